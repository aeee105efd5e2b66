"""ABB RAPID (IRC5, RobotWare 5 to 7): the record that the registry finds. Heavy modules load when asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpl.registry import Dialect

if TYPE_CHECKING:
    from rpl.ir import Program
    from rpl.ir.analog import AnalogPorts


def _recognise(path: str, text: str) -> int:
    from .recognise import recognise

    return recognise(path, text)


def _analog_said(program: Program) -> tuple[AnalogPorts, ...]:
    from .iosignals import said

    return said(program)


DIALECT = Dialect(
    __name__,
    "ABB RAPID",
    (".mod", ".sys", ".prg", ".modx", ".sysx"),
    _recognise,
    notation_fields=("cf1", "cf4", "cf6", "cfx"),
    aliases=("abb",),
    analog_said=_analog_said,
    reader="reader",
)
