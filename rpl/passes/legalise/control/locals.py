"""Variables of routines as variables of their module, for targets whose routines have none.

What the routine declared with a value gets it where the routine begins. Calls by which a routine comes to itself are
refused: its variables are those of both activations.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.capabilities import Local, Parameters, RoutineRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.activations import Activations, called
from rpl.passes.legalise.rewriting.beside import tidy
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.stopping import stopped
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts

RECURSION = code(
    "recursion-lost",
    Severity.LOSS,
    "{name} calls itself, directly or through others; the target's routines cannot be active twice",
    "write it as a loop, with an array for what each round has to keep",
    stops=True,
)
SHARED = code(
    "variables-shared",
    Severity.WARNING,
    "{name} runs for an interrupt or another task as well as for the program, and its variables are the same in both",
)


@legalising(
    unless=lambda context: (
        Local.VARIABLES in context.capabilities.routines.locals
        and RoutineRule.RECURSION in context.capabilities.routines.rules
        and (context.capabilities.routines.parameters is Parameters.NAMES)
    )
)
def variables_of_routines(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose routines have no variables, or cannot call themselves."""
    can = context.capabilities
    facts = Activations.of(program)
    again: set[int] = set()
    for key, routine in facts.routines.items():
        shares = (Local.VARIABLES not in can.routines.locals and _variables(routine)) or (
            can.routines.parameters is Parameters.NONE and bool(routine.parameters)
        )
        if key in facts.recursive and (shares or RoutineRule.RECURSION not in can.routines.rules):
            again.add(key)
        elif key in facts.beside and shares:
            context.diagnostics.report(SHARED, routine.origin, name=routine.name)
    if again:
        program = edit_routines(program, context, lambda editor, routine: _guarded(editor, routine, facts, again))
    return program if Local.VARIABLES in can.routines.locals else _moved(program, context)


def _variables(routine: ir.Routine) -> bool:
    return any(isinstance(one, ir.Variable) and one.storage == "variable" for one in routine.declarations)


def _guarded(editor: Editor, routine: ir.Routine, facts: Activations, again: set[int]) -> ir.Routine:
    """The routine with stops in place of calls that would activate one of `again` a second time. What else has become
    of a statement with such a call goes, if that is only values."""

    def change(statement: ir.Statement) -> ir.Body:
        callee = next(filter(comes_back, called(statement, editor.scope)), None)
        if callee is not None:
            return (stopped(statement, RECURSION, editor.context, name=callee.name),)
        return (inside(statement, each),)

    def each(body: ir.Body) -> ir.Body:
        return _whole(map_body(body, change))

    def comes_back(callee: ir.Routine) -> bool:
        return id(callee) in again and id(routine) in facts.reached({id(callee)})

    if id(routine) not in facts.recursive:
        return routine
    return edit_bodies(routine, each)


def _whole(body: ir.Body) -> ir.Body:
    """Without the values that a stop has no use for: those of the statement that it stands for."""
    stops = [one.origin for one in body if isinstance(one, ir.Opaque) and one.origin.source is not None]
    done = body
    for stop in stops:
        parts = [one for one in body if (one.origin.source, one.origin.start) == (stop.source, stop.start)]
        if all(isinstance(one, ir.Opaque | ir.Return) or _sets_name(one) for one in parts):
            gone = {id(one) for one in parts if _sets_name(one) and not one.origin.comments}
            done = tuple(one for one in done if id(one) not in gone)
    return done


def _sets_name(statement: ir.Statement) -> bool:
    return isinstance(statement, ir.Assign) and isinstance(statement.target, ir.Name)


# ---- variables


def _moved(program: ir.Program, context: Context) -> ir.Program:
    """The program with the variables of routines in their modules."""
    used = Counter(
        one.name.lower()
        for module in program.modules
        for declarations in (module.declarations, *(routine.declarations for routine in module.routines))
        for one in declarations
        if isinstance(one, ir.Variable | ir.SignalDeclaration | ir.EnumDeclaration | ir.RecordDeclaration)
    )
    used.update(routine.name.lower() for module in program.modules for routine in module.routines)
    modules = []
    for module in program.modules:
        routines, made = [], []
        for routine in module.routines:
            done, own = _without_variables(routine, used, context)
            routines.append(done)
            made.extend(own)
        modules.append(
            module
            if not made
            else replace(module, declarations=(*module.declarations, *made), routines=tuple(routines))
        )
    return replace(program, modules=tuple(modules))


def _without_variables(
    routine: ir.Routine, used: Counter[str], context: Context
) -> tuple[ir.Routine, list[ir.Declaration]]:
    names: dict[str, str] = {}
    made: list[ir.Declaration] = []
    kept: list[ir.Declaration] = []
    start: list[ir.Statement] = []
    parameters = {one.name.lower() for one in routine.parameters}
    for one in routine.declarations:
        if not isinstance(one, ir.Variable) or one.name.lower() in parameters:
            kept.append(one)
            continue
        name = one.name if used[one.name.lower()] == 1 else context.fresh(f"{routine.name}_{one.name}")
        if name != one.name:
            names[one.name.lower()] = name
        fixed = one.storage != "variable"
        made.append(replace(one, name=name, scope="module", initial=one.initial if fixed else None))
        if one.initial is not None and not fixed:
            start.append(ir.Assign(ir.Name(name), one.initial, origin=tidy(one.origin)))
    if not made:
        return routine, []
    done = replace(routine, declarations=tuple(kept), body=(*start, *routine.body))
    made = [_renamed_declaration(one, names) for one in made]
    return edit_bodies(done, lambda body: renamed(body, names)), made


def _renamed_declaration(declaration: ir.Declaration, names: dict[str, str]) -> ir.Declaration:
    return rewrite_parts(declaration, lambda one: _name(one, names)) if names else declaration


def _name(expression: ir.Expression, names: dict[str, str]) -> ir.Expression:
    if isinstance(expression, ir.Name) and expression.id.lower() in names:
        return replace(expression, id=names[expression.id.lower()])
    return rewrite_parts(expression, lambda one: _name(one, names))


def renamed(body: ir.Body, names: dict[str, str]) -> ir.Body:
    if not names:
        return body

    def statement(one: ir.Statement) -> ir.Statement:
        if isinstance(one, ir.For) and not one.scoped and one.counter.lower() in names:
            one = replace(one, counter=names[one.counter.lower()])
        return rewrite_parts(one, lambda part: _name(part, names), lambda inner: tuple(map(statement, inner)))

    return tuple(map(statement, body))
