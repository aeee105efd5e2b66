"""INFORM's words, ranges and limits as data. `M` marks what rests on memory; each such row has a test.

Ranges are those of a controller as it is delivered.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from rpl.passes.capabilities import Bank
from rpl.registry import words
from rpl.words import spelled

_WORDS: Final = words("inform")
_NUMBERS: Final = _WORDS.numbers("numbers")

# M: a controller can be given more variables than it is delivered with (STANDARD_LAST).
B: Final = Bank("B", 0, 999)
D: Final = Bank("D", 0, 999)
I: Final = Bank("I", 0, 999)  # noqa: E741 - the controller's own letter
R: Final = Bank("R", 0, 999)
S: Final = Bank("S", 0, 999)
P: Final = Bank("P", 0, 999)
STANDARD_LAST: Final[Mapping[str, int]] = {**dict.fromkeys(("B", "D", "I", "R", "S"), 99), "P": 127}
POINTS: Final = Bank("C", 0, 9998)
BANKS: Final[Mapping[str, Bank]] = {bank.name: bank for bank in (B, D, I, R, S, P)}
NUMBERS: Final = ("B", "I", "D", "R")
WHOLE: Final = ("B", "I", "D")
RANGES: Final[Mapping[str, tuple[int, int]]] = {
    bank: (int(least), int(_WORDS.numbers("largest")[bank])) for bank, least in _WORDS.numbers("least").items()
}
TL: Final = "TL"  # the controller's tools
UF: Final = "UF"  # its user frames
TOOLS: Final = int(_NUMBERS["tools"])
USER_FRAMES: Final = int(_NUMBERS["user_frames"])

COMPARISONS: Final = frozenset(("=", "<>", "<", ">", "<=", ">="))
OPPOSITE: Final[Mapping[str, str]] = {"=": "<>", "<>": "=", "<": ">=", ">=": "<", ">": "<=", "<=": ">"}
TURNED: Final[Mapping[str, str]] = {"=": "=", "<>": "<>", "<": ">", ">": "<", "<=": ">=", ">=": "<="}
ARITHMETIC: Final[Mapping[str, str]] = spelled(_WORDS.pairs("arithmetic")) | {"div": "DIV"}
BITS: Final[Mapping[str, str]] = spelled(_WORDS.pairs("bits"))
FUNCTIONS: Final[Mapping[str, str]] = spelled(_WORDS.pairs("functions"))
TEXT_FUNCTIONS: Final[Mapping[str, str]] = {
    "text_part": "MID$",
    "text_length": "LEN",
    "character_code": "ASC",
    "from_code": "CHR$",
    "text_value": "VAL",
    "value_text": "VAL2STR",
}
# What the printer of positions says in its own way.
POSITION_FUNCTIONS: Final = (
    *("current_target", "current_joints", "target_to_joints", "joints_to_target", "inverse", "compose", "pose_of"),
    *("displaced", "displaced_in_tool", "element_sum", "element_difference", "offset"),
)
POSE_ELEMENTS: Final = _WORDS.listed("pose_elements")
EXTERNAL: Final = ("e1", "e2", "e3", "e4", "e5", "e6")
JOINT_ELEMENTS: Final = _WORDS.listed("joint_elements")
FLAGS: Final = _WORDS.listed("posture")

MM_PER_COUNT: Final = _NUMBERS["mm_per_count"]
DEG_PER_COUNT: Final = _NUMBERS["deg_per_count"]
# How many counts of a variable make the unit of a speed, time or blend.
COUNTS: Final[Mapping[str, int]] = {tag: round(1 / part) for tag, part in _WORDS.numbers("variable_units").items()}
# Least and largest value of a tag, and its decimals. M: the ranges of V and CR.
TAGS: Final[Mapping[str, tuple[float, float, int]]] = {
    "V": (0.1, 1500.0, 1),
    "VR": (0.1, 180.0, 1),
    "VJ": (0.01, 100.0, 2),
    "CR": (1.0, 500.0, 1),
    "T": (0.01, 655.35, 2),
    "ACC": (20, 100, 0),
    "DEC": (20, 100, 0),
}
LEVELS: Final = tuple(map(float, _WORDS.listed("levels")))  # distances of PL=0..8 in mm
STANDARD_LEVEL: Final = int(_NUMBERS["standard_level"])

MOVES: Final[Mapping[str, str]] = spelled(_WORDS.pairs("moves"))
SIGNALS: Final[Mapping[str, str]] = spelled(_WORDS.pairs("signals"))
# M: last numbers of the universal signals.
LAST_SIGNAL: Final[Mapping[str, int]] = {"IN": 4096, "OT": 4096, "AI": 40, "AO": 40}
DIRECT_INPUTS: Final = int(_NUMBERS["direct_inputs"])
MOST_TERMS: Final = 8  # M: comparisons in one condition
SURE_TERMS: Final = 6  # that many fit on a line
LONGEST_REMARK: Final = 32
LONGEST_LABEL: Final = 8
LONGEST_TEXT: Final = 32  # M: 16 before the DX200
LONGEST_MESSAGE: Final = 32
LONGEST_NAME: Final = 32
LONGEST_LINE: Final = 128  # M
GROUP_SIZES: Final = (8, 4)  # signals of a group: IG#, IGH# and kin
WATCH_STEP_S: Final = 0.01  # the shortest TIMER
MOST_SUBTASKS: Final = 5  # M
RESERVED: Final = frozenset(("all", "end", "nop"))
# L, U and B: axes (from 0) whose whole turns no RCONF shows, and a turn of them in degrees.
UNTURNED: Final = (1, 2, 4)
TURN_DEG: Final = 360.5
