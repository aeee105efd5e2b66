"""Registers whose place is changed by components and joint moves to them: KRL's T names the sign of every axis."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.source import source_from_text
from rpl.translation import translate_program

FANUC = "fanuc_lrmate200id"
PROGRAM = """/PROG  MAIN
/MN
   1:  UFRAME_NUM=0 ;
   2:  UTOOL_NUM=0 ;
   3:J P[1] 50% FINE    ;
   4:  PR[1]=LPOS    ;
   5:  PR[2]=PR[1]-PR[1]    ;
   6:  PR[2,2]=(-160)    ;
{body}
/POS
P[1]{{ GP1: UF : 0, UT : 0, CONFIG : 'N U T, 0, 0, 0', X = 400.0 mm, Y = 80.0 mm, Z = 100.0 mm,
 W = 180.0 deg, P = 0.0 deg, R = 0.0 deg }};
P[2]{{ GP1: UF : 0, UT : 0, CONFIG : 'N U T, 0, 0, 0', X = 400.0 mm, Y = 80.0 mm, Z = 60.0 mm,
 W = 180.0 deg, P = 0.0 deg, R = 0.0 deg }};
/END
"""
# Lines, and whether the written move still names the posture.
CASES = [
    ("PR[1,2]=(-80)\nJ PR[1] 50% FINE", False),
    ("PR[3]=PR[1]\nPR[3,2]=PR[3,2]*(-1)\nPR[4]=PR[3]\nJ PR[4] 50% FINE", False),
    ("PR[3]=PR[1]+PR[2]\nJ PR[3] 50% FINE", False),
    ("J PR[1] 50% FINE Offset,PR[2]", False),
    ("J P[2] 50% FINE", True),
    ("J P[2] 50% FINE\nJ PR[1] 50% FINE", True),
]


@pytest.mark.parametrize(("lines", "flags"), CASES, ids=[lines.splitlines()[-1] for lines, _ in CASES])
def test_a_changed_place_is_reached_with_the_posture_there_is(lines: str, flags: bool) -> None:
    body = "\n".join(
        f"{at:4}:{'' if line.startswith('J ') else '  '}{line}    ;" for at, line in enumerate(lines.splitlines(), 7)
    )
    read = read_sources([source_from_text("MAIN.LS", PROGRAM.format(body=body))], "tp", Diagnostics())
    diagnostics = Diagnostics()
    done = translate_program(read, "krl", FANUC, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    assert ("changed-target-nearest" not in {one.code.name for one in diagnostics.of(Severity.INFO)}) == flags
    back = read_sources([source_from_text(one.path, one.data.decode()) for one in done.files], "krl", Diagnostics())
    result = prove_programs(read.program, back.program, FANUC, None)
    assert result.agrees, result.as_text()
