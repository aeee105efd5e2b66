"""Relative moves for targets whose moves want a whole target: each starts where the one before it has ended."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.simulation import entry_name
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program
from tests.analog_wiring import WIRED

KUKA = "kuka_kr6r900sixx"
START = """DEF P()
DECL E6POS P1,P2
DECL FRAME F
DECL AXIS WAYS
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
    "turned in the base": "LIN P1\nLIN_REL {Z 10.0,A 15.0} #BASE\nLIN_REL {X 9.0}\n",
    "turned in the tool": "LIN P1 C_DIS\nLIN_REL {Z -10.0,B 12.0,C 5.0} #TOOL\nLIN_REL {X 9.0} #TOOL\n",
    "turned from where the robot stands": "P1=$POS_ACT\nLIN_REL {Z 10.0,A 15.0,B 5.0} #BASE\n",
    "turned in the tool from there": "P1=$POS_ACT\nLIN_REL {Z 10.0,A 15.0,B 5.0} #TOOL\nLIN_REL {C 8.0}\n",
    "turned by an input": "LIN P2\nLIN_REL {A ($ANIN[1]*10+5)}\nLIN_REL {Y 20.0}\n",
    "turned by data": "F={X 5.0,Y 0.0,Z 9.0,A 20.0,B 3.0,C 0.0}\nLIN_REL F #TOOL\nF.X=1.0\nLIN_REL F\n",
    "joint move that turns": "PTP_REL {Z 10.0,A 15.0}\nPTP_REL {X 5.0,C 9.0} #TOOL\n",
    "joint values of a variable": "WAYS={A1 5.0,A2 0.0,A3 -4.0,A4 0.0,A5 3.0,A6 20.0}\nPTP_REL WAYS\nPTP_REL WAYS\n",
    "by an input": "LIN_REL {X ($ANIN[1]*10)}\nLIN_REL {Y 20.0}\n",
}


@pytest.mark.parametrize("target", ["rapid", "urscript"])
@pytest.mark.parametrize("name", CASES)
def test_relative_moves_end_at_the_same_places(name: str, target: str) -> None:
    moves_are_equal(CASES[name], target)


@pytest.mark.parametrize("name", [name for name in CASES if "components" in name])
def test_points_with_some_components_are_whole_in_vplus(name: str) -> None:
    moves_are_equal(CASES[name], "vplus")


@pytest.mark.parametrize("target", ["tp", "inform", "vplus"])
def test_joint_values_of_a_variable(target: str) -> None:
    moves_are_equal(CASES["joint values of a variable"], target)


@pytest.mark.parametrize("target", ["tp", "inform", "vplus"])
@pytest.mark.parametrize("name", [name for name in CASES if "turn" in name])
def test_relative_moves_that_turn_the_tool(name: str, target: str) -> None:
    moves_are_equal(CASES[name], target)


def moves_are_equal(moves: str, target: str) -> None:
    read = read_sources([source_from_text("p.src", START + moves + "END\n")], "krl", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, KUKA, None, diagnostics, analog=WIRED)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    result = prove_programs(read.program, back.program, KUKA, entry="P", to_entry=entry_name(back.program))
    assert result.agrees, result.as_text()
