"""How VAL3 spells the neutral vocabulary, as data."""

from __future__ import annotations

from rpl.registry import words as shared_words
from rpl.words import spelled
from rpl.writing.precedence import RELATIONS, Operator, OperatorTable
from rpl.writing.text import NumberStyle


def words(text: str) -> frozenset[str]:
    """The words of a list."""
    return frozenset(text.split())


RESERVED = words(
    """begin end if then else elseIf endIf while endWhile do until for to step endFor switch case default break
    endSwitch return call taskCreate taskCreateSync and or xor true false num bool string trsf frame tool point
    pointRx joint jointRx config mdesc dio aio sio world flange abs acos aioGet aioSet appro asc asin atan
    autoConnectMove chr clock close cls compose cos delay dioGet dioSet distance enablePower exp find get getKey
    getMonitorSpeed here herej interpolateL isEmpty isPowered isSettled jointToPoint left len limit link ln log
    logMsg max mid min movec movej movel open pointToJoint popUpMsg position power put putln resetMotion
    restartMove right round roundDown roundUp sel setFrame setMonitorSpeed sin size sqrt start stop stopMove tan
    taskKill taskResume taskStatus taskSuspend toNum toString trunc userPage wait waitEndMove watch off Cartesian"""
).union(*map(words, shared_words("val3").pairs("configuration").values()))
LONGEST_NAME = 15
NUMBERS = NumberStyle(exponent="")

_OR, _AND, _EQUAL, ORDER, SUM, _PRODUCT, SIGN = 10, 20, 30, 40, 50, 60, 70
_BINARY = {
    "or": Operator("or", _OR),
    "cor": Operator("or", _OR),
    "xor": Operator("xor", _OR),
    "and": Operator("and", _AND),
    "cand": Operator("and", _AND),
    "=": Operator("==", _EQUAL, "none", False),
    "<>": Operator("!=", _EQUAL, "none", False),
    "<": Operator("<", ORDER, "none", False),
    ">": Operator(">", ORDER, "none", False),
    "<=": Operator("<=", ORDER, "none", False),
    ">=": Operator(">=", ORDER, "none", False),
    "+": Operator("+", SUM, spaced=False),
    "-": Operator("-", SUM, spaced=False),
    "&": Operator("+", SUM, spaced=False),
    "*": Operator("*", _PRODUCT, spaced=False),
    "/": Operator("/", _PRODUCT, spaced=False),
    "mod": Operator("%", _PRODUCT, spaced=False),
    ":": Operator("*", _PRODUCT, spaced=False),
}
# Precedence rests on memory (M): operators of different kinds side by side get brackets.
OPERATORS = OperatorTable(
    binary=_BINARY,
    unary={"-": Operator("-", SIGN), "+": Operator("+", SIGN), "not": Operator("!", SIGN)},
    mixed=(frozenset(("or", "cor", "xor", "and", "cand")), frozenset(("*", "/", "mod"))),
    sign_behind=RELATIONS,
)

_WORDS = shared_words("val3")
# Functions of numbers and texts that differ in the name alone.
FUNCTIONS = spelled(_WORDS.pairs("functions")) | {
    "text_length": "len",
    "from_code": "chr",
    "interpolate_pose": "interpolateL",
}
# Words of a configuration: as at the start, flag 0, flag 1, free.
FLAGS = {
    name: (shown[-1], *shown[:-1]) for name, text in _WORDS.pairs("configuration").items() for shown in (text.split(),)
}
TASKS = spelled(_WORDS.pairs("tasks"))
MESSAGES = spelled(_WORDS.pairs("messages")) | {"state": "putln", "error": "popUpMsg"}
JOINTS = ("j1", "j2", "j3", "j4", "j5", "j6")
TYPES = {
    "IntType": "num", "RealType": "num", "BoolType": "bool", "StringType": "string", "PoseType": "trsf",
    "TargetType": "pointRx", "JointsType": "jointRx",
}  # fmt: skip
