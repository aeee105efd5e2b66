"""Points moved by a frame that turns nothing are `Offs` of the point (RAPID multiplies poses, not robtargets)."""

from __future__ import annotations

import re

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import ReadProgram, read_sources
from rpl.proof.prove import prove_programs
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "kuka_kr10r1100sixx"
DATA = """DEFDAT offsets
DECL FRAME once={X 0.0,Y 0.0,Z -105.0,A 0.0,B 0.0,C 0.0}
DECL FRAME over={X 0.0,Y 20.0,Z 100.0,A 0.0,B 0.0,C 0.0}
DECL FRAME turned={X 0.0,Y 0.0,Z 100.0,A 0.0,B 10.0,C 0.0}
DECL FRAME changing={X 0.0,Y 0.0,Z 100.0,A 0.0,B 0.0,C 0.0}
DECL FRAME table={X 0.0,Y 0.0,Z 100.0,A 0.0,B 0.0,C 0.0}
DECL E6POS XP1={X 500,Y 0,Z 500,A 0,B 90,C 0,S 2,T 3,E1 0,E2 0,E3 0,E4 0,E5 0,E6 0}
DECL E6POS XP2={X 500,Y 100,Z 500,A 0,B 90,C 0,S 2,T 3,E1 0,E2 0,E3 0,E4 0,E5 0,E6 0}
ENDDAT
"""
PROGRAM = """DEF offsets()
BAS(#INITMOV,0)
$TOOL={{X 0,Y 0,Z 100,A 0,B 0,C 0}}
$BASE={{X 0,Y 0,Z 0,A 0,B 0,C 0}}
PTP {{A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}}
{moves}
END
"""


def read(moves: str) -> ReadProgram:
    texts = [source_from_text("offsets.src", PROGRAM.format(moves=moves)), source_from_text("offsets.dat", DATA)]
    return read_sources(texts, "krl", Diagnostics())


def rapid(moves: str, diagnostics: Diagnostics | None = None) -> tuple[str, ReadProgram]:
    """What is written, and that as it is read."""
    files = translate_program(
        read(moves), "rapid", ARM, None, Diagnostics() if diagnostics is None else diagnostics
    ).files
    sources = [source_from_bytes(one.path, one.data) for one in files if one.path.endswith(".mod")]
    return "\n".join(one.text for one in sources), read_sources(sources, "rapid", Diagnostics())


def targets(moves: str) -> list[str]:
    return re.findall(r"MoveL (\w+\(.*?\)|\w+),v", rapid(moves)[0])


def test_a_frame_that_moves_one_point_is_its_numbers() -> None:
    assert targets("LIN once:XP1") == ["Offs(XP1,0,0,-105)"]
    assert "once" not in rapid("LIN once:XP1")[0]


def test_a_frame_that_moves_several_points_keeps_its_name() -> None:
    moved = targets("LIN over:XP1\nLIN over:XP2")
    assert moved == ["Offs(XP1,0,over.trans.y,over.trans.z)", "Offs(XP2,0,over.trans.y,over.trans.z)"]


@pytest.mark.parametrize(
    "moves",
    [
        "LIN turned:XP1",
        "LIN changing:XP1\nchanging.Z=50\nLIN changing:XP1",
        "$BASE=table\nLIN table:XP1",
    ],
)
def test_what_turns_or_changes_or_is_a_frame_stays_a_product(moves: str) -> None:
    assert "Offs(" not in rapid(moves)[0]


@pytest.mark.parametrize(
    ("moves", "named"),
    [("LIN once:XP1", "once"), ("LIN over:XP1\nLIN over:XP2", "over"), ("LIN XP1", ""), ("LIN turned:XP1", "")],
)
def test_what_does_not_follow_the_frame_is_named_once(moves: str, named: str) -> None:
    diagnostics = Diagnostics()
    rapid(moves, diagnostics)
    told = [one.message for one in diagnostics if one.code.name == "taught-value-written"]
    assert len(told) == (1 if named else 0)
    assert all(f"worked out of {named} as taught now" in one for one in told)


def test_the_robot_goes_the_same_way() -> None:
    moves = "LIN once:XP1\nLIN over:XP1\nLIN over:XP2 C_DIS\nLIN XP1"
    proof = prove_programs(read(moves).program, rapid(moves)[1].program, ARM, entry="offsets", to_entry="main")
    assert proof.agrees, proof.as_text()
