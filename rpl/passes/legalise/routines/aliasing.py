"""Calls by reference that copies cannot stand for, for targets whose routines get copies only.

A routine works on a copy of such an argument, and the caller takes its last value back. That is the same as long as
nobody else sees the variable meanwhile: the routine or what it calls by the variable's own name, a second parameter
that stands for the same place, an interrupt or another task. Where that cannot be ruled out the call is a loss and the
program stops in front of it; everywhere else the copy is exact and nothing is said.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import cast, get_args

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, children
from rpl.passes.capabilities import Parameters, Passing
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.activations import Activations
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.facts.values.heldtexts import HeldTexts, named_by
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.settable import written_places

ALIASED = code(
    "reference-aliased",
    Severity.LOSS,
    "{name} gets {what} by reference, and {reason}; the target passes copies, which would give other values",
    "use one name for it: leave the argument out, or pass a variable of its own and assign it behind the call",
    stops=True,
)
_PARTS = (ir.Index, ir.Field)
_STATEMENTS = tuple(one for one in get_args(ir.Statement) if one is not ir.CallRoutine)
_NONE, _LATER = ir.Nothing(), ir.Nothing()  # no statement yet; something that an interrupt or a place on the path does
Key = int | tuple[int, str]  # a variable's declaration by identity; a parameter by its routine and folded name
Step = int | str | tuple[str, int] | None  # an element, a component, a variable and what is added to it, any element
Steps = tuple[Step, ...]
Place = tuple[Key, Steps]


@legalising(
    unless=lambda context: (
        Passing.REFERENCES in context.capabilities.routines.passing
        and context.capabilities.routines.parameters is Parameters.NAMES
    )
)
def without_shared_references(program: ir.Program, context: Context) -> ir.Program:
    """Guards calls whose arguments by reference are seen under a second name. Only for targets without references."""
    by_reference = any(
        parameter.mode != "value"
        for module in program.modules
        for routine in module.routines
        for parameter in routine.parameters
    )
    if not by_reference:
        return program
    refused = _Facts(program).refused(context)
    if not refused:
        return program

    def change(statement: ir.Statement) -> ir.Body:
        if id(statement) not in refused:
            return (inside(statement, lambda inner: map_body(inner, change)),)
        text = str(statement.origin.text or refused[id(statement)]).strip().partition("\n")[0]
        stop = ir.Vendor(context.source, text, "unknown", origin=statement.origin)
        return (stop, inside(statement, lambda inner: map_body(inner, change))) if blocks(statement) else (stop,)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, lambda body: map_body(body, change))

    return edit_routines(program, context, work)


class _Named:
    """Which routines calls by a computed name may mean: those that its text tells, else each that takes so many
    arguments."""

    def __init__(self, program: ir.Program) -> None:
        self.program = program
        self.routines: list[ir.Routine] | None = None

    def of(self, call: ir.CallRoutine) -> list[ir.Routine]:
        if not call.arguments:
            return []
        if self.routines is None:
            procedures = (one for module in self.program.modules for one in module.routines)
            self.routines = [one for one in procedures if one.kind == "procedure"]
            self.held = HeldTexts.of(self.program)
        told = named_by(call, self.held, {one.name.lower() for one in self.routines})
        meant = [one for one in self.routines if not told or one.name.lower() in told]
        return [one for one in meant if len(one.parameters) == len(call.arguments)]


@dataclass(slots=True)
class _Uses:
    """What a stretch of the program reads and writes, by name or by handing it on; the calls in it."""

    scope: Scope
    named: _Named
    reads: list[Place] = field(default_factory=list)
    writes: list[Place] = field(default_factory=list)
    passed: list[tuple[tuple[int, str], Place]] = field(default_factory=list)
    callees: set[int] = field(default_factory=set)
    dynamic: bool = False
    calls: list[tuple[ir.Statement, ir.Call | ir.CallRoutine]] = field(default_factory=list)
    beside: list[ir.Statement] = field(default_factory=list)

    def look(self, roots: Iterable[object]) -> None:
        stack: list[tuple[object, ir.Statement]] = [(root, _NONE) for root in roots]
        while stack:
            node, around = stack.pop()
            match node:
                case ir.Name() | ir.Index() | ir.Field():
                    place, below = placed(node, self.scope)
                    self.reads.extend(() if place is None else (place,))
                    stack.extend((one, around) for one in below)
                    continue
                case ir.Call() | ir.CallRoutine():
                    around = node if isinstance(node, ir.CallRoutine) and around is not _LATER else around
                    if around is not _LATER:
                        self.calls.append((around, node))
                    stack.extend((one, around) for one in self.called(node))
                    continue
                case ir.DeclareInterrupt() | ir.OrderInterrupt() | ir.Trigger() | ir.DefineTrigger():
                    self.beside.append(node)
                    stack.extend((one, _LATER) for one in children(node))  # its call comes at another time
                    continue
            if isinstance(node, _STATEMENTS):
                around = cast(ir.Statement, node) if around is not _LATER else around
                stack.extend((one, around) for one in self.writing(cast(ir.Statement, node)))
            else:
                stack.extend((one, around) for one in children(node))

    def writing(self, statement: ir.Statement) -> list[object]:
        """Notes what a statement writes; gives what is left to look at."""
        if isinstance(statement, ir.For) and not statement.scoped:
            place, _ = placed(ir.Name(statement.counter), self.scope)
            self.writes.extend(() if place is None else (place,))
        for target in written_places(statement):
            place, _ = placed(target, self.scope)
            self.writes.extend(() if place is None else (place,))
        if isinstance(statement, ir.Assign) and isinstance(statement.target, ir.Name | ir.Index | ir.Field):
            return [statement.value, *placed(statement.target, self.scope)[1]]
        return children(statement)

    def called(self, call: ir.Call | ir.CallRoutine) -> list[object]:
        """Notes a call; gives what is evaluated for it."""
        candidates = self.candidates(call)
        if isinstance(call, ir.CallRoutine) and call.dynamic is not None:
            self.dynamic = True
        else:
            self.callees.update(map(id, candidates))
        if not candidates:
            return children(call)
        left: list[object] = [] if isinstance(call, ir.Call) or call.dynamic is None else [call.dynamic]
        for routine in candidates:
            for parameter, value in paired(routine, call.arguments):
                place, below = placed(value, self.scope)
                if parameter is None or parameter.mode == "value" or place is None:
                    left.append(value)
                    continue
                self.passed.append(((id(routine), parameter.name.lower()), place))
                left.extend(below)
        return left

    def candidates(self, call: ir.Call | ir.CallRoutine) -> list[ir.Routine]:
        """The routines that a call may reach: one, or by a computed name each that takes so many arguments."""
        if isinstance(call, ir.CallRoutine) and call.dynamic is not None:
            return self.named.of(call)
        routine = self.scope.routine(call.name)
        return [] if routine is None else [routine]


class _Facts:
    """Who uses what in a whole program."""

    def __init__(self, program: ir.Program) -> None:
        self.program = program
        self.uses: dict[int, _Uses] = {}
        self.names: dict[int, ir.Routine] = {}
        scopes = ProgramScope(program)
        named = _Named(program)
        for module, routine in scopes.routines():
            uses = self.uses[id(routine)] = _Uses(scopes.routine(module, routine), named)
            self.names[id(routine)] = routine
            for body in bodies(routine):
                uses.look(body)
        self.read = self.parameters([(one.reads, one.passed) for one in self.uses.values()])
        self.written = self.parameters([(one.writes, one.passed) for one in self.uses.values()])
        passed: set[Key] = {key for uses in self.uses.values() for _, (key, _) in uses.passed if isinstance(key, int)}
        wanted = passed - {id(one) for routine in self.names.values() for one in _locals(routine)}
        self.own = {key: self.by_variable((uses,), wanted) for key, uses in self.uses.items()}
        self._reached: dict[int, set[int]] = {}
        self._threads: list[set[int]] | None = None
        self.beside = self.by_variable(self.actions(), wanted)

    def parameters(self, found: list[tuple[list[Place], list[tuple[tuple[int, str], Place]]]]) -> set[Key]:
        """The parameters by reference that are used so, also by handing them on."""
        done: set[Key] = {key for places, _ in found for key, _ in places if isinstance(key, tuple)}
        givers: defaultdict[Key, list[Key]] = defaultdict(list)
        for _, passed in found:
            for parameter, (key, _) in passed:
                if isinstance(key, tuple):
                    givers[parameter].append(key)
        work = list(done)
        while work:
            for key in givers.get(work.pop(), ()):
                if key not in done:
                    done.add(key)
                    work.append(key)
        return done

    def by_variable(self, several: Iterable[_Uses], wanted: set[Key]) -> dict[Key, list[tuple[Steps, bool]]]:
        """Of the variables asked for: which parts are read and written (True)."""
        found: dict[Key, list[tuple[Steps, bool]]] = {}
        for uses in several:
            taken = [(place, False) for place in uses.reads] + [(place, True) for place in uses.writes]
            taken += [(place, False) for parameter, place in uses.passed if parameter in self.read]
            taken += [(place, True) for parameter, place in uses.passed if parameter in self.written]
            for (key, steps), writes in taken:
                if key in wanted:
                    found.setdefault(key, []).append((steps, writes))
        return found

    def actions(self) -> Iterator[_Uses]:
        """What interrupts and points on the path look at and assign themselves."""
        for uses in self.uses.values():
            for statement in uses.beside:
                apart = _Uses(uses.scope, uses.named)
                apart.look(children(statement))
                yield apart

    def reached(self, routine: int) -> set[int]:
        """The routine and all that it calls; a call by a computed name may be of any."""
        if routine not in self._reached:
            found, work = {routine}, [routine]
            while work:
                uses = self.uses.get(work.pop())
                for callee in () if uses is None else self.uses if uses.dynamic else uses.callees:
                    if callee not in found:
                        found.add(callee)
                        work.append(callee)
            self._reached[routine] = found
        return self._reached[routine]

    def uses_of(self, routines: Iterable[int], place: Place) -> set[bool]:
        """Do these routines read (False) or write (True) something of the place by its name?"""
        key, steps = place
        return {
            writes
            for routine in routines
            for other, writes in self.own.get(routine, {}).get(key, ())
            if overlap(steps, other)
        }

    # ---- what cannot be

    def refused(self, context: Context) -> dict[int, str]:
        """Statements (by identity) whose calls copies cannot stand for, with the routine's name; each is reported."""
        found: dict[int, str] = {}
        for key, uses in self.uses.items():
            for statement, call in reversed(uses.calls):
                for routine in uses.candidates(call):
                    why = self.why(key, uses, call, routine) if id(routine) in self.uses else None
                    if why is None:
                        continue
                    found[id(statement)] = routine.name
                    what, reason = why
                    context.diagnostics.report(ALIASED, statement.origin, name=routine.name, what=what, reason=reason)
                    break
        return found

    def why(
        self, caller: int, uses: _Uses, call: ir.Call | ir.CallRoutine, routine: ir.Routine
    ) -> tuple[str, str] | None:
        """The variable and the second way to it; None when there is none."""
        given: list[tuple[tuple[int, str], Place, str]] = []
        for declared, value in paired(routine, call.arguments):
            place, _ = placed(value, uses.scope)
            if declared is not None and declared.mode != "value" and place is not None:
                given.append(((id(routine), declared.name.lower()), place, _called(value)))
        nested = _Uses(uses.scope, uses.named)
        nested.look(argument.value for argument in call.arguments if argument.value is not None)
        inner = {one for callee in nested.callees for one in self.reached(callee)}
        for at, (parameter, here, what) in enumerate(given):
            for other, second, _ in given[:at]:
                shared = here[0] == second[0] and overlap(here[1], second[1], together=not inner)
                if shared and ({parameter, other} & self.written) and self.used(parameter) and self.used(other):
                    return what, f"its parameters {other[1]} and {parameter[1]} may both stand for it"
            if isinstance(here[0], tuple) or not self.used(parameter):
                continue
            if self.clashes(parameter, self.uses_of(self.reached(id(routine)), here)):
                return what, f"{routine.name} or what it calls uses {_base(what)} by its own name"
            if True in self.uses_of(inner, here):
                return what, f"another argument's function changes {_base(what)}"
            if self.clashes(parameter, self.meanwhile(caller, here)):
                return what, f"an interrupt or another task uses {_base(what)} as well"
        return None

    def used(self, parameter: Key) -> bool:
        return parameter in self.read or parameter in self.written

    def clashes(self, parameter: Key, other: set[bool]) -> bool:
        """Does it matter that somebody else reads or writes what the parameter stands for?"""
        return (bool(other) and parameter in self.written) or (True in other and parameter in self.read)

    def meanwhile(self, caller: int, place: Place) -> set[bool]:
        """What interrupts and other tasks than the caller's do with a place."""
        if self._threads is None:
            self._threads = Activations.of(self.program).threads
        mine = [at for at, routines in enumerate(self._threads) if caller in routines]
        others: set[int] = set()
        for at, routines in enumerate(self._threads):
            if mine != [at]:
                others |= routines
        found = self.uses_of(others, place) if len(self._threads) > 1 else set()
        key, steps = place
        return found | {writes for other, writes in self.beside.get(key, ()) if overlap(steps, other)}


def paired(
    routine: ir.Routine, arguments: tuple[ir.Argument, ...]
) -> Iterator[tuple[ir.Parameter | None, ir.Expression]]:
    """The arguments that have a value, with their parameters (None: there is none)."""
    by_name = {one.name.lower(): one for one in routine.parameters}
    required = iter([one for one in routine.parameters if not one.optional])
    for argument in arguments:
        parameter = by_name.get(argument.name.lower()) if argument.name else next(required, None)
        if argument.value is not None:
            yield parameter, argument.value


def placed(value: object, scope: Scope) -> tuple[Place | None, list[object]]:
    """Where an lvalue is, as far as others can see it, and the subscripts in it. A routine's own variables are nobody
    else's, but two parameters may stand for one of them."""
    steps: list[Step] = []
    below: list[object] = []
    while isinstance(value, _PARTS):
        if isinstance(value, ir.Field):
            steps.append(value.name.lower())
        else:
            steps.extend(map(_step, reversed(value.indices)))
            below.extend(value.indices)
        value = value.base
    if not isinstance(value, ir.Name):
        return None, [*below, *([value] if steps else [])]
    symbol = scope.value(value.id)
    if symbol is None or isinstance(symbol.declaration, ir.SignalDeclaration):
        return None, below
    declaration = symbol.declaration
    key: Key = id(declaration)
    if isinstance(declaration, ir.Parameter):
        key = (id(symbol.routine), declaration.name.lower())
    return (key, tuple(reversed(steps))), below


def _step(index: ir.Expression) -> Step:
    """A subscript: a number, a variable with a number added, or anything."""
    match index:
        case ir.IntLiteral(value=number):
            return number
        case ir.Name(id=name):
            return name.lower(), 0
        case ir.Binary(op="+" | "-" as op, left=ir.Name(id=name), right=ir.IntLiteral(value=number)):
            return name.lower(), number if op == "+" else -number
    return None


def overlap(one: Steps, other: Steps, together: bool = False) -> bool:
    """May two parts of a variable have something in common? `together`: both are chosen at the same moment, so that
    `a[i]` and `a[i+1]` are two elements."""
    return all(_same(a, b, together) for a, b in zip(one, other, strict=False))


def _same(one: Step, other: Step, together: bool) -> bool:
    if isinstance(one, tuple) or isinstance(other, tuple):
        return not (together and isinstance(one, tuple) and isinstance(other, tuple) and one[0] == other[0]) or (
            one == other
        )
    return one == other or one is None or other is None


def _locals(routine: ir.Routine) -> Iterator[ir.Variable]:
    """Its variables that each call has anew, so that only the call itself sees them."""
    for one in routine.declarations:
        if isinstance(one, ir.Variable) and one.storage != "persistent":
            yield one


def _base(what: str) -> str:
    return what.partition("[")[0].partition(".")[0]


def _called(value: ir.Expression) -> str:
    """An lvalue in words."""
    parts: list[str] = []
    while isinstance(value, _PARTS):
        parts.append(f".{value.name}" if isinstance(value, ir.Field) else "[..]")
        value = value.base
    return (value.id if isinstance(value, ir.Name) else "a value") + "".join(reversed(parts))
