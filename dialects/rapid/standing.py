"""The signals that a backup of a controller has in its I/O configuration (EIO.cfg).

Signals have names; the number is the place in the map of its device (`-DeviceMap "4"`), where that is one bit. It is
taken only where one device alone has single signals of the kind: else numbers meet.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from rpl.ir.standing import Standing
from rpl.source import Source

from .iosignals import is_configuration, signals_of

_KINDS = {"di": "digital_in", "do": "digital_out"}
_PLACE = re.compile(r"\d{1,4}")


def standing(sources: Sequence[Source]) -> Standing:
    """All files of the backup together."""
    names: dict[str, str] = {}
    found: dict[str, dict[str, dict[int, str]]] = {}
    for source in sources:
        for values in signals_of(source.text) if is_configuration(source.text) else ():
            name = values.get("name", "")
            if name:
                names[name.lower()] = source.path
            kind = _KINDS.get(values.get("signaltype", "").lower())
            place = values.get("devicemap", values.get("unitmap", ""))
            if name and kind and _PLACE.fullmatch(place):
                device = values.get("device", values.get("unit", ""))
                found.setdefault(kind, {}).setdefault(device, {})[int(place)] = name
    signals = {
        (kind, number): name
        for kind, devices in found.items()
        if len(devices) == 1
        for number, name in next(iter(devices.values())).items()
    }
    return Standing(names, signals=signals)
