"""Places in the robot's own base: a KRL program says so at its start, for `$BASE` keeps what ran before.

`$BASE` has no valid value after power-on, and keeps what a program has set until another one sets it (M).
"""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

JOB = """/JOB
//NAME A
//POS
///NPOS 0,0,0,2,0,0
///TOOL 0
///POSTYPE %s
///RECTAN
///RCONF 0,0,0,0,0,0,0,0
P000=500.000,50.000,400.000,180.0000,0.0000,0.0000
P001=500.000,80.000,400.000,180.0000,0.0000,0.0000
//INST
///DATE 2024/01/01 00:00
///ATTR SC,RW
///GROUP1 RB1
NOP
MOVJ P000 VJ=10.00
MOVL P001 V=100.0
END
"""
SCRIPT = "def p():\n  movej([0, -1.5, 1.5, -1.5, -1.5, 0])\n  movel(p[0.4, 0.1, 0.4, 0, 3.14, 0], v=0.1)\nend\n"
STEPS = ".PROGRAM a()\n  SET p = TRANS(500, 50, 400, 0, 180, 0)\n  MOVE p\n.END\n"


def lines(path: str, text: str, dialect: str, robot: str) -> list[str]:
    read = read_sources([source_from_text(path, text)], dialect, Diagnostics())
    written = translate_program(read, "krl", robot, None, Diagnostics())
    return "\n".join(file.data.decode("latin-1") for file in written.files).splitlines()


@pytest.mark.parametrize(
    ("path", "text", "dialect", "robot"),
    [
        ("p.script", SCRIPT, "urscript", "ur10e"),
        ("a.v2", STEPS, "vplus", "staubli_rx160"),
    ],
)
def test_the_base_is_said_once_before_the_first_move(path: str, text: str, dialect: str, robot: str) -> None:
    found = lines(path, text, dialect, robot)
    assert found.count("$BASE=$NULLFRAME") == 1
    first = next(n for n, line in enumerate(found) if line.startswith(("PTP", "LIN")))
    assert found.index("$BASE=$NULLFRAME") < first


@pytest.mark.parametrize(("kind", "number"), [("BASE", 0), ("USER\n///USER 1", 1)])
def test_inline_forms_say_the_base_themselves(kind: str, number: int) -> None:
    found = lines("A.JBI", JOB % kind, "inform", "motoman_gp8")
    assert not [line for line in found if line.startswith("$BASE")]
    frames = [line for line in found if "DECL" in line and " FDAT " in line]
    assert len(frames) == 2 and all(f"BASE_NO {number}," in line for line in frames)


def test_a_base_that_the_moves_name_is_theirs() -> None:
    fast = JOB.replace("MOVJ P000 VJ=10.00\nMOVL P001 V=100.0", "MOVL P000 V=2500.0\nMOVL P001 V=2500.0")
    found = lines("A.JBI", fast % "USER\n///USER 1", "inform", "motoman_gp8")
    assert [line for line in found if line.startswith("$BASE")] == ["$BASE=BASE_DATA[1]"]


def test_ways_in_joints_need_none() -> None:
    found = lines("p.script", "def p():\n  movej([0, -1.5, 1.5, -1.5, -1.5, 0])\nend\n", "urscript", "ur10e")
    assert not [line for line in found if "$BASE" in line]
