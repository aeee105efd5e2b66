"""Searches and braking interrupts of other languages in V+: REACTI, BRAKE, and looking while the robot moves."""

from __future__ import annotations

import pytest

from rpl.cell import parse_cell
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.proof.wiring import with_signal_names
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

KUKA, ABB, FANUC = "kuka_kr6r900sixx", "abb_irb120_3_58", "fanuc_lrmate200id"
HEAD = """MODULE m
  VAR robtarget pFound;
  PERS tooldata tGun:=[TRUE,[[0,0,100],[1,0,0,0]],[0.6,[0,0,40],[1,0,0,0],0,0,0]];
  PERS wobjdata wBoard:=[FALSE,TRUE,"",[[50,-20,10],[0.991444861,0,0,0.130526192]],[[0,0,0],[1,0,0,0]]];
  CONST robtarget pAbove:=[[350,100,250],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    ConfL\\Off;
    MoveJ pAbove,v500,fine,tGun\\WObj:=wBoard;
"""
TAIL = "\n  ENDPROC\nENDMODULE\n"


def proved(
    text: str, name: str, robot: str, cell: str = "", entry: str = "main"
) -> tuple[list[str], Diagnostics, bool]:
    """The steps in V+, what was reported, and whether both programs mean the same."""
    diagnostics = Diagnostics()
    dialect = {"mod": "rapid", "src": "krl", "ls": "tp"}[name.rpartition(".")[2]]
    read = read_sources([source_from_text(name, text)], dialect, diagnostics)
    translation = translate_program(read, "vplus", robot, None, diagnostics)
    files = translation.files
    back = read_sources([source_from_bytes(one.path, one.data) for one in files], "vplus", Diagnostics())
    named = with_signal_names(back.program, translation.program)
    found = prove_programs(read.program, named, robot, robot, parse_cell(cell), entry=entry, to_entry=entry)
    lines = [line.strip() for line in files[0].data.decode("ascii").split("\r\n")]
    return lines, diagnostics, found.agrees


def rapid(body: str, cell: str = "") -> tuple[list[str], Diagnostics, bool]:
    return proved(f"{HEAD}{body}{TAIL}", "m.mod", ABB, cell)


SEARCH = "    SearchL\\Stop,diTouch,pFound,Offs(pAbove,0,0,-100),v20,tGun\\WObj:=wBoard;\n"


def test_a_search_is_a_reaction_that_stops_the_robot() -> None:
    lines, diagnostics, _ = rapid(SEARCH)
    start = next(at for at, line in enumerate(lines) if line.startswith("REACTI"))
    assert lines[start : start + 5] == [
        *("REACTI ditouch, rpl_on_hit, 119", "SPEED 20 MMPS"),
        *("MOVES wboard_user_fra:SHIFT(pabove BY 0, 0, -100)", "BREAK", "IGNORE ditouch"),
    ]
    program = lines[lines.index(".PROGRAM rpl_on_hit()") :]
    assert program[1:3] == ["SET #rpl_hit_at = #PHERE", "rpl_hit = TRUE"]
    assert not [item for item in diagnostics if item.severity.word == "loss"]


def test_the_found_place_is_seen_as_the_move_saw_its_target() -> None:
    there = "Abs(pFound.trans.x-350)<0.01 AND Abs(pFound.trans.y-100)<0.01 AND pFound.trans.z<250"
    cell = "[[input]]\ntime = 3.0\nsignal = 'diTouch'\nvalue = true\n"
    lines, _, equal = rapid(f"{SEARCH}    IF {there} Set doOn;", cell)
    assert equal
    assert "SET pfound = INVERSE(wboard_user_fra):(p1:INVERSE(TOOL):tgun_frame)" in lines


TP = """/PROG  A
/ATTR
/MN
   1:L P[1] 200mm/sec FINE ;
   2:  SKIP CONDITION {condition} ;
   3:L P[2] 20mm/sec FINE Skip,LBL[1],PR[4:there]=LPOS ;
   4:  DO[1]=ON ;
   5:  LBL[1] ;
   6:L P[1] 200mm/sec FINE ;
/POS
"""
POINT = """P[{n}]{{
   GP1:
	UF : 0, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =   400.000  mm,	Y =     0.000  mm,	Z =   {z}  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
}};
"""
TOUCH = "[[input]]\ntime = {t}\nsignal = 'DI[5]'\nvalue = true\n[[input]]\ntime = {t}\nsignal = '1005'\nvalue = true\n"


@pytest.mark.parametrize("cell", ["", TOUCH.format(t=4.0), TOUCH.format(t=0.0)], ids=["never", "moving", "before"])
@pytest.mark.parametrize("condition", ["DI[5]=ON", "DI[5]=ON OR R[1]>3"])
def test_skip_jumps_where_nothing_was_found(condition: str, cell: str) -> None:
    points = POINT.format(n=1, z=300.0) + POINT.format(n=2, z=200.0)
    text = f"{TP.format(condition=condition)}{points}/END\n".replace("/MN\n", "/MN\n   0:  R[1]=0 ;\n")
    lines, diagnostics, equal = proved(text, "a.ls", FANUC, cell, "a")
    polled = "search-polled" in {item.code.name for item in diagnostics}
    assert equal
    assert polled == ("OR" in condition) == any(line == "BRAKE" for line in lines)


def test_an_interrupt_that_brakes_and_resumes_drops_the_move() -> None:
    text = """DEF prog( )
INTERRUPT DECL 10 WHEN $IN[5] DO seen( )
PTP {A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}
search( )
$OUT[2]=TRUE
END
DEF search( )
INTERRUPT ON 10
$VEL.CP=0.05
LIN_REL {Z -100}
$OUT[3]=TRUE
END
DEF seen( )
INTERRUPT OFF 10
BRAKE
$OUT[1]=TRUE
RESUME
END
"""
    cell = (
        "[[input]]\ntime = 1.0\nsignal = '$IN[5]'\nvalue = true\n[[input]]\ntime = 1.0\nsignal = '1005'\nvalue = true\n"
    )
    lines, diagnostics, equal = proved(text, "prog.src", KUKA, cell, "prog")
    start = lines.index(".PROGRAM seen()")
    assert lines[start + 1 : start + 6] == ["IGNORE 1005", "BRAKE", "BREAK", "SIGNAL 1", "rpl_resumed = TRUE"]
    assert not [item for item in diagnostics if item.severity.word == "loss"]
    assert equal
