"""The vocabulary of RPL, the text of the IR: which word stands for which node part.

One table each, used in both directions by the reader and by the printer, so that they cannot drift apart. The keywords
of statements stand in grammars/rpl.lark.
"""

from __future__ import annotations

import re

from rpl.ir.builtins import FUNCTIONS, PROCEDURES
from rpl.ir.expressions import UNITS
from rpl.ir.types import (
    AxesType,
    BoolType,
    CharType,
    ClockType,
    ExternalType,
    InterruptType,
    IntType,
    JointsType,
    LoadType,
    PoseType,
    RealType,
    RotationType,
    SpeedType,
    StringType,
    ToolType,
    TriggerType,
    Type,
    VectorType,
    WorkObjectType,
    ZoneType,
)

NATIVE = "rpl"

SIGNAL_WORDS: dict[str, str] = {
    "di": "digital_in",
    "do": "digital_out",
    "ai": "analog_in",
    "ao": "analog_out",
    "gi": "group_in",
    "go": "group_out",
    "flag": "flag",
}
CONVERSION_WORDS: dict[str, str] = {
    "to_real": "real",
    "to_nearest": "round_half_away",
    "to_int": "trunc",
    "to_bit": "bit",
    "to_bool": "truth",
    "to_code": "code",
    "to_char": "char",
    "to_minus_bit": "minus_bit",
    "to_floor": "floor",
}
PRESENT_WORD = "present"
# Words that mean something else than a user's function when they stand before an opening bracket.
# A built-in procedure gives a result too, so its name is one of these words.
FUNCTION_WORDS = frozenset((*FUNCTIONS, *PROCEDURES, *CONVERSION_WORDS, *SIGNAL_WORDS, PRESENT_WORD))
PROCEDURE_WORDS = frozenset(PROCEDURES)
UNIT_WORDS: dict[str, str] = {**{unit: unit for unit in UNITS if unit != "percent"}, "%": "percent"}

TYPE_WORDS: dict[str, Type] = {
    "int": IntType(),
    "real": RealType(),
    "bool": BoolType(),
    "char": CharType(),
    "string": StringType(),
    "vector": VectorType(),
    "rotation": RotationType(),
    "pose": PoseType(),
    "external": ExternalType(),
    "axes": AxesType(),
    "joints": JointsType(),
    "tool": ToolType(),
    "workobject": WorkObjectType(),
    "load": LoadType(),
    "speed": SpeedType(),
    "zone": ZoneType(),
    "clock": ClockType(),
    "interrupt": InterruptType(),
    "trigger": TriggerType(),
}
# Types that carry the notation of a controller: `target.krl`; without one it is RPL's own.
NOTED_TYPE_WORDS = ("target", "configuration")

SCOPE_WORDS: dict[str, str] = {"routine": "routine", "local": "module", "task": "task", "global": "global"}
STORAGE_WORDS: dict[str, str] = {"const": "constant", "var": "variable", "persistent": "persistent"}
RELATIVE_WORDS: dict[str, str] = {"in base": "base", "in tool": "tool", "in joints": "joints"}
HALT_WORDS: dict[str, str] = {"": "stop", "exit": "exit", "cycle": "cycle"}

# Keywords that cannot stand bare as a name at every place; a name like that is written in backticks.
_RESERVED = """
    affix alias arm array ask at attribute backward begin bnot by call case close connect const continue default else
    entry enum errors exit external false for frame function global goto gripper halt if init label local loop message
    module move next not nothing off on opaque open percent persistent plain procedure pulse raise record repeat retry
    return rotation routine set signal spline switch task then trap true undo unfix unread until var vendor wait while
"""
RESERVED = frozenset(_RESERVED.split())

_BARE = re.compile(r"[^\W\d]\w*")
_ESCAPES = {"\n": "\\n", "\r": "\\r", "\t": "\\t", "\\": "\\\\"}
_UNESCAPES = {"n": "\n", "r": "\r", "t": "\t"}
_ESCAPED = re.compile(r"\\(?:u([0-9A-Fa-f]{4})|U([0-9A-Fa-f]{8})|(.))", re.DOTALL)


def is_bare(name: str) -> bool:
    """Can the name be written without backticks (apart from words that are reserved)?"""
    return _BARE.fullmatch(name) is not None


def enclose(text: str, quote: str) -> str:
    """The text between quote signs, with every sign that could not be read back escaped."""
    return quote + "".join(_escaped(sign, quote) for sign in text) + quote


def _escaped(sign: str, quote: str) -> str:
    if sign == quote:
        return "\\" + sign
    if sign in _ESCAPES:
        return _ESCAPES[sign]
    if sign.isprintable():
        return sign
    return f"\\u{ord(sign):04x}" if ord(sign) < 0x10000 else f"\\U{ord(sign):08x}"


def disclose(text: str) -> str:
    """What stands between the quotes of a written text or name."""
    inner = text[1:-1]
    return _ESCAPED.sub(_unescaped, inner) if "\\" in inner else inner


def _unescaped(match: re.Match[str]) -> str:
    code = match[1] or match[2]
    if code:
        number = int(code, 16)
        return chr(number) if number < 0x110000 else "\ufffd"
    return _UNESCAPES.get(match[3], match[3])
