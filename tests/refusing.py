"""What translation tells of a refused statement, and that the target's own stop stands in its place."""

from __future__ import annotations

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

# How a program of each language stops where a statement is refused.
STOPS = {
    "krl": "HALT",
    "rapid": "Stop;",
    "tp": "PAUSE",
    "urscript": "halt",
    "vplus": "PAUSE",
    "inform": "PAUSE",
    "rpl": "HALT",
}


def refused(text: str, source: str, target: str, arm: str, file: str = "") -> list[tuple[str, int]]:
    """Code and line (from 1) of each loss in the program; where there is one, the target's own stop is written."""
    extension = {"krl": "src", "rapid": "mod", "urscript": "script", "vplus": "v2", "tp": "ls", "inform": "jbi"}
    diagnostics = Diagnostics()
    name = file or f"main.{extension.get(source, source)}"
    read = read_sources([source_from_text(name, text)], source, diagnostics)
    assert not diagnostics.has_errors
    files = translate_program(read, target, arm, None, diagnostics).files
    told = [(item.code.name, item.origin.line) for item in diagnostics.of(Severity.LOSS)]
    written = b"\n".join(one.data for one in files).decode("latin-1")
    assert not told or STOPS[target] in written, written
    return told
