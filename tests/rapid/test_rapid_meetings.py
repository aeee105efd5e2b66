"""Tasks that wait for each other: written in RAPID as they were read, refused by name elsewhere."""

from __future__ import annotations

import pytest
from rapid_helpers import normal, read_back, statement, without_remarks

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

DATA = 'PERS tasks both{2}:=[["T_ROB1"],["T_ROB2"]];\nVAR syncident here;\nVAR syncident points{9};\n'
LINES = (
    "WaitSyncTask here,both;",
    "WaitSyncTask\\InPos,points{3},both;",
    "WaitSyncTask here,both\\TimeOut:=20;",
    "SyncMoveOn here,both;",
    "SyncMoveOff here\\TimeOut:=2;",
)


@pytest.mark.parametrize("line", LINES)
def test_what_was_read_is_written(line: str) -> None:
    assert isinstance(statement(line, DATA), ir.Meet)
    program = normal(f"MODULE m\n{DATA}PROC main()\n{line}\nENDPROC\nENDMODULE\n")
    assert without_remarks(read_back(program)) == without_remarks(program)


@pytest.mark.parametrize("line", LINES)
@pytest.mark.parametrize("target", ["krl", "tp", "urscript", "inform", "vplus"])
def test_another_language_refuses_it_by_name(target: str, line: str) -> None:
    diagnostics = Diagnostics()
    text = f"MODULE m\n{DATA}PROC main()\n{line}\nENDPROC\nENDMODULE\n"
    read = read_sources([source_from_text("m.mod", text)], "rapid", diagnostics)
    translate_program(read, target, "abb_irb1600_6_12", None, diagnostics)
    (found,) = [item for item in diagnostics if item.code.name == "meeting-lost"]
    assert ("(points)" if "points" in line else "(here)") in found.as_text()
    assert found.origin.line == 6
