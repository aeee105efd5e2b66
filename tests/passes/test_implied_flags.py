"""Postures of the arm at places that are known only in a run: what the flags say by themselves is kept."""

from __future__ import annotations

import numpy as np
import pytest

from rpl import registry
from rpl.diagnostics import Diagnostics
from rpl.emulator.model import load_robot
from rpl.passes.legalise.places.postures.impliedflags import implied_flags
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

FANUC = "fanuc_lrmate200id"
WRISTS = """/PROG  WRISTS
/MN
   1:  PR[1]=LPOS ;
   2:  PR[1]=PR[1]-PR[1] ;
   3:  R[8]=0 ;
   3:  IF DI[9]=OFF,JMP LBL[7] ;
   3:  R[8]=1 ;
   3:  LBL[7] ;
   3:  PR[1,1]=350+R[8] ;
   4:  UFRAME[R[1]]=PR[1] ;
   5:  UFRAME_NUM=R[1] ;
   6:J P[1] 50% FINE    ;
   7:  PR[2]=JPOS ;
   8:J P[2] 50% FINE    ;
   9:  PR[3]=JPOS ;
  10:  DO[1]=(PR[2,5]<(-5) AND PR[3,5]>5) ;
/POS
P[1]{ GP1: UF : 2, UT : 0, CONFIG : 'N U T, 0, 0, 0', X = 50 mm, Y = 20 mm, Z = 160 mm, W = 170 deg, P = 20 deg,
 R = 0 deg };
P[2]{ GP1: UF : 2, UT : 0, CONFIG : 'F U T, 0, 0, 0', X = 50 mm, Y = 20 mm, Z = 160 mm, W = 170 deg, P = 20 deg,
 R = 0 deg };
/END
"""


def written(target: str) -> tuple[dict[str, str], list[str]]:
    start = WRISTS.replace("   1:  PR[1]", "   1:  R[1]=2 ;\n   1:  PR[1]")
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("WRISTS.LS", start)], "tp", Diagnostics())
    done = translate_program(read, target, FANUC, None, diagnostics)
    back = read_sources([source_from_bytes(f.path, f.data) for f in done.files], target, Diagnostics())
    run = run_program(back.program, FANUC, None, done.renamed.get("WRISTS", "WRISTS"), 60.0)
    assert [each[2] for each in run.outputs] == [True]
    return {f.path: f.data.decode() for f in done.files}, [item.code.name for item in diagnostics]


def test_krl_gets_the_status_and_no_turns() -> None:
    files, codes = written("krl")
    assert "S 2}" in files["WRISTS.dat"] and "S 6}" in files["WRISTS.dat"]
    assert codes.count("configuration-without-turns") == 2 and "configuration-not-converted" not in codes


def test_inform_gets_all_it_says_without_the_place() -> None:
    files, _ = written("inform")
    assert "///RCONF 0,0" in files["WRISTS.JBI"] and "///RCONF 1,0" in files["WRISTS.JBI"]


@pytest.mark.parametrize(("flip", "status"), [(0, 2), (1, 6)])
def test_what_is_equal_wherever_the_arm_is(flip: int, status: int) -> None:
    arm = load_robot(FANUC)
    tp, krl = (registry.dialect(name).notation for name in ("tp", "krl"))
    assert tp is not None and krl is not None
    joints = np.array([1.0, 5.0, -20.0, 3.0, 60.0 if flip else -60.0, 2.0])
    shown = tp().encode(arm, joints)
    found = implied_flags(arm, tp(), shown, krl(), {})
    assert found == {"s": status}
    assert implied_flags(arm, tp(), shown, krl(), {(arm.name, "tp", "krl", tuple(sorted(shown.items()))): {}}) == {}
