"""ABB RAPID as a target: the record that the registry finds."""

from rpl.registry import Target

TARGET = Target(
    __name__,
    "ABB RAPID",
    options={"header": "yes: begin each module with the load header of program files"},
    encodings=("latin-1", "utf-8"),
    rows=True,
)
