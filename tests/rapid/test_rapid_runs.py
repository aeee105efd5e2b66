"""RAPID programs that switch an output when an expectation of the manuals holds: what runs, beyond what is read."""

from __future__ import annotations

import pytest
from rapid_helpers import read_back

from rpl.diagnostics import Diagnostics
from rpl.passes.typing import normalise
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_text

ABB = "abb_irb1200_5_90"
HEAD = """MODULE checks
  VAR intnum seen;
  VAR triggdata gun;
  VAR num n:=0;
  VAR byte mask:=170;
  VAR pose fr;
  VAR pos at;
  CONST robtarget p1:=[[450,0,350],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  TRAP tCount
    n:=n+1;
  ENDTRAP
  PROC main()
"""
TAIL = """
  ENDPROC
ENDMODULE
"""
# name, body, robot. Each sets do1 when it holds.
CASES = [
    # TriggInt orders the interrupt by itself, there is no ISignalDI (RAPID reference: TriggInt).
    (
        "a trap at a place of the path",
        """MoveJ p1,v500,fine,tool0; CONNECT seen WITH tCount; TriggInt gun,30,seen;
        TriggL Offs(p1,0,0,-100),v200,gun,fine,tool0; WaitTime 0.1; IF n=1 SetDO do1,1;""",
        ABB,
    ),
    (
        "no trap while it sleeps",
        """MoveJ p1,v500,fine,tool0; CONNECT seen WITH tCount; TriggInt gun,30,seen; ISleep seen;
        TriggL Offs(p1,0,0,-100),v200,gun,fine,tool0; WaitTime 0.1; IF n=0 SetDO do1,1;""",
        ABB,
    ),
    # Bits of a byte are counted from 1, the least one (RAPID reference, BitCheck and its kin).
    ("bits are asked", "IF BitCheck(mask,2) AND NOT BitCheck(mask,1) AND BitCheck(mask,8) SetDO do1,1;", None),
    (
        "a frame by places that are written out",
        """fr:=DefFrame([[10,20,30],p1.rot,p1.robconf,p1.extax],Offs(p1,-440,120,-320),p1\\Origin:=1);
        fr:=DefFrame([[10,20,30],[1,0,0,0],[0,0,0,0],p1.extax],[[10,120,30],[1,0,0,0],[0,0,0,0],p1.extax],
        [[-50,20,30],[1,0,0,0],[0,0,0,0],p1.extax]); at:=PoseVect(fr,[5,0,2]);
        IF Distance(at,[10,25,32])<0.01 AND Abs(EulerZYX(\\Z,fr.rot)-90)<0.01 SetDO do1,1;""",
        None,
    ),
    ("bits are set and cleared", "BitSet mask,1; BitClear mask,8; IF mask=43 SetDO do1,1;", None),
    # StrToByte and ByteToStr with \\Char are the code of a character and back (RAPID reference).
    ("characters", 'IF StrToByte("A"\\Char)=65 AND ByteToStr(66\\Char)="B" AND StrToByte("12")=12 SetDO do1,1;', None),
    ("bits leave a byte", "IF BitLSh(mask,1)=84 AND BitRSh(mask,1)=85 AND BitNeg(mask)=85 SetDO do1,1;", None),
]


@pytest.mark.parametrize(("name", "body", "robot"), CASES, ids=[case[0] for case in CASES])
def test_it_holds(name: str, body: str, robot: str | None) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("checks.mod", HEAD + body + TAIL)], "rapid", diagnostics)
    assert not [item.as_text() for item in diagnostics]
    for program in (read.program, read_back(normalise(read.program, diagnostics))):  # and when it is written anew
        result = run_program(program, robot)
        assert (result.status, [each[1:] for each in result.outputs]) == ("finished", [("do1", True)])
