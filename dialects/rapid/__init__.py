"""ABB RAPID (IRC5, RobotWare 5 to 7): the record that the registry finds. Heavy modules load when asked for."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rpl.diagnostics import Diagnostics
from rpl.registry import Dialect, ReadResult
from rpl.source import Source

if TYPE_CHECKING:
    from rpl.emulator.configuration import Notation
    from rpl.ir import Module, Program
    from rpl.ir.analog import AnalogPorts
    from rpl.ir.rules import Rules


def _recognise(path: str, text: str) -> int:
    from .recognise import recognise

    return recognise(path, text)


def _analog_said(program: Program) -> tuple[AnalogPorts, ...]:
    from .iosignals import said

    return said(program)


def _read(sources: Sequence[Source], diagnostics: Diagnostics) -> ReadResult:
    from .reader import read

    return read(sources, diagnostics)


def _rules() -> Rules:
    from .rules import RULES

    return RULES


def _prelude() -> Module:
    from .prelude import prelude

    return prelude()


def _notation() -> Notation:
    from .configuration import NOTATION

    return NOTATION


def _flag_terms(arm: str) -> dict[str, tuple[tuple[int, str, int], ...]]:
    """The quarter turns, and cfx bit by bit."""
    from .configuration import CFX_UNUSED

    cfx = () if arm in CFX_UNUSED else ((4, "behind_axis1", 0), (2, "behind_lower_arm", 0), (1, "wrist_negative", 0))
    return {"cf1": ((1, "quarter", 1),), "cf4": ((1, "quarter", 4),), "cf6": ((1, "quarter", 6),), "cfx": cfx}


DIALECT = Dialect(
    "rapid",
    "ABB RAPID",
    (".mod", ".sys", ".prg", ".modx", ".sysx"),
    _recognise,
    _read,
    _rules,
    _prelude,
    _notation,
    notation_fields=("cf1", "cf4", "cf6", "cfx"),
    flag_terms=_flag_terms,
    aliases=("abb",),
    analog_said=_analog_said,
)
