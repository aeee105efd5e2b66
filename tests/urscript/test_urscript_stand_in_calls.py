"""A program that wants the robot to stand at the start of a routine, or behind a call: the corner in front ends."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "adept_viper_s650"
STAND = ".PROGRAM stand()\nBREAK\nHERE now\n.END\n"
# The main program, the routines it calls, and whether a wait is written (else the move has no radius).
CASES = {
    "first step of a call": ("MOVES TRANS(400,40,240,0,180,0)\nCALL stand()", STAND, False),
    "first step of a call in a call": (
        "MOVES TRANS(400,40,240,0,180,0)\nCALL outer()",
        f".PROGRAM outer()\nCALL stand()\n.END\n{STAND}",
        False,
    ),
    "call behind a branch": (
        "IF SIG(-1001) THEN\nMOVES TRANS(400,40,240,0,180,0)\nEND\nCALL stand()",
        STAND,
        True,
    ),
    "move in a call": (
        "CALL drive()\nBREAK\nHERE now",
        ".PROGRAM drive()\nMOVES TRANS(400,40,240,0,180,0)\n.END\n",
        True,
    ),
    "branch with a stop behind one without": (
        "IF SIG(-1001) THEN\nMOVES TRANS(400,40,240,0,180,0)\nELSE\nMOVES TRANS(400,0,240,0,180,0)\nBREAK\nEND\n"
        "BREAK\nHERE now",
        "",
        True,
    ),
}


@pytest.mark.parametrize("what", CASES)
def test_the_robot_stands_where_the_program_wants_it(what: str) -> None:
    main, others, waits = CASES[what]
    text = (
        ".PROGRAM main()\nDISABLE SCALE.ACCEL\nSPEED 50 ALWAYS\n"
        f"MOVE TRANS(400,0,240,0,180,0)\nMOVES TRANS(400,0,200,0,180,0)\n{main}\n"
        f"IF ABS(DY(now)-40) < 0.05 THEN\nSIGNAL 1\nEND\n.END\n{others}"
    )
    read = read_sources([source_from_text("main.v2", text)], "vplus", Diagnostics())
    files = translate_program(read, "urscript", ARM, None, Diagnostics()).files
    shown = files[0].data.decode()
    assert ("is_steady" in shown) == waits, shown
    back = read_sources([source_from_bytes(one.path, one.data) for one in files], "urscript", Diagnostics())
    result = run_program(back.program, ARM)
    assert result.status == "finished" and [value for _, _, value in result.outputs] == [True]
