"""Who sends a message is a text in most languages; the number of an alarm is written as one. What a job says of its
points in its head is no line in the head of a KRL file."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

JOB = """/JOB
//NAME ALARM
//POS
///NPOS 1,0,0,0,0,0
///USER 1
///TOOL 0
///POSTYPE USER
///RECTAN
///RCONF 1,0,0,0,0,0,0,0
C00000=20.000,20.000,80.000,180.0000,0.0000,0.0000
//INST
///DATE 2025/05/14 10:22
///ATTR SC,RW
///GROUP1 RB1
NOP
SET B001 12
MOVJ C00000 VJ=50.00
SETUALM 8001 "NO PART IN TRAY" 0
SETUALM B001 "GLUE IS LOW" 0 SMODE=1
END
"""
FRAMES = """//UFRAME 1
///NAME TABLE
///TOOL 0
///GROUP 1,0,0,0
///PULSE
////BUSER 500.000,-20.000,300.000,0.0000,0.0000,90.0000
"""


def written(target: str) -> str:
    diagnostics = Diagnostics()
    sources = [source_from_text("ALARM.JBI", JOB), source_from_text("UFRAME.CND", FRAMES)]
    read = read_sources(sources, "inform", diagnostics)
    done = translate_program(read, target, "motoman_gp7", None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    return "\n".join(file.data.decode() for file in done.files)


@pytest.mark.parametrize(
    ("target", "known", "computed"),
    [
        ("rapid", 'ErrWrite "8001","NO PART IN TRAY";', 'ErrWrite ValToStr(B001),"GLUE IS LOW";'),
        ("urscript", 'popup("NO PART IN TRAY", title="8001", error=True)', "title=to_str(B001)"),
        ("inform", 'SETUALM 8001 "NO PART IN TRAY" 0', 'SETUALM B001 "GLUE IS LOW" 0'),
    ],
)
def test_numbers_of_alarms(target: str, known: str, computed: str) -> None:
    text = written(target)
    assert known in text
    assert computed in text


def test_krl_head_lines_are_of_krl_files() -> None:
    text = written("krl")
    assert "&USER" not in text
    assert 'MsgQuit("NO PART IN TRAY","8001")' in text
