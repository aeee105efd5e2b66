"""Tools and user frames by their numbers: what the source keeps as data with a name is a frame of the controller.

Data that nothing assigns and that stands as a tool or frame gets a number of its own, the one that its name says where
it says one; its value goes into the controller's table, not into the programs. A program that moves selects its numbers
before its first move, so that it can be started and its points touched up alone, and none again while it is in force.
What is in force at a move stands at the move, for the points of the listing (UF, UT).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes import rigid
from rpl.passes.fold import Unchanged, constant
from rpl.passes.legalise.context import Context, ProgramScope, rules_of
from rpl.passes.legalise.facts.forward import reactions
from rpl.passes.legalise.facts.modalflow import Flow, in_frame
from rpl.passes.legalise.rewriting.editing import edit_bodies, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.scope import Scope
from rpl.passes.values import pose_of

from .. import tables

HOME = "frames"
_DIGITS = re.compile(r"(\d+)\D*\Z")
_HARMLESS = (ir.Nothing, ir.Wait, ir.WaitUntil, ir.Message, ir.Clock, ir.Assign)

# Data as a program says it, and which declarations its names mean there.
Key = tuple[ir.Expression, tuple[int, ...]]


@legalising(sees=("system tool", "system base"))
def frame_numbers(program: ir.Program, context: Context) -> ir.Program:
    """Tools and frames that nothing assigns are numbers of the controller's tables."""
    if not any(map(_selected, walk(*program.modules))):
        return program
    scopes = ProgramScope(program)
    unchanged = unchanged_in(program)
    made = _tables(program, scopes, unchanged, context)
    modules = []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            numbered = partial(_with_numbers, made, unchanged.assigned, scopes.routine(module, routine))
            routines.append(edit_bodies(routine, numbered))
        modules.append(replace(module, routines=tuple(routines)))
    declared = tuple(map(_declaration, made))
    home = ir.Module(context.fresh(HOME), program.modules[0].dialect, declared, public=True)
    done = selected_once(replace(program, modules=(*modules, home)), context)
    values = tuple(_value(name, number, pose) for name in made for number, pose in made[name].values.items())
    return replace(done, modules=(*done.modules[:-1], replace(home, declarations=(*declared, *values))))


def _with_numbers(made: Mapping[str, _Table], assigned: set[str], scope: Scope, body: ir.Body) -> ir.Body:
    """The statements with numbers for data as a whole; a component of it is looked at in a register, as the controller
    looks at none of its frames."""

    def numbered(expression: ir.Expression) -> ir.Expression | None:
        if _names(expression) & assigned:
            return None  # the program sets it, if only to this value
        numbers = ((name, table.numbers.get(_key(expression, scope))) for name, table in made.items())
        return next((element(name, number) for name, number in numbers if number), None)

    def held(place: ir.Expression) -> ir.Expression:
        """Where a function asks for a tool or work object: the frame of such data."""
        parts = (ir.Field(place, part) for part in ("frame", "user_frame"))
        return next((found for one in parts if (found := numbered(one)) is not None), change(place))

    def change(expression: ir.Expression) -> ir.Expression:
        if isinstance(expression, ir.Builtin) and expression.function == "current_target":
            return replace(expression, arguments=tuple(map(held, expression.arguments)))
        if not isinstance(expression, ir.Field | ir.Name | ir.Index):
            return rewrite_parts(expression, change)
        if (found := numbered(expression)) is not None:
            return found
        base: ir.Expression = expression
        while isinstance(base, ir.Field):
            base = base.base
            if numbered(base) is not None:
                return expression
        return rewrite_parts(expression, change)

    def each(statement: ir.Statement) -> ir.Statement:
        match statement:
            case ir.Assign(target=ir.System(name=name), value=value) if name in made:
                number = made[name].numbers.get(_key(value, scope))
                return statement if number is None else replace(statement, value=element(name, number))
            case ir.Move():
                return statement  # what it goes to is a point or a register, not an element of the table
        return rewrite_parts(statement, change, whole)

    def whole(inner: ir.Body) -> ir.Body:
        return tuple(map(each, inner))

    return whole(body)


def element(name: str, number: int) -> ir.Index:
    """What stands for a number: `UFRAME[2]`. Frame 0 is the world."""
    return ir.Index(ir.Name(tables.SELECTED[name][0]), (ir.IntLiteral(number),))


# ---- which data has a number


@dataclass(slots=True)
class _Table:
    """The numbers of one kind: those of data, and the value behind each."""

    numbers: dict[Key, int] = field(default_factory=dict)
    values: dict[int, rigid.Pose] = field(default_factory=dict)


def _tables(program: ir.Program, scopes: ProgramScope, unchanged: Unchanged, context: Context) -> dict[str, _Table]:
    """The numbers that tools and frames get, in the order in which the program uses them."""
    found: dict[str, dict[Key, rigid.Pose]] = {name: {} for name in tables.SELECTED}
    changing: dict[str, set[Key]] = {name: set() for name in tables.SELECTED}
    world: set[Key] = set()
    for module in program.modules:
        for routine in module.routines:
            scope = scopes.routine(module, routine)
            for node in walk(*bodies(routine)):
                match node:
                    case ir.Assign(target=ir.System(name=name), value=value) if name in found and not _is_none(value):
                        pose = pose_of(constant(value, scope, unchanged)) if _is_shared(value, scope) else None
                        if pose == rigid.IDENTITY and name == "base" and _names(value) & unchanged.assigned:
                            world.add(_key(value, scope))
                        elif pose is None:
                            changing[name].add(_key(value, scope))
                        else:
                            found[name][_key(value, scope)] = pose
    made = {name: _numbered(name, found[name], len(changing[name]), context) for name in tables.SELECTED}
    made["base"].numbers.update(dict.fromkeys(world, 0))
    return made


def _numbered(name: str, found: Mapping[Key, rigid.Pose], changing: int, context: Context) -> _Table:
    """`changing`: as many numbers are left for what the run decides, and one for the flange."""
    bank, most = tables.SELECTED[name]
    earlier = {label: number for (kind, number), label in context.registers.items() if kind == bank}
    there = context.there
    mine = {number for kind, number in context.registers if kind == bank}
    in_use = there.of(bank) - mine
    wanted = {
        key: earlier.get(_label(key)) or there.like(bank, _values(pose)) or _own_number(key)
        for key, pose in found.items()
    }
    table = _Table()
    for key in sorted(found, key=lambda one: not wanted[one]):
        if len(table.values) >= most - 1 - changing:
            break
        own = wanted[key] not in in_use or there.like(bank, _values(found[key])) == wanted[key]
        others = (number for number in range(1, most + 1) if number not in in_use)
        free = (number for number in (wanted[key] if own else 0, *others) if number and number not in table.values)
        number = next((one for one in free if one <= most), 0)
        if not number:
            break
        table.numbers[key], table.values[number] = number, found[key]
        context.register_names[bank, number] = _label(key)
    return table


def _label(key: Key) -> str:
    """The datum's name; an element with its index."""
    names = [node.id for node in walk(key[0]) if isinstance(node, ir.Name)]
    indices = [str(node.value) for node in walk(key[0]) if isinstance(node, ir.IntLiteral)]
    return "".join((*names[:1], *indices)) if names else "frame"


def _own_number(key: Key) -> int:
    """The number that its name ends with, or its index in a table of the source; 0: it says none."""
    found = _DIGITS.search(_label(key))
    return int(found[1]) if found and key[1] else 0


def _is_none(value: ir.Expression) -> bool:
    return isinstance(value, ir.System) and value.name in ("null_frame", "world")


def _key(value: ir.Expression, scope: Scope) -> Key:
    symbols = [scope.value(node.id) for node in walk(value) if isinstance(node, ir.Name)]
    return value, tuple(0 if one is None else id(one.declaration) for one in symbols)


def _names(value: ir.Expression) -> set[str]:
    return {node.id.lower() for node in walk(value) if isinstance(node, ir.Name)}


def _is_shared(value: ir.Expression, scope: Scope) -> bool:
    """Is it of the whole program, not of a routine?"""
    symbols = [scope.value(node.id) for node in walk(value) if isinstance(node, ir.Name)]
    return all(one is not None and one.routine is None for one in symbols)


def _declaration(name: str) -> ir.Variable:
    """The controller's table. Its values come behind it, where it is not taken for data that the program sets."""
    bank, most = tables.SELECTED[name]
    type = ir.ArrayType(ir.PoseType(), (ir.IntLiteral(most),), 1)
    return ir.Variable(bank, type, storage="persistent", scope="global")


def _value(name: str, number: int, pose: rigid.Pose) -> ir.Initialise:
    return ir.Initialise(ir.Assign(element(name, number), _pose(pose)))


def _values(pose: rigid.Pose) -> tuple[float, ...]:
    place = pose.position
    return (place.x, place.y, place.z, *pose.rotation.zyx)


def _pose(pose: rigid.Pose) -> ir.Aggregate:
    parts = zip(ir.POSE, _values(pose), strict=True)
    return ir.Aggregate(tuple((part, ir.RealLiteral(value + 0.0)) for part, value in parts), type_name="pose")


# ---- where it is selected


def selected_once(program: ir.Program, context: Context) -> ir.Program:
    """Each program that moves selects its tool and frame before its first move; what is in force is not selected
    again, and stands at the moves."""
    defaults = dict(rules_of(context.source).system_defaults)
    flow = Flow.of(program, defaults)
    steady = not any(True for _ in reactions(program))
    program = _each_routine(program, lambda one: _selecting(one, flow, steady))
    flow = Flow.of(program, defaults)
    program = _each_routine(program, lambda one: _without_repeated(one, flow))
    last = Flow.of(program, defaults)

    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Move):
            known = last.at(statement)
            tool, frame = (_number(name, known[name]) for name in ("tool", "base"))
            return (replace(statement, tool=statement.tool or tool, frame=statement.frame or frame),)
        return (inside(statement, lambda body: map_body(body, change)),)

    return _each_routine(program, lambda one: edit_bodies(one, lambda body: map_body(body, change)))


def _each_routine(program: ir.Program, work: Callable[[ir.Routine], ir.Routine]) -> ir.Program:
    modules = (replace(one, routines=tuple(map(work, one.routines))) for one in program.modules)
    return replace(program, modules=tuple(modules))


def _number(name: str, value: ir.Expression | None) -> ir.Expression | None:
    """The element of the table that is known to be in force."""
    if value is not None and name == "base" and _is_none(value):
        return element(name, 0)
    match value:
        case ir.Index(base=ir.Name(id=bank)) if bank == tables.SELECTED[name][0]:
            return value
    return None


def _selecting(routine: ir.Routine, flow: Flow, steady: bool) -> ir.Routine:
    """The routine that selects, before its first move, what is in force there by whatever called it; `steady`: nothing
    selects between two statements."""
    nodes = [*walk(routine.body)]
    first = next((node for node in nodes if isinstance(node, ir.Move)), None)
    if first is None:
        return routine
    known = flow.at(first)
    set_before = {_selected(node) for node in nodes[: nodes.index(first)]}
    wanted = [
        ir.Assign(ir.System(name), value)
        for name in tables.SELECTED
        if name not in set_before and (value := _number(name, known[name])) is not None
    ]
    return replace(routine, body=_at_head(_with_first(routine.body, first, wanted), steady))


def _with_first(body: ir.Body, first: ir.Move, wanted: list[ir.Assign]) -> ir.Body:
    """The body with these statements in front of its first move, outside of the blocks that it stands in unless these
    select something."""
    at = next(number for number, one in enumerate(body) if any(node is first for node in walk(one)))
    if body[at] is first or not any(_may_select(node) for node in walk(body[at])):
        return (*body[:at], *wanted, *body[at:])

    def change(statement: ir.Statement) -> ir.Body:
        if statement is first:
            return (*wanted, statement)
        return (inside(statement, lambda inner: map_body(inner, change)),)

    return (*body[:at], *change(body[at]), *body[at + 1 :])


def _at_head(body: ir.Body, steady: bool) -> ir.Body:
    """The body that begins with the numbers it selects first, where only what needs none stands before them."""
    front: list[ir.Statement] = []
    rest: list[ir.Statement] = []
    remarks = next((at for at, one in enumerate(body) if not isinstance(one, ir.Nothing)), 0)
    body, above = body[remarks:], body[:remarks]
    for at, one in enumerate(body if steady else ()):
        name = _selected(one)
        if name and not one.origin.comments and name not in map(_selected, front) and _is_chosen(one):
            front.append(one)
        elif name or not isinstance(one, _HARMLESS) or in_frame(one) or any(map(_calls, walk(one))):
            rest.extend(body[at:])
            break
        else:
            rest.append(one)
    return (*above, *sorted(front, key=lambda one: _selected(one)), *(rest if front else body))


def _selected(node: object) -> str:
    """`tool`, `base`, or nothing: what a statement selects."""
    match node:
        case ir.Assign(target=ir.System(name=name)) if name in tables.SELECTED:
            return name
    return ""


def _is_chosen(one: ir.Statement) -> bool:
    """Is it a constant number that it selects?"""
    return isinstance(one, ir.Assign) and _number(_selected(one), one.value) is not None


def _calls(node: object) -> bool:
    return isinstance(node, ir.Call | ir.CallRoutine)


def _may_select(node: object) -> bool:
    return bool(_selected(node)) or _calls(node) or isinstance(node, ir.Vendor | ir.Opaque)


def _without_repeated(routine: ir.Routine, flow: Flow) -> ir.Routine:
    """The routine without what is in force already; one that needs frames keeps its first selection of each kind."""
    needs = any(isinstance(node, ir.Move) for node in walk(routine.body))
    kept: set[str] = set() if needs else set(tables.SELECTED)

    def change(statement: ir.Statement) -> ir.Body:
        name = _selected(statement)
        if not name:
            return (inside(statement, lambda inner: map_body(inner, change)),)
        assert isinstance(statement, ir.Assign)
        repeated = name in kept and flow.again(statement)
        kept.add(name)
        return (ir.Nothing(origin=statement.origin) if repeated else statement,)

    return edit_bodies(routine, lambda body: map_body(body, change))
