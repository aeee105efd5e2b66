"""Moves that say a time or a turning speed, in targets whose moves say that too; elsewhere the latter is refused."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import entry_name, run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ROBOT = "fanuc_lrmate200id"
POINT = """P[{n}]{{
   GP1:
	UF : 0, UT : 1,	CONFIG : 'N U T, 0, 0, 0',
	X = 400.0  mm,	Y = {y}  mm,	Z = 200.000  mm,
	W = 180.000 deg,	P = 0.000 deg,	R = {r} deg
}};
"""
PROGRAM = (
    """/PROG  TIMED
/ATTR
DEFAULT_GROUP = 1,*,*,*,*;
/MN
   1:J P[1] 100% FINE ;
   2:L P[2] 200mm/sec FINE ;
   3:L P[1] 2.0sec FINE ;
   4:L P[3] 30deg/sec FINE ;
   5:L P[1] 200mm/sec FINE ;
/POS
"""
    + POINT.format(n=1, y="0.0", r="0.0")
    + POINT.format(n=2, y="100.0", r="0.0")
    + POINT.format(n=3, y="0.0", r="60.0")
    + "/END\n"
)


def _durations(target: str, program: str = PROGRAM) -> list[float]:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("TIMED.LS", program)], "tp", diagnostics)
    translation = translate_program(read, target, ROBOT, None, diagnostics)
    assert not translation.losses
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, diagnostics)
    assert not diagnostics.has_errors
    result = run_program(back.program, ROBOT, None, entry_name(back.program), 60.0, controller="plain")
    assert result.status == "finished"
    return [float(event.data["duration"]) for event in result.trace if event.kind == "move"]


@pytest.mark.parametrize("target", ["rapid", "vplus", "urscript", "tp", "rpl"])
def test_a_time_is_kept(target: str) -> None:
    _, before, timed, _, after = _durations(target, PROGRAM.replace("30deg/sec", "200mm/sec"))
    assert timed == pytest.approx(2.0, abs=0.05)
    assert before < 1.0 and after < 1.0


@pytest.mark.parametrize("target", ["rapid", "krl", "inform", "tp", "rpl"])
def test_a_turning_speed_is_kept(target: str) -> None:
    _, _, _, turned, after = _durations(target)
    assert turned == pytest.approx(2.0, abs=0.15)
    assert after < 1.0


@pytest.mark.parametrize("target", ["vplus", "urscript", "val3"])
def test_a_turning_speed_is_refused(target: str) -> None:
    """At the usual speed of a path the tool would turn as fast as the arm can."""
    read = read_sources([source_from_text("TIMED.LS", PROGRAM)], "tp", Diagnostics())
    lost = translate_program(read, target, ROBOT, None, Diagnostics()).losses
    assert [(item.code.name, item.origin.line) for item in lost] == [("turning-speed-lost", 8)]
