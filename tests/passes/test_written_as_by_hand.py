"""Programs come out as people write them: no routine for a wait, no copy of a variable, no flag of a wait."""

from __future__ import annotations

import re

import pytest
from there_and_back import Journey, there_and_back

from rpl.cell import Cell, Input

WAITS = """def main():
  READY = 1
  def wait_input(number):
    while not get_standard_digital_in(number):
      sync()
    end
  end
  set_standard_digital_out(3, True)
  wait_input(READY)
  wait_input(2)
  set_standard_digital_out(3, False)
end
"""


@pytest.mark.parametrize(
    ("target", "waits"),
    [
        ("inform", ["WAIT IN#(2)=ON", "WAIT IN#(3)=ON"]),
        ("tp", ["WAIT DI[2:READY]=ON", "WAIT DI[3]=ON"]),
        ("krl", ["WAIT FOR READY", "WAIT FOR $IN[3]"]),
        ("rapid", ["WaitDI READY,1"]),
    ],
)
def test_a_routine_that_only_waits_stands_where_it_is_called(target: str, waits: list[str]) -> None:
    journey = there_and_back({"main.script": WAITS}, "urscript", target)
    assert not journey.losses and not re.search("wait_?input", journey.text, re.IGNORECASE)
    assert [one for one in waits if one not in journey.text] == []
    outputs = journey.run(cell=Cell(inputs=(Input(0.5, "digital_in[1]", True), Input(1.0, "digital_in[2]", True))))
    assert [(round(at, 1), value) for at, _, value in outputs.outputs] == [(0.0, True), (1.0, False)]


@pytest.mark.parametrize(
    "other",
    [
        "  number = 1\n  wait_input(number)\n  number = 2\n",  # a variable that changes
        "  wait_input(get_standard_analog_in(0))\n",  # a value that is asked for
    ],
)
def test_a_routine_that_some_call_needs_stays(other: str) -> None:
    text = WAITS.replace("  wait_input(2)\n", other)
    assert "WAIT_INPUT" in there_and_back({"main.script": text}, "urscript", "inform").text


# ---- parameters of INFORM

COUNTED = """MODULE m
  PERS num total:=0;
  PROC main()
    total:=0;
    FOR row FROM 1 TO 2 DO
      FOR column FROM 1 TO 3 DO
        put column,row;
      ENDFOR
    ENDFOR
    SetGO go1,total;
  ENDPROC
  PROC put(num column,num row)
    total:=total+10*row+column;
  ENDPROC
ENDMODULE
"""


def copies(journey: Journey) -> list[str]:
    """Variables that one variable is copied to in front of a call."""
    return re.findall(r"SET [BDIR]\d+ [BDIR]\d+\r?\n(?=CALL|SET [BDIR]\d+ [BDIR]\d+\r?\nCALL)", journey.text)


def test_a_job_looks_at_the_variable_that_each_call_gives() -> None:
    journey = there_and_back({"m.mod": COUNTED}, "rapid", "inform")
    assert not journey.losses and copies(journey) == []
    assert journey.prove().verdict == "equal"


@pytest.mark.parametrize(
    "change",
    [
        ("put column,row;", "put column,row;\n        put row,column;"),  # two calls, two variables
        ("total:=total+10*row+column;", "row:=row+1;\n    total:=total+10*row+column;"),  # the routine writes it
    ],
)
def test_other_parameters_are_copies(change: tuple[str, str]) -> None:
    journey = there_and_back({"m.mod": COUNTED.replace(*change)}, "rapid", "inform")
    assert copies(journey) != [] and journey.prove().verdict == "equal"


# ---- places that are copied and moved

MOVED = """DEF main()
  DECL E6POS Over
  BAS(#INITMOV,0)
  $TOOL=$NULLFRAME
  $BASE=$NULLFRAME
  PTP {A1 0,A2 -90,A3 90,A4 0,A5 90,A6 0}
  Over=XPick
  Over.X=XPick.X-5
  Over.Z=Over.Z+CLEAR
  $VEL.CP=0.2
  LIN Over
END
"""
POINTS = """DEFDAT main
DECL REAL CLEAR=90.0
DECL E6POS XPick={X 500,Y 100,Z 250,A 0,B 180,C 0,S 2,T 3}
ENDDAT
"""
WRITTEN = {
    "rapid": "Offs(XPick,-5,0,CLEAR",
    "vplus": "SHIFT(xpick BY -5, 0, clear)",
    "urscript": "pose_trans(p[-0.005, 0, clear",
}


@pytest.mark.parametrize("target", WRITTEN)
def test_a_place_moved_by_components_is_one_assignment(target: str) -> None:
    journey = there_and_back({"main.src": MOVED, "main.dat": POINTS}, "krl", target, "kuka_kr6r900_2")
    assert not journey.losses and WRITTEN[target] in journey.text
    assert journey.prove().verdict in ("equal", "alike")


@pytest.mark.parametrize("step", ["Over.Z=Over.Z*2", "Over.Z=Over.X+CLEAR", "Over.Z=CLEAR", "Over.A=Over.A+5"])
def test_what_is_more_than_a_way_stays_a_step(step: str) -> None:
    text = MOVED.replace("  Over.X=XPick.X-5\n  Over.Z=Over.Z+CLEAR\n", f"  {step}\n")
    assert "Offs(" not in there_and_back({"main.src": text, "main.dat": POINTS}, "krl", "rapid").text


# ---- waits with a limit

RETRIED = """MODULE m
  PROC main()
    SetDO do1,1;
    WaitDI di2,1\\MaxTime:=1.5;
    SetDO do1,0;
  ERROR
    IF ERRNO=ERR_WAIT_MAXTIME THEN
      SetDO do3,1;
      RETRY;
    ENDIF
  ENDPROC
ENDMODULE
"""
LATE = Cell(inputs=(Input(4.0, "di2", True),))


@pytest.mark.parametrize(
    ("target", "loop"), [("krl", "WHILE NOT "), ("urscript", "while not "), ("vplus", "WHILE NOT ")]
)
def test_a_wait_that_is_tried_again_looks_first_and_keeps_no_flag(target: str, loop: str) -> None:
    journey = there_and_back({"m.mod": RETRIED}, "rapid", target)
    assert loop in journey.text and "timed_out" not in journey.text
    outputs = [(round(at, 1), value) for at, _, value in journey.run(cell=LATE).outputs]
    assert outputs == [(0.0, True), (1.5, True), (4.0, False)]


def test_a_choice_behind_a_wait_asks_the_signal() -> None:
    assert "IFTHENEXP IN#(2)=OFF" in there_and_back({"m.mod": RETRIED}, "rapid", "inform").text


# ---- waits for the end of the motion

GRIPPED = """.PROGRAM main()
        SIGNAL -1
        CALL open()
        MOVE #PPOINT(0, -90, 90, 0, 90, 0)
        MOVE #PPOINT(10, -80, 90, 0, 80, 0)
        CALL open()
        MOVE #PPOINT(20, -80, 90, 0, 80, 0)
        MOVE #PPOINT(0, -90, 90, 0, 90, 0)
        BREAK
        CALL open()
.END
.PROGRAM open()
        BREAK
        SIGNAL 1
        WAIT.EVENT , 0.3
        SIGNAL -1
.END
"""


@pytest.mark.parametrize(("target", "stops"), [("inform", " PL=0"), ("tp", " FINE ")])
def test_a_wait_that_a_routine_begins_with_is_said_at_the_moves_before_its_calls(target: str, stops: str) -> None:
    journey = there_and_back({"m.v2": GRIPPED}, "vplus", target, "adept_viper_s650")
    assert not journey.losses
    moves = [line for line in journey.text.splitlines() if re.search(r"MOV[JL] |^ *\d+:[JL] ", line)]
    assert [stops in line for line in moves] == [False, True, False, True]
    assert not re.search("IMOV| INC ", journey.text)
    assert journey.prove().verdict in ("equal", "alike")


def test_a_wait_for_a_move_that_is_not_known_stays_in_its_routine() -> None:
    asked = (
        "        MOVE #PPOINT(20, -80, 90, 0, 80, 0)\n        IF SIG(1001) THEN\n            CALL open()\n        END\n"
    )
    text = GRIPPED.replace("        MOVE #PPOINT(20, -80, 90, 0, 80, 0)\n", asked)
    assert "IMOV" in there_and_back({"m.v2": text}, "vplus", "inform", "adept_viper_s650").text
