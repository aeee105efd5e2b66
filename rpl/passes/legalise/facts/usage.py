"""Who changes what: names assigned anywhere, system variables a routine sets (with what it calls), interrupts.

Conservative and by name: a name that is assigned in one scope counts as assigned in all.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import partial

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.rewrite import visit_parts


def each_statement(body: ir.Body, visit: Callable[[ir.Statement], None]) -> None:
    """Visit every statement of a body, outer before inner."""

    def look(statements: ir.Body) -> None:
        for statement in statements:
            visit(statement)
            visit_parts(statement, _nothing, look)

    look(body)


def each_expression(statement: ir.Statement, visit: Callable[[ir.Expression], None], inner: bool = False) -> None:
    """Visit every expression of a statement, outer before inner; with `inner` also those of its bodies."""

    def look(expression: ir.Expression) -> None:
        visit(expression)
        visit_parts(expression, look)

    def deeper(statements: ir.Body) -> None:
        for one in statements:
            visit_parts(one, look, deeper)

    visit_parts(statement, look, deeper if inner else None)


def _nothing(expression: ir.Expression) -> None:
    """Expressions hold no statements."""


def base_name(lvalue: ir.Expression) -> str | None:
    """The variable an lvalue belongs to, folded."""
    while isinstance(lvalue, ir.Index | ir.Field):
        lvalue = lvalue.base
    return lvalue.id.lower() if isinstance(lvalue, ir.Name) else None


@dataclass(slots=True)
class Usage:
    """Facts about a whole program."""

    assigned: set[str] = field(default_factory=set)
    """Names assigned, used as an output, or passed where they could be changed."""
    otherwise: set[str] = field(default_factory=set)
    """Those of them that something else than an assignment changes."""
    sets: dict[str, set[str]] = field(default_factory=dict)
    """Routine (folded) -> system variables it may set, directly or through calls."""
    interrupting: set[str] = field(default_factory=set)
    """System variables that an interrupt's routine may set."""
    passed: list[tuple[str, int | None, str]] = field(default_factory=list)
    """Variables that are arguments: the routine (folded), the argument's position (None: named), the variable."""


def usage_of(program: ir.Program) -> Usage:
    usage = Usage()
    calls: dict[str, set[str]] = {}
    handlers: set[str] = set()
    inner: list[tuple[ir.Routine, Usage]] = []
    for module in program.modules:
        for declaration in module.declarations:
            if isinstance(declaration, ir.Initialise):
                _assigned(declaration.assign, usage)
        for routine in module.routines:
            key = routine.name.lower()
            usage.sets.setdefault(key, set())
            calls.setdefault(key, set())
            own = Usage(sets=usage.sets)
            inner.append((routine, own))
            visit = partial(_statement, key=key, usage=own, calls=calls, handlers=handlers)
            for body in bodies(routine):
                each_statement(body, visit)
    unchanging = _unchanging(inner)
    for own in (usage, *(one for _, one in inner)):
        usage.otherwise |= own.otherwise | _changed(own, unchanging)
        usage.assigned |= own.assigned
    usage.assigned |= usage.otherwise
    _close(usage.sets, calls)
    for name in handlers:
        usage.interrupting |= usage.sets.get(name, set())
    return usage


def _unchanging(inner: list[tuple[ir.Routine, Usage]]) -> dict[str, frozenset[int]]:
    """Routine (folded) -> positions of arguments that it cannot change, whichever routine of that name: by value, and
    by reference where it only reads them or passes them on to such."""
    found: dict[str, frozenset[int]] = {}
    while True:
        more: dict[str, frozenset[int]] = {}
        for routine, own in inner:
            key, changed = routine.name.lower(), own.assigned | own.otherwise | _changed(own, found)
            kept = frozenset(
                at
                for at, one in enumerate(routine.parameters)
                if one.mode == "value" or one.name.lower() not in changed
            )
            if any(one.optional for one in routine.parameters):
                kept = frozenset()
            more[key] = kept & more.get(key, kept)
        if more == found:
            return found
        found = more


def _changed(own: Usage, unchanging: dict[str, frozenset[int]]) -> set[str]:
    return {name for routine, at, name in own.passed if at is None or at not in unchanging.get(routine, ())}


def assigned_in(*found_in: ir.Body) -> set[str]:
    """Names that the statements assign or pass where they could be changed (not what called routines assign)."""
    usage = Usage()

    def look(statement: ir.Statement) -> None:
        _assigned(statement, usage)
        each_expression(statement, call)

    def call(expression: ir.Expression) -> None:
        if isinstance(expression, ir.Call):
            _arguments(expression.name, expression.arguments, usage)

    for body in found_in:
        each_statement(body, look)
    return usage.assigned | usage.otherwise | _changed(usage, {})


def assigned_below(program: ir.Program) -> dict[str, set[str]]:
    """Routine (folded) -> names that it, or what it calls, assigns or passes where they could be changed."""
    found: dict[str, set[str]] = {}
    calls: dict[str, set[str]] = {}
    procedures = _procedures(program)
    for module in program.modules:
        for routine in module.routines:
            key = routine.name.lower()
            for body in bodies(routine):
                found.setdefault(key, set()).update(assigned_in(body))
            calls.setdefault(key, set()).update(*(_may_call(node, procedures) for node in walk(routine)))
    _close(found, calls)
    return found


def _procedures(program: ir.Program) -> frozenset[str]:
    """What a call by a text may mean, folded."""
    routines = (routine for module in program.modules for routine in module.routines)
    return frozenset(routine.name.lower() for routine in routines if routine.kind == "procedure")


def _may_call(node: object, procedures: frozenset[str]) -> Iterable[str]:
    """The routines (folded) that a node calls or may call."""
    match node:
        case ir.CallRoutine(dynamic=dynamic) if dynamic is not None:
            return procedures
        case ir.CallRoutine(name=name) | ir.Call(name=name):
            return (name.lower(),)
    return ()


def _statement(statement: ir.Statement, key: str, usage: Usage, calls: dict[str, set[str]], handlers: set[str]) -> None:
    _assigned(statement, usage)
    match statement:
        case ir.Assign(target=ir.System(name=name)):
            usage.sets[key].add(name)
        case ir.CallRoutine(name=name):
            calls[key].add(name.lower())
        case ir.DeclareInterrupt(action=ir.CallRoutine(name=name)) | ir.ConnectInterrupt(routine=name):
            handlers.add(name.lower())
            calls[key].add(name.lower())
        case ir.Trigger(action=ir.CallRoutine(name=name)):
            handlers.add(name.lower())

    def call(expression: ir.Expression) -> None:
        if isinstance(expression, ir.Call):
            calls[key].add(expression.name.lower())
            _arguments(expression.name, expression.arguments, usage)

    each_expression(statement, call)


def _assigned(statement: ir.Statement, usage: Usage) -> None:
    """Lvalues of any statement: assignment targets, outputs of built-ins, arguments that may be passed by reference."""
    match statement:
        case ir.Assign(target=target):
            _name(target, usage.assigned)
        case ir.For(counter=counter):
            usage.otherwise.add(counter.lower())
        case ir.CallRoutine(name=name, arguments=arguments):
            _arguments(name, arguments, usage)
        case ir.Do(arguments=values):
            for value in values:
                _name(value, usage.otherwise)
        case ir.Dialog(answer=answer, timed_out=flag):
            _name(answer, usage.otherwise)
            _name(flag, usage.otherwise)
        case ir.WaitUntil(timed_out=flag):
            _name(flag, usage.otherwise)
        case ir.Clock(clock=clock):
            _name(clock, usage.otherwise)
        case ir.DefineTrigger(target=target):
            _name(target, usage.otherwise)
        case ir.Move(search=ir.Search(found=found, hit=hit)):
            _name(found, usage.otherwise)
            _name(hit, usage.otherwise)


def _arguments(name: str, arguments: tuple[ir.Argument, ...], usage: Usage) -> None:
    named = any(argument.name for argument in arguments)
    for at, argument in enumerate(arguments):
        if isinstance(argument.value, ir.Name | ir.Index | ir.Field):
            variable = base_name(argument.value)
            if variable is not None:
                usage.passed.append((name.lower(), None if named else at, variable))


def _name(value: ir.Expression | None, names: set[str]) -> None:
    name = base_name(value) if value is not None else None
    if name is not None:
        names.add(name)


def _close(sets: dict[str, set[str]], calls: dict[str, set[str]]) -> None:
    """Transitive closure over calls."""
    changed = True
    while changed:
        changed = False
        for key, callees in calls.items():
            before = len(sets[key])
            for callee in callees:
                sets[key] |= sets.get(callee, set())
            changed = changed or len(sets[key]) != before


def doing(program: ir.Program, does: Callable[[object], bool]) -> frozenset[str]:
    """The routines (folded names) with a node for which `does` holds, in themselves or in what they call."""
    return doing_each(program, lambda node: ("",) if does(node) else (), ("",))[""]


def doing_each(
    program: ir.Program, does: Callable[[object], Iterable[str]], whats: Iterable[str]
) -> dict[str, frozenset[str]]:
    """For each of `whats`, the routines (folded names) with a node that `does` it, in themselves or in what they
    call."""
    below = done_below(program, does)
    return {what: frozenset(name for name, found in below.items() if what in found) for what in whats}


def done_below(program: ir.Program, does: Callable[[object], Iterable[str]]) -> dict[str, set[str]]:
    """For each routine (folded name) what its nodes do, or those of what it calls."""
    calls: dict[str, set[str]] = {}
    found: dict[str, set[str]] = {}
    procedures = _procedures(program)
    for module in program.modules:
        for routine in module.routines:
            name = routine.name.lower()
            called, done = calls.setdefault(name, set()), found.setdefault(name, set())
            for node in walk(routine):
                called.update(_may_call(node, procedures))
                done.update(does(node))
    _close(found, calls)
    return found


def called_below(program: ir.Program, roots: set[str]) -> frozenset[str]:
    """These routines and all that they call, folded."""
    routines = {routine.name.lower(): routine for module in program.modules for routine in module.routines}
    found, waiting = set(roots), list(roots)
    while waiting:
        routine = routines.get(waiting.pop())
        for node in walk(*bodies(routine)) if routine is not None else ():
            match node:
                case ir.CallRoutine(name=name) | ir.Call(name=name) if name.lower() not in found:
                    found.add(name.lower())
                    waiting.append(name.lower())
    return frozenset(found)


def exposed(program: ir.Program, names: set[str]) -> ir.Program:
    """The program with these routines (folded names) visible outside of their modules, for generated code to call."""
    if not names:
        return program

    def visible(routine: ir.Routine) -> ir.Routine:
        hidden = routine.name.lower() in names and routine.scope == "module"
        return replace(routine, scope="task") if hidden else routine

    modules = tuple(replace(module, routines=tuple(map(visible, module.routines))) for module in program.modules)
    return replace(program, modules=modules)


def called_names(routines: Iterable[ir.Routine]) -> set[str]:
    """Routines that these call as statements, folded."""
    found: set[str] = set()

    def look(statement: ir.Statement) -> None:
        if isinstance(statement, ir.CallRoutine):
            found.add(statement.name.lower())

    for routine in routines:
        for body in bodies(routine):
            each_statement(body, look)
    return found
