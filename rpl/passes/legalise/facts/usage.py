"""Who changes what: names assigned anywhere, and what a routine does with what it calls.

Conservative and by name: a name that is assigned in one scope counts as assigned in all.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Set
from dataclasses import dataclass, field, replace
from itertools import chain
from typing import NamedTuple

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.kinds import gathering, holds_none, kinds_within, walk_for
from rpl.passes.rewrite import visit_parts

_BY_TEXT = ""  # among names of called routines: any procedure
_CALLS = frozenset(("Call", "CallRoutine"))
_BESIDE = frozenset(("TaskControl", "DeclareInterrupt", "Trigger", "DefineTrigger", "OnError"))


def each_statement(body: ir.Body, visit: Callable[[ir.Statement], None]) -> None:
    """Visit every statement of a body, outer before inner."""

    def look(statements: ir.Body) -> None:
        for statement in statements:
            visit(statement)
            visit_parts(statement, _nothing, look)

    look(body)


def each_expression(
    statement: ir.Statement,
    visit: Callable[[ir.Expression], None],
    inner: bool = False,
    kinds: Set[str] = frozenset(),
) -> None:
    """Visit every expression of a statement, outer before inner; with `inner` also those of its bodies. kinds: what is
    looked for; a statement that holds none of these is not entered."""
    if holds_none(statement, kinds):
        return

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


class _Change(NamedTuple):
    """A variable (folded) that a statement may change. how: `assigned`, `otherwise`, `passed` to the routine `to` as
    its argument `at` (None: by its name)."""

    name: str
    how: str
    to: str = ""
    at: int | None = None


@dataclass(slots=True)
class Usage:
    """Facts about a whole program."""

    assigned: set[str] = field(default_factory=set)
    """Names assigned, used as an output, or passed where they could be changed."""
    otherwise: set[str] = field(default_factory=set)
    """Those of them that something else than an assignment changes."""
    passed: set[tuple[str, int | None, str]] = field(default_factory=set)
    """Variables that are arguments: the routine (folded), the argument's position (None: named), the variable."""

    def take(self, changes: Iterable[_Change]) -> None:
        for one in changes:
            if one.how == "passed":
                self.passed.add((one.to, one.at, one.name))
            else:
                (self.assigned if one.how == "assigned" else self.otherwise).add(one.name)


def usage_of(program: ir.Program) -> Usage:
    usage = Usage()
    inner: list[tuple[ir.Routine, Usage]] = []
    for module in program.modules:
        for declaration in module.declarations:
            if isinstance(declaration, ir.Initialise):
                usage.take(_changes(declaration.assign))
        for routine in module.routines:
            inner.append((routine, Usage()))
            for statement in chain(*bodies(routine)):
                inner[-1][1].take(_changes(statement))
    unchanging = _unchanging(inner)
    for own in (usage, *(one for _, one in inner)):
        usage.otherwise |= own.otherwise | _changed(own, unchanging)
        usage.assigned |= own.assigned
    usage.assigned |= usage.otherwise
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
    return {one.name for body in found_in for statement in body for one in _changes(statement)}


def written_in(routine: ir.Routine) -> set[str]:
    """Names (folded) that a routine writes itself, not by passing them on: assigned, counted, answered, found."""
    statements = chain(*bodies(routine))
    return {one.name for statement in statements for one in _changes(statement) if one.how != "passed"}


def assigned_below(program: ir.Program) -> dict[str, set[str]]:
    """Routine (folded) -> names that it, or what it calls, assigns or passes where they could be changed."""
    return done_below(program, lambda statement: (one.name for one in _changes(statement)))


def done_below(program: ir.Program, does: Callable[[ir.Statement], Iterable[str]]) -> dict[str, set[str]]:
    """For each routine (folded name) what its statements do, or those of what it calls. does: what one does with all
    that is in it."""
    found: dict[str, set[str]] = {}
    for routine in _routines(program):
        done = found.setdefault(routine.name.lower(), set())
        done.update(*(does(statement) for statement in chain(*bodies(routine))))
    return _below(program, found)


def _below(program: ir.Program, found: dict[str, set[str]]) -> dict[str, set[str]]:
    """What routines do with what they call, by what they do themselves."""
    calls: dict[str, set[str]] = {}
    procedures = _procedures(program)
    for routine in _routines(program):
        called = calls.setdefault(routine.name.lower(), set())
        called.update(*map(_called, chain(*bodies(routine))))
        if _BY_TEXT in called:
            called |= procedures
    _close(found, calls)
    return found


def _routines(program: ir.Program) -> Iterator[ir.Routine]:
    return (routine for module in program.modules for routine in module.routines)


def _procedures(program: ir.Program) -> frozenset[str]:
    """What a call by a text may mean, folded."""
    return frozenset(routine.name.lower() for routine in _routines(program) if routine.kind == "procedure")


@gathering("Call", "CallRoutine")
def _called(statement: ir.Statement) -> Iterable[str]:
    """The routines (folded) that a statement calls; _BY_TEXT: by a text."""
    match statement:
        case ir.CallRoutine(dynamic=dynamic) if dynamic is not None:
            yield _BY_TEXT
        case ir.CallRoutine(name=name):
            yield name.lower()
    yield from (call.name.lower() for call in _functions(statement))


@gathering(
    *("Assign", "For", "Call", "CallRoutine", "Do", "Dialog", "WaitUntil", "Clock", "DefineTrigger", "Search"),
)
def _changes(statement: ir.Statement) -> Iterable[_Change]:
    """Lvalues of any statement: assignment targets, outputs of built-ins, arguments that may be passed by reference."""
    match statement:
        case ir.Assign(target=target):
            yield from _named("assigned", target)
        case ir.For(counter=counter):
            yield _Change(counter.lower(), "otherwise")
        case ir.CallRoutine(name=name, arguments=arguments):
            yield from _passed(name, arguments)
        case ir.Do(arguments=values):
            yield from _named("otherwise", *values)
        case ir.Dialog(answer=answer, timed_out=flag):
            yield from _named("otherwise", answer, flag)
        case ir.WaitUntil(timed_out=flag):
            yield from _named("otherwise", flag)
        case ir.Clock(clock=clock):
            yield from _named("otherwise", clock)
        case ir.DefineTrigger(target=target):
            yield from _named("otherwise", target)
        case ir.Move(search=ir.Search(found=found, hit=hit)):
            yield from _named("otherwise", found, hit)
    for call in _functions(statement):
        yield from _passed(call.name, call.arguments)


def _functions(statement: ir.Statement) -> list[ir.Call]:
    """The calls in the expressions of a statement itself."""
    found: list[ir.Call] = []
    if "Call" in kinds_within(statement):
        each_expression(statement, lambda one: found.append(one) if isinstance(one, ir.Call) else None)
    return found


def _passed(name: str, arguments: tuple[ir.Argument, ...]) -> Iterable[_Change]:
    named = any(argument.name for argument in arguments)
    for at, argument in enumerate(arguments):
        if isinstance(argument.value, ir.Name | ir.Index | ir.Field):
            variable = base_name(argument.value)
            if variable is not None:
                yield _Change(variable, "passed", name.lower(), None if named else at)


def _named(how: str, *values: ir.Expression | None) -> Iterable[_Change]:
    for value in values:
        name = base_name(value) if value is not None else None
        if name is not None:
            yield _Change(name, how)


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
    found: dict[str, set[str]] = {}
    for routine in _routines(program):
        found.setdefault(routine.name.lower(), set()).update(("",) if any(map(does, walk(routine))) else ())
    return frozenset(name for name, done in _below(program, found).items() if done)


def called_below(program: ir.Program, roots: set[str]) -> frozenset[str]:
    """These routines and all that they call, folded."""
    routines = {routine.name.lower(): routine for module in program.modules for routine in module.routines}
    found, waiting = set(roots), list(roots)
    while waiting:
        routine = routines.get(waiting.pop())
        for node in walk_for(_CALLS, *bodies(routine)) if routine is not None else ():
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


def given_by_reference(program: ir.Program, *roots: object) -> set[str]:
    """Folded names of variables that calls below these nodes (without any: of the whole program) give as they are, so
    that the called routine may change them. What no routine of the program takes is given so, too."""
    modes = {one.name.lower(): [each.mode for each in one.parameters] for one in _routines(program)}
    found: set[str] = set()
    for call in walk_for(_CALLS, *(roots or program.modules)):
        if not isinstance(call, ir.Call | ir.CallRoutine):
            continue
        taken = modes.get(call.name.lower(), [])
        for at, one in enumerate(call.arguments):
            by_value = at < len(taken) and not one.name and taken[at] == "value"
            if not by_value and isinstance(one.value, ir.Name):
                found.add(one.value.id.lower())
    return found


def given_beside(routine: ir.Routine) -> set[str]:
    """Folded names that a routine gives to what runs at another time: tasks, interrupts, errors and places on the
    path. They may change at any time."""
    given = tuple(walk_for(_BESIDE, routine))
    return {node.id.lower() for node in walk(given) if isinstance(node, ir.Name)} if given else set()


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
