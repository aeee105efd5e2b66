"""From a programmed target to what the emulator plans: tool, work object, robot base, missing components, speeds.

A target P is reached when  robot_root · FK(joints) · tool = frame · displacement · P.  With the part on the robot (a
stationary tool) the roles change:  robot_root · FK(joints) · part · displacement · P = tool.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

from rpl.emulator.postures import ASKED_POSTURES
from rpl.passes import rigid
from rpl.runtime.faults import ProgramError
from rpl.runtime.moves.orders import Modal, Order
from rpl.runtime.moves.scene import NOTHING, External, Scene, place_of
from rpl.runtime.values import (
    AxesValue,
    ConfigValue,
    ExternalValue,
    JointsValue,
    PoseValue,
    Record,
    RotationValue,
    TargetValue,
    Value,
    VectorValue,
    pose_of,
    used_axes,
)

if TYPE_CHECKING:
    from rpl.emulator.configuration import Notation, Selection
    from rpl.emulator.mechanismfile import Mechanism
    from rpl.emulator.mechanisms import Carrier
    from rpl.emulator.model import RobotModel
    from rpl.emulator.planner import MoveRequest
    from rpl.emulator.rotations import FloatArray
    from rpl.ir.rules import Rules
    from rpl.motionmodel import MotionModel

# What a controller that does not say otherwise does; base units.
DEFAULTS: Modal = {
    "path_speed": 250.0,
    "path_acceleration": 5000.0,
    "swivel_speed": 200.0,
    "twist_speed": 200.0,
    "swivel_acceleration": 1000.0,
    "twist_acceleration": 1000.0,
    "joint_speed": 100.0,
    "joint_acceleration": 100.0,
    "external_speed": 100.0,
    "external_acceleration": 100.0,
    "override": 100.0,
    "speed_percent": 100.0,
    "acceleration_percent": 100.0,
    "acceleration_ramp": 100.0,
    "stop_ramp": 100.0,
    "scale_acceleration": False,
    "path_limit_rule": "reduce",
    "orientation_mode": "variable",
    "circle_orientation": "base",
    "singularity_mode": "off",
}
_ORIENTATIONS: dict[str, Literal["interpolated", "constant", "wrist_joints"]] = {
    "variable": "interpolated",
    "constant": "constant",
    "wrist": "wrist_joints",
}


def convention_of(rules: Rules) -> str:
    """How a language writes rotations: zyx angles or a quaternion."""
    return "zyx" if "a" in rules.components.get("TargetType", ()) else "quaternion"


def matrix_of(pose: rigid.Pose) -> FloatArray:
    import numpy as np

    return np.array(pose.matrix)


def pose_of_array(matrix: FloatArray) -> rigid.Pose:
    return rigid.pose_of_matrix([[float(x) for x in row] for row in matrix])


def setting(modal: Modal, over: Modal, name: str, index: int | None = None) -> Value:
    """A system variable: of the move, else of the task, else the default. Indexed ones may be set per axis."""
    keys = (name,) if index is None else (f"{name}[{index}]", name)
    for table in (over, modal, DEFAULTS):
        for key in keys:
            value = table.get(key)
            if value is not None:
                return value
    return None


@dataclass(frozen=True, slots=True)
class Frames:
    """The frames of a move. Robot holds the tool: `tool` in the flange, `base` of the targets in the robot's base.
    `stationary`: `tool` is the part in the flange, `base` the fixed tool in the robot's base. `base` holds for the
    external axes of one moment; it comes from `frame` on its `mount` (or in the world) and from `root`, the robot's
    base on what it `rides` (or in the world)."""

    tool: rigid.Pose
    base: rigid.Pose
    stationary: bool
    frame: rigid.Pose = rigid.IDENTITY
    root: rigid.Pose = rigid.IDENTITY
    rides: Mechanism | None = None
    mount: Mechanism | None = None

    def at(self, external: External) -> Frames:
        """The same frames at other external axes."""
        root = self.root_at(external)
        if self.mount is None:
            return replace(self, base=root.inverse.then(self.frame))
        place = place_of(self.mount, external).then(self.frame)
        return replace(self, base=place if self.mount.on_robot else root.inverse.then(place))

    def led_by(self, leader: Mechanism, external: External) -> Frames:
        """The same frames, standing in the room, as parts of the leader's moving frame when it is at its end."""
        place = place_of(leader, external)
        if leader.on_robot:
            place = self.root_at(external).then(place)
        return replace(self, frame=place.inverse.then(self.frame), mount=leader).at(external)

    def root_at(self, external: External) -> rigid.Pose:
        """The robot's base in the world."""
        return self.root if self.rides is None else place_of(self.rides, external).then(self.root)

    def target_in_work(self, goal: rigid.Pose) -> rigid.Pose:
        """The tool's pose in the work that a carrier plans in (see rpl.emulator.mechanisms)."""
        return (self.tool if self.stationary else self.frame).then(goal)

    def carrier(self) -> Carrier | None:
        """What carries work, tool or robot; None where nothing of them moves with the flange or external axes."""
        if not self.stationary and self.rides is None and self.mount is None:
            return None
        from rpl.emulator.mechanisms import Carrier as Made

        tool = self.frame if self.stationary else self.tool
        return Made(matrix_of(tool), matrix_of(self.root), self.stationary, self.rides, self.mount)

    def target_in_robot(self, goal: rigid.Pose) -> tuple[rigid.Pose, rigid.Pose]:
        """The pose to go to and the moving point in the flange that goes there."""
        if self.stationary:
            return self.base, self.tool.then(goal)
        return self.base.then(goal), self.tool

    def goal_of(self, flange: rigid.Pose) -> rigid.Pose:
        """The target that the flange's pose means in these frames."""
        if self.stationary:
            return self.tool.inverse.then(flange.inverse).then(self.base)
        return self.base.inverse.then(flange).then(self.tool)


def frames_of(
    tool: Value, frame: Value, modal: Modal, over: Modal, scene: Scene = NOTHING, external: External = (),
    known: bool = True,
) -> Frames:  # fmt: skip
    """Tool and frame as given at the move, else the modal ones; at external axes. Without a robot it is not `known`
    where mechanisms are: a frame on one of them then is where it stands."""
    given = frame is not None
    tool = tool if tool is not None else setting(modal, over, "tool")
    frame = frame if frame is not None else setting(modal, over, "base")
    held = not isinstance(tool, Record) or bool(tool.get("held"))
    part_held = isinstance(frame, Record) and bool(frame.get("held"))
    modal_stationary = setting(modal, over, "interpolation") == "tool" or bool(setting(modal, over, "held_work"))
    root = _rigid(setting(modal, over, "robot_root"))
    if isinstance(tool, Record) and isinstance(frame, Record) and held == part_held:
        raise ProgramError("motion", "tool and work object must not both be held, or both stationary")
    tool_pose = _tool_pose(tool)
    frame_pose = _frame_pose(frame).then(_rigid(setting(modal, over, "displacement")))
    rides = scene.rides
    if isinstance(tool, Record) and not held:
        made = Frames(frame_pose, rigid.IDENTITY, True, tool_pose, root, rides)
    elif modal_stationary and not isinstance(tool, Record):
        made = Frames(tool_pose, rigid.IDENTITY, True, frame_pose, root, rides)
    else:
        of_frame = {} if "base" in over else modal  # a frame of the move alone is not on what carries the modal one
        unit, place = (setting(of_frame, over, name) for name in ("base_unit", "base_root"))
        mount = scene.mount_of(frame, given, unit, place) if known else None
        made = Frames(tool_pose, rigid.IDENTITY, False, frame_pose, root, rides, mount)
    return made.at(external)


def _rigid(value: Value) -> rigid.Pose:
    if value is None:
        return rigid.IDENTITY
    if isinstance(value, TargetValue):
        value = value.pose
    if isinstance(value, PoseValue):
        return value.rigid()
    raise ProgramError("wrong_kind", "a pose is needed here")


def _tool_pose(value: Value) -> rigid.Pose:
    return _rigid(value.get("frame") if isinstance(value, Record) else value)


def _frame_pose(value: Value) -> rigid.Pose:
    if isinstance(value, Record):
        return _rigid(value.get("user_frame")).then(_rigid(value.get("object_frame")))
    return _rigid(value)


# ---- targets


def filled(value: Value, before: rigid.Pose) -> rigid.Pose:
    """The pose of a target; components that are left out stay as the last target has them."""
    pose = value.pose if isinstance(value, TargetValue) else value
    if isinstance(pose, VectorValue):
        pose = PoseValue(pose, RotationValue("zyx", (None, None, None)))
    if not isinstance(pose, PoseValue):
        raise ProgramError("wrong_kind", "a motion needs a pose, a target or joints")
    place = before.position
    trans = (place.x, place.y, place.z)
    xyz = [given if given is not None else old for given, old in zip(pose.trans, trans, strict=True)]
    parts = pose.rot.parts
    if all(part is None for part in parts):
        rotation = before.rotation
    elif None in parts:
        old_parts = before.rotation.zyx if pose.rot.convention == "zyx" else before.rotation.quaternion
        mixed = tuple(given if given is not None else old for given, old in zip(parts, old_parts, strict=True))
        rotation = RotationValue(pose.rot.convention, mixed).rigid()
    else:
        rotation = pose.rot.rigid()
    return rigid.Pose(rigid.Vector(*xyz), rotation)


def shifted(value: Value, before: rigid.Pose, axes: str) -> rigid.Pose:
    """A relative target: the given components moved and turned in the axes of the frame or of the tool."""
    shift = filled(value, rigid.IDENTITY)
    if axes == "tool":
        return before.then(shift)
    return rigid.Pose(before.position.plus(shift.position), shift.rotation.then(before.rotation))


def joints_of(value: Value, before: Sequence[float], relative: bool) -> list[float]:
    """Joint values; those left out stay, or are moved by the given amounts."""
    axes = value.axes if isinstance(value, JointsValue) else value
    given = axes.values[: len(before)] if isinstance(axes, AxesValue) else ()
    joints = list(before)
    for axis, number in enumerate(given):
        if number is not None:
            joints[axis] = joints[axis] + number if relative else float(number)
    return joints


def external_of(value: Value, before: tuple[float | None, ...], relative: bool) -> tuple[float | None, ...]:
    """External axes after the move."""
    if isinstance(value, JointsValue | TargetValue):
        wanted = used_axes(value.ext.values)
    elif isinstance(value, ExternalValue):
        wanted = used_axes(value.values)
    else:
        return before
    done: list[float | None] = []
    for old, new in zip(before, wanted, strict=True):
        done.append(old if new is None else (old or 0.0) + new if relative else new)
    return tuple(done)


def is_joints(value: Value) -> bool:
    return isinstance(value, JointsValue | AxesValue)


def current_target(
    model: RobotModel, joints: FloatArray, external: tuple[float | None, ...], frames: Frames, rules: Rules,
    notation: Notation | None,
) -> TargetValue:  # fmt: skip
    """Where the tool centre point is, as the language shows it."""
    goal = frames.goal_of(pose_of_array(model.forward(joints)))
    flags: tuple[tuple[str, Value], ...] = ()
    if notation is not None:
        flags = tuple(notation.encode(model, joints).items())
    conf = ConfigValue(rules.name, flags)
    return TargetValue(pose_of(goal, convention_of(rules)), conf, external_value(external, rules))


def external_value(external: tuple[float | None, ...], rules: Rules) -> ExternalValue:
    """External axes as the language shows those that are not there: 9E9, or zero where every axis has a value."""
    absent = 0.0 if rules.undefined else 9e9
    return ExternalValue(tuple(absent if value is None else value for value in external))


def joints_value(joints: Sequence[float], external: tuple[float | None, ...], rules: Rules) -> JointsValue:
    values = [float(joint) for joint in joints[:6]]
    padded = tuple(values + [0.0] * (6 - len(values)))
    return JointsValue(AxesValue(padded), external_value(external, rules))


# ---- requests


@dataclass(slots=True)
class Planning:
    """What is known when a move is planned: where the robot will be then."""

    model: RobotModel
    joints: FloatArray
    external: tuple[float | None, ...]
    modal: Modal
    notation: Notation | None
    controller: MotionModel
    scene: Scene = NOTHING


def request_of(order: Order, plan: Planning) -> tuple[MoveRequest, rigid.Pose, rigid.Pose, tuple[float | None, ...]]:
    """The request, the moving point in the flange, the goal in the move's frame, the external axes after it."""
    import numpy as np

    frames = frames_in_room = frames_of(order.tool, order.frame, plan.modal, order.modal, plan.scene, plan.external)
    before = frames.goal_of(pose_of_array(plan.model.forward(plan.joints)))
    relative = order.relative is not None
    external = external_of(order.target, plan.external, relative)
    frames = _led(frames, order, plan, external)
    remote = _is_remote(frames, order, plan)
    carrier = None if order.velocity else _held(frames).carrier() if remote else frames.carrier()
    options = _common(order, plan, external) | {"carrier": carrier}
    if order.external_only:
        options |= {"kind": "joint", "target_joints": plan.joints}
        return _request(options), frames.tool, before, external
    if is_joints(order.target):
        joints = np.array(joints_of(order.target, [float(j) for j in plan.joints], relative))
        goal = frames.goal_of(pose_of_array(plan.model.forward(joints)))
        options |= {"target_joints": joints}
    else:
        goal = _goal(order.target, before, order.relative)
        options |= {"target_pose": matrix_of(_planned(frames, carrier, goal, remote))}
        options |= _configuration(order, plan)
    moving = frames.target_in_robot(goal)[1]
    options |= {"kind": order.kind if order.kind in ("joint", "linear", "circular") else "linear"}
    options |= {"tool": matrix_of(frames.tool if carrier is not None and not frames.stationary else moving)}
    if order.kind == "circular":
        via = filled(order.via, before) if order.relative is None else shifted(order.via, before, order.relative)
        along = frames
        if order.relative is None and isinstance(order.via, TargetValue):
            along = _led(frames_in_room, order, plan, external_of(order.via, external, False))
        options |= {"via_pose": matrix_of(_planned(along, carrier, via, remote)), "swept_deg": order.swept}
        if is_joints(order.target):
            options |= {"target_pose": matrix_of(_planned(frames, carrier, goal, remote))}
    return _request(options), moving, goal, external


def _led(frames: Frames, order: Order, plan: Planning, external: External) -> Frames:
    """Frames at given external axes; of a coordinated path move in the moving frame of what leads it."""
    leader = None if order.kind == "joint" else setting(plan.modal, order.modal, "coordinated")
    if not leader or frames.stationary:
        return frames.at(external)
    return frames.at(external).led_by(plan.scene.called(str(leader)), external)


def _is_remote(frames: Frames, order: Order, plan: Planning) -> bool:
    """Is it a path in the part that the robot holds, although its places are those of the tool?"""
    if order.kind == "joint" or setting(plan.modal, order.modal, "remote_tool") is not True:
        return False
    if frames.stationary or frames.mount is not None:
        raise ProgramError("motion", "a path in the part under places of the tool goes with a base that stands still")
    return True


def _held(frames: Frames) -> Frames:
    """The frames of a tool fixed in the room at the base of the moves, the flange itself being the part."""
    return replace(frames, tool=rigid.IDENTITY, stationary=True)


def _planned(frames: Frames, carrier: Carrier | None, goal: rigid.Pose, remote: bool = False) -> rigid.Pose:
    """A programmed pose as the planner counts it: in the work where something carries it, else in the base."""
    if remote:
        flange = frames.base.then(goal).then(frames.tool.inverse)
        return _held(frames).target_in_work(_held(frames).goal_of(flange))
    return frames.target_in_robot(goal)[0] if carrier is None else frames.target_in_work(goal)


def _goal(target: Value, before: rigid.Pose, relative: str | None) -> rigid.Pose:
    return filled(target, before) if relative is None else shifted(target, before, relative)


def _request(options: dict[str, Value]) -> MoveRequest:
    from rpl.emulator.planner import MoveRequest

    return MoveRequest(**options)


def _configuration(order: Order, plan: Planning) -> dict[str, Value]:
    """How the posture at the end is chosen or checked."""
    notation, model = plan.notation, plan.model
    if notation is None:
        return {}
    given = dict(order.target.conf.flags) if isinstance(order.target, TargetValue) else {}
    flags = {name: None if value is None else int(value) for name, value in given.items()}
    if order.kind == "joint":
        exact = setting(plan.modal, order.modal, "joint_configuration_check") is not False
        if order.configuration == "nearest" or (order.configuration is None and not exact):
            flags = {}
        posture = {name: str(setting(plan.modal, order.modal, name) or "") for name in ASKED_POSTURES}
        if any(posture.values()) and not any(value is not None for value in flags.values()):
            return {"select": InPosture(model, tuple(posture.items()))}
        return {"select": ByFlags(model, notation, tuple(flags.items()))}
    checks = setting(plan.modal, order.modal, "path_configuration_check") is True
    if (
        order.configuration == "nearest"
        or not (checks or order.configuration == "exact")
        or not any(value is not None for value in flags.values())
    ):
        return {}
    return {"check_end": ArrivesWith(model, notation, tuple(flags.items()))}


@dataclass(frozen=True, slots=True)
class InPosture:
    """Chooses the joints for a flange pose by words for the posture; equal ones choose alike."""

    model: RobotModel
    asked: tuple[tuple[str, str], ...]

    def __call__(self, flange: FloatArray, near: FloatArray) -> Selection:
        from rpl.emulator.configuration import Selection

        joints = self.model.in_posture(flange, near, dict(self.asked))
        words = ", ".join(word for _, word in self.asked if word)
        return Selection(joints, f"the target cannot be reached with the posture asked for ({words})")


@dataclass(frozen=True, slots=True)
class ByFlags:
    """Chooses the joints for a flange pose by a controller's configuration flags; equal ones choose alike."""

    model: RobotModel
    notation: Notation
    flags: tuple[tuple[str, int | None], ...]

    def __call__(self, flange: FloatArray, near: FloatArray) -> Selection:
        return self.notation.select(self.model, flange, dict(self.flags), near)


@dataclass(frozen=True, slots=True)
class ArrivesWith:
    """Tells whether a path arrives with a controller's configuration flags, or why not."""

    model: RobotModel
    notation: Notation
    flags: tuple[tuple[str, int | None], ...]

    def __call__(self, joints: FloatArray) -> str | None:
        return _mismatch(self.model, self.notation, dict(self.flags), joints)


def _mismatch(model: RobotModel, notation: Notation, flags: dict[str, int | None], joints: FloatArray) -> str | None:
    shown = notation.encode(model, joints)
    if all(value is None or shown.get(name) == value for name, value in flags.items()):
        return None
    found = notation.select(model, model.forward(joints), flags, joints)
    if found.joints is not None and abs(found.joints - joints).max() < 0.01:
        return None
    asked = ", ".join(f"{name} {value}" for name, value in flags.items())
    reached = ", ".join(f"{name} {value}" for name, value in shown.items())
    return f"the path arrives with {reached}, programmed is {asked}"


# M: a move with a time of its own is not held to the speed in force, but to what fast arms reach at most.
_FASTEST_MM_S, _FASTEST_DEG_S = 5000.0, 1000.0


def _common(order: Order, plan: Planning, external: tuple[float | None, ...]) -> dict[str, Value]:
    """Speeds, accelerations, orientation."""
    import numpy as np

    speed, modal = order.speed, plan.modal

    def value(name: str, index: int | None = None) -> Value:
        return setting(modal, order.modal, name, index)

    over = max(float(value("override")) / 100.0, 1e-3)
    profile_share = over * float(value("speed_percent")) / 100.0
    own = order.acceleration if order.acceleration is not None else value("acceleration_percent")
    scale = _speed_share(order, plan) if value("scale_acceleration") else 1.0
    effort = effort_share = _share(own, "acceleration_percent", order.rules) * scale
    axes = range(1, plan.model.axes + 1)
    options: dict[str, Value] = {}
    if speed.profile is not None:
        path = float(speed.path if speed.path is not None else speed.profile.get("path")) * profile_share
        limit = value("speed_limit")
        path = min(path, float(limit)) if limit is not None else path
        rotation = float(speed.rotation if speed.rotation is not None else speed.profile.get("rotation"))
        rotation *= profile_share
        if order.kind == "joint" and path > 0.0:
            options["tcp_speed_for_joint_move"] = path
        joint_share = np.full(plan.model.axes, over)
    else:
        path = float(speed.path if speed.path is not None else value("path_speed")) * profile_share
        rotation = float(speed.rotation if speed.rotation is not None else value("swivel_speed")) * over
        joint_share = np.array([float(value("joint_speed", axis)) / 100.0 * profile_share for axis in axes])
        if speed.path is not None and order.kind == "joint" and speed.joint is None:
            options["tcp_speed_for_joint_move"] = path
    if speed.joint is not None:
        joint_share = np.full(plan.model.axes, float(speed.joint) / 100.0 * over)
    joint_effort = np.array([float(value("joint_acceleration", axis)) / 100.0 * effort for axis in axes])
    if speed.axis is not None:  # the leading axis runs at this speed, the others with it
        joint_share = np.minimum(speed.axis * over / plan.model.speeds, 1.0)
    if speed.axis_acceleration is not None:
        joint_effort = speed.axis_acceleration / plan.model.accelerations
    acceleration = _path_acceleration(order, plan)
    if speed.path_acceleration is not None:
        acceleration, effort = speed.path_acceleration, 1.0
    mode = order.orientation or str(value("orientation_mode"))
    if value("singularity_mode") == "wrist" and order.kind != "joint":
        mode = "wrist"
    options |= {
        "path_speed_mm_s": path if path > 0.0 or _has_path_speed(order) else 1e-3,
        "path_acc_mm_s2": float(acceleration) * effort,
        "ori_speed_deg_s": rotation if rotation > 0.0 else 1e-3,
        "ori_acc_deg_s2": float(value("swivel_acceleration")) * effort,
        "joint_speed": joint_share,
        "joint_acc": joint_effort,
        "duration_s": speed.duration if speed.duration is not None else value("move_duration") or None,
        "orientation": _ORIENTATIONS.get(mode, "interpolated"),
        "circle_orientation": order.circle_orientation or str(value("circle_orientation")),
        "reduce_speed_near_singularity": value("path_limit_rule") == "reduce",
    }
    options |= _ramps(order, plan, effort_share, scale)
    options |= _externals(order, plan, external, effort_share)
    return _by_time(options, over) if speed.duration else options


def _speed_share(order: Order, plan: Planning) -> float:
    """The programmed speed as a share of the full one, which on a path is the one that programs start with; the
    override does not count. M: at most the whole, so that no axis exceeds its acceleration."""
    speed = order.speed
    if order.kind == "joint" and (speed.path is None or speed.joint is not None):
        said = speed.joint if speed.joint is not None else setting(plan.modal, order.modal, "joint_speed", 1)
        full: Value = 100.0
    else:
        said = speed.path if speed.path is not None else setting(plan.modal, order.modal, "path_speed")
        full = order.rules.system_defaults.get("path_speed", DEFAULTS["path_speed"])
    return min(max(float(said) / float(full), 1e-3), 1.0)


def _ramps(order: Order, plan: Planning, effort: float, scale: float) -> dict[str, Value]:
    """How the acceleration changes, and slowing down by `effort`, the share in which the move speeds up. `scale`: what
    both are scaled by."""

    def share(name: str) -> float:
        return _share(setting(plan.modal, order.modal, name), name, order.rules)

    down = setting(plan.modal, order.modal, "deceleration_percent")
    return {
        "controller": plan.controller.with_ramp(100.0 * share("acceleration_ramp")),
        "effort": effort,
        "braking": 1.0 if down is None else share("deceleration_percent") * scale / effort,
        "stop_ramp": share("stop_ramp"),
    }


def _share(percent: Value, name: str, rules: Rules) -> float:
    """A percentage as a share, within what the controller takes."""
    least, most = rules.percents_of(name)
    return min(max(float(percent), least), most) / 100.0


def _externals(order: Order, plan: Planning, external: External, effort: float) -> dict[str, Value]:
    """Where the external axes go, and their shares of speed and acceleration."""

    def shares(name: str) -> list[float]:
        places = range(1, len(external) + 1)
        return [float(setting(plan.modal, order.modal, name, place)) / 100.0 for place in places]

    efforts = [share * effort for share in shares("external_acceleration")]
    return plan.scene.options(plan.external, external, shares("external_speed"), efforts)


def _path_acceleration(order: Order, plan: Planning) -> float:
    """At 100 percent, mm/s²: as the program says, else the controller's."""
    said = order.modal.get("path_acceleration", plan.modal.get("path_acceleration"))
    own = plan.controller.path_acceleration_mm_s2
    return float(said if said is not None else own if own is not None else DEFAULTS["path_acceleration"])


def _has_path_speed(order: Order) -> bool:
    """Does the speed of the tool govern the move? Not that of a joint move without one, nor with a time of its own."""
    speed = order.speed
    on_path = order.kind != "joint" or speed.profile is not None or (speed.path is not None and speed.joint is None)
    return on_path and not order.external_only and not speed.duration


def _by_time(options: dict[str, Value], over: float) -> dict[str, Value]:
    """A move with a time of its own: the time decides, up to what the arm can do."""
    kept = {name: value for name, value in options.items() if name != "tcp_speed_for_joint_move"}
    return kept | {
        "path_speed_mm_s": max(float(options["path_speed_mm_s"]), _FASTEST_MM_S * over),
        "ori_speed_deg_s": max(float(options["ori_speed_deg_s"]), _FASTEST_DEG_S * over),
        "joint_speed": over,
    }
