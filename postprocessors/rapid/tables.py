"""RAPID's vocabulary for writing: types, components, operators, reserved words, predefined speeds and zones."""

from __future__ import annotations

from rpl import ir
from rpl.writing.precedence import Operator, OperatorTable


def words(text: str) -> frozenset[str]:
    """The words of a list."""
    return frozenset(text.split())


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

# Predefined buttons of a message box: the keys they show, and the number that each gives.
BUTTONS: dict[str, tuple[tuple[str, int], ...]] = {
    "btnAbrtRtryIgn": (("Abort", 2), ("Retry", 3), ("Ignore", 4)),
    "btnOKCancel": (("OK", 1), ("Cancel", 5)),
    "btnRetryCancel": (("Retry", 3), ("Cancel", 5)),
    "btnYesNo": (("Yes", 6), ("No", 7)),
    "btnYesNoCancel": (("Yes", 6), ("No", 7), ("Cancel", 5)),
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
SIGNAL_NAMES = {
    "digital_in": "signaldi",
    "digital_out": "signaldo",
    "analog_in": "signalai",
    "analog_out": "signalao",
    "group_in": "signalgi",
    "group_out": "signalgo",
}

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
    mixed=(frozenset(_BINARY),),
)
# BitAnd and its kin take bytes only, so operations on whole numbers are not among them.
OPERATORS = frozenset((*_BINARY, ":", "**", "not"))

RESERVED = words(
    """alias and backward case connect const default div do else elseif endfor endfunc endif endmodule endproc
    endrecord endtest endtrap endwhile error exit false for from func goto if inout local mod module nostepin not
    noview or pers proc raise readonly record retry return step sysmodule task test then to trap true trynext undo
    var viewonly while with xor"""
)

_SPEEDS = (5, 10, 20, 30, 40, 50, 60, 80, 100, 150, 200, 300, 400, 500, 600, 800)
_FAST = (1000, 1500, 2000, 2500, 3000, 4000, 5000, 6000, 7000)
# The values of speeddata and zonedata that have a predefined name.
SPEED_NAMES: dict[tuple[float, ...], str] = {
    (float(path), 500.0, 5000.0, 1000.0): f"v{path}" for path in (*_SPEEDS, *_FAST)
}
_ZONES = {
    "z0": (0.3, 0.3, 0.3, 0.03, 0.3, 0.03),
    "z1": (1, 1, 1, 0.1, 1, 0.1),
    "z5": (5, 8, 8, 0.8, 8, 0.8),
    "z10": (10, 15, 15, 1.5, 15, 1.5),
    "z15": (15, 23, 23, 2.3, 23, 2.3),
    "z20": (20, 30, 30, 3, 30, 3),
    "z30": (30, 45, 45, 4.5, 45, 4.5),
    "z40": (40, 60, 60, 6, 60, 6),
    "z50": (50, 75, 75, 7.5, 75, 7.5),
    "z60": (60, 90, 90, 9, 90, 9),
    "z80": (80, 120, 120, 12, 120, 12),
    "z100": (100, 150, 150, 15, 150, 15),
    "z150": (150, 225, 225, 23, 225, 23),
    "z200": (200, 300, 300, 30, 300, 30),
}
ZONE_NAMES: dict[tuple[float, ...], str] = {
    (0.0, *(float(size) for size in sizes)): name for name, sizes in _ZONES.items()
}
