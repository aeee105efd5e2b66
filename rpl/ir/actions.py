"""The statements that other statements may carry: triggers and interrupts act by an assignment or a call."""

from __future__ import annotations

from dataclasses import dataclass, field

from rpl.ir.expressions import Argument, Expression
from rpl.source import NOWHERE, Origin


@dataclass(frozen=True, slots=True)
class Assign:
    """`target` is a Name, Index, Field, System or Signal. Assigning a Signal switches the output."""

    target: Expression
    value: Expression
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class CallRoutine:
    """Call of a procedure. With `dynamic`, the name is the text that this expression gives (RAPID `%name%`)."""

    name: str
    arguments: tuple[Argument, ...] = ()
    dynamic: Expression | None = None
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Vendor:
    """A statement only one controller has. effect: none, tuning, message, time, unknown. `tuning` concerns only how
    its controller drives or watches itself (payload, collision guard), not what the program does. An unknown effect
    stops a run unless the cell file says what it stands for."""

    dialect: str
    text: str
    effect: str
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Opaque:
    """Text that could not be read; reported where it was met. A run stops on it."""

    text: str
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Nothing:
    """Carries comments (origin.comments) that stand before no statement, and layout lines such as folds."""

    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)
