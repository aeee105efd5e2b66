"""What mutants change, as data: each operator makes one change at one place of a program, small enough to be missed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import cast

from mutation_sites import Path, Site, sites

from rpl import ir


@dataclass(frozen=True, slots=True)
class Mutant:
    """One change: at `path` stands `value` instead. `needs`: statements of which one has to be reached for the change
    to matter (empty: a declaration, of what is `declared`)."""

    operator: str
    path: Path
    value: object
    site: Site
    needs: tuple[ir.Statement, ...]


@dataclass(frozen=True, slots=True)
class Number:
    """A change of a number that means `role`: times a factor, then plus an amount in base units (mm, deg, s). `within`:
    only inside of a tool or frame (TRUE), only outside (FALSE), both (None)."""

    name: str
    role: str
    times: float = 1.0
    add: float = 0.0
    within: bool | None = False


FRAME = "tool or frame"
NUMBERS = (
    Number("coordinate +1 mm", "coordinate", add=1.0),
    Number("angle +0.5 deg", "angle", add=0.5),
    Number("quaternion component +0.01", "quaternion", add=0.01),
    Number("joint +0.5 deg", "joint", add=0.5),
    Number("motor pulses +1000", "motor pulse", add=1000.0),
    Number("external axis +1", "external axis", add=1.0),
    Number("tool or frame +1 mm", "coordinate", add=1.0, within=True),
    Number("tool or frame +0.5 deg", "angle", add=0.5, within=True),
    Number("tool or frame, quaternion +0.01", "quaternion", add=0.01, within=True),
    Number("path speed +20 %", "path speed", times=1.2),
    Number("path speed tenfold", "path speed", times=10.0),
    Number("joint speed -20 %", "joint speed", times=0.8),
    Number("turning speed tenfold", "turning speed", times=10.0),
    Number("time of a move +20 %", "move time", times=1.2),
    Number("acceleration -20 %", "acceleration", times=0.8),
    Number("corner to a third", "corner", times=1.0 / 3.0),
    Number("corner level +1", "corner level", add=1.0),
    Number("wait +1 ms", "wait", add=0.001),
    Number("wait +20 %", "wait", times=1.2),
    Number("time-out +20 %", "time-out", times=1.2),
    Number("pulse three times as long", "pulse", times=3.0),
    Number("delay of an output +50 ms", "delay", add=0.05),
    Number("trigger +10 mm", "trigger distance", add=10.0),
    Number("trigger +50 ms", "trigger delay", add=0.05),
    Number("load twice as heavy", "load mass", times=2.0, within=None),
    Number("centre of a load +10 mm", "load centre", add=10.0, within=None),
    Number("loop bound +1", "loop bound", add=1.0),
    Number("case +1", "case value", add=1.0),
    Number("compared number +1", "compared number", add=1.0),
    Number("assigned number +1", "assigned number", add=1.0),
    Number("number put out +1", "output value", add=1.0),
    Number("number of an output +1", "output number", add=1.0),
    Number("number of an input +1", "input number", add=1.0),
    Number("index +1", "index", add=1.0),
    Number("posture number +1", "posture number", add=1.0),
    Number("priority +1", "priority", add=1.0),
    Number("other number +1", "", add=1.0, within=None),
)
_IN_MM = frozenset(("coordinate", "load centre", "trigger distance"))
_SCALED = _IN_MM | {"angle", "joint", "wait", "delay", "trigger delay", "time-out"}
_UNSET = 1e8  # larger numbers stand for an axis that is not there

_TRUTH = {"output value": "output inverted", "posture flag": "posture flag inverted"}
_COMPARISONS = {
    "=": ("<>",),
    "<>": ("=",),
    "<": ("<=", ">="),
    "<=": ("<", ">"),
    ">": (">=", "<="),
    ">=": (">", "<"),
}
_LOGIC = {"and": "or", "or": "and", "cand": "cor", "cor": "cand", "xor": "or", "band": "bor", "bor": "band"}
_ARITHMETIC = {"+": "-", "-": "+", "*": "+", "/": "*", "div": "*", "quo": "*", "mod": "+"}
_KINDS = {"joint": "linear", "linear": "joint"}
_ADDED_MM, _ANOTHER_MM = 20.0, 60.0
_NO_STATEMENT = (ir.Nothing, ir.Label, ir.Vendor, ir.Opaque)
_DROPPED: tuple[tuple[tuple[type, ...], str], ...] = (
    ((ir.Move, ir.MoveExternal, ir.Spline), "move dropped"),
    ((ir.CallRoutine,), "call dropped"),
    ((ir.Pulse, ir.SetAfter), "output dropped"),
    ((ir.Wait, ir.WaitUntil, ir.WaitForMotion), "wait dropped"),
    ((ir.Message, ir.Dialog), "message dropped"),
    ((ir.Trigger, ir.PathRule, ir.DefineTrigger), "trigger dropped"),
    ((ir.Assign, ir.SetForNextMove, ir.Do), "assignment dropped"),
    ((ir.If, ir.Switch, ir.For, ir.While, ir.Repeat, ir.Loop), "branch or loop dropped"),
)


class Names:
    """What a program declares: what another name can stand in place of."""

    def __init__(self, program: ir.Program) -> None:
        self.points: dict[str, list[str]] = {}
        self.type_of: dict[str, str] = {}
        self.routines: dict[int, list[str]] = {}
        self.signals: dict[str, list[str]] = {}
        for module in program.modules:
            for one in module.declarations:
                if isinstance(one, ir.Variable) and isinstance(one.type, ir.TargetType | ir.JointsType | ir.PoseType):
                    kind = repr(one.type)
                    self.type_of[one.name] = kind
                    self.points.setdefault(kind, []).append(one.name)
            for routine in module.routines:
                if routine.kind == "procedure":
                    self.routines.setdefault(len(routine.parameters), []).append(routine.name)

    def after(self, name: str, among: list[str]) -> Iterator[str]:
        """The next one in a row, if there is another."""
        others = [one for one in among if one.lower() != name.lower()]
        if others and name in among:
            yield others[among.index(name) % len(others)]


Change = Callable[[Site, Names], Iterator[tuple[str, object]]]


def _numbers(site: Site, names: Names) -> Iterator[tuple[str, object]]:
    literal = site.value
    if not isinstance(literal, ir.IntLiteral | ir.RealLiteral) or abs(literal.value) > _UNSET:
        return
    for one in NUMBERS:
        if one.role != site.role or (one.within is not None and one.within != (site.owner == FRAME)):
            continue
        scale = ir.UNITS.get(site.unit, 1.0) if one.role in _SCALED else 1.0
        value = literal.value * one.times + one.add / scale
        if value == literal.value:
            continue
        if isinstance(literal, ir.IntLiteral) and float(value).is_integer():
            yield one.name, ir.IntLiteral(int(value), origin=literal.origin)
        else:
            yield one.name, ir.RealLiteral(round(float(value), 9), origin=literal.origin)


def _truth_and_texts(site: Site, names: Names) -> Iterator[tuple[str, object]]:
    match site.value:
        case ir.BoolLiteral(value=value):
            name = _TRUTH.get(site.role, "truth value inverted")
            yield name, ir.BoolLiteral(not value, origin=site.value.origin)
        case ir.TextLiteral(value=text) if text:
            yield "text changed", replace(site.value, value=text + "s")


def _conditions(site: Site, names: Names) -> Iterator[tuple[str, object]]:
    if site.condition:
        condition = cast("ir.Expression", site.value)  # a condition is nothing else
        yield "condition negated", ir.Unary("not", condition, origin=site.origin)
    node = site.value
    if not isinstance(node, ir.Binary):
        return
    for op in _COMPARISONS.get(node.op, ()):
        yield "another comparison", replace(node, op=op)
    if node.op in _LOGIC:
        yield "and for or", replace(node, op=_LOGIC[node.op])
    if node.op in _ARITHMETIC:
        yield "another arithmetic operator", replace(node, op=_ARITHMETIC[node.op])


def _moves(site: Site, names: Names) -> Iterator[tuple[str, object]]:
    move = site.value
    if isinstance(move, ir.Name) and isinstance(site.statement, ir.Move) and site.path[-1] in ("target", "via"):
        for name in names.after(move.id, names.points.get(names.type_of.get(move.id, ""), [])):
            yield "another point", replace(move, id=name)
    if not isinstance(move, ir.Move):
        return
    if move.kind in _KINDS and move.motion_class != "velocity" and move.relative is None:
        yield "joint move for linear move", replace(move, kind=_KINDS[move.kind])
    if move.orientation in ("variable", "constant"):
        other = {"variable": "constant", "constant": "variable"}[move.orientation]
        yield "orientation kept or not", replace(move, orientation=other)
    if move.search is not None:
        edge = {"rising": "falling", "falling": "rising"}.get(move.search.edge, "rising")
        yield "edge of a search", replace(move, search=replace(move.search, edge=edge))
    match move.blend:
        case None:
            pass
        case ir.BlendStop():
            yield "corner added", replace(move, blend=ir.BlendDistance(ir.RealLiteral(_ADDED_MM)))
        case ir.BlendZone(zone=zone, distance=None) as blend:
            distance = ir.RealLiteral(_ANOTHER_MM)
            yield "another corner", replace(move, blend=ir.BlendZone(zone, distance, blend.in_position))
            yield "corner removed", replace(move, blend=ir.BlendStop())
        case _:
            yield "corner removed", replace(move, blend=ir.BlendStop())


def _calls(site: Site, names: Names) -> Iterator[tuple[str, object]]:
    call = site.value
    match call:
        case ir.CallRoutine(name=name, arguments=arguments, dynamic=None):
            for other in names.after(name, names.routines.get(len(arguments), [])):
                yield "another routine", replace(call, name=other)
            for one, two in zip(range(len(arguments)), range(1, len(arguments)), strict=False):
                if arguments[one].name is None and arguments[two].name is None and arguments[one] != arguments[two]:
                    swapped = (*arguments[:one], arguments[two], arguments[one], *arguments[two + 1 :])
                    yield "arguments swapped", replace(call, arguments=swapped)
        case ir.Signal(name=str(name), index=None, kind=kind):
            for other in names.after(name, names.signals.get(kind, [])):
                yield "another signal", replace(call, name=other)


def _bodies(site: Site, names: Names) -> Iterator[tuple[str, object]]:
    """Rows of statements: one left out, two that follow each other swapped."""
    body = site.value
    if not isinstance(body, tuple):
        return
    if site.path[-1] == "otherwise":
        yield "else dropped", ()
    for number, statement in enumerate(body):
        if isinstance(statement, _NO_STATEMENT):
            continue
        yield f"{number}:{_dropped(statement)}", (*body[:number], *body[number + 1 :])
        behind = body[number + 1] if number + 1 < len(body) else None
        if behind is not None and not isinstance(behind, _NO_STATEMENT) and behind != statement:
            yield f"{number}:neighbours swapped", (*body[:number], behind, statement, *body[number + 2 :])


def _dropped(statement: object) -> str:
    if isinstance(statement, ir.Assign) and isinstance(statement.target, ir.Signal):
        return "output dropped"
    return next((name for kinds, name in _DROPPED if isinstance(statement, kinds)), "other statement dropped")


CHANGES: tuple[Change, ...] = (_numbers, _truth_and_texts, _conditions, _moves, _calls, _bodies)


def mutants(program: ir.Program) -> Iterator[Mutant]:
    """Every mutant of a program, in its order."""
    names = Names(program)
    every = [site for site in sites(program) if site.origin.source is not None]
    for site in every:
        match site.value:
            case ir.Signal(name=str(name), index=None, kind=kind) if name not in names.signals.get(kind, ()):
                names.signals.setdefault(kind, []).append(name)
    for site in every:
        for change in CHANGES:
            for name, value in change(site, names):
                yield _made(site, name, value)


def _made(site: Site, name: str, value: object) -> Mutant:
    number, colon, operator = name.partition(":")
    if not colon or not number.isdigit() or not isinstance(site.value, tuple):
        needs: tuple[ir.Statement, ...] = (site.statement,) if site.statement is not None else ()
        if isinstance(site.value, tuple):
            needs = site.value[:1]
        return Mutant(name, site.path, value, site, needs)
    at = int(number)
    needs = site.value[at : at + (2 if operator == "neighbours swapped" else 1)]
    there = replace(site, origin=getattr(needs[0], "origin", site.origin))
    return Mutant(operator, site.path, value, there, needs)
