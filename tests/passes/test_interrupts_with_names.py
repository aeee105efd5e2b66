"""What a name of an interrupt can be in RAPID and a number elsewhere cannot: it is refused where it is connected."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "abb_irb1200_5_90"
HEAD = "MODULE m\n  VAR intnum irq;\n  VAR num n:=0;\n  PROC main()\n    Set do1;\n"
TAIL = """    Set do2;
  ENDPROC
  TRAP tFirst
    n:=n+1;
  ENDTRAP
  TRAP tSecond
    n:=n+10;
  ENDTRAP
"""
ASKING = """  TRAP tAsking
    StopMove;
    IF INTNO=irq n:=n+1;
    StartMove;
  ENDTRAP
"""
PROGRAMS = {
    "interrupt-connected-anew": """    CONNECT irq WITH tFirst;
    ISignalDI di1,1,irq;
    WaitTime 0.5;
    IDelete irq;
    CONNECT irq WITH tSecond;
    ISignalDI di1,1,irq;
    ISleep irq;
    IWatch irq;
""",
    "interrupt-ordered-anew": """    CONNECT irq WITH tFirst;
    ISignalDI\\Single,di1,1,irq;
    WaitTime 0.5;
    IDelete irq;
    CONNECT irq WITH tFirst;
    ISignalDI di2,1,irq;
""",
    "interrupt-number-asked": """    CONNECT irq WITH tAsking;
    ISignalDI di1,1,irq;
    WaitTime 0.5;
    IDelete irq;
""",
}
CASES = [(name, target) for name in PROGRAMS for target in ("krl", "tp", "urscript", "vplus", "inform")]
DECLARED_ANEW = ("interrupt-ordered-anew", "krl")  # KRL declares a number anew at run time


@pytest.mark.parametrize(("name", "target"), [case for case in CASES if case != DECLARED_ANEW])
def test_it_is_refused_where_it_is_connected_and_nowhere_else(name: str, target: str) -> None:
    text = HEAD + PROGRAMS[name] + TAIL + (ASKING if "tAsking" in PROGRAMS[name] else "") + "ENDMODULE\n"
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("m.mod", text)], "rapid", Diagnostics())
    written = translate_program(read, target, ARM, None, diagnostics)
    connected = [at for at, line in enumerate(text.splitlines(), 1) if "CONNECT" in line]
    assert [(item.code.name, item.origin.line) for item in diagnostics.of(Severity.LOSS)] == [
        (name, line) for line in connected
    ]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    result = run_program(back.program, ARM, None, written.renamed.get("main", "main"), 10.0)
    assert result.status == "stopped" and len(result.outputs) == 1


def test_krl_declares_a_number_anew() -> None:
    diagnostics = Diagnostics()
    read = read_sources(
        [source_from_text("m.mod", HEAD + PROGRAMS[DECLARED_ANEW[0]] + TAIL + "ENDMODULE\n")], "rapid", diagnostics
    )
    translate_program(read, "krl", ARM, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)


def test_a_target_without_interrupts_stops_where_the_interrupt_is_connected() -> None:
    diagnostics = Diagnostics()
    text = HEAD + PROGRAMS["interrupt-number-asked"] + TAIL + ASKING + "ENDMODULE\n"
    read = read_sources([source_from_text("m.mod", text)], "rapid", diagnostics)
    translate_program(read, "val3", ARM, None, diagnostics)
    stops = [(item.code.name, item.origin.line) for item in diagnostics.of(Severity.LOSS) if item.origin.line > 4]
    assert stops == [("interrupt-lost", 6)]


SAME_NAME = """MODULE m
  VAR num n:=0;
  PROC main()
    VAR intnum irq;
    CONNECT irq WITH tFirst;
    ISignalDO do5,1,irq;
    other;
    Set do5;
    WaitTime 0.1;
    IDelete irq;
    IF n=2 Set do1;
  ENDPROC
  PROC other()
    VAR intnum irq;
    CONNECT irq WITH tFirst;
    ISignalDO do6,1,irq;
    Set do6;
    WaitTime 0.1;
    IDelete irq;
  ENDPROC
  TRAP tFirst
    n:=n+1;
  ENDTRAP
ENDMODULE
"""


@pytest.mark.parametrize("target", ["krl", "tp", "urscript", "vplus", "inform"])
def test_variables_of_two_routines_are_two_interrupts(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("m.mod", SAME_NAME)], "rapid", Diagnostics())
    written = translate_program(read, target, ARM, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    result = run_program(back.program, ARM, None, written.renamed.get("main", "main"), 10.0)
    assert result.fault is None and len(result.outputs) == 3  # do5, do6 and, where both came, do1
