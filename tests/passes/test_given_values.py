"""Data that only a controller keeps, with the values of a cell file: other controllers begin with them."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.cell.cellfile import parse_cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.passes.given import with_given
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

JOB = """/JOB
//NAME GLUE
//POS
///NPOS 1,0,0,0,0,0
///USER 1
///TOOL 2
///POSTYPE USER
///RECTAN
///RCONF 0,0,0,0,0,0
C00000=0.000,0.000,80.000,180.0000,0.0000,0.0000
//INST
///DATE 2024/05/06 09:30
///ATTR SC,RW,RJ
////FRAME USER 1
///GROUP1 RB1
NOP
MOVJ C00000 VJ=10.00 PL=0
ADD D000 5
DOUT OT#(1) ON IF D000=12
END
"""
CELL = """[variables]
UF1 = { x = 400.0, y = -50.0, z = 200.0, a = 0.0, b = 0.0, c = 0.0 }
TL2 = { x = 0.0, y = 0.0, z = 90.0, a = 0.0, b = 0.0, c = 0.0 }
D000 = 7
"""
LISTING = """/PROG  GLUE
/MN
   1:  UFRAME_NUM=2 ;
   2:  UTOOL_NUM=1 ;
   3:J P[1] 10% FINE ;
   4:  IF R[1]=3,JMP LBL[1] ;
   5:  DO[1]=ON ;
   6:  LBL[1] ;
/POS
P[1]{
   GP1:
	UF : 2, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =     0.000  mm,	Y =     0.000  mm,	Z =    80.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
/END
"""
NUMBERED = """[variables]
"UFRAME[2]" = { x = 400.0, y = -50.0, z = 200.0, a = 0.0, b = 0.0, c = 0.0 }
"UTOOL[1]" = { x = 0.0, y = 0.0, z = 90.0, a = 0.0, b = 0.0, c = 0.0 }
R1 = 4
"""
SOURCES = {"inform": ("job.jbi", JOB, CELL, "motoman_gp7"), "tp": ("glue.ls", LISTING, NUMBERED, "fanuc_lrmate200id")}


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "urscript", "vplus", "inform", "rpl"])
@pytest.mark.parametrize("language", SOURCES)
def test_another_controller_drives_to_the_same_place(language: str, target: str) -> None:
    name, text, described, robot = SOURCES[language]
    cell, diagnostics = parse_cell(described), Diagnostics()
    read = read_sources([source_from_text(name, text)], language, diagnostics)
    written = translate_program(read, target, robot, None, diagnostics, given=cell.variables)
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    again = Diagnostics()
    back = read_sources([source_from_bytes(file.path, file.data) for file in written.files], target, again)
    entry = written.renamed.get("GLUE", "GLUE")
    result = prove_programs(read.program, back.program, robot, robot, cell, entry="GLUE", to_entry=entry)
    assert result.agrees, result.as_text()


@pytest.mark.parametrize(
    ("value", "begins"),
    [
        (7, ir.IntLiteral(7)),
        (True, None),
        ("seven", None),
        ({"x": 1.0}, None),
    ],
)
def test_only_a_value_of_the_right_shape_is_taken(value: object, begins: ir.Expression | None) -> None:
    count = ir.Variable("count", ir.IntType(), None, "persistent")
    program = ir.Program((ir.Module("data", "rpl", (count,)),))
    (found,) = with_given(program, {"data.COUNT": value}).modules[0].declarations
    assert isinstance(found, ir.Variable) and found.initial == begins


def test_what_the_program_sets_by_itself_stays() -> None:
    own = ir.Variable("count", ir.IntType(), ir.IntLiteral(1), "variable")
    fixed = ir.Variable("size", ir.IntType(), ir.IntLiteral(2), "constant")
    program = ir.Program((ir.Module("data", "rpl", (own, fixed)),))
    assert with_given(program, {"count": 5, "size": 6, "other[1]": 3}) is program
