"""Interrupt routines that stop the robot on its path and let it go on: KRL goes on by itself when the routine
ends, for others the interrupt is refused where it is ordered."""

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
from tests.refusing import refused

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
    MoveL p2,v100,fine,tool0;
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
GOING_ON = {
    "held": "StopMove; bStopped:=TRUE; WaitTime 1; StartMove;",
    "stored": "StopMove; StorePath; bStopped:=TRUE; WaitTime 1; RestoPath; StartMove;",
    "signals behind": "StopMove; WaitTime 1; StartMove; bStopped:=TRUE; SetDO do40,1;",
}
OTHERWISE = {
    "stays": "StopMove; bStopped:=TRUE;",
    "only sometimes": "StopMove; IF bStopped THEN StartMove; ENDIF",
    "left before": "StopMove; IF di6=0 RETURN; StartMove;",
    "early": "StopMove; bStopped:=TRUE; StartMove; WaitTime 1;",
    "in a routine": "bStopped:=TRUE; HoldIt;",
    "chosen": "IF di6=1 THEN StopMove; WaitTime 1; StartMove; ENDIF bStopped:=TRUE;",
}


def switched_on(record: Record) -> set[int]:
    """The digital outputs that were on at some time."""
    found: set[int] = set()
    for happening in (each for of_task in record.tasks.values() for each in of_task if each.kind == "output"):
        numbers = (re.fullmatch(r"digital_out:(\d+)", key) for key in happening.names)
        found |= {int(number[1]) for number in numbers if number and happening.value}
    return found


def program(trap: str) -> str:
    lines = trap.replace("; ", ";\n    ").replace("THEN ", "THEN\n    ")
    routine = HOLD_IT if "HoldIt" in trap else ""
    return PROGRAM.replace("@TRAP@", lines).replace("@ROUTINE@", routine)


def codes(diagnostics: Diagnostics, severity: Severity) -> set[str]:
    return {item.code.name for item in diagnostics.of(severity)}


@pytest.mark.parametrize("form", GOING_ON)
def test_the_move_goes_on_behind_the_routine(form: str, tmp_path: Path) -> None:
    file = tmp_path / "cell.toml"
    file.write_text(CELL, "utf-8")
    cell = read_cell(str(file))
    read = read_sources([source_from_text("Hold.mod", program(GOING_ON[form]))], "rapid", Diagnostics())
    diagnostics = Diagnostics()
    made = translate_program(read, "krl", ARM, None, diagnostics)
    assert not codes(diagnostics, Severity.LOSS)
    back = read_sources([source_from_bytes(f.path, f.data) for f in made.files], "krl", Diagnostics())
    named = with_signal_names(back.program, made.program)
    entry = made.renamed.get("main", "main")
    result = run_program(named, ARM, in_words_of(cell, read.program, named), entry, 60.0)
    assert result.fault is None
    assert {1, 2, 3} <= switched_on(record_of(result, named))


@pytest.mark.parametrize("form", OTHERWISE)
def test_what_goes_on_at_another_time_is_refused_at_the_stop(form: str) -> None:
    text = program(OTHERWISE[form])
    line = next(at for at, one in enumerate(text.splitlines(), 1) if "StopMove" in one)
    assert refused(text, "rapid", "krl", ARM) == [("motion-stays-stopped", line)]


@pytest.mark.parametrize("target", ["tp", "urscript", "vplus", "inform"])
@pytest.mark.parametrize("trap", [*GOING_ON.values(), *OTHERWISE.values()])
def test_a_move_that_would_begin_again_in_its_middle_is_refused_where_the_interrupt_is_ordered(
    trap: str, target: str
) -> None:
    text = program(trap)
    diagnostics = Diagnostics()
    made = translate_program(
        read_sources([source_from_text("Hold.mod", text)], "rapid", Diagnostics()), target, ARM, None, diagnostics
    )
    lost = [(item.code.name, item.origin.line) for item in diagnostics.of(Severity.LOSS)]
    line = next(at for at, one in enumerate(text.splitlines(), 1) if "ISignalDI" in one)
    assert lost == [("braked-move-lost" if target == "vplus" else "interrupt-not-watched", line)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in made.files], target, Diagnostics())
    result = run_program(back.program, ARM, None, made.renamed.get("main", "main"), 60.0)
    assert result.status == "stopped" and not result.outputs


def test_what_is_left_of_a_refused_brake_is_one_remark() -> None:
    """Also of an interrupt that comes again, which V+ would have to be told."""
    text = program(GOING_ON["held"]).replace("\\Single,", " ")
    source = read_sources([source_from_text("Hold.mod", text)], "rapid", Diagnostics())
    (file,) = translate_program(source, "vplus", ARM).files
    assert file.data.decode("ascii").count("is refused where it is declared: StopMove;") == 1
