"""What the beginning of a program sets once and for all: tools and frames that it works out before it uses them.

The statements that a run begins with are carried out here as far as everything in them is constant: assignments,
branches, loops that count, calls with their arguments. Kept data has no value until the program gives it one, so that
what is found holds at each start. A variable, or an array's element, is settled when all its assignments stand in that
beginning, each has the same constant value, and nothing reads it before. Elements that nothing sets keep their first
value.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import chain

from rpl import ir
from rpl.ir.walk import bodies, rewrite, walk
from rpl.passes import rigid
from rpl.passes.fold import Unchanged, Value, constant
from rpl.passes.legalise.facts.entries import calls_of, moving_entries, reached, routines_beside
from rpl.passes.legalise.facts.usage import assigned_below, assigned_in, base_name, usage_of
from rpl.passes.legalise.kinds import gathering, kinds_in_routine, walk_for
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.values import Target, component, literal

# A variable of a container (0: the program's data) with indices and components; the last is empty for a whole value.
Place = tuple[int, str, tuple[int, ...], str]
Settled = dict[tuple[str, tuple[int, ...]], Value]

_MODAL = ("tool", "base")
_NAMING = frozenset(("CallRoutine", "Call", "ConnectInterrupt", "TaskControl", "OnError"))
_MOVING = frozenset(("Move", "MoveExternal", "Spline"))
_MOST_STEPS = 2000  # statements carried out; a longer beginning is no preparation
_MOST_ELEMENTS = 100  # of an array whose first values are looked at
_PLAIN = (ir.Nothing, ir.Message, ir.Wait, ir.WaitUntil, ir.WaitForMotion, ir.LookAhead, ir.Pulse, ir.Clock)
_ACTIONS = (
    *(ir.Move, ir.MoveExternal, ir.Spline, ir.Opaque, ir.Vendor, ir.While, ir.Loop, ir.Repeat, ir.For, ir.Switch),
    *(ir.TaskControl, ir.DeclareInterrupt, ir.ConnectInterrupt, ir.OnError),
)
_LEAVING = (ir.Goto, ir.Return, ir.ExitLoop, ir.NextPass, ir.Halt, ir.Raise, ir.Retry, ir.TryNext)


def settled_at_start(program: ir.Program, unchanged: Unchanged, places: bool = False) -> Settled:
    """Values of global variables, (folded name, indices of an element), that hold from their first use on: of those
    that tool and frame are taken from; `places`: and where moves go."""
    wanted = _wanted(program, places) & unchanged.assigned
    if not wanted:
        return {}
    wanted -= _changed_otherwise(program, wanted)
    start = _Start(program, unchanged, wanted)
    roots = _moving_roots(program)
    found = [(module, one) for module, one in start.scopes.routines() if one.name.lower() in roots]
    if wanted and len(found) == 1 and not any(handler.body for handler in found[0][1].handlers):
        with suppress(_EndError):  # what comes behind depends on the run
            start.body(found[0][1].body, _Level(start.scopes.routine(*found[0]), 1, True))
    statements = start.all_assignments()
    return start.untouched(statements) | start.settled(statements)


def _wanted(program: ir.Program, places: bool) -> set[str]:
    """Variables that tool and frame are taken from, and `places`."""
    asked = {"frame", "place"} if places else {"frame"}
    return {
        name
        for module in program.modules
        for routine in module.routines
        for statement in chain(*bodies(routine))
        for what, name in _taken_from(statement)
        if what in asked
    }


@gathering("Move", "system tool", "system base")
def _taken_from(statement: ir.Statement) -> Iterator[tuple[str, str]]:
    """Variables that a statement takes a tool or frame (`frame`) or the goal of a move (`place`) from."""
    match statement:
        case ir.Assign(target=ir.System(name=name), value=value) if name in _MODAL:
            parts: tuple[tuple[str, ir.Expression | None], ...] = (("frame", value),)
        case ir.Move(tool=tool, frame=frame, target=target):
            parts = ("frame", tool), ("frame", frame), ("place", target)
        case _:
            return
    for what, part in parts:
        yield from ((what, one.id.lower()) for one in walk(part) if isinstance(one, ir.Name))


def _moving_roots(program: ir.Program) -> set[str]:
    """Where a run may begin that moves the robot."""
    moving = {
        routine.name.lower()
        for module in program.modules
        for routine in module.routines
        if not _MOVING.isdisjoint(kinds_in_routine(routine))
    }
    calls = calls_of(program)
    return {root for root in moving_entries(program) if not reached(root, calls).isdisjoint(moving)}


def _changed_otherwise(program: ir.Program, wanted: set[str]) -> set[str]:
    """What else than a plain assignment in a routine may change, or a program beside this one."""

    def without(node: object) -> object:
        plain = isinstance(node, ir.Assign) and base_name(node.target) in wanted
        return ir.Nothing() if plain else node

    found = usage_of(rewrite(program, without)).assigned
    below, beside = assigned_below(program), routines_beside(program)
    return found.union(*(below.get(name, set()) for name in beside))


class _EndError(Exception):
    """The beginning ends here: what follows is not known."""


@dataclass(frozen=True, slots=True)
class _Level:
    """A routine that is carried out. `number`: of its own data; `once`: does only this beginning run its statements?"""

    scope: Scope
    number: int
    once: bool


@dataclass(slots=True)
class _Start:
    program: ir.Program
    unchanged: Unchanged
    wanted: set[str]
    scopes: ProgramScope = field(init=False)
    known: dict[Place, Value] = field(default_factory=dict)
    made: dict[int, list[Value | None]] = field(default_factory=dict)  # values by the identity of their assignment
    done: dict[tuple[str, tuple[int, ...]], set[int]] = field(default_factory=dict)  # assignments made, by element
    early: set[tuple[str, tuple[int, ...] | None]] = field(default_factory=set)  # read before; None: any element
    steps: int = 0
    levels: int = 1
    returned: Value | None = None  # by the function that ended last
    unsure: set[str] = field(init=False)
    sites: dict[str, int] = field(init=False)

    def __post_init__(self) -> None:
        self.scopes = ProgramScope(self.program)
        below = assigned_below(self.program)
        self.unsure = set().union(*(below.get(name, set()) for name in routines_beside(self.program)))
        self.sites = _sites(self.program)

    # ---- statements

    def body(self, body: ir.Body, level: _Level) -> str:
        """Carry it out; the way it was left: empty text at its end, `exit`, `next`, `return`."""
        for statement in body:
            self.steps += 1
            if self.steps > _MOST_STEPS:
                raise _EndError
            if left := self.statement(statement, level):
                return left
        return ""

    def statement(self, statement: ir.Statement, level: _Level) -> str:
        match statement:
            case ir.Assign():
                self.assign(statement, level)
            case ir.CallRoutine(dynamic=None):
                self.call(statement, level)
            case ir.If(branches=branches, otherwise=otherwise):
                return self.choice(branches, otherwise, level)
            case ir.While() | ir.Repeat() | ir.Loop():
                return self.loop(statement, level)
            case ir.For():
                self.counted(statement, level)
            case ir.Return(value=value):
                self.returned = None if value is None else self.value(value, level)
                return "return"
            case ir.ExitLoop():
                return "exit"
            case ir.NextPass():
                return "next"
            case ir.Label():
                self.known.clear()
            case ir.Vendor(effect=effect) if effect != "unknown":
                pass
            case ir.Move(triggers=(), search=None) | ir.MoveExternal():
                self.reads(statement, level)
            case _ if isinstance(statement, _PLAIN):
                self.reads(statement, level)
                for name in assigned_in((statement,)):
                    self.forget(name, level)
            case _:
                raise _EndError
        return ""

    def assign(self, statement: ir.Assign, level: _Level) -> None:
        target = statement.target
        self.reads(statement.value, level)
        value = self.value(statement.value, level)
        name = base_name(target)
        if name is None:  # a signal or a setting of the controller
            self.reads(target, level)
            return
        place = self.place(target, level)
        if place is None:
            self.forget(name, level)
            return
        number, _, indices, part = place
        for old in [old for old in self.known if old[:3] == place[:3] and (not part or old[3] in ("", part))]:
            if part and not old[3]:
                self.spread(old)
            self.known.pop(old, None)
        self.known.pop(place, None)  # the spread gave the component its old value
        if number == 0 and not part and name in self.wanted and level.once:
            self.made.setdefault(id(statement), []).append(value)
            self.done.setdefault((name, indices), set()).add(id(statement))
        if value is not None and not (number == 0 and name in self.unsure):
            self.known[place] = value

    def spread(self, whole: Place) -> None:
        """A known place, component by component, before one of them changes."""
        for name in ir.POSE:
            part = component(self.known[whole], name)
            if part is not None:
                self.known[(*whole[:3], name)] = part

    def forget(self, name: str, level: _Level) -> None:
        number = self.number(name, level)
        for old in [old for old in self.known if old[:2] == (number, name)]:
            del self.known[old]

    def call(self, call: ir.CallRoutine, level: _Level) -> None:
        for argument in call.arguments:
            if argument.value is not None:
                self.reads(argument.value, level)
        routine = level.scope.routine(call.name)
        if routine is None or any(one.mode != "value" for one in routine.parameters):
            raise _EndError
        self.run(routine, call, level)

    def run(self, routine: ir.Routine, call: ir.CallRoutine | ir.Call, level: _Level) -> None:
        """Carry out a routine with the values of its arguments."""
        home = self.scopes.home(routine)
        named = any(one.name or one.value is None for one in call.arguments)
        if home is None or named or len(call.arguments) != len(routine.parameters) or routine.handlers:
            raise _EndError
        values = [self.value(one.value, level) for one in call.arguments if one.value is not None]
        self.levels += 1
        once = level.once and self.sites.get(call.name.lower()) == 1
        inside = _Level(self.scopes.routine(home, routine), self.levels, once)
        for parameter, value in zip(routine.parameters, values, strict=True):
            if value is not None:
                self.known[(inside.number, parameter.name.lower(), (), "")] = value
        self.returned = None
        self.body(routine.body, inside)

    def result(self, call: ir.Call, level: _Level) -> Value | None:
        """The value of a function that only works with data of its own."""
        routine = level.scope.routine(call.name)
        home = self.scopes.home(routine) if routine is not None else None
        if routine is None or home is None:
            raise _EndError
        scope = self.scopes.routine(home, routine)
        given = {one.name.lower() for one in routine.parameters if one.mode == "reference"}
        for node in walk(*bodies(routine)):
            target = base_name(node.target) if isinstance(node, ir.Assign) else ""
            symbol = scope.value(target) if target else None
            foreign = isinstance(node, ir.Assign) and (symbol is None or symbol.routine is None or target in given)
            if foreign or isinstance(node, (ir.CallRoutine, *_PLAIN, *_ACTIONS)):
                raise _EndError
        self.run(routine, call, level)
        return self.returned

    def choice(self, branches: tuple[tuple[ir.Expression, ir.Body], ...], otherwise: ir.Body, level: _Level) -> str:
        for at, (condition, body) in enumerate(branches):
            self.reads(condition, level)
            known = self.value(condition, level)
            if known is True:
                return self.body(body, level)
            if known is not False:
                self.uncertain((*(one for _, one in branches[at:]), otherwise), level)
                return ""
        return self.body(otherwise, level)

    def uncertain(self, bodies: tuple[ir.Body, ...], level: _Level) -> None:
        """Statements that may run or not: what they change is not known behind them."""
        for node in walk(*bodies):
            if isinstance(node, (*_LEAVING, ir.CallRoutine, ir.Call, ir.Label)):
                raise _EndError
            if isinstance(node, ir.Assign):
                self.reads(node.value, level)
                self.forget(base_name(node.target) or "", level)
            elif isinstance(node, _ACTIONS):
                raise _EndError

    def loop(self, loop: ir.While | ir.Repeat | ir.Loop, level: _Level) -> str:
        while True:
            if isinstance(loop, ir.While) and not self.holds(loop.condition, level):
                return ""
            left = self.body(loop.body, level)
            if left in ("exit", "return"):
                return left if left == "return" else ""
            if isinstance(loop, ir.Repeat) and self.holds(loop.until, level):
                return ""
            self.steps += 1

    def holds(self, condition: ir.Expression, level: _Level) -> bool:
        self.reads(condition, level)
        known = self.value(condition, level)
        if not isinstance(known, bool):
            raise _EndError
        return known

    def counted(self, loop: ir.For, level: _Level) -> None:
        """Counting loops are few in preparations; those that touch no tool or frame are passed over."""
        if any(isinstance(node, ir.CallRoutine | ir.Call | ir.Move | ir.Label | ir.Goto) for node in walk(loop)):
            raise _EndError
        self.uncertain((loop.body,), level)
        self.forget(loop.counter.lower(), level)

    # ---- values

    def number(self, name: str, level: _Level) -> int:
        """Whose data the name means: that of the routine, or the program's (0)."""
        symbol = level.scope.value(name)
        return level.number if symbol is not None and symbol.routine is not None else 0

    def place(self, target: ir.Expression, level: _Level) -> Place | None:
        component = ""
        if isinstance(target, ir.Field):
            component, target = target.name.lower(), target.base
        indices: tuple[int, ...] = ()
        if isinstance(target, ir.Index):
            values = [self.value(one, level) for one in target.indices]
            indices = tuple(int(one) for one in values if isinstance(one, int | float))
            if len(indices) != len(values):
                return None
            target = target.base
        if not isinstance(target, ir.Name):
            return None
        return self.number(target.id, level), target.id.lower(), indices, component

    def value(self, expression: ir.Expression, level: _Level) -> Value | None:
        def inserted(one: ir.Expression) -> ir.Expression:
            known: Value | None = None
            if isinstance(one, ir.Name | ir.Index | ir.Field):
                place = self.place(one, level)
                known = self.at(place) if place is not None else None
            elif isinstance(one, ir.Call):
                known = self.result(one, level)
            known = known.pose if isinstance(known, Target) else known
            written = literal(known) if known is not None else None
            return rewrite_parts(one, inserted) if written is None else written

        return constant(inserted(expression), level.scope, self.unchanged)

    def at(self, place: Place) -> Value | None:
        if place in self.known:
            return self.known[place]
        if place[3]:
            whole = self.known.get((*place[:3], ""))
            return None if whole is None else component(whole, place[3])
        parts = [self.known.get((*place[:3], name)) for name in ir.POSE]
        numbers = [float(one) for one in parts if isinstance(one, int | float)]
        if len(numbers) != len(parts) or abs(numbers[4]) >= 90.0:
            return None
        return rigid.Pose(rigid.Vector(*numbers[:3]), rigid.rotation_of_zyx(*numbers[3:]))

    # ---- what is settled

    def reads(self, node: object, level: _Level) -> None:
        """Note what is read before it is set."""
        for name, indices in self._elements(node, level):
            if indices is None or (name, indices) not in self.done:
                self.early.add((name, indices))

    def _elements(self, node: object, level: _Level) -> Iterator[tuple[str, tuple[int, ...] | None]]:
        bases: set[int] = set()
        for one in walk(node):
            if isinstance(one, ir.Index) and isinstance(one.base, ir.Name):
                bases.add(id(one.base))
                place = self.place(one, level) if one.base.id.lower() in self.wanted else None
                if one.base.id.lower() in self.wanted:
                    yield one.base.id.lower(), None if place is None else place[2]
            elif isinstance(one, ir.Name) and id(one) not in bases and one.id.lower() in self.wanted:
                yield one.id.lower(), ()

    def untouched(self, statements: dict[tuple[str, tuple[int, ...] | None], set[int]]) -> Settled:
        """Elements that keep their first value: all assignments to the array are to others."""
        found: Settled = {}
        free = {name for name in self.wanted if (name, None) not in statements}
        first = Unchanged(self.unchanged.assigned - free, self.unchanged.initialised)
        for module in self.program.modules:
            scope = self.scopes.module(module)
            for one in module.declarations:
                if not isinstance(one, ir.Variable) or one.name.lower() not in free:
                    continue
                type = scope.resolve(one.type)
                if not isinstance(type, ir.ArrayType) or len(type.dimensions) != 1:
                    continue
                extent = type.dimensions[0]
                size = constant(extent, scope) if extent is not None else None
                last = min(int(size), _MOST_ELEMENTS) if isinstance(size, int | float) else 0
                for at in range(type.base, type.base + last):
                    value = constant(ir.Index(ir.Name(one.name), (ir.IntLiteral(at),)), scope, first)
                    if value is not None and (one.name.lower(), (at,)) not in statements:
                        found[one.name.lower(), (at,)] = value
        return found

    def settled(self, statements: dict[tuple[str, tuple[int, ...] | None], set[int]]) -> Settled:
        found: Settled = {}
        for (name, indices), made in self.done.items():
            values = [value for one in made for value in self.made[one]]
            first = values[0]
            every = statements.get((name, indices), set()) | statements.get((name, None), set())
            early = {(name, indices), (name, None)} & self.early
            if first is None or early or every != made or any(value != first for value in values):
                continue
            found[name, indices] = first
        return found

    def all_assignments(self) -> dict[tuple[str, tuple[int, ...] | None], set[int]]:
        """By name and element (None: any element, or a part of one)."""
        found: dict[tuple[str, tuple[int, ...] | None], set[int]] = {}
        for module, routine in self.scopes.routines():
            level = _Level(self.scopes.routine(module, routine), -1, False)
            for node in walk(routine):
                name = base_name(node.target) if isinstance(node, ir.Assign) else None
                if not isinstance(node, ir.Assign) or name is None or name not in self.wanted:
                    continue
                self.known.clear()  # the element that a computed index means is not known
                place = self.place(node.target, level)
                key = None if place is None or place[3] else place[2]
                found.setdefault((name, key), set()).add(id(node))
        return found


def _sites(program: ir.Program) -> dict[str, int]:
    """How often each routine (folded) is named as one to be run; calls by a text may mean any."""
    found: dict[str, int] = {}
    dynamic = 0
    for node in walk_for(_NAMING, *program.modules):
        match node:
            case ir.CallRoutine(dynamic=text) if text is not None:
                dynamic = 1
            case ir.CallRoutine(name=name) | ir.Call(name=name) | ir.ConnectInterrupt(routine=name):
                found[name.lower()] = found.get(name.lower(), 0) + 1
            case ir.TaskControl(task=name) | ir.OnError(routine=str() as name):
                found[name.lower()] = found.get(name.lower(), 0) + 1
    return {name: count + dynamic for name, count in found.items()}
