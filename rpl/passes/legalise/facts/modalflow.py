"""What modal settings are at each move: constants carried through branches, loops and calls of the whole program.

A setting is known where every way to the place has set the same constant (a literal, or data that nothing assigns).
Routines are entered with what all their calls have in common, and leave with what they have set.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.data.datalists import never_called
from rpl.passes.legalise.facts.heldtexts import known_calls
from rpl.passes.legalise.facts.usage import Usage, doing_each, each_expression, usage_of
from rpl.passes.scope import ProgramScope, Scope

SETTINGS = frozenset(("tool", "base", "path_speed", "joint_speed", "blend_distance", "blend_joint"))
# What else is followed, because the size of a corner that a speed decides depends on it. The values are those of a
# controller that says nothing (mm/s2 and percent, as the emulator takes them).
BRAKING = {
    "blend_speed": 100.0,
    "path_acceleration": 5000.0,
    "acceleration_percent": 100.0,
    "joint_acceleration": 100.0,
}
# How the tool turns on arcs is followed too; setting it again is never left out, for targets start with other rules.
_TURNS = "circle_orientation"
# What all speeds are a share of, and the highest (RAPID VelSet), as a controller has them that says nothing.
_SHARES = {"speed_percent": 100.0, "speed_limit": 5000.0, "override": 100.0}
# Percentage for slowing down, of languages that have one of their own: none where that is as strong as speeding up.
_DOWN = "deceleration_percent"
# Whether moves are joined at all (V+ CPON): a truth value.
_JOINED = "blending"
# Whether accelerations are a share of what is said, as the speed is.
SCALED = {"scale_acceleration": False}
# The least time of moves, s; none where nothing is said.
_TIMES = {"move_duration": 0.0}
_NUMBERS = BRAKING.keys() | _SHARES.keys() | _TIMES.keys()
_FOLLOWED = SETTINGS | _NUMBERS | SCALED.keys() | {"displacement", _TURNS, _JOINED, _DOWN}
# Setting -> constant; None: it depends on the run. A place that is never reached has no state.
State = dict[str, "ir.Expression | None"]
_UNKNOWN: State = dict.fromkeys(_FOLLOWED)
_ROUNDS = 40


# Functions that give or take a pose in the modal frame where they are not told another.
IN_FRAME = {
    "current_target": 0,
    "current_position": 0,
    "joints_to_target": 1,
    "target_to_joints": 1,
    "target_to_joints_near": 2,
    "is_reachable": 2,
}


def in_frame(statement: ir.Statement) -> bool:
    """Does the statement read a pose that depends on the modal frame?"""
    found = False

    def look(one: ir.Expression) -> None:
        nonlocal found
        match one:
            case ir.System(name="actual_pose"):
                found = True
            case ir.Builtin(function=function, arguments=arguments) if function in IN_FRAME:
                found = found or len(arguments) == IN_FRAME[function]

    each_expression(statement, look)
    return found


def _plainly_reads(statement: ir.Statement) -> bool:
    """Is it an assignment that reads or converts a place, and calls nothing that may change a setting?"""
    if not isinstance(statement, ir.Assign):
        return False
    inside = list(walk(statement.value))
    reads = any(isinstance(one, ir.Builtin) and one.function in IN_FRAME for one in inside)
    return reads and not any(isinstance(one, ir.Call) for one in inside)


def joined(*states: State | None) -> State | None:
    """What is known on every way."""
    found = [state for state in states if state is not None]
    if not found:
        return None
    known = dict(found[0])
    for other in found[1:]:
        for name, value in other.items():
            before = known[name]
            if before is not value and before is not None and before != value:
                known[name] = None
    return known


@dataclass(slots=True)
class Flow:
    """`start`: the settings at the beginning of a program."""

    usage: Usage
    start: State
    moves: dict[int, State] = field(default_factory=dict)
    repeated: dict[int, bool] = field(default_factory=dict)
    kept: list[object] = field(default_factory=list)  # keeps the identities alive
    calls_by_text: bool = False

    @classmethod
    def of(cls, program: ir.Program, defaults: dict[str, float | bool | str]) -> Flow:
        """Follow the program; `defaults` are the system variables of its language at the start."""
        start: State = {name: _default(name, defaults) for name in _FOLLOWED}
        flow = cls(usage_of(program), start)
        _Follower(program, flow).follow()
        return flow

    def arc_rule(self, move: ir.Move) -> str:
        """How the tool turns on an arc that does not say it: `base`, `path`; empty text: it hangs on the run."""
        rule = self.at(move)[_TURNS]
        return rule.member if isinstance(rule, ir.EnumLiteral) else ""

    def at(self, statement: ir.Statement) -> State:
        """The settings at a move, or where an expression of a statement depends on the frame (all unknown where nothing
        leads)."""
        return self.moves.get(id(statement), _UNKNOWN)

    def never_comes_to(self, statement: ir.Statement) -> bool:
        """Does nothing of the program lead to this move (and nobody is called by a text)?"""
        return not self.calls_by_text and id(statement) not in self.moves

    def again(self, statement: ir.Assign) -> bool:
        """Is the setting known to have this value already?"""
        return self.repeated.get(id(statement), False)


def _default(name: str, defaults: dict[str, float | bool | str]) -> ir.Expression | None:
    if name in ("base", "displacement"):
        return ir.System("null_frame")
    if name == _TURNS:
        return ir.EnumLiteral(str(defaults.get(name, "base")))
    value = defaults.get(name, (BRAKING | _SHARES | _TIMES | SCALED).get(name))
    if isinstance(value, bool):
        return ir.BoolLiteral(value)
    return ir.RealLiteral(float(value)) if isinstance(value, int | float) else None


@dataclass(slots=True)
class _Loop:
    breaks: list[State] = field(default_factory=list)
    passes: list[State] = field(default_factory=list)


class _Follower:
    def __init__(self, program: ir.Program, flow: Flow) -> None:
        program = known_calls(program)
        self.program, self.flow = program, flow
        self.scopes = ProgramScope(program)
        self.routines = {r.name.lower(): (m, r) for m in reversed(program.modules) for r in m.routines}
        self.beside = _beside(program)
        self.entries: dict[str, State | None] = dict.fromkeys(self.routines)
        self.exits: dict[str, State | None] = dict.fromkeys(self.routines)
        self.setters = _setters(program)
        self.setting = frozenset().union(*self.setters.values())
        self.called_in: dict[int, tuple[str, ...]] = {}  # by identity of a part of the program, which stays alive
        self.anywhere = dict(_UNKNOWN)
        self.loops: list[_Loop] = []
        self.jumps: dict[str, State] = {}  # what holds where a label (folded) is jumped to
        self.returns: list[State] = []
        self.noting = False
        for name in self.started():
            self.entries[name] = dict(flow.start)

    def started(self) -> set[str]:
        """Routines that a run may begin with."""
        begins = {self.program.entry.lower(), *(t.entry.lower() for t in self.program.tasks if t.kind == "motion")}
        beside = {task.entry.lower() for task in self.program.tasks}
        return ((begins - {""} or never_called(self.program)) | beside) & set(self.routines)

    def follow(self) -> None:
        order = list(self.routines)
        for _ in range(_ROUNDS):
            before = (dict(self.entries), dict(self.exits))
            for name in order:
                self.routine(name)
            order.reverse()  # what calls bring goes down a chain of them, what routines leave behind goes up
            if before == (self.entries, self.exits):
                break
        else:
            self.entries = {name: dict(_UNKNOWN) for name in self.entries}
            self.exits = {name: dict(_UNKNOWN) for name in self.exits}
        self.noting = True
        for name in self.routines:
            self.routine(name)

    def routine(self, name: str) -> None:
        module, routine = self.routines[name]
        entry = dict(_UNKNOWN) if name in self.beside else self.entries[name]
        if entry is None:
            return
        self.scope: Scope = self.scopes.routine(module, routine)
        # What surely holds at a label: what the routine was entered with and never sets.
        self.anywhere = {key: None if name in self.setters[key] else value for key, value in entry.items()}
        self.loops, self.returns = [], []
        end = self.labelled(routine.body, entry)
        for handler in routine.handlers:
            self.returns.extend(state for state in (self.body(handler.body, dict(_UNKNOWN)),) if state is not None)
        self.exits[name] = joined(end, *self.returns)

    def labelled(self, body: ir.Body, entry: State) -> State | None:
        """The body followed until what its jumps bring to each label stays the same; it is noted then only."""
        noting, self.noting = self.noting, False
        self.jumps = {}
        for _ in range(_ROUNDS):
            before = dict(self.jumps)
            self.body(body, dict(entry))
            if before == self.jumps:
                break
        else:
            self.jumps = {name: dict(self.anywhere) for name in self.jumps}
        self.noting, self.loops, self.returns = noting, [], []
        return self.body(body, dict(entry))

    # ---- statements

    def body(self, body: ir.Body, state: State | None) -> State | None:
        for statement in body:
            if isinstance(statement, ir.Label):
                state = joined(state, self.jumps.get(statement.name.lower()))
            if state is None:
                continue
            state = self.statement(statement, state)
        return state

    def statement(self, statement: ir.Statement, state: State) -> State | None:
        if self.noting and not isinstance(statement, ir.Move) and (in_frame(statement) or _plainly_reads(statement)):
            self.note(statement, state)
        match statement:
            case ir.If(branches=branches, otherwise=otherwise):
                ends: list[State | None] = []
                passed: State | None = state
                for condition, body in branches:
                    passed = None if passed is None else self.calls(condition, passed)
                    ends.append(None if passed is None else self.body(body, dict(passed)))
                ends.append(None if passed is None else self.body(otherwise, dict(passed)))
                return joined(*ends)
            case ir.Switch(selector=selector, cases=cases, default=default):
                chosen = self.calls(selector, state)
                if chosen is None:
                    return None
                choices = [self.body(case.body, dict(chosen)) for case in cases]
                return joined(*choices, self.body(default or (), dict(chosen)))
            case ir.While(condition=ahead) | ir.For(stop=ahead):
                return self.loop(statement.body, self.calls(ahead, state), True)
            case ir.Repeat(body=body) | ir.Loop(body=body):
                return self.loop(body, state, isinstance(statement, ir.Repeat))
        return self.simple(statement, state)

    def loop(self, body: ir.Body, state: State | None, ends: bool) -> State | None:
        """`ends`: the loop has an end of its own, not only jumps out of it."""
        start = state
        while start is not None:
            loop = _Loop()
            self.loops.append(loop)
            end = self.body(body, dict(start))
            self.loops.pop()
            again = joined(start, end, *loop.passes)
            if again == start:
                return joined(start if ends else None, *loop.breaks)
            start = again
        return None

    def simple(self, statement: ir.Statement, state: State) -> State | None:
        match statement:
            case ir.ExitLoop() | ir.NextPass() if self.loops:
                kept = self.loops[-1].breaks if isinstance(statement, ir.ExitLoop) else self.loops[-1].passes
                kept.append(state)
                return None
            case ir.Return(value=value):
                left = state if value is None else self.calls(value, state)
                if left is not None:
                    self.returns.append(left)
                return None
            case ir.Goto(label=label):
                self.jumps[label.lower()] = joined(self.jumps.get(label.lower()), state) or state
                return None
            case ir.Move():
                self.note(statement, state)
            case ir.CallRoutine(name=name, dynamic=None):
                after = self.calls(statement.arguments, state)
                return None if after is None else self.called(name, after)
            case ir.CallRoutine():
                self.flow.calls_by_text = True
                return dict(_UNKNOWN)
            case ir.Assign(target=ir.System(name=name), value=value) if name in _FOLLOWED:
                new = self.stable(value) if name not in self.flow.usage.interrupting else None
                if name not in (_TURNS, _JOINED, _DOWN, "override", *_TIMES):
                    self.note_setting(statement, new is not None and state[name] == new)
                return {**state, name: new}
        return self.calls(statement, state)

    def note(self, statement: ir.Statement, state: State) -> None:
        if self.noting:
            self.flow.kept.append(statement)
            known = joined(self.flow.moves.get(id(statement)), state)
            self.flow.moves[id(statement)] = known if known is not None else state

    def note_setting(self, statement: ir.Assign, same: bool) -> None:
        if self.noting:
            self.flow.kept.append(statement)
            self.flow.repeated[id(statement)] = same and self.flow.repeated.get(id(statement), True)

    # ---- calls

    def calls(self, node: object, state: State) -> State | None:
        """The state behind the functions that an expression or a plain statement calls."""
        names = self.called_in.get(id(node))
        if names is None:
            names = self.called_in[id(node)] = tuple([one.name for one in walk(node) if isinstance(one, ir.Call)])
        after: State | None = state
        for name in names:
            if after is not None:
                after = self.called(name, after)
        return after

    def called(self, name: str, state: State) -> State | None:
        key = name.lower()
        if key not in self.routines:
            return state
        there = self.scopes.routine(*self.routines[key])
        entered = {setting: _carried(value, self.scope, there) for setting, value in state.items()}
        self.entries[key] = joined(self.entries[key], entered)
        left = self.exits[key]
        if left is None or key not in self.setting:
            return state if left is not None else None
        return {
            setting: _carried(value, there, self.scope) if key in self.setters[setting] else state[setting]
            for setting, value in left.items()
        }

    # ---- constants

    def stable(self, value: ir.Expression) -> ir.Expression | None:
        """The value when it is the same at every place and time."""
        match value:
            case ir.RealLiteral() | ir.IntLiteral() | ir.BoolLiteral():
                return value
            case ir.EnumLiteral(member=member):
                return ir.EnumLiteral(member.lower())
            case ir.System(name="null_frame" | "world"):
                return ir.System("null_frame")
            case ir.Quantity(value=inner) | ir.Unary(operand=inner) | ir.Convert(operand=inner):
                return value if self.stable(inner) is not None else None
            case ir.Field(base=base):
                return value if self.stable(base) is not None else None
            case ir.Index(base=base, indices=indices):
                return value if all(self.stable(one) is not None for one in (base, *indices)) else None
            case ir.Binary(left=left, right=right):
                return value if self.stable(left) is not None and self.stable(right) is not None else None
            case ir.Aggregate(entries=entries):
                return value if all(self.stable(one) is not None for _, one in entries) else None
            case ir.Name(id=name):
                symbol = self.scope.value(name)
                if symbol is None or symbol.routine is not None or not isinstance(symbol.declaration, ir.Variable):
                    return None
                fixed = symbol.declaration.storage == "constant" or name.lower() not in self.flow.usage.assigned
                return value if fixed else None
        return None


def _carried(value: ir.Expression | None, home: Scope, there: Scope) -> ir.Expression | None:
    """A constant of one routine as another one says it: what has no name there, or a name for something else, is said
    by its value, as far as that is written at its declaration."""
    if value is None or all(
        (here := home.value(one.id)) is not None
        and (seen := there.value(one.id)) is not None
        and seen.declaration is here.declaration
        for one in walk(value)
        if isinstance(one, ir.Name)
    ):
        return value
    symbol = home.value(value.id) if isinstance(value, ir.Name) else None
    written = symbol.declaration.initial if symbol and isinstance(symbol.declaration, ir.Variable) else None
    named = any(isinstance(one, ir.Name | ir.Index | ir.Field) for one in walk(written)) if written else True
    return None if named else written


def _beside(program: ir.Program) -> set[str]:
    """Routines that something else than a call may run."""
    names: set[str] = set()
    for node in walk(*program.modules):
        match node:
            case ir.DeclareInterrupt(action=ir.CallRoutine(name=name)) | ir.Trigger(action=ir.CallRoutine(name=name)):
                names.add(name.lower())
            case ir.ConnectInterrupt(routine=name) | ir.TaskControl(task=name) | ir.Routine(name=name, kind="trap"):
                names.add(name.lower())
    return names


def _setters(program: ir.Program) -> dict[str, frozenset[str]]:
    """Setting -> routines that change it, themselves or by what they call; behind others it is as before."""

    def sets(node: object) -> Iterable[str]:
        match node:
            case ir.Assign(target=ir.System(name=setting)) if setting in _FOLLOWED:
                return (setting,)
            case ir.CallRoutine(dynamic=dynamic) if dynamic is not None:
                return _FOLLOWED
        return ()

    return doing_each(program, sets, _FOLLOWED)
