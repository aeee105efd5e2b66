"""Closed V+ blocks to IR nodes, and the jumps of EXIT and NEXT over several loops."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import cast, get_args

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.reading.pieces import Block, Item, ModulePart

from .statements import Datum, Declared, Header

NOT_IN_CASE = code(
    "vplus-before-first-value", Severity.WARNING, "steps between CASE and the first VALUE are never executed"
)
LATE_DECLARATION = code(
    "vplus-late-declaration",
    Severity.WARNING,
    "declared behind the first step; controllers refuse this",
    "move the line to the top of the program",
)
MISPLACED = code("vplus-misplaced", Severity.ERROR, "{what} cannot stand here")
JOINT_SPEED = code(
    "vplus-speed-of-joints",
    Severity.INFO,
    "a tool speed holds for straight lines; moves in joints get {percent} percent of their speed",
)
NO_LOOP = code("vplus-no-such-loop", Severity.ERROR, "{word} {count} reaches over more loops than there are")

_UNIT = re.compile(r"\b(?:MMPS|IPS)\b", re.IGNORECASE)
_STATEMENTS = get_args(ir.Statement)


@dataclass(frozen=True, slots=True)
class ProgramPart:
    """A whole program, its types not known yet."""

    header: Header
    declared: tuple[Declared, ...]
    body: ir.Body


@dataclass(frozen=True, slots=True)
class DataPart:
    """A data section: values for global variables."""

    section: str
    values: tuple[tuple[Datum, ModulePart], ...]


class Builder:
    """Builds closed blocks."""

    def __init__(self, diagnostics: Diagnostics) -> None:
        self.diagnostics = diagnostics

    def __call__(self, block: Block) -> Item | tuple[Item, ...]:
        kind = block.open.kind.partition(" ")[0]
        if kind == "program":
            return self.program(block)
        if kind == "data":
            return self.data(block)
        lifted = [item for section in block.sections for item in section.items if _is_outer(item)]
        return (*self.statement(kind, block), *lifted)

    def statement(self, kind: str, block: Block) -> tuple[ir.Statement, ...]:
        origin, data = block.open.origin, block.open.data
        bodies = [self.body(section.items) for section in block.sections]
        match kind:
            case "IF":
                return (ir.If(((_expression(data), bodies[0]),), sum(bodies[1:], ()), origin=origin),)
            case "CASE":
                return (self.switch(block, bodies),)
            case "FOR":
                return _counted(cast(tuple[ir.Expression, ...], data), bodies[0], block)
            case "WHILE":
                return (ir.While(_expression(data), bodies[0], origin=origin),)
        until = block.close.data if block.close else ir.BoolLiteral(True)
        return (ir.Repeat(_expression(until), bodies[0], origin=origin),)

    def switch(self, block: Block, bodies: list[ir.Body]) -> ir.Statement:
        cases: list[ir.Case] = []
        default: ir.Body | None = None
        before = bodies[0]
        if any(not isinstance(statement, ir.Nothing) for statement in before):
            self.diagnostics.report(NOT_IN_CASE, block.open.origin)
            before = ()
        for section, body in zip(block.sections[1:], bodies[1:], strict=True):
            head = section.head
            whole, before = before + body, ()
            if head is not None and isinstance(head.data, tuple):
                cases.append(ir.Case(head.data, whole, origin=head.origin))
            else:
                default = whole
        if not cases and default is None:
            default = before
        return ir.Switch(_expression(block.open.data), tuple(cases), default, origin=block.open.origin)

    def body(self, items: Iterable[Item]) -> ir.Body:
        done: list[ir.Statement] = []
        for item in items:
            if isinstance(item, _STATEMENTS):
                done.append(item)
            elif isinstance(item, ModulePart) and not _is_outer(item):
                self.diagnostics.report(MISPLACED, item.origin, what="a declaration inside of a block")
                done.append(ir.Opaque(item.origin.text, origin=item.origin))
        self.check_speeds(done)
        return tuple(done)

    def check_speeds(self, body: list[ir.Statement]) -> None:
        """A tool speed for the next move counts for straight lines: told where that is not one."""
        for at, statement in enumerate(body):
            match statement:
                case ir.SetForNextMove(
                    setting=ir.System(name="joint_speed"), value=ir.IntLiteral() | ir.RealLiteral() as percent
                ) if _UNIT.search(statement.origin.text or ""):
                    following = next((one for one in body[at:] if isinstance(one, ir.Move)), None)
                    if following is None or following.kind == "joint":
                        self.diagnostics.report(JOINT_SPEED, statement.origin, percent=f"{percent.value:g}")

    def program(self, block: Block) -> Item | tuple[Item, ...]:
        header, origin = block.open.data, block.open.origin
        assert isinstance(header, Header)
        items = [item for section in block.sections for item in section.items]
        outer = [item for item in items if _is_outer(item)]
        declared: list[Declared] = []
        statements: list[Item] = []
        for item in items:
            if isinstance(item, ModulePart) and isinstance(item.data, Declared):
                if any(not isinstance(statement, ir.Nothing) for statement in statements):
                    self.diagnostics.report(LATE_DECLARATION, item.origin)
                declared.append(item.data)
                if item.origin.comments:
                    statements.append(ir.Nothing(origin=item.origin))
            elif not _is_outer(item):
                statements.append(item)
        body = self.leaves(self.body(statements), ())
        part = ModulePart(header.name, (), (), ProgramPart(header, tuple(declared), body), origin)
        return (part, *outer) if outer else part

    def data(self, block: Block) -> Item | tuple[Item, ...]:
        items = [item for section in block.sections for item in section.items]
        values = tuple(
            (item.data, item) for item in items if isinstance(item, ModulePart) and isinstance(item.data, Datum)
        )
        outer = [item for item in items if _is_outer(item)]
        part = ModulePart("data", (), (), DataPart(str(block.open.data), values), block.open.origin)
        return (part, *outer) if outer else part

    # ---- EXIT and NEXT

    def leaves(self, body: ir.Body, loops: tuple[_Loop, ...]) -> ir.Body:
        """The body with marks of EXIT and NEXT resolved: the innermost loop by its own statements, others by labels."""
        done: list[ir.Statement] = []
        for statement in body:
            done.extend(self.left(statement, loops))
        return tuple(done)

    def left(self, statement: ir.Statement, loops: tuple[_Loop, ...]) -> tuple[ir.Statement, ...]:
        match statement:
            case ir.Goto(label=label) if ":" in label:
                return (self.leave(statement, loops),)
            case ir.If(branches=branches, otherwise=otherwise):
                inner = tuple((condition, self.leaves(body, loops)) for condition, body in branches)
                return (replace(statement, branches=inner, otherwise=self.leaves(otherwise, loops)),)
            case ir.Switch(cases=cases, default=default):
                inside = tuple(replace(case, body=self.leaves(case.body, loops)) for case in cases)
                other = None if default is None else self.leaves(default, loops)
                return (replace(statement, cases=inside, default=other),)
            case ir.For() | ir.While() | ir.Repeat():
                loop = _Loop(f"loop{statement.origin.line}")
                body = self.leaves(statement.body, (*loops, loop))
                if "next" in loop.used:
                    body = (*body, ir.Label(f"{loop.name}.next", origin=statement.origin))
                kept: tuple[ir.Statement, ...] = (replace(statement, body=body),)
                if "exit" in loop.used:
                    kept = (*kept, ir.Label(f"{loop.name}.exit", origin=statement.origin))
                return kept
        return (statement,)

    def leave(self, mark: ir.Goto, loops: tuple[_Loop, ...]) -> ir.Statement:
        word, _, number = mark.label.partition(":")
        count = int(number)
        if count > len(loops):
            self.diagnostics.report(NO_LOOP, mark.origin, word=word.upper(), count=count)
            return ir.Opaque(mark.origin.text, origin=mark.origin)
        if count == 1:
            return ir.ExitLoop(origin=mark.origin) if word == "exit" else ir.NextPass(origin=mark.origin)
        loop = loops[-count]
        loop.used.add(word)
        return ir.Goto(f"{loop.name}.{word}", origin=mark.origin)


class _Loop:
    """A loop around what is being read: its name for labels, and which of them are used."""

    __slots__ = ("name", "used")

    def __init__(self, name: str) -> None:
        self.name = name
        self.used: set[str] = set()


def _counted(data: tuple[ir.Expression, ...], body: ir.Body, block: Block) -> tuple[ir.Statement, ...]:
    """A FOR loop. An element that counts gets its values from a variable of the loop's own."""
    counter, start, stop, step = data
    origin = block.open.origin
    if isinstance(counter, ir.Name):
        return (ir.For(counter.id, start, stop, step, body, origin=origin),)
    hidden = ir.Name(f"for{origin.line}", origin=origin)
    given = ir.Assign(counter, hidden, origin=origin)
    return ir.For(hidden.id, start, stop, step, (given, *body), origin=origin), given


def _is_outer(item: Item) -> bool:
    """Does the item belong beside programs, not inside of one?"""
    return isinstance(item, ModulePart) and isinstance(item.data, ProgramPart | DataPart)


def _expression(data: object) -> ir.Expression:
    assert isinstance(data, get_args(ir.Expression))
    return cast(ir.Expression, data)
