"""Numbers read by a format from a text, in every target."""

from __future__ import annotations

import pytest
from there_and_back import entry_of

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

KUKA = "kuka_kr6r900sixx"
TEXT = """DEF JOB()
DECL INT I,OFS
DECL REAL R
DECL CHAR LINE[24]
DECL STATE_T ST
LINE[]="B=12;T=-3.5 7"
OFS=2
SREAD(LINE[],ST,OFS,"%d",I)
$OUT[1]=(I==12) AND (OFS==4)
SREAD(LINE[],ST,OFS,";T=%f %d",R,I)
$OUT[2]=(ABS(R+3.5)<0.001) AND (I==7) AND (OFS==13)
OFS=0
I=99
SREAD(LINE[],ST,OFS,"C=%d",I)
$OUT[3]=(I==99)
OFS=2
SREAD(LINE[],ST,OFS,"%f",R)
$OUT[4]=(R==12.0)
END
"""


@pytest.mark.parametrize("target", ["rapid", "tp", "urscript", "vplus", "inform"])
def test_numbers_are_read_from_a_text(target: str) -> None:
    read = read_sources([source_from_text("job.src", TEXT)], "krl", Diagnostics())
    told, again = Diagnostics(), Diagnostics()
    written = translate_program(read, target, KUKA, None, told)
    assert not [item.as_text() for item in told.of(Severity.LOSS) if item.code.name != "tp-text-case"]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, again)
    assert not [item.as_text() for item in again.of(Severity.ERROR)]
    result = prove_programs(read.program, back.program, KUKA, entry="JOB", to_entry=entry_of(written, "JOB"))
    assert result.agrees, result.as_text()
