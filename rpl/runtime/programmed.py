"""What a program asks of one move, in measures that hold for every controller: speeds, accelerations, the corner at its
end, tool, frame, and the joints that it means. Runs of two programs are compared by it without looking at dynamics.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rpl.runtime.chain import Planning, frames_of

if TYPE_CHECKING:
    from rpl.emulator.planner import MoveRequest, PlannedMove
    from rpl.emulator.rotations import FloatArray
    from rpl.passes import rigid
    from rpl.runtime.orders import BlendOrder, Order

# Shorter ways (mm) are none: the move turns on the spot.
_NO_WAY_MM = 0.01


@dataclass(frozen=True, slots=True, eq=False)
class Programmed:
    """A move as it is asked for. None: the program does not say it, or it has no meaning for this move.

    path_mm_s: of the tool on a path. turning_deg_s: of its orientation. joint_share: of the leading axis' greatest
    speed. seconds: a time of its own, and planned_s what that gives. acceleration: with its unit, absolute or a share
    of what the controller has; driven_acceleration: what this arm makes of it (mm/s2 on a path, else the share of the
    axes' own), for two that do not compare. usual_acceleration: the program says none, and its language has a
    value of its own at the start. corner_mm: the size of the corner at its end, 0 for a stop, None where it is not a
    length. tool: the tool centre point in the flange. frame: the work object. joints (n,): where the arm is to stand,
    with turns. rate: the part of a path per second at which the slowest of path, turning and external axes lets it go.
    """

    kind: str
    path_mm_s: float | None = None
    turning_deg_s: float | None = None
    joint_share: float | None = None
    seconds: float | None = None
    planned_s: float = 0.0
    acceleration: tuple[float, str] | None = None
    driven_acceleration: float | None = None
    usual_acceleration: bool = False
    corner_mm: float | None = None
    tool: rigid.Pose | None = None
    frame: rigid.Pose | None = None
    joints: FloatArray | None = None
    rate: float | None = None

    def __deepcopy__(self, memo: object) -> Programmed:
        return self


def programmed_of(order: Order, request: MoveRequest, plan: Planning, planned: PlannedMove | None) -> Programmed:
    """What is asked of a move. `planned` None: a segment of a spline block, which has no plan of its own."""
    import numpy as np

    tool, frame = _frames(order, plan)
    speed = order.speed
    says_turning = speed.profile is not None or speed.rotation is not None or _says("swivel_speed", order, plan)
    length = planned.length_mm if planned is not None else _NO_WAY_MM
    joint = request.kind == "joint" and planned is not None
    share = None
    if planned is not None and joint:
        ways = np.abs(planned.end_joints - planned.start_joints) / plan.model.speeds
        share = float(planned.profile.speed * ways.max()) if ways.max() > 1e-9 else None
    return Programmed(
        order.kind,
        path_mm_s=None if joint or length < _NO_WAY_MM else request.path_speed_mm_s,
        turning_deg_s=None if joint or not says_turning else request.ori_speed_deg_s,
        joint_share=share,
        seconds=request.duration_s,
        planned_s=planned.duration_s if planned is not None else 0.0,
        acceleration=_acceleration(order, request, plan),
        driven_acceleration=request.path_acc_mm_s2 if request.kind != "joint" else float(np.min(request.joint_acc)),
        usual_acceleration=request.kind != "joint" and _is_usual(order, plan),
        corner_mm=_corner_mm(order.blend),
        tool=tool,
        frame=frame,
        joints=planned.end_joints if planned is not None else None,
        rate=None if joint or planned is None else planned.profile.speed,
    )


def _frames(order: Order, plan: Planning) -> tuple[rigid.Pose | None, rigid.Pose | None]:
    """Tool and work object that the program has given; external axes move the latter, which is not counted here."""
    frames = frames_of(order.tool, order.frame, plan.modal, order.modal, plan.scene, plan.external)
    given = {"tool": order.tool, "base": order.frame}
    tool, frame = (
        given[name] is not None or order.modal.get(name) is not None or plan.modal.get(name) is not None
        for name in ("tool", "base")
    )
    return frames.tool if tool else None, frames.frame if frame and not frames.stationary else None


def _says(name: str, order: Order, plan: Planning) -> bool:
    """Has the program set this? What the controller begins with it has not."""
    if order.modal.get(name) is not None:
        return True
    value = plan.modal.get(name)
    return value is not None and value != order.rules.system_defaults.get(name)


def _is_usual(order: Order, plan: Planning) -> bool:
    known = order.rules.system_defaults.get("path_acceleration") is not None
    return known and order.speed.path_acceleration is None and not _says("path_acceleration", order, plan)


def _acceleration(order: Order, request: MoveRequest, plan: Planning) -> tuple[float, str] | None:
    """The acceleration in force and its unit: an absolute one, or a share of the controller's own. A move by time has
    none."""
    if request.duration_s:
        return None
    if request.kind == "joint":
        if order.speed.axis_acceleration is not None:
            return float(order.speed.axis_acceleration), "deg/s2"
        import numpy as np

        return float(np.min(request.joint_acc)), "of the axes'"
    absolute = order.speed.path_acceleration is not None or _says("path_acceleration", order, plan)
    return (request.path_acc_mm_s2, "mm/s2") if absolute else (request.effort, "of the controller's")


def _corner_mm(blend: BlendOrder) -> float | None:
    if blend.stops:
        return 0.0
    if blend.kind == "zone" and blend.zone is not None:
        return float(blend.distance if blend.distance is not None else blend.zone.get("path") or 0.0)
    return float(blend.distance) if blend.kind == "distance" and blend.distance is not None else None
