"""How KRL spells the neutral vocabulary: `words.toml` from the writer's side, and what only the writer knows."""

from __future__ import annotations

from rpl.ir import BoolType, IntType, RealType
from rpl.registry import words
from rpl.words import spelled
from rpl.writing.precedence import RELATIONS, Operator, OperatorTable

_WORDS = words("krl")
RESERVED = frozenset(_WORDS.listed("reserved"))

_RELATION, _OR, _EXOR, _AND, _SUM, _PRODUCT, _SIGN, _CHAIN = 20, 30, 40, 50, 60, 70, 80, 90
_BINARY = {
    "=": Operator("==", _RELATION, "none", spaced=False),
    "<>": Operator("<>", _RELATION, "none", spaced=False),
    "<": Operator("<", _RELATION, "none", spaced=False),
    ">": Operator(">", _RELATION, "none", spaced=False),
    "<=": Operator("<=", _RELATION, "none", spaced=False),
    ">=": Operator(">=", _RELATION, "none", spaced=False),
    "or": Operator("OR", _OR),
    "bor": Operator("B_OR", _OR),
    "xor": Operator("EXOR", _EXOR),
    "bxor": Operator("B_EXOR", _EXOR),
    "and": Operator("AND", _AND),
    "band": Operator("B_AND", _AND),
    "+": Operator("+", _SUM, spaced=False),
    "-": Operator("-", _SUM, spaced=False),
    "*": Operator("*", _PRODUCT, spaced=False),
    "/": Operator("/", _PRODUCT, spaced=False),
    "div": Operator("/", _PRODUCT, spaced=False),
    "quo": Operator("/", _PRODUCT, spaced=False),
    ":": Operator(":", _CHAIN, spaced=False),
}
OPERATORS = OperatorTable(
    binary=_BINARY,
    unary={
        "-": Operator("-", _SIGN),
        "+": Operator("+", _SIGN),
        "not": Operator("NOT", _SIGN),
        "bnot": Operator("B_NOT", _SIGN),
    },
    # Relations bind less tightly than AND and OR, which few expect; products of places are no products of numbers.
    mixed=(
        RELATIONS | {"or", "bor", "xor", "bxor", "and", "band"},
        frozenset(("*", "/", "div", "quo")),
        *(frozenset((":", sign)) for sign in ("+", "-", "*", "/", "div", "quo")),
    ),
    sign_behind=RELATIONS,
)

# The controller's data list, its tables of tools and bases with the names in them, and how many each has.
CONFIG = "$config"
SELECTED = {"tool": "TOOL_DATA", "base": "BASE_DATA"}
NAMES = {"TOOL_DATA": "TOOL_NAME", "BASE_DATA": "BASE_NAME"}
MOST_FRAMES = 32
LONGEST_FRAME_NAME = 24
# What the basis package has for inline forms.
FORM_NAMES = ("BAS", "$BWDSTART", "PDAT_ACT", "LDAT_ACT", "FDAT_ACT", "PDEFAULT", "FHOME", "$H_POS")
FORM_TYPES = ("FDAT", "PDAT", "LDAT")
OWN = frozenset((CONFIG, *(name.lower() for pair in NAMES.items() for name in pair)))
OWN |= frozenset(name.lower() for name in (*FORM_NAMES, *FORM_TYPES))

EXTERNAL_KINEMATICS = ("EASYS", "EBSYS", "ECSYS", "EDSYS", "EESYS", "EFSYS")
COUNTED = frozenset(_WORDS.listed("counted"))
# Structured variables whose components are neutral variables of their own, in KRL's order.
STRUCTURES = {name: tuple(parts.items()) for name, parts in _WORDS.nested("structures").items()}
_UNITS = _WORDS.pairs("units")
_VARIABLES = spelled(_WORDS.pairs("scalars") | _WORDS.pairs("indexed")) | {
    neutral: f"{name}.{part}" for name, parts in STRUCTURES.items() for part, neutral in parts
}
# Neutral system variable -> spelling and the unit that KRL measures it in ("" for the neutral one).
SYSTEM = {neutral: (name, _UNITS.get(neutral, "")) for neutral, name in _VARIABLES.items()}
MODES = {variable: spelled(members) for variable, members in _WORDS.nested("modes").items()}
SIGNALS = _WORDS.pairs("signals")
GROUPS = _WORDS.pairs("groups")

FUNCTIONS = spelled(_WORDS.pairs("functions"))
# A text is read by the function of the variable's type.
PARSERS = {IntType: "StrToInt", RealType: "StrToReal", BoolType: "StrToBool"}
_TEXTS = spelled(_WORDS.pairs("text_procedures"))
PROCEDURES = _TEXTS | {length: _TEXTS[name] for name, length in _WORDS.pairs("text_lengths").items()}
_SHOWN = spelled(_WORDS.pairs("messages"))
MESSAGES = _SHOWN | {"write": _SHOWN["notify"], "error": _SHOWN["quit"]}
# Conversions that KRL makes by itself where the value is stored or compared.
SILENT_CONVERSIONS = frozenset(("real", "round_half_away", "code", "char"))
ATTRIBUTES = frozenset(("ACCESS", "REL", "PARAM", "COMMENT", "USER", "TECHNOLOGY"))
LONGEST_LINE = 474
DEFAULT_TEXT_CAPACITY = 80
# The controller's functions for texts take a CHAR[256] at most (its own declarations of StrToInt and kin).
LONGEST_TEXT = 255
