"""What V+'s own words mean in neutral terms: signals, switches, built-in functions, instructions of one controller.

Data only. `M` marks what rests on memory of the manuals alone; each such row has a test as a hypothesis.
"""

from __future__ import annotations

from rpl import ir

REAL, TEXT = ir.RealType(), ir.StringType()
POSE, JOINTS = ir.PoseType(), ir.JointsType(external=False)
# What the sign in front of a function's name says of its value.
OF_SIGIL: dict[str, ir.Type] = {"$": TEXT, "#": JOINTS}

# Only so many characters of a name count (user's guide: fifteen, the rest is cut without a word). M: the sign of the
# type in front of it is not counted.
NAME_LENGTH = 15

# M: numbers of signals: outputs from 1, inputs from 1001, software signals from 2001, signals of the robot from 3001.
# (first, last, neutral kind, what is taken off the number)
SIGNAL_RANGES: tuple[tuple[int, int, str, int], ...] = (
    (1, 999, "digital_out", 0),
    (1001, 1999, "digital_in", 1000),
    (2001, 2999, "flag", 2000),
    (3001, 3999, "digital_out", 0),
)
# M: the hand's solenoids are the first two signals of the robot.
HAND_OPEN, HAND_CLOSE = 3001, 3002
# M: HAND.TIME is a parameter; its default stands in for what the controller has stored. Seconds. A project that sets it
# to one number has that number throughout, since the controller keeps it.
HAND_TIME_S = 0.05
# WAIT without a condition waits for the next trajectory cycle (user's guide: 16 ms).
CYCLE_S = 0.016
# M: a reaction without a priority has this one; V+ counts upwards, the neutral order downwards from PRIORITY_TOP.
REACT_PRIORITY = 1
PRIORITY_TOP = 128

# What 100 percent of SPEED means for straight lines and for turning the tool. M: the controller has it in its robot
# data; these stand in for it and are what a share of it is calculated from.
FULL_PATH_SPEED_MM_S = 1000.0
FULL_ROTATION_SPEED_DEG_S = 180.0
MM_PER_INCH = 25.4

# An array with an index that nobody can foresee gets at least this last index (V+ arrays grow as they are used).
# Of three dimensions each gets the smaller one: a run has a place for every element.
LAST_INDEX = 255
LAST_INDEX_OF_THREE = 63

CONSTANTS: dict[str, ir.Expression] = {
    "true": ir.BoolLiteral(True),
    "on": ir.BoolLiteral(True),
    "false": ir.BoolLiteral(False),
    "off": ir.BoolLiteral(False),
    "pi": ir.RealLiteral(3.141592653589793),
    "tps": ir.RealLiteral(62.5),  # M: ticks of the system clock per second, one each 16 ms
}

# Functions of numbers and texts that are the neutral ones under another name: V+ name -> (neutral, count of arguments).
FUNCTIONS: dict[str, tuple[str, int]] = {
    "abs": ("abs", 1),
    "atan2": ("atan2", 2),
    "cos": ("cos", 1),
    "sin": ("sin", 1),
    "sqrt": ("sqrt", 1),
    "fract": ("fraction", 1),
    "int": ("trunc", 1),
    "random": ("random", 0),
    "inverse": ("inverse", 1),
    "len": ("text_length", 1),
    "val": ("text_value", 1),
    "$chr": ("from_code", 1),
    "$time": ("time_text", 0),
    "#phere": ("current_joints", 0),
}

# Whole numbers in binary: how many bytes, most significant first (V+ language reference). M: real numbers are rounded.
BYTES: dict[str, int] = {"$intb": 2, "intb": 2, "$lngb": 4, "lngb": 4}

# Numbers to another base: binary, hexadecimal, octal. M: VAL reads them in a text as well.
NUMBER_MARKS: dict[str, int] = {"^b": 2, "^h": 16, "^": 8}

# TASK(1, n) gives this while task n executes (drivers that watch their tasks ask for it). M: 0 when it does not; which
# other numbers say how it has ended is not imitated.
TASK_STATE, TASK_EXECUTING = 1, 4

# Functions whose value only the controller knows; a run stops there unless the cell file gives the value.
CONTROLLER_VALUES: dict[str, ir.Type] = {
    **dict.fromkeys(
        """accel bstatus belt config dblb device duration error fltb force.read get.event getc getevent id identical
        int.event hand iostat last latched parameter pendant priority select sig.ins solve.angles solve.flags speed
        state strdif switch tas task time transb vfeature vlocate vparameter vresult vstate window
        """.split(),  # noqa: SIM905 (a word list reads better)
        REAL,
    ),
    **dict.fromkeys(("latch", "scale", "solve.trans", "transb", "vlocation"), POSE),
    "#platch": JOINTS,
    **dict.fromkeys(
        "$fltb $dblb $transb $id $symbol $system $truncate $unpack".split(),  # noqa: SIM905
        TEXT,
    ),
}

# Instructions that only the controller can carry out, by their first word, with what a run must know of them.
RAW_EFFECTS: dict[str, str] = {
    "fclose": "none",
    **dict.fromkeys(("attach", "detach", "payload", "noop", "select", "calibrate"), "tuning"),
    "mcs": "message",
    "write": "message",
}
# Switches that a run of the emulated arm does not feel. DRY.RUN and UPPER would change what a program does: any other
# switch stops a run unless the cell file says what it stands for.
SWITCHES_WITHOUT_EFFECT = frozenset(
    """auto.power.off autostart belt force interactive kermit mcp.messages mcs.message mcs.messages messages monitors
    network power robot set.speed trace vision
    """.split()  # noqa: SIM905
)

# Switches that are settings of the moves behind them. M: SCALE.ACCEL is that of the task's robot.
SETTING_SWITCHES = {"cp": "blending", "scale.accel": "scale_acceleration"}

# M: these are on in a robot that works.
SWITCHED_ON = frozenset(("power", "robot", "messages"))

# M: numbers of the errors that a program can ask for with ERROR(-1).
ERRORS: dict[str, int] = {
    "no_value": -401,
    "unreachable": -610,
    "joint_limit": -1024,
    "division_by_zero": -403,
    "negative_argument": -410,
}

# Posture words: (neutral variable, neutral word). RIGHTY is the arm with its elbow to the right of the line from
# shoulder to wrist; on a six-axis arm the neutral front (M), on a SCARA the positive second joint.
POSTURES: dict[str, tuple[str, str]] = {
    "righty": ("posture_shoulder", "front"),
    "lefty": ("posture_shoulder", "back"),
    "above": ("posture_elbow", "up"),
    "below": ("posture_elbow", "down"),
    "flip": ("posture_wrist", "flip"),
    "noflip": ("posture_wrist", "noflip"),
}
# Settings that a run of the emulated arm does not feel: whether the servos settle, how far the wrist may turn.
SETTLING = frozenset(("null", "nonull", "single", "multiple", "overlap", "nooverlap"))
# M: COARSE 100 is this many times as wide as FINE 100, of which `end_tolerance` is a percentage.
COARSE_FACTOR = 10.0
