"""The mechanisms around a robot, as a run sees them: which one carries a frame, which one the robot rides, and what is
known of the external axes that move them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from rpl.passes import rigid
from rpl.runtime.faults import ProgramError
from rpl.runtime.values import PoseValue, Record, TargetValue, Value

if TYPE_CHECKING:
    from rpl.emulator.mechanismfile import Mechanism, MechanismAxis
    from rpl.emulator.rotations import FloatArray

External = tuple[float | None, ...]
EXTERNAL_SPEED = 500.0  # mm/s or deg/s of an external axis at 100 percent, for want of its data
# An axis whose data give a speed but no acceleration reaches it in this time; a model, as for the arm's own axes.
_RAMP_S = 0.3
_SIX = 6
_NO_UNIT = ("", "none")


@dataclass(frozen=True, slots=True)
class Scene:
    """The mechanisms of the robot's file and of the cell."""

    mechanisms: tuple[Mechanism, ...] = ()

    @property
    def rides(self) -> Mechanism | None:
        """The one that carries the robot."""
        return next((one for one in self.mechanisms if one.carries_robot), None)

    def called(self, name: str) -> Mechanism:
        """The mechanism of that name; a fault of the program where nobody has said where it stands."""
        for one in self.mechanisms:
            if one.is_called(name):
                return one
        raise ProgramError(
            "no_mechanism", f"no mechanism is called '{name}': a [[mechanism]] of the cell file says where it stands"
        )

    def mount_of(self, frame: Value, given: bool, unit: Value, root: Value) -> Mechanism | None:
        """What carries the frame of a move: the unit that its data name, or, of a frame that is `given` by nobody at
        the move, the modal `unit`, its root put to the place that the program says."""
        if isinstance(frame, Record):
            name = str(frame.get("unit") or "")
            named = frame.get("fixed") is False and not frame.get("held") and name.strip()
            return self.called(name) if named else None
        if given or not unit or str(unit) in _NO_UNIT:
            return None
        found = self.called(str(unit))
        return found if root is None else replace(found, root=_six(root), on_robot=False)

    def axis(self, number: int) -> MechanismAxis | None:
        """What is known of an external axis."""
        return next((axis for one in self.mechanisms for axis in one.axes if axis.number == number), None)

    def sliding(self) -> tuple[bool, ...]:
        """Which of the external axes slide; M: one that nobody describes is taken as a turning one."""
        known = [self.axis(place + 1) for place in range(_SIX)]
        return tuple(axis is not None and axis.sliding for axis in known)

    def options(self, start: External, goal: External, shares: list[float], efforts: list[float]) -> dict[str, Value]:
        """External axes from one place to another as a request has them, at shares of their speed and acceleration;
        nothing where there are none."""
        if not self.mechanisms and all(value is None for value in goal):
            return {}
        known = [self.axis(place + 1) for place in range(_SIX)]
        speeds = [axis.speed if axis is not None and axis.speed is not None else EXTERNAL_SPEED for axis in known]
        accs = [
            ((axis.acceleration if axis is not None else None) or speed / _RAMP_S) * effort
            for axis, speed, effort in zip(known, speeds, efforts, strict=True)
        ]
        return {
            "external_start": tuple(value or 0.0 for value in start),
            "external_target": tuple(value or 0.0 for value in goal),
            "external_speeds": tuple(top * share for top, share in zip(speeds, shares, strict=True)),
            "external_accs": tuple(accs),
            "external_limits": tuple(axis.limits if axis is not None else None for axis in known),
        }


NOTHING = Scene()


def place_of(mechanism: Mechanism, external: External) -> rigid.Pose:
    """Where a mechanism carries what stands on it."""
    from rpl.emulator.mechanisms import mechanism_pose

    return _pose(mechanism_pose(mechanism, [value or 0.0 for value in external] or [0.0]))


def _pose(matrix: FloatArray) -> rigid.Pose:
    return rigid.pose_of_matrix([[float(x) for x in row] for row in matrix])


def _six(value: Value) -> tuple[float, float, float, float, float, float]:
    pose = value.pose if isinstance(value, TargetValue) else value
    if not isinstance(pose, PoseValue):
        raise ProgramError("wrong_kind", "the root of a mechanism is a pose")
    place, turn = pose.rigid().position, pose.rigid().rotation.zyx
    return (place.x, place.y, place.z, *turn)


__all__ = ["NOTHING", "External", "Scene", "place_of"]
