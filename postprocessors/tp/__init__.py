"""FANUC TP listings (.LS) as a target: the record that the registry finds."""

from rpl.registry import Target

TARGET = Target(
    __name__,
    "FANUC TP",
    longest_line=320,
    encodings=("ascii",),
    rows=True,
    options={"names": "longest program name: 36 (default) or 8 for old controllers"},
)
