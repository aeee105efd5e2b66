"""Targets of some components only: the rest is where the last move went, blended or not."""

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.simulation import entry_name
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

KUKA = "kuka_kr6r900sixx"
START = """DEF P()
DECL E6POS P1
DECL E6AXIS HOME
$BASE={X 0.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}
$TOOL={X 0.0,Y 0.0,Z 80.0,A 0.0,B 0.0,C 0.0}
HOME={A1 0.0,A2 -90.0,A3 90.0,A4 0.0,A5 90.0,A6 0.0}
P1={X 500.0,Y 0.0,Z 400.0,A 180.0,B 0.0,C 180.0,S 2,T 2}
$APO.CDIS=10
$APO.CPTP=30
$VEL.CP=0.3
PTP {A1 0,A2 -90,A3 90,A4 0,A5 90,A6 0}
"""
CASES = {
    "one axis behind constant joints": "PTP {A1 15}\nPTP_REL {A1 5,A6 -10}\n",
    "one axis behind joints in a variable": "HOME.A1=5\nPTP HOME\nPTP {A6 20}\n",
    "one axis behind a place": "PTP P1\nPTP {A6 20}\n",
    "a coordinate of a line": "LIN P1\nLIN {Z 450}\nLIN {X 480,Y 20}\n",
    "an arc over a point without angles": "LIN P1\nCIRC {X 550,Y 50,Z 400},{X 500,Y 100,Z 400,A 180,B 0,C 180}\n",
    "an arc to a point in a variable": "LIN P1\nP1.Y=100\nCIRC {X 550,Y 50,Z 400},P1\n",
}
TARGETS = ["rapid", "tp", "urscript", "vplus", "inform"]


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("name", CASES)
def test_what_is_left_out_stays(name: str, target: str) -> None:
    read = read_sources([source_from_text("p.src", START + CASES[name] + "END\n")], "krl", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, KUKA, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    result = prove_programs(read.program, back.program, KUKA, entry="P", to_entry=entry_name(back.program))
    assert result.agrees, result.as_text()


@pytest.mark.parametrize("target", TARGETS)
def test_behind_a_corner_nothing_has_to_stop(target: str) -> None:
    body = "PTP {A1 15} C_PTP\nPTP {A6 20}\nLIN P1 C_DIS\nLIN {Z 450}\n"
    read = read_sources([source_from_text("p.src", START + body + "END\n")], "krl", Diagnostics())
    diagnostics = Diagnostics()
    translate_program(read, target, KUKA, None, diagnostics)
    assert "stopped-for-position" not in {item.code.name for item in diagnostics}
