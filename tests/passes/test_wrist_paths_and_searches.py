"""FANUC moves whose wrist goes evenly (Wjnt), and searches whose condition holds before the move begins."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.proof.prove import ProofResult, prove_programs
from rpl.proof.wiring import with_signal_names
from rpl.simulation import entry_name
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ROBOT = "fanuc_lrmate200id"
HEAD = "/PROG  WAY\n/ATTR\nDEFAULT_GROUP = 1,*,*,*,*;\n/MN\n"
POINT = """P[{n}]{{
   GP1:
	UF : 0, UT : 1,	CONFIG : 'N U T, 0, 0, 0',
	X = {x}  mm,	Y = {y}  mm,	Z = 200.000  mm,
	W = 180.000 deg,	P = 0.000 deg,	R = 0.000 deg
}};
"""
POINTS = "/POS\n" + POINT.format(n=1, x="400.0", y="0.0") + POINT.format(n=2, x="400.0", y="100.0") + "/END\n"
WRIST = """   1:J P[1] 100% FINE ;
   2:L P[2] 100mm/sec FINE Wjnt ;
   3:  DO[1]=ON ;
"""
ALREADY = """   1:J P[1] 100% FINE ;
   2:  R[1]=1 ;
   3:  SKIP CONDITION R[1]=1 OR DI[3]=ON ;
   4:L P[2] 100mm/sec FINE Skip,LBL[1],PR[2]=LPOS ;
   5:  DO[1]=ON ;
   6:  LBL[1] ;
   7:  R[1]=0 ;
   8:L P[2] 100mm/sec FINE Skip,LBL[2] ;
   9:  DO[2]=ON ;
  10:  LBL[2] ;
"""


def _proved(lines: str, target: str) -> tuple[ProofResult, list[str]]:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("WAY.LS", HEAD + lines + POINTS)], "tp", diagnostics)
    translation = translate_program(read, target, ROBOT, None, diagnostics)
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, diagnostics)
    assert not diagnostics.has_errors
    assert not translation.losses
    named = with_signal_names(back.program, translation.program)
    result = prove_programs(read.program, named, ROBOT, entry="WAY", to_entry=entry_name(named))
    return result, [item.code.name for item in diagnostics]


@pytest.mark.parametrize("target", ["rapid", "krl", "tp", "urscript", "vplus", "inform", "rpl"])
def test_the_tool_goes_the_same_way_and_may_turn_otherwise(target: str) -> None:
    result, codes = _proved(WRIST, target)
    evenly = target in ("rapid", "urscript", "vplus", "inform")
    assert ("wrist-path-turned" in codes) == evenly
    assert result.level == "events" if evenly else result.agrees
    assert result.max_path_mm < 0.01


@pytest.mark.parametrize("target", ["krl", "tp", "urscript", "vplus", "rpl"])
def test_there_is_no_move_where_the_condition_holds_at_once(target: str) -> None:
    result, _ = _proved(ALREADY, target)
    assert result.agrees
