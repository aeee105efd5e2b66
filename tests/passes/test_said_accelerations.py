"""Moves for a target that says accelerations in numbers have those of the source's controller."""

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

TP = """/PROG  MAIN
/MN
{lines}
/POS
P[1]{{
   GP1:
	UF : 0, UT : 1,
	J1= 0.000 deg,	J2= 0.000 deg,	J3= 0.000 deg,
	J4= 0.000 deg,	J5= -90.000 deg,	J6= 0.000 deg
}};
P[2]{{
   GP1:
	UF : 0, UT : 1,	CONFIG : 'N U T, 0, 0, 0',
	X = 420.000 mm,	Y = 0.000 mm,	Z = -60.000 mm,
	W = 180.000 deg,	P = 0.000 deg,	R = 0.000 deg
}};
/END
"""
RAPID = """MODULE M
CONST robtarget p:=[[600,0,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
VAR num n:=50;
PROC main()
{lines}
ENDPROC
ENDMODULE
"""
KRL = """DEF M()
DECL E6POS P={{X 500,Y 0,Z 500,A 0,B 90,C 0}}
{lines}
END
"""


def moves(source: str, text: str, arm: str | None) -> tuple[list[str], list[str]]:
    """Settings of each move, and the codes of the reports that matter."""
    names = {"tp": "MAIN.LS", "rapid": "M.mod", "krl": "M.src"}
    read = read_sources([source_from_text(names[source], text)], source, Diagnostics())
    diagnostics = Diagnostics()
    files = translate_program(read, "urscript", arm, None, diagnostics).files
    lines = [line.strip() for file in files for line in file.data.decode().splitlines()]
    found = [line for line in lines if line.startswith(("movej(", "movel("))]
    settings = [", ".join(part for part in line[:-1].split(", ") if part[:2] in ("a=", "v=", "t=")) for line in found]
    codes = {item.code.name for item in diagnostics} & {"accelerations-of-source", "dropped-setting"}
    return settings, sorted(codes)


@pytest.mark.parametrize(
    ("line", "settings"),
    [
        ("J P[1] 100% FINE", "a=22.1076, v=6.6323"),
        ("J P[1] 100% FINE ACC50", "a=11.0537, v=6.6323"),
        ("L P[2] 500mm/sec FINE", "a=5, v=0.5"),
        ("L P[2] 500mm/sec CNT50 ACC20", "a=1, v=0.5"),
        ("L P[2] 500mm/sec FINE ACC24", "v=0.5"),  # what the target takes anyway
        ("L P[2] 500mm/sec FINE ACC R[1]", "a=(r1 * 50.0) / 1000.0, v=0.5"),
        ("L P[2] 2.0sec FINE", "t=2"),  # a time needs none
    ],
)
def test_moves_have_the_acceleration_of_their_own_controller(line: str, settings: str) -> None:
    found, codes = moves("tp", TP.format(lines=f"   1:  R[1]=20 ;\n   2:{line} ;"), "fanuc_lrmate200id")
    assert found == [settings]
    assert codes == (["accelerations-of-source"] if "a=" in settings else [])


def test_without_an_arm_the_axes_have_the_usual_one() -> None:
    assert moves("tp", TP.format(lines="   1:J P[1] 100% FINE ;"), None) == (["v=3.1416"], [])
    assert moves("tp", TP.format(lines="   1:J P[1] 100% FINE ACC50 ;"), None)[1] == ["dropped-setting"]


@pytest.mark.parametrize(
    ("lines", "settings"),
    [
        ("MoveL p,v100,fine,tool0;", "a=5, v=0.1"),
        ("AccSet 50,100;\nMoveL p,v100,fine,tool0;", "a=2.5, v=0.1"),
        ("AccSet n,100;\nMoveL p,v100,fine,tool0;", "a=(n * 50.0) / 1000.0, v=0.1"),
        ("IF n>1 AccSet 20,100;\nMoveL p,v100,fine,tool0;", "v=0.1"),
    ],
)
def test_percent_for_all_moves(lines: str, settings: str) -> None:
    found, codes = moves("rapid", RAPID.format(lines=lines), "abb_irb1200_5_90")
    assert found == [settings]
    assert ("accelerations-of-source" in codes) == ("a=" in settings)


def test_accelerations_that_are_set() -> None:
    lines = "$ACC.CP=2.3\nLIN P\n$ACC_AXIS[1]=50\nPTP P"
    found, _ = moves("krl", KRL.format(lines=lines), "kuka_kr6r900sixx")
    assert [one.split(",")[0] for one in found] == ["a=2.3", "a=8.7266"]
