"""Names and numbers that a map keeps: the same bytes from the same source, and no change where the source grows."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import Translation, translate_program
from rpl.writing.namemap import NameMap, map_text, parse_map

TARGETS = ("tp", "inform", "rapid", "krl", "urscript", "vplus", "val3")
KRL = """DEF station()
DECL INT box_count
DECL REAL heights[3]
DECL E6POS pick
SIGNAL grip $OUT[5]
{data}
pick={{X 500,Y 0,Z 600,A 0,B 90,C 0}}
{first}
box_count=1
heights[2]=2.5
$OUT[7]=FALSE
put_it_down_on_the_table()
PTP {{X 500,Y 0,Z 600,A 0,B 90,C 0}}
LIN {{X 500,Y 100,Z 600,A 0,B 90,C 0}}
LIN pick
grip=TRUE
box_count=box_count+1
END
DEF put_it_down_on_the_table()
DECL INT tries
tries=3
LIN {{X 400,Y 100,Z 500,A 0,B 90,C 0}}
tries=tries+1
END
"""
RAPID = """MODULE station
{data}
CONST robtarget pPick:=[[500,0,600],[0.7071068,0,0.7071068,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget pPlace:=[[500,100,600],[0.7071068,0,0.7071068,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
PERS num nBoxes:=3;
PROC main()
VAR num nTry;
{first}
nTry:=nBoxes;
MoveJ pPick,v1000,fine,tool0;
MoveL pPlace,v200,z10,tool0;
SetDO doGrip,1;
WaitDI diClosed,1;
nBoxes:=nTry+1;
PutItDownOnTheTable;
ENDPROC
PROC PutItDownOnTheTable()
MoveL pPick,v200,fine,tool0;
SetDO doBlow,1;
ENDPROC
ENDMODULE
"""
CASES = {
    "krl": (KRL, "DECL INT added", "added=7\nLIN {X 450,Y 50,Z 600,A 0,B 90,C 0}\nadded=added+1\n$OUT[3]=TRUE"),
    "rapid": (
        RAPID,
        "CONST robtarget pAdded:=[[450,0,600],[0.7071068,0,0.7071068,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
        "PERS num nAdded:=7;",
        "nAdded:=nAdded+1;\nMoveJ pAdded,v1000,fine,tool0;\nSetDO doAdded,1;\nWaitDI diAdded,1;",
    ),
}


def translated(dialect: str, grown: bool, target: str, earlier: NameMap) -> Translation:
    text, data, first = CASES[dialect]
    text = text.format(data=data if grown else "", first=first if grown else "")
    suffix = {"krl": "src", "rapid": "mod"}[dialect]
    read = read_sources([source_from_text(f"station.{suffix}", text)], dialect, Diagnostics())
    return translate_program(read, target, diagnostics=Diagnostics(), earlier=earlier)


PAIRS = [(dialect, target) for dialect in CASES for target in TARGETS if target != dialect]


@pytest.mark.parametrize(("dialect", "target"), PAIRS)
def test_the_map_of_a_translation_changes_nothing(dialect: str, target: str) -> None:
    first = translated(dialect, False, target, NameMap())
    again = translated(dialect, False, target, parse_map(map_text(first.map)))
    assert again.files == first.files
    assert map_text(again.map) == map_text(first.map)


@pytest.mark.parametrize(("dialect", "target"), PAIRS)
def test_names_and_numbers_stay_where_the_source_grows_in_front(dialect: str, target: str) -> None:
    first = translated(dialect, False, target, NameMap()).map
    grown = translated(dialect, True, target, parse_map(map_text(first))).map
    assert {name: grown.names[name] for name in first.names} == first.names
    assert {at: grown.numbers[at] for at in first.numbers} == first.numbers
    assert len(grown.names) + len(grown.numbers) > len(first.names) + len(first.numbers)


def test_short_names_stay_with_their_routines() -> None:
    """Names of eight signs are cut: the first that comes would get the plain one."""
    text = "DEF first()\nput_down_the_box()\nEND\nDEF put_down_the_box()\n$OUT[1]=TRUE\nEND\n"
    grown = "DEF first()\nput_down_()\nput_down_the_box()\nEND\nDEF put_down_()\n$OUT[2]=TRUE\nEND\n"
    options = {"names": "8"}

    def files(text: str, earlier: NameMap) -> Translation:
        read = read_sources([source_from_text("first.src", text)], "krl", Diagnostics())
        return translate_program(read, "tp", diagnostics=Diagnostics(), earlier=earlier, options=options)

    first = files(text, NameMap())
    again = files(grown + text.partition("END\n")[2], first.map)
    assert first.map.names["put_down_the_box"] == again.map.names["put_down_the_box"] == "put_down"
    assert again.map.names["put_down_"] == "put_do_2"
