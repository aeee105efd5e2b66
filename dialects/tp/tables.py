"""What TP's own words mean in neutral terms. Data only. `M` marks what rests on memory and has a test of its own."""

from __future__ import annotations

import re

from rpl import ir

# Signals: TP's letter -> neutral kind. The groups without a number space of their own are named signals.
NUMBERED_SIGNALS: dict[str, str] = {
    "DI": "digital_in",
    "DO": "digital_out",
    "AI": "analog_in",
    "AO": "analog_out",
    "GI": "group_in",
    "GO": "group_out",
    "F": "flag",
}
NAMED_SIGNALS: dict[str, str] = {
    "RI": "digital_in",
    "RO": "digital_out",
    "UI": "digital_in",
    "UO": "digital_out",
    "SI": "digital_in",
    "SO": "digital_out",
    "WI": "digital_in",
    "WO": "digital_out",
    "WSI": "digital_in",
    "WSO": "digital_out",
    "M": "flag",
}
# How many there are of those whose number a program may compute.
NAMED_COUNTS = {"RI": 8, "RO": 8, "UI": 18, "UO": 20, "SI": 15, "SO": 15}
SIGNAL_LETTERS = {kind: letter for letter, kind in NUMBERED_SIGNALS.items()}

# Register banks: TP's letter -> type of an element, first and last number, value before anything was written.
# M: counts of a standard controller; a program that uses a higher number makes the bank larger.
LAST_NUMBER = {"R": 200, "PR": 100, "SR": 25}
FRAMES = {"UFRAME": 9, "UTOOL": 10}
# Numeric registers beyond it belong to one call of a program (LOCAL_REGISTERS of its header). M: 0 at the start.
LOCAL_REGISTERS = 10000

FUNCTIONS: dict[str, str] = {
    "SIN": "sin",
    "COS": "cos",
    "TAN": "tan",
    "ASIN": "asin",
    "ACOS": "acos",
    "ATAN": "atan",
    "ATAN2": "atan2",  # M: ATAN2[y,x]
    "SQRT": "sqrt",
    "SQR": "sqrt",
    "EXP": "exp",
    "LN": "log",
    "ABS": "abs",
    "TRUNC": "trunc",
    "ROUND": "round",
    "STRLEN": "text_length",
}

# Elements of a position register by number.
CARTESIAN_ELEMENTS = ("x", "y", "z", "c", "b", "a", "e1", "e2", "e3")
JOINT_ELEMENTS = ("j1", "j2", "j3", "j4", "j5", "j6", "e1", "e2", "e3")

# System variables that have a neutral meaning (upper case, without blanks).
SYSTEM_VARIABLES: dict[str, str] = {
    "$MCR.$GENOVERRIDE": "override",
}
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

# M: COORD goes with the first coordinated pair, whose leader is the second motion group; a cell file says where it
# stands by a [[mechanism]] of this name. Positions count in the user frame in the room, the way is straight on it.
LEADER = "GP2"
