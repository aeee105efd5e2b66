"""Corners with a size in mm as CNT, which every controller has: CR is an option that no public program uses (counted:
0 of 5,591 moves). The controller's own model says how far before its end a move at a speed begins the corner of each
CNT; the one whose corner comes nearest is written, and never a larger one than the controller can drive. Where no
number says the path speed (the run decides it, or the move says a time) or the size, CR says the size.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

from rpl import ir
from rpl.controllerfiles import controller_named
from rpl.diagnostics import Severity, code
from rpl.motionmodel import MotionModel
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import kinds_in
from rpl.passes.legalise.rewriting.editing import edit_all, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising

from ..expressions import constant, measured

CORNER = code(
    "tp-corner-by-speed",
    Severity.WARNING,
    "a corner with a size in mm is written as the CNT that begins nearest at the speed of its move; farthest off:"
    " CNT{percent} for {distance:g} mm, which begins {made:g} mm before the point at {speed:g} mm/s",
    "CR says the distance where the controller has that option",
)
_MOST = 100
_TOLD_MM = 0.1  # what is nearer is not told


class _Made(NamedTuple):
    """A corner that is written: how far it is off, as CNT of what, mm before the point, at mm/s, of the move."""

    off: float
    percent: int
    distance: float
    made: float
    speed: float
    move: ir.Move


@legalising(sees=("Move",))
def continuous_corners(program: ir.Program, context: Context) -> ir.Program:
    """Behind what says the speed and the corner at each move."""
    if "BlendDistance" not in kinds_in(program):
        return program
    model, found = controller_named(context.target), list[_Made]()

    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Move):
            one = _made(statement, model)
            if one is None:
                return (statement,)
            found.append(one)
            begins = ir.BlendDistance(ir.RealLiteral(one.made))
            return (replace(statement, blend=ir.BlendPercent(ir.IntLiteral(one.percent), begins)),)
        return (inside(statement, body),)

    def body(statements: ir.Body) -> ir.Body:
        return map_body(statements, change, {"BlendDistance"})

    done = edit_all(program, body)
    worst = max(found, key=lambda one: one.off, default=None)
    if worst is not None and worst.off >= _TOLD_MM:
        shown = {
            "percent": worst.percent,
            "distance": worst.distance,
            "made": round(worst.made, 1),
            "speed": worst.speed,
        }
        context.diagnostics.report(CORNER, worst.move.origin, **shown)
    return done


def _made(move: ir.Move, model: MotionModel) -> _Made | None:
    """Of a path move whose corner has a size."""
    if move.kind == "joint" or not isinstance(move.blend, ir.BlendDistance) or move.blend.distance is None:
        return None
    size, speed, effort = measured(move.blend.distance, "mm"), _speed(move), _effort(move)
    if not size or speed is None or effort is None:
        return None
    percent = nearest_percent(model, size, speed, effort)
    made = round(model.overlap_distance_mm(percent, speed, effort), 3)
    return _Made(abs(made - size), percent, size, made, speed, move)


@lru_cache(maxsize=4096)
def nearest_percent(model: MotionModel, size_mm: float, speed_mm_s: float, effort: float = 1.0) -> int:
    """The CNT (1 to 100) whose corner begins nearest to that distance before the point, at a speed and a share of the
    acceleration."""
    return min(range(1, _MOST + 1), key=lambda n: abs(model.overlap_distance_mm(n, speed_mm_s, effort) - size_mm))


def _speed(move: ir.Move) -> float | None:
    """Of the path in mm/s, where it is a number."""
    path = None if move.speed is None else move.speed.path
    found = None if path is None else measured(path, "mm/s")
    return found if found else None


def _effort(move: ir.Move) -> float | None:
    """The acceleration as a share of the usual one, as `dialects/tp/motion.py` takes it; None: the run decides it."""
    if move.acceleration is None:
        return 1.0
    percent = constant(move.acceleration)
    return None if percent is None else max(percent / 100.0, 0.01)
