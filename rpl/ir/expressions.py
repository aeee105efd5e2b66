"""Expressions of the IR.

Two spellings of one meaning share a node; two meanings never do: `/` is real division, `div` truncates toward zero,
`quo` divides by the operands' types (KRL) and is resolved by passes.typing; `and`/`or` evaluate both sides,
`cand`/`cor` stop at the first that decides.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from rpl.ir.types import Type
from rpl.source import NOWHERE, Origin


@dataclass(frozen=True, slots=True)
class IntLiteral:
    """`spelling` is the source's own way of writing it ('B1011', 0x1F, 12e3); empty means plain decimal."""

    value: int
    spelling: str = field(default="", compare=False)
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class RealLiteral:
    value: float
    spelling: str = field(default="", compare=False)
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class BoolLiteral:
    value: bool
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class TextLiteral:
    value: str
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class EnumLiteral:
    """A member of an enumeration (KRL `#NAME`)."""

    member: str
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Name:
    """A variable, constant, parameter or signal by its name as written."""

    id: str
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Index:
    base: Expression
    indices: tuple[Expression, ...]
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Field:
    """Component of a record or of a built-in type. After passes.typing built-in components have neutral names."""

    base: Expression
    name: str
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Unary:
    """op: one of UNARY_OPERATORS."""

    op: str
    operand: Expression
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Binary:
    """op: one of BINARY_OPERATORS."""

    op: str
    left: Expression
    right: Expression
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Argument:
    """One actual argument. `value` None with no name: left out (KRL `f(1,,2)`); a RAPID switch `\\On` has name and
    value None. `if_present`: pass it on only when that optional parameter is present (RAPID `\\x?y`)."""

    value: Expression | None
    name: str | None = None
    if_present: str | None = None


@dataclass(frozen=True, slots=True)
class Call:
    """Call of a user's function by name."""

    name: str
    arguments: tuple[Argument, ...]
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Builtin:
    """A neutral built-in function (see ir.builtins for names, parameters and meaning)."""

    function: str
    arguments: tuple[Expression, ...]
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Aggregate:
    """Structured value: named entries (`{X 1,Y 2}`) or positional (name None, `[1,2]`). `type_name` is the written
    type prefix; after passes.typing it is the type the context gives (printed by types.type_text)."""

    entries: tuple[tuple[str | None, Expression], ...]
    type_name: str | None = None
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class System:
    """A neutral system variable (see ir.builtins.SYSTEM_VARIABLES), such as `tool`, `path_speed`, `timer`."""

    name: str
    indices: tuple[Expression, ...] = ()
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Signal:
    """A physical signal: by number (`index`, and `last` for a group of bits) or by name. Digital signals are BOOL."""

    kind: str
    index: Expression | None = None
    last: Expression | None = None
    name: str | None = None
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Quantity:
    """A number with its unit: the value in base units (mm, s, deg and their quotients) is `value * UNITS[unit]`."""

    value: Expression
    unit: str
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Magnitude:
    """The inverse of Quantity: a quantity read as a plain number of `unit`."""

    value: Expression
    unit: str
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Convert:
    """Explicit conversion, one of CONVERSIONS; inserted by passes.typing where the source language converts."""

    how: str
    operand: Expression
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Present:
    """Is the optional parameter given? (RAPID Present, KRL VARSTATE of a parameter)"""

    name: str
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class VendorValue:
    """A value only one controller can give. A run stops there unless the cell file says what it is."""

    dialect: str
    text: str
    type: Type
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


Expression = (
    IntLiteral
    | RealLiteral
    | BoolLiteral
    | TextLiteral
    | EnumLiteral
    | Name
    | Index
    | Field
    | Unary
    | Binary
    | Call
    | Builtin
    | Aggregate
    | System
    | Signal
    | Quantity
    | Magnitude
    | Convert
    | Present
    | VendorValue
)

UNARY_OPERATORS = ("-", "+", "not", "bnot")
# ':' composes poses left to right; '&' joins texts; '@' is the cross product of vectors.
BINARY_OPERATORS = (
    *("+", "-", "*", "/", "div", "mod", "quo", "**", ":", "&", "@"),
    *("=", "<>", "<", ">", "<=", ">="),
    *("and", "or", "xor", "cand", "cor", "band", "bor", "bxor"),
)
# real: exact widening; round_half_away: KRL real to int; trunc: toward zero; bit: BOOL to 0/1; truth: nonzero to BOOL;
# code: CHAR to its number; char: number to CHAR; minus_bit: BOOL to 0/-1 (V+); floor: the whole number not above.
CONVERSIONS = ("real", "round_half_away", "trunc", "bit", "truth", "code", "char", "minus_bit", "floor")

# Unit name -> factor to the base unit (mm, s, deg, mm/s, mm/s2, deg/s, deg/s2, percent, kg).
UNITS: dict[str, float] = {
    "mm": 1.0,
    "cm": 10.0,
    "m": 1000.0,
    "inch": 25.4,
    "s": 1.0,
    "ms": 0.001,
    "min": 60.0,
    "deg": 1.0,
    "rad": 57.29577951308232,
    "mm/s": 1.0,
    "m/s": 1000.0,
    "cm/min": 10.0 / 60.0,
    "inch/min": 25.4 / 60.0,
    "mm/s2": 1.0,
    "m/s2": 1000.0,
    "deg/s": 1.0,
    "rad/s": 57.29577951308232,
    "deg/s2": 1.0,
    "rad/s2": 57.29577951308232,
    "percent": 1.0,
    "kg": 1.0,
}
