"""Corners whose next step stands behind a choice, a label or a call, where the target stands still at every signal."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

POINTS = """///NPOS 2,0,0,0,0,0
///TOOL 0
///POSTYPE ROBOT
///RECTAN
///RCONF 1,0,0,0,0,0,0,0
C00000=450.000,20.000,300.000,180.0000,0.0000,0.0000
C00001=450.000,120.000,300.000,180.0000,0.0000,0.0000
"""
CORNER, STOP, BACK = "MOVL C00001 V=200.0 PL=2\n", "MOVL C00000 V=200.0 PL=0\n", "MOVL C00000 V=100.0 PL=0\n"
IF, ELSE, ENDIF = "IFTHENEXP B001=1\n", "ELSE\n", "ENDIF\n"
OUT, IN = "DOUT OT#(3) ON\n", "JUMP *GO IF IN#(2)=ON\nINC B002\n*GO\n"


def job(name: str, steps: str, points: str = "///NPOS 0,0,0,0,0,0\n") -> str:
    head = f"/JOB\n//NAME {name}\n//POS\n{points}//INST\n///DATE 2025/05/14 10:22\n///ATTR SC,RW\n///GROUP1 RB1\n"
    return f"{head}NOP\n{steps}END\n"


def translated(steps: str, sub: str = "", target: str = "krl") -> tuple[str, Diagnostics]:
    sources = [("MAIN", job("MAIN", steps, POINTS)), ("SUB", job("SUB", sub, POINTS))]
    read = read_sources([source_from_text(f"{name}.JBI", text) for name, text in sources], "inform", Diagnostics())
    diagnostics = Diagnostics()
    files = translate_program(read, target, "motoman_gp7", None, diagnostics).files
    return "\n".join(file.data.decode("utf-8") for file in files), diagnostics


def told(diagnostics: Diagnostics, name: str) -> list[int]:
    return [item.origin.line for item in diagnostics if item.code.name == name]


KEPT = {  # the output gets the mark that lets the corner be
    "behind a branch": STOP + IF + CORNER + ENDIF.replace("ENDIF", "ELSE\nTIMER T=0.10\nENDIF") + OUT + BACK,
    "in both branches": STOP + IF + CORNER + ELSE + CORNER + ENDIF + OUT + BACK,
    "behind a label": STOP + CORNER + "JUMP *ON IF B001=1\nINC B002\n*ON\n" + OUT + BACK,
}


@pytest.mark.parametrize("case", KEPT)
def test_an_output_keeps_the_corner(case: str) -> None:
    text, diagnostics = translated(KEPT[case])
    assert text.count("CONTINUE") == 1, text
    assert len(told(diagnostics, "early-logic")) == 1
    assert told(diagnostics, "corner-stops-behind") == []


LOST = {  # where the robot stops: a place that decides, or one that the robot also drives to with a stop
    "a choice by an input": STOP + CORNER + IN + BACK,
    "behind a stop in the other branch": STOP + IF + CORNER + ELSE + STOP + ENDIF + OUT + BACK,
    "a loop that looks at an input": STOP + CORNER + "WHILEEXP IN#(2)=OFF\nINC B002\nENDWHILE\n" + BACK,
    "a loop back": STOP + "WHILEEXP B001<3\n" + IN + CORNER + "INC B001\nENDWHILE\n" + BACK,
}


@pytest.mark.parametrize("case", LOST)
def test_a_corner_that_is_lost_is_told(case: str) -> None:
    text, diagnostics = translated(LOST[case])
    (line,) = told(diagnostics, "corner-stops-behind")
    numbered = job("MAIN", LOST[case], POINTS).splitlines()
    assert numbered[line - 1] == CORNER.strip()
    assert "CONTINUE" not in text


def test_ways_through_called_jobs() -> None:
    ends_in_corner = STOP + CORNER + "INC B002\n"
    text, diagnostics = translated("CALL JOB:SUB\n" + OUT + BACK, ends_in_corner)
    assert text.count("CONTINUE") == 1
    _, diagnostics = translated("CALL JOB:SUB\n" + IN + BACK, ends_in_corner)
    assert len(told(diagnostics, "corner-stops-behind")) == 1
    text, diagnostics = translated(STOP + CORNER + "CALL JOB:SUB\n" + OUT + BACK, "INC B002\n")
    assert text.count("CONTINUE") == 1
    _, diagnostics = translated(STOP + CORNER + IF + "INC B002\n" + ENDIF + "CALL JOB:SUB\n" + BACK, IN)
    assert len(told(diagnostics, "corner-stops-behind")) == 1
    _, diagnostics = translated(STOP + CORNER + "CALL JOB:SUB\n" + BACK, OUT)
    assert len(told(diagnostics, "corner-stops-behind")) == 1


@pytest.mark.parametrize("target", ["rapid", "tp", "rpl"])
def test_only_where_the_program_stands_at_signals(target: str) -> None:
    for steps in (*KEPT.values(), *LOST.values()):
        _, diagnostics = translated(steps, target=target)
        assert told(diagnostics, "corner-stops-behind") == []
