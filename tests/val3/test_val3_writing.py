"""VAL3 as it is written: names and data that movements need, and waits where the source's program stands still.

The wrong way of each rule is kept beside the right one, so that the proof is seen to tell them apart.
"""

from __future__ import annotations

import re

import pytest
from val3_helpers import ROBOT, application

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.source import source_from_text
from rpl.translation import translate_program
from tests.there_and_back import there_and_back

KRL = """DEF job( )
DECL E6POS XP
XP={X 380,Y 50,Z -60,A 180,B 0,C 180,E1 0,E2 0,E3 0,E4 0,E5 0,E6 0}
BAS(#INITMOV,0)
$VEL.CP=0.2
$TOOL={X 0,Y 0,Z 100,A 0,B 0,C 0}
PTP {A1 0,A2 20,A3 80,A4 0,A5 80,A6 0}
PTP XP
%s
END
"""


def written(code: str) -> tuple[str, str]:
    """The code of the program, and its data."""
    found = Diagnostics()
    program = read_sources([source_from_text("job.src", KRL % code)], "krl", found)
    files = {
        file.path: file.data.decode("utf-8-sig")
        for file in translate_program(program, "val3", ROBOT, None, found).files
    }
    code = re.search(r"begin\n(.*?)end\]\]>", files["job.pgx"], re.DOTALL)
    assert code is not None
    return code[1], files["job.dtx"]


CASES = {
    "an output behind a movement": ("$OUT[2]=TRUE", "waitEndMove()\n  do2=true"),
    "a wait at an input": ("WAIT FOR $IN[1]", "waitEndMove()\n  wait(di1)"),
    "a time": ("WAIT SEC 0.5", "waitEndMove()\n  delay(0.5)"),
    "a pulse": ("PULSE($OUT[3],TRUE,0.5)", 'waitEndMove()\n  do3=true\n  taskCreate "pulse1"'),
    "a way from where the robot is, in the axes of the tool": (
        "IF $IN[1] THEN\nLIN XP\nENDIF\nPTP {A1 10}\nLIN_REL {X 20} #TOOL",
        "waitEndMove()\n  movel(appro(here(tTool,world)",
    ),
    "a condition at an input": ("IF $IN[1] THEN\n$OUT[2]=TRUE\nENDIF", "waitEndMove()\n  if di1"),
    "a loop that looks at an input behind each movement": (
        "WHILE $IN[1]\nLIN XP\nENDWHILE",
        "waitEndMove()\n  endWhile",
    ),
}


@pytest.mark.parametrize(("code", "text"), CASES.values(), ids=CASES.keys())
def test_what_looks_at_the_outside_waits_for_the_robot(code: str, text: str) -> None:
    lines, _ = written(code)
    assert text in re.sub(r"\n +", "\n  ", lines)


def test_a_calculation_between_movements_does_not_hold_the_robot() -> None:
    lines, _ = written("$VEL.CP=0.1\nLIN XP\n$VEL.CP=0.3\nLIN XP")
    assert "waitEndMove" not in lines


def test_what_the_program_names_is_declared() -> None:
    """Signals, tools, points and movement descriptors; speeds stand in their names."""
    lines, data = written("LIN XP\n$OUT[2]=TRUE\nWAIT FOR $IN[1]")
    declared = set(re.findall(r'<Data name="(\w+)"', data))
    for name in ("do2", "di1", "tTool", "mL200"):
        assert name in lines and name in declared
    assert re.search(r'name="do2"[^>]*type="dio"', data) and re.search(r'name="di1"[^>]*type="dio"', data)


def test_no_terminal_is_guessed_for_a_signal() -> None:
    """Which valve hangs at which terminal only the cell knows; without a link the controller refuses the signal."""
    found = Diagnostics()
    program = read_sources([source_from_text("job.src", KRL % "$OUT[2]=TRUE\nWAIT FOR $IN[1]")], "krl", found)
    files = translate_program(program, "val3", ROBOT, None, found).files
    assert not any(b"link=" in file.data for file in files)
    (told,) = [item for item in found if item.code.name == "val3-signals-not-linked"]
    assert "do2" in told.message and "di1" in told.message


FROM_HERE = (
    "movej(jHome,tGrip,mStop)\nwaitEndMove()\nmovej(pA,tGrip,mStop)\n{wait}"
    "movel(appro(here(tGrip,world),{{0,0,-50,0,0,0}}),tGrip,mStop)\nwaitEndMove()\ndoOut=true"
)


def test_a_way_seen_from_here_behind_a_movement_is_told_apart() -> None:
    """`here` is evaluated when the statement is executed: without the wait the way begins where the robot was then."""
    right = application(FROM_HERE.format(wait="waitEndMove()\n"))
    wrong = application(FROM_HERE.format(wait=""))
    assert prove_programs(right.program, right.program, ROBOT, entry="start").verdict == "equal"
    assert prove_programs(right.program, wrong.program, ROBOT, entry="start").verdict == "different"


# Lists of several dimensions since s7: their sizes and keys with commas between them (M: the form of the keys).
GRID = (("nGrid", "num", "2,3", {"0,0": "1", "0,1": "2", "0,2": "3", "1,0": "4", "1,1": "5", "1,2": "6"}),)
THERE_AND_BACK = {
    "a point of a frame": "movej(appro(pInPart,{0,0,-40,0,0,0}),tGrip,mFast)\nmovel(pInPart,tGrip,mStop)",
    "an arc": "movej(pA,tGrip,mStop)\nmovec(compose(pA,world,{40,100,0,0,0,0}),pB,tGrip,mStop)",
    "places that are worked out": "pB.trsf.z=-80\npB.trsf.rz=160\nmovej(pB,tGrip,mStop)",
    "choices and loops": (
        "for nX=1 to 3\nswitch nX\ncase 1\nmovej(pA,tGrip,mStop)\nbreak\ndefault\n"
        "movej(pB,tGrip,mFast)\nbreak\nendSwitch\nendFor\nwhile nX>0\nnX=nX-1\nendWhile\nwaitEndMove()\ndoOut=nX==0"
    ),
    "a tool and texts": 'movej(pA,tGrip,mStop)\nclose(tGrip)\nsX="n"+toString(".1",1.25)\nputln(sX)\nopen(tGrip)',
    "a list of two dimensions": (
        "for nX=0 to 2\nnGrid[1,nX]=nGrid[1,nX]+nX\nendFor\ndoOut=nGrid[1,2]==8 and nGrid[1,0]==4"
    ),
    "a limited wait": "movej(pA,tGrip,mStop)\nwaitEndMove()\nif !watch(diIn==true,0.3)\ndoOut=true\nendIf",
}


@pytest.mark.parametrize("code", THERE_AND_BACK.values(), ids=THERE_AND_BACK.keys())
def test_what_is_written_means_what_was_read(code: str) -> None:
    program = application(code + "\nwaitEndMove()", GRID)
    found = Diagnostics()
    done = translate_program(program, "val3", ROBOT, None, found)
    back = read_sources(
        [source_from_text(file.path, file.data.decode("utf-8-sig")) for file in done.files], "val3", found
    )
    assert not [item.as_text() for item in found if item.code.name.startswith(("val3-not", "val3-lost", "unreadable"))]
    result = prove_programs(program.program, back.program, ROBOT, entry="start")
    assert result.verdict in ("equal", "alike"), result


def test_data_of_one_name_in_two_modules_are_two_data() -> None:
    """What all modules see keeps its name; what a routine declares for itself hides both."""
    files = {
        "job.src": "DEF JOB()\nOTHER()\nTHIRD()\n$OUT[1]=(N==1)\nEND\n",
        "job.dat": "DEFDAT JOB\nINT N=1\nENDDAT\n",
        "other.src": "DEF OTHER()\n$OUT[2]=(N==2)\nEND\n",
        "other.dat": "DEFDAT OTHER PUBLIC\nDECL GLOBAL INT N=2\nENDDAT\n",
        "third.src": "DEF THIRD()\nOWN()\n$OUT[3]=(N==2)\nEND\nDEF OWN()\nINT N\nN=4\n$OUT[4]=(N==4)\nEND\n",
    }
    journey = there_and_back(files, "krl", "val3", "kuka_kr6r900sixx")
    assert not journey.losses
    data = next(file.data.decode() for file in journey.written.files if file.path == "job.dtx")
    values = dict(re.findall(r'<Data name="(n(?:_\d)?)".*\n.*value="(\d)"', data))
    assert values == {"n": "2", "n_2": "1"}
    assert journey.switched_on(journey.run("JOB")) == {1, 2, 3, 4}


def test_a_routine_that_cannot_be_declared_stops_where_it_is_called() -> None:
    text = """MODULE job
  VAR intnum inDoor;
  PROC main()
    SetDO do1,1;
    off inDoor;
    SetDO do2,1;
  ENDPROC
  PROC off(VAR intnum which)
    IDelete which;
  ENDPROC
ENDMODULE
"""
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("job.mod", text)], "rapid", Diagnostics())
    files = translate_program(read, "val3", ROBOT, None, diagnostics).files
    lost = [item for item in diagnostics.of(Severity.LOSS) if "off" in item.message]
    assert {item.origin.line for item in lost} >= {5, 8}
    main = next(file.data.decode() for file in files if file.path == "main.pgx")
    assert "call off" not in main and main.count("wait(false)") >= 1


def test_a_question_whether_a_task_runs_follows_its_name() -> None:
    """VAL3 has no point in a name, so the task is called otherwise there, also where it is asked for."""
    text = """.PROGRAM main()
        stop.it = FALSE
        EXECUTE 1 count.parts()
        WAIT.EVENT , 0.2
        IF TASK(1, 1) == 4 THEN
            SIGNAL 1
        END
        stop.it = TRUE
        WAIT TASK(1, 1) <> 4
        SIGNAL 2
.END
.PROGRAM count.parts()
        WAIT stop.it
.END
"""
    journey = there_and_back({"main.v2": text}, "vplus", "val3", "adept_viper_s650")
    assert not journey.losses
    assert 'taskStatus("count_parts")' in journey.text
    assert journey.switched_on(journey.run("main")) == {1, 2}
