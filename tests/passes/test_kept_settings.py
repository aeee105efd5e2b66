"""Settings of the motion that a program reads back, in targets that have no word to ask for them."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import entry_name, run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

KUKA = "kuka_kr6r900sixx"
READ = """DEF JOB()
DECL INT I,A
DECL FRAME F,G
DECL REAL V,W[6]
A=$ADVANCE
BAS(#INITMOV,0)
$ACC.CP=1.5
V=$ACC.CP
$ACC.CP=V/3
PTP {A1 1.0,A2 -90.0,A3 90.0,A4 0.0,A5 10.0,A6 0.0}
FOR I=1 TO 6
  $VEL_AXIS[I]=60
ENDFOR
FOR I=1 TO 6
  W[I]=$VEL_AXIS[I]
  $VEL_AXIS[I]=W[I]/2
ENDFOR
PTP {A1 3.0}
$VEL.ORI1=120.0
$OUT[1]=(A==0) AND ($ADVANCE==3)
$OUT[2]=(ABS(V-1.5)<0.0001) AND (ABS($ACC.CP-0.5)<0.0001)
$OUT[3]=(W[2]==60.0) AND ($VEL_AXIS[4]==30)
$OUT[4]=$VEL.ORI1==120.0
CHANGE()
$OUT[5]=$ACC_AXIS[2]==70
FOR I=1 TO 3
  $BASE.Y=I*10.0
ENDFOR
$BASE.Z=5.0
$OUT[6]=($BASE.Y==30.0) AND ($BASE.Z==5.0) AND ($BASE.X==0.0)
$ACC.CP=$ACC.CP*2
$OUT[7]=ABS($ACC.CP-1.0)<0.0001
F=$POS_ACT
$BASE=$BASE:{X 4.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}
G=$POS_ACT
$OUT[8]=($BASE.X==4.0) AND (ABS(F.X-G.X-4.0)<0.01)
END
DEF CHANGE()
$ACC_AXIS[2]=$ACC_AXIS[1]+20
END
"""


@pytest.mark.parametrize("target", ["rapid", "tp", "urscript", "vplus", "inform", "rpl"])
def test_a_setting_is_what_was_set_last(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("job.src", READ)], "krl", diagnostics)
    translation = translate_program(read, target, KUKA, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, Diagnostics())
    entry = entry_name(read.program, None)
    result = run_program(back.program, KUKA, None, translation.renamed.get(entry, entry) if entry else None, 20.0)
    assert result.status == "finished", result.fault
    assert [value for _, _, value in result.outputs] == [True] * 8
