"""Loops that drive at a given speed pass by pass while they look at signals and count (URScript's search for contact):
each pass becomes a search of what many passes drive, and counts as many.

What ends the loop is told from its head and from branches that leave it: signals alone, or how far a counter is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.control.jumps import leaves, opposite
from rpl.passes.legalise.rewriting.editing import Editor, expansion

PART_S = 1.0  # s: how much of an endless way is written at once; less would stop more often, more might not be reached
_LOGIC = (ir.Signal, ir.Unary, ir.Binary, ir.BoolLiteral, ir.IntLiteral, ir.RealLiteral)
_TURNED = {"<": ">", "<=": ">=", ">": "<", ">=": "<="}
_ROUNDED = 1e-6


@dataclass(frozen=True, slots=True)
class Around:
    """Where the loop stands."""

    program: ir.Program
    routine: ir.Routine

    def own(self) -> set[str]:
        """The variables that no other routine sees."""
        variables = {one.name.lower() for one in self.routine.declarations if isinstance(one, ir.Variable)}
        return variables | {one.name.lower() for one in self.routine.parameters}


@dataclass(frozen=True, slots=True)
class Counted:
    """How such a loop goes on. `looks`: what has to hold of the signals; `left`: how much its counter may still grow;
    `counts`: each counter with what a pass adds; `pass_s`: how long a pass lasts."""

    looks: ir.Expression
    left: ir.Expression | None
    counter: str
    counts: dict[str, float]
    pass_s: float
    single: bool


def counted(loop: ir.Statement, move: ir.Move, around: Around, pauses: float | None) -> Counted | None:
    """What the loop does beside its motion, where that is looking and counting alone. `pauses`: what its waits add."""
    given = move.speed.duration if move.speed is not None else None
    time = given.value if isinstance(given, ir.Quantity) else given
    if pauses is None or not isinstance(time, ir.RealLiteral | ir.IntLiteral) or not 0.0 < time.value <= PART_S:
        return None
    if not isinstance(loop, ir.While | ir.Loop):
        return None
    going = list(_conjuncts(loop.condition)) if isinstance(loop, ir.While) else []
    counts: dict[str, float] = {}
    driven = False  # what counts stands behind the motion
    for statement in loop.body:
        count = _count(statement)
        left = leaving(statement)
        driven = driven or statement is move
        if count is not None and count[0] not in counts and driven:
            counts[count[0]] = count[1]
        elif left is not None:
            going += _conjuncts(opposite(left))
        elif statement is not move and not isinstance(statement, ir.Nothing | ir.Wait):
            return None
    if any(isinstance(node, ir.Name) and node.id.lower() in counts for node in walk(move)):
        return None
    looks = [one for one in going if all(map(is_outside, walk(one)))]
    limits = [one for one in going if one not in looks]
    if not looks or len(limits) > 1 or not _only_there(counts, loop, limits, around):
        return None
    left_of = _limit(limits[0], counts) if limits else None
    if limits and left_of is None:
        return None
    counter, rest = left_of or ("", None)
    return Counted(_all(looks), rest, counter, counts, float(time.value) + pauses, len(looks) == 1)


def searched(loop: ir.While | ir.Loop, move: ir.Move, found: Counted, editor: Editor, way: Way) -> ir.Body:
    """The loop whose passes are searches. Where one has found, its own look sees that, even if the signal has gone."""
    hit = editor.temporary("hit", ir.BoolType())
    before, seconds, grown = _part(found, editor)
    part = replace(way(move, seconds), search=ir.Search(opposite(found.looks), stop="path", hit=hit))
    seen = opposite(found.looks)

    def look(condition: ir.Expression) -> ir.Expression:
        return ir.Binary("or", condition, hit) if found.single and condition == seen else condition

    body: list[ir.Statement] = []
    for statement in loop.body:
        count = _count(statement)
        if statement is move:
            body += expansion(move.origin, (*before, part))
        elif count is not None:
            more = (_added(statement, grown(count[1])),)
            body.append(ir.If(((hit, (statement,)),), more, origin=statement.origin))
        elif isinstance(statement, ir.If):
            ((condition, inner),) = statement.branches
            body.append(replace(statement, branches=((look(condition), inner),)))
        elif not isinstance(statement, ir.Wait):
            body.append(statement)
    start = ir.Assign(hit, ir.BoolLiteral(False))
    return expansion(loop.origin, (start, replace(loop, body=tuple(body))))


Way = Callable[[ir.Move, ir.Expression], ir.Move]
_Grown = Callable[[float], ir.Expression]


def _part(found: Counted, editor: Editor) -> tuple[ir.Body, ir.Expression, _Grown]:
    """How long the next search lasts: what makes that known, the seconds, and what a counter grows meanwhile."""
    passes = max(round(PART_S / found.pass_s), 1)
    if found.left is None:
        return (), ir.RealLiteral(round(passes * found.pass_s, 9)), lambda step: _literal(step * passes)
    step = found.counts[found.counter]
    whole = isinstance(editor.type_of(ir.Name(found.counter)), ir.IntType) and step == 1.0
    part = editor.temporary("part", ir.IntType() if whole else ir.RealType())
    most = _literal(passes * step) if whole else ir.RealLiteral(round(passes * step, 9))
    shorter = ir.If(((ir.Binary(">", part, most), (ir.Assign(part, most),)),))
    before = (ir.Assign(part, found.left), shorter)
    return before, _scaled(part, found.pass_s / step), lambda other: _scaled(part, other / step)


def _scaled(value: ir.Expression, factor: float) -> ir.Expression:
    return value if abs(factor - 1.0) < _ROUNDED else ir.Binary("*", value, ir.RealLiteral(round(factor, 12)))


def _literal(value: float) -> ir.Expression:
    return ir.IntLiteral(round(value)) if value == round(value) else ir.RealLiteral(round(value, 9))


def _added(statement: ir.Statement, more: ir.Expression) -> ir.Statement:
    assert isinstance(statement, ir.Assign) and isinstance(statement.value, ir.Binary)  # a count
    return replace(statement, value=ir.Binary("+", statement.target, more), origin=statement.origin)


def _conjuncts(condition: ir.Expression) -> Iterator[ir.Expression]:
    if isinstance(condition, ir.Binary) and condition.op in ("and", "cand"):
        yield from _conjuncts(condition.left)
        yield from _conjuncts(condition.right)
    elif condition != ir.BoolLiteral(True):
        yield condition


def _all(conditions: list[ir.Expression]) -> ir.Expression:
    first, *more = conditions
    for one in more:
        first = ir.Binary("and", first, one)
    return first


def _count(statement: ir.Statement) -> tuple[str, float] | None:
    """A variable that grows by a number."""
    match statement:
        case ir.Assign(target=ir.Name(id=name), value=ir.Binary("+", ir.Name(id=same), step)):
            if name.lower() == same.lower() and isinstance(step, ir.IntLiteral | ir.RealLiteral) and step.value > 0:
                return name.lower(), float(step.value)
    return None


def leaving(statement: ir.Statement) -> ir.Expression | None:
    """The condition of a branch that leaves the loop without driving."""
    match statement:
        case ir.If(branches=((condition, inner),), otherwise=()) if inner and leaves(inner[-1]):
            jumps = any(isinstance(n, ir.NextPass | ir.Goto | ir.Label | ir.Move) for n in walk(*inner))
            return None if jumps else condition
    return None


def _limit(going: ir.Expression, counts: dict[str, float]) -> tuple[str, ir.Expression] | None:
    """The counter that a condition compares with what does not change, and how much it may still grow."""
    match going:
        case ir.Binary(op=op, left=ir.Name(id=name), right=limit) if op in ("<", "<="):
            pass
        case ir.Binary(op=op, left=limit, right=ir.Name(id=name)) if _TURNED.get(op) in ("<", "<="):
            op = _TURNED[op]
        case _:
            return None
    varies = any(isinstance(node, ir.Call) or _is_one_of(node, counts) for node in walk(limit))
    if name.lower() not in counts or varies:
        return None
    rest: ir.Expression = limit
    rest = ir.Binary("-", rest, ir.Name(name))
    if op == "<=":  # the pass at the limit too
        rest = ir.Binary("+", rest, _literal(counts[name.lower()]))
    return name.lower(), rest


def _is_one_of(node: object, names: dict[str, float]) -> bool:
    return isinstance(node, ir.Name) and node.id.lower() in names


def _only_there(counts: dict[str, float], loop: ir.Statement, limits: list[ir.Expression], around: Around) -> bool:
    """Are the counters of the loop asked for nothing but their limit, and set before? What a search has counted when it
    finds is not the number of passes."""
    nodes = list(walk(*bodies(around.routine)) if counts.keys() <= around.own() else walk(*around.program.modules))
    asked = [n for n in nodes if _is_one_of(n, counts)]
    there = sum(_is_one_of(n, counts) for n in walk(loop))
    sets = [n for n in nodes if isinstance(n, ir.Assign) and _is_one_of(n.target, counts)]
    begins = [n for n in sets if not any(_is_one_of(m, counts) for m in walk(n.value))]
    known = [*limits, *map(opposite, limits)]
    tests = [n for n in nodes if n in known]
    inner = [n for n in walk(loop) if n in known]
    return len(asked) - there == len(begins) + len(tests) - len(inner)


def is_outside(node: object) -> bool:
    """Is it part of a condition that signals alone decide?"""
    return not isinstance(node, ir.Expression) or isinstance(node, _LOGIC)


__all__ = ["PART_S", "Around", "Counted", "counted", "is_outside", "leaving", "searched"]
