"""Relative moves for targets whose moves want a whole target: each starts where the one before it has ended."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.simulation import entry_name
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

KUKA = "kuka_kr6r900sixx"
START = """DEF P()
DECL E6POS P1,P2
P1={X 500.0,Y 50.0,Z 400.0,A 0.0,B 180.0,C 0.0,S 2,T 35}
P2={X 400.0,Y 50.0,Z 400.0,A 0.0,B 180.0,C 0.0,S 2,T 35}
BAS(#INITMOV,0)
PTP P1
"""
CASES = {
    "from where the robot stands, twice": "P1=$POS_ACT\nLIN_REL {Z 40.0}\nLIN_REL {X 15.0} #TOOL\n",
    "the first is blended": "P1=$POS_ACT\nLIN_REL {Z 40.0} C_DIS\nLIN_REL {Y 15.0} C_DIS\nLIN_REL {X -9.0}\n",
    "from a named point": "LIN P1\nLIN_REL {Z 40.0}\nLIN_REL {X 15.0} #TOOL\n",
    "an arc whose points have some components": "LIN P1\nCIRC {X 450.0,Y 90.0},{X 400.0,Y 50.0}\n",
    "an arc over a point with some components": "PTP P1\nCIRC {X 450.0,Y 90.0},P2\n",
    "an arc by offsets": "LIN P1\nCIRC_REL {X -50.0,Y 40.0},{X -100.0}\nLIN_REL {Z 20.0}\n",
    "an arc behind another one": "LIN P1\nCIRC {X 450.0,Y 90.0},{X 400.0,Y 50.0}\nCIRC {X 450.0,Y 10.0},P1\n",
    "by an input": "LIN_REL {X ($ANIN[1]*10)}\nLIN_REL {Y 20.0}\n",
}


@pytest.mark.parametrize("target", ["rapid", "urscript"])
@pytest.mark.parametrize("name", CASES)
def test_relative_moves_end_at_the_same_places(name: str, target: str) -> None:
    moves_are_equal(CASES[name], target)


@pytest.mark.parametrize("name", [name for name in CASES if "components" in name])
def test_points_with_some_components_are_whole_in_vplus(name: str) -> None:
    moves_are_equal(CASES[name], "vplus")


def moves_are_equal(moves: str, target: str) -> None:
    read = read_sources([source_from_text("p.src", START + moves + "END\n")], "krl", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, KUKA, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    result = prove_programs(read.program, back.program, KUKA, entry="P", to_entry=entry_name(back.program))
    assert result.equal, result.as_text()
