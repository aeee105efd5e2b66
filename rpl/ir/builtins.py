"""The neutral built-in functions, procedures and system variables that dialects lower to and writers print from.

One table for each: a name, its parameter kinds, what it gives, one sentence of meaning. The interpreter implements
exactly these names; a dialect maps its own spellings to them; a target lists those it can say. Angles are degrees.
Kinds: n number, i whole number, b BOOL, t text, c text or char, p pose or target, v vector, r rotation, j joints,
x anything, l an lvalue that is written, ? the parameter may be left out.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Function:
    """`parameters`: one kind letter each, `?` behind optional ones. `result`: kind letter, or a parameter's number to
    give the same type as that argument."""

    name: str
    parameters: str
    result: str
    meaning: str


def _table(rows: str) -> dict[str, Function]:
    table = {}
    for row in rows.strip().splitlines():
        name, parameters, result, meaning = (part.strip() for part in row.split("|"))
        table[name] = Function(name, parameters.replace(" ", ""), result, meaning)
    return table


FUNCTIONS: dict[str, Function] = _table(
    """
    abs            | n        | 0 | absolute value; whole for whole numbers
    sqrt           | n        | n | square root; negative: error
    sin            | n        | n | sine of degrees
    cos            | n        | n | cosine of degrees
    tan            | n        | n | tangent of degrees
    asin           | n        | n | arc sine in degrees
    acos           | n        | n | arc cosine in degrees, 0..180
    atan           | n        | n | arc tangent in degrees, -90..90
    atan2          | nn       | n | angle of the vector (second, first) in degrees, (-180, 180]
    exp            | n        | n | e to the power
    power          | nn       | n | first to the power of second
    log            | n        | n | natural logarithm
    round          | ni?      | n | round half away from zero to the given decimals (0)
    trunc          | ni?      | n | cut toward zero to the given decimals (0)
    floor          | n        | i | largest whole number not above
    ceil           | n        | i | smallest whole number not below
    min            | nn       | n | the smaller
    max            | nn       | n | the larger
    bit_shift_left | ii       | i | shift left
    bit_shift_right| ii       | i | shift right
    length         | x        | i | number of elements of an array's first dimension, or characters of a text
    dimension      | xi       | i | number of elements of the given dimension
    inverse        | p        | p | inverse of a pose
    compose        | pp       | p | product of poses (the function form of `:`)
    transform      | pv       | v | a vector given in the pose, expressed in the pose's reference
    offset         | pnnn     | 0 | target moved by x, y, z in the axes of its frame; rotation unchanged
    tool_offset    | pnnnn?n?n? | 0 | target moved by x, y, z in its own axes, then turned about x, y, z (moving axes)
    distance       | vv       | n | distance of two positions in mm
    magnitude      | v        | n | length of a vector
    dot            | vv       | n | scalar product
    normalise      | r        | r | rotation with unit quaternion
    euler_x        | r        | n | rotation about x of the ZYX Euler angles
    euler_y        | r        | n | rotation about y of the ZYX Euler angles
    euler_z        | r        | n | rotation about z of the ZYX Euler angles
    rotation_zyx   | nnn      | r | rotation from ZYX Euler angles (about z, new y, new x)
    frame_from_points | vvvi? | p | frame through points; origin: first (1, usual), second (2), their line at third (3)
    current_target | x?x?     | p | where the tool centre point is (tool, frame; else the modal ones)
    current_joints |          | j | the joints now
    current_position | x?x?   | v | position of the tool centre point now
    target_to_joints | px?x?  | j | inverse kinematics of a target (tool, frame)
    joints_to_target | jx?x?  | p | forward kinematics (tool, frame)
    current_tool   |          | x | the tool in use as a value of tool type
    current_frame  |          | x | the work object in use as a value of work object type
    text_length    | t        | i | number of characters
    text_capacity  | t        | i | declared capacity
    text_part      | tii      | t | `third` characters from position `second` (1-based)
    text_find      | tit      | i | position of `third`'s first occurrence in first from position second; not found: 0
    text_find_any  | tit      | i | position of the first character that is in the set; not found: length + 1
    text_find_none | tit      | i | position of the first character that is not in the set; not found: length + 1
    text_match     | tit      | i | position where the pattern begins from position second; not found: length + 1
    text_member    | tit      | b | is the character at the position in the set
    text_order     | ttx      | b | is the first not after the second in the given order
    text_equal     | ttb?     | b | equal; third: ignore case
    text_upper     | t        | t | in upper case
    text_lower     | t        | t | in lower case
    text_map       | ttt      | t | characters of second replaced by those of third at the same place
    number_text    | ni       | t | the number with a fixed count of decimals
    power_text     | ni       | t | the number as a power of ten with that count of decimals: `3.85E-01`
    based_number   | ti       | i | whole number that the digits of the text show in that base (2 ... 16)
    digits_in_base | tii      | t | the digits of a whole number without sign: from one base to another, in capitals
    digits_less    | tt       | b | is the whole number in the first text less than that in the second
    digits_equal   | tt       | b | are the whole numbers in the texts equal
    digits_sum     | tt       | t | of two whole numbers in texts, up to 32 bits
    digits_difference | tt    | t | of two whole numbers in texts; error when below zero
    digits_product | tt       | t | of two whole numbers in texts, up to 32 bits
    digits_quotient | tt      | t | of two whole numbers in texts, without its fraction
    digits_remainder | tt     | t | of the division of two whole numbers in texts
    value_text     | x        | t | any value as its language writes it
    format         | tx*      | t | C-like format: %d %i %f %s %g %x %c with widths
    message_text   | tx*      | t | text with %1 %2 ... replaced by the further arguments
    text_value     | t        | n | number written in the text; error when none
    character_code | c        | i | code of the first character
    from_code      | i        | t | character of a code
    number_bytes   | ni       | t | the number, rounded, as so many bytes (two's complement), most significant first
    bytes_number   | tii      | i | signed whole number in `third` bytes of the text from position `second` (1-based)
    clock_seconds  | x        | n | time shown by a stop watch in s
    time_text      |          | t | time of day as text
    date_text      |          | t | date as text
    random         |          | n | number in [0, 1) from the run's seed
    is_uninitialised | x      | b | has the variable no value yet
    pose_of        | p        | p | the pose of a target without configuration
    error_text     | n        | t | text of an error number
    sign           | n        | n | -1, 0 or 1
    fraction       | n        | n | the part behind the decimal point, with the number's sign
    log10          | n        | n | logarithm to base 10
    element_sum    | xx       | 0 | x, y, z, a, b, c (or joints) one by one; flags of the first
    element_difference | xx   | 0 | component by component, like element_sum
    displaced      | pp       | 0 | target moved by a pose given in its frame (second . first); configuration kept
    displaced_in_tool | pp    | 0 | target moved by a pose given in its own axes (first . second); configuration kept
    rotation_vector_x | r     | n | x of the rotation vector (axis times angle in degrees)
    rotation_vector_y | r     | n | y of the rotation vector in degrees
    rotation_vector_z | r     | n | z of the rotation vector in degrees
    pose_from_rotation_vector | nnnnnn | p | pose from x, y, z and a rotation vector in degrees
    pose_zyz       | nnnnnn   | p | pose from x, y, z and angles about z, new y, new z
    zyz_yaw        | p        | n | first angle of the ZYZ Euler angles; 0 where only the sum is determined
    zyz_pitch      | p        | n | second angle of the ZYZ Euler angles, 0..180
    zyz_roll       | p        | n | third angle of the ZYZ Euler angles
    interpolate_pose | ppn    | p | straight and by the shortest rotation from first (0) to second (1), also beyond
    rotation_angle | pp       | n | angle of the rotation between two poses in degrees
    aligned        | p        | p | turned by the least angle so that z lies along an axis of the frame
    joints_from_pulses | nnnnnnn? | j | joints of motor pulses, by the arm's pulses per degree
    joint_pulses   | ji       | i | motor pulses of one axis (1 ...)
    external_from_pulses | x  | 0 | external axes of motor pulses, by the pulses per unit of the mechanisms
    with_external  | xx       | 0 | a target or joints with the given external axes
    element_product | xn      | 0 | each component times a number, like element_sum
    arc_middle     | ppp      | 2 | halfway from second to third on the circle through all three, where first is not
    pose_sum       | pp       | p | positions added, rotations multiplied (first . second)
    pose_difference | pp      | p | what added to the second gives the first: positions subtracted, second^-1 . first
    target_to_joints_near | pjx?x? | j | joints of a target nearest to given ones; flags choose first (tool, frame)
    is_reachable   | pjx?x?   | b | is there a solution for the target, starting from the given joints (tool, frame)
    task_runs      | t        | b | has the task of this routine been started, and has it not ended
    """
)

PROCEDURES: dict[str, Function] = _table(
    """
    text_append    | lt       | b | append; gives FALSE where the capacity does not suffice
    text_append_length | lt   | i | append; gives the new length, 0 where the capacity does not suffice
    text_copy      | lt       | b | copy
    text_clear     | l        | b | make empty
    parse_number   | tl       | b | text to number; FALSE when it is none
    parse_value    | tl       | b | text to a value of the variable's type; FALSE when it is none
    format_into    | lll tx*  | b | append formatted values to a text at an offset: text, state, offset (written)
    scan_from      | tll tl*  | b | read formatted values from a text from an offset
    increment      | ln?      | n | add (1)
    decrement      | ln?      | n | subtract (1)
    clear          | l        | n | set to zero
    """
)


@dataclass(frozen=True, slots=True)
class SystemVariable:
    """`type`: kind letter as above (or `P` pose, `J` joints, `T` tool, `W` work object, `L` load). `access`: r, rw."""

    name: str
    type: str
    access: str
    indexed: bool
    unit: str
    stops_advance: bool
    meaning: str


def _system(rows: str) -> dict[str, SystemVariable]:
    table = {}
    for row in rows.strip().splitlines():
        name, kind, access, indexed, unit, stops, meaning = (part.strip() for part in row.split("|"))
        table[name] = SystemVariable(name, kind, access, indexed == "i", unit, stops == "s", meaning)
    return table


SYSTEM_VARIABLES: dict[str, SystemVariable] = _system(
    """
    tool            | P | rw | - |       | - | tool centre point in the flange (or the work piece, see interpolation)
    base            | P | rw | - |       | - | base or work object frame in the world
    base_unit       | x | rw | - |       | - | name of what carries the modal base; writing `base` takes it off
    base_root       | P | rw | - |       | - | where that mechanism's root is in the world, where the program says it
    coordinated     | x | rw | - |       | - | of a path move: the mechanism in whose moving frame it is straight
    remote_tool     | b | rw | - |       | - | of a path move: straight in the held part, under the base as fixed tool
    displacement    | P | rw | - |       | - | between the frame and the targets (RAPID program displacement)
    load            | L | rw | - |       | - | payload
    robot_root      | P | rw | - |       | - | robot base in the world
    world           | P | r  | - |       | - | the world frame
    null_frame      | P | r  | - |       | - | identity pose
    held_work       | b | rw | - |       | - | TRUE: the robot holds the part, the tool is fixed in the room
    path_speed      | n | rw | - | mm/s  | - | speed of the tool centre point
    path_acceleration | n | rw | - | mm/s2 | - | acceleration of the tool centre point
    swivel_speed    | n | rw | - | deg/s | - | reorientation speed, swivel
    twist_speed     | n | rw | - | deg/s | - | reorientation speed, rotation about the tool
    swivel_acceleration | n | rw | - | deg/s2 | - | reorientation acceleration, swivel
    twist_acceleration | n | rw | - | deg/s2 | - | reorientation acceleration, rotation about the tool
    joint_speed     | n | rw | i | percent | - | speed of an axis
    joint_acceleration | n | rw | i | percent | - | acceleration of an axis
    external_speed  | n | rw | i | percent | - | speed of an external axis
    external_acceleration | n | rw | i | percent | - | acceleration of an external axis
    path_jerk       | n | rw | - |       | - | jerk on the path
    blend_distance  | n | rw | - | mm    | - | distance at which a blend begins
    blend_rotation  | n | rw | - | deg   | - | rotation at which a blend begins
    blend_speed     | n | rw | - | percent | - | speed at which a blend begins
    blend_joint     | n | rw | - | percent | - | joint blend
    orientation_mode | x | rw | - |      | - | how the orientation goes on a path: variable, constant, wrist
    circle_orientation | x | rw | - |    | - | reference of the orientation on a circle: base, path
    interpolation   | x | rw | - |       | - | base: the robot holds the tool; tool: it holds the part
    singular_rule   | i | rw | i |       | - | rule at each singularity: 0 axis to zero, 1 keep the axis
    path_limit_rule | x | rw | - |       | - | what happens when an axis would be too fast: constant, reduce
    advance         | i | rw | - |       | - | number of moves the program pointer may be ahead
    override        | n | rw | - | percent | - | programmed speed override
    speed_percent   | n | rw | - | percent | - | RAPID VelSet override
    speed_limit     | n | rw | - | mm/s  | - | RAPID VelSet maximum
    acceleration_percent | n | rw | - | percent | - | RAPID AccSet acceleration
    acceleration_ramp | n | rw | - | percent | - | RAPID AccSet ramp
    deceleration_percent | n | rw | - | percent | - | deceleration, where that is not as strong as the acceleration
    scale_acceleration | b | rw | - | | - | acceleration and deceleration are a share of what is said, as the speed is
    stop_ramp       | n | rw | - | percent | - | RAPID AccSet: how fast the deceleration changes before a stop
    joint_configuration_check | b | rw | - | | - | joint moves go to exactly the programmed configuration
    path_configuration_check | b | rw | - | | - | path moves check the programmed configuration at their end
    singularity_mode | x | rw | - |      | - | wrist: wrist axes interpolated in joints; off; lock_axis_4
    actual_pose     | P | r  | - |       | s | tool centre point now
    actual_joints   | J | r  | - |       | s | joints now
    actual_joint    | n | r  | i | deg   | s | one joint now
    tool_of_moves   | p | r  | - |       | s | the tool of the task that moves the robot, for a task beside it
    frame_of_moves  | p | r  | - |       | s | the frame of the task that moves the robot, for a task beside it
    start_pose      | P | r  | - |       | s | start of the current move
    end_pose        | P | r  | - |       | s | end of the current move
    interrupt_pose  | P | r  | - |       | s | where the robot was when the interrupt came
    interrupt_joints | J | r | - |       | s | joints when the interrupt came
    return_pose     | P | r  | - |       | s | where the robot was stopped on its path (now, while it is on one)
    return_joints   | J | r  | - |       | s | joints where the robot was stopped on its path
    remaining_distance | n | r | - | mm  | s | distance to the end of the current move
    path_speed_actual | n | r | - | mm/s | s | speed now
    timer           | n | rw | i | s     | - | a timer that runs unless stopped
    timer_stopped   | b | rw | i |       | - | stops and starts a timer
    timer_positive  | b | r  | i |       | - | timer above zero
    flag            | b | rw | i |       | - | global flag
    cyclic_flag     | b | rw | i |       | - | flag evaluated cyclically
    error_number    | n | r  | - |       | - | number of the error being handled
    interrupt_number | n | r | - |       | - | identity of the interrupt being handled
    mode            | x | r  | - |       | - | operating mode
    simulated       | b | r  | - |       | - | TRUE: no real robot
    time            | n | r  | - | s     | - | time since the start of the run
    step_time       | n | r  | - | s     | - | one cycle of the controller, the shortest wait (URScript get_steptime)
    date            | x | r  | - |       | - | date and time record
    moving          | b | r  | - |       | s | is the robot moving
    posture_shoulder | x | rw | - |     | - | asked of joint moves to poses without flags: front, back or empty
    posture_elbow   | x | rw | - |      | - | asked of joint moves to poses without flags: up, down or empty
    posture_wrist   | x | rw | - |      | - | asked of joint moves to poses without flags: flip, noflip or empty
    move_duration   | n | rw | - | s    | - | least time of a move (V+ DURATION)
    end_tolerance   | n | rw | - | percent | - | how exactly a stop is waited for (V+ FINE, COARSE)
    home_joints     | J | r  | - |       | - | the joints of the robot's ready position
    blending        | b | rw | - |      | - | FALSE: every move ends in a stop (V+ CPOFF)
    """
)
