"""Names that every RAPID system has declared: data, functions, instructions and types (lower case).

A program's own data of such a name hides the system's, so `fine` or `Offs` in a move would mean the program's variable.
The writer gives data of other languages another name then. Sources: reference manual, system data and data types.
"""

from __future__ import annotations

from .tables import SIGNAL_NAMES, TYPE_NAMES, WORDS

_LISTS = ("instructions", "functions", "number_types", "vendor_types", "record_types", "errors", "stop_points")
_SPEEDS = (("v", "speeds"), ("vrot", "rotary_speeds"), ("vlin", "linear_speeds"))
_VENDOR = ("vendor_instructions", "vendor_functions")
PREDEFINED = frozenset(
    name.lower()
    for name in (
        *(name for key in (*_LISTS, "further_data") for name in WORDS.listed(key)),
        *(f"{letters}{size}" for letters, key in _SPEEDS for size in WORDS.listed(key)),
        *(name for key in _VENDOR for names in WORDS.pairs(key).values() for name in names.split()),
        *WORDS.pairs("zones"),
        *WORDS.numbers("numbers"),
        *WORDS.pairs("texts"),
        *TYPE_NAMES.values(),
        *SIGNAL_NAMES.values(),
        "switch",
    )
)
