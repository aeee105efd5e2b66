"""What the machine asks of a linked program. rpl.linking makes one; the runtime itself knows no compiler."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rpl.emulator.configuration import Notation
    from rpl.ir.analog import AnalogRange, AnalogSetting
    from rpl.runtime.code import Code, Values
    from rpl.runtime.values import SignalRef


class Linked(Protocol):
    """A program ready to run."""

    def initialise(self, values: Values, machine: Any) -> None:
        """Fill the global data with first values."""

    def codes(self) -> Iterator[tuple[int, Code]]:
        """The code of each routine of the program (by its number in the program's order) and of the actions in it."""

    def variable_slot(self, name: str) -> int | None:
        """The place of a global variable."""

    def languages(self) -> tuple[str, ...]:
        """The dialects of the program's modules, each once."""

    @property
    def assumes(self) -> bool:
        """Does data without a value get one where it is read?"""

    @property
    def signals_named(self) -> int:
        """How many names of signals are known by now: those of a routine are when it is linked."""

    def alias(self, name: str) -> SignalRef | None:
        """The physical signal behind a declared name."""

    def alias_names(self, port: SignalRef) -> tuple[str, ...]:
        """The declared names of a physical signal."""

    def signal_name(self, dialect: str, kind: str, number: int) -> str:
        """How the dialect spells a numbered signal."""

    def analog_range(
        self, dialect: str, settings: Sequence[AnalogSetting], port: SignalRef, names: Sequence[str]
    ) -> AnalogRange | None:
        """What the numbers of an analogue signal stand for; None where only its controller's configuration knows it."""

    def notation(self, dialect: str) -> Notation | None:
        """The dialect's arm configuration flags."""
