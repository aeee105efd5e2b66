"""What a move in RAPID is driven with: predefined words and named data, and no numbers in the move."""

from __future__ import annotations

import re

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

HOME = "PTP {A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}"
DATA = """DEFDAT m
DECL FRAME GRIPPER={X 0,Y 0,Z 120,A 0,B 0,C 0}
DECL FRAME TABLE={X 400,Y 0,Z 100,A 0,B 0,C 0}
DECL E6POS XP={X 50,Y 0,Z 300,A 0,B 90,C 0}
ENDDAT
"""


def written(*lines: str, more: str = "") -> tuple[str, list[str]]:
    """The text for the routine with these lines, and the codes of what was said."""
    files = {"m.src": "\n".join(("DEF m()", *lines, "END", more)), "m.dat": DATA}
    found = Diagnostics()
    read = read_sources([source_from_text(name, text) for name, text in files.items()], "krl", found)
    done = translate_program(read, "rapid", "kuka_kr6r900sixx", None, found)
    return "\n".join(file.data.decode() for file in done.files), [item.code.name for item in found]


def moves(text: str) -> list[str]:
    return [re.sub(r"^Move\w+ .*?,(?=[vz]\w)", "", line.strip()) for line in text.splitlines() if " Move" in line]


@pytest.mark.parametrize(
    ("settings", "move", "head"),
    [
        ("$VEL.CP=0.3", "v300,fine,tool0;", ""),
        ("$VEL.CP=0.302", "v300,fine,tool0;", ""),
        ("$VEL.CP=0.35", "v350,fine,tool0;", "CONST speeddata v350:=[350,500,5000,1000];"),
        ("$VEL.CP=0.3\n$VEL.ORI1=20", "v300_20,fine,tool0;", "CONST speeddata v300_20:=[300,20,5000,1000];"),
        ("$VEL.CP=0.3\n$VEL.ORI1=200", "v300,fine,tool0;", ""),
        ("$VEL.CP=0.3\n$TOOL=GRIPPER", "v300,fine,GRIPPER;", "tooldata GRIPPER:=[TRUE,[[0,0,120],"),
        ("$VEL.CP=0.3\n$BASE=TABLE", "v300,fine,tool0\\WObj:=TABLE;", 'wobjdata TABLE:=[FALSE,TRUE,"",[[400,0,100],'),
        ("$VEL.CP=0.3\n$BASE=TABLE\n$BASE=$NULLFRAME", "v300,fine,tool0;", ""),
        ("$VEL.CP=0.3\n$TOOL={X 0,Y 0,Z 80,A 0,B 0,C 0}", "v300,fine,tool1;", "tooldata tool1:=[TRUE,[[0,0,80],"),
    ],
)
def test_what_is_known_is_a_word_of_the_move(settings: str, move: str, head: str) -> None:
    text, _ = written(HOME, settings, "LIN XP", "LIN XP")
    assert moves(text) == ["vmax,fine,tool0;", move, move], text
    assert head in text and not re.search(r"(tframe|uframe|v_tcp|v_ori):=", text), text


def test_a_corner_of_a_size_of_its_own_is_data_with_a_name() -> None:
    text, _ = written(HOME, "$VEL.CP=0.3", "$APO.CDIS=25", "LIN XP C_DIS", "$APO.CDIS=50", "LIN XP C_DIS", "LIN XP")
    assert moves(text)[1:] == ["v300,z25,tool0;", "v300,z50,tool0;", "v300,fine,tool0;"]
    assert text.count("zonedata") == 1


def test_what_is_rounded_is_said() -> None:
    assert "nearest-predefined" in written(HOME, "$VEL.CP=0.302", "LIN XP")[1]
    assert "nearest-predefined" not in written(HOME, "$VEL.CP=0.3", "LIN XP")[1]


def test_a_tool_that_the_run_decides_is_a_variable() -> None:
    lines = ("IF $IN[1] THEN", "$TOOL=GRIPPER", "ELSE", "$TOOL=$NULLFRAME", "ENDIF", "LIN XP")
    text, _ = written(HOME, *lines)
    assert moves(text)[-1].endswith(",fine,tCurrent;") and text.count("tCurrent.tframe:=") == 2, text
