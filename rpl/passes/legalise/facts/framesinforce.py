"""Which tool and frame hold at each move and at each question for joints, as poses, as far as they are constant.

Tool and frame of a move are its own or the modal ones; those are followed through assignments, branches, loops and
calls, as far as they are constant.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from rpl import ir
from rpl.ir.walk import bodies
from rpl.passes import rigid
from rpl.passes.fold import constant, element_key
from rpl.passes.legalise.facts.inforce import InForce, variable
from rpl.passes.legalise.facts.usage import each_expression, each_statement
from rpl.passes.legalise.kinds import kinds_in, kinds_within
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.rewrite import rewrite_parts, visit_parts
from rpl.passes.scope import Scope
from rpl.passes.values import Record, Value, pose_of

_MODAL = ("tool", "base", "robot_root")
_ASKING = frozenset(("target_to_joints", "target_to_joints_near", "is_reachable", "joints_to_target"))
_ASKED = frozenset(f"function {name}" for name in _ASKING)
_HEEDED = _ASKED | {"Move"} | {f"system {name}" for name in _MODAL}
_CHANGING = frozenset(("Assign", "For", "Do", "Dialog", "WaitUntil", "Clock", "DefineTrigger"))  # variables
State = Mapping[str, Value]


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


class FramesInForce(InForce[Value]):
    """Follows modal tool and frame through a whole program; `frames` has each move by identity, and each function that
    asks for the joints of a place, or for the place of joints, with what is in use then. A state has what is known of
    the settings and of variables that they rest on."""

    def __init__(self, program: ir.Program) -> None:
        super().__init__(program, {f"${name}": rigid.IDENTITY for name in _MODAL})
        made = frozenset[str]().union(*self.changed.values())
        self.unknown = {name: value for name, value in self.start.items() if name not in made}
        self.unchanged = unchanged_in(program)
        self.frames: dict[int, Frames] = {}
        self.known: dict[tuple[int, str], rigid.Pose | None] = {}
        self.relevant = _relevant(program)
        self.asking = not _ASKED.isdisjoint(kinds_in(program))
        self.heeds = _HEEDED | _CHANGING if self.relevant else _HEEDED
        self.follow_program()

    # ---- what the analysis asks

    def told(self, condition: ir.Expression, state: State) -> bool | None:
        known = constant(condition, self.scope, None, state) if _names(condition) & self.relevant else None
        return known if isinstance(known, bool) else None

    def note(self, statement: ir.Statement, before: State) -> None:
        if self.asking and not _ASKED.isdisjoint(kinds_within(statement)):
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

    def brought(self, state: State, home: Scope, there: Scope) -> State:
        return _outside(_outside(state, home), there)

    def left(self, before: State, end: State, routine: ir.Routine, there: Scope, here: Scope) -> State:
        own = {name: value for name, value in before.items() if not _is_outside(name, here)}
        behind = super().left(before, end, routine, there, here)
        return {**behind, **own} if own else behind

    def passed(self, call: ir.CallRoutine | ir.Call, state: State) -> State:
        """Variables that the call may change through its parameters are forgotten."""
        routine = self.scope.routine(call.name)
        lent = routine is not None and any(one.mode == "reference" for one in routine.parameters)
        return super().passed(call, state) if lent else state

    def assigned(self, name: str, target: ir.Expression, value: ir.Expression, before: State) -> State:
        scope, kept = self.scope, self.without(before, {name})
        match target:
            case ir.System(name=setting) if setting in _MODAL:
                return _with(kept, name, pose_of(constant(value, scope, self.unchanged, before)))
            case ir.Name() if name in self.relevant:
                return _with(kept, name, constant(value, scope, self.unchanged, before))
            case ir.Index(base=ir.Name(), indices=indices) if name in self.relevant:
                places = [constant(index, scope, self.unchanged, before) for index in indices]
                whole = [int(place) for place in places if isinstance(place, int | float)]
                if len(whole) == len(places):
                    others = {one: known for one, known in before.items() if one != name}
                    return _with(others, element_key(name, whole), constant(value, scope, self.unchanged, before))
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


def _with(state: State, name: str, value: Value | None) -> State:
    return {one: known for one, known in state.items() if one != name} if value is None else {**state, name: value}


def _is_outside(name: str, scope: Scope) -> bool:
    symbol = None if name.startswith("$") else scope.value(variable(name))
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


__all__ = ["Frames", "FramesInForce"]
