"""Closed TP blocks to IR: IF THEN, FOR, point logic under a move, and the program with its positions."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import cast, get_args

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.ir.walk import statements, walk
from rpl.passes.rewrite import changed
from rpl.reading.pieces import Block, Item, ModulePart

from . import modal, tables
from .header import Header
from .motion import MISSING_POSITION, NOT_TAUGHT, SECOND_ARM
from .positions import parse_position
from .statements import CHOSEN_NUMBER, CHOSEN_TRUTH, HIT, TIMED_OUT

MISPLACED = code("tp-misplaced", Severity.ERROR, "{what} cannot stand here")
LOOSE_ARC = code(
    "tp-arc-points",
    Severity.WARNING,
    "the last A point has no partner for an arc; the robot's way to it is not known here",
)
_STATEMENTS = get_args(ir.Statement)
_LOCAL_REGISTER = re.compile(r"R1\d{4}")


@dataclass(frozen=True, slots=True)
class Listing:
    """What a program's part knows of its header."""

    header: Header


@dataclass(slots=True)
class Builder:
    """Builds closed blocks. `name`: how a program is called in the IR. `conditions`: what they set (modal.py)."""

    diagnostics: Diagnostics
    program: str = ""
    conditions: modal.Values = field(default_factory=dict)
    nested: int = 0
    routines: list[ir.Routine] = field(default_factory=list)

    def __call__(self, block: Block) -> Item | tuple[Item, ...]:
        match block.open.kind:
            case "program":
                return self.listing(block)
            case "if":
                return self.branch(block)
            case "for":
                return self.loop(block)
        return self.point_logic(block)

    def body(self, items: Iterable[Item]) -> ir.Body:
        done: list[ir.Statement] = []
        for item in items:
            if isinstance(item, _STATEMENTS):
                done.append(item)
            else:
                self.diagnostics.report(MISPLACED, item.origin, what="this")
        return tuple(_grouped(done, self.diagnostics))

    def settled(self, items: Iterable[Item]) -> ir.Body:
        """A whole program's lines, its moves with the conditions that hold for them."""
        return modal.settled(self.body(items), self.conditions)

    def branch(self, block: Block) -> Item:
        condition = cast(ir.Expression, block.open.data)
        bodies = [self.body(section.items) for section in block.sections]
        otherwise: ir.Body = sum(bodies[1:], ())
        return ir.If(((condition, bodies[0]),), otherwise, origin=block.open.origin)

    def loop(self, block: Block) -> Item | tuple[Item, ...]:
        assert isinstance(block.open.data, tuple)
        counter, start, stop, down = block.open.data
        body = self.body(item for section in block.sections for item in section.items)
        origin = block.open.origin
        if isinstance(counter, ir.Name) and not _changes(body, stop):
            step = ir.IntLiteral(-1, origin=origin) if down else None
            return ir.For(counter.id, start, stop, step, body, keeps_last=True, origin=origin)
        return self.indexed_loop(counter, start, stop, down, body, block)

    def indexed_loop(
        self, counter: ir.Expression, start: ir.Expression, stop: ir.Expression, down: bool, body: ir.Body, block: Block
    ) -> tuple[Item, ...]:
        """A loop whose counter is an element of the register array, or whose bound changes inside: ENDFOR compares the
        counter with the bound as it is then, and counts on only below it (operator's manual, FOR/ENDFOR)."""
        origin = block.open.origin
        bound = stop
        made: list[Item] = [ir.Assign(counter, start, origin=origin)]
        within, last = (">=", "<=") if down else ("<=", ">=")
        bare = replace(origin, comments=())  # the remarks above stand before the first statement only
        leave = ir.If(((ir.Binary(last, counter, bound, origin=bare), (ir.ExitLoop(origin=bare),)),), origin=bare)
        step = ir.Binary("-" if down else "+", counter, ir.IntLiteral(1), origin=bare)
        again = ir.Assign(counter, step, origin=bare)
        condition = ir.Binary(within, counter, bound, origin=bare)
        made.append(ir.While(condition, (*body, leave, again), origin=bare))
        return tuple(made)

    def point_logic(self, block: Block) -> Item:
        """Statements under a move run as a program of their own, so long before or after its end."""
        assert isinstance(block.open.data, tuple)
        move, (_, delay) = block.open.data
        self.nested += 1
        name = f"{self.program}_P{self.nested}"
        body = self.settled(item for section in block.sections for item in section.items)
        flags = _local_flags(list(statements(body)))
        self.routines.append(ir.Routine(name, declarations=flags, body=body, scope="global", origin=block.open.origin))
        action = ir.CallRoutine(name, origin=block.open.origin)
        trigger = ir.Trigger("end", action, None, delay, origin=block.open.origin)
        return replace(cast(ir.Move, move), triggers=(*move.triggers, trigger), origin=block.open.origin)

    def listing(self, block: Block) -> Item:
        header = block.open.data
        assert isinstance(header, Header)
        lines: list[Item] = []
        positions: list[ir.Declaration] = []
        for section in block.sections:
            if section.head is None:
                lines.extend(section.items)
                continue
            for item in section.items:
                match item:
                    case ir.Variable():
                        positions.append(item)
                    case ir.Nothing() | ir.Opaque():
                        lines.append(item)
                    case _:
                        self.diagnostics.report(MISPLACED, item.origin, what="a statement among the positions")
        body = self.settled(lines)
        inside = list(statements(body))
        nested = list(statements(*(routine.body for routine in self.routines)))
        declared = (*self.used_positions(positions, inside + nested), *_local_flags(inside))
        routine = ir.Routine(
            self.program, declarations=declared, body=body, scope="global", origin=replace(block.open.origin)
        )
        routines = (routine, *self.routines)
        return ModulePart(self.program, (), routines, Listing(header), block.open.origin)

    def used_positions(self, positions: list[ir.Declaration], inside: list[ir.Statement]) -> tuple[ir.Declaration, ...]:
        """The program's positions: constant where no statement writes them. A missing one is declared without value."""
        written = {_base(node.target) for node in inside if isinstance(node, ir.Assign)}
        found: dict[str, ir.Variable] = {}
        for position in positions:
            assert isinstance(position, ir.Variable)
            constant = position.initial is not None and position.name not in written
            storage = "constant" if constant else "persistent"
            found.setdefault(position.name, changed(position, storage=storage))
        missing: dict[str, ir.Variable] = {}
        reported: set[str] = set()
        for move in (node for node in inside if isinstance(node, ir.Move)):
            for name in (_base(move.target), _base(move.via)):
                if not name.startswith("P") or not name[1:].isdigit() or name in reported:
                    continue
                known = found.get(name)
                if known is None:
                    reported.add(name)
                    self.diagnostics.report(MISSING_POSITION, move.origin, number=name[1:])
                    missing[name] = ir.Variable(name, ir.TargetType("tp"), None, "persistent", "routine")
                elif known.initial is None and name not in written:
                    reported.add(name)
                    group = parse_position(known.origin.text).second_arm
                    if group is not None:
                        self.diagnostics.report(SECOND_ARM, move.origin, number=name[1:], group=group)
                    else:
                        self.diagnostics.report(NOT_TAUGHT, move.origin, number=name[1:])
        return (*found.values(), *missing.values())


def _changes(body: ir.Body, bound: ir.Expression) -> bool:
    """Does the loop's body write the register that is its bound?"""
    return any(isinstance(node, ir.Assign) and node.target == bound for node in statements(body))


def _base(expression: ir.Expression | None) -> str:
    match expression:
        case ir.Name(id=name):
            return name
        case ir.Field(base=base) | ir.Index(base=base):
            return _base(base)
        case ir.Builtin(arguments=(first, *_)):
            return _base(first)
    return ""


def _local_flags(inside: list[ir.Statement]) -> tuple[ir.Variable, ...]:
    """Variables that the reader needs besides the registers."""
    used = {
        HIT: any(isinstance(node, ir.Move) and node.search is not None for node in inside),
        TIMED_OUT: any(isinstance(node, ir.WaitUntil) and node.timed_out is not None for node in inside),
    }
    flags = tuple(ir.Variable(name, ir.BoolType(), scope="routine") for name in (HIT, TIMED_OUT) if used[name])
    return *flags, *modal.chosen(inside), *_chosen(inside), *_local_registers(inside)


def _chosen(inside: list[ir.Statement]) -> Iterable[ir.Variable]:
    """What is worked out in front of a block."""
    names = {
        node.target.id: None for node in inside if isinstance(node, ir.Assign) and isinstance(node.target, ir.Name)
    }
    for name in names:
        if name.startswith((CHOSEN_TRUTH, CHOSEN_NUMBER)):
            type: ir.Type = ir.BoolType() if name.startswith(CHOSEN_TRUTH) else tables.NUMBER
            yield ir.Variable(name, type, scope="routine")


def _local_registers(inside: list[ir.Statement]) -> Iterable[ir.Variable]:
    """R[10001] and up belong to each call of the program."""
    used = {node.id for node in walk(*inside) if isinstance(node, ir.Name) and _LOCAL_REGISTER.fullmatch(node.id)}
    for name in sorted(used):
        yield ir.Variable(name, tables.NUMBER, ir.IntLiteral(0), scope="routine")


def _grouped(statements: list[ir.Statement], diagnostics: Diagnostics) -> Iterable[ir.Statement]:
    """Consecutive S moves form one spline; consecutive A moves form arcs, two points each behind the first."""
    place = 0
    while place < len(statements):
        run = _run(statements, place)
        if run <= 1 and not _is_spline(statements[place]):
            yield statements[place]
        elif _is_spline(statements[place]):
            moves = [statement for statement in statements[place : place + run] if isinstance(statement, ir.Move)]
            last = moves[-1]
            yield ir.Spline("path", tuple(moves), last.blend, origin=moves[0].origin)
        else:
            yield from _arcs([s for s in statements[place : place + run] if isinstance(s, ir.Move)], diagnostics)
        place += max(run, 1)


def _is_spline(statement: ir.Statement) -> bool:
    return isinstance(statement, ir.Move) and statement.kind == "spline"


def _is_arc(statement: ir.Statement) -> bool:
    if not isinstance(statement, ir.Move) or statement.kind != "linear":
        return False
    return letter_of(statement) == "A"


def letter_of(move: ir.Move) -> str:
    """The motion letter in the listing."""
    return re.sub(r"^\s*\d*\s*:", "", move.origin.text).strip()[:1].upper()


def _run(statements: list[ir.Statement], place: int) -> int:
    """How many moves of the same grouped kind begin here."""
    test = _is_spline if _is_spline(statements[place]) else _is_arc
    count = 0
    while place + count < len(statements) and test(statements[place + count]):
        count += 1
    return count


def _arcs(moves: list[ir.Move], diagnostics: Diagnostics) -> Iterable[ir.Statement]:
    """M: the first A point is reached on a line, the next ones in pairs: over one to the other."""
    yield moves[0]
    rest = moves[1:]
    while len(rest) >= 2:
        via, goal, *rest = rest
        yield replace(goal, kind="circular", via=via.target)
    if rest:
        diagnostics.report(LOOSE_ARC, rest[0].origin)
        yield ir.Vendor("tp", " ".join(rest[0].origin.text.split()), "unknown", origin=rest[0].origin)
