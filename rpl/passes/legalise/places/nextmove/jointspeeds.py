"""Speeds of joint moves in the other measure: percent of the axes and millimetres of the tool a second.

One controller says how much of their speed the axes use, another how fast the tool goes at most. What one is in the
other hangs on the arm and on the move, so it is worked out for each move whose ends are known: the tool's way along the
even motion of the axes, and the time that the slowest of them needs for it. The speed that is written is the one with
which the move is as fast, ramps apart. Moves whose ends the run decides get what is usual in the same program, or what
the arm's first axis does. The ends stand here as the source says them, so this is before postures are chosen for the
target.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from statistics import median
from typing import Any

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Arm, Context, array
from rpl.passes.legalise.facts.motion.whereabouts import NOWHERE_KNOWN, Stand, Whereabouts
from rpl.passes.legalise.facts.settingsinforce import SettingsInForce
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_all, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.values import Record, pose_of

MEASURED = code(
    "measured-joint-speed",
    Severity.INFO,
    "the target says the speed of a joint move in another measure; {given} is written as {written}, with which it "
    "is as fast on {arm}",
    several="{count} joint moves have a speed in another measure, with which each is as fast: [{given}: {written}]",
)
USUAL = code(
    "usual-joint-speed",
    Severity.WARNING,
    "the target says the speed of a joint move in another measure, and where this one begins or ends is not known "
    "here; {given} is written as {written}, as is usual for {arm}",
    "compare how long this move takes",
)
# Chords along which the tool's way is measured, as the emulator does for moves of 36 degrees.
_CHORDS = 9
# What a joint move does on average of what the first axis alone could do with the tool, for moves of which nothing is
# known: of the moves in our samples between 0.3 and 0.7.
_USUAL_SHARE = 0.5
# Shares and limits of all speeds are worked into the moves later, in the measure of the source: programs that set them
# keep it.
_SHARES = ("speed_percent", "speed_limit")
_LEAST_WAY = 1e-3  # mm and deg; less is no way


@dataclass(frozen=True, slots=True)
class _Behind(Stand):
    """Behind a path move: its end is worked out when a joint move follows."""

    move: ir.Move | None = None


@legalising(sees=("Move",))
def joint_speeds(program: ir.Program, context: Context) -> ir.Program:
    """Only between languages of which one says percent of the axes and the other millimetres a second, where an arm is
    given."""
    arm = context.to_robot or context.robot
    if arm is None or context.robot is None or not any(_spoken(one) for one in _joint_moves(*program.modules)):
        return program
    if any(isinstance(one, ir.System) and one.name in _SHARES for one in walk_for({"System"}, *program.modules)):
        return program
    speeds = _Speeds(program, context, context.robot, arm)
    return edit_all(program, speeds.body) if speeds.found else program


def _joint_moves(*nodes: object) -> Iterator[ir.Move]:
    return (one for one in walk(*nodes) if isinstance(one, ir.Move) and one.kind == "joint")


def _spoken(move: ir.Move) -> bool:
    """May its speed need another measure? One by time needs none."""
    return move.speed is None or move.speed.duration is None


class _Ends(Whereabouts):
    """tool_speeds: of joint moves by identity, how fast the tool goes on average when the axes go as fast as they can,
    mm/s."""

    def __init__(self, program: ir.Program, context: Context, source: Arm, arm: Arm) -> None:
        self.tool_speeds: dict[int, float] = {}
        self.of_source, self.runs_on = source, arm
        super().__init__(program, replace(context, to_robot=None), settled=True)

    def moved(self, move: ir.Move, stand: Stand) -> Stand:
        if move.kind != "joint":
            return NOWHERE_KNOWN if move.search is not None or move.relative else _Behind(move=move)
        flange = self.flange_behind(stand.move) if isinstance(stand, _Behind) and stand.move is not None else None
        near = stand.joints or tuple(float(one) for one in self.of_source.home)
        end = self.end(move, replace(NOWHERE_KNOWN, joints=near, flange=flange or stand.flange, seen=stand.seen))
        start = stand.joints
        if start is None and flange is not None and end.joints is not None:
            start = self.nearest(flange, end.joints)
        frames = self.flow.frames.get(id(move))
        if start is not None and end.joints is not None and frames is not None and frames.tool is not None:
            speed = self.tool_speed(start, end.joints, array(frames.tool.matrix))
            if speed is not None:
                self.tool_speeds[id(move)] = speed
        return end

    def flange_behind(self, move: ir.Move) -> Any:
        pose, frames = pose_of(constant(move.target, self.scope, self.unchanged)), self.flow.frames.get(id(move))
        return None if pose is None or frames is None else frames.flange(pose)

    def tool_speed(self, start: Any, end: Any, tool: Any) -> float | None:
        """mm/s; None where the arm that runs the result reaches an end of the move in no posture, or nothing moves."""
        import numpy as np

        first, last, arm = array(start), array(end), self.runs_on
        if arm is not self.of_source:
            last = arm.nearest(self.of_source.forward(last), arm.home)
            first = None if last is None else arm.nearest(self.of_source.forward(first), last)
            if first is None or last is None:
                return None
        way = np.abs(last - first)
        joints = first + np.linspace(0.0, 1.0, _CHORDS + 1)[:, None] * (last - first)
        points = (arm.forward(joints) @ tool)[:, :3, 3]
        length = float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
        if way.max() < _LEAST_WAY or length < _LEAST_WAY:
            return None
        return length / float(np.max(way / np.asarray(arm.speeds)))


class _Speeds:
    """found: is there anything to say in another measure?"""

    def __init__(self, program: ir.Program, context: Context, source: Arm, arm: Arm) -> None:
        self.context, self.arm = context, arm
        self.percents = context.capabilities.settings.modal  # else speeds of the tool
        self.flow = SettingsInForce.begun_by(program, context.source)
        self.unchanged = unchanged_in(program)
        self.given: dict[int, float | None] = {}
        scopes = ProgramScope(program)
        for module, routine in scopes.routines():
            scope = scopes.routine(module, routine)
            for one in _joint_moves(*bodies(routine)):
                self.given[id(one)] = self.speed(one, scope)
        self.found = any(value is not None for value in self.given.values())
        if self.found:
            # A speed of the tool is as long for every arm; percent of the axes are those of the arm that has them.
            self.ends = _Ends(program, context, source, arm if self.percents else source)
            known = sorted(self.ends.tool_speeds.values())
            self.usual = median(known) if known else _usual(arm)

    def speed(self, move: ir.Move, scope: Scope) -> float | None:
        """The number that the target says otherwise: mm/s or percent, None where there is nothing to do."""
        speed = move.speed or ir.Speed()
        if not _spoken(move):
            return None
        if self.percents:
            if speed.joint is not None or speed.axis is not None:
                return None
            path = None if speed.path is None else constant(speed.path, scope, self.unchanged)
            if path is None and speed.profile is not None:
                profile = constant(speed.profile, scope, self.unchanged)
                path = profile.part("path") if isinstance(profile, Record) else None
            return float(path) if isinstance(path, int | float) and path > 0.0 else None
        if speed.path is not None or speed.profile is not None or speed.axis is not None:
            return None
        own = next((value for name, value in move.settings if name == ir.System("joint_speed")), None)
        said = speed.joint or own or self.flow.at(move)["joint_speed"]
        percent = None if said is None else constant(said, scope, self.unchanged)
        return float(percent) if isinstance(percent, int | float) and 0.0 < percent < 100.0 else None

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def statement(self, statement: ir.Statement) -> ir.Body:
        given = self.given.get(id(statement)) if isinstance(statement, ir.Move) else None
        if not isinstance(statement, ir.Move) or given is None:
            return (inside(statement, self.body),)
        own = self.ends.tool_speeds.get(id(statement))
        full = own or self.usual
        if self.percents:
            percent = min(100.0, _rounded(100.0 * given / full))
            speed, said = ir.Speed(joint=ir.RealLiteral(percent)), (f"{given:g} mm/s", f"{percent:g} %")
        else:
            path = float(f"{given / 100.0 * full:.3g}")
            speed, said = ir.Speed(path=ir.RealLiteral(path)), (f"{given:g} %", f"{path:g} mm/s")
        what = USUAL if own is None else MEASURED
        self.context.diagnostics.report(what, statement.origin, given=said[0], written=said[1], arm=self.arm.name)
        kept = tuple(pair for pair in statement.settings if pair[0] != ir.System("joint_speed"))
        return (replace(statement, speed=speed, settings=kept),)


def _rounded(percent: float) -> float:
    """Whole percent, as people write them; below ten with two digits."""
    return max(float(round(percent)) if percent >= 10.0 else float(f"{percent:.2g}"), 0.01)


def _usual(arm: Arm) -> float:
    """mm/s of the tool when the axes go as fast as they can, for a move of which nothing is known."""
    x, y = (float(one) for one in arm.forward(array(arm.home))[:2, 3])
    return max(_USUAL_SHARE * math.radians(float(arm.speeds[0])) * math.hypot(x, y), 100.0)


__all__ = ["joint_speeds"]
