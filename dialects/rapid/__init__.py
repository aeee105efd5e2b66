"""ABB RAPID (IRC5, RobotWare 5 to 7): the record that the registry finds. Heavy modules load when asked for."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rpl.diagnostics import Diagnostics
from rpl.registry import Dialect, ReadResult
from rpl.source import Source

if TYPE_CHECKING:
    from rpl.checks.loading import Loader
    from rpl.emulator.configuration import Notation
    from rpl.ir import Module, Program
    from rpl.ir.analog import AnalogPorts
    from rpl.ir.rules import Rules
    from rpl.ir.standing import Standing


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


def _standing(sources: Sequence[Source]) -> Standing:
    from .standing import standing

    return standing(sources)


def _loading() -> Loader:
    from .loading import LOADER

    return LOADER


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
    aliases=("abb",),
    analog_said=_analog_said,
    loading=_loading,
    standing=_standing,
)
