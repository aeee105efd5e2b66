"""What `get_standard_analog_out` tells: amperes or volts (script manual), though the output is set as a share of its
range. Which of both `set_analog_outputdomain` says; without it the installation does, which no program shows.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.analog import MILLIAMPERES, AnalogPorts, AnalogRange
from rpl.ir.walk import walk

from . import nodes
from .nodes import Expr
from .rules import FIRST_SIGNAL
from .scopes import Project, calls_inside, own_expressions, statements

if TYPE_CHECKING:
    from .calls import Calls

NO_DOMAIN = code(
    "urscript-analog-domain",
    Severity.WARNING,
    "whether {name} tells amperes or volts is said by the installation alone; it is read as the share that was set",
    "say it in the program with set_analog_outputdomain",
)
_SETTER = "set_analog_outputdomain"
CURRENT, VOLTAGE = 0, 1  # what the setter's second argument says
# Level of a share s of the range: least + s * span, in A (4 to 20 mA) and V (0 to 10 V).
RANGES: Final = {CURRENT: (0.004, 0.016), VOLTAGE: (0.0, 10.0)}


def domains(project: Project) -> dict[int | None, set[int | None]]:
    """What the project says of each output; None is a number that is computed."""
    found: dict[int | None, set[int | None]] = {}
    for function in project.functions():
        for node in statements(function.node.body):
            for expression in own_expressions(node):
                for call in calls_inside(expression):
                    if call.base is None and call.name == _SETTER and len(call.arguments) == 2:
                        port, domain = (_number(value) for _, value in call.arguments)
                        found.setdefault(port, set()).add(domain)
    return found


def _number(value: Expr) -> int | None:
    return value.value if isinstance(value, nodes.Number) and isinstance(value.value, int) else None


def level(calls: Calls, name: str, group: str, port: Expr | None) -> ir.Expression | None:
    """The level of an output; None where the program changes what it tells."""
    signal = calls.signal(group, "out", port)
    known = domains(calls.project)
    if not known:
        calls.diagnostics.report(NO_DOMAIN, calls.origin, name=name)
        return signal
    number = _number(port) if port is not None else None
    said = set(known.get(None, set()))
    for each, kinds in known.items():
        if number is None or each == number:
            said |= kinds
    if not said:
        calls.diagnostics.report(NO_DOMAIN, calls.origin, name=name)
        return signal
    domain = next(iter(said))
    if len(said) > 1 or domain not in RANGES:
        return None
    least, span = RANGES[domain]
    level = ir.Binary("*", signal, ir.RealLiteral(span))
    return level if least == 0.0 else ir.Binary("+", level, ir.RealLiteral(least))


_SAID = re.compile(r"(set_analog_outputdomain|set_(?:standard|tool)_analog_input_domain)\(\s*(\d+)\s*,\s*([01])\s*\)")
_OUTPUT = {
    CURRENT: AnalogRange((0.0, 1.0), (4.0, 20.0), MILLIAMPERES),
    VOLTAGE: AnalogRange((0.0, 1.0), (0.0, 10.0)),
}
_INPUT = {CURRENT: AnalogRange((0.0, 1.0), (0.0, 1000.0), MILLIAMPERES), VOLTAGE: AnalogRange((0.0, 1.0), (0.0, 1.0))}


def said(program: ir.Program) -> tuple[AnalogPorts, ...]:
    """The ranges of the signals whose domain the program sets; none of those that it sets to both."""
    found: dict[tuple[str, int], set[AnalogRange]] = {}
    for node in walk(*program.modules):
        call = _SAID.fullmatch(node.text.strip()) if isinstance(node, ir.Vendor) else None
        if call is not None:
            port, domain, output = int(call[2]), int(call[3]), call[1] == _SETTER
            first = FIRST_SIGNAL["tool_analog" if "tool" in call[1] else "standard_analog"]
            key = ("analog_out" if output else "analog_in", port + first)
            found.setdefault(key, set()).add((_OUTPUT if output else _INPUT)[domain])
    return tuple(
        AnalogPorts(kind, next(iter(ranges)) if len(ranges) == 1 else None, number, number)
        for (kind, number), ranges in found.items()
    )


__all__ = ["NO_DOMAIN", "level", "said"]
