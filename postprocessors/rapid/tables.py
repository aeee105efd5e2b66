"""RAPID's vocabulary for writing: types, components, operators, reserved words, predefined speeds and zones."""

from __future__ import annotations

from typing import Final

from rpl import ir, registry
from rpl.writing.precedence import RELATIONS, Operator, OperatorTable


def words(text: str) -> frozenset[str]:
    """The words of a list."""
    return frozenset(text.split())


WORDS = registry.words("rapid")

# Neutral system variable -> component of the controller's own data.
SYSTEM_RECORDS: dict[str, str] = {
    "displacement": "C_PROGDISP.pdisp",
    "speed_percent": "C_MOTSET.vel.oride",
    "speed_limit": "C_MOTSET.vel.max",
    "acceleration_percent": "C_MOTSET.acc.acc",
    "acceleration_ramp": "C_MOTSET.acc.ramp",
    "joint_configuration_check": "C_MOTSET.conf.jsup",
    "path_configuration_check": "C_MOTSET.conf.lsup",
}

# The shortest period of ITimer, where it does not come a single time (RAPID reference manual).
SHORTEST_PERIOD_S: Final = 0.1

# Predefined buttons of a message box: the keys they show, and the number that each gives.
_NUMBERS = WORDS.numbers("numbers")
BUTTONS = {
    name: tuple((key, int(_NUMBERS[f"res{key}"])) for key in keys.split())
    for name, keys in WORDS.pairs("buttons").items()
    if " " in keys  # a message with one key asks nothing
}

# IR type class -> type name. Types with parameters (signals, vendor types, references) are named in types.py.
TYPE_NAMES: dict[type, str] = {
    ir.IntType: "num",
    ir.RealType: "num",
    ir.BoolType: "bool",
    ir.StringType: "string",
    ir.VectorType: "pos",
    ir.RotationType: "orient",
    ir.PoseType: "pose",
    ir.ConfigType: "confdata",
    ir.ExternalType: "extjoint",
    ir.AxesType: "robjoint",
    ir.TargetType: "robtarget",
    ir.JointsType: "jointtarget",
    ir.ToolType: "tooldata",
    ir.WorkObjectType: "wobjdata",
    ir.LoadType: "loaddata",
    ir.SpeedType: "speeddata",
    ir.ZoneType: "zonedata",
    ir.ClockType: "clock",
    ir.InterruptType: "intnum",
    ir.TriggerType: "triggdata",
    ir.CharType: "string",
}
SIGNAL_NAMES = WORDS.pairs("signal_types")
PREFIXES = {kind: name.removeprefix("signal") for kind, name in SIGNAL_NAMES.items()}
READERS = {
    "digital_in": "DInput",
    "digital_out": "DOutput",
    "analog_in": "AInput",
    "analog_out": "AOutput",
    "group_in": "GInput",
    "group_out": "GOutput",
}

# Neutral component -> RAPID component, per type class; what is missing has the same name.
COMPONENTS: dict[type, dict[str, str]] = {
    ir.TargetType: {"conf": "robconf", "ext": "extax"},
    ir.JointsType: {"ext": "extax"},
    ir.AxesType: {f"j{index}": f"rax_{index}" for index in range(1, 7)},
    ir.ExternalType: {f"e{index}": f"eax_{letter}" for index, letter in enumerate("abcdef", 1)},
    ir.ToolType: {"held": "robhold", "frame": "tframe", "load": "tload"},
    ir.WorkObjectType: {
        "held": "robhold",
        "fixed": "ufprog",
        "unit": "ufmec",
        "user_frame": "uframe",
        "object_frame": "oframe",
    },
    ir.LoadType: {"axes": "aom"},
    ir.SpeedType: {
        "path": "v_tcp",
        "rotation": "v_ori",
        "linear_external": "v_leax",
        "rotary_external": "v_reax",
    },
    ir.ZoneType: {
        "stop": "finep",
        "path": "pzone_tcp",
        "rotation_path": "pzone_ori",
        "external_path": "pzone_eax",
        "rotation": "zone_ori",
        "linear_external": "zone_leax",
        "rotary_external": "zone_reax",
    },
}
# A component of a component that the neutral name reaches directly: `p.x` is `p.trans.x`.
NESTED: dict[type, dict[str, tuple[str, ...]]] = {
    ir.TargetType: {
        **{name: ("trans", name) for name in ("x", "y", "z")},
        **{name: ("rot", name) for name in ("q1", "q2", "q3", "q4")},
        **{name: ("robconf", name) for name in ("cf1", "cf4", "cf6", "cfx")},
        **{f"e{index}": ("extax", f"eax_{letter}") for index, letter in enumerate("abcdef", 1)},
    },
    ir.PoseType: {
        **{name: ("trans", name) for name in ("x", "y", "z")},
        **{name: ("rot", name) for name in ("q1", "q2", "q3", "q4")},
    },
    ir.JointsType: {
        **{f"j{index}": ("robax", f"rax_{index}") for index in range(1, 7)},
        **{f"e{index}": ("extax", f"eax_{letter}") for index, letter in enumerate("abcdef", 1)},
    },
}

_SUM, _PRODUCT, _RELATION, _AND, OR_LEVEL = 4, 5, 3, 2, 1
RELATION_LEVEL = _RELATION
_BINARY = {
    "*": Operator("*", _PRODUCT, spaced=False),
    "/": Operator("/", _PRODUCT, spaced=False),
    "@": Operator("*", _PRODUCT, spaced=False),
    "div": Operator("DIV", _PRODUCT),
    "mod": Operator("MOD", _PRODUCT),
    "+": Operator("+", _SUM, spaced=False),
    "-": Operator("-", _SUM, spaced=False),
    "&": Operator("+", _SUM, spaced=False),
    **{sign: Operator(sign, _RELATION, "none", spaced=False) for sign in ("=", "<>", "<", ">", "<=", ">=")},
    "cand": Operator("AND", _AND),
    "and": Operator("AND", _AND),
    "cor": Operator("OR", OR_LEVEL),
    "or": Operator("OR", OR_LEVEL),
    "xor": Operator("XOR", OR_LEVEL),
}
OPERATOR_TABLE = OperatorTable(
    _BINARY,
    {"-": Operator("-", _SUM, spaced=False), "+": Operator("+", _SUM, spaced=False)},
    mixed=(RELATIONS | {"cand", "and", "cor", "or", "xor"}, frozenset(("*", "/", "@", "div", "mod"))),
    sign_behind=RELATIONS,
)
# BitAnd and its kin take bytes only, so operations on whole numbers are not among them.
OPERATORS = frozenset((*_BINARY, ":", "**", "not"))

RESERVED = frozenset(word.lower() for word in (*WORDS.listed("reserved"), *WORDS.listed("module_attributes")))
# The values of speeddata and zonedata that have a predefined name.
SPEED_NAMES: dict[tuple[float, ...], str] = {
    (float(path), 500.0, 5000.0, 1000.0): f"v{path}" for path in WORDS.listed("speeds")
}
ZONE_NAMES: dict[tuple[float, ...], str] = {
    (0.0, *map(float, sizes.split())): name for name, sizes in WORDS.pairs("zones").items()
}
