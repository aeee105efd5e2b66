"""The general purpose registers: by which signals of a running program they are seen.

RTDE guide: 128 bits (64 to 127 by themselves, the first 64 in two words), 48 integers, 48 reals, in each direction. The
lower half of each belongs to the field bus, the upper one to external clients; both are served alike here.
"""

from __future__ import annotations

from dataclasses import dataclass

from rpl.controllers.virtual.cabinet import Cabinet
from rpl.registry import words

INPUT, OUTPUT = "input", "output"
_COUNT = 48
_FIRST = {kind: words("urscript").numbers(f"first_{kind}") for kind in ("digital", "analog")}
_BITS = int(_FIRST["digital"]["boolean"])
_REALS = int(_FIRST["analog"]["float"])


@dataclass(frozen=True, slots=True)
class Register:
    """`type`: of RTDE. `names`: of the signals that it is: the bits of a word, or the two names of an integer, which is
    numbered in programs that work out its number."""

    type: str
    names: tuple[str, ...]

    def value(self, cabinet: Cabinet) -> int | float | bool:
        if len(self.names) > 2:  # a word of bits
            return sum(bool(cabinet.signal(name)) << place for place, name in enumerate(self.names))
        found = next((value for name in self.names if (value := cabinet.signal(name)) is not None), 0)
        number = found if isinstance(found, (int, float)) else 0
        return float(number) if self.type == "DOUBLE" else bool(number) if self.type == "BOOL" else int(number)

    def signals(self, value: int | float | bool) -> dict[str, int | float | bool]:
        """What to set for this value."""
        if len(self.names) > 2:
            return {name: bool(int(value) >> place & 1) for place, name in enumerate(self.names)}
        return dict.fromkeys(self.names, value)


def _of(direction: str) -> dict[str, Register]:
    way = direction.removesuffix("put")
    found = {
        f"{direction}_bit_registers{first}_to_{first + 31}": Register(
            "UINT32", tuple(f"d{way[0]}{_BITS + first + bit}" for bit in range(32))
        )
        for first in (0, 32)
    }
    for number in range(64, 128):
        found[f"{direction}_bit_register_{number}"] = Register("BOOL", (f"d{way[0]}{_BITS + number}",))
    for number in range(_COUNT):
        found[f"{direction}_int_register_{number}"] = Register(
            "INT32", (f"{direction}_integer_register_{number}", f"g{way[0]}{number + 1}")
        )
        found[f"{direction}_double_register_{number}"] = Register("DOUBLE", (f"a{way[0]}{_REALS + number}",))
    return found


REGISTERS = {direction: _of(direction) for direction in (INPUT, OUTPUT)}
