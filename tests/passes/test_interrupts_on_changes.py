"""Interrupts on each change of a value, and one variable that is ordered anew, in every other language."""

import pytest

from rpl import registry
from rpl.cell import parse_cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.record import signal_names
from rpl.proof.wiring import in_words_of, with_signal_names
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "abb_irb1200_5_90"
# Each expectation switches one output on.
PROGRAM = """MODULE Changes
  PERS num pCount:=0;
  PERS bool pFlag:=FALSE;
  VAR intnum iCount;
  VAR intnum iFlag;
  VAR intnum iOnce;
  VAR intnum iLeft;
  VAR intnum iRight;
  VAR num nCount;
  VAR num nFlag;
  VAR num nOnce;
  VAR num nOrder;
  PROC main()
    CONNECT iCount WITH tCount;
    IPers pCount,iCount;
    CONNECT iFlag WITH tFlag;
    IPers pFlag,iFlag;
    CONNECT iOnce WITH tOnce;
    ISignalDO\\Single,do31,edge,iOnce;
    FOR i FROM 1 TO 3 DO
      pCount:=i*i;
      WaitTime 0.2;
      pFlag:=i=2;
      WaitTime 0.2;
      InvertDO do31;
      WaitTime 0.2;
    ENDFOR
    IDelete iCount;
    IDelete iFlag;
    IDelete iOnce;
    pCount:=99;
    WaitTime 0.2;
    IF nCount=3 SetDO do1,1;
    IF nFlag=2 SetDO do2,1;
    IF nOnce=1 SetDO do3,1;
    Reset do31;
    CONNECT iLeft WITH tLeft;
    CONNECT iRight WITH tRight;
    ISignalDO do32,1,iLeft;
    ISignalDO do33,1,iRight;
    Set do33;
    WaitTime 0.2;
    Set do32;
    WaitTime 0.2;
    Reset do33;
    WaitTime 0.2;
    Set do33;
    WaitTime 0.2;
    IDelete iLeft;
    IDelete iRight;
    IF nOrder=212 SetDO do4,1;
  ENDPROC
  TRAP tCount
    Incr nCount;
  ENDTRAP
  TRAP tFlag
    Incr nFlag;
  ENDTRAP
  TRAP tOnce
    Incr nOnce;
  ENDTRAP
  TRAP tLeft
    nOrder:=nOrder*10+1;
  ENDTRAP
  TRAP tRight
    nOrder:=nOrder*10+2;
  ENDTRAP
ENDMODULE
"""

# One interrupt variable, ordered anew at once.
AGAIN = """MODULE Again
  VAR intnum iAgain;
  VAR num nAgain;
  VAR intnum iTime;
  VAR num nTime;
  PROC main()
    FOR k FROM 1 TO 2 DO
      IDelete iAgain;
      CONNECT iAgain WITH tAgain;
      ISignalDO do34,1,iAgain;
      Set do34;
      WaitTime 0.3;
      Reset do34;
      WaitTime 0.3;
    ENDFOR
    IDelete iAgain;
    IF nAgain=2 SetDO do1,1;
    CONNECT iTime WITH tTime;
    ITimer 0.2,iTime;
    WaitTime 0.7;
    IDelete iTime;
    IF nTime=3 SetDO do2,1;
  ENDPROC
  TRAP tAgain
    Incr nAgain;
  ENDTRAP
  TRAP tTime
    Incr nTime;
  ENDTRAP
ENDMODULE
"""

# ISleep: what comes meanwhile is lost, what comes after IWatch is not. IDisable: what comes meanwhile waits for IEnable
# (RAPID reference manual, "ISleep - Deactivates an interrupt", "IDisable - Disables interrupts").
ASLEEP = """MODULE Asleep
  PERS num pCount:=0;
  VAR intnum iCount;
  VAR intnum iEdge;
  VAR num nCount;
  VAR num nEdge;
  PROC main()
    Reset do31;
    CONNECT iCount WITH tCount;
    IPers pCount,iCount;
    CONNECT iEdge WITH tEdge;
    ISignalDO do31,edge,iEdge;
    ISleep iCount;
    ISleep iEdge;
    pCount:=1;
    Set do31;
    WaitTime 0.3;
    IWatch iCount;
    IWatch iEdge;
    WaitTime 0.3;
    IF nCount=0 SetDO do1,1;
    IF nEdge=0 SetDO do2,1;
    pCount:=2;
    Reset do31;
    WaitTime 0.3;
    IF nCount=1 SetDO do3,1;
    IF nEdge=1 SetDO do4,1;
    IDisable;
    pCount:=3;
    Set do31;
    WaitTime 0.3;
    IF nCount=1 AND nEdge=1 SetDO do5,1;
    IEnable;
    WaitTime 0.3;
    pCount:=4;
    WaitTime 0.3;
    Reset do31;
    WaitTime 0.3;
    IF nCount=3 AND nEdge=3 SetDO do6,1;
  ENDPROC
  TRAP tCount
    Incr nCount;
  ENDTRAP
  TRAP tEdge
    Incr nEdge;
  ENDTRAP
ENDMODULE
"""


@pytest.mark.parametrize(
    ("program", "count"), [(PROGRAM, 4), (AGAIN, 2), (ASLEEP, 6)], ids=["changes", "again", "asleep"]
)
@pytest.mark.parametrize("target", sorted(set(registry.target_names()) - {"rapid", "val3"}))
def test_changes_in_every_language(target: str, program: str, count: int) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("Changes.mod", program)], "rapid", diagnostics)
    assert met(run_program(read.program, ARM)) == count
    written = translate_program(read, target, ARM, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    again = read_sources([source_from_bytes(file.path, file.data) for file in written.files], target, diagnostics)
    named = with_signal_names(again.program, written.program)
    cell = in_words_of(parse_cell(""), read.program, named)
    run = run_program(named, ARM, cell, written.renamed.get("main", "main"))
    assert run.status == "finished", run.fault
    assert met(run) == count, run.outputs


def met(result: RunResult) -> int:
    """How many of the outputs 1 ... 6 have been switched on, whatever the language calls them."""
    found = set()
    for event in result.trace:
        if event.kind == "output" and event.data.get("value"):
            kind, index, last, _ = event.port or (None, None, None, None)
            known = [str(name) for name in (event.data.get("signal"), *event.names) if name]
            found |= set(signal_names(kind, known, index, last))
    return len(found & {f"digital_out:{number}" for number in range(1, 7)})
