"""Tools and user frames by their numbers: what the source keeps as data with a name is a frame of the controller.

Data that nothing assigns and that stands as a tool or frame gets a number of its own, the one that its name says where
it says one; its value goes into the controller's table, not into the programs. A program that moves selects its numbers
before its first move, so that it can be started and its points touched up alone, and none again while it is in force.
What is in force at a move stands at the move, for the points of the listing (UF, UT).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import partial

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context, ProgramScope, rules_of
from rpl.passes.legalise.facts.forward import reactions
from rpl.passes.legalise.facts.settingsinforce import SettingsInForce, in_frame
from rpl.passes.legalise.facts.values.framenumbers import Table, is_none, key_of, names_in, tables_of
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_bodies, edit_each, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.scope import Scope

from .. import tables

HOME = "frames"
_HARMLESS = (ir.Nothing, ir.Wait, ir.WaitUntil, ir.Message, ir.Clock, ir.Assign)


@legalising(sees=("system tool", "system base"))
def frame_numbers(program: ir.Program, context: Context) -> ir.Program:
    """Tools and frames that nothing assigns are numbers of the controller's tables."""
    if not any(map(_selected, walk_for({"Assign"}, *program.modules))):
        return program
    scopes = ProgramScope(program)
    unchanged = unchanged_in(program)
    made = tables_of(_selections(program, scopes), tables.SELECTED, unchanged, context)
    modules = []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            numbered = partial(_with_numbers, made, unchanged.assigned, scopes.routine(module, routine))
            routines.append(edit_bodies(routine, numbered))
        modules.append(replace(module, routines=tuple(routines)))
    declared = tuple(table.declaration() for table in made.values())
    home = ir.Module(context.fresh(HOME), program.modules[0].dialect, declared, public=True)
    done = selected_once(replace(program, modules=(*modules, home)), context)
    values = tuple(one for table in made.values() for one in table.initials())
    return replace(done, modules=(*done.modules[:-1], replace(home, declarations=(*declared, *values))))


def _with_numbers(made: Mapping[str, Table], assigned: set[str], scope: Scope, body: ir.Body) -> ir.Body:
    """The statements with numbers for data as a whole; a component of it is looked at in a register, as the controller
    looks at none of its frames."""

    def numbered(expression: ir.Expression) -> ir.Expression | None:
        if names_in(expression) & assigned:
            return None  # the program sets it, if only to this value
        numbers = ((name, table.numbers.get(key_of(expression, scope))) for name, table in made.items())
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
                number = made[name].numbers.get(key_of(value, scope))
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


def _selections(program: ir.Program, scopes: ProgramScope) -> Iterator[tuple[str, ir.Expression, Scope]]:
    for module in program.modules:
        for routine in module.routines:
            scope = scopes.routine(module, routine)
            for node in walk_for({"Assign"}, *bodies(routine)):
                match node:
                    case ir.Assign(target=ir.System(name=name), value=value) if name in tables.SELECTED:
                        yield name, value, scope


# ---- where it is selected


def selected_once(program: ir.Program, context: Context) -> ir.Program:
    """Each program that moves selects its tool and frame before its first move; what is in force is not selected
    again, and stands at the moves."""
    defaults = dict(rules_of(context.source).system_defaults)
    flow = SettingsInForce.of(program, defaults)
    steady = not any(True for _ in reactions(program))
    selecting = edit_each(program, lambda _, one: _selecting(one, flow, steady))
    here = flow if selecting is program else SettingsInForce.of(selecting, defaults)
    program = edit_each(selecting, lambda _, one: _without_repeated(one, here))
    last = here if program is selecting else SettingsInForce.of(program, defaults)

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
    if value is not None and name == "base" and is_none(value):
        return element(name, 0)
    match value:
        case ir.Index(base=ir.Name(id=bank)) if bank == tables.SELECTED[name][0]:
            return value
    return None


def _selecting(routine: ir.Routine, flow: SettingsInForce, steady: bool) -> ir.Routine:
    """The routine that selects, before its first move, what is in force there by whatever called it; `steady`: nothing
    selects between two statements."""
    nodes = [*walk_for({"Move", "Assign"}, routine.body)]
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


def _without_repeated(routine: ir.Routine, flow: SettingsInForce) -> ir.Routine:
    """The routine without what is in force already; one that needs frames keeps its first selection of each kind."""
    needs = any(isinstance(node, ir.Move) for node in walk_for({"Move"}, routine.body))
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
