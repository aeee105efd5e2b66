"""What KRL's own names mean in neutral terms: types, system variables, built-in functions, vendor technology calls.

Data only. Sources are the system variable and expert programming manuals unless a row says `M` (from memory, tested
as a hypothesis).
"""

from __future__ import annotations

from rpl import ir

KEYWORDS = frozenset(
    """and anin anout b_and b_exor b_not b_or bool brake c_dis c_ori c_ptp c_spl c_vel case cast_from cast_to char
    circ circ_rel const continue decl def default defdat deffct delay digin disable distance do else enable end enddat
    endfct endfor endif endloop endspline endswitch endwhile enum exit exor ext extfct extfctp extp false for frame
    global goto halt if import int interrupt is lin lin_rel loop maximum minimum not off on onstart or path pos axis
    e6pos e6axis prio ptp ptp_rel ptp_spline public pulse real repeat resume return sec signal spl spline struc switch
    scirc scirc_rel slin slin_rel sptp sptp_rel spl_rel step then to trigger true until wait when while with ca in out
    """.split()  # noqa: SIM905 (a word list reads better)
)

BASIC_TYPES: dict[str, ir.Type] = {
    "int": ir.IntType(),
    "real": ir.RealType(),
    "bool": ir.BoolType(),
    "char": ir.CharType(),
    "frame": ir.PoseType(),
    "pos": ir.TargetType("krl", external=False),
    "e6pos": ir.TargetType("krl"),
    "axis": ir.JointsType(external=False),
    "e6axis": ir.JointsType(),
    "e3pos": ir.TargetType("krl"),  # the same with three external axes; more are zero
    "e3axis": ir.JointsType(),
}

# $NAME -> neutral variable and KRL's unit ("" when it is the neutral one).
SCALARS: dict[str, tuple[str, str]] = {
    "$tool": ("tool", ""),
    "$base": ("base", ""),
    "$robroot": ("robot_root", ""),
    "$world": ("world", ""),
    "$nullframe": ("null_frame", ""),
    "$advance": ("advance", ""),
    "$ov_pro": ("override", ""),
    "$ori_type": ("orientation_mode", ""),
    "$circ_type": ("circle_orientation", ""),
    "$ipo_mode": ("interpolation", ""),
    "$cp_vel_type": ("path_limit_rule", ""),
    "$pos_act": ("actual_pose", ""),
    "$pos_act_mes": ("actual_pose", ""),  # measured: the arm of a run is where it is commanded to be
    "$axis_act": ("actual_joints", ""),
    "$axis_act_mes": ("actual_joints", ""),
    "$axis_act_meas": ("actual_joints", ""),
    "$tool_c": ("tool_of_moves", ""),  # M: of the main run, also in a submit program, which has no $TOOL
    "$base_c": ("frame_of_moves", ""),
    "$pos_for": ("end_pose", ""),
    "$pos_back": ("start_pose", ""),
    "$pos_int": ("interrupt_pose", ""),
    "$axis_int": ("interrupt_joints", ""),
    "$pos_ret": ("return_pose", ""),
    "$axis_ret": ("return_joints", ""),
    "$dist_next": ("remaining_distance", ""),
    "$vel_act": ("path_speed_actual", "m/s"),
    "$rob_timer": ("time", "ms"),
}
INDEXED: dict[str, tuple[str, str]] = {
    "$vel_axis": ("joint_speed", ""),
    "$acc_axis": ("joint_acceleration", ""),
    "$vel_extax": ("external_speed", ""),
    "$acc_extax": ("external_acceleration", ""),
    "$timer": ("timer", "ms"),
    "$timer_stop": ("timer_stopped", ""),
    "$timer_flag": ("timer_positive", ""),
    "$flag": ("flag", ""),
    "$cycflag": ("cyclic_flag", ""),
    "$singul_pos": ("singular_rule", ""),
}
# Read as INT, in whole ms (manual of the system variables), so that `$TIMER[1]/1000` is a whole division.
# M: the nearest millisecond is shown; a timer of the controller may count in its cycle of 12 ms.
COUNTED = frozenset(("$timer", "$rob_timer"))
# Structured modal settings: component -> neutral variable and unit, in the order of the structure.
STRUCTURES: dict[str, dict[str, tuple[str, str]]] = {
    "$vel": {"cp": ("path_speed", "m/s"), "ori1": ("swivel_speed", ""), "ori2": ("twist_speed", "")},
    "$acc": {
        "cp": ("path_acceleration", "m/s2"),
        "ori1": ("swivel_acceleration", ""),
        "ori2": ("twist_acceleration", ""),
    },
    "$apo": {
        "cvel": ("blend_speed", ""),
        "cptp": ("blend_joint", ""),
        "cdis": ("blend_distance", ""),
        "cori": ("blend_rotation", ""),
    },
}
# What a controller measures or knows of its arm, with the type of what is read; a cell file can give the values.
MEASURED: dict[str, ir.Type] = {
    **dict.fromkeys(("$softn_end", "$softp_end", "$vel_axis_act", "$torque_axis_act", "$curr_act"), ir.RealType()),
    **dict.fromkeys(("$vel_ma", "$acc_ma", "$vel_axis_ma", "$distance", "$pathtime", "$mot_temp"), ir.RealType()),
    **dict.fromkeys(("$robruntime", "$date", "$interpreter"), ir.IntType()),
    **dict.fromkeys(("$in_home1", "$in_home2", "$in_home3", "$in_home4", "$in_home5"), ir.BoolType()),
}
SIGNALS = {
    "$in": "digital_in",
    "$out": "digital_out",
    "$anin": "analog_in",
    "$anout": "analog_out",
}
GROUP_KINDS = {"digital_in": "group_in", "digital_out": "group_out"}
ALWAYS_TRUE_INPUT, ALWAYS_FALSE_INPUT = 1025, 1026

# Members of KRL's own enumerations that choose a mode <-> neutral words.
MODES: dict[str, dict[str, str]] = {
    "orientation_mode": {"var": "variable", "constant": "constant", "joint": "wrist"},
    "circle_orientation": {"base": "base", "path": "path"},
    "interpolation": {"base": "base", "tcp": "tool"},
    "path_limit_rule": {"constant": "constant", "var_all": "reduce"},
}

FUNCTIONS: dict[str, str] = {
    "abs": "abs",
    "sqrt": "sqrt",
    "sin": "sin",
    "cos": "cos",
    "tan": "tan",
    "acos": "acos",
    "atan2": "atan2",
    "inv_pos": "inverse",
    "strlen": "text_length",
    "strdecllen": "text_capacity",
    "frand": "random",
}
# Text functions that give BOOL and write their first or last argument; statements or operands alike.
TEXT_PROCEDURES: dict[str, str] = {
    "stradd": "text_append",
    "strcopy": "text_copy",
    "strclear": "text_clear",
    "strtoint": "parse_number",
    "strtoreal": "parse_number",
    "strtobool": "parse_value",
    "swrite": "format_into",
    "sread": "scan_from",
}
# M: $IN_HOME is TRUE while each axis is within so many degrees of $H_POS ($H_POS_TOL as delivered).
HOME_TOLERANCE_DEG = 2
# M: data of KSS 5 has no CIRC_TYP; its BAS leaves $CIRC_TYPE as it is, which is #BASE behind BAS(#INITMOV,0).
# Nor has it an APO_MODE of joint moves: APO_DIST is a percentage there.
USUAL_COMPONENTS: dict[str, dict[str, str]] = {"ldat": {"circ_typ": "BASE"}, "pdat": {"apo_mode": "CPTP"}}
# M: StrAdd is an INT in KSS 8: the new length, 0 when it does not fit. Programs also ask it like a BOOL.
TEXT_LENGTHS = {"text_append": "text_append_length"}
MESSAGES = {"msgnotify": "notify", "msgstate": "state", "msgquit": "quit", "msgloop": "quit"}  # MsgLoop: M

# Calls into technology packages, by how the routine's name begins. Effect: what a run must know of it.
VENDOR_CALLS: tuple[tuple[str, str], ...] = (
    ("on_error_proceed", "none"),
    ("err_clear", "none"),
    ("err_raise", "message"),
    ("set_cd_params", "tuning"),
    ("collmon", "tuning"),
    ("use_cm_pro_values", "tuning"),
    ("delete_backward_buffer", "none"),
    ("cread", "unknown"),
    ("cwrite", "unknown"),
    ("copen", "unknown"),
    ("cclose", "unknown"),
    ("cioctl", "unknown"),
    ("cast_to", "unknown"),
    ("cast_from", "unknown"),
    ("eki_", "unknown"),
    ("rsi_", "unknown"),
    ("st_", "unknown"),
    ("h50", "unknown"),
    ("h70", "unknown"),
    ("a10", "unknown"),
    ("a20", "unknown"),
    ("arc_", "unknown"),
    ("grp", "unknown"),
    ("asyptp", "unknown"),
    ("asycont", "unknown"),
    ("asystop", "unknown"),
)


def vendor_effect(name: str) -> str | None:
    """The declared effect of a technology call by its routine's lower-case name; None when it is none."""
    for beginning, effect in VENDOR_CALLS:
        if name.startswith(beginning):
            return effect
    return None
