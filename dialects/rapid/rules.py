"""RAPID's meaning as data for the core."""

from __future__ import annotations

from rpl.ir.rules import AdvanceRules, InputRules, Range, Rules, TriggerRules

from .prelude import ERRORS
from .types import TYPES

_EXTERNAL = {f"eax_{letter}": f"e{index}" for index, letter in enumerate("abcdef", 1)}
_AXES = {f"rax_{index}": f"j{index}" for index in range(1, 7)}

# Component -> neutral name, per built-in type.
COMPONENTS: dict[str, dict[str, str]] = {
    "TargetType": {"trans": "trans", "rot": "rot", "robconf": "conf", "extax": "ext"},
    "JointsType": {"robax": "robax", "extax": "ext"},
    "AxesType": _AXES,
    "ExternalType": _EXTERNAL,
    "PoseType": {"trans": "trans", "rot": "rot"},
    "VectorType": {"x": "x", "y": "y", "z": "z"},
    "RotationType": {"q1": "q1", "q2": "q2", "q3": "q3", "q4": "q4"},
    "ConfigType": {"cf1": "cf1", "cf4": "cf4", "cf6": "cf6", "cfx": "cfx"},
    "ToolType": {"robhold": "held", "tframe": "frame", "tload": "load"},
    "WorkObjectType": {
        "robhold": "held",
        "ufprog": "fixed",
        "ufmec": "unit",
        "uframe": "user_frame",
        "oframe": "object_frame",
    },
    "LoadType": {"mass": "mass", "cog": "cog", "aom": "axes", "ix": "ix", "iy": "iy", "iz": "iz"},
    "SpeedType": {"v_tcp": "path", "v_ori": "rotation", "v_leax": "linear_external", "v_reax": "rotary_external"},
    "ZoneType": {
        "finep": "stop",
        "pzone_tcp": "path",
        "pzone_ori": "rotation_path",
        "pzone_eax": "external_path",
        "zone_ori": "rotation",
        "zone_leax": "linear_external",
        "zone_reax": "rotary_external",
    },
}

# A fly-by move lets the program go on about 0.1 s before the corner path (overview manual, motion and logic); a stop
# point holds it until the robot stands.
_ADVANCE = AdvanceRules(
    moves=4,
    runs_ahead_of="fly_by",
    lead_s=0.1,
    source="ABB RAPID Reference Manual, overview 5, 3.1 to 3.3: planning takes approx. 0.1 s, the servo's lag 0",
    # M: number and name as published logs of controllers show them; the manual's list of events is not at hand.
    late_corner="50024 Corner path failure: the corner path is executed as a stop point, the next move came too late",
)

_DEFAULTS: dict[str, float | bool | str] = {
    "speed_percent": 100.0,
    "speed_limit": 5000.0,
    "acceleration_percent": 100.0,
    "acceleration_ramp": 100.0,
    "stop_ramp": 100.0,
    "joint_configuration_check": True,
    "path_configuration_check": True,
    "singularity_mode": "off",
    "circle_orientation": "path",  # M: CirPathMode starts as \PathFrame
    "override": 100.0,
}

# Components of the controller's own data, read only (reference manual, data types progdisp and motsetdata) -> neutral
# system variables.
SYSTEM_RECORDS: dict[tuple[str, str], str] = {
    ("C_PROGDISP", "pdisp"): "displacement",
    ("C_MOTSET", "vel.oride"): "speed_percent",
    ("C_MOTSET", "vel.max"): "speed_limit",
    ("C_MOTSET", "acc.acc"): "acceleration_percent",
    ("C_MOTSET", "acc.ramp"): "acceleration_ramp",
    ("C_MOTSET", "conf.jsup"): "joint_configuration_check",
    ("C_MOTSET", "conf.lsup"): "path_configuration_check",
}

# How functions are called here, and the types of what they take (reference manual, functions); a point of DefFrame is
# a robtarget, of which the place counts. What takes any type, or becomes operators, is not in the table.
FUNCTIONS: dict[str, tuple[str, ...]] = {
    line.split()[0]: tuple(line.split()[1:])
    for line in """
    abs Abs num|sqrt Sqrt num|sin Sin num|cos Cos num|tan Tan num|asin ASin num|acos ACos num|atan ATan num
    exp Exp num|atan2 ATan2 num num|power Pow num num|round Round num num|trunc Trunc num num
    offset Offs robtarget num num num|tool_offset RelTool robtarget num num num num num num
    compose PoseMult pose pose|inverse PoseInv pose|transform PoseVect pose pos
    euler_x EulerZYX orient|euler_y EulerZYX orient|euler_z EulerZYX orient|rotation_zyx OrientZYX num num num
    distance Distance pos pos|magnitude VectMagn pos|dot DotProd pos pos|normalise NOrient orient
    frame_from_points DefFrame robtarget.trans robtarget.trans robtarget.trans num
    target_to_joints CalcJointT robtarget tooldata wobjdata|joints_to_target CalcRobT jointtarget tooldata wobjdata
    current_target CRobT tooldata wobjdata|current_position CPos tooldata wobjdata
    text_length StrLen string|text_part StrPart string num num|text_find_any StrFind string num string
    text_match StrMatch string num string|text_member StrMemb string num string|text_map StrMap string string string
    number_text NumToStr num num|clock_seconds ClkRead clock
    """.replace("|", "\n")
    .strip()
    .splitlines()
}

# Reference manual: NOrient (a quaternion off by at most 0.00001 is normalised, by at most 0.1 slightly off, beyond that
# unusable); zonedata and motion principles 2.3 (zones become half the distance where they overlap).
# M: a load without a mass (-1 of a tool that the pendant made) is refused when the robot moves with it.
INPUTS = InputRules(
    rotation_limits=(1e-5, 0.1),
    large_corner="makes it {half:g} mm, half of that",
    least_mass=1e-6,
    without_mass="the controller refuses to move with it (here it drives as without a load)",
    ranges={"move_duration": Range(0.0, above=True)},  # M: \\T:=0 is no time for a move
)

RULES = Rules(
    "rapid",
    _ADVANCE,
    text_plus=True,
    text_length=80,  # reference manual, data type string
    # Reference manual, num: IEEE single; whole numbers from -8388607 to 8388608 are exact. M: each operation rounds.
    real_bits=24,
    whole_bits=24,
    group_bits=16,  # M: the system parameters say a group's signals; more than 16 are rare (a num holds 23 bits)
    components=COMPONENTS,
    wait_poll_s=0.1,
    system_defaults=_DEFAULTS,
    # RAPID Reference Manual, AccSet: less than 20 percent gives 20, a ramp of less than 10 percent gives 10.
    percent_limits={
        "acceleration_percent": (20.0, 100.0),
        "acceleration_ramp": (10.0, 100.0),
        "stop_ramp": (1.0, 100.0),
    },
    errors=ERRORS,
    type_names=TYPES,
    exact_types=True,
    # Reference manual, loaddata: the tool's load in wrist coordinates, GripLoad's in those of the tool; MoveL, \\TLoad:
    # the total load of the move, the load of its tooldata is not looked at then.
    loads_of_tools=True,
    functions=FUNCTIONS,
    inputs=INPUTS,
    # M: the controller's configuration (SYS.cfg, CAB_TASKS) names its tasks; the first robot's is T_ROB1 by delivery.
    task_name="T_ROB{number}",
    pulse_step_s=0.001,  # PulseDO, limitations (0.01 s before RobotWare 5)
    triggers=TriggerRules(early_while_braking=True),  # TriggIO, limitations: not earlier than the braking begins
)
