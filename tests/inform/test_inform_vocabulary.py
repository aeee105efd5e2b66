"""Words and forms of newer controllers, each in a small job that sets an output when the manual's expectation holds."""

from __future__ import annotations

import pytest
from inform_helpers import job, outputs, read, run

from rpl import ir

POINTS = """
///TOOL 0
///POSTYPE ROBOT
///RECTAN
///RCONF 1,0,0,0,0,0
C00001=900.000,0.000,800.000,180.0000,0.0000,0.0000
C00002=900.000,100.000,800.000,180.0000,0.0000,0.0000
"""
HELD = {
    "the value of a condition as a number": """
SET B001 3
SET B000 LOGICEXP (B001=3 AND IN#(2)=OFF)
JUMP *NO IF B000<>1""",
    "clearing from a computed variable on": """
SET B001 60
SET I060 5
SET I061 5
SET I062 5
CLEAR I[B001] 2
JUMP *NO IFEXPRESS I060<>0 OREXP I061<>0 OREXP I062<>5""",
    "clearing what is no variable": """
CLEAR STACK
CLEAR QUE""",
    "an alarm that does not stop": 'SETUALM 8001 "WARN" 0 SMODE=1',
    "a job by number": """
SET B000 3
SET I010 0
CALL B000
CALL IG#(3)
JUMP *NO IF I010<>3""",
    "texts and positions among arguments": """
SUB P070 P070
SETE P070 (2) 5000
CALL JOB:MIXED ("AB", P070, 2.5)
GETS R000 $RV
JUMP *NO IF R000<>9.5""",
    "a job beside with arguments": """
PSTART JOB:TAKES SUB3 ARGF 4
PWAIT SUB3
JUMP *NO IF I025<>4""",
    "two jobs of one sub task": """
SET I010 0
PSTART JOB:3 SUB1
PWAIT SUB1
PSTART JOB:SLOW SUB1
PWAIT SUB1
JUMP *NO IF I010<>9""",
    "nothing to wait for": "PWAIT SUB4",
    "a timer": """
SETTM TM000 TRESET
SETTM TM000 TSTART
TIMER T=0.50
SETTM TM000 TSTOP
TIMER T=0.50
GETS D000 $TM000
JUMP *NO IF D000<450
JUMP *NO IF TM000>550""",
    "a timer's flag": """
SETTM TM001 500
JUMP *NO IF TF001=ON
WAIT TF001=ON T=1.00
JUMP *NO IF TF001=OFF""",
    "groups of the user": """
DOUT OGU#(6) 3
DIN B000 OGU#(6)
JUMP *NO IF B000<>3""",
    "a shift in the axes of the tool": """
SUB P014 P014
SETE P014 (3) 25000
SFTON P014 TF
MOVJ C00001 VJ=50.00 PL=0
SFTOF
GETS PX012 $PX001
GETE D000 P012 (3)
MOVL C00001 V=300.0 PL=0
GETS PX012 $PX001
GETE D001 P012 (3)
JUMP *NO IFEXPRESS D000>775100 OREXP D000<774900 OREXP D001<799900""",
    "a shift in space": """
SUB P014 P014
SETE P014 (2) 25000
SFTON3D P014
MOVJ C00001 VJ=50.00 PL=0
SFTOF3D
GETS PX012 $PX001
GETE D000 P012 (2)
JUMP *NO IFEXPRESS D000>25100 OREXP D000<24900""",
    "the tool of a position": """
MOVJ C00001 VJ=50.00 PL=0
SUB P040 P040
SETE P040 (3) 100000
SETTOOL TL#(2) P040
GETS PX012 $PX001
SETE P012 TL#(2)
MOVL P012 V=300.0 PL=0
CNVRT PX013 PX012 PULSE
CNVRT PX014 PX013 BF TL#(0)
GETE D000 P014 (3)
JUMP *NO IFEXPRESS D000>900100 OREXP D000<899900""",
}
NUMBERED = job("ADD I010 3", name="3")
TAKES = job("GETARG LI000 IARG#(1)\nSET I025 LI000", name="TAKES")
SLOW = job("TIMER T=1.00\nADD I010 6", name="SLOW")
MIXED = job(
    """
GETARG LS000 IARG#(1)
GETARG LPX000 IARG#(2)
GETARG LR000 IARG#(3)
LEN LB000 LS000
GETE LD000 LP000 (2)
DIV LD000 1000
SET LR001 LD000
ADD LR001 LR000
ADD LR001 LB000
RET LR001""",
    name="MIXED",
)


@pytest.mark.parametrize("words", HELD)
def test_the_expectation_holds(words: str) -> None:
    main = job(HELD[words] + "\nDOUT OT#(1) ON\n*NO", POINTS)
    made = run(main, NUMBERED, TAKES, SLOW, MIXED, robot="motoman_mh24")
    assert ("OT#(1)", True) in outputs(made), made.fault


def test_an_unknown_number_of_a_job_is_an_alarm() -> None:
    made = run(job("SET B000 9\nCALL B000\nDOUT OT#(1) ON"), NUMBERED)
    assert outputs(made) == [] and "undefined job" in str(made.messages)


def test_a_variable_of_aout_counts_hundredths_of_a_volt() -> None:
    made = run(job("SET I000 -250\nAOUT AO#(1) I000\nSET R000 1.5\nAOUT AO#(2) R000\nAOUT AO#(3) 2"))
    assert [value for _, value in outputs(made)] == pytest.approx([-2.5, 1.5, 2.0])


def test_print_shows_text_and_values() -> None:
    body = 'SET B001 5\nSET S001 "AB"\nPRINT "TEST\\n"\nPRINT "N %d OF %s" B001 S001\nPRINT B001\nCLS'
    texts = [str(message) for message in run(job(body)).messages]
    assert [word for word in ("TEST", "N 5 OF AB", "5") if not any(word in text for text in texts)] == []


def test_dialog_gives_the_number_of_the_button() -> None:
    body = 'SET S010 "GO ON?"\nSET S011 "YES"\nSET S012 "NO"\n'
    body += 'DIALOG B050 DIALSB 10 20 S010 30 40 S011 DIALSB 10 30 "" 50 40 S012\nDOUT OG#(1) B050'
    assert outputs(run(job(body), cell="answers = [2]")) == [("OT#(2)", True)]


def test_an_output_before_the_robot_arrives() -> None:
    body = "MOVJ C00001 VJ=50.00 PL=0\nMOVL C00002 V=50.0 PL=0\nANTOUT AT#(1) ON ANT=-0.50\nDOUT OT#(1) ON"
    made = run(job(body, POINTS), robot="motoman_mh24")
    (early, first, _), (arrived, second, _) = made.outputs
    assert (first, second) == ("AT1", "OT#(1)")
    assert arrived - early == pytest.approx(0.5, abs=0.05)


def test_outputs_around_arrivals_in_a_loop() -> None:
    body = "FOR I000=1 TO 2\nMOVL C00002 V=50.0 PL=0\nANTOUT AT#(1) ON ANT=-0.50\nNEXT I000"
    _, diagnostics = read(job(body, POINTS))
    assert "inform-not-anticipated" not in {item.code.name for item in diagnostics}


def test_condition_files_are_left_to_the_controller() -> None:
    program, diagnostics = read(job("SETFILE WEV#(1) (5) 3500\nGETFILE D000 WEV#(1) (6)"))
    assert not diagnostics.has_errors
    body = program.modules[-1].routines[0].body
    assert any(isinstance(one, ir.Vendor) and one.effect == "none" for one in body)
    assert any(isinstance(one, ir.Assign) and isinstance(one.value, ir.VendorValue) for one in body)
