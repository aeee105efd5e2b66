"""A bank that counts from zero is a list with the same numbers, whatever the passes count from in between."""

from __future__ import annotations

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

HEAD = "/JOB\n//NAME SUMS\n//POS\n///NPOS 0,0,0,0,0,0\n//INST\n///DATE 2025/05/14 10:22\n///ATTR SC,RW\n///GROUP1 RB1\n"
JOB = HEAD + "NOP\nSET D003 5\nFOR I000 = 0 TO 5\nADD D007 D[I000]\nNEXT I000\nEND\n"


def test_indices_keep_their_numbers() -> None:
    read = read_sources([source_from_text("SUMS.JBI", JOB)], "inform", Diagnostics())
    done = translate_program(read, "urscript", None, None, Diagnostics())
    text = "\n".join(file.data.decode() for file in done.files)
    assert "D[3] = 5" in text
    assert "D[7] = D[7] + D[I000]" in text
