"""Joint moves whose posture words ask for (V+ LEFTY, ABOVE, FLIP), for targets without such words: to the joints.

Place, tool and frame must be constant, and what the words leave open either known from the move before or no choice on
this arm. Other words go away: named as lost where the program asks for one and elsewhere for another posture.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.capabilities import Postures
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.framesinforce import FramesInForce
from rpl.passes.legalise.facts.usage import doing
from rpl.passes.legalise.facts.values.taughtvalues import JointsOfPlaces
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.walk import Rewriter, unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.values import Record, Target, Value, component, pose_of, real

_SAME_DEG = 0.01
_POSTURES = ("posture_shoulder", "posture_elbow", "posture_wrist")
POSTURE = code(
    "posture-change-lost",
    Severity.LOSS,
    "this move asks for another {name} than other moves; the target has no such setting and keeps the posture",
    "write the posture into the target of the move",
)
OPEN = code(
    "posture-left-open",
    Severity.WARNING,
    "this move asks for one part of the posture; how the arm stands otherwise is not known here, so it goes to the "
    "joints nearest to {where}",
)
_STANDING = (ir.Nothing, ir.Wait, ir.WaitUntil, ir.WaitForMotion, ir.LookAhead)


@legalising(unless=lambda context: set(_POSTURES) & context.capabilities.system_variables, sees=("Move",))
def asked_postures(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without the settings; solved for the arm that the program was written for."""
    if not any(isinstance(one, ir.Move) and _asked(one) for one in walk_for({"Move"}, *program.modules)):
        return program
    return _Asked(program, context).program()


class _Asked(Rewriter):
    """`here`: the joints that the move before went to, where they are known. `seen`: the last known ones before.
    `worded`: a move before has asked for a posture."""

    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        self.written = JointsOfPlaces(program, context)
        arm, other = context.robot, context.to_robot
        self.arm = arm if other is None or other is arm else None
        asked = [_asked(one).items() for one in walk_for({"Move"}, *program.modules) if isinstance(one, ir.Move)]
        self.varied = {name for name in _POSTURES if len({w for one in asked for n, w in one if n == name}) > 1}
        self.here: Any = None
        self.seen: Any = None
        self.worded = False
        named = {routine.name.lower() for module in program.modules for routine in module.routines}
        self.quiet = named - doing(program, lambda node: isinstance(node, ir.Move | ir.Vendor) or _calls_any(node))
        self.flow, self.unchanged = FramesInForce(program), unchanged_in(program)

    def body(self, body: ir.Body) -> ir.Body:
        self.here, self.seen, self.worded = None, None, False
        done = super().body(body)
        self.here, self.seen, self.worded = None, None, False
        return done

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        if isinstance(statement, ir.Move):
            return [self.move(statement)]
        if not isinstance(statement, _STANDING) and not self.stands(statement):
            self.here = None
        return super().statement(statement)

    def stands(self, statement: ir.Statement) -> bool:
        """A setting, an output, a value or a call that does not move the robot."""
        match statement:
            case ir.Assign(value=value):
                called = [node.name for node in walk(value) if isinstance(node, ir.Call)]
            case ir.CallRoutine(name=name, dynamic=None):
                called = [name]
            case _:
                return False
        return all(name.lower() in self.quiet for name in called)

    def move(self, move: ir.Move) -> ir.Move:
        asked = _asked(move)
        plain = replace(move, settings=_others(move)) if asked else move
        goal = constant(move.target, self.scope, self.unchanged)
        joints, self.seen = self.axes(goal), self.seen if self.here is None else self.here
        if move.relative is not None or move.search is not None:
            self.here = None
        elif joints is not None:  # joints say it all, whatever the words
            self.here = joints
            return plain
        else:
            self.here = self.solved(move, goal, asked)
        self.worded = self.worded or bool(asked)
        if move.kind != "joint" or not (asked or self.elsewise(move, goal)):
            return plain
        if self.here is None:
            for name in sorted(self.varied & asked.keys()):
                self.context.diagnostics.report(POSTURE, move.origin, name=name.replace("_", " "))
            return plain
        self.written.tell(move, self.scope, move.target)
        entries = tuple((name, real(round(float(one), 9))) for name, one in zip(ir.AXES, self.here, strict=False))
        return replace(plain, target=ir.Aggregate(entries, type_name="joints"))

    def elsewise(self, move: ir.Move, goal: Value | None) -> bool:
        """Does the arm come to this place without words, but as an earlier word has left it and not as it stands at
        first? Targets whose places say the posture would turn it back."""
        frames, arm, pose = self.flow.frames.get(id(move)), self.arm, pose_of(goal)
        if not self.worded or self.here is None or self.context.capabilities.places.postures is not Postures.FLAGS:
            return False
        flange = None if frames is None or pose is None else frames.flange(pose)
        if flange is None or arm is None:
            return False
        usual = arm.in_posture(flange.matrix, arm.home, {})
        return usual is None or abs(usual - self.here).max() > _SAME_DEG

    def solved(self, move: ir.Move, goal: Value | None, asked: dict[str, str]) -> Any:
        """The joints of a place, where nothing is left to chance."""
        frames, arm, here = self.flow.frames.get(id(move)), self.arm, self.here
        pose = pose_of(goal)
        if frames is None or pose is None or arm is None or move.kind != "joint":
            return None
        flange = frames.flange(pose)
        if flange is None or (isinstance(goal, Target) and any(value is not None for _, value in goal.flags)):
            return None
        if here is not None:
            return arm.in_posture(flange.matrix, here, asked)
        ways = [arm.in_posture(flange.matrix, one.joints, asked) for one in arm.inverse(flange.matrix, arm.home)]
        found = [None if way is None else arm.nearest_turn(way, arm.home) for way in ways]
        if not found or any(one is None or abs(one - found[0]).max() > 1e-6 for one in found):
            return self.guessed(move, flange.matrix, asked) if asked and found else None
        return found[0]

    def guessed(self, move: ir.Move, flange: Any, asked: dict[str, str]) -> Any:
        """The joints in the posture that is asked for, otherwise as the arm stood last or stands at first."""
        arm, near = self.arm, self.seen
        assert arm is not None
        way = arm.in_posture(flange, arm.home if near is None else near, asked)
        if way is not None:
            where = "its home position" if near is None else "the last joints that are known"
            self.context.diagnostics.report(OPEN, move.origin, where=where)
        return way

    def axes(self, value: object) -> Any:
        """Constant joint values (n,)."""
        import numpy as np

        if not isinstance(value, Record) or self.arm is None:
            return None
        found = [component(value, name) for name in ir.AXES[: self.arm.axes]]
        if not all(isinstance(one, int | float) for one in found):
            return None
        return np.array(found, dtype=np.float64)


def _calls_any(node: object) -> bool:
    """Calls by a computed name may reach every routine."""
    return isinstance(node, ir.CallRoutine) and node.dynamic is not None


def _asked(move: ir.Move) -> dict[str, str]:
    return {
        place.name: value.member
        for place, value in move.settings
        if isinstance(place, ir.System) and place.name in _POSTURES and isinstance(value, ir.EnumLiteral)
    }


def _others(move: ir.Move) -> tuple[tuple[ir.Expression, ir.Expression], ...]:
    return tuple(one for one in move.settings if not (isinstance(one[0], ir.System) and one[0].name in _POSTURES))


__all__ = ["asked_postures"]
