"""Which tool and frame hold at each move and at each question for joints, as far as they are constant, and which moves
a written target serves.

Tool and frame of a move are its own or the modal ones; those are followed through assignments, branches, loops and
calls, as far as they are constant. A target reaches moves through variables, arrays, parameters and results.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import partial

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes import rigid
from rpl.passes.fold import constant, element_key
from rpl.passes.legalise.context import ProgramScope
from rpl.passes.legalise.facts.entries import routines_beside
from rpl.passes.legalise.facts.forward import Forward, beside, reactions, started
from rpl.passes.legalise.facts.usage import (
    assigned_below,
    assigned_in,
    base_name,
    doing_each,
    each_expression,
    each_statement,
)
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.rewrite import rewrite_parts, visit_parts
from rpl.passes.scope import Scope
from rpl.passes.values import Record, Value, pose_of

_MODAL = ("tool", "base", "robot_root")
_SETTINGS = frozenset(f"${name}" for name in _MODAL)
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


class ModalFlow(Forward[State]):
    """Follows modal tool and frame through a whole program; `frames` has each move by identity, and each function that
    asks for the joints of a place, or for the place of joints, with what is in use then. A state has what is known, of
    settings with a `$` in front and of variables that they rest on."""

    def __init__(self, program: ir.Program, scopes: ProgramScope) -> None:
        super().__init__(program, {}, {})
        self.unchanged = unchanged_in(program)
        self.frames: dict[int, Frames] = {}
        self.known: dict[tuple[int, str], rigid.Pose | None] = {}
        self.relevant = _relevant(program)
        self.asking = any(isinstance(one, ir.Builtin) and one.function in _ASKING for one in walk(*program.modules))
        self.changed = self.changes()
        self.unsure = self.changed_at_any_time()
        self.start = {f"${name}": rigid.IDENTITY for name in _MODAL if not self.is_unsure(f"${name}")}
        made = set[str]().union(*self.changed.values())
        self.unknown = {name: value for name, value in self.start.items() if name not in made}
        self.solve(started(program), beside(program))

    def changes(self) -> dict[int, set[str]]:
        """What each routine changes, itself or by its calls."""
        variables, settings = assigned_below(self.program), doing_each(self.program, _settings, _SETTINGS)
        found: dict[int, set[str]] = {}
        for key, one in self.summaries.items():
            name = one.routine.name.lower()
            own = {setting for setting, routines in settings.items() if name in routines}
            found[key] = own | variables.get(name, set())
        return found

    def changed_at_any_time(self) -> set[str]:
        """What interrupts, triggers, error routines and other tasks assign (their settings are their own)."""
        found: set[str] = set()
        reacting = {name.lower() for name in reactions(self.program)}
        others = set(beside(self.program)) | routines_beside(self.program)
        for name in sorted(reacting | others):
            for one in self.by_name.get(name, ()):
                changed = self.changed[id(one.routine)]
                found |= {one for one in changed if name in reacting or not one.startswith("$")}
        for node in walk(*self.program.modules):
            match node:
                case ir.DeclareInterrupt(action=ir.Assign(target=target)) | ir.Trigger(action=ir.Assign(target=target)):
                    found.add(_changed(target))
        return found

    def is_unsure(self, name: str) -> bool:
        return _variable(name) in self.unsure

    # ---- what the analysis asks

    def join(self, one: State, other: State) -> State:
        common = {name: value for name, value in one.items() if name in other and other[name] == value}
        return one if len(common) == len(one) else common

    def transfer(self, statement: ir.Statement, before: State) -> State:
        match statement:
            case ir.Assign(target=target, value=value):
                return self.assign(target, value, before)
            case ir.For(counter=counter):
                return _without(before, {counter.lower()})
            case ir.Do() | ir.Dialog() | ir.WaitUntil() | ir.Clock() | ir.DefineTrigger() if before:
                return _without(before, assigned_in((statement,)))
            case ir.Move(search=ir.Search()):
                return _without(before, assigned_in((statement,)))
        return before

    def told(self, condition: ir.Expression, state: State) -> bool | None:
        known = constant(condition, self.scope, None, state) if _names(condition) & self.relevant else None
        return known if isinstance(known, bool) else None

    def note(self, statement: ir.Statement, before: State) -> None:
        if self.asking:
            self.questions(statement, before)
        if isinstance(statement, ir.Move):
            self.tell(statement, self.of_move(statement, before, self.scope))

    def tell(self, node: ir.Move | ir.Builtin, found: Frames) -> None:
        """A statement may be told of several times, with what holds there in some of its runs."""
        known = self.frames.get(id(node), found)
        tool, base = (one if one == other else None for one, other in _both(known, found))
        self.frames[id(node)] = known if known == found else Frames(tool, base)

    def questions(self, statement: ir.Statement, state: State) -> None:
        """The frames in use where this statement itself asks for joints."""

        def look(one: ir.Expression) -> None:
            if isinstance(one, ir.Builtin) and one.function in _ASKING:
                self.tell(one, self.in_use(None, None, state, self.scope))

        each_expression(statement, look)

    def entered(self, state: State, here: Scope, there: Scope) -> State:
        return _outside(_outside(state, here), there)

    def left(self, before: State, end: State, routine: ir.Routine, there: Scope, here: Scope) -> State:
        changed = self.changed[id(routine)]
        found = _outside(_outside(end, there), here)
        kept = {
            name: value
            for name, value in before.items()
            if found.get(name) == value or not _is_outside(name, here) or not _in(name, changed)
        }
        return kept | {name: value for name, value in found.items() if _in(name, changed)}

    def passed(self, call: ir.CallRoutine | ir.Call, state: State) -> State:
        """Variables that the call may change through its parameters are forgotten."""
        routine = self.scope.routine(call.name)
        if routine is None or not any(one.mode == "reference" for one in routine.parameters):
            return state
        return _without(state, {base_name(one.value) or "" for one in call.arguments if one.value is not None})

    def assign(self, target: ir.Expression, value: ir.Expression, state: State) -> State:
        scope, name = self.scope, _changed(target)
        kept = _without(state, {name})
        if self.is_unsure(name):
            return kept
        match target:
            case ir.System(name=setting) if setting in _MODAL:
                return _with(kept, name, pose_of(constant(value, scope, self.unchanged, state)))
            case ir.Name() if name in self.relevant:
                return _with(kept, name, constant(value, scope, self.unchanged, state))
            case ir.Index(base=ir.Name(), indices=indices) if name in self.relevant:
                places = [constant(index, scope, self.unchanged, state) for index in indices]
                whole = [int(place) for place in places if isinstance(place, int | float)]
                if len(whole) == len(places):
                    others = {one: known for one, known in state.items() if one != name}
                    return _with(others, element_key(name, whole), constant(value, scope, self.unchanged, state))
        return kept

    # ---- what is asked of it

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


def _settings(node: object) -> Iterable[str]:
    changed = _changed(node.target) if isinstance(node, ir.Assign) else ""
    return (changed,) if changed in _SETTINGS else ()


def _variable(name: str) -> str:
    """The variable of a name in a state, which may be that of an array's element."""
    return name.partition("[")[0]


def _without(state: State, variables: set[str]) -> State:
    """The state with nothing known of these."""
    kept = {name: value for name, value in state.items() if _variable(name) not in variables}
    return state if len(kept) == len(state) else kept


def _with(state: State, name: str, value: Value | None) -> State:
    return {one: known for one, known in state.items() if one != name} if value is None else {**state, name: value}


def _in(name: str, changed: set[str]) -> bool:
    return _variable(name) in changed


def _is_outside(name: str, scope: Scope) -> bool:
    symbol = None if name.startswith("$") else scope.value(_variable(name))
    return symbol is None or symbol.routine is None


def _outside(state: State, scope: Scope) -> State:
    """What other routines see of it."""
    kept = {name: value for name, value in state.items() if _is_outside(name, scope)}
    return state if len(kept) == len(state) else kept


def _both(one: Frames, other: Frames) -> Iterator[tuple[rigid.Pose | None, rigid.Pose | None]]:
    yield one.tool, other.tool
    yield one.base, other.base


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
