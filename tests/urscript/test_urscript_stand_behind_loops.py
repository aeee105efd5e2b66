"""A program that wants the robot to stand behind a loop or branch whose last move is rounded."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "adept_viper_s650"
MOVES = "MOVES TRANS(400,20*i,140,0,180,0)\nMOVES TRANS(400,20*i,240,0,180,0)"
BODIES = {
    "loop": f"FOR i = 1 TO 2\n{MOVES}\nEND",
    "branch": f"i = 2\nIF SIG(-1001) THEN\n{MOVES}\nEND",
    "move": f"i = 2\n{MOVES}",
}


@pytest.mark.parametrize("what", BODIES)
def test_the_place_behind_it_is_the_last_point(what: str) -> None:
    text = (
        f".PROGRAM main()\nSPEED 50 ALWAYS\nMOVE TRANS(400,0,240,0,180,0)\n{BODIES[what]}\nBREAK\nHERE now\n"
        "IF (ABS(DZ(now)-240) < 0.05) AND (ABS(DY(now)-40) < 0.05) THEN\nSIGNAL 1\nEND\n.END\n"
    )
    read = read_sources([source_from_text("main.v2", text)], "vplus", Diagnostics())
    files = translate_program(read, "urscript", ARM, None, Diagnostics()).files
    shown = files[0].data.decode()
    assert ("is_steady" in shown) == (what != "move")
    back = read_sources([source_from_bytes(one.path, one.data) for one in files], "urscript", Diagnostics())
    result = run_program(back.program, ARM)
    assert result.status == "finished" and [value for _, _, value in result.outputs] == [True]
