"""Records with arrays in them, in arrays and as parameters and results, for targets without records."""

from __future__ import annotations

import pytest
from there_and_back import entry_of

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

KUKA = "kuka_kr6r900sixx"
DATA = """DEFDAT JOB
STRUC PART_T INT NR,REAL HOLES[3]
DECL PART_T QUEUE[4]
ENDDAT
"""
TEXT = """DEF JOB()
DECL INT I
DECL PART_T ONE
DECL CHAR CODE[8]
FOR I=1 TO 4
  ONE.NR=10*I
  ONE.HOLES[1]=I
  ONE.HOLES[2]=I*1.5
  ONE.HOLES[3]=-I
  QUEUE[I]=ONE
ENDFOR
ONE=QUEUE[2]
$OUT[1]=(ONE.HOLES[2]==3.0) AND (QUEUE[3].HOLES[3]==-3.0)
TURN(QUEUE[3])
$OUT[2]=(QUEUE[3].NR==-30) AND (QUEUE[3].HOLES[1]==-3.0) AND (QUEUE[3].HOLES[3]==3.0) AND (QUEUE[2].HOLES[1]==2.0)
TURN(ONE)
$OUT[3]=(ONE.HOLES[1]==-2.0) AND (QUEUE[2].HOLES[1]==2.0)
QUEUE[4]=MADE(7)
$OUT[4]=(QUEUE[4].NR==7) AND (QUEUE[4].HOLES[2]==14.0)
CODE[]="AB7"
FOR I=1 TO 3
  SWITCH CODE[I]
    CASE "A","7"
      $OUT[4+I]=TRUE
    CASE "B"
      $OUT[4+I]=(I==2)
  ENDSWITCH
ENDFOR
END
DEF TURN(P_:OUT)
DECL PART_T P_
DECL REAL H
P_.NR=-P_.NR
H=P_.HOLES[1]
P_.HOLES[1]=P_.HOLES[3]
P_.HOLES[3]=H
END
DEFFCT PART_T MADE(N_:IN)
DECL INT N_,J
DECL PART_T R_
R_.NR=N_
FOR J=1 TO 3
  R_.HOLES[J]=N_*J
ENDFOR
RETURN R_
ENDFCT
"""


@pytest.mark.parametrize("target", ["tp", "inform", "vplus", "urscript", "rapid"])
def test_records_with_arrays_keep_their_values(target: str) -> None:
    files = [source_from_text("job.src", TEXT), source_from_text("job.dat", DATA)]
    read = read_sources(files, "krl", Diagnostics())
    told, again = Diagnostics(), Diagnostics()
    written = translate_program(read, target, KUKA, None, told)
    losses = [item.as_text() for item in told.of(Severity.LOSS) if item.code.name != "tp-text-case"]
    assert not losses
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, again)
    assert not [item.as_text() for item in again.of(Severity.ERROR)]
    result = prove_programs(read.program, back.program, KUKA, entry="JOB", to_entry=entry_of(written, "JOB"))
    assert result.agrees, result.as_text()
