"""Moves, stops and modal settings of the robot.

Speeds and accelerations are written at each move or stand in the function's defaults; a time replaces them. There is no
modal speed and no frame: poses are of the tool in the robot's base. servoj and servoc drive the arm directly; they are
read as the moves they stand for, which is reported. speedj and speedl begin a motion that goes on.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code

from .arguments import Bound
from .calls import Calls
from .expressions import pose_literal
from .kinds import REAL, is_joints, is_number
from .nodes import Expr, Number, Sign

SERVO = code(
    "urscript-servo",
    Severity.INFO,
    "{name} is read as a move to its target in the given time",
    "look-ahead and gain of the controller are not followed",
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
    made = ir.Move("joint", target(calls, goal), speed=speed, blend=ir.BlendStop(), origin=calls.origin)
    return (replace(made, motion_class="servo"),)


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


def _rate(joint: bool, name: str) -> Make:
    """A motion that goes on: its six speeds are the way in a second (script manual: accelerate, and continue with
    constant speed; the function returns after its time, else when the speed is reached)."""

    def make(calls: Calls, bound: Bound) -> Made | None:
        value = bound[name]
        if value is None or calls.kind(value) is None:
            return None
        parts = [part for part in (calls.element(value, place) for place in range(6)) if part is not None]
        if len(parts) < 6:
            return None
        acceleration, time = quantity(calls, bound["a"], "rad/s2" if joint else "m/s2"), bound["t"]
        duration = quantity(calls, time, "s") if time is not None and literal(time) != 0 else None
        if joint:
            turns = tuple((f"j{axis}", ir.Quantity(part, "rad")) for axis, part in enumerate(parts, 1))
            goal: ir.Expression = ir.Aggregate(turns, "joints")
            speed = ir.Speed(axis_acceleration=acceleration, duration=duration)
        else:
            goal = _shift(parts)
            speed = ir.Speed(path_acceleration=acceleration, duration=duration)
        return (
            ir.Move(
                "joint" if joint else "linear",
                goal,
                relative="joints" if joint else "base",
                speed=speed,
                blend=ir.BlendStop(),
                motion_class="velocity",
                origin=calls.origin,
            ),
        )

    return make


def _shift(parts: list[ir.Expression]) -> ir.Expression:
    """A way and a turn in the axes of the base; most ways turn nothing."""
    if not all(isinstance(part, ir.IntLiteral | ir.RealLiteral) and part.value == 0 for part in parts[3:]):
        return pose_literal(parts)
    way = tuple((axis, ir.Quantity(part, "m")) for axis, part in zip("xyz", parts, strict=False))
    return ir.Aggregate((*way, *((angle, ir.RealLiteral(0.0)) for angle in "abc")), "pose")


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
    inertia = calls.three(bound.get("inertia"))
    if inertia is not None:  # about the centre of gravity, in the flange's axes; the products of inertia have no place
        entries.extend(zip(("ix", "iy", "iz"), inertia, strict=True))
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
    "speedj": _rate(True, "qd"),
    "speedl": _rate(False, "xd"),
    "stopj": _stop,
    "stopl": _stop,
    "set_tcp": _set_tcp,
    "set_payload": _load,
    "set_payload_mass": _load,
    "set_payload_cog": _load,
    "set_target_payload": _load,
}
