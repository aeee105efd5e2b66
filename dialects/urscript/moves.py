"""Moves, stops and modal settings of the robot.

Speeds and accelerations are written at each move or stand in the function's defaults; a time replaces them. There is no
modal speed and no frame: poses are of the tool in the robot's base. servoj, servoc, speedj and speedl drive the arm
directly; they are read as the moves they stand for, which is reported.
"""

from __future__ import annotations

from collections.abc import Callable

from rpl import ir
from rpl.diagnostics import Severity, code

from .arguments import Bound
from .calls import Calls
from .expressions import pose_literal
from .kinds import REAL, is_joints, is_number
from .nodes import Expr, ListOf, Number, PoseOf, Sign
from .rules import STEP_TIME_S

SERVO = code(
    "urscript-servo",
    Severity.INFO,
    "{name} is read as a move to its target in the given time",
    "look-ahead and gain of the controller are not followed",
)
RATE = code(
    "urscript-speed",
    Severity.INFO,
    "{name} is read as a move by speed times time that comes to rest at its end",
    "the controller goes on until it is told to stop",
)

Made = tuple[ir.Statement, ...]
Make = Callable[[Calls, Bound], Made | None]


def target(calls: Calls, goal: Expr | None) -> ir.Expression:
    """A place to go to: joints or a pose."""
    assert goal is not None  # the parameter has to be given
    return calls.joints(goal) if is_joints(calls.kind(goal)) else calls.value(goal)


def quantity(calls: Calls, value: Expr | None, unit: str) -> ir.Expression | None:
    return ir.Quantity(calls.value(value, REAL), unit) if value is not None else None


def literal(value: Expr | None) -> float | None:
    """The number that is written there."""
    match value:
        case Number(value=number):
            return float(number)
        case Sign(op="-", operand=Number(value=number)):
            return -float(number)
    return None


def _speed(calls: Calls, bound: Bound, joint: bool) -> ir.Speed:
    """A time other than 0 replaces speed and acceleration."""
    time = bound.get("t")
    duration = quantity(calls, time, "s") if time is not None and literal(time) != 0 else None
    if duration is not None and literal(time) is not None:
        return ir.Speed(duration=duration)
    if joint:
        axis, acceleration = quantity(calls, bound["v"], "rad/s"), quantity(calls, bound["a"], "rad/s2")
        return ir.Speed(axis=axis, axis_acceleration=acceleration, duration=duration)
    path, acceleration = quantity(calls, bound["v"], "m/s"), quantity(calls, bound["a"], "m/s2")
    return ir.Speed(path=path, path_acceleration=acceleration, duration=duration)


def _blend(calls: Calls, radius: Expr | None) -> ir.Blend:
    if radius is None or literal(radius) == 0:
        return ir.BlendStop()
    return ir.BlendDistance(quantity(calls, radius, "m"))


def _move(kind: str, motion_class: str = "classic") -> Make:
    def make(calls: Calls, bound: Bound) -> Made:
        goal = target(calls, bound["goal"])
        return (
            ir.Move(
                kind,
                goal,
                speed=_speed(calls, bound, kind == "joint"),
                blend=_blend(calls, bound["r"]),
                motion_class=motion_class,
                origin=calls.origin,
            ),
        )

    return make


def _circle(calls: Calls, bound: Bound) -> Made:
    """Mode 1 keeps the orientation to the arc; the orientation of the point on the way never counts."""
    mode = literal(bound["mode"])
    return (
        ir.Move(
            "circular",
            target(calls, bound["pose_to"]),
            via=target(calls, bound["pose_via"]),
            speed=_speed(calls, bound, False),
            blend=_blend(calls, bound["r"]),
            orientation="constant" if mode == 1 else None,
            circle_orientation="path" if mode == 1 else "base",
            motion_class="process",
            origin=calls.origin,
        ),
    )


def _servoj(calls: Calls, bound: Bound) -> Made:
    calls.diagnostics.report(SERVO, calls.origin, name="servoj")
    goal = bound["q"]
    assert goal is not None  # it has to be given
    speed = ir.Speed(duration=quantity(calls, bound["t"], "s"))
    return (ir.Move("joint", target(calls, goal), speed=speed, blend=ir.BlendStop(), origin=calls.origin),)


def _servoc(calls: Calls, bound: Bound) -> Made:
    calls.diagnostics.report(SERVO, calls.origin, name="servoc")
    return (
        ir.Move(
            "linear",
            target(calls, bound["pose"]),
            speed=_speed(calls, bound, False),
            blend=_blend(calls, bound["r"]),
            motion_class="process",
            origin=calls.origin,
        ),
    )


# ---- speedj, speedl


def _rates(calls: Calls, value: Expr | None, time: Expr | None) -> tuple[list[ir.Expression], list[Expr] | None] | None:
    """The six ways, speed times time, and the six speeds where they are written out."""
    if value is None or time is None or literal(time) == 0 or calls.kind(value) is None:
        return None
    parts = [calls.element(value, place) for place in range(6)]
    found = [part for part in parts if part is not None]
    if len(found) < 6:
        return None
    span = calls.value(time, REAL)
    listed = list(value.items) if isinstance(value, ListOf | PoseOf) else None
    none = ir.RealLiteral(0.0)
    return [none if _is_zero(part) else ir.Binary("*", part, span) for part in found], listed


def _is_zero(value: ir.Expression) -> bool:
    return isinstance(value, ir.IntLiteral | ir.RealLiteral) and value.value == 0


def _top(parts: list[ir.Expression]) -> ir.Expression:
    total: ir.Expression | None = None
    for part in parts:
        square = ir.Binary("**", part, ir.IntLiteral(2))
        total = square if total is None else ir.Binary("+", total, square)
    assert total is not None  # there are parts
    return ir.Builtin("sqrt", (total,))


def _is_short(time: Expr | None) -> bool:
    """One cycle of the controller: the caller sends the next one at once."""
    number = literal(time)
    return number is None or number <= 10 * STEP_TIME_S


def _speedj(calls: Calls, bound: Bound) -> Made | None:
    ways = _rates(calls, bound["qd"], bound["t"])
    if ways is None:
        return None
    calls.diagnostics.report(RATE, calls.origin, name="speedj")
    names = ("j1", "j2", "j3", "j4", "j5", "j6")
    goal = ir.Aggregate(tuple((n, ir.Quantity(w, "rad")) for n, w in zip(names, ways[0], strict=True)), "joints")
    speed = ir.Speed(duration=quantity(calls, bound["t"], "s"))
    return (ir.Move("joint", goal, relative="joints", speed=speed, blend=ir.BlendStop(), origin=calls.origin),)


def _speedl(calls: Calls, bound: Bound) -> Made | None:
    ways = _rates(calls, bound["xd"], bound["t"])
    if ways is None:
        return None
    calls.diagnostics.report(RATE, calls.origin, name="speedl")
    goal = pose_literal(ways[0])
    listed = ways[1]
    straight = listed is not None and all(literal(item) == 0 for item in listed[3:])
    if straight:
        turns = tuple((name, ir.RealLiteral(0.0)) for name in "abc")
        steps = tuple((name, ir.Quantity(way, "m")) for name, way in zip("xyz", ways[0], strict=False))
        goal = ir.Aggregate((*steps, *turns), "pose")
    if straight and listed is not None and not _is_short(bound["t"]) and any(literal(x) != 0 for x in listed[:3]):
        # Speed times time is the way of the ramp up, of the even part, and of the ramp down behind it.
        top = ir.Quantity(_top([calls.value(item, REAL) for item in listed[:3]]), "m/s")
        speed = ir.Speed(path=top, path_acceleration=quantity(calls, bound["a"], "m/s2"))
    else:
        speed = ir.Speed(duration=quantity(calls, bound["t"], "s"))
    return (ir.Move("linear", goal, relative="base", speed=speed, blend=ir.BlendStop(), origin=calls.origin),)


def _stop(calls: Calls, bound: Bound) -> Made:
    """The arm brakes, whatever moved it; what was to come is forgotten."""
    origin = calls.origin
    return (ir.StopMotion(origin=origin), ir.ClearMotion(origin=origin), ir.StartMotion(origin=origin))


# ---- tool and load


def _set_tcp(calls: Calls, bound: Bound) -> Made:
    return (ir.Assign(ir.System("tool"), calls.pose(bound["pose"]), origin=calls.origin),)


def _load(calls: Calls, bound: Bound) -> Made | None:
    mass, cog = bound.get("m"), bound.get("cog")
    entries: list[tuple[str | None, ir.Expression]] = []
    if mass is not None:
        entries.append(("mass", calls.value(mass, REAL)))
    if cog is not None:
        parts = calls.three(cog)
        if parts is None:
            return None
        centre = tuple((axis, ir.Quantity(part, "m")) for axis, part in zip("xyz", parts, strict=True))
        entries.append(("cog", ir.Aggregate(centre, "vector")))
    if mass is None:
        entries.append(("mass", ir.Field(ir.System("load"), "mass")))  # set_payload_cog keeps it
    if not is_number(calls.kind(mass) if mass is not None else REAL):
        return None
    return (ir.Assign(ir.System("load"), ir.Aggregate(tuple(entries), "load"), origin=calls.origin),)


MOVES: dict[str, Make] = {
    "movej": _move("joint"),
    "movel": _move("linear"),
    "movep": _move("linear", "process"),
    "movec": _circle,
    "servoj": _servoj,
    "servoc": _servoc,
    "speedj": _speedj,
    "speedl": _speedl,
    "stopj": _stop,
    "stopl": _stop,
    "set_tcp": _set_tcp,
    "set_payload": _load,
    "set_payload_mass": _load,
    "set_payload_cog": _load,
    "set_target_payload": _load,
}
