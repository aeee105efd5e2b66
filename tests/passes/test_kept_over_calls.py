"""Tool and frame that are in force stay known behind a call that neither moves nor changes them."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

POINTS = """///NPOS 1,0,0,1,0,0
///TOOL 1
///POSTYPE BASE
///RECTAN
///RCONF 1,0,0,0,0,0,0,0
C00000=450.000,20.000,300.000,180.0000,0.0000,0.0000
P00001=0.000,0.000,50.000,0.0000,0.0000,0.0000
"""
MOVE = "MOVL C00000 V=200.0 PL=0\n"


def job(name: str, steps: str) -> str:
    head = f"/JOB\n//NAME {name}\n//POS\n{POINTS}//INST\n///DATE 2025/05/14 10:22\n///ATTR SC,RW\n///GROUP1 RB1\n"
    return f"{head}NOP\n{steps}END\n"


@pytest.mark.parametrize(
    ("called", "again"),
    [
        ("DOUT OT#(1) ON\nTIMER T=0.20\n", False),
        ("WAIT IN#(1)=ON T=0.50\n", False),
        ("INC B001\n", False),
        ("CALL JOB:DEEP\n", False),
        ("SETTOOL TL#(1) P001\n", True),
        ("CALL JOB:TOOL\n", True),
        (MOVE, True),
    ],
)
def test_the_tool_behind_a_call(called: str, again: bool) -> None:
    main = f"SETTOOL TL#(1) P001\n{MOVE}CALL JOB:SUB\n{MOVE}"
    texts = {"MAIN": main, "SUB": called, "DEEP": "DOUT OT#(2) ON\n", "TOOL": "SETTOOL TL#(1) P001\n"}
    sources = [source_from_text(f"{name}.JBI", job(name, steps)) for name, steps in texts.items()]
    read = read_sources(sources, "inform", Diagnostics())
    files = translate_program(read, "krl", "motoman_gp7", None, Diagnostics()).files
    (text,) = [file.data.decode("utf-8") for file in files if file.path.endswith("MAIN.src")]
    assert text.count("$TOOL=TL1") == (2 if again else 1)
