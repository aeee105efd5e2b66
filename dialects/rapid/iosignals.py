"""The I/O configuration of a controller (EIO.cfg of a backup): what numbers of analogue signals stand for.

Technical reference, system parameters, topic I/O System, type Signal: -MaxLog and -MinLog are the values that programs
use where the signal has -MaxPhys and -MinPhys. Between them it is linear. The file says no unit. M: up to 10 it is
volts, up to 20 without a sign milliamperes; where both logical values are the same, programs use the physical ones.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from rpl import ir
from rpl.ir.analog import MILLIAMPERES, VOLTS, AnalogPorts, AnalogRange

ATTRIBUTE = "analog signal"
_HEADER = re.compile(r"[\s\ufeff]*(?:EIO|MMC|MOC|PROC|SIO|SYS):CFG_\d", re.IGNORECASE)
_SECTION = re.compile(r"^(\w+):[ \t]*\r?$", re.MULTILINE)
_CONTINUED = re.compile(r"\\[ \t]*\r?\n")
_VALUE = re.compile(r'-(\w+)[ \t]+(?:"([^"\n]*)"|([^\s"]+))')
_KINDS = {"ai": "analog_in", "ao": "analog_out"}
_MOST_VOLTS, _MOST_MILLIAMPERES = 10.0, 20.0


def is_configuration(text: str) -> bool:
    """Is the text a part of the controller's configuration (SYSPAR of a backup)?"""
    return _HEADER.match(text) is not None


def signals_of(text: str) -> Iterator[dict[str, str]]:
    """What the configuration says of each signal: its parameters by their names in small letters."""
    for at in _SECTION.finditer(text):
        if at[1].upper() != "EIO_SIGNAL":
            continue
        following = _SECTION.search(text, at.end())
        section = text[at.end() : following.start() if following else len(text)]
        for line in _CONTINUED.sub(" ", section).splitlines():
            values = {key.lower(): quoted or plain for key, quoted, plain in _VALUE.findall(line)}
            if values:
                yield values


def ranges(text: str) -> Iterator[AnalogPorts]:
    """The analogue signals of a configuration whose range it says."""
    for values in signals_of(text):
        kind = _KINDS.get(values.get("signaltype", "").lower())
        found = _range(values) if kind and values.get("name") else None
        if kind and found is not None:
            yield AnalogPorts(kind, found, name=values["name"])


def _range(values: dict[str, str]) -> AnalogRange | None:
    """None: the configuration does not say it, or in a unit that is not known."""
    numbers = [_number(values.get(key, "0")) for key in ("minlog", "maxlog", "minphys", "maxphys")]
    low, high, least, most = numbers
    if least is None or most is None or low is None or high is None or least == most:
        return None
    if low == high:
        low, high = least, most
    if max(abs(least), abs(most)) <= _MOST_VOLTS:
        return AnalogRange((low, high), (least, most), VOLTS)
    if least >= 0.0 and most <= _MOST_MILLIAMPERES:
        return AnalogRange((low, high), (least, most), MILLIAMPERES)
    return None


def _number(text: str) -> float | None:
    try:
        value = float(text)
    except ValueError:
        return None
    return value if abs(value) < 1e9 else None


def attribute(ports: AnalogPorts) -> tuple[str, str]:
    """How a module keeps it."""
    found = ports.range
    assert found is not None  # only ranges that are known are kept
    numbers = " ".join(repr(value) for value in (*found.numbers, *found.levels))
    return ATTRIBUTE, f"{ports.kind} {ports.name} {numbers} {found.unit}"


def said(program: ir.Program) -> tuple[AnalogPorts, ...]:
    """The ranges that the modules of a program keep."""
    kept = (value.split() for module in program.modules for name, value in module.attributes if name == ATTRIBUTE)
    return tuple(
        AnalogPorts(kind, AnalogRange((float(a), float(b)), (float(c), float(d)), unit), name=name)
        for kind, name, a, b, c, d, unit in kept
    )


__all__ = ["ATTRIBUTE", "attribute", "is_configuration", "ranges", "said"]
