"""What the programs of one file share, and what prints the parts of a body needs of the printer of the whole body.

Stated here, below all of them, so that none of their files leads back to itself.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.source import Origin
from rpl.writing.ledger import EmissionLedger
from rpl.writing.statements import CannotSayError
from rpl.writing.target import LeftAlone
from rpl.writing.templates import Macros

from . import tables
from .expressions import Expressions
from .facts.tasks import is_later
from .motion import Motion, MotionFacts
from .reactions import Reactions


@dataclass(slots=True)
class Output:
    """What all programs of one file share. `tasks`: number of each program that runs beside the main one."""

    ledger: EmissionLedger
    diagnostics: Diagnostics
    facts: MotionFacts
    reactions: Reactions
    taken: set[str]
    say: Macros
    left_alone: LeftAlone
    tasks: dict[str, int] = field(default_factory=dict)
    helpers: set[str] = field(default_factory=set)
    pulses: list[ir.Signal] = field(default_factory=list)

    def helper_task(self, signal: ir.Signal) -> int:
        """The task that ends the pulses of a signal."""
        if signal not in self.pulses:
            self.pulses.append(signal)
        number = tables.TASKS - self.pulses.index(signal)
        if number <= sum(not is_later(name) for name in self.tasks):
            raise CannotSayError(f"pulses need tasks of their own, and there are {tables.TASKS}")
        return number


class BodyPrinter(Protocol):
    """Prints the body of one program."""

    expressions: Expressions
    output: Output
    diagnostics: Diagnostics
    motion: Motion
    depth: int

    def line(self, text: str, origin: Origin | None = None, shown: str = "") -> None:
        """One step (`shown`: as a macro of its own says it), with the comments that belong to its statement."""
        ...

    def comments_only(self, origin: Origin) -> None:
        """The remarks of a statement that has no line of its own."""
        ...

    def comments_only_before(self, origin: Origin) -> None:
        """Those of its remarks that stand in front of it."""
        ...

    def stands(self) -> bool:
        """Does the robot stand for certain when the last line has been executed?"""
        ...

    def condition(self, expression: ir.Expression, again: bool = False) -> str:
        """A truth value; `again`: it is looked at more than once."""
        ...
