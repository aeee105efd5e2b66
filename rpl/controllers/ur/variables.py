"""The variables of RTDE: names, types, and what the virtual controller gives for each.

Names and types are those of the RTDE guide for PolyScope 5.12. What the emulated robot has no notion of (currents,
temperatures, voltages, forces) has the value of a robot at rest: zero, or what the guide's example shows.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from rpl.controllers.ur.panel import Panel
from rpl.controllers.ur.registers import INPUT, OUTPUT, REGISTERS, Register
from rpl.controllers.ur.rtde import Value

Six = tuple[float, float, float, float, float, float]
_ZERO6: Six = (0.0,) * 6
RUNTIME = {"stopped": 1, "running": 2, "paused": 4}
ROBOT_MODES = {"POWER_OFF": 3, "IDLE": 5, "RUNNING": 7}
SAFETY_MODES = {"NORMAL": 1, "PROTECTIVE_STOP": 3, "ROBOT_EMERGENCY_STOP": 7}
_SAFETY_BITS = {"NORMAL": 1, "PROTECTIVE_STOP": 1 << 2 | 1 << 10, "ROBOT_EMERGENCY_STOP": 1 << 6 | 1 << 7 | 1 << 10}


@dataclass
class Moment:
    """The robot at one moment, the same for all who listen. Angles in rad, lengths in m, as the controller counts."""

    panel: Panel
    began: float = field(default_factory=time.monotonic)
    t: float = 0.0
    joints: Six = _ZERO6
    speeds: Six = _ZERO6
    pose: Six = _ZERO6
    pose_speed: Six = _ZERO6
    moving: bool = False

    def look(self) -> None:
        """Take the present values. Speeds are what passed since the last look."""
        cabinet = self.panel.cabinet
        now = time.monotonic() - self.began
        passed, self.t = now - self.t, now
        found = cabinet.joints
        degrees = tuple(found[:6]) if found is not None and len(found) >= 6 else (0.0,) * 6
        joints = _six(tuple(math.radians(value) for value in degrees))
        if joints == self.joints and not self.moving and self.pose != _ZERO6:
            return
        pose = self._pose(found)
        if passed > 0.0 and self.pose != _ZERO6:
            self.speeds = _six(tuple((new - old) / passed for new, old in zip(joints, self.joints, strict=True)))
            linear = tuple((new - old) / passed for new, old in zip(pose[:3], self.pose[:3], strict=True))
            self.pose_speed = _six((*linear, 0.0, 0.0, 0.0))
        self.moving = joints != self.joints
        self.joints, self.pose = joints, pose

    def _pose(self, degrees: Sequence[float] | None) -> Six:
        """The tool in the base: position in m, rotation vector in rad."""
        from rpl.emulator.rotations import matrix_to_rotation_vector

        tool = self.panel.cabinet.tool_at(degrees) if degrees is not None else None
        if tool is None:
            return _ZERO6
        turn = matrix_to_rotation_vector(tool[:3, :3])
        return _six((*(float(value) / 1000.0 for value in tool[:3, 3]), *(float(value) for value in turn)))


def _six(values: tuple[float, ...]) -> Six:
    a, b, c, d, e, f = values
    return a, b, c, d, e, f


def bits(panel: Panel, kind: str) -> int:
    """Digital signals: 8 of the controller's, 8 configurable, 2 of the tool; the lowest bit is the first one."""
    signal = panel.cabinet.signal
    return sum(bool(signal(f"{kind}{number + 1}")) << number for number in range(18))


def _number(panel: Panel, name: str) -> float:
    value = panel.cabinet.signal(name)
    return float(value) if isinstance(value, (int, float)) else 0.0


def _status_bits(panel: Panel) -> int:
    powered = panel.robot_mode in ("IDLE", "RUNNING")
    return powered | (panel.cabinet.phase == "running") << 1 | 1 << 3


Get = Callable[[Moment], Value]


def _always(value: Value) -> Get:
    return lambda moment: value


def _of_moment(name: str) -> Get:
    return lambda moment: getattr(moment, name)


def _of_signal(name: str) -> Get:
    return lambda moment: _number(moment.panel, name)


def _of_register(register: Register) -> Get:
    return lambda moment: register.value(moment.panel.cabinet)


# Variables that are zero here, by their type.
_AT_REST = {
    "VECTOR6D": """target_qdd target_moment joint_control_output actual_TCP_force joint_temperatures
        actual_joint_voltage
        ft_raw_wrench actual_current_window actual_current_as_torque payload_inertia actual_current target_current""",
    "VECTOR3D": "actual_tool_accelerometer elbow_position elbow_velocity payload_cog",
    "DOUBLE": """actual_momentum actual_robot_current io_current euromap67_24V_voltage euromap67_24V_current payload
        tool_analog_input0 tool_analog_input1 tool_output_current tool_temperature tcp_force_scalar
        joint_position_deviation_ratio collision_detection_ratio actual_execution_time""",
    "UINT32": "analog_io_types euromap67_input_bits euromap67_output_bits tool_analog_input_types",
    "UINT8": "tool_output_mode tool_digital_output0_mode tool_digital_output1_mode",
    "INT32": "tool_output_voltage",
}


def _outputs() -> dict[str, tuple[str, Get]]:
    found: dict[str, tuple[str, Get]] = {
        "timestamp": ("DOUBLE", _of_moment("t")),
        "robot_mode": ("INT32", lambda moment: ROBOT_MODES[moment.panel.robot_mode]),
        "joint_mode": (
            "VECTOR6INT32",
            lambda moment: (253 if moment.panel.robot_mode == "RUNNING" else 239,) * 6,
        ),
        "safety_mode": ("INT32", lambda moment: SAFETY_MODES[moment.panel.safety]),
        "safety_status": ("INT32", lambda moment: SAFETY_MODES[moment.panel.safety]),
        "runtime_state": ("UINT32", lambda moment: RUNTIME[moment.panel.cabinet.phase]),
        "robot_status_bits": ("UINT32", lambda moment: _status_bits(moment.panel)),
        "safety_status_bits": ("UINT32", lambda moment: _SAFETY_BITS[moment.panel.safety]),
        "actual_digital_input_bits": ("UINT64", lambda moment: bits(moment.panel, "di")),
        "actual_digital_output_bits": ("UINT64", lambda moment: bits(moment.panel, "do")),
        "speed_scaling": ("DOUBLE", lambda moment: moment.panel.speed),
        "target_speed_fraction": ("DOUBLE", lambda moment: moment.panel.speed),
        "script_control_line": ("UINT32", lambda moment: moment.panel.cabinet.line),
        "actual_main_voltage": ("DOUBLE", _always(48.0)),
        "actual_robot_voltage": ("DOUBLE", _always(48.0)),
        "tool_mode": ("UINT32", _always(253)),
        "time_scale_source": ("INT32", _always(-1)),
    }
    for word in ("actual", "target"):
        found[f"{word}_q"] = ("VECTOR6D", _of_moment("joints"))
        found[f"{word}_qd"] = ("VECTOR6D", _of_moment("speeds"))
        found[f"{word}_TCP_pose"] = ("VECTOR6D", _of_moment("pose"))
        found[f"{word}_TCP_speed"] = ("VECTOR6D", _of_moment("pose_speed"))
    for kind, names in _AT_REST.items():
        value = _always((0.0,) * int(kind[6]) if kind.startswith("VECTOR") else 0)
        found |= dict.fromkeys(names.split(), (kind, value))
    for way in ("input", "output"):
        for number in (0, 1):
            signal = f"a{way[0]}{number + 1}"
            found[f"standard_analog_{way}{number}"] = ("DOUBLE", _of_signal(signal))
    for direction in (INPUT, OUTPUT):
        for name, register in REGISTERS[direction].items():
            found[name] = (register.type, _of_register(register))
    return found


OUTPUTS = _outputs()
# What a client may set, with its type; registers are further below.
_SETTABLE = {
    "speed_slider_mask": "UINT32",
    "speed_slider_fraction": "DOUBLE",
    "standard_digital_output_mask": "UINT8",
    "standard_digital_output": "UINT8",
    "configurable_digital_output_mask": "UINT8",
    "configurable_digital_output": "UINT8",
    "tool_digital_output_mask": "UINT8",
    "tool_digital_output": "UINT8",
    "standard_analog_output_mask": "UINT8",
    "standard_analog_output_type": "UINT8",
    "standard_analog_output_0": "DOUBLE",
    "standard_analog_output_1": "DOUBLE",
    "external_force_torque": "VECTOR6D",
}
INPUT_TYPES = {**_SETTABLE, **{name: register.type for name, register in REGISTERS[INPUT].items()}}
_FIRST_OF = {"standard": 1, "configurable": 9, "tool": 17}


def apply(panel: Panel, values: dict[str, Value]) -> None:
    """What a data package of a client sets, all at one moment."""
    changed: dict[str, int | float | bool] = {}
    for name, value in values.items():
        register = REGISTERS[INPUT].get(name)
        if register is not None and not isinstance(value, tuple):
            changed |= register.signals(value)
    for word, first in _FIRST_OF.items():
        mask, levels = values.get(f"{word}_digital_output_mask"), values.get(f"{word}_digital_output")
        if isinstance(mask, int) and isinstance(levels, int):
            for bit in range(8):
                if mask >> bit & 1:
                    changed[f"do{first + bit}"] = bool(levels >> bit & 1)
    mask = values.get("standard_analog_output_mask")
    for bit in (0, 1):
        level = values.get(f"standard_analog_output_{bit}")
        if isinstance(mask, int) and mask >> bit & 1 and isinstance(level, float):
            changed[f"ao{bit + 1}"] = level
    fraction = values.get("speed_slider_fraction")
    if values.get("speed_slider_mask") and isinstance(fraction, float):
        panel.speed = min(max(fraction, 0.0), 1.0)
    if changed:
        panel.cabinet.set_signals(changed)
