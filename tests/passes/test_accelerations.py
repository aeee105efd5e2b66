"""The acceleration of single moves where accelerations are modal; what only tunes the source's controller."""

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

LISTING = """/PROG  MAIN
/MN
   1:  PAYLOAD[1] ;
   2:J P[1] 50% FINE ACC80 ;
   3:J P[2] 50% FINE ACC80 ;
   4:  R[1]=1 ;
   5:L P[1] 100mm/sec FINE ACC60 ;
   6:J P[2] 50% FINE ;
   7:  IF R[1]=1,CALL SUB ;
   8:J P[1] 50% FINE ACC50 ;
/POS
P[1]{
   GP1:
	UF : 0, UT : 1,
	J1= 0.000 deg,	J2= 0.000 deg,	J3= 0.000 deg,
	J4= 0.000 deg,	J5= -90.000 deg,	J6= 0.000 deg
};
P[2]{
   GP1:
	UF : 0, UT : 1,
	J1= 10.000 deg,	J2= 0.000 deg,	J3= 0.000 deg,
	J4= 0.000 deg,	J5= -90.000 deg,	J6= 0.000 deg
};
/END
"""
SUB = "/PROG  SUB\n/MN\n   1:  R[2]=1 ;\n/POS\n/END\n"


def written(target: str, wanted: str) -> tuple[list[str], list[str]]:
    """Lines of the main program that hold the word, and the codes of all reports."""
    sources = [source_from_text("MAIN.LS", LISTING), source_from_text("SUB.LS", SUB)]
    read = read_sources(sources, "tp", Diagnostics())
    diagnostics = Diagnostics()
    files = translate_program(read, target, "fanuc_lrmate200id", None, diagnostics).files
    lines = [line.strip() for file in files for line in file.data.decode("latin-1").splitlines()]
    codes = [item.code.name for item in diagnostics if item.severity.word in ("warning", "loss")]
    return [line for line in lines if wanted in line], codes


def test_a_percentage_for_all_moves_is_set_around_them() -> None:
    lines, codes = written("rapid", "AccSet")
    assert lines == ["AccSet 80,100;", "AccSet 60,100;", "AccSet 100,100;", "AccSet 50,100;", "AccSet 100,100;"]
    assert not [name for name in codes if "guarded" in name or name == "not-written"]


def test_braking_goes_with_it_where_a_target_has_both() -> None:
    found = [f"ACCEL {value}, {value}" for value in (80, 60, 100, 50, 100)]
    assert written("vplus", "ACCEL")[0] == ["DISABLE SCALE.ACCEL", *found]


def test_axes_and_path_have_accelerations_of_their_own() -> None:
    assert written("krl", "$ACC_AXIS[1]")[0] == [f"$ACC_AXIS[1]={value}" for value in ("80", "100.0", "50", "100.0")]
    assert written("krl", "$ACC.CP")[0] == ["$ACC.CP=3.0", "$ACC.CP=5.0"]


def test_what_only_tunes_the_controller_stays_as_a_remark() -> None:
    lines, codes = written("rapid", "PAYLOAD")
    assert lines == ["! left out: PAYLOAD[1]"]
    assert "tuning-left-out" in codes


def test_a_straight_move_to_joints_goes_to_their_place() -> None:
    assert written("krl", "LIN")[0] == ["LIN rpl_target_of_joints(P1)"]
    (line,) = written("rapid", "MoveL")[0]
    assert line.startswith("MoveL CalcRobT(MAIN_P1,")
