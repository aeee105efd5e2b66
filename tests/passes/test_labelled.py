"""What registers are called in their controller stands beside the variables that they become."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

PROGRAM = """/PROG  PICK
/ATTR
/MN
   1:  R[7]=DI[1] ;
   2:  R[6:height of part]=R[7]+20 ;
   3:J PR[3:above the table] 50% FINE ;
   4:  DO[1]=(R[6]>5) ;
/POS
/END
"""
SHOWN = {
    "rapid": ("num R6:=0; !height of part", "robtarget PR3; !above the table"),
    "krl": ("R6=0 ;height of part", "PR3 ;above the table"),
    "urscript": ("r6 = 0.0  # height of part", "# above the table"),
    "vplus": ("; r6: height of part", "; pr3: above the table"),
    "inform": (),
}


@pytest.mark.parametrize("target", SHOWN)
def test_the_name_stands_beside(target: str) -> None:
    read = read_sources([source_from_text("pick.ls", PROGRAM)], "tp", Diagnostics())
    files = translate_program(read, target, None, None, Diagnostics()).files
    written = "\n".join(file.data.decode("latin-1") for file in files)
    assert all(one in written for one in SHOWN[target]), written
