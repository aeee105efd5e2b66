"""URScript as it is written: expressions and statements before their types are known.

The language declares nothing; what a name is follows from the whole project. So reading has two steps: statements
become these nodes, and when all are there, `infer` finds the types and `statements` writes the IR.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from rpl import ir
from rpl.source import NOWHERE, Origin


@dataclass(frozen=True, slots=True)
class Number:
    value: float | int
    spelling: str


@dataclass(frozen=True, slots=True)
class Text:
    value: str


@dataclass(frozen=True, slots=True)
class Truth:
    value: bool


@dataclass(frozen=True, slots=True)
class Var:
    name: str


@dataclass(frozen=True, slots=True)
class At:
    """An element: of a list, of a pose, of a matrix (several indices), of a structure."""

    base: Expr
    indices: tuple[Expr, ...]


@dataclass(frozen=True, slots=True)
class Member:
    base: Expr
    name: str


@dataclass(frozen=True, slots=True)
class Sign:
    """op: - + not"""

    op: str
    operand: Expr


@dataclass(frozen=True, slots=True)
class Operation:
    """op: or xor and == != < > <= >= + - * / % ^"""

    op: str
    left: Expr
    right: Expr


@dataclass(frozen=True, slots=True)
class Apply:
    """A call; `base` is the handle of a method call (`camera.read(1)`)."""

    name: str
    arguments: tuple[tuple[str | None, Expr], ...]
    base: Expr | None = None


@dataclass(frozen=True, slots=True)
class PoseOf:
    """`p[x, y, z, rx, ry, rz]`"""

    items: tuple[Expr, ...]


@dataclass(frozen=True, slots=True)
class ListOf:
    items: tuple[Expr, ...]


@dataclass(frozen=True, slots=True)
class Run:
    """`run thread()`: starts it; the value is its handle."""

    call: Expr


@dataclass(frozen=True, slots=True)
class Hole:
    """A place that a generator has still to fill: `{{PORT}}`, `$$SPEED$$`, or nothing at all."""

    text: str


Expr = Number | Text | Truth | Var | At | Member | Sign | Operation | Apply | PoseOf | ListOf | Run | Hole


@dataclass(frozen=True, slots=True)
class Store:
    """`target = value`; scope: global, local or empty."""

    scope: str
    target: Expr
    value: Expr
    origin: Origin


@dataclass(frozen=True, slots=True)
class Declare:
    """`global x` or `local x` without a value."""

    scope: str
    name: str
    origin: Origin


@dataclass(frozen=True, slots=True)
class Perform:
    """An expression as a statement: a call."""

    call: Expr
    origin: Origin


@dataclass(frozen=True, slots=True)
class Branches:
    branches: tuple[tuple[Expr, Block], ...]
    otherwise: Block
    origin: Origin


@dataclass(frozen=True, slots=True)
class Repeat:
    """while"""

    condition: Expr
    body: Block
    origin: Origin


@dataclass(frozen=True, slots=True)
class Give:
    """return"""

    value: Expr | None
    origin: Origin


@dataclass(frozen=True, slots=True)
class Word:
    """A statement of one word: break continue halt pass enter_critical exit_critical."""

    word: str
    origin: Origin


@dataclass(frozen=True, slots=True)
class Thread:
    """op: join kill"""

    op: str
    handle: Expr
    origin: Origin


@dataclass(frozen=True, slots=True)
class Template:
    """A line of a template language (`{% if ... %}`) or a placeholder in the place of statements."""

    text: str
    origin: Origin


@dataclass(frozen=True, slots=True)
class Define:
    """kind: def, sec, thread. parameters: name and default."""

    kind: str
    name: str
    parameters: tuple[tuple[str, Expr | None], ...]
    body: Block
    origin: Origin
    end: Origin = field(default=NOWHERE)


Node = Store | Declare | Perform | Branches | Repeat | Give | Word | Thread | Template | Define | ir.Nothing | ir.Opaque
Block = tuple[Node, ...]


def shown(expression: Expr) -> str:
    """The expression as URScript text."""
    match expression:
        case Number(spelling=spelling):
            return spelling
        case Text(value=value):
            return f'"{value}"'
        case Truth(value=value):
            return "True" if value else "False"
        case Var(name=name):
            return name
        case At(base=base, indices=indices):
            return f"{shown(base)}[{_listed(indices)}]"
        case Member(base=base, name=name):
            return f"{shown(base)}.{name}"
        case Sign(op=op, operand=operand):
            return f"not {_inner(operand)}" if op == "not" else f"{op}{_inner(operand)}"
        case Operation(op=op, left=left, right=right):
            return f"{_inner(left)} {op} {_inner(right)}"
        case Apply(name=name, arguments=arguments, base=base):
            words = ", ".join(shown(value) if key is None else f"{key}={shown(value)}" for key, value in arguments)
            return f"{shown(base)}.{name}({words})" if base is not None else f"{name}({words})"
        case PoseOf(items=items):
            return f"p[{_listed(items)}]"
        case ListOf(items=items):
            return f"[{_listed(items)}]"
        case Run(call=call):
            return f"run {shown(call)}"
    return expression.text


def _inner(expression: Expr) -> str:
    text = shown(expression)
    return f"({text})" if isinstance(expression, Operation) else text


def _listed(items: tuple[Expr, ...]) -> str:
    return ", ".join(shown(item) for item in items)


def parts(expression: Expr) -> tuple[Expr, ...]:
    """The expressions directly inside."""
    match expression:
        case At(base=base, indices=indices):
            return (base, *indices)
        case Member(base=base):
            return (base,)
        case Sign(operand=operand):
            return (operand,)
        case Operation(left=left, right=right):
            return (left, right)
        case Apply(arguments=arguments, base=base):
            inner = tuple(value for _, value in arguments)
            return (base, *inner) if base is not None else inner
        case PoseOf(items=items) | ListOf(items=items):
            return items
        case Run(call=call):
            return (call,)
    return ()
