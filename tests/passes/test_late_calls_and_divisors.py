"""Late calls, divisors of zero, constants of constants, in each target.

A division by zero is an error that a handler can catch in RAPID, whatever the divisor looks like.
"""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import entry_name, run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ABB = "abb_irb1200_5_90"
TARGETS = ["krl", "rapid", "tp", "urscript", "vplus", "inform", "rpl"]
DIVISORS = """MODULE Job
  CONST num FIRST:=3;
  CONST num LAST:=FIRST*2+1;
  VAR num next:=LAST+1;
  VAR num list{3}:=[LAST,FIRST+1,-FIRST];
  VAR num seen:=0;
  PROC main()
    part;
    IF seen=9 SetDO do1,1;
    IF LAST=7 AND next=8 AND list{1}+list{2}+list{3}=8 SetDO do2,1;
  ENDPROC
  PROC part()
    VAR num n:=5;
    n:=n DIV 0;
    n:=n MOD 0;
    n:=n/-0;
  ERROR
    IF ERRNO=ERR_DIVZERO THEN
      seen:=seen+FIRST;
      TRYNEXT;
    ENDIF
  ENDPROC
ENDMODULE
"""
LATE = """MODULE Job
  VAR num order:=0;
  PROC main()
    order:=4;
    FOR i FROM 3 TO 1 DO
      %"step"+NumToStr(i,0)%;
    ENDFOR
    IF order=4321 SetDO do1,1;
  ENDPROC
  PROC step1()
    order:=order*10+1;
  ENDPROC
  PROC step2()
    order:=order*10+2;
  ENDPROC
  PROC step3()
    order:=order*10+3;
  ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize(("text", "count"), [(DIVISORS, 2), (LATE, 1)])
def test_it_means_the_same(text: str, count: int, target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("job.mod", text)], "rapid", diagnostics)
    own = run_program(read.program, ABB)
    assert [value for _, _, value in own.outputs] == [True] * count
    translation = translate_program(read, target, ABB, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    again = Diagnostics()
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, again)
    assert not again.has_errors
    entry = entry_name(read.program, None)
    result = run_program(back.program, ABB, None, translation.renamed.get(entry, entry) if entry else None, 20.0)
    assert result.status == "finished", result.fault
    assert [value for _, _, value in result.outputs] == [True] * count
