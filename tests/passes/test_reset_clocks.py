"""A stop watch that runs stands when it is set to zero: in every language, also where timers would count on."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

FRAME = "MODULE demo\n  VAR clock ck;\n  VAR bool long:=TRUE;\n  PROC main()\n{}\n  ENDPROC\nENDMODULE\n"
STANDS = """
ClkStart ck;
WaitTime 0.5;
ClkReset ck;
WaitTime 1;
IF ClkRead(ck)<0.05 SetDO do1,1;
ClkStart ck;
WaitTime 0.5;
ClkStop ck;
IF Abs(ClkRead(ck)-0.5)<0.1 SetDO do2,1;
"""
IN_BRANCH = """
ClkStart ck;
WaitTime 0.5;
IF long THEN
  ClkReset ck;
ENDIF
WaitTime 1;
IF ClkRead(ck)<0.05 SetDO do1,1;
ClkReset ck;
ClkStart ck;
WaitTime 0.3;
ClkReset ck;
ClkStart ck;
WaitTime 0.5;
IF Abs(ClkRead(ck)-0.5)<0.1 SetDO do2,1;
"""


@pytest.mark.parametrize("program", [STANDS, IN_BRANCH], ids=["between waits", "in a branch"])
@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "vplus", "inform", "urscript", "rpl"])
def test_a_reset_watch_stands(target: str, program: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("demo.mod", FRAME.format(program))], "rapid", diagnostics)
    translation = translate_program(read, target, "abb_irb1200_5_90", None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    files = [source_from_bytes(one.path, one.data) for one in translation.files]
    result = run_program(read_sources(files, target, Diagnostics()).program, "abb_irb1200_5_90")
    assert result.fault is None and [state for _, _, state in result.outputs] == [True, True]


def test_a_reset_before_a_start_is_one_step() -> None:
    diagnostics = Diagnostics()
    text = FRAME.format("ClkReset ck;\nClkStart ck;\nWaitTime 1;\nClkReset ck;\nIF ClkRead(ck)=0 SetDO do1,1;")
    read = read_sources([source_from_text("demo.mod", text)], "rapid", diagnostics)
    written = b"".join(one.data for one in translate_program(read, "tp", "abb_irb1200_5_90", None, diagnostics).files)
    steps = [
        line.split("=")[1].split()[0] for line in written.decode().splitlines() if "TIMER[" in line and "]=" in line
    ]
    assert steps[:4] == ["RESET", "START", "STOP", "RESET"]
