"""One signal, several reactions one after the other: what REACT replaces and IGNORE takes away, here and elsewhere."""

from __future__ import annotations

import pytest
from vplus_helpers import as_rpl, outputs, program_of, read, run

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

MORE = ".PROGRAM one()\na = a+1\n.END\n.PROGRAM two()\nb = b+1\n.END\n.PROGRAM once()\nIGNORE 2001\nb = b+1\n.END\n"
EDGE = "SIGNAL 2001\nWAIT.EVENT , 0.1\nSIGNAL -2001\nWAIT.EVENT , 0.1"
BALANCED = f"a = 0\nb = 0\nREACT 2001, one\n{EDGE}\nIGNORE 2001\nREACT 2001, two, 5\n{EDGE}\nIGNORE 2001\n{EDGE}"
# The second one takes itself away; the third finds nothing left of it.
ONCE = f"a = 0\nb = 0\nREACT 2001, one\n{EDGE}\nIGNORE 2001\nREACT 2001, once, 5\n{EDGE}\n{EDGE}"
REPLACED = f"a = 0\nb = 0\nREACT 2001, one\n{EDGE}\nREACT 2001, two, 5\n{EDGE}\n{EDGE}\nIGNORE 2001\n{EDGE}"


@pytest.mark.parametrize(
    ("steps", "met"),
    [(BALANCED, "(a == 1) AND (b == 1)"), (REPLACED, "(a == 1) AND (b == 1)"), (ONCE, "(a == 1) AND (b == 1)")],
)
def test_each_reaction_is_its_own(steps: str, met: str) -> None:
    result = run(f"{steps}\nIF {met} THEN\nSIGNAL 1\nEND", MORE)
    assert outputs(result)[-1] == ("1", True)


def test_nothing_is_replaced_where_each_is_taken_away() -> None:
    program, _ = read(program_of(BALANCED, MORE))
    assert sum("INTERRUPT DELETE" in line.upper() or "DELETE" in line.upper() for line in as_rpl(program)) == 2


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "urscript", "inform", "vplus", "rpl"])
def test_they_are_told_apart_in_every_language(target: str) -> None:
    text = program_of(f"{BALANCED}\nIF (a == 1) AND (b == 1) THEN\nSIGNAL 1\nEND", MORE)
    source = read_sources([source_from_text("main.v2", text)], "vplus", Diagnostics())
    found = Diagnostics()
    translation = translate_program(source, target, "adept_viper_s650", None, found)
    assert not [item.as_text() for item in found.of(Severity.LOSS)]
    files = [source_from_bytes(file.path, file.data) for file in translation.files]
    back = read_sources(files, target, Diagnostics())
    result = run_program(back.program, "adept_viper_s650", None, translation.renamed.get("test", "test"))
    assert result.status == "finished"
    assert any(value for _, _, value in result.outputs[-1:])
