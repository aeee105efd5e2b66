"""Interrupts that come again after a time: what passes while another trap runs comes once, and they go on behind it."""

import pytest
from test_interrupts_on_changes import met

from rpl import registry
from rpl.cell import parse_cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.wiring import in_words_of, with_signal_names
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "abb_irb1200_5_90"
CELL = """
[[reaction]]
when = "do[34]"
becomes = true
after = 0.5
signal = "di[5]"
value = true
"""
# Beats at 0.2, 0.4; those of 0.6, 0.8 and 1.0 come once behind the long trap (at 1.1); then 1.2, 1.4, 1.6, 1.8.
PROGRAM = """MODULE beats
    VAR beat, stop: INTERRUPT
    VAR count: INT = 0
    VAR in_time: INT = 0
    PROCEDURE main()
        CONNECT stop TO long_trap
        ARM stop ON edge WHEN di[5]
        CONNECT beat TO counted
        ARM beat ON timer TIME 0.2 s
        SET do[34] TO ON
        WAIT 1.9 s
        INTERRUPT DELETE beat
        IF in_time = 2 THEN SET do[1] TO ON
        IF count = 7 THEN SET do[2] TO ON
    END PROCEDURE
    TRAP long_trap()
        in_time = count
        WAIT 0.6 s
    END TRAP
    TRAP counted()
        count = count + 1
    END TRAP
END MODULE
"""


@pytest.mark.parametrize("target", ["krl", "rapid", "rpl", "vplus"])
def test_beats_go_on_behind_a_long_trap(target: str) -> None:
    assert target in registry.target_names()
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("beats.rpl", PROGRAM)], "rpl", diagnostics)
    assert met(run_program(read.program, ARM, parse_cell(CELL), controller="plain")) == 2
    written = translate_program(read, target, ARM, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    again = read_sources([source_from_bytes(file.path, file.data) for file in written.files], target, diagnostics)
    named = with_signal_names(again.program, written.program)
    cell = in_words_of(parse_cell(CELL), read.program, named)
    run = run_program(named, ARM, cell, written.renamed.get("main", "main"), controller="plain")
    assert run.status == "finished", run.fault
    assert met(run) == 2, run.outputs


# The robot is held for a second in the middle of a move of one second, and drives on to its end; then nothing comes.
HELD = """MODULE a
VAR intnum i;
VAR clock ck;
VAR pos seen;
CONST robtarget p:=[[400,-50,300],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
PROC main()
MoveJ p,v1000,fine,tool0;
CONNECT i WITH hold;
ITimer\\Single,0.5,i;
ClkStart ck;
MoveL Offs(p,100,0,0),v100,fine,tool0;
ClkStop ck;
IF Abs(ClkRead(ck)-2)<0.2 AND Abs(seen.x-450)<4 SetDO do1,1;
ClkReset ck;
ClkStart ck;
MoveL p,v100,fine,tool0;
ClkStop ck;
IDelete i;
IF Abs(ClkRead(ck)-1)<0.2 SetDO do2,1;
ENDPROC
TRAP hold
StopMove;
WaitTime 0.3;
seen:=CPos(\\Tool:=tool0\\WObj:=wobj0);
WaitTime 0.7;
StartMove;
ENDTRAP
ENDMODULE
"""


@pytest.mark.parametrize("target", ["krl"])
def test_once_and_the_robot_is_held(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("a.mod", HELD)], "rapid", diagnostics)
    assert met(run_program(read.program, ARM, controller="plain")) == 2
    written = translate_program(read, target, ARM, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    again = read_sources([source_from_bytes(file.path, file.data) for file in written.files], target, diagnostics)
    named = with_signal_names(again.program, written.program)
    run = run_program(named, ARM, None, again.program.entry or written.renamed.get("main", "main"), controller="plain")
    assert run.status == "finished", run.fault
    assert met(run) == 2, run.outputs
