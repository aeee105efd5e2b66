"""Tools and bases whose data stands in `$config.dat` alone are named when that file is not there."""

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text

CONFIG = "DEFDAT $CONFIG\nDECL FRAME BASE_DATA[32]\nBASE_DATA[3]={X 1.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}\nENDDAT\n"

CASES: list[tuple[str, tuple[str, ...], list[str]]] = [
    ("both", ("$BASE=BASE_DATA[3]", "$TOOL=TOOL_DATA[2]"), ["BASE_DATA[3]", "TOOL_DATA[2]"]),
    ("once", ("$BASE=BASE_DATA[3]", "$BASE=BASE_DATA[ 03 ]"), ["BASE_DATA[3]"]),
    ("remark", ("; $BASE=BASE_DATA[3]",), []),
    ("none", ("$TOOL=$NULLFRAME",), []),
    ("set", ("BASE_DATA[3]={X 1,Y 0,Z 0,A 0,B 0,C 0}", "$BASE=BASE_DATA[3]"), []),
    ("set-part", ("BASE_DATA[3].X=5", "$BASE=BASE_DATA[3]"), []),
    ("set-other", ("BASE_DATA[4]={X 1,Y 0,Z 0,A 0,B 0,C 0}", "$BASE=BASE_DATA[3]"), ["BASE_DATA[3]"]),
    ("set-any", ("BASE_DATA[$OV_PRO]={X 1,Y 0,Z 0,A 0,B 0,C 0}", "$BASE=BASE_DATA[3]"), []),
]


def named(*files: tuple[str, str]) -> list[str]:
    found = Diagnostics()
    read_sources([source_from_text(*one) for one in files], "krl", found)
    assert not found.has_errors
    return [str(dict(one.arguments)["name"]) for one in found if one.code.name == "krl-not-given"]


@pytest.mark.parametrize(("lines", "wanted"), [one[1:] for one in CASES], ids=[one[0] for one in CASES])
def test_what_no_file_gives_is_named(lines: tuple[str, ...], wanted: list[str]) -> None:
    assert named(("p.src", "\n".join(("DEF p()", *lines, "END", "")))) == wanted


def test_the_configuration_gives_it() -> None:
    program = "p.src", "DEF p()\n$BASE=BASE_DATA[3]\n$TOOL=TOOL_DATA[2]\nEND\n"
    assert named(program, ("$config.dat", CONFIG)) == ["TOOL_DATA[2]"]


def test_inline_forms_name_them_too() -> None:
    data = 'DEFDAT p\nDECL FDAT FP1={TOOL_NO 1,BASE_NO 0,IPO_FRAME #BASE,POINT2[] " "}\nENDDAT\n'
    assert named(("p.src", "DEF p()\nEND\n"), ("p.dat", data)) == ["TOOL_DATA[1]"]
