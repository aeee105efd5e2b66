"""Signals whose numbers stand in data of a name have that name in every language, and back."""

from __future__ import annotations

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

DATA = source_from_text("work.dat", "DEFDAT work\nSIGNAL grip $OUT[3]\nSIGNAL part $IN[9]\nENDDAT\n")


def written(text: str, name: str, source: str, target: str) -> str:
    sources = [source_from_text(name, text), *([DATA] if source == "krl" else [])]
    read = read_sources(sources, source, Diagnostics())
    files = translate_program(read, target, None, None, Diagnostics()).files
    return "".join(one.data.decode() for one in files if not one.path.endswith(".toml"))


def test_names_of_signals_become_data_with_their_numbers() -> None:
    """Counted as the target counts, and read back as names."""
    source = "DEF work( )\nWAIT FOR part\ngrip=TRUE\nEND\n"
    script = written(source, "work.src", "krl", "urscript")
    assert "global grip = 2" in script and "set_standard_digital_out(grip, True)" in script
    assert "global part = 0" in script and "get_configurable_digital_in(part)" in script
    program = written(source, "work.src", "krl", "vplus")
    assert "SIGNAL grip" in program and "WAIT SIG(part)" in program and "part 1009" in program
    assert "grip=TRUE" in written(script, "work.script", "urscript", "krl")
