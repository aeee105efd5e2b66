"""What INFORM's words mean in neutral terms, and the numbers that differ between controllers. Data only.

Sources are the operator's and data transmission manuals of NX100 to YRC1000. `M` marks what rests on memory or could be
set otherwise on a controller; each such row has a test that names it.
"""

from __future__ import annotations

import re

from rpl.registry import words

_WORDS = words("inform")
_NUMBERS = _WORDS.numbers("numbers")

# ---- units of numbers without a unit of their own

MM_PER_COUNT, DEG_PER_COUNT = _NUMBERS["mm_per_count"], _NUMBERS["deg_per_count"]  # of elements of a position
VARIABLE_UNITS = _WORDS.numbers("variable_units")
# Least and largest value of whole variables.
WIDTHS = {bank: (int(least), int(_WORDS.numbers("largest")[bank])) for bank, least in _WORDS.numbers("least").items()}
LAST_BYTE = WIDTHS["B"][1]
LAST_VARIABLE = 99  # M: of B, I, D, R and S as delivered
VOLTS_PER_COUNT = 0.01  # of a variable that AOUT is given
PULSE_S = 0.3  # M: PULSE without a time
# M: a speed in V= is mm/s (a parameter can make it cm/min, inch/min or mm/min).
PATH_UNIT = "mm/s"

# ---- positioning levels

# M: the last one stands for a move without PL, which a controller rounds by its acceleration.
LEVELS = (*map(float, _WORDS.listed("levels")), 25.0)
STANDARD_LEVEL = int(_NUMBERS["standard_level"])

# ---- moves

MOVE_KINDS = _WORDS.pairs("moves") | {"IMOV": "linear"}
MOVES = frozenset((*MOVE_KINDS, *(f"S{word}" for word in MOVE_KINDS)))

# ---- frames and tools

USER_FRAMES, TOOLS = int(_NUMBERS["user_frames"]), int(_NUMBERS["tools"])
# Words for a frame: the base and the robot's own (M: taken to be the same), the tool.
BASE_WORDS = ("BF", "RF", "BASE", "ROBOT")
TOOL_WORDS = ("TF", "TOOL")

# ---- elements of positions

POSE_ELEMENTS = _WORDS.listed("pose_elements")
JOINT_ELEMENTS = _WORDS.listed("joint_elements")
POSTURE = _WORDS.listed("posture")

# ---- signals, calculation

SIGNALS = _WORDS.pairs("signals")
DIRECT_INPUTS = int(_NUMBERS["direct_inputs"])
ARITHMETIC, BITS, FUNCTIONS = _WORDS.pairs("arithmetic"), _WORDS.pairs("bits"), _WORDS.pairs("functions")

# ---- comparison and logic words

AND_WORDS = ("ANDEXP", "ANDIF", "AND", "ANDEXPRESS")
OR_WORDS = ("OREXP", "ORIF", "OR", "OREXPRESS")
# M: SET FL0010 ON, SET FL0010 LOGICEXP (condition), FL0010=ON in conditions.
FLAG = re.compile(r"FL\d{1,4}")
# Timers of newer controllers. M: TM000 counts milliseconds up from where it is set; SETTM TM000 500 lets its flag TF000
# come 500 ms later, until when the timer shows what is missing as a negative number.
TIMER, TIMER_FLAG = re.compile(r"TM(\d{1,3})"), re.compile(r"TF(\d{1,3})")
TIMER_UNIT = "ms"
CONDITION_WORDS = ("IF", "IFEXP", "IFEXPRESS")

# ---- system variables read by GETS

# $PXn: what, and whether in pulses. `current`: where the robot is; `searched`: where the last search found its signal.
POSITIONS: dict[str, tuple[str, bool]] = {
    "PX000": ("current", True),
    "PX001": ("current", False),
    "PX002": ("searched", True),
    "PX003": ("searched", False),
    "PX007": ("searched", True),  # M: as its use in touch sensing jobs shows
    # M: the place commanded, as against the one measured; here they are one.
    "PX010": ("current", True),
    "PX011": ("current", False),
}
SEARCH_STATUS = "B002"  # 1: the last SRCH found its signal
WAIT_STATUS = "B014"  # 1: the last WAIT with a time ended by its condition
# Global data that stand for these.
SEARCH_FOUND, SEARCH_PLACE, WAIT_LATE, UNTIL_MET = "SEARCH_FOUND", "SEARCH_PLACE", "WAIT_LATE", "UNTIL_MET"
# M: a shift lasts until SFTOF, also where the job that began it has ended (jobs that only begin one are in use).
SHIFT, SHIFT_IN_TOOL = "SHIFT", "SHIFT_IN_TOOL"
# While a text is read as a number to another base (VAL ... RADIX=16).
DIGITS, DIGITS_AT, DIGIT, DIGITS_SUM = "VAL_TEXT", "VAL_AT", "VAL_DIGIT", "VAL_SUM"
DIGIT_WORDS = "0123456789ABCDEFabcdef"
# What the last RET with a value gave back (M: kept until the next one): numbers, texts.
RETURNED = "RV"
RETURN_VALUE, RETURN_TEXT = "RETURN_VALUE", "RETURN_TEXT"

# ---- instructions that only this controller has: effect none, message, time, unknown

VENDOR: dict[str, str] = {
    # look-ahead, accuracy, monitoring: no effect on what the program means
    **dict.fromkeys(("ADVINIT", "ADVSTOP", "HTRAJON", "HTRAJOF", "HPVELON", "HPVELOF", "SMOOTH", "HPMMVON"), "tuning"),
    **dict.fromkeys(("HPMMVOF", "SHCKSET", "SHCKRST"), "tuning"),
    **dict.fromkeys(("LATESTJOB", "SAVEJ", "SAVEV", "SETFILE"), "none"),
    **dict.fromkeys(("REFP", "GRPOF", "GRPON", "PMTON", "PMTOF", "FLWOF", "FLWON"), "none"),
    # arc welding
    **dict.fromkeys(("ARCON", "ARCOF", "ARCSET", "ARCCUR", "ARCVOL", "AWELD", "VWELD", "WVON", "WVOF"), "none"),
    **dict.fromkeys(("ARCCTS", "ARCCTE", "COMARCON", "COMARCOF", "WIRRTN", "TAILON", "PRE-TIG"), "none"),
    # handling, spot, painting, sealing
    **dict.fromkeys(("HAND", "TOOLON", "TOOLOF", "SPYON", "SPYOF", "GUNON", "GUNOF", "ARATION", "ARATIOF"), "none"),
    **dict.fromkeys(("GUNCL", "SPOT", "SVSPOT", "SVGUNCL", "STROKE", "SVSTROKE", "GUNCHG"), "unknown"),
    **dict.fromkeys(("HSEN", "STRWAIT"), "unknown"),
    # whole motions made by the controller itself
    **dict.fromkeys(("FORMCUT", "FORMAPR", "CIRCUT", "CUTSET", "SYSTART", "SYEND", "CVTON", "CVTOF"), "unknown"),
    # other tasks and programs
    "SKILLSND": "message",
    **dict.fromkeys(("LOADJ", "DELETEJ", "LOADV", "SWAIT", "EI", "DI", "VSTART", "VDET", "VWAIT"), "unknown"),
    **dict.fromkeys(("SETPRM", "GETNAME", "CONVSFT"), "unknown"),
}
# Application packages by the beginning of a word, where the word itself is not listed.
VENDOR_BEGINNINGS: tuple[tuple[str, str], ...] = (
    ("SY", "unknown"),
    ("ARC", "none"),
    ("WV", "none"),
    ("MACRO", "unknown"),
    ("PAL", "unknown"),
)


def vendor_effect(word: str) -> str | None:
    """The declared effect of an instruction that only this controller has; None when it is none of them."""
    if word in VENDOR:
        return VENDOR[word]
    return next((effect for beginning, effect in VENDOR_BEGINNINGS if word.startswith(beginning)), None)


# Words and tags of a move that change nothing in what it means here.
PLAIN_MOVE_WORDS = frozenset(("FPT", "REF", "SYNC"))
PLAIN_MOVE_TAGS = frozenset(("SPDL", "MVF", "CTP", "SEN"))
