"""Universal Robots URScript: how its files are recognised; the heavy parts are imported when called."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

from rpl.registry import Dialect

if TYPE_CHECKING:
    from rpl.ir import Program
    from rpl.ir.analog import AnalogPorts

_HEADER = re.compile(
    r"^[ \t\ufeff]*(?:def|thread|sec)[ \t]+\w+[ \t]*\([^()\n]*(?:\([^()\n]*\)[^()\n]*)*\)[ \t]*:", re.MULTILINE
)
_END = re.compile(r"^[ \t]*end[ \t]*(?:#.*)?$", re.MULTILINE)
_TYPICAL = re.compile(
    r"^[ \t]*(?:movej|movel|movep|movec|servoj|servoc|speedj|speedl|stopj|stopl|set_tcp|set_payload|set_gravity|textmsg"
    r"|popup|sync|set_(?:standard_|configurable_|tool_)?(?:digital|analog)_out|socket_open|socket_send_\w+"
    r"|modbus_\w+|write_output_\w+_register|rpc_factory)[ \t]*\("
    r"|\bget_(?:standard_|configurable_|tool_)?(?:digital|analog)_in\(|=[ \t]*p\[|\bget_inverse_kin\(|\bpose_trans\("
    r"|^[ \t]*(?:enter_critical|exit_critical|halt)[ \t]*$|^[ \t]*(?:global|local)[ \t]+\w+[ \t]*=(?!=)"
    r"|^[ \t]*\w+[ \t]*=[ \t]*run[ \t]|^[ \t]*\$[ \t]*\d+[ \t]+\"",
    re.MULTILINE,
)
# What other languages with `def ...:` have and URScript has not.
_PYTHON = re.compile(
    r"^[ \t]*(?:import|from|class|with|for|try|except|lambda|async|@\w+)\b.*:?[ \t]*$|\bself\.", re.MULTILINE
)


def _recognise(path: str, text: str) -> int:
    """How sure the content is URScript: headers with their ends, and the names of the controller's functions."""
    head = text[:200_000]
    if _is_saved_program(head):
        return 95
    headers, ends, typical = len(_HEADER.findall(head)), len(_END.findall(head)), len(_TYPICAL.findall(head))
    if len(_PYTHON.findall(head)) > ends:
        return 0
    if headers and ends and typical:
        return 95
    if headers and ends:
        return 80
    code = [line for line in head.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    if typical and typical * 4 >= len(code):
        return 60
    return 35 if typical and Path(path).suffix.lower() in (".script", ".urscript") else 0


def _is_saved_program(text: str) -> bool:
    """A program saved by the teach pendant (.urp, unpacked)."""
    return text.lstrip("\ufeff \t\r\n").startswith(("<URProgram", "<?xml")) and "<URProgram" in text[:2000]


def _companions(path: str) -> tuple[str, ...]:
    """The saved program that a script is of."""
    return (f"{path[:-7]}.urp",) if path.lower().endswith(".script") else ()


def _analog_said(program: Program) -> tuple[AnalogPorts, ...]:
    from .levels import said

    return said(program)


# Neutral numbers of digital and analog signals by the pendant's names: first number, name.
_DIGITAL = ((19, "{}put_boolean_register_{}"), (17, "tool_{}[{}]"), (9, "config_{}[{}]"), (1, "digital_{}[{}]"))
_ANALOG = ((5, "{}put_float_register_{}"), (3, "tool_analog_{}[{}]"), (1, "analog_{}[{}]"))


def _signal_name(kind: str, number: int) -> str:
    """How the teach pendant names a signal: `digital_out[0]`, `config_in[3]`, `tool_out[1]`, `analog_in[0]`."""
    what, _, way = kind.partition("_")
    if what in ("digital", "analog"):
        for first, name in _DIGITAL if what == "digital" else _ANALOG:
            if number >= first:
                return name.format(way, number - first)
    return f"{kind}[{number - 1}]"


DIALECT = Dialect(
    __name__,
    title="Universal Robots URScript",
    extensions=(".script", ".urscript", ".ur", ".urp"),
    recognise=_recognise,
    companions=_companions,
    notation_fields=(),
    signal_name=_signal_name,
    aliases=("ur", "universal robots", "universal-robots"),
    analog_said=_analog_said,
)
