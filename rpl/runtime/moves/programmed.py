"""What a program asks of one move, in measures that hold for every controller: speeds, accelerations, the corner at its
end, tool, frame, and the joints that it means. Runs of two programs are compared by it without looking at dynamics.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpl.runtime.moves.chain import Planning, frames_of, is_joints
from rpl.runtime.moves.orders import BlendOrder, Order, Programmed

if TYPE_CHECKING:
    from rpl.emulator.planner import MoveRequest, PlannedMove
    from rpl.passes import rigid

# Shorter ways (mm) are none: the move turns on the spot.
_NO_WAY_MM = 0.01


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
    """Tool and work object that the program has given; external axes move the latter, which is not counted here. A move
    to joint values is seen from no work object, whatever it names or is set."""
    frames = frames_of(order.tool, order.frame, plan.modal, order.modal, plan.scene, plan.external)
    given = {"tool": order.tool, "base": order.frame}
    tool, frame = (
        given[name] is not None or order.modal.get(name) is not None or plan.modal.get(name) is not None
        for name in ("tool", "base")
    )
    seen = frame and not frames.stationary and not is_joints(order.target)
    return frames.tool if tool else None, frames.frame if seen else None


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
