"""Actions on the way of a joint move at a constant place or time before its end: the program looks where the tool is
while the robot moves, and acts there. At a place that the run decides they are refused.

For targets whose moves can leave the program running (NWAIT) and that cut only straight moves at a place. A time before
the end is told from how far the tool has come since the last look, as if it braked evenly from there on.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.fold import Unchanged, constant_number
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.saidaccelerations import number_of
from rpl.passes.legalise.rewriting.beside import tidy
from rpl.passes.legalise.rewriting.editing import Editor
from rpl.passes.legalise.rewriting.stopping import stopped
from rpl.passes.legalise.settings.movesettings import plain
from rpl.passes.typing import type_of

WATCHED = code(
    "path-event-looked-for",
    Severity.WARNING,
    "an action on the path is done by the program, which looks every {seconds:g} s how far the tool is from the end;"
    " a time before the end is estimated from its speed",
)
COMPUTED = code(
    "path-event-computed-on-joint-move",
    Severity.LOSS,
    "how far before the end of a joint move an action comes, only the run knows; the target cuts no such move there",
    "give the distance as a constant, or drive straight",
    stops=True,
)


@dataclass(frozen=True, slots=True)
class Watched:
    """An action that comes where the tool is `way` mm from the end, or `time` s before it, or that long behind."""

    trigger: ir.Trigger
    way: float
    time: float

    @property
    def order(self) -> tuple[float, float]:
        return self.time, -self.way

    @property
    def apart(self) -> bool:
        """Does it come elsewhere than at the end?"""
        return bool(self.way or self.time)


def watched(
    move: ir.Move,
    given: list[ir.Trigger],
    goes_on: bool,
    editor: Editor,
    unchanged: Unchanged,
    temporary: Callable[[str, ir.Type], ir.Name],
) -> ir.Body | None:
    """The move with the looking behind it; None where that cannot be."""
    if move.kind != "joint" or move.relative is not None or move.search is not None or move.concurrent:
        return None
    refused = [one for one in given if _is_computed(one, editor, unchanged)]
    if refused:
        stops = [stopped(one, COMPUTED, editor.context) for one in refused]
        others, plain_move = [one for one in given if one not in refused], replace(move, triggers=())
        as_it_is: ir.Body = (*others, plain_move)
        looked = watched(plain_move, others, goes_on, editor, unchanged, temporary)
        return (*stops, *(as_it_is if looked is None else looked))
    size = _corner(move, editor, unchanged)
    events = [_event(one, editor, unchanged) for one in given]
    if size is None or any(one is None for one in events):
        return None
    found = [one for one in events if one is not None]
    apart = sorted((one for one in found if one.apart), key=lambda one: one.order)
    both = any(one.way for one in apart) and any(one.time for one in apart)
    if not apart or (len(apart) > 1 and both):
        return None
    poll = editor.capabilities.io.poll_s
    editor.context.diagnostics.report(WATCHED, given[0].origin, seconds=poll)
    names = temporary("to", ir.PoseType()), temporary("was", ir.RealType()), temporary("left", ir.RealType())
    started = [one.trigger for one in found if one.trigger.reference == "start"]
    ended = [one.trigger.action for one in found if one not in apart and one.trigger.reference != "start"]
    done: list[ir.Statement] = [
        *started,
        ir.Assign(names[0], _end(move, editor), origin=tidy(move.origin)),
        replace(move, triggers=(), concurrent=True),
    ]
    for one in apart:
        seconds = max(-one.time, 0.0)
        seconds = seconds if size else at_present_speed(seconds, ramp_s(move, editor.context))  # a corner brakes not
        done.extend(_until(move, one.way, seconds, names, poll, size))
        done.extend([_pause(one.time)] if one.time > 0.0 else [])
        done.append(replace(one.trigger.action, origin=one.trigger.origin))
    if not size:
        done.append(ir.WaitForMotion(origin=tidy(move.origin)))
    elif ended or not goes_on:
        done.extend(_until(move, size, 0.0, names, poll, 0.0))
    return (*done, *ended)


def at_present_speed(seconds: float, ramp: float | None) -> float:
    """How long the way that is left that time before the end takes at the speed of now: all of that time is braking,
    or its last part."""
    return seconds - ramp / 2.0 if ramp is not None and ramp < seconds else seconds / 2.0


def ramp_s(move: ir.Move, context: Context) -> float | None:
    """How long the move brakes from its full speed, in s; None where that is not known."""
    arm, speed = context.to_robot or context.robot, move.speed
    if speed is None or (move.kind == "joint" and arm is None):
        return None
    percent = 100.0 if move.acceleration is None else number_of(move.acceleration)
    if move.kind == "joint" and arm is not None:
        full, share, axis = float(min(arm.speeds)), number_of(speed.joint), number_of(speed.axis)
        fast = axis if share is None else full * share / 100.0
        rate = number_of(speed.axis_acceleration) or float(min(arm.accelerations))
    else:
        fast = number_of(speed.path)
        usual = rules_of(context.target).system_defaults.get("path_acceleration", 5000.0)
        rate = number_of(speed.path_acceleration) or float(usual)
    return fast / (rate * percent / 100.0) if fast is not None and percent else None


def _corner(move: ir.Move, editor: Editor, unchanged: Unchanged) -> float | None:
    """How far (mm) from its end the move goes over into the next one; 0: it stops there; None: it is computed."""
    match move.blend:
        case None | ir.BlendStop():
            return 0.0
        case ir.BlendDistance(distance=distance) if distance is not None:
            return constant_number(distance, editor.scope, unchanged)
    return None


def _is_computed(trigger: ir.Trigger, editor: Editor, unchanged: Unchanged) -> bool:
    distance = trigger.distance
    return distance is not None and constant_number(plain(distance), editor.scope, unchanged) is None


def _event(trigger: ir.Trigger, editor: Editor, unchanged: Unchanged) -> Watched | None:
    """None where its place is not known before, or counted from the start."""
    given = [plain(one) for one in (trigger.distance, trigger.delay) if one is not None]
    numbers = [constant_number(one, editor.scope, unchanged) for one in given]
    if None in numbers:
        return None
    distance = 0.0 if trigger.distance is None else numbers[0] or 0.0
    delay = 0.0 if trigger.delay is None else numbers[-1] or 0.0
    if distance > 0.0 or (trigger.reference == "start" and (distance or delay)) or (delay > 0.0 and not distance):
        return None
    return Watched(trigger, -distance, delay)


def _tool(move: ir.Move) -> ir.Expression:
    return move.tool if move.tool is not None else ir.System("tool")


def _end(move: ir.Move, editor: Editor) -> ir.Expression:
    """The end of the move as a pose in the robot's base."""
    target = move.target
    if isinstance(target, ir.Builtin) and target.function == "target_to_joints_near":
        target = target.arguments[0]
    elif isinstance(type_of(target, editor.scope), ir.JointsType):
        return ir.Builtin("joints_to_target", (target, _tool(move), ir.System("null_frame")))
    pose = ir.Builtin("pose_of", (target,))
    return pose if move.frame is None else ir.Binary(":", move.frame, pose)


def _until(
    move: ir.Move,
    way: float,
    time: float,
    names: tuple[ir.Name, ir.Name, ir.Name],
    poll: float,
    size: float,
) -> list[ir.Statement]:
    """Looks until the tool is so far from the end, or would come there in that time by its speed, at the latest where
    the corner begins."""
    end, was, left = names
    here = ir.Builtin("current_target", (_tool(move), ir.System("null_frame")))
    distance = ir.Builtin("distance", (ir.Field(here, "trans"), ir.Field(end, "trans")))
    near: ir.Expression = ir.RealLiteral(max(way, size))
    if time:
        near = ir.Binary("*", ir.Binary("-", was, left), ir.RealLiteral(float(f"{time / poll:.9g}")))
        near = ir.Binary("+", near, ir.RealLiteral(way)) if way else near
    comes: ir.Expression = ir.Binary("<=", left, near)
    if size and time:
        comes = ir.Binary("cor", comes, ir.Binary("<=", left, ir.RealLiteral(size)))
    leave = ir.If(((comes, (ir.ExitLoop(),)),))
    again: tuple[ir.Statement, ...] = (ir.Assign(was, left),) if time else ()
    first: tuple[ir.Statement, ...] = (ir.Assign(was, distance),) if time else ()
    looking: tuple[ir.Statement, ...] = (_pause(poll), ir.Assign(left, distance), leave, *again)
    origin = tidy(move.origin)
    return [replace(one, origin=origin) for one in (*first, ir.Loop(looking))]


def _pause(seconds: float) -> ir.Statement:
    return ir.Wait(ir.Quantity(ir.RealLiteral(seconds), "s"))


__all__ = ["COMPUTED", "Watched", "at_present_speed", "ramp_s", "watched"]
