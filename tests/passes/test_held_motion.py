"""Interrupt routines that stop the robot on its path and let it go on, in languages without a word for going on."""

import re
from pathlib import Path

import pytest

from rpl.cell import read_cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.record import Record
from rpl.proof.recording import record_of
from rpl.proof.wiring import in_words_of, with_signal_names
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "abb_irb1200_5_90"
CELL = """[[reaction]]
when = "do36"
after = 0.8
signal = "di6"
value = true
"""
PROGRAM = """MODULE Hold
  CONST robtarget p1:=[[500,0,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pm:=[[520,100,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget p2:=[[500,200,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR intnum iStop;
  VAR bool bStopped:=FALSE;
  VAR robtarget pEnd;
  VAR clock ck;
  PROC main()
    MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tool0;
    MoveL p1,v300,fine,tool0;
    CONNECT iStop WITH tHold;
    ISignalDI\\Single,di6,1,iStop;
    SetDO do36,1;
    ClkReset ck;
    ClkStart ck;
    @MOVE@
    ClkStop ck;
    IDelete iStop;
    pEnd:=CRobT(\\Tool:=tool0\\WObj:=wobj0);
    IF bStopped SetDO do1,1;
    IF ClkRead(ck)>2.8 AND ClkRead(ck)<3.6 SetDO do2,1;
    IF Abs(pEnd.trans.y-200)<0.5 SetDO do3,1;
  ENDPROC
@ROUTINE@  TRAP tHold
    @TRAP@
  ENDTRAP
ENDMODULE
"""
HOLD_IT = """  PROC HoldIt()
    StopMove;
    WaitTime 1;
    StartMove;
  ENDPROC
"""
STRAIGHT, ARC = "MoveL p2,v100,fine,tool0;", "MoveC pm,p2,v100,fine,tool0;"
GOING_ON = {
    "held": "StopMove; bStopped:=TRUE; WaitTime 1; StartMove;",
    "stored": "StopMove; StorePath; bStopped:=TRUE; WaitTime 1; RestoPath; StartMove;",
    "signals behind": "StopMove; WaitTime 1; StartMove; bStopped:=TRUE; SetDO do40,1;",
    "in a routine": "bStopped:=TRUE; HoldIt;",
    "chosen": "IF di6=1 THEN StopMove; WaitTime 1; StartMove; ENDIF bStopped:=TRUE;",
}
OTHERWISE = {
    "stays": ("StopMove; bStopped:=TRUE;", "motion-stays-stopped"),
    "only sometimes": ("StopMove; IF bStopped THEN StartMove; ENDIF", "motion-stays-stopped"),
    "left before": ("StopMove; IF di6=0 RETURN; StartMove;", "motion-stays-stopped"),
    "early": ("StopMove; bStopped:=TRUE; StartMove; WaitTime 1;", "motion-goes-on-early"),
    "early in a routine": ("HoldIt; WaitTime 1;", "motion-goes-on-early"),
}
TARGETS = ("krl", "tp", "urscript", "vplus", "inform")


def switched_on(record: Record) -> set[int]:
    """The digital outputs that were on at some time."""
    found: set[int] = set()
    for happening in (each for of_task in record.tasks.values() for each in of_task if each.kind == "output"):
        numbers = (re.fullmatch(r"digital_out:(\d+)", key) for key in happening.names)
        found |= {int(number[1]) for number in numbers if number and happening.value}
    return found


def program(trap: str, move: str = STRAIGHT) -> str:
    lines = trap.replace("; ", ";\n    ").replace("THEN ", "THEN\n    ")
    routine = HOLD_IT if "HoldIt" in trap else ""
    return PROGRAM.replace("@TRAP@", lines).replace("@MOVE@", move).replace("@ROUTINE@", routine)


def codes(diagnostics: Diagnostics, severity: Severity) -> set[str]:
    return {item.code.name for item in diagnostics.of(severity)}


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("form", GOING_ON)
def test_the_move_goes_on_behind_the_routine(form: str, target: str, tmp_path: Path) -> None:
    file = tmp_path / "cell.toml"
    file.write_text(CELL, "utf-8")
    cell = read_cell(str(file))
    read = read_sources([source_from_text("Hold.mod", program(GOING_ON[form]))], "rapid", Diagnostics())
    diagnostics = Diagnostics()
    made = translate_program(read, target, ARM, None, diagnostics)
    assert not codes(diagnostics, Severity.LOSS)
    assert ("stopped-move-begins-again" in codes(diagnostics, Severity.WARNING)) is (target != "krl")
    back = read_sources([source_from_bytes(f.path, f.data) for f in made.files], target, Diagnostics())
    named = with_signal_names(back.program, made.program)
    entry = made.renamed.get("main", "main")
    result = run_program(named, ARM, in_words_of(cell, read.program, named), entry, 60.0)
    assert result.fault is None
    assert {1, 2, 3} <= switched_on(record_of(result, named))


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("form", OTHERWISE)
def test_what_goes_on_at_another_time_is_named(form: str, target: str) -> None:
    trap, expected = OTHERWISE[form]
    read = read_sources([source_from_text("Hold.mod", program(trap))], "rapid", Diagnostics())
    diagnostics = Diagnostics()
    translate_program(read, target, ARM, None, diagnostics)
    assert expected in codes(diagnostics, Severity.LOSS)


@pytest.mark.parametrize("target", TARGETS)
def test_an_arc_does_not_begin_again_from_its_middle(target: str) -> None:
    read = read_sources([source_from_text("Hold.mod", program(GOING_ON["held"], ARC))], "rapid", Diagnostics())
    diagnostics = Diagnostics()
    translate_program(read, target, ARM, None, diagnostics)
    assert ("stopped-move-lost" in codes(diagnostics, Severity.LOSS)) is (target != "krl")
