"""How KRL spells the neutral vocabulary: the reader's tables from the other side, as data."""

from __future__ import annotations

from rpl.ir import BoolType, IntType, RealType
from rpl.writing.precedence import Operator, OperatorTable

RESERVED = frozenset(
    """and anin anout axis b_and b_exor b_not b_or bool brake c_dis c_ori c_ptp c_spl c_vel ca case cast_from cast_to
    channel char circ circ_rel confirm const const_vel continue decl def default defdat deffct delay digin disable
    distance do e6axis e6pos else enable end enddat endfct endfor endif endloop endspline endswitch endwhile enum exit
    exor ext extfct extfctp extp false for frame global goto halt if import in int interrupt is lin lin_rel loop maximum
    minimum not off on onstart or out path pos prio ptp ptp_rel ptp_spline public pulse real repeat resume return scirc
    scirc_rel sec signal slin slin_rel spl spl_rel spline sptp sptp_rel step struc switch then time_block to trigger
    true until wait when while with
    abs acos atan2 cos frand inv_pos inverse forward sin sqrt tan varstate stradd strclear strcomp strcopy strdecllen
    strfind strlen strtobool strtoint strtoreal swrite sread cread cwrite copen cclose cioctl ek
    msgnotify msgquit msgstate msgdialog msgloop on_error_proceed
    bas fdat pdat ldat apo cp load inertia date base_data tool_data load_data""".split()  # noqa: SIM905 (a word list reads better)
)

_RELATION, _OR, _EXOR, _AND, _SUM, _PRODUCT, _SIGN, _CHAIN = 20, 30, 40, 50, 60, 70, 80, 90
_BINARY = {
    "=": Operator("==", _RELATION, "none", spaced=False),
    "<>": Operator("<>", _RELATION, "none", spaced=False),
    "<": Operator("<", _RELATION, "none", spaced=False),
    ">": Operator(">", _RELATION, "none", spaced=False),
    "<=": Operator("<=", _RELATION, "none", spaced=False),
    ">=": Operator(">=", _RELATION, "none", spaced=False),
    "or": Operator("OR", _OR),
    "bor": Operator("B_OR", _OR),
    "xor": Operator("EXOR", _EXOR),
    "bxor": Operator("B_EXOR", _EXOR),
    "and": Operator("AND", _AND),
    "band": Operator("B_AND", _AND),
    "+": Operator("+", _SUM, spaced=False),
    "-": Operator("-", _SUM, spaced=False),
    "*": Operator("*", _PRODUCT, spaced=False),
    "/": Operator("/", _PRODUCT, spaced=False),
    "div": Operator("/", _PRODUCT, spaced=False),
    "quo": Operator("/", _PRODUCT, spaced=False),
    ":": Operator(":", _CHAIN, spaced=False),
}
OPERATORS = OperatorTable(
    binary=_BINARY,
    unary={
        "-": Operator("-", _SIGN),
        "+": Operator("+", _SIGN),
        "not": Operator("NOT", _SIGN),
        "bnot": Operator("B_NOT", _SIGN),
    },
    mixed=(frozenset(_BINARY),),
)

EXTERNAL_KINEMATICS = ("EASYS", "EBSYS", "ECSYS", "EDSYS", "EESYS", "EFSYS")
COUNTED = frozenset(("timer", "time"))  # INT in their own unit
# Neutral system variable -> spelling and the unit that KRL measures it in ("" for the neutral one).
SYSTEM: dict[str, tuple[str, str]] = {
    "tool": ("$TOOL", ""),
    "base": ("$BASE", ""),
    "robot_root": ("$ROBROOT", ""),
    "world": ("$WORLD", ""),
    "null_frame": ("$NULLFRAME", ""),
    "advance": ("$ADVANCE", ""),
    "override": ("$OV_PRO", ""),
    "orientation_mode": ("$ORI_TYPE", ""),
    "circle_orientation": ("$CIRC_TYPE", ""),
    "interpolation": ("$IPO_MODE", ""),
    "path_limit_rule": ("$CP_VEL_TYPE", ""),
    "actual_pose": ("$POS_ACT", ""),
    "actual_joints": ("$AXIS_ACT", ""),
    "tool_of_moves": ("$TOOL_C", ""),
    "frame_of_moves": ("$BASE_C", ""),
    "end_pose": ("$POS_FOR", ""),
    "start_pose": ("$POS_BACK", ""),
    "interrupt_pose": ("$POS_INT", ""),
    "interrupt_joints": ("$AXIS_INT", ""),
    "return_pose": ("$POS_RET", ""),
    "return_joints": ("$AXIS_RET", ""),
    "remaining_distance": ("$DIST_NEXT", ""),
    "path_speed_actual": ("$VEL_ACT", "m/s"),
    "path_speed": ("$VEL.CP", "m/s"),
    "swivel_speed": ("$VEL.ORI1", ""),
    "twist_speed": ("$VEL.ORI2", ""),
    "path_acceleration": ("$ACC.CP", "m/s2"),
    "swivel_acceleration": ("$ACC.ORI1", ""),
    "twist_acceleration": ("$ACC.ORI2", ""),
    "blend_speed": ("$APO.CVEL", ""),
    "blend_joint": ("$APO.CPTP", ""),
    "blend_distance": ("$APO.CDIS", ""),
    "blend_rotation": ("$APO.CORI", ""),
    "joint_speed": ("$VEL_AXIS", ""),
    "joint_acceleration": ("$ACC_AXIS", ""),
    "external_speed": ("$VEL_EXTAX", ""),
    "external_acceleration": ("$ACC_EXTAX", ""),
    "timer": ("$TIMER", "ms"),
    "timer_stopped": ("$TIMER_STOP", ""),
    "timer_positive": ("$TIMER_FLAG", ""),
    "time": ("$ROB_TIMER", "ms"),
    "flag": ("$FLAG", ""),
    "cyclic_flag": ("$CYCFLAG", ""),
    "singular_rule": ("$SINGUL_POS", ""),
}
# Structured variables whose components are neutral variables of their own, in KRL's order.
STRUCTURES: dict[str, tuple[tuple[str, str], ...]] = {
    "$VEL": (("CP", "path_speed"), ("ORI1", "swivel_speed"), ("ORI2", "twist_speed")),
    "$ACC": (("CP", "path_acceleration"), ("ORI1", "swivel_acceleration"), ("ORI2", "twist_acceleration")),
    "$APO": (("CVEL", "blend_speed"), ("CPTP", "blend_joint"), ("CDIS", "blend_distance"), ("CORI", "blend_rotation")),
}
MODES: dict[str, dict[str, str]] = {
    "orientation_mode": {"variable": "VAR", "constant": "CONSTANT", "wrist": "JOINT"},
    "circle_orientation": {"base": "BASE", "path": "PATH"},
    "interpolation": {"base": "BASE", "tool": "TCP"},
    "path_limit_rule": {"constant": "CONSTANT", "reduce": "VAR_ALL"},
}
SIGNALS = {"digital_in": "$IN", "digital_out": "$OUT", "analog_in": "$ANIN", "analog_out": "$ANOUT", "flag": "$FLAG"}
GROUPS = {"group_in": "$IN", "group_out": "$OUT"}

FUNCTIONS = {
    "abs": "ABS",
    "sqrt": "SQRT",
    "sin": "SIN",
    "cos": "COS",
    "tan": "TAN",
    "acos": "ACOS",
    "atan2": "ATAN2",
    "inverse": "INV_POS",
    "text_length": "StrLen",
    "text_capacity": "StrDeclLen",
    "random": "FRAND",
}
# A text is read by the function of the variable's type.
PARSERS = {IntType: "StrToInt", RealType: "StrToReal", BoolType: "StrToBool"}
PROCEDURES = {
    "text_append": "StrAdd",
    "text_append_length": "StrAdd",
    "text_copy": "StrCopy",
    "text_clear": "StrClear",
    "parse_number": "StrToReal",
    "parse_value": "StrToBool",
    "format_into": "SWRITE",
    "scan_from": "SREAD",
}
MESSAGES = {
    "notify": "MsgNotify",
    "state": "MsgState",
    "quit": "MsgQuit",
    "write": "MsgNotify",
    "error": "MsgQuit",
}
# Conversions that KRL makes by itself where the value is stored or compared.
SILENT_CONVERSIONS = frozenset(("real", "round_half_away", "code", "char"))
ATTRIBUTES = frozenset(("ACCESS", "REL", "PARAM", "COMMENT", "USER", "TECHNOLOGY"))
LONGEST_LINE = 474
DEFAULT_TEXT_CAPACITY = 80
# The controller's functions for texts take a CHAR[256] at most (its own declarations of StrToInt and kin).
LONGEST_TEXT = 255
