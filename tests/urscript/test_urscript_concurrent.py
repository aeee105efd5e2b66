"""Moves that the program does not wait for: a thread drives them."""

from __future__ import annotations

import pytest

from tests.there_and_back import there_and_back

ROBOT = "motoman_gp7"
JOB = """/JOB
//NAME MAIN
//POS
///NPOS 3,0,0,0,0,0
///TOOL 0
///POSTYPE ROBOT
///RECTAN
///RCONF 1,0,0,0,0,0,0,0
C00000=480.000,0.000,350.000,180.0000,0.0000,0.0000
C00001=500.000,80.000,260.000,180.0000,0.0000,0.0000
C00002=500.000,80.000,200.000,180.0000,0.0000,0.0000
//INST
///DATE 2024/03/05 09:20
///ATTR SC,RW
///GROUP1 RB1
NOP
MOVJ C00000 VJ=50.00 PL=0
{lines}
END
"""


def script_of(lines: str) -> tuple[str, set[str]]:
    """The script and the codes of its warnings, after checking that it does what the job does."""
    journey = there_and_back({"MAIN.JBI": JOB.format(lines=lines)}, "inform", "urscript", ROBOT)
    assert not journey.losses
    proof = journey.prove("MAIN")
    assert proof.agrees, proof.as_text()
    return journey.text, {item.code.name for item in journey.found}


SEEN = "GETS PX010 $PX001\nGETE D010 P010 (2)\nDOUT OT#(2) ON\nJUMP *E IF D010<79900\nDOUT OT#(3) ON\n*E"


@pytest.mark.parametrize(
    "lines",
    [
        f"MOVL C00001 V=50.0 PL=0 NWAIT\nDOUT OT#(1) ON\nCWAIT\n{SEEN}",
        f"MOVL C00001 V=50.0 PL=0 NWAIT\nTIMER T=0.5\nDOUT OT#(1) ON\nMOVL C00002 V=50.0 PL=0\n{SEEN}",
        f"IFTHENEXP IN#(1)=OFF\nMOVL C00001 V=50.0 PL=0 NWAIT\nENDIF\nDOUT OT#(1) ON\nCWAIT\n{SEEN}",
        f"SET B001 0\nWHILEEXP B001<3\nINC B001\n"
        f"MOVL C00001 V=50.0 PL=0 NWAIT\nDOUT OT#(1) ON\nCWAIT\nENDWHILE\n{SEEN}",
        "MOVL C00001 V=50.0 PL=0 NWAIT\nDOUT OT#(1) ON",
    ],
)
def test_a_thread_drives_the_move(lines: str) -> None:
    script, _ = script_of(lines)
    assert "run rpl_mover()" in script and "while rpl_moving:" in script


def test_a_corner_behind_it_is_a_stop_and_told() -> None:
    program = JOB.format(lines="MOVL C00001 V=50.0 CR=20.0 NWAIT\nDOUT OT#(1) ON\nMOVL C00002 V=50.0 PL=0")
    assert "concurrent-move-stops" in reported(program)
    assert "concurrent-move-stops" not in reported(program.replace("CR=20.0", "PL=0"))


@pytest.mark.parametrize(
    "lines",
    [
        "MOVL C00001 V=50.0 PL=0 NWAIT\nDOUT OT#(1) ON\nMOVL C00002 V=50.0 PL=0 NWAIT\nDOUT OT#(2) ON\nCWAIT",
        "WHILEEXP B001<3\nINC B001\nMOVL C00001 V=50.0 PL=0 NWAIT\nDOUT OT#(1) ON\nENDWHILE\nCWAIT",
    ],
)
def test_several_at_once_are_refused(lines: str) -> None:
    assert "urscript-guarded-stop" in reported(JOB.format(lines=lines))


def reported(job: str) -> set[str]:
    return {item.code.name for item in there_and_back({"MAIN.JBI": job}, "inform", "urscript", ROBOT).found}
