"""One interrupt variable for several trap routines, one after the other, in languages with numbered interrupts."""

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.proof.wiring import with_signal_names
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

TRAPS = """  TRAP tFirst
    n:=n+1;
  ENDTRAP
  TRAP tSecond
    n:=n+10;
  ENDTRAP
ENDMODULE
"""
IN_TURN = """MODULE m
  VAR intnum irq;
  VAR num n:=0;
  PROC main()
    CONNECT irq WITH tFirst;
    ISignalDO do1,1,irq;
    Set do1;
    WaitTime 0.5;
    IDelete irq;
    Reset do1;
    CONNECT irq WITH tSecond;
    ISignalDO do1,1,irq;
    FOR i FROM 1 TO 3 DO
      IF i=2 ISleep irq;
      IF i=3 IWatch irq;
      Set do1;
      WaitTime 0.5;
      Reset do1;
      WaitTime 0.2;
    ENDFOR
    IDelete irq;
    IF n=21 Set do2;
  ENDPROC
"""
CHOSEN = """MODULE m
  VAR intnum irq;
  VAR num n:=0;
  PROC main()
    IF di1=1 THEN
      CONNECT irq WITH tFirst;
    ELSE
      CONNECT irq WITH tSecond;
    ENDIF
    ISignalDO do1,1,irq;
    Set do1;
  ENDPROC
"""


def test_each_connection_calls_its_own_routine() -> None:
    read = read_sources([source_from_text("m.mod", IN_TURN + TRAPS)], "rapid", Diagnostics())
    diagnostics = Diagnostics()
    done = translate_program(read, "krl", "abb_irb1200_5_90", None, diagnostics)
    assert not diagnostics.has_errors
    files = [source_from_bytes(one.path, one.data) for one in done.files]
    back = read_sources(files, "krl", Diagnostics())
    named = with_signal_names(back.program, done.program)
    proof = prove_programs(read.program, named, "abb_irb1200_5_90")
    assert proof.agrees, proof.as_text()
    text = "".join(one.data.decode() for one in done.files)
    assert "INTERRUPT DECL 10 WHEN $OUT[1] DO tFirst" in text
    assert "INTERRUPT DECL 11 WHEN $OUT[1] DO tSecond" in text


def test_a_routine_that_depends_on_the_way_taken_is_a_loss() -> None:
    read = read_sources([source_from_text("m.mod", CHOSEN + TRAPS)], "rapid", Diagnostics())
    diagnostics = Diagnostics()
    translate_program(read, "krl", "abb_irb1200_5_90", None, diagnostics)
    assert "interrupt-connected-anew" in [item.code.name for item in diagnostics]
