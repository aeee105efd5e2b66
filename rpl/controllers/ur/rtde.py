"""Real-Time Data Exchange, version 2: how its packages look, for the client and the virtual controller.

Universal Robots' "RTDE Guide" (22229): big endian; u16 size of the whole package, u8 type, payload. A recipe names
variables; data packages hold their values without gaps, behind the recipe's number.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass

VERSION = 2
PROTOCOL, CONTROLLER, MESSAGE, DATA, OUTPUTS, INPUTS, START, PAUSE = b"VvMUOISP"
HEADER = struct.Struct(">HB")
# How each type of the guide is packed.
FORMATS = {
    "BOOL": "?",
    "UINT8": "B",
    "UINT32": "I",
    "UINT64": "Q",
    "INT32": "i",
    "DOUBLE": "d",
    "VECTOR3D": "3d",
    "VECTOR6D": "6d",
    "VECTOR6INT32": "6i",
    "VECTOR6UINT32": "6I",
}
Number = int | float | bool
Value = Number | tuple[Number, ...]


def package(kind: int, payload: bytes = b"") -> bytes:
    return HEADER.pack(HEADER.size + len(payload), kind) + payload


@dataclass(frozen=True, slots=True)
class Recipe:
    """What a data package holds: names and types in their order."""

    number: int
    names: tuple[str, ...]
    types: tuple[str, ...]
    packing: struct.Struct

    def packed(self, values: Sequence[Value]) -> bytes:
        """A data package of these values."""
        flat: list[Number] = [self.number]
        for value in values:
            flat.extend(value) if isinstance(value, tuple) else flat.append(value)
        return package(DATA, self.packing.pack(*flat))

    def unpacked(self, payload: bytes) -> dict[str, Value]:
        """Values by name of a data package's payload. Raises struct.error for one of another length."""
        flat = self.packing.unpack(payload)
        found: dict[str, Value] = {}
        place = 1
        for name, kind in zip(self.names, self.types, strict=True):
            count = 6 if kind.startswith("VECTOR6") else 3 if kind == "VECTOR3D" else 1
            found[name] = flat[place] if count == 1 else tuple(flat[place : place + count])
            place += count
        return found


def recipe(number: int, names: Sequence[str], types: Sequence[str]) -> Recipe:
    """Raises KeyError for a type that there is not (NOT_FOUND, IN_USE)."""
    packing = struct.Struct(">B" + "".join(FORMATS[kind] for kind in types))
    return Recipe(number, tuple(names), tuple(types), packing)
