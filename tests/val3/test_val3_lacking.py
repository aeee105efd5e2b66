"""What other languages have and VAL3 has not, as it is written in VAL3: read back, it does the same."""

from __future__ import annotations

import re

import pytest
from there_and_back import there_and_back
from val3_helpers import ROBOT, application

from rpl.cell import Cell, Input
from rpl.diagnostics import Diagnostics
from rpl.translation import translate_program

JOINTS = "{A1 0,A2 20,A3 80,A4 0,A5 80,A6 0}"


def switched(code: str, data: str = "") -> tuple[set[int], str]:
    """The outputs that the written KRL program switches on in VAL3, and its text."""
    journey = there_and_back({"job.src": f"DEF job()\n{data}\n{code}\nEND\n"}, "krl", "val3", "kuka_kr6r900sixx")
    assert not journey.losses, journey.losses
    return journey.switched_on(journey.run("JOB")), journey.text


LOOPS = {
    "an endless loop that is left at its beginning": (
        "N=0\nLOOP\nIF N>=3 THEN\nEXIT\nENDIF\nN=N+1\nENDLOOP\n$OUT[1]=(N==3)",
        "while n<3",
    ),
    "an endless loop that is left at its end": (
        "N=0\nLOOP\nN=N+1\nIF N>=3 THEN\nEXIT\nENDIF\nENDLOOP\n$OUT[1]=(N==3)",
        "until n>=3",
    ),
    "a loop that is left in its middle": (
        "N=0\nM=0\nLOOP\nN=N+1\nIF N>=3 THEN\nEXIT\nENDIF\nM=M+1\nENDLOOP\n$OUT[1]=(N==3) AND (M==2)",
        "until bLeave",
    ),
    "a counting loop that is left: the counter keeps its value": (
        "FOR N=1 TO 9\nIF N==4 THEN\nEXIT\nENDIF\nENDFOR\n$OUT[1]=(N==4)",
        "while !bLeave and n<=9",
    ),
    "a counting loop that could be left and is not": (
        "FOR N=1 TO 3\nIF N==7 THEN\nEXIT\nENDIF\nENDFOR\n$OUT[1]=(N==4)",
        "n=n+1",
    ),
    "a loop that is left out of a switch, which ends its cases with the same word": (
        "N=0\nLOOP\nN=N+1\nSWITCH N\nCASE 1\n$OUT[2]=TRUE\nCASE 3\nEXIT\nENDSWITCH\nENDLOOP\n$OUT[1]=(N==3)",
        "bLeave=true",
    ),
    "the inner one of two loops": (
        "M=0\nFOR N=1 TO 2\nK=0\nREPEAT\nK=K+1\nIF K==2 THEN\nEXIT\nENDIF\nM=M+1\nUNTIL K>5\nENDFOR\n$OUT[1]=(M==2)",
        "do",
    ),
}


@pytest.mark.parametrize(("code", "text"), LOOPS.values(), ids=LOOPS.keys())
def test_no_loop_is_left_by_a_word(code: str, text: str) -> None:
    """VAL3 has no Break (help of Visual Components 4.9, Staubli add-on; DELMIA, Staubli translators)."""
    found, written = switched(code, "INT N,M,K")
    assert 1 in found and text in written
    assert not re.search(r"\bbreak\b(?!\n *(?:case|default|endSwitch))", written)


ANGLES = {
    "an angle that is read": "P={X 10,Y 20,Z 30,A 40,B 50,C 60}\n$OUT[1]=(ABS(P.A-40)<0.001) AND (ABS(P.B-50)<0.001)",
    "the angle about x": "P={X 10,Y 20,Z 30,A 40,B 50,C 60}\n$OUT[1]=(ABS(P.C-60)<0.001)",
    "an angle that is set": (
        "P={X 10,Y 20,Z 30,A 40,B 50,C 60}\nP.A=-70\n$OUT[1]=(ABS(P.A+70)<0.001) AND (ABS(P.C-60)<0.001)"
    ),
    "a component of a place that is worked out": (
        "P={X 10,Y 20,Z 30,A 90,B 0,C 0}\nQ={X 5,Y 0,Z 0,A 0,B 0,C 0}\nQ=P:Q\n$OUT[1]=(ABS(Q.Y-25)<0.001)"
    ),
    "the angle of two numbers": "$OUT[1]=(ABS(ATAN2(-3.0,-3.0)+135.0)<0.0001)",
}


@pytest.mark.parametrize("code", ANGLES.values(), ids=ANGLES.keys())
def test_angles_about_z_y_x_are_read_and_set(code: str) -> None:
    """A trsf turns about x, the new y, the new z (RoboDK's and the Robots plug-in's postprocessors for VAL3)."""
    found, _ = switched(code, "FRAME P,Q")
    assert 1 in found


TP = """/PROG  {name}
/ATTR
/MN
   1:  UFRAME_NUM=1 ;
   2:  UTOOL_NUM=1 ;
   3:J P[1:above] 50% FINE ;
   4:  CALL {next} ;
/POS
P[1:"above"]{{
   GP1:
	UF : 1, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =   {x}  mm,	Y =     0.000  mm,	Z =   400.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
}};
/END
"""


def test_taught_points_of_programs_are_data_on_their_frame_with_their_posture() -> None:
    """They are taught anew at the pendant, which shows data of the application only; two of one name stay two."""
    one = TP.format(name="ONE", next="TWO", x="500.000")
    two = TP.format(name="TWO", next="THREE", x="550.000")
    three = "/PROG  THREE\n/ATTR\n/MN\n   1:  DO[1]=ON ;\n/POS\n/END\n"
    journey = there_and_back({"one.ls": one, "two.ls": two, "three.ls": three}, "tp", "val3", "fanuc_m10ia")
    data = next(file.data.decode("utf-8-sig") for file in journey.written.files if file.path.endswith(".dtx"))
    row = r'<Data name="(above\w*)".*\n *<Value key="0" x="(\d+)".* shoulder="(\w+)".*fatherId="(.*?)"'
    found = sorted(re.findall(row, data))
    assert found == [("above", "500", "righty", "frame1[0]"), ("above_two", "550", "righty", "frame1[0]")]
    assert not re.search(r"above\w*\.trsf=", journey.text)


SEARCH = """MODULE job
  PROC main()
    VAR robtarget found;
    MoveAbsJ [[0,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,fine,tool0;
    SearchL\\Stop,di1,found,[[350,0,450],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v50,tool0;
    SetDO do1,1;
  ERROR
    SetDO do2,1;
    TRYNEXT;
  ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize(("touched", "outputs"), [(True, {1}), (False, {1, 2})], ids=["found", "not found"])
def test_a_search_is_a_wait_beside_the_movement(touched: bool, outputs: set[int]) -> None:
    """Movements go into a queue and the program goes on; resetMotion stops the robot and forgets what is left (VAL3
    reference manual 5.3, chapters 9.2 and 9.4)."""
    journey = there_and_back({"job.mod": SEARCH}, "rapid", "val3", "abb_irb120_3_58")
    assert not journey.losses
    assert "wait(di1 or isSettled())" in journey.text and "resetMotion()" in journey.text
    cell = Cell(inputs=(Input(1.5, "di1", True),)) if touched else None
    assert journey.switched_on(journey.run("main", cell)) == outputs


def test_the_operator_acknowledges_a_message_by_a_key() -> None:
    """getKey gives the key pressed last, -1 for none (VAL3 reference manual 5.3, user interface)."""
    text = 'def job():\n  popup("No part", blocking=True)\n  set_digital_out(1, True)\nend\n'
    journey = there_and_back({"job.script": text}, "urscript", "val3", "ur5e")
    assert not journey.losses
    assert 'putln("No part")\n  do\n    delay(0)\n  until getKey()!=-1\n' in journey.text


def test_a_configuration_of_local_points_is_kept() -> None:
    """A point that the program changes is data of its routine; what it begins with has its posture too."""
    code = "l_pA={{380,-120,-100,180,0,0},{righty,epositive,wnegative}}\nl_pA.trsf.z=-90\nmovej(l_pA,tGrip,mStop)"
    head = '<Locals><Local name="l_pA" type="pointRx" xsi:type="array" size="1" /></Locals>\n---\n'
    found = Diagnostics()
    files = translate_program(application(head + code), "val3", ROBOT, None, found).files
    start = next(file.data.decode("utf-8-sig") for file in files if file.path == "start.pgx")
    assert "l_pA.config.wrist=wnegative" in start
