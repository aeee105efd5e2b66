"""SWRITE tells its state in a variable that the formatted writes of a routine share, declared before the offset."""

from __future__ import annotations

import re

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

SHOWN = """MODULE m
  PROC main()
    VAR num n:=1.5;
    TPWrite "first "+NumToStr(n,1);
    TPWrite "second "+NumToStr(n,2)+" mm";
  ENDPROC
ENDMODULE
"""


def test_one_state_for_all_writes_of_a_routine() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("m.mod", SHOWN)], "rapid", diagnostics)
    written = translate_program(read, "krl", None, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    text = "\n".join(file.data.decode("latin-1") for file in written.files)
    assert re.findall(r"(?i)decl (state_t|int) (\w+)", text) == [("STATE_T", "state"), ("INT", "offset")]
    assert len(re.findall(r"SWRITE\(\w+\[\],state,offset,", text)) == 2
