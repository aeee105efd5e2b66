"""A variable that only holds the way by which places are moved (INFORM `SETE P010 (1) D000` in front of SFTON), for
targets whose moves say such a way in numbers (`Offs(corner,column*140,row*120,layer*70)`).

Its components are set once, one behind the other, and nothing else looks at it: they stand in the moves themselves. It
is emptied in front of them, or in another routine (TP `PR[11]=LPOS-LPOS` at the start).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context, ProgramScope
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.paths.movebefore import MovesBefore
from rpl.passes.legalise.rewriting.unreaddata import without_unread
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.scope import Scope

_PARTS = ("x", "y", "z")
_ZERO = ir.RealLiteral(0.0)


@legalising(
    unless=lambda context: "offset" not in context.capabilities.functions or context.capabilities.places.move_functions,
    sees=("function offset",),
)
def ways_as_numbers(program: ir.Program, context: Context) -> ir.Program:
    """Where what the components are worked out of stays as it is up to the last move."""
    named = Counter(one.id.lower() for one in walk_for({"Name"}, *program.modules) if isinstance(one, ir.Name))
    scopes, before = ProgramScope(program), MovesBefore(program, unchanged_in(program))
    gone: set[int] = set()  # declarations, by identity
    emptied = _emptied(program)
    modules = []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            if not any(bodies(routine)[1:]):
                routine = _written(routine, scopes.routine(module, routine), named, before, emptied, gone)
            routines.append(routine)
        modules.append(replace(module, routines=tuple(routines)))
    done = replace(program, modules=tuple(_without(module, gone) for module in modules))
    return without_unread(done, emptied.keys())


def _emptied(program: ir.Program) -> Counter[str]:
    """Variables (folded names) that are never set as a whole but to nothing, and begin with nothing if with a value:
    how often they are emptied by what names nothing else."""
    found, filled = Counter[str](), set[str]()
    for node in walk_for({"Assign", "Variable"}, *program.modules):
        match node:
            case ir.Assign(target=ir.Name(id=name), value=value):
                if _names_nothing(value):
                    found[name.lower()] += 1
                else:
                    filled.add(name.lower())
            case ir.Variable(name=name, initial=value) if value is not None and not _names_nothing(value):
                filled.add(name.lower())
    return Counter({name: times for name, times in found.items() if name not in filled})


def _names_nothing(value: ir.Expression) -> bool:
    """A place without a way: a written one, or the robot's less itself."""
    match value:
        case ir.Builtin(function="element_difference", arguments=(one, other)):
            return one == other and not any(isinstance(node, ir.Call | ir.Name) for node in walk((one,)))
        case ir.Aggregate():
            return _is_nothing(value, "")
    return False


def _without(module: ir.Module, gone: set[int]) -> ir.Module:
    routines = tuple(
        replace(one, declarations=tuple(each for each in one.declarations if id(each) not in gone))
        for one in module.routines
    )
    declarations = tuple(one for one in module.declarations if id(one) not in gone)
    return replace(module, declarations=declarations, routines=routines)


@dataclass(frozen=True, slots=True)
class _Way:
    """The statements from `first` up to `behind` set the components of a variable. `name`: folded; `shown`: as it is
    written. `elsewhere`: how often it is named where other statements empty it."""

    name: str
    shown: str
    first: int
    behind: int
    parts: Mapping[str, ir.Expression]
    elsewhere: int = 0


def _written(
    routine: ir.Routine,
    scope: Scope,
    named: Counter[str],
    before: MovesBefore,
    emptied: Counter[str],
    gone: set[int],
) -> ir.Routine:
    body = routine.body
    at = 0
    while at < len(body):
        way = _way(body, at) or _way_set(body, at, emptied)
        if way is not None and _is_only_a_way(way, body, scope, named, before):
            kept = [ir.Nothing(origin=one.origin) for one in body[at : way.behind] if one.origin.comments]
            body = (*body[:at], *kept, *(_moved(one, way) for one in body[way.behind :]))
            at += len(kept)
            symbol = scope.value(way.shown)
            if symbol is not None and not way.elsewhere:
                gone.add(id(symbol.declaration))
        else:
            at += 1
    return routine if body is routine.body else replace(routine, body=body)


def _way(body: ir.Body, at: int) -> _Way | None:
    """A variable that is emptied here and whose components are set behind that."""
    match body[at]:
        case ir.Assign(target=ir.Name(id=name), value=value) if _is_nothing(value, name):
            pass
        case _:
            return None
    behind, parts = _parts_set(body, at + 1, name)
    return _Way(name.lower(), name, at, behind, parts) if parts else None


def _way_set(body: ir.Body, at: int, emptied: Counter[str]) -> _Way | None:
    """A variable that is emptied elsewhere and whose components are set here, where no jump comes past and nothing that
    is called later empties it."""
    match body[at]:
        case ir.Assign(target=ir.Field(base=ir.Name(id=name))) if emptied[name.lower()]:
            behind, parts = _parts_set(body, at, name)
        case _:
            return None
    jumps = any(isinstance(node, ir.Goto) for node in walk(*body[:at]))
    calls = any(isinstance(node, ir.CallRoutine | ir.Call) for node in walk(*body[behind:]))
    if jumps or calls or not parts:
        return None
    return _Way(name.lower(), name, at, behind, parts, emptied[name.lower()])


def _parts_set(body: ir.Body, at: int, name: str) -> tuple[int, dict[str, ir.Expression]]:
    """What the statements from here on set x, y and z of a variable to, and which is the first that does not."""
    parts: dict[str, ir.Expression] = {}
    for behind in range(at, len(body) + 1):
        match body[behind] if behind < len(body) else None:
            case ir.Assign(target=ir.Field(base=ir.Name(id=one), name=part), value=value) if (
                one.lower() == name.lower() and part in _PARTS and part not in parts
            ):
                parts[part] = value
            case _:
                break
    return behind, parts


def _is_nothing(value: ir.Expression, name: str) -> bool:
    match value:
        case ir.Builtin(function="element_difference", arguments=(ir.Name(id=one), ir.Name(id=other))):
            return one.lower() == other.lower() == name.lower()
        case ir.Aggregate(entries=entries):
            return all(isinstance(one, ir.IntLiteral | ir.RealLiteral) and one.value == 0 for _, one in entries)
    return False


def _is_only_a_way(way: _Way, body: ir.Body, scope: Scope, named: Counter[str], before: MovesBefore) -> bool:
    symbol = scope.value(way.shown)
    if symbol is None or isinstance(symbol.declaration, ir.Parameter):
        return False
    rest = body[way.behind :]
    set_here = sum(
        isinstance(one, ir.Name) and one.id.lower() == way.name for one in walk(*body[way.first : way.behind])
    )
    used = sum(_uses(one, way.name) for one in walk(*rest))
    if (
        not used
        or set_here + used + way.elsewhere != named[way.name]
        or any(_asks(one, way) for one in way.parts.values())
    ):
        return False
    return not any(before.may_change(one, rest, scope) for one in way.parts.values())


def _asks(value: ir.Expression, way: _Way) -> bool:
    """Does a component rest on what is another one when it is looked at later, or on the variable itself?"""
    for node in walk((value,)):
        match node:
            case ir.Call() | ir.Signal() | ir.System() | ir.VendorValue() | ir.Builtin():
                return True
            case ir.Name(id=name) if name.lower() == way.name:
                return True
    return False


def _uses(node: object, name: str) -> int:
    """How often a move is moved by the variable."""
    match node:
        case ir.Builtin(function="offset", arguments=(_, *numbers)):
            return sum(_part(one, name) is not None for one in numbers)
    return 0


def _part(value: ir.Expression, name: str) -> str | None:
    match value:
        case ir.Field(base=ir.Name(id=one), name=part) if one.lower() == name and part in _PARTS:
            return part
    return None


def _moved(statement: ir.Statement, way: _Way) -> ir.Statement:
    def change(value: ir.Expression) -> ir.Expression:
        done = rewrite_parts(value, change)
        if not isinstance(done, ir.Builtin) or not _uses(done, way.name):
            return done
        numbers = [
            one if (part := _part(one, way.name)) is None else way.parts.get(part, _ZERO) for one in done.arguments[1:]
        ]
        return replace(done, arguments=(done.arguments[0], *numbers))

    def work(one: ir.Statement) -> ir.Statement:
        return rewrite_parts(one, change, lambda body: tuple(work(inner) for inner in body))

    return work(statement)


__all__ = ["ways_as_numbers"]
