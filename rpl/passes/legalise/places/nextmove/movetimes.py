"""Times of moves for targets that cannot say them: the least time as a setting (V+ DURATION), and the time of one move
(URScript `t=`, TP `2.0sec`).

A least time becomes the time that a move says where it can say one (RAPID `\\T`), unless the way takes longer at the
speed in force. Else the move gets the speed that takes so long, with its ramps where the way is constant: a path by its
length, a move of the axes by the one that is the slowest. Where the way is not constant it is taken from where the
robot stands, so it has to stand there. Other moves keep their speed, which is named later.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.capabilities import MoveSetting, PathRule
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.effects import Effects, blocks
from rpl.passes.legalise.facts.motion.whereabouts import Way, Whereabouts
from rpl.passes.legalise.facts.settingsinforce import SettingsInForce, State
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.settings.explicit import TIMED_MOVE
from rpl.passes.legalise.settings.speeds import USUAL
from rpl.passes.legalise.stages import legalising
from rpl.passes.values import Value

BY_SPEED = code(
    "move-time-by-speed",
    Severity.WARNING,
    "the time of this move is kept by a speed that is worked out from its length{ramps}",
)
LEAST = code(
    "least-time-as-time",
    Severity.WARNING,
    "the least time of this move is written as its time: where its way takes longer at the speed in force ({speed}), "
    "the target is faster",
    "look that the time is long enough for the way",
)
_AT_RUN = "; its ramps take their time on top"
_KNOWN = " and the usual acceleration"
_TIME, _SPEED, _PERCENT = ir.System("move_duration"), ir.System("path_speed"), ir.System("joint_speed")
_ROTATION = "swivel_speed"
_MORE = 1.0 + 1e-9  # times what rounding may add
_SHORT_MM, _SMALL_DEG = 0.05, 0.05  # less than this is no way and no turn
# How fast the tool turns, and how that begins and ends, where nothing is said: the emulator's values, deg/s and deg/s2.
_TURN_SPEED, _TURN_ACCELERATION = 180.0, 600.0
Settings = tuple[tuple[ir.Expression, ir.Expression], ...]


@dataclass(frozen=True, slots=True)
class _Wanted:
    """Which times the target cannot say, and whether its moves say their own; `arcs`: also those on arcs."""

    least: bool
    own: bool
    said: bool
    arcs: bool


@legalising()
def move_times(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without the setting, or whose moves say no time."""
    can = context.capabilities
    said = "duration" in (can.settings.speeds or USUAL) and (
        not can.settings.modal or MoveSetting.SPEED in can.settings.of_moves
    )
    nodes = list(walk_for({"Move", "System"}, *program.modules))
    arcs = said and (PathRule.TIMED_ARCS in can.motion.paths or MoveSetting.SPEED not in can.settings.of_moves)
    timed = {node.kind == "circular" for node in nodes if isinstance(node, ir.Move) and _own(node) is not None}
    wanted = _Wanted(
        _TIME.name not in can.system_variables and _TIME in nodes,
        (not said and bool(timed)) or (not arcs and True in timed),
        said,
        arcs,
    )
    if not wanted.least and not wanted.own:
        return program
    facts = _Facts(program, context, wanted)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, _Times(editor, facts).body)

    return edit_routines(program, context, work)


class _Facts:
    """What holds in the whole program. `modal`: the least time in force is known at every move."""

    def __init__(self, program: ir.Program, context: Context, wanted: _Wanted) -> None:
        self.context, self.wanted = context, wanted
        self.ours = dict(rules_of(context.source).system_defaults)
        self.theirs = dict(rules_of(context.target).system_defaults)
        self.flow = SettingsInForce.of(program, self.ours)
        self.effects = Effects(program)
        self.places = Whereabouts(program, context)
        moves = [one for one in walk_for({"Move"}, *program.modules) if isinstance(one, ir.Move)]
        self.modal = wanted.least and all(self.flow.at(move)[_TIME.name] is not None for move in moves)

    def time(self, move: ir.Move) -> tuple[Settings, ir.Expression | None]:
        """The settings of the move without its least time, and that time; 0 is none."""
        kept = tuple(pair for pair in move.settings if pair[0] != _TIME)
        time = next((value for name, value in move.settings if name == _TIME), None)
        if time is None and self.modal:
            time = self.flow.at(move)[_TIME.name]
        return kept, None if _number(time) == 0.0 else time

    def acceleration(self, state: State) -> float:
        """Of paths, mm/s2: what the program has set, else what the target's controller takes."""
        name = "path_acceleration"
        found, ours = _number(state[name]), self.ours.get(name, 5000.0)
        can = self.context.capabilities  # such targets' moves say those of the source, or are set to them
        brought = name in can.settings.speeds or (name in can.system_variables and can.settings.modal)
        theirs = ours if brought else self.theirs.get(name, 5000.0)
        value = float(theirs if found is None or found == ours else found)
        return value * self.effort(state)

    def quick(self) -> ir.Expression | None:
        """The acceleration of a move whose time is kept by its speed alone, where the target is set to a lower one."""
        name, can = "path_acceleration", self.context.capabilities
        ours, theirs = self.ours.get(name), float(self.theirs.get(name, 5000.0))
        slower = isinstance(ours, int | float) and ours < theirs
        return ir.RealLiteral(theirs) if slower and name in can.system_variables and can.settings.modal else None

    def effort(self, state: State) -> float:
        found = _number(state["acceleration_percent"])
        return max((100.0 if found is None else found) / 100.0, 0.01)


class _Times:
    """The moves of one routine."""

    def __init__(self, editor: Editor, facts: _Facts) -> None:
        self.editor, self.facts, self.wanted, self.flow = editor, facts, facts.wanted, facts.flow

    def known(self, value: ir.Expression) -> Value | None:
        return constant(value, self.editor.scope, self.facts.places.unchanged)

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        stands = False
        for statement in body:
            if isinstance(statement, ir.Move):
                move = self.with_time(statement) if self.wanted.said else statement
                done.append(move if move is not statement else self.with_speed(statement, done, stands))
                stands = isinstance(statement.blend, ir.BlendStop)
                continue
            if isinstance(statement, ir.WaitForMotion):
                stands = True
            elif blocks(statement) or isinstance(statement, ir.CallRoutine | ir.Label):
                statement, stands = inside(statement, self.body), False
            elif self.facts.modal and isinstance(statement, ir.Assign) and statement.target == _TIME:
                statement = ir.Nothing(origin=statement.origin)  # each move says it
            done.append(statement)
        return tuple(done)

    # ---- a least time as the time of the move

    def with_time(self, move: ir.Move) -> ir.Move:
        """A move with a speed of its own keeps that, and gets no time: it would be faster where the way is long."""
        kept, time = self.facts.time(move)
        if time is None or _own(move) is not None or any(name in (_SPEED, _PERCENT) for name, _ in kept):
            return move
        if move.kind == "circular" and not self.wanted.arcs:
            return move
        natural, seconds = self.natural(move), self.known(time)
        if natural is None or not isinstance(seconds, int | float):
            if (shown := self.slowed(move)) is not None:
                self.editor.context.diagnostics.report(LEAST, move.origin, speed=shown)
        elif natural > seconds * _MORE:
            return replace(move, settings=kept)
        return replace(move, settings=kept, speed=replace(move.speed or ir.Speed(), duration=time))

    def slowed(self, move: ir.Move) -> str | None:
        """The speed in force where it is not the full one, in words."""
        state = self.flow.at(move)
        name, unit = ("joint_speed", " %") if move.kind == "joint" else ("path_speed", " mm/s")
        found, full = _number(state[name]), _number(self.flow.start.get(name))
        if found is None:
            return "which hangs on the run"
        return None if full is not None and found * _MORE >= full else f"{found:g}{unit}"

    def natural(self, move: ir.Move) -> float | None:
        """Seconds that the move takes at the speed in force, its ramps left out; None where that is not known."""
        way, state, arm = self.facts.places.of(move), self.flow.at(move), self.facts.places.arm
        if move.kind == "joint":
            share = _number(state["joint_speed"])
            if way.axes is None or arm is None or share is None or share <= 0.0:
                return None
            return float(max(one / top for one, top in zip(way.axes, arm.speeds, strict=False))) * 100.0 / share
        speed = _number(state["path_speed"])
        return None if way.length_mm is None or speed is None or speed <= 0.0 else way.length_mm / speed

    # ---- a speed that takes the time

    def with_speed(self, move: ir.Move, before: list[ir.Statement], stands: bool) -> ir.Move:
        kept, least = self.facts.time(move)
        can_say = self.wanted.said and (move.kind != "circular" or self.wanted.arcs)
        own = None if can_say else _own(move)
        alone = move.speed is None or move.speed == ir.Speed(joint=move.speed.joint, path=move.speed.path)
        if own is None and (not self.wanted.least or not alone):
            return move
        time = least if own is None else own
        if time is None or move.search is not None:
            return replace(move, settings=kept) if self.wanted.least else move
        kept = kept if own is None else move.settings
        most = self.most(move, kept) if own is None else None
        speed, ramps = self.constant_speed(move, time, most), _KNOWN
        if speed is None:
            speed, ramps = self.speed_at_run(move, time, most, before, stands), _AT_RUN
        report = self.editor.context.diagnostics.report
        if speed is None:
            report(TIMED_MOVE, move.origin)
            speed = self.modal(move) if own is not None else ir.Speed()
        else:
            report(BY_SPEED, move.origin, ramps=ramps)
        return self.driven(replace(move, settings=kept), speed, own is None)

    def modal(self, move: ir.Move) -> ir.Speed:
        """The speed in force for moves that say none, where the program sets one."""
        state, name = self.flow.at(move), "joint_speed" if move.kind == "joint" else "path_speed"
        found = None if move.speed is None or move.speed.profile is not None else _number(state[name])
        if found is None:
            return ir.Speed()
        return ir.Speed(joint=ir.RealLiteral(found)) if move.kind == "joint" else ir.Speed(path=ir.RealLiteral(found))

    def driven(self, move: ir.Move, speed: ir.Speed, least: bool) -> ir.Move:
        """The move at a speed, which is a setting of this move where it had a least time only."""
        said = ((_SPEED, speed.path), (_PERCENT, speed.joint), (ir.System(_ROTATION), speed.rotation))
        if least and move.speed is not None and speed != ir.Speed():
            return replace(move, speed=speed)
        if least:
            own = tuple((name, value) for name, value in said if value is not None)
            names = [name for name, _ in own]
            return replace(move, settings=(*(pair for pair in move.settings if pair[0] not in names), *own))
        old = move.speed or ir.Speed()
        if speed == ir.Speed():
            return replace(move, speed=replace(old, duration=None))
        profile = old.profile if speed.path is not None or speed.joint is not None else None
        return replace(move, speed=replace(speed, profile=profile))

    def most(self, move: ir.Move, kept: Settings) -> ir.Expression | None:
        """The speed (mm/s or percent) that a move with a least time has otherwise."""
        own = None if move.speed is None else move.speed.joint if move.kind == "joint" else move.speed.path
        if own is not None:
            return own
        name = _PERCENT if move.kind == "joint" else _SPEED
        return next((value for one, value in kept if one == name), self.flow.at(move)[name.name])

    def constant_speed(self, move: ir.Move, time: ir.Expression, most: ir.Expression | None) -> ir.Speed | None:
        """The speed of a constant way."""
        way, arm, seconds = self.facts.places.of(move), self.facts.places.arm, self.known(time)
        if not isinstance(seconds, int | float) or seconds <= 0.0:
            return None
        state, highest = self.flow.at(move), math.inf if most is None else self.known(most)
        if move.acceleration is not None:
            state = {**state, "acceleration_percent": move.acceleration}
        if not isinstance(highest, int | float):
            return None
        if move.kind == "joint":
            if way.axes is None or arm is None:
                return None
            full = float(max(one / top for one, top in zip(way.axes, arm.speeds, strict=False)))
            if full <= 0.0:
                return ir.Speed(joint=ir.RealLiteral(100.0))
            rates = [float(top) / one for one, top in zip(way.axes, arm.accelerations, strict=False) if one > 0.0]
            rate = slowed(seconds, min(rates) * self.facts.effort(state))
            return ir.Speed(joint=_real(min(rate * full * 100.0, highest, 100.0), 4))
        if way.length_mm is None or way.turn_deg is None:
            return None
        return self.path_speed(way, seconds, state, highest)

    def path_speed(self, way: Way, seconds: float, state: State, highest: float) -> ir.Speed | None:
        """Along a path; where the tool only turns, or turns faster than the target does unasked, the turn's too."""
        length, turn = way.length_mm or 0.0, way.turn_deg or 0.0
        if length <= _SHORT_MM and turn <= _SMALL_DEG:
            return ir.Speed(path=_real(100.0, 0))
        rates = []
        if length > _SHORT_MM:
            rates.append(self.facts.acceleration(state) / length)
        if turn > _SMALL_DEG:
            rates.append(_TURN_ACCELERATION * self.facts.effort(state) / turn)
        rate = slowed(seconds, min(rates))
        fast = rate * turn > 0.99 * float(self.facts.theirs.get(_ROTATION, _TURN_SPEED))
        rotation = _real(rate * turn, 3) if length <= _SHORT_MM or fast else None
        if length <= _SHORT_MM:
            return ir.Speed(rotation=rotation)
        return ir.Speed(path=_real(min(rate * length, highest), 3), rotation=rotation)

    def speed_at_run(
        self, move: ir.Move, time: ir.Expression, most: ir.Expression | None, before: list[ir.Statement], stands: bool
    ) -> ir.Speed | None:
        """The speed that is worked out from where the robot stands then."""
        steps = self.way(move, time)
        if not steps:
            return None
        origin = replace(move.origin, comments=())
        if not stands:
            before.append(ir.WaitForMotion(origin=origin))
        before += (replace(one, origin=origin) for one in steps)
        result = steps[0].target
        value: ir.Expression = ir.Binary("/", result, time)
        if most is not None:
            value = ir.Builtin("min", (most, value))
        if move.kind == "joint":
            value = ir.Builtin("min", (ir.RealLiteral(100.0), value))
        before.append(ir.Assign(result, value, origin=origin))
        if move.kind == "joint":
            return ir.Speed(joint=result)
        return ir.Speed(path=result, path_acceleration=self.facts.quick())

    def way(self, move: ir.Move, time: ir.Expression) -> list[ir.Assign]:
        """Steps whose first target ends as the length of the way (mm), or as 100 times the seconds at full speed: no
        less than 1 percent takes in the time, as a move to where the arm is has a speed too."""
        goal, arm = self.editor.type_of(move.target), self.facts.places.arm
        if move.relative or not self.facts.effects.quiet(move.target):
            return []
        if move.kind == "linear" and isinstance(goal, ir.PoseType | ir.TargetType):
            length = self.editor.temporary("move_speed", ir.RealType())
            here = ir.Field(ir.Builtin("current_target", _around(move)), "trans")
            return [ir.Assign(length, ir.Builtin("distance", (here, ir.Field(move.target, "trans"))))]
        there, solved = self.goal(move, goal)
        if there is None or arm is None:
            return []
        share = self.editor.temporary("move_share", ir.RealType())
        now = self.editor.temporary("joints_now", ir.JointsType())
        steps = [ir.Assign(share, time), *solved, ir.Assign(now, ir.Builtin("current_joints", ()))]
        for name, top in zip(ir.AXES, arm.speeds, strict=False):
            turn = ir.Builtin("abs", (ir.Binary("-", ir.Field(there, name), ir.Field(now, name)),))
            needed = ir.Binary("*", turn, ir.RealLiteral(round(100.0 / float(top), 6)))
            steps.append(ir.Assign(share, ir.Builtin("max", (share, needed))))
        return steps

    def goal(self, move: ir.Move, type: ir.Type | None) -> tuple[ir.Expression | None, list[ir.Assign]]:
        """The joints that a joint move goes to, and the step that works them out where it goes to a place."""
        can, ask = self.editor.context.capabilities, "target_to_joints"
        if move.kind != "joint" or isinstance(type, ir.JointsType):
            return (move.target, []) if move.kind == "joint" else (None, [])
        if not isinstance(type, ir.PoseType | ir.TargetType) or (
            can.places.kinematics is None and ask not in can.functions
        ):
            return None, []
        joints = self.editor.temporary("joints_there", ir.JointsType())
        return joints, [ir.Assign(joints, ir.Builtin(ask, (move.target, *_around(move))))]


def _around(move: ir.Move) -> tuple[ir.Expression, ...]:
    """The tool and the frame that the move names itself."""
    if move.tool is None:
        return ()
    return (move.tool,) if move.frame is None else (move.tool, move.frame)


def slowed(seconds: float, acceleration: float) -> float:
    """The top speed (1/s) of a move from rest to rest of that time, its ramps at this acceleration (1/s2); that of the
    shortest one where there is no such move. From 1/v + v/a = t."""
    rest = seconds * seconds - 4.0 / acceleration
    return math.sqrt(acceleration) if rest < 0.0 else 2.0 / (seconds + math.sqrt(rest))


def _own(move: ir.Move) -> ir.Expression | None:
    return None if move.speed is None else move.speed.duration


def _number(value: ir.Expression | None) -> float | None:
    """A number that is written out."""
    match value:
        case ir.RealLiteral(value=number) | ir.IntLiteral(value=number):
            return float(number)
        case ir.Quantity(value=inner, unit=unit):
            found = _number(inner)
            return None if found is None else found * ir.UNITS[unit]
    return None


def _real(value: float, digits: int) -> ir.RealLiteral:
    return ir.RealLiteral(round(float(value), digits))


__all__ = ["move_times", "slowed"]
