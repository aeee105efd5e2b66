"""What TP's own words mean in neutral terms: `words.toml` as the reader asks it, and what only the reader knows.

`M` marks what rests on memory and has a test of its own.
"""

from __future__ import annotations

import re

from rpl import ir
from rpl.registry import words

_WORDS = words("tp")
# TP's letter -> neutral kind.
NUMBERED_SIGNALS = _WORDS.pairs("numbered_signals")
NAMED_SIGNALS = _WORDS.pairs("named_signals")
# How many there are of those whose number a program may compute.
NAMED_COUNTS = {"RI": 8, "RO": 8, "UI": 18, "UO": 20, "SI": 15, "SO": 15}

# M: a program that uses a higher number makes the bank of registers larger.
LAST_NUMBER = {bank: int(last) for bank, last in _WORDS.numbers("last_numbers").items()}
FRAMES = {"UFRAME": 9, "UTOOL": 10}
# Numeric registers beyond it belong to one call of a program (LOCAL_REGISTERS of its header). M: 0 at the start.
LOCAL_REGISTERS = 10000

FUNCTIONS = _WORDS.pairs("functions") | _WORDS.pairs("text_functions")
CARTESIAN_ELEMENTS = _WORDS.listed("pose_elements")
JOINT_ELEMENTS = _WORDS.listed("joint_elements")
SYSTEM_VARIABLES = _WORDS.pairs("system_variables")
ACTIVE_NUMBERS = {"$MNUFRAMENUM[1]": "UFRAME_NUM", "$MNUTOOLNUM[1]": "UTOOL_NUM"}
FRAME_VARIABLE = re.compile(r"\$MN(UFRAME|UTOOL)\[1,(\d+)\]")  # of the arm, a whole position
# M: actual position in the world frame, element by element.
ACTUAL_POSITION = {
    "$SCR_GRP[1].$MCH_POS_X": "x",
    "$SCR_GRP[1].$MCH_POS_Y": "y",
    "$SCR_GRP[1].$MCH_POS_Z": "z",
    "$SCR_GRP[1].$MCH_POS_W": "c",
    "$SCR_GRP[1].$MCH_POS_P": "b",
    "$SCR_GRP[1].$MCH_POS_R": "a",
}
WAIT_TIMEOUT = "$WAITTMOUT"
WAIT_TIMEOUT_DEFAULT = 3000  # M: hundredths of a second
LONGEST_PULSE_TENTHS = 255  # measured: 25.6 s is refused
PULSE_DEFAULT_S = 0.4  # M: $DEFPULSE 4, in tenths of a second

# Path speed that max_speed stands for, mm/s: $SPEEDLIM of R-2000iB controller files; joint moves take 100 percent.
MAX_SPEED_MM_S = 2000.0
# WELD_SPEED is data of the weld schedule, which no listing holds: only the controller knows it.
ONLY_CONTROLLER_SPEEDS = frozenset(("weld_speed",))

UNITS: dict[str, tuple[str, str]] = {
    # unit -> (field of ir.Speed, unit of the quantity; empty for the base unit)
    "%": ("joint", ""),
    "mm/sec": ("path", ""),
    "mm/s": ("path", ""),
    "cm/min": ("path", "cm/min"),
    "inch/min": ("path", "inch/min"),
    "deg/sec": ("rotation", ""),
    "deg/s": ("rotation", ""),
    "sec": ("duration", ""),
    "msec": ("duration", "ms"),
}

# Options of a move without a number that change only speed or smoothness, not where the robot goes.
HARMLESS_OPTIONS = frozenset(("pth", "break", "mrot", "cjnt"))
# Options with a number that say only how straight the way is near a point.
HARMLESS_NUMBERS = frozenset(("pspd", "rt_ld", "ap_ld"))

# Instructions of applications, by their first words: what a run must know of them. Everything else is unknown.
INSTRUCTION_EFFECTS: tuple[tuple[str, str], ...] = (
    ("col detect", "tuning"),
    ("col guard", "tuning"),
    ("lock preg", "tuning"),
    ("unlock preg", "tuning"),
    ("lock vreg", "tuning"),
    ("unlock vreg", "tuning"),
    ("payload", "tuning"),
    # Which start requests are taken, what is recorded or shown: nothing that a program could notice.
    ("rsr[", "none"),
    ("return_path_dsbl", "none"),
    ("returnpath_dsbl", "none"),
    ("diag_rec", "none"),
    ("sample start", "none"),
    ("sample end", "none"),
    ("auto backward exit", "none"),
    # Limits of speed and force: they change how a move goes, not where to.
    ("joint_max_speed", "tuning"),
    ("linear_max_speed", "tuning"),
    ("torq_limit", "tuning"),
    ("softfloat", "tuning"),
    # M: a travel condition that always holds (VW body shop).
    ("tc_online (on)", "none"),
    ("tc_online(on)", "none"),
    ("fb-psps (on)", "none"),
    ("fb-psps (an)", "none"),
    ("fb online (an)", "none"),
    ("arc start", "unknown"),
)
# M: names of the gripper macros as the handling tool comes with them -> their programs.
STANDARD_MACROS: dict[str, str] = {
    "open hand 1": "HOPN1",
    "close hand 1": "HCLS1",
    "relax hand 1": "HRELX1",
    "open hand 2": "HOPN2",
    "close hand 2": "HCLS2",
    "relax hand 2": "HRELX2",
}


def instruction_effect(text: str) -> str:
    """The declared effect of an application instruction."""
    lower = " ".join(text.lower().split())
    return next((effect for start, effect in INSTRUCTION_EFFECTS if lower.startswith(start)), "unknown")


NUMBER = ir.RealType()
TARGET = ir.TargetType("tp")
JOINTS = ir.JointsType()

(LEADER,) = _WORDS.listed("leader")
