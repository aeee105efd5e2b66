"""Which tool and frame hold at each move and at each question for joints, as far as they are constant, and which moves
a written target serves.

Tool and frame of a move are its own or the modal ones; those are followed through assignments, branches, loops and
calls, as far as they are constant. A target reaches moves through variables, arrays, parameters and results.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import partial

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes import rigid
from rpl.passes.fold import constant, element_key
from rpl.passes.legalise.context import ProgramScope
from rpl.passes.legalise.facts.usage import base_name, each_expression, each_statement
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.rewrite import rewrite_parts, visit_parts
from rpl.passes.scope import Scope
from rpl.passes.values import Record, Value, pose_of

_MODAL = ("tool", "base", "robot_root")
_ROUNDS = 24
_ASKING = frozenset(("target_to_joints", "target_to_joints_near", "is_reachable", "joints_to_target"))
State = dict[str, Value]


@dataclass(frozen=True, slots=True)
class Frames:
    """Tool in the flange and frame in the robot's base at a move; None when not constant."""

    tool: rigid.Pose | None
    base: rigid.Pose | None

    def flange(self, pose: rigid.Pose) -> rigid.Pose | None:
        """The flange in the robot's base frame for a pose of the tool in the frame."""
        if self.tool is None or self.base is None:
            return None
        return self.base.then(pose).then(self.tool.inverse)


@dataclass(frozen=True, slots=True)
class Use:
    """One way a target is used. `joint`: its arm configuration chooses the posture. `moved`: name and numbers of the
    function that moves it first (offset, tool_offset), when these are constant."""

    frames: Frames
    joint: bool
    moved: tuple[str, tuple[float, ...]] | None = None


class ModalFlow:
    """Follows modal tool and frame through a whole program; `frames` has each move by identity, and each function that
    asks for the joints of a place, or for the place of joints, with what is in use then."""

    def __init__(self, program: ir.Program, scopes: ProgramScope) -> None:
        self.scopes, self.unchanged = scopes, unchanged_in(program)
        self.frames: dict[int, Frames] = {}
        self.known: dict[tuple[int, str], rigid.Pose | None] = {}
        self.relevant = _relevant(program)
        self.entries: dict[int, State] = {}
        self.calls: dict[int, State] = {}
        self.exits: dict[int, State] = {}
        self.ends: list[State] = []
        self.routine: ir.Routine | None = None
        self.made: set[str] = set()
        self.asking = any(isinstance(one, ir.Builtin) and one.function in _ASKING for one in walk(*program.modules))
        every = list(scopes.routines())
        self.scope_of = {id(routine): scopes.routine(module, routine) for module, routine in every}
        self.changed = self.changes(every)
        called = self.called(every)
        start: State = dict.fromkeys((f"${name}" for name in _MODAL), rigid.IDENTITY)
        roots = [routine for _, routine in every if id(routine) not in called]
        for _ in range(_ROUNDS):
            before = (dict(self.entries), dict(self.exits))
            self.calls = {id(root): dict(start) for root in roots if root.kind != "trap"}
            for _, routine in every:
                if id(routine) in self.entries or id(routine) in self.calls:
                    self.visit(routine, dict(self.entries.get(id(routine), self.calls.get(id(routine), {}))))
            self.entries = dict(self.calls)
            if (self.entries, self.exits) == before:
                break
        for _, routine in every:
            if id(routine) not in self.entries:
                self.visit(routine, {})

    def called(self, every: list[tuple[ir.Module, ir.Routine]]) -> set[int]:
        found: set[int] = set()
        for _, routine in every:
            scope = self.scope_of[id(routine)]
            for body in bodies(routine):
                each_statement(body, partial(_note_callees, scope=scope, found=found))
        return found

    def changes(self, every: list[tuple[ir.Module, ir.Routine]]) -> dict[int, set[str] | None]:
        """What each routine assigns, itself or by its calls; None when that is not known."""
        own: dict[int, set[str]] = {}
        calls: dict[int, set[int]] = {}
        unknown: set[int] = set()
        for _, routine in every:
            key, scope = id(routine), self.scope_of[id(routine)]
            own[key], calls[key] = set(), set()

            def look(one: ir.Statement, key: int = key, scope: Scope = scope) -> None:
                calls[key].update(map(id, _callees(one, scope)))
                match one:
                    case ir.Assign(target=target):
                        own[key].add(_changed(target))
                    case ir.CallRoutine(dynamic=dynamic) if dynamic is not None:
                        unknown.add(key)

            for body in bodies(routine):
                each_statement(body, look)
        self.made = set().union(*own.values())
        growing = True
        while growing:
            growing = False
            for key, callees in calls.items():
                more = set().union(*(own[one] for one in callees if one in own)) - own[key]
                lost = key not in unknown and not callees.isdisjoint(unknown)
                own[key] |= more
                unknown |= {key} if lost else set()
                growing = growing or bool(more) or lost
        return {key: None if key in unknown else names for key, names in own.items()}

    def visit(self, routine: ir.Routine, state: State) -> None:
        self.routine, self.ends = routine, []
        scope = self.scope_of[id(routine)]
        self.body(routine.body, state, scope)
        for handler in routine.handlers:
            self.body(handler.body, {}, scope)
        for end in self.ends:
            _join(state, end)
        self.exits[id(routine)] = _outside(state, scope)

    def body(self, body: ir.Body, state: State, scope: Scope) -> None:
        for statement in body:
            self.statement(statement, state, scope)

    def statement(self, statement: ir.Statement, state: State, scope: Scope) -> None:
        for callee in _callees(statement, scope):
            self.call(callee, state, scope)
        for name in _lent(statement, scope):
            _forget_variable(state, name)
        if self.asking:
            self.questions(statement, state, scope)
        match statement:
            case ir.Move():
                self.frames[id(statement)] = self.of_move(statement, state, scope)
            case ir.Assign(target=target, value=value):
                self.assign(target, value, state, scope)
            case ir.If(branches=branches, otherwise=otherwise):
                self.branches(branches, otherwise, state, scope)
            case ir.Switch(cases=cases, default=default):
                ends = [self.ended(case.body, state, scope) for case in cases]
                ends.append(self.ended(default or (), state, scope))
                _replace(state, ends)
            case ir.For(body=body) | ir.While(body=body) | ir.Repeat(body=body) | ir.Loop(body=body):
                for _ in range(_ROUNDS):
                    end = self.ended(body, state, scope)
                    old = dict(state)
                    _join(state, end)
                    if state == old:
                        break
                if self.asking:  # the condition is asked again behind the body
                    self.questions(statement, state, scope)
            case ir.Label():
                self.forget(state)
            case ir.Return():
                self.ends.append(dict(state))
            case ir.Spline(body=inner):
                self.body(inner, state, scope)
            case ir.CallRoutine(dynamic=dynamic) if dynamic is not None:
                self.forget(state)

    def questions(self, statement: ir.Statement, state: State, scope: Scope) -> None:
        """The frames in use where this statement itself asks for joints."""

        def look(one: ir.Expression) -> None:
            if isinstance(one, ir.Builtin) and one.function in _ASKING:
                self.frames[id(one)] = self.in_use(None, None, state, scope)

        each_expression(statement, look)

    def forget(self, state: State) -> None:
        """Anything may have run before this place; settings that nothing in the program makes are as at the start."""
        for name in [name for name in state if not name.startswith("$") or name in self.made]:
            del state[name]

    def ended(self, body: ir.Body, state: State, scope: Scope) -> State:
        inside = dict(state)
        self.body(body, inside, scope)
        return inside

    def branches(
        self, branches: tuple[tuple[ir.Expression, ir.Body], ...], otherwise: ir.Body, state: State, scope: Scope
    ) -> None:
        ends: list[State] = []
        for condition, body in branches:
            known = constant(condition, scope, None, state) if self.mentions(condition) else None
            if known is False:
                self.ended(body, state, scope)  # its moves still need frames
                continue
            ends.append(self.ended(body, state, scope))
            if known is True:
                _replace(state, ends)
                return
        ends.append(self.ended(otherwise, state, scope))
        _replace(state, ends)

    def mentions(self, condition: ir.Expression) -> bool:
        return bool(_names(condition) & self.relevant)

    def assign(self, target: ir.Expression, value: ir.Expression, state: State, scope: Scope) -> None:
        match target:
            case ir.System(name=name) if name in _MODAL:
                _put(state, f"${name}", pose_of(constant(value, scope, self.unchanged, state)))
            case ir.Field(base=ir.System(name=name)):
                state.pop(f"${name}", None)
            case ir.Name(id=name) if name.lower() in self.relevant:
                found = constant(value, scope, self.unchanged, state)
                _forget_variable(state, name.lower())
                _put(state, name.lower(), found)
            case ir.Index(base=ir.Name(id=name), indices=indices) if name.lower() in self.relevant:
                found = constant(value, scope, self.unchanged, state)
                places = [constant(index, scope, self.unchanged, state) for index in indices]
                whole = [int(place) for place in places if isinstance(place, int | float)]
                if len(whole) < len(places):
                    _forget_variable(state, name.lower())
                else:
                    state.pop(name.lower(), None)
                    _put(state, element_key(name, whole), found)
            case _:
                _forget_variable(state, base_name(target) or "")

    def call(self, callee: ir.Routine, state: State, scope: Scope) -> None:
        passed = _outside(state, scope)
        key = id(callee)
        if key in self.calls:
            _join(self.calls[key], passed)
        else:
            self.calls[key] = dict(passed)
        end = self.exits.get(key)
        if end is not None:
            changed = self.changed[key]
            for name in [name for name in state if name in passed and end.get(name) != state[name]]:
                if changed is None or _variable(name) in changed:
                    del state[name]
            state.update({name: value for name, value in end.items() if changed is None or _variable(name) in changed})

    def of_move(self, move: ir.Move, state: State, scope: Scope) -> Frames:
        settings = {place.name: value for place, value in move.settings if isinstance(place, ir.System)}
        return self.in_use(move.tool or settings.get("tool"), move.frame or settings.get("base"), state, scope)

    def in_use(
        self, own_tool: ir.Expression | None, own_base: ir.Expression | None, state: State, scope: Scope
    ) -> Frames:
        """Those of a statement that may say its own."""
        tool = self.part(own_tool, "tool", state, scope)
        base = self.part(own_base, "base", state, scope)
        root = pose_of(state.get("$robot_root", rigid.IDENTITY))
        if base is not None and root is not None and root != rigid.IDENTITY:
            base = root.inverse.then(base)
        return Frames(tool, base)

    def part(self, given: ir.Expression | None, name: str, state: State, scope: Scope) -> rigid.Pose | None:
        if given is None:
            return pose_of(state.get(f"${name}"))
        fixed = isinstance(given, ir.Name) and given.id.lower() not in self.relevant
        key = (id(scope), given.id) if fixed and isinstance(given, ir.Name) else None
        if key is not None and key in self.known:
            return self.known[key]
        found = self.frame_of(constant(given, scope, self.unchanged, state), name)
        if key is not None:
            self.known[key] = found
        return found

    def frame_of(self, value: Value | None, name: str) -> rigid.Pose | None:
        """The pose of a tool, work object or pose."""
        if isinstance(value, Record):
            if value.part("held") is (name == "base"):
                return None  # the robot holds the part; the tool stands in the room
            if name == "tool":
                return pose_of(value.part("frame"))
            if value.part("fixed") is False and value.part("unit"):
                return None  # it is where a mechanism carries it
            user, item = pose_of(value.part("user_frame")), pose_of(value.part("object_frame"))
            return user.then(item) if user and item else None
        return pose_of(value)


def _changed(target: ir.Expression) -> str:
    """The name in a state that an assignment changes."""
    match target:
        case ir.System(name=name) | ir.Field(base=ir.System(name=name)):
            return f"${name}"
    return base_name(target) or ""


def _variable(name: str) -> str:
    """The variable of a name in a state, which may be that of an array's element."""
    return name.partition("[")[0]


def _forget_variable(state: State, name: str) -> None:
    for one in [one for one in state if _variable(one) == name]:
        del state[one]


def _put(state: State, name: str, value: Value | None) -> None:
    if value is None:
        state.pop(name, None)
    else:
        state[name] = value


def _join(state: State, other: State) -> None:
    for name in [name for name, value in state.items() if other.get(name) != value]:
        del state[name]


def _replace(state: State, ends: list[State]) -> None:
    first, *rest = ends
    for one in rest:
        _join(first, one)
    state.clear()
    state.update(first)


def _outside(state: State, scope: Scope) -> State:
    """What a called routine sees of it."""

    def own(name: str) -> bool:
        symbol = scope.value(_variable(name))
        return symbol is None or symbol.routine is not None

    return {name: value for name, value in state.items() if name.startswith("$") or not own(name)}


def _note_callees(statement: ir.Statement, scope: Scope, found: set[int]) -> None:
    found.update(map(id, _callees(statement, scope)))


def _callees(statement: ir.Statement, scope: Scope) -> list[ir.Routine]:
    names: list[str] = []
    if isinstance(statement, ir.CallRoutine) and statement.dynamic is None:
        names.append(statement.name)

    def look(expression: ir.Expression) -> None:
        if isinstance(expression, ir.Call):
            names.append(expression.name)

    each_expression(statement, look)
    found = [scope.routine(name) for name in names]
    return [routine for routine in found if routine is not None]


def _lent(statement: ir.Statement, scope: Scope) -> set[str]:
    """Variables that calls of the statement may change through their parameters."""
    found: set[str] = set()

    def look(call: ir.CallRoutine | ir.Call) -> None:
        routine = scope.routine(call.name)
        if routine is not None and any(one.mode == "reference" for one in routine.parameters):
            found.update(filter(None, (base_name(one.value) for one in call.arguments if one.value is not None)))

    def inner(expression: ir.Expression) -> None:
        if isinstance(expression, ir.Call):
            look(expression)

    if isinstance(statement, ir.CallRoutine) and statement.dynamic is None:
        look(statement)
    each_expression(statement, inner)
    return found


def _names(expression: ir.Expression) -> set[str]:
    found: set[str] = set()

    def look(one: ir.Expression) -> ir.Expression:
        if isinstance(one, ir.Name):
            found.add(one.id.lower())
        return rewrite_parts(one, look)

    look(expression)
    return found


def _relevant(program: ir.Program) -> set[str]:
    """Variables that tool and frame may rest on."""
    rests: dict[str, set[str]] = {}
    wanted: set[str] = set()

    def look(one: ir.Statement) -> None:
        match one:
            case ir.Assign(target=ir.System(name=name), value=value) if name in _MODAL:
                wanted.update(_names(value))
            case ir.Assign(target=ir.Name(id=name) | ir.Index(base=ir.Name(id=name)), value=value):
                rests.setdefault(name.lower(), set()).update(_names(value))

    choices: dict[int, ir.If] = {}
    for module in program.modules:
        for routine in module.routines:
            for body in bodies(routine):
                each_statement(body, look)
                choices |= _choices_of_frames(body)
    for choice in choices.values():
        for condition, _ in choice.branches:
            wanted.update(_names(condition))
    size = -1
    while size != len(wanted):
        size = len(wanted)
        for name in list(wanted):
            wanted |= rests.get(name, set())
    return wanted


def _choices_of_frames(body: ir.Body) -> dict[int, ir.If]:
    """The branches that tool or frame are set in, at any depth, by identity."""
    found: dict[int, ir.If] = {}
    around: list[ir.If] = []

    def look(statements: ir.Body) -> None:
        for one in statements:
            match one:
                case ir.Assign(target=ir.System(name=name)) if name in _MODAL:
                    for choice in reversed(around):
                        if id(choice) in found:
                            break
                        found[id(choice)] = choice
                case ir.If():
                    around.append(one)
            visit_parts(one, lambda expression: None, look)
            if isinstance(one, ir.If):
                around.pop()

    look(body)
    return found


# ---- targets to the moves they serve


def _moved(place: ir.Expression, scope: Scope) -> tuple[str, tuple[float, ...]] | None:
    """By which constant numbers a move's target is moved first."""
    match place:
        case ir.Builtin(function="offset" | "tool_offset" as function, arguments=(_, *rest)):
            values = [constant(one, scope) for one in rest]
            numbers = tuple(float(value) for value in values if isinstance(value, int | float))
            return (function, numbers) if len(numbers) == len(values) and any(numbers) else None
    return None


@dataclass(slots=True)
class Uses:
    """For each written target (an aggregate, by identity) how it is used."""

    found: dict[int, set[Use]] = field(default_factory=dict)
    sources: dict[int, set[int]] = field(default_factory=dict)
    moves: list[tuple[int, Use]] = field(default_factory=list)
    order: dict[Use, int] = field(default_factory=dict)  # of the uses, as their moves stand in the program
    keep: list[object] = field(default_factory=list)

    @classmethod
    def of(cls, program: ir.Program, scopes: ProgramScope) -> Uses:
        uses = cls()
        flow = ModalFlow(program, scopes)
        for module in program.modules:
            scope = scopes.module(module)
            uses.declared(module.declarations, scope)
            for routine in module.routines:
                inner = scopes.routine(module, routine)
                uses.declared(routine.declarations, inner)
                for body in bodies(routine):
                    each_statement(body, partial(uses.statement, scope=inner, routine=routine, flow=flow))
        uses.spread()
        return uses

    def declared(self, declarations: tuple[ir.Declaration, ...], scope: Scope) -> None:
        for one in declarations:
            match one:
                case ir.Variable(initial=initial) if initial is not None:
                    self.feed(id(one), initial, scope)
                case ir.Initialise(assign=assign):
                    self.feed_place(assign.target, assign.value, scope)

    def statement(self, statement: ir.Statement, scope: Scope, routine: ir.Routine, flow: ModalFlow) -> None:
        if isinstance(statement, ir.Move):
            frames = flow.frames.get(id(statement), Frames(None, None))
            for place in (statement.target, statement.via):
                if place is not None:
                    use = Use(frames, statement.kind == "joint", _moved(place, scope))
                    self.moves.extend((root, use) for root in self.roots(place, scope))
        self.values_of(statement, scope, routine)

    def values_of(self, statement: ir.Statement, scope: Scope, routine: ir.Routine) -> None:
        """What the statement puts where: by assignments, results, and arguments of calls."""
        match statement:
            case ir.Assign(target=target, value=value):
                self.feed_place(target, value, scope)
            case ir.Return(value=value) if value is not None:
                self.feed(id(routine), value, scope)
            case ir.CallRoutine(name=name, arguments=arguments, dynamic=None):
                self.passed(name, arguments, scope)

        def look(expression: ir.Expression) -> None:
            if isinstance(expression, ir.Call):
                self.passed(expression.name, expression.arguments, scope)

        each_expression(statement, look)

    def passed(self, name: str, arguments: tuple[ir.Argument, ...], scope: Scope) -> None:
        routine = scope.routine(name)
        if routine is None:
            return
        required = [one for one in routine.parameters if not one.optional]
        by_name = {one.name.lower(): one for one in routine.parameters}
        for at, argument in enumerate(arguments):
            if argument.value is None:
                continue
            positional = required[at] if at < len(required) else None
            parameter = by_name.get(argument.name.lower()) if argument.name else positional
            if parameter is not None:
                self.feed(id(parameter), argument.value, scope)
                if parameter.mode == "reference":
                    for root in self.roots(argument.value, scope):
                        self.sources.setdefault(root, set()).add(id(parameter))

    def feed_place(self, target: ir.Expression, value: ir.Expression, scope: Scope) -> None:
        for place in self.roots(target, scope):
            self.feed(place, value, scope)

    def feed(self, place: int, value: ir.Expression, scope: Scope) -> None:
        found = set(self.roots(value, scope))
        if found:
            self.sources.setdefault(place, set()).update(found)

    def roots(self, value: ir.Expression, scope: Scope) -> Iterator[int]:
        """What a value's arm configuration comes from: declarations, routines, written aggregates."""
        match value:
            case ir.Name(id=name):
                symbol = scope.value(name)
                if symbol is not None:
                    yield id(symbol.declaration)
            case ir.Index(base=base) | ir.Field(base=base):
                yield from self.roots(base, scope)
            case ir.Binary(op=":", right=right):
                yield from self.roots(right, scope)
            case ir.Builtin(arguments=(first, *_)):
                yield from self.roots(first, scope)
            case ir.Call(name=name):
                routine = scope.routine(name)
                if routine is not None:
                    yield id(routine)
            case ir.Aggregate(entries=entries):
                yield id(value)
                self.keep.append(value)
                for _, entry in entries:
                    self.sources.setdefault(id(value), set()).update(self.roots(entry, scope))

    def reach(self, value: ir.Expression, scope: Scope) -> set[int]:
        """Everything that the value's arm configuration may come from."""
        found: set[int] = set()
        work = list(self.roots(value, scope))
        while work:
            key = work.pop()
            if key not in found:
                found.add(key)
                work.extend(self.sources.get(key, ()))
        return found

    def spread(self) -> None:
        for _, use in self.moves:
            self.order.setdefault(use, len(self.order))
        work = list(self.moves)
        while work:
            key, use = work.pop()
            have = self.found.setdefault(key, set())
            if use in have:
                continue
            have.add(use)
            work.extend((source, use) for source in self.sources.get(key, ()))
