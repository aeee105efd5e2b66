"""How V+ spells the neutral vocabulary, as data. What no manual at hand states is marked `M:`."""

from __future__ import annotations

from rpl.registry import words as shared_words
from rpl.words import spelled
from rpl.writing.precedence import Operator, OperatorTable

_WORDS = shared_words("vplus")
_NUMBERS = _WORDS.numbers("numbers")


def words(text: str) -> frozenset[str]:
    """The words of a list."""
    return frozenset(text.split())


# Words that cannot be names: of steps, of operators and functions.
RESERVED = words(
    """abort above abs accel accel.set aio.in aio.out align always and any appro appros asc atan2 attach auto band base
    below bits bmask bor brake break bxor by call calls case clear.event close closei coarse com config cos cpoff cpon
    cycle.end decompose defbelt define defined delay depart departs dest detach device disable distance do double drive
    duration dx dy dz else enable end error execute exit false fine flip fclose fopen fopena fopend fopenr fopenw for
    fract frame fseek getc global goto halt here hand hour.meter id if ignore inrange int inverse iostat ips kill last
    left lefty len local lock loc max min mmps mod monitor move movec movef moves movesf movest movet multiple nest
    next noflip nonull nooverlap normal not null of off on open openi or outside overlap parameter pause pi pos proceed
    program prompt random react reacte reacti read ready real relax relaxi release reset retry return returne righty
    runsig rx ry rz scale select set set.event setbelt shift sig sig.ins sign signal sin single speed sqr sqrt state
    step stop switch task tas then time timer to tool trans true type until val value wait wait.event while window
    write xor zero belt dry.run power cp uppper here phere pdest ppoint encode decode chr mid fldw alter alton altoff
    latch noop user spin payload update load save net calibrate mcs write mc prime sstep xstep"""
)
LONGEST_NAME = int(_NUMBERS["name_length"])  # without the sign of the type
LONGEST_LINE = 120
TIMERS = 15  # TIMER 1 .. 15 can be set
TASKS = 7  # M: tasks beside the one that runs the program, on the smallest controllers

# Relations bind loosest, OR like +, AND like * (see the reader's page).
RELATION, SUM, PRODUCT, SIGN, COMPOUND = 10, 20, 30, 40, 50
_BINARY = {
    "=": Operator("==", RELATION, "none"),
    "<>": Operator("<>", RELATION, "none"),
    "<": Operator("<", RELATION, "none"),
    ">": Operator(">", RELATION, "none"),
    "<=": Operator("<=", RELATION, "none"),
    ">=": Operator(">=", RELATION, "none"),
    "+": Operator("+", SUM, spaced=False),
    "&": Operator("+", SUM, spaced=False),
    "-": Operator("-", SUM, spaced=False),
    "or": Operator("OR", SUM),
    "cor": Operator("OR", SUM),
    "xor": Operator("XOR", SUM),
    "bor": Operator("BOR", SUM),
    "bxor": Operator("BXOR", SUM),
    "*": Operator("*", PRODUCT, spaced=False),
    "/": Operator("/", PRODUCT),
    "mod": Operator("MOD", PRODUCT),
    "and": Operator("AND", PRODUCT),
    "cand": Operator("AND", PRODUCT),
    "band": Operator("BAND", PRODUCT),
    ":": Operator(":", COMPOUND, spaced=False),
}
OPERATORS = OperatorTable(
    binary=_BINARY,
    unary={
        "-": Operator("-", SIGN),
        "+": Operator("+", SIGN),
        "not": Operator("NOT", SIGN),
        "bnot": Operator("COM", SIGN),
    },
    mixed=(frozenset(("or", "cor", "xor", "and", "cand", "band", "bor", "bxor")),),
)
WRITTEN_OPERATORS = frozenset(("div", "**"))  # written with a function

FUNCTIONS = spelled(_WORDS.pairs("functions")) | {
    "min": "MIN",
    "max": "MAX",
    "character_code": "ASC",
    "error_text": "$ERROR",
}
# Functions of texts that a program which comes along makes (library.v2), and its name.
BROUGHT_TEXTS = {"text_upper": "rpl.upper", "text_lower": "rpl.lower", "text_map": "rpl.map"}
_LARGEST_POWER = 6  # as a product


def is_raised(exponent: float) -> bool:
    """Does a program that comes along work out this power? Small whole ones are products, 0.5 is a root."""
    return exponent != 0.5 and not (exponent.is_integer() and 0 < exponent <= _LARGEST_POWER)


BYTES = {int(count): name for name, count in _WORDS.numbers("bytes").items()}  # whole numbers in a text
# Spelled without an argument.
VALUES = spelled(_WORDS.pairs("values")) | {"time_text": "$TIME()", "current_target": "HERE"}
SYSTEM = {
    "tool": "TOOL",
    "base": "INVERSE(BASE)",
    "null_frame": "NULL",
    "world": "NULL",
    "actual_pose": "HERE",
    "end_pose": "DEST",
    "actual_joints": "#PHERE",
    "error_number": "ERROR(-1)",
    "time": "TIMER(-3)",
}
SETTINGS = words(
    """acceleration_percent deceleration_percent override blending scale_acceleration end_tolerance move_duration
    posture_shoulder posture_elbow posture_wrist"""
)
POSTURES = {(name, value): word for name, shown in _WORDS.nested("postures").items() for word, value in shown.items()}
LAST_FLAG = 512  # soft signals 2001 to 2512
# The notation's flags as words: (0, 1).
FLAGS = {name: tuple(shown.split()) for name, shown in _WORDS.pairs("flags").items()}

# Signals: what is added to a neutral number, and the largest one.
SIGNALS = {kind: int(number) for kind, number in _WORDS.numbers("signals").items()}
GROUPS = {"group_out": "digital_out", "group_in": "digital_in"}
MOST_SIGNALS = int(_NUMBERS["most_signals"])
ROBOT_SIGNALS = (int(_NUMBERS["first_of_robot"]), int(_NUMBERS["last_of_robot"]))
SINGLE_OUTPUTS = frozenset(("digital_out", "flag"))
LATER = "rpl.later."  # and a number: programs that switch one output after a time
MOST_BITS = 32
HAND_OPEN, HAND_CLOSE = int(_NUMBERS["hand_open"]), int(_NUMBERS["hand_close"])
FULL_PATH_SPEED_MM_S = _NUMBERS["full_path_speed"]
FULL_ROTATION_SPEED_DEG_S = _NUMBERS["full_rotation_speed"]
STANDS_MM = 0.1  # M: nearer than this to where its motion ends, the arm counts as standing
COARSE_FACTOR = _NUMBERS["coarse_factor"]
PRIORITY_TOP = int(_NUMBERS["priority_top"])  # neutral priorities go down from it
AXES = ("j1", "j2", "j3", "j4", "j5", "j6")
EXTERNAL = ("e1", "e2", "e3", "e4", "e5", "e6")
PLACES = ("x", "y", "z")
UNUSED = 9e8  # an external axis that does not exist stands at 9E9


def is_signal(kind: str, number: float) -> bool:
    """Is there a signal of this kind with this number?"""
    first, last = ROBOT_SIGNALS
    return 1 <= number <= MOST_SIGNALS or (kind == "digital_out" and first <= number <= last)
