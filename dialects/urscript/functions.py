"""URScript's own functions: their parameters with names and defaults, and the kind of their result.

A parameter is `name:letter` with `=default` where it may be left out: b bool, i whole number, n number, t text,
p pose, q joints, m joints or pose, l list, x anything. Results: the same letters, h a handle, s a time, - none,
? unknown, l3 and l6 lists of three and six numbers, m6 a matrix, li lists of whole numbers, lb of 32 bools.
What has an effect word (none, message, time, unknown) is a Vendor statement or value; all others have a neutral meaning
in `calls`, `moves` or `procedures`. Sources: script manuals 3.5 and 5.2; defaults of moves from there.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

from .kinds import BOOL, HANDLE, INT, JOINTS, POSE, REAL, TEXT, Kind, list_of
from .nodes import Expr, ListOf, Number, PoseOf, Sign, Text, Truth


@dataclass(frozen=True, slots=True)
class Parameter:
    """`default` None: it must be given, or is left out where `optional`."""

    name: str
    letter: str
    default: Expr | None = None
    optional: bool = False


@dataclass(frozen=True, slots=True)
class Builtin:
    name: str
    parameters: tuple[Parameter, ...]
    result: str
    effect: str = ""

    @property
    def kind(self) -> Kind | None:
        return RESULTS.get(self.result)


RESULTS: dict[str, Kind | None] = {
    "b": BOOL,
    "i": INT,
    "n": REAL,
    "t": TEXT,
    "p": POSE,
    "q": JOINTS,
    "h": HANDLE,
    "l": list_of(REAL, None),
    "l3": list_of(REAL, 3),
    "l6": list_of(REAL, 6),
    "li": list_of(INT, None),
    "lb": list_of(BOOL, 32),
    "m6": list_of(list_of(REAL, 6), 6),
    "s": Kind("struct", fields=(("sec", INT), ("nanosec", INT))),
}
# The kind that a parameter of this letter tells of a name whose kind nothing else tells.
HINTS: dict[str, Kind] = {
    "b": BOOL,
    "i": INT,
    "n": REAL,
    "t": TEXT,
    "p": POSE,
    "q": JOINTS,
    "l": list_of(REAL, None),
}

# Functions with a neutral meaning.
_MEANT = """
    movej(goal:m, a:n=1.4, v:n=1.05, t:n=0, r:n=0) -
    movel(goal:m, a:n=1.2, v:n=0.25, t:n=0, r:n=0) -
    movep(goal:m, a:n=1.2, v:n=0.25, r:n=0) -
    movec(pose_via:m, pose_to:m, a:n=1.2, v:n=0.25, r:n=0, mode:i=0) -
    servoj(q:q, a:n=0, v:n=0, t:n=0.002, lookahead_time:n=0.1, gain:n=300) -
    servoc(pose:m, a:n=1.2, v:n=0.25, r:n=0) -
    speedj(qd:l, a:n, t:n=0) -
    speedl(xd:l, a:n, t:n=0, aRot:n=?) -
    stopj(a:n=2.0) -
    stopl(a:n=20.0, aRot:n=?) -
    set_tcp(pose:p, tcp_name:t=?) -
    set_payload(m:n, cog:l=?) -
    set_payload_mass(m:n) -
    set_payload_cog(cog:l) -
    set_target_payload(m:n, cog:l=?, inertia:l=?, transition_time:n=0) -
    sleep(t:n) -
    sync() -
    assert(condition:b) -
    textmsg(s1:x, s2:x="") -
    popup(s:x, title:x="Popup", warning:b=False, error:b=False, blocking:b=False) -
    set_digital_out(n:i, b:b) -
    set_standard_digital_out(n:i, b:b) -
    set_configurable_digital_out(n:i, b:b) -
    set_tool_digital_out(n:i, b:b) -
    set_analog_out(n:i, f:n) -
    set_standard_analog_out(n:i, f:n) -
    set_flag(n:i, b:b) -
    get_digital_in(n:i) b
    get_standard_digital_in(n:i) b
    get_configurable_digital_in(n:i) b
    get_tool_digital_in(n:i) b
    get_digital_out(n:i) b
    get_standard_digital_out(n:i) b
    get_configurable_digital_out(n:i) b
    get_tool_digital_out(n:i) b
    get_analog_in(n:i) n
    get_standard_analog_in(n:i) n
    get_tool_analog_in(n:i) n
    get_analog_out(n:i) n
    get_standard_analog_out(n:i) n
    get_flag(n:i) b
    read_input_boolean_register(address:i) b
    read_output_boolean_register(address:i) b
    read_input_integer_register(address:i) i
    read_output_integer_register(address:i) i
    read_input_float_register(address:i) n
    read_output_float_register(address:i) n
    write_output_boolean_register(address:i, value:b) -
    write_output_integer_register(address:i, value:i) -
    write_output_float_register(address:i, value:n) -
    read_port_bit(address:i) b
    read_port_register(address:i) i
    write_port_bit(address:i, value:b) -
    write_port_register(address:i, value:i) -
    modbus_set_output_register(signal_name:t, register_value:x, is_secondary_program:b=False) -
    modbus_set_output_signal(signal_name:t, digital_value:x, is_secondary_program:b=False) -
    get_actual_tcp_pose() p
    get_target_tcp_pose() p
    get_actual_tool_flange_pose() p
    get_target_tool_flange_pose() p
    get_tcp_offset() p
    get_actual_joint_positions() q
    get_joint_positions() q
    get_target_joint_positions() q
    get_forward_kin(q:q=?, tcp:p=?) p
    get_inverse_kin(x:p, qnear:q=?, maxPositionError:n=?, maxOrientationError:n=?, tcp:p=?) q
    get_inverse_kin_has_solution(pose:p, qnear:q=?, maxPositionError:n=?, maxOrientationError:n=?, tcp:p=?) b
    is_steady() b
    get_target_payload() n
    get_target_payload_cog() l3
    is_within_safety_limits(pose:m, qnear:q=?) b
    get_steptime() n
    time(mode:i=0) s
    pose_trans(p_from:p, p_from_to:p) p
    pose_inv(p_from:p) p
    pose_add(p_1:p, p_2:p) p
    pose_sub(p_to:p, p_from:p) p
    pose_dist(p_from:p, p_to:p) n
    point_dist(p_from:p, p_to:p) n
    interpolate_pose(p_from:p, p_to:p, alpha:n) p
    rotvec2rpy(rotation_vector:l) l3
    rpy2rotvec(rpy_vector:l) l3
    integer_to_binary_list(x:i) lb
    binary_list_to_integer(l:x) i
    d2r(d:n) n
    r2d(r:n) n
    sin(f:n) n
    cos(f:n) n
    tan(f:n) n
    asin(f:n) n
    acos(f:n) n
    atan(f:n) n
    atan2(x:n, y:n) n
    sqrt(f:n) n
    pow(base:n, exponent:n) n
    log(b:n, f:n) n
    floor(f:n) i
    ceil(f:n) i
    norm(a:x) n
    normalize(v:x) l
    random() n
    length(v:x) i
    get_list_length(v:x) i
    str_at(src:t, index:i) t
    str_cat(op1:x, op2:x) t
    str_empty(str:t) b
    str_find(src:t, target:t, start_from:i=0) i
    str_len(str:t) i
    str_sub(src:t, index:i, len:i=-1) t
    to_num(str:t) n
    to_str(val:x) t
"""

# What only this controller has, by effect and result.
_VENDOR = """
    tuning: set_gravity set_tool_voltage set_tool_communication set_analog_inputrange set_analog_outputdomain
        set_standard_analog_input_domain set_tool_analog_input_domain set_input_actions_to_default
        set_standard_digital_input_action set_configurable_digital_input_action set_tool_digital_input_action
        set_gp_boolean_input_action set_runstate_configurable_digital_output_to_value
        set_runstate_standard_digital_output_to_value set_runstate_standard_analog_output_to_value
        set_runstate_tool_digital_output_to_value set_runstate_gp_boolean_output_to_value
        set_tool_output_mode set_tool_digital_output_mode set_safety_mode_transition_hardness
        position_deviation_warning set_friction_coefficients collision_detection_reset set_base_acceleration
        modbus_set_signal_update_frequency set_joint_velocity_mode
    none: set_conveyor_tick_count modbus_add_signal modbus_delete_signal modbus_set_signal_watchdog
        modbus_set_runstate_dependent_choice modbus_set_digital_input_action modbus_add_rtu_signal
        enable_external_ft_sensor ft_rtde_input_enable zero_ftsensor set_tcp_offset reset_revolution_counter
        socket_close rtde_set_watchdog
        encoder_enable_pulse_decode encoder_enable_set_tick_count encoder_set_tick_count set_world_model_attr
        path_offset_set_alpha_filter path_offset_set_max_offset path_offset_enable path_offset_disable
        force_mode_set_damping force_mode_set_gain_scaling end_screwdriving
    message: socket_send_string socket_send_line socket_send_int socket_send_byte socket_set_var write_serial
    unknown: force_mode end_force_mode freedrive_mode end_freedrive_mode teach_mode end_teach_mode direct_torque
        torque_command optimovej optimovel screwdriving protective_stop powerdown
        conveyor_pulse_decode track_conveyor_linear track_conveyor_circular stop_conveyor_tracking
        set_tool_contact end_tool_contact path_offset_set modbus_send_custom_command request_popup
        pendant_node set_pos interpreter_mode end_interpreter clear_interpreter
"""
_VENDOR_VALUES = """
    b: socket_open request_boolean_from_primary_client is_freedrive
    i: get_conveyor_tick_count tool_contact encoder_get_tick_count modbus_get_error get_tool_output_mode
        get_tool_digital_output_mode request_integer_from_primary_client
        socket_get_var encoder_unwind_delta_tick_count get_freedrive_status
    n: force get_controller_temp get_joint_temp get_tool_current request_float_from_primary_client
        modbus_get_time_since_signal_invalid get_euromap_input
    t: socket_read_string socket_read_line request_string_from_primary_client get_robot_serial
    l: socket_read_ascii_float
    l3: get_tool_accelerometer_reading
    l6: get_tcp_force get_actual_tcp_speed get_target_tcp_speed get_actual_joint_speeds get_target_joint_speeds
        get_joint_torques wrench_trans get_coriolis_and_centrifugal_torques get_target_payload_inertia
    m6: get_jacobian get_jacobian_time_derivative get_mass_matrix
    li: socket_read_binary_integer socket_read_byte_list
    q: get_actual_joint_positions_history
    h: rpc_factory serial_factory rtsi_factory eip_reader_factory eip_writer_factory
    p: get_target_tcp_pose_along_path get_target_waypoint
    ?: modbus_get_signal_status get_rtde_value inv transpose dot cross size get_euromap_output
"""


def _default(text: str) -> Expr:
    if text.startswith('"'):
        return Text(text[1:-1])
    if text in ("True", "False"):
        return Truth(text == "True")
    if text.startswith("-"):
        return Sign("-", _default(text[1:]))
    return Number(int(text) if text.isdecimal() else float(text), text)


def _parameter(text: str) -> Parameter:
    name, _, rest = text.strip().partition(":")
    letter, _, default = rest.partition("=")
    if default == "?":
        return Parameter(name, letter, optional=True)
    return Parameter(name, letter, _default(default) if default else None)


def _builtins() -> dict[str, Builtin]:
    made: dict[str, Builtin] = {}
    for line in _MEANT.strip().splitlines():
        name, _, rest = line.strip().partition("(")
        inner, _, result = rest.rpartition(")")
        given = tuple(_parameter(each) for each in inner.split(",")) if inner else ()
        made[name] = Builtin(name, given, result.strip())
    for table, is_value in ((_VENDOR, False), (_VENDOR_VALUES, True)):
        word = ""
        for token in table.split():
            if token.endswith(":"):
                word = token[:-1]
            elif is_value:
                made.setdefault(token, Builtin(token, (), word, "unknown"))
            else:
                made.setdefault(token, Builtin(token, (), "?", word))
    return made


BUILTINS: dict[str, Builtin] = _builtins()


def constant(expression: Expr) -> bool:
    """Made of literals alone."""
    match expression:
        case Number() | Text() | Truth():
            return True
        case Sign(operand=operand):
            return constant(operand)
        case ListOf(items=items) | PoseOf(items=items):
            return all(constant(item) for item in items)
    return False


class BindError(Exception):
    """The arguments do not fit the function."""


def bind(builtin: Builtin, arguments: tuple[tuple[str | None, Expr], ...]) -> dict[str, Expr | None]:
    """Each parameter's expression: given by place or by name, else its default, None where it was left out."""
    bound: dict[str, Expr | None] = {}
    parameters = _parameters(builtin.name, tuple([name for name, _ in arguments]))
    for name, (_, value) in zip(parameters, arguments, strict=True):
        bound[name] = value
    for parameter in builtin.parameters:
        if parameter.name not in bound:
            bound[parameter.name] = parameter.default
    return bound


@lru_cache(maxsize=4096)
def _parameters(function: str, names: tuple[str | None, ...]) -> tuple[str, ...]:
    """The parameter that each argument is for; programs write few different ways to call a function."""
    builtin = BUILTINS[function]
    bound: list[str] = []
    place = 0
    for name in names:
        if name is None:
            if place >= len(builtin.parameters):
                raise BindError(f"{builtin.name} takes {len(builtin.parameters)} arguments at most")
            name = builtin.parameters[place].name
            place += 1
        elif all(name != parameter.name for parameter in builtin.parameters):
            name = _first_free(builtin, name)
        if name in bound:
            raise BindError(f"{builtin.name} gets {name} twice")
        bound.append(name)
    for parameter in builtin.parameters:
        if parameter.name in bound:
            continue
        if parameter.default is None and not parameter.optional:
            raise BindError(f"{builtin.name} needs {parameter.name}")
    return tuple(bound)


def _first_free(builtin: Builtin, name: str) -> str:
    """Names of parameters differ between versions: the place to go to is named `q`, `pose`, `goal`, `pose_to`."""
    if name in _PLACES and builtin.parameters and builtin.parameters[0].letter in "mq":
        return builtin.parameters[0].name
    raise BindError(f"{builtin.name} has no parameter {name}")


_PLACES = frozenset(("q", "pose", "goal", "pose_to", "x", "p", "target"))
