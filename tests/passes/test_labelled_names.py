"""Comments of numbered variables as names: `R[1:count]` is `count` where variables have names."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

POINT = """P[{number}:"{label}"]{{
   GP1:
  UF : 0, UT : 1,  CONFIG : 'N U T, 0, 0, 0',
  X =  400.000 mm, Y = {number}0.000 mm, Z = 300.000 mm, W = 180.000 deg, P = 0.000 deg, R = 0.000 deg
}};
"""


def written(body: str, target: str, points: tuple[tuple[int, str], ...] = ()) -> str:
    listed = "".join(POINT.format(number=number, label=label) for number, label in points)
    text = f"/PROG MAIN\n/ATTR\n/MN\n{body}\n/POS\n{listed}/END\n"
    read = read_sources([source_from_text("main.ls", text)], "tp", Diagnostics())
    done = translate_program(read, target, "fanuc_m10ia", None, Diagnostics())
    return "\n".join(file.data.decode("latin-1") for file in done.files)


@pytest.mark.parametrize(
    ("target", "declared", "used"),
    [
        ("rapid", "PERS num count:=0; !R7", "count:=count+1;"),
        ("krl", "DECL GLOBAL INT count=0 ;R7", "count=count+1"),
        ("urscript", "global count = 0  # R7", "count = count + 1"),
        ("vplus", "", "count = count+1"),
    ],
)
def test_a_register_has_the_name_that_its_comment_says(target: str, declared: str, used: str) -> None:
    text = written("1: R[7:count]=0;\n2: R[7:count]=R[7:count]+1;", target)
    assert used in text and declared in text, text


@pytest.mark.parametrize("label", ["parts done", "1st", "naar-links"])
def test_a_comment_that_is_no_word_stays_a_remark(label: str) -> None:
    text = written(f"1: R[7:{label}]=0;\n2: R[7:{label}]=R[7:{label}]+1;", "rapid")
    assert f"PERS num R7:=0; !{label}" in text and "R7:=R7+1;" in text, text


def test_two_registers_with_one_comment_keep_their_numbers() -> None:
    text = written("1: R[7:count]=1;\n2: R[8:count]=R[7:count]+1;", "rapid")
    assert "R8:=R7+1;" in text, text


def test_a_name_that_the_program_has_already_is_not_given_again() -> None:
    text = written("1: R[7:main]=1;\n2: R[7:main]=R[7:main]+1;", "rapid")
    assert "R7:=R7+1;" in text, text


def test_points_have_the_names_of_their_comments() -> None:
    body = "1: UFRAME_NUM=0;\n2: UTOOL_NUM=1;\n3:J P[3:above] 100% FINE;\n4:L P[1] 500mm/sec FINE;"
    text = written(body, "rapid", ((3, "above"), (1, "")))
    assert "LOCAL CONST robtarget above:=[[400,30,300]" in text, text
    assert "MoveJ above," in text and "MoveL P1," in text, text


def test_an_element_of_a_position_register_carries_the_registers_comment() -> None:
    text = written("1: PR[5:pick]=LPOS;\n2: PR[5,3:pick]=PR[5,3:pick]+100;", "rapid")
    assert "pick.trans.z:=pick.trans.z+100;" in text and "PR3" not in text, text


def test_targets_with_numbers_keep_them() -> None:
    text = written("1: R[7:count]=0;\n2: R[7:count]=R[7:count]+1;", "inform")
    assert "count" not in text.replace("'", ""), text


def test_flags_have_the_names_of_their_comments() -> None:
    text = written("1: F[1:ready]=(OFF);\n2: F[2:part ok]=(ON);\n3: WAIT (F[1:ready]);", "krl")
    assert "DECL GLOBAL BOOL ready=FALSE" in text and "ready=FALSE" in text and "WAIT FOR ready" in text, text
    assert "$FLAG[2]=TRUE" in text, text


def test_flags_that_the_run_chooses_keep_their_numbers() -> None:
    text = written("1: F[1:ready]=(OFF);\n2: R[1]=1;\n3: F[R[1]]=(ON);", "krl")
    assert "$FLAG[1]=FALSE" in text, text
