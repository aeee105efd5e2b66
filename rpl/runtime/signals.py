"""Physical signals: one value per signal, whatever the program calls it.

A numbered bit is one signal under its number, its alias and as part of a group of bits. A named signal stands for
itself; a name made of a usual word and a number (`di3`, `$IN[3]`) is also found under that kind and number, so that one
description of a cell serves a program and its translation.
"""

from __future__ import annotations

import re

from rpl.runtime.faults import ProgramError
from rpl.runtime.values import SignalRef, Value, whole

Key = tuple[str, int] | str

# How people name signals by number, whatever the language: word -> kind.
_WORDS = {
    "digital_out": ("out", "ot", "do", "dout", "output", "digitalout", "digout"),
    "digital_in": ("in", "di", "din", "input", "digitalin", "digin"),
    "analog_out": ("ao", "anout", "aout", "analogout"),
    "analog_in": ("ai", "anin", "ain", "analogin"),
    "group_out": ("go", "gout", "groupout"),
    "group_in": ("gi", "gin", "groupin"),
    "flag": ("flag", "flg"),
}
_KINDS = {word: kind for kind, words in _WORDS.items() for word in words}
_NUMBERED = re.compile(r"\$?([A-Za-z_]+?)_?\s*#?\s*[\[(]?\s*0*(\d+)\s*[\])]?$")


def usual_key(name: str) -> tuple[str, int] | None:
    """Kind and number that a usual name stands for: `do3`, `DO_3`, `$OUT[3]`, `OT#(3)`, `digital_out[3]`."""
    match = _NUMBERED.fullmatch(name.strip())
    if match is None:
        return None
    kind = _KINDS.get(match[1].lower().replace("_", ""))
    return None if kind is None else (kind, int(match[2]))


def joined_name(name: str) -> str | None:
    """RI[1], SIN#(2) as RI1, SIN2: the name by which a signal of such an own kind is kept."""
    match = _NUMBERED.fullmatch(name.strip())
    return None if match is None else f"{match[1]}{match[2]}"


def usual(key: Key) -> Key:
    """The key by kind and number of a name that is made of a usual word and a number; else the key itself."""
    found = usual_key(key) if isinstance(key, str) else None
    return found if found is not None else key


_BITS = re.compile(r"(group_(?:in|out)):(\d+)-(\d+)")


def bits_named(name: str) -> SignalRef | None:
    """The group that a name in neutral words means by its bits: `group_out:9-16`."""
    found = _BITS.fullmatch(name.strip())
    return SignalRef(found[1], int(found[2]), int(found[3])) if found is not None else None


def name_of_bits(port: SignalRef) -> str:
    """The other way round of `bits_named`."""
    return f"group_{'in' if port.kind.endswith('_in') else 'out'}:{port.number}-{port.last}"


def bit_kind(kind: str) -> str:
    """The kind of the bits that a group is made of."""
    return kind.replace("group_", "digital_")


def key_of(port: SignalRef) -> Key:
    """Where the value of a single signal is kept. Groups of numbered bits have no value of their own."""
    if port.name is not None:
        return port.name.lower()
    return (port.kind, port.number or 0)


def is_bit_group(port: SignalRef) -> bool:
    """Is it made of numbered bits? A group known by its own number (FANUC GO[2]) is a signal by itself."""
    return port.name is None and port.last is not None


def group_bits(port: SignalRef) -> list[Key]:
    """Keys of the bits of a numbered group, lowest first."""
    first = port.number or 0
    kind = bit_kind(port.kind)
    return [(kind, number) for number in range(first, (port.last if port.last is not None else first) + 1)]


def zero_of(kind: str) -> Value:
    if kind.startswith("analog"):
        return 0.0
    return 0 if kind.startswith("group") else False


def keys_named(text: str, alias: SignalRef | None) -> frozenset[Key]:
    """All keys under which a signal that a cell file names may be found."""
    keys: set[Key] = {text.strip().lower()}
    if alias is not None and not is_bit_group(alias):
        keys.add(key_of(alias))
    else:
        usual = usual_key(text)
        if usual is not None:
            keys.add(usual)
        elif whole := joined_name(text):
            keys.add(whole.lower())
    return frozenset(keys)


def as_port(value: Value, kind: str) -> SignalRef:
    """The signal that a parameter stands for: a signal, or its name. Raises ProgramError for anything else."""
    if isinstance(value, SignalRef):
        return value
    if isinstance(value, str) and value:
        return SignalRef(kind, name=value)
    raise ProgramError("no_value", "the signal parameter stands for no signal")


def number_from(value: Value, least: int) -> int:
    """The number of a signal that a program has worked out. Raises ProgramError below `least` (0: there is none)."""
    if (number := whole(value)) >= least or least == 0:
        return number
    raise ProgramError("out_of_range", f"there is no signal of the number {number}")
