"""KUKA KRL as a target: the record that the registry finds."""

from rpl.registry import Target

TARGET = Target(
    __name__,
    "KUKA KRL",
    options={"moves": "`forms` or `lines`: moves as inline forms or expert lines; else as people write such a program"},
    encodings=("cp1252", "utf-8"),
)
