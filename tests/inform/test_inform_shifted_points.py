"""Tools and frames as the controller's files hold them, and places that are counted from taught points."""

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

RAPID = """MODULE one
PERS tooldata tGrip:=[TRUE,[[0,0,150],[1,0,0,0]],[1,[0,0,50],[1,0,0,0],0,0,0]];
PERS wobjdata wTable:=[FALSE,TRUE,"",[[350,150,20],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
CONST robtarget pCorner:=[[70,60,70],[0,0.707107,0.707107,0],[0,0,1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST jointtarget jHome:=[[0,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
PERS num nRow:=0;
PROC main()
MoveAbsJ jHome,v1000,fine,tGrip;
FOR i FROM 1 TO 2 DO
put i;
ENDFOR
ENDPROC
PROC put(num row)
VAR robtarget pPlace;
{body}
ENDPROC
ENDMODULE
"""
COUNTED = """pPlace:=Offs(pCorner,(row-1)*40,0,0);
MoveJ Offs(pPlace,0,0,90),v1000,fine,tGrip\\WObj:=wTable;
MoveL pPlace,v200,fine,tGrip\\WObj:=wTable;
SetDO do1,1;
WaitTime 0.2;
MoveL Offs(pPlace,0,0,90),v500,fine,tGrip\\WObj:=wTable;"""


def written(body: str) -> tuple[dict[str, list[str]], Diagnostics]:
    """The lines of each file; what was written means the same."""
    robot, diagnostics = "abb_irb1200_5_90", Diagnostics()
    read = read_sources([source_from_text("one.mod", RAPID.replace("{body}", body))], "rapid", diagnostics)
    done = translate_program(read, "inform", robot, None, diagnostics)
    back = read_sources([source_from_bytes(file.path, file.data) for file in done.files], "inform", Diagnostics())
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    result = prove_programs(read.program, back.program, robot, robot, None)
    assert result.agrees, result.as_text()
    return {file.path: file.data.decode("ascii").split("\r\n")[:-1] for file in done.files}, diagnostics


def instructions(lines: list[str]) -> list[str]:
    return lines[lines.index("NOP") + 1 : -1]


def test_constant_tools_and_frames_stand_beside_the_jobs() -> None:
    files, _ = written("MoveJ pCorner,v1000,fine,tGrip\\WObj:=wTable;")
    assert files["TOOL.CND"][:3] == ["//TOOL 1", "///NAME TGRIP", "0.000,0.000,150.000,0.0000,0.0000,0.0000"]
    assert files["UFRAME.CND"] == [
        *("//UFRAME 1", "///NAME WTABLE", "///TOOL 0", "////BUSER 350.000,150.000,20.000,0.0000,0.0000,0.0000")
    ]
    head = files["PUT.JBI"][: files["PUT.JBI"].index("NOP")]
    assert {"///TOOL 1", "///USER 1", "///ATTR SC,RW,RJ", "////FRAME USER 1"} <= set(head)
    assert instructions(files["PUT.JBI"]) == ["MOVJ C00000 VJ=75.00 PL=0"]


def test_a_constant_way_from_a_point_is_a_shift() -> None:
    files, diagnostics = written("MoveJ Offs(pCorner,0,0,90),v1000,fine,tGrip\\WObj:=wTable;")
    assert "C00000=70.000,60.000,70.000,180.0000,0.0000,90.0000" in files["PUT.JBI"]
    assert any(line.startswith("SFTON P") for line in files["PUT.JBI"])
    assert "taught-value-written" not in {item.code.name for item in diagnostics}


def test_a_counted_place_is_a_point_with_a_shift() -> None:
    files, _ = written(COUNTED)
    lines = instructions(files["PUT.JBI"])
    words = [line.split()[0] for line in lines]
    assert words[-7:] == ["SFTON", "MOVJ", "MOVL", "DOUT", "TIMER", "MOVL", "SFTOF"]
    assert lines[words.index("SFTON")].endswith(" UF#(1)") and "MULMAT" not in words
    assert [line for line in files["PUT.JBI"] if line.startswith("C0")] == [
        "C00000=70.000,60.000,160.000,180.0000,0.0000,90.0000",
        "C00001=70.000,60.000,70.000,180.0000,0.0000,90.0000",
        "C00002=70.000,60.000,160.000,180.0000,0.0000,90.0000",
    ]


@pytest.mark.parametrize(
    "change",
    [
        ("WaitTime 0.2;", "IF row=1 pPlace.trans.x:=pPlace.trans.x+5;"),  # only sometimes
        ("WaitTime 0.2;", "nRow:=pPlace.trans.x;"),  # read
        ("MoveJ Offs(pPlace,0,0,90)", "pPlace:=CRobT(\\Tool:=tGrip\\WObj:=wTable);MoveJ Offs(pPlace,0,0,90)"),
        ("MoveJ Offs(pPlace,0,0,90)", "pPlace:=RelTool(pPlace,0,0,0\\Rz:=row);MoveJ Offs(pPlace,0,0,90)"),  # turned
    ],
)
def test_what_is_more_than_a_shift_is_calculated(change: tuple[str, str]) -> None:
    files, _ = written(COUNTED.replace(*change))
    assert not any(line.startswith("SFTON") for line in files["PUT.JBI"])
