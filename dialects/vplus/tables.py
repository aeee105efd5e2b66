"""What V+'s own words mean in neutral terms: signals, switches, built-in functions, instructions of one controller.

Data only. `M` marks what rests on memory of the manuals alone; each such row has a test as a hypothesis.
"""

from __future__ import annotations

from rpl import ir
from rpl.registry import words
from rpl.words import lowered

_WORDS = words("vplus")
_NUMBERS = _WORDS.numbers("numbers")
REAL, TEXT = ir.RealType(), ir.StringType()
POSE, JOINTS = ir.PoseType(), ir.JointsType(external=False)
# What the sign in front of a function's name says of its value.
OF_SIGIL: dict[str, ir.Type] = {"$": TEXT, "#": JOINTS}

# Only so many characters of a name count; the rest is cut without a word.
NAME_LENGTH = int(_NUMBERS["name_length"])

# What is added to neutral numbers, the largest of these, and the signals of the robot.
OFFSETS = {kind: int(number) for kind, number in _WORDS.numbers("signals").items()}
MOST_SIGNALS = int(_NUMBERS["most_signals"])
ROBOT_SIGNALS = (int(_NUMBERS["first_of_robot"]), int(_NUMBERS["last_of_robot"]))
# First, last, neutral kind, what is taken off the number.
SIGNAL_RANGES: tuple[tuple[int, int, str, int], ...] = (
    *((1 + offset, MOST_SIGNALS + offset, kind, offset) for kind, offset in OFFSETS.items()),
    (*ROBOT_SIGNALS, "digital_out", 0),
)
HAND_OPEN, HAND_CLOSE = int(_NUMBERS["hand_open"]), int(_NUMBERS["hand_close"])
# M: HAND.TIME is a parameter; its default stands in for what the controller has stored. Seconds. A project that sets it
# to one number has that number throughout, since the controller keeps it.
HAND_TIME_S = 0.05
# WAIT without a condition waits for the next trajectory cycle (user's guide: 16 ms).
CYCLE_S = 0.016
REACT_PRIORITY = 1  # M: of a reaction without one
PRIORITY_TOP = int(_NUMBERS["priority_top"])

FULL_PATH_SPEED_MM_S = _NUMBERS["full_path_speed"]
FULL_ROTATION_SPEED_DEG_S = _NUMBERS["full_rotation_speed"]
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
    **{name: (neutral, 1) for name, neutral in lowered(_WORDS.pairs("functions")).items()},
    "atan2": ("atan2", 2),
    "int": ("trunc", 1),
    **{name: (neutral, 0) for name, neutral in lowered(_WORDS.pairs("values")).items()},
}

# Whole numbers in binary: how many bytes, most significant first (V+ language reference). M: real numbers are rounded.
BYTES: dict[str, int] = {
    sign + name.lower(): int(count) for name, count in _WORDS.numbers("bytes").items() for sign in ("", "$")
}

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

# Posture words: (neutral variable, neutral word).
POSTURES: dict[str, tuple[str, str]] = {
    word.lower(): (name, value) for name, words in _WORDS.nested("postures").items() for word, value in words.items()
}
# The notation's flags as words: (0, 1).
FLAGS = {name: (first, second) for name, text in _WORDS.pairs("flags").items() for first, second in (text.split(),)}
# Settings that a run of the emulated arm does not feel: whether the servos settle, how far the wrist may turn.
SETTLING = frozenset(("null", "nonull", "single", "multiple", "overlap", "nooverlap"))
# `end_tolerance` is a percentage of FINE 100.
COARSE_FACTOR = _NUMBERS["coarse_factor"]
