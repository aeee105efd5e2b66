"""How URScript spells the neutral vocabulary, as data. What no manual states is marked `M:` and kept here."""

from __future__ import annotations

from rpl.registry import words as shared_words
from rpl.writing.precedence import RELATIONS, Operator, OperatorTable


def words(text: str) -> frozenset[str]:
    """The words of a list."""
    return frozenset(text.split())


KEYWORDS = words(
    """and break continue def elif else end enter_critical exit_critical False global goto halt if in join kill local
    not or pass return run sec struct sync thread True while xor p"""
)
# Names of the controller's own functions: a variable of that name would hide them.
SCRIPT_FUNCTIONS = words(
    """acos append asin assert atan atan2 binary_list_to_integer ceil clear conveyor_pulse_decode cos d2r
    encoder_enable_pulse_decode end_force_mode floor force force_mode freedrive_mode get_actual_joint_positions
    get_actual_joint_speeds get_actual_tcp_pose get_actual_tcp_speed get_analog_in get_analog_out
    get_configurable_digital_in get_configurable_digital_out get_digital_in get_digital_out get_flag get_forward_kin
    get_inverse_kin get_inverse_kin_has_solution get_list_length get_standard_analog_in get_standard_analog_out
    get_standard_digital_in get_standard_digital_out get_steptime get_target_joint_positions get_target_payload
    get_target_tcp_pose get_tcp_force get_tcp_offset get_tool_analog_in get_tool_digital_in get_tool_digital_out insert
    integer_to_binary_list interpolate_pose inv is_steady length log make_list movec movej movel movep norm
    normalize point_dist popup pose pose_add pose_dist pose_inv pose_sub pose_trans position_deviation_warning pow
    powerdown protective_stop r2d random read_input_boolean_register read_output_boolean_register remove
    request_boolean_from_primary_client request_float_from_primary_client request_integer_from_primary_client
    request_string_from_primary_client rotvec2rpy rpc_factory rpy2rotvec script_version servoc servoj set_analog_out
    set_configurable_digital_out set_digital_out set_flag set_gravity set_payload set_payload_cog set_payload_mass
    set_standard_analog_out set_standard_digital_out set_target_payload set_tcp set_tool_digital_out
    set_tool_voltage sin size sleep socket_close socket_open speedj speedl sqrt stopj stopl stop_conveyor_tracking
    str_at str_cat str_empty str_find str_len str_sub sum tan textmsg time to_num to_str track_conveyor_linear transpose
    wrench_trans write_output_boolean_register zero_ftsensor list int float bool string"""
)
RESERVED = KEYWORDS | SCRIPT_FUNCTIONS
# What movej and movel take when nothing is said: rad/s2, m/s2 (script manual 5.2).
USUAL_ACCELERATION = {"joint": "1.4", "linear": "1.2"}
LONGEST_NAME = 63  # M: no manual states a limit

# M: precedence as in Python. Only `not` over comparisons and `and` over `or` have examples in the manual, so logical
# operators of two kinds side by side get brackets.
_OR, _XOR, _AND, NOT, RELATION, SUM, PRODUCT, SIGN = 10, 20, 30, 40, 50, 60, 70, 80
_BINARY = {
    "or": Operator("or", _OR),
    "cor": Operator("or", _OR),
    "xor": Operator("xor", _XOR),
    "and": Operator("and", _AND),
    "cand": Operator("and", _AND),
    "=": Operator("==", RELATION, "none"),
    "<>": Operator("!=", RELATION, "none"),
    "<": Operator("<", RELATION, "none"),
    ">": Operator(">", RELATION, "none"),
    "<=": Operator("<=", RELATION, "none"),
    ">=": Operator(">=", RELATION, "none"),
    "+": Operator("+", SUM),
    "-": Operator("-", SUM),
    "*": Operator("*", PRODUCT),
    "/": Operator("/", PRODUCT),
}
OPERATORS = OperatorTable(
    binary=_BINARY,
    unary={"-": Operator("-", SIGN), "+": Operator("+", SIGN), "not": Operator("not", NOT)},
    mixed=(frozenset(("or", "cor", "xor", "and", "cand")), frozenset(("*", "/"))),
    sign_behind=RELATIONS,
)
# Operators written as a function: of the controller, or one that the program brings along.
OPERATOR_FUNCTIONS = {
    ":": "pose_trans",
    "**": "pow",
    "&": "str_cat",
    "div": "rpl_div",
    "mod": "rpl_mod",
    "band": "rpl_and",
    "bor": "rpl_or",
    "bxor": "rpl_xor",
}

# Functions that take and give numbers of any unit alike.
FUNCTIONS = {
    "abs": "norm",
    "sqrt": "sqrt",
    "floor": "floor",
    "ceil": "ceil",
    "power": "pow",
    "random": "random",
    "min": "rpl_min",
    "max": "rpl_max",
    "sign": "rpl_sign",
    "bit_shift_left": "rpl_shift_left",
    "bit_shift_right": "rpl_shift_right",
    "compose": "pose_trans",
    "inverse": "pose_inv",
    "interpolate_pose": "interpolate_pose",
    "length": "length",
    "text_length": "str_len",
    "number_text": "rpl_number_text",
    "value_text": "to_str",
    "text_value": "to_num",
    "text_upper": "rpl_upper",
    "text_lower": "rpl_lower",
    "text_map": "rpl_mapped",
    "text_find_any": "rpl_find_any",
    "text_match": "rpl_match",
    "text_member": "rpl_member",
    "character_code": "rpl_code",
    "from_code": "rpl_char",
}
TO_ANGLE = {"sin": "sin", "cos": "cos", "tan": "tan"}  # angle in, number out
FROM_ANGLE = {"asin": "asin", "acos": "acos", "atan": "atan", "atan2": "atan2"}  # number in, angle out
EULER = {"c": 0, "b": 1, "a": 2}  # place in roll, pitch, yaw
AXES = ("j1", "j2", "j3", "j4", "j5", "j6")
EXTERNAL = ("e1", "e2", "e3", "e4", "e5", "e6")
PLACES = {"x": 0, "y": 1, "z": 2}

# Physical digital signals counted from 1: (first, last, infix of the controller's functions).
_WORDS = shared_words("urscript")
_NUMBERS = _WORDS.numbers("numbers")


def _ranges(kind: str) -> tuple[tuple[int, int, str], ...]:
    firsts = {name: int(number) for name, number in _WORDS.numbers(f"first_{kind}").items()}
    lasts = (*(first - 1 for first in list(firsts.values())[1:]), int(_NUMBERS[f"last_{kind}"]))
    return tuple((first, last, name) for (name, first), last in zip(firsts.items(), lasts, strict=True))


DIGITAL, ANALOG = _ranges("digital"), _ranges("analog")
COUNTED_FROM_0 = tuple((first, last, -first) for first, last, _ in DIGITAL)
REGISTERS = ("boolean", "float")  # general purpose registers, read and written by functions of another form
STEP_S = float(_NUMBERS["step_s"])  # one cycle of the controller, which sync() waits for
FLAGS = 32  # set_flag(0) .. set_flag(31): internal digital signals, counted from 1 here as the others

# M: what movej, movel and movep do without v and a (script manual's defaults), deg/s and mm/s.
JOINT_LIMIT_DEG_S = 180.0
