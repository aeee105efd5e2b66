"""The head of a listing: program name and type, attributes, application section."""

from __future__ import annotations

import re
from dataclasses import dataclass

from .words import attribute_name, attribute_value

_PROGRAM = re.compile(r"/PROG[ \t]+(\S+)[ \t]*([A-Za-z]*)")
_ATTRIBUTE = re.compile(
    r"^[ \t]*(?:TCD:)?[ \t]*([A-Za-z_.\u0080-\uffff]+)[ \t]*=[ \t]*([^;]*?)[ \t]*[,;]?[ \t]*\r?$", re.MULTILINE
)


@dataclass(frozen=True, slots=True)
class Header:
    """What stands before /MN. `kind`: the word behind the name (Macro, Cond, Process), empty for a plain program."""

    name: str
    kind: str
    attributes: tuple[tuple[str, str], ...]

    @property
    def comment(self) -> str:
        return next((value.strip('"') for name, value in self.attributes if name == "COMMENT"), "")


def read_header(text: str) -> Header:
    """The header in a listing's text (up to /MN)."""
    program = _PROGRAM.search(text)
    attributes = []
    if program and program[2]:
        attributes.append(("PROG_TYPE", program[2]))
    body, _, application = text.partition("/APPL")
    for name, value in _ATTRIBUTE.findall(body):
        attributes.append((attribute_name(name), attribute_value(value)))
    kept = " ".join(application.partition("/MN")[0].split())
    if kept:
        attributes.append(("APPL", kept))
    return Header(program[1] if program else "", program[2] if program else "", tuple(attributes))
