"""Moves to computed positions with other tools than most of a job's: a position variable comes with its own tool.

Each program is proved against the jobs written for it, so that the flange goes the same way.
"""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import Translation, translate_program

ARM = "kuka_kr6r900sixx"
KRL = """DEF MAIN()
DECL E6POS START,P,Q
DECL FRAME WAY
DECL REAL SIZE
START={{X 450,Y 100,Z 450,A 180,B 0,C 180,S 2,T 35}}
$TOOL=$NULLFRAME
$BASE=$NULLFRAME
$VEL.CP=0.2
PTP {{A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}}
P=START
P.X=460
PTP P
LIN P
Q=P
Q.Y=110
LIN Q
{lines}
IF $POS_ACT.X>0 THEN
  $OUT[1]=TRUE
ENDIF
END
"""
LONG, SHORT = "{X 0,Y 0,Z 120,A 0,B 0,C 0}", "{X 20,Y 0,Z 40,A -30,B 0,C 0}"
SIDE = "{X 400,Y -150,Z 250,A 90,B 0,C 0}"
MOVES = {
    "linear": "$TOOL=LONG\nP.Z=300\nLIN P",
    "joint, in the posture of the position": "$TOOL=LONG\nP.Z=300\nPTP P",
    "two tools": "$TOOL=LONG\nP.Z=300\nLIN P\n$TOOL=SHORT\nP.Z=320\nLIN P\nP.Y=40\nPTP P",
    "back to the first": "$TOOL=LONG\nP.Z=300\nLIN P\n$TOOL=$NULLFRAME\nP.Y=50\nLIN P",
    "in a base": "$TOOL=SHORT\n$BASE=SIDE\nP={X 10,Y -20,Z 60,A 90,B 0,C 180}\nP.X=30\nLIN P\nP.Y=-30\nPTP P",
    "arc": "$TOOL=LONG\nP.Z=300\nLIN P\nQ=P\nQ.X=440\nQ.Y=120\nP.Y=140\nCIRC Q,P",
    "arcs in a row": (
        "$TOOL=LONG\nP.Z=300\nLIN P\nQ=P\nQ.X=440\nQ.Y=120\nP.Y=140\nCIRC Q,P\nQ=P\nQ.Z=310\nQ.Y=150\nP.Y=160\nCIRC Q,P"
    ),
    "relative": "$TOOL=LONG\nP.Z=300\nLIN P\nWAY={X 5,Y 0,Z 10,A 0,B 0,C 0}\nWAY.Z=WAY.Z+P.Z/30\nLIN_REL WAY",
    "with a tool that is computed": "WAY=LONG\nWAY.Z=P.Z/4\n$TOOL=WAY\nP.Z=300\nLIN P\nP.Y=60\nPTP P",
}


def translated(lines: str) -> tuple[Translation, str, Diagnostics]:
    read = read_sources(
        [
            source_from_text(
                "MAIN.src", KRL.format(lines=lines.replace("LONG", LONG).replace("SHORT", SHORT).replace("SIDE", SIDE))
            )
        ],
        "krl",
        Diagnostics(),
    )
    diagnostics = Diagnostics()
    translation = translate_program(read, "inform", ARM, None, diagnostics)
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], "inform", Diagnostics())
    result = prove_programs(read.program, back.program, ARM, None, entry="MAIN", to_entry="MAIN")
    assert result.agrees, result.as_text()
    text = next(f.data.decode() for f in translation.files if f.path.startswith("MAIN"))
    return translation, text, diagnostics


@pytest.mark.parametrize("lines", MOVES.values(), ids=MOVES)
def test_the_wanted_tool_comes_to_the_wanted_place(lines: str) -> None:
    assert not translated(lines)[2].of(Severity.LOSS)


def test_a_variable_for_each_tool() -> None:
    """Taught with the tool, then given other components; the tool stays."""
    text = translated(MOVES["two tools"])[1]
    assert text.count("GETE") >= 12 and {"///TOOL 1", "///TOOL 2"} <= set(text.splitlines())


CORNERS = {"SIZE=30": "2", "SIZE=5": "1", "SIZE=0": "0", "SIZE=900": "8"}


@pytest.mark.parametrize("size", CORNERS)
def test_a_corner_of_a_joint_move_that_is_computed(size: str) -> None:
    """The levels are looked up in the run; the way in the corner differs, so the level itself is what counts."""
    lines = f"{size}\n$APO.CDIS=SIZE\nPTP P C_DIS\nP.Z=300\nLIN P"
    read = read_sources(
        [
            source_from_text(
                "MAIN.src", KRL.format(lines=lines.replace("LONG", LONG).replace("SHORT", SHORT).replace("SIDE", SIDE))
            )
        ],
        "krl",
        Diagnostics(),
    )
    diagnostics = Diagnostics()
    files = translate_program(read, "inform", ARM, None, diagnostics).files
    assert not diagnostics.of(Severity.LOSS)
    assert any(one.code.name == "inform-computed-corner" for one in diagnostics)
    text = next(one.data.decode() for one in files if one.path.startswith("MAIN"))
    assert text.count(">=500.0") == 1 and " PL=B" in text
