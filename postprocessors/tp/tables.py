"""FANUC TP's words, ranges and limits as data. `M` marks what rests on memory; each such row has a test.

Ranges are those of a controller as it is delivered; most of them can be enlarged at a controlled start.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from rpl.passes.capabilities import Bank
from rpl.registry import words
from rpl.words import spelled
from rpl.writing.precedence import Operator, OperatorTable
from rpl.writing.text import NumberStyle

_WORDS: Final = words("tp")

# M: precedence of mixed logic; all operators group to the left.
OPERATORS: Final = OperatorTable(
    binary={
        "*": Operator("*", 7, spaced=False),
        "/": Operator("/", 7, spaced=False),
        "div": Operator("DIV", 7),
        "mod": Operator("MOD", 7),
        "+": Operator("+", 6, spaced=False),
        "-": Operator("-", 6, spaced=False),
        "<": Operator("<", 5, "none", spaced=False),
        ">": Operator(">", 5, "none", spaced=False),
        "<=": Operator("<=", 5, "none", spaced=False),
        ">=": Operator(">=", 5, "none", spaced=False),
        "=": Operator("=", 4, "none", spaced=False),
        "<>": Operator("<>", 4, "none", spaced=False),
        "and": Operator("AND", 3),
        "or": Operator("OR", 2),
    },
    unary={"not": Operator("!", 8)},
    mixed=(frozenset(("and", "or")),),
)
COMPARISONS: Final = frozenset(("=", "<>", "<", ">", "<=", ">="))
SUMS: Final = frozenset(("+", "-"))
PRODUCTS: Final = frozenset(("*", "/", "div", "mod"))
# M: a plain line (without brackets) has at most five operators of one family, a plain condition five comparisons.
LONGEST_PLAIN: Final = 5
NUMBERS: Final = NumberStyle(exponent="")
DISTANCES: Final = NumberStyle(exponent="", always_point=True)  # DB 70.0mm

# Instructions with one argument in brackets that stand alone behind the equals sign.
FUNCTIONS: Final[Mapping[str, str]] = spelled(_WORDS.pairs("functions"))
# Functions of texts: a name and its arguments without brackets.
TEXT_FUNCTIONS: Final[Mapping[str, str]] = spelled(_WORDS.pairs("text_functions")) | {"text_part": "SUBSTR"}
# What the position printers say in their own way, as the right side of an assignment or the target of a move.
POSITION_FUNCTIONS: Final = frozenset(
    (
        *("current_target", "current_joints", "element_sum", "element_difference", "offset"),
        *("displaced_in_tool", "pose_of"),
    )
)

# System variables that are read by their names.
SYSTEM_VARIABLES: Final[Mapping[str, str]] = spelled(_WORDS.pairs("system_variables"))
_LAST: Final = {bank: int(last) for bank, last in _WORDS.numbers("last_numbers").items()}
# Counts as delivered; program limits at a controlled start give more (SpotTool+ manual: PR up to 2000 for one group).
R: Final = Bank("R", 1, _LAST["R"], most=999)  # M: the largest number of R
PR: Final = Bank("PR", 1, _LAST["PR"], most=2000)
SR: Final = Bank("SR", 1, _LAST["SR"], most=300)  # M: the largest number of SR
F: Final = Bank("F", 1, 1024, "flag")
TIMER: Final = Bank("TIMER", 1, 20, "timer")
POINTS: Final = Bank("P", 1, 32766)  # M: the largest that another postprocessor's authors found, 16 bits
ARGUMENTS: Final = Bank("AR", 1, 10)
BANKS: Final[Mapping[str, Bank]] = {bank.name: bank for bank in (R, PR, SR, F, TIMER, POINTS, ARGUMENTS)}
LAST_LABEL: Final = 32766
MOST_TOOLS: Final = 9  # M: UTOOL[10] exists on newer controllers only
MOST_FRAMES: Final = 9
# The controller's tables of user frames and tools, by the system variable of the element in force.
TIMED_OUT: Final = "rpl_timed_out"  # stands for the jump of a wait, and has no register
SELECTED: Final[Mapping[str, tuple[str, int]]] = {"base": ("UFRAME", MOST_FRAMES), "tool": ("UTOOL", MOST_TOOLS)}

SIGNALS: Final[Mapping[str, str]] = spelled(_WORDS.pairs("numbered_signals"))
# M: last numbers of the signals.
LAST_SIGNAL: Final[Mapping[str, int]] = {"DI": 32767, "DO": 32767, "AI": 64, "AO": 64, "GI": 100, "GO": 100, "F": 1024}
NAMED_SIGNALS: Final = (*_WORDS.pairs("named_signals"), "SEMAPHORE")
# The signals of the end of the arm, which have numbers of their own beside those of DI and DO, by folded name.
OWN_SIGNALS: Final = {f"r{way[0]}{at}": f"digital_{way}" for way in ("in", "out") for at in range(1, 9)}

LETTERS: Final[Mapping[str, str]] = {"joint": "J", "linear": "L", "circular": "C"}
# Components of a position register by their number.
POSE_ELEMENTS: Final = _WORDS.listed("pose_elements")
JOINT_ELEMENTS: Final = _WORDS.listed("joint_elements")

LONGEST_LINE: Final = 254  # M: characters of one instruction
LOGIC_NAMES = 8  # registers in one condition: so many fit in a line with their comments
LONGEST_REMARK: Final = 32
LONGEST_COMMENT: Final = 16  # of a register, a label, a position and a program
LONGEST_MESSAGE: Final = 24
SHOWN: Final = ("R", "SR", "F", "PR")  # registers that a message may name in place of a value
LONGEST_TEXT: Final = 254
MOST_ARGUMENTS: Final = 10
# The limit of a wait ($WAITTMOUT): one page of a course names 0 to 32767, no manual was found. M: of a timed wait too.
MOST_HUNDREDTHS: Final = 32767
MOST_TRIGGERS: Final = 5  # M: actions on the path of one move
DEEPEST_BLOCK: Final = 10
# Ranges of the motion settings: M the last places of the units.
LARGEST_PERCENT: Final = 100
LARGEST_MM_S: Final = 2000
LARGEST_DEG_S: Final = 500
ACCELERATION: Final = (20, 150)
LARGEST_CORNER_MM: Final = 1000
MM_PER_CNT: Final = 4.0  # a blend distance at a joint move as CNT; the same measure as for other joint blends
RESERVED: Final = frozenset(("all", "end", "abort", "pause", "call", "run", "wait", "for", "if", "else", "select"))

# What COORD says: the first coordinated pair is led by the second motion group.
(LEADER,) = _WORDS.listed("leader")
