"""A routine that nothing calls can be started alone, beside `main`: its data has its values then too.

In RAPID data has its initial value when the program is loaded, whichever routine the program pointer is moved to. TP
and INFORM have no such values: programs set them.
"""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ROBOT = "abb_irb1200_7_70"
MODULE = """MODULE m
  CONST robtarget pA:=[[500,50,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR num high:=20;
  VAR num seen;
  PROC main()
    seen:=high;
  ENDPROC
  PROC path1()
    drive;
  ENDPROC
  PROC drive()
    MoveJ Offs(pA,0,0,high),v100,fine,tool0;
  ENDPROC
  PROC path2()
    MoveJ pA,v100,fine,tool0;
  ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize("target", ["tp", "inform"])
@pytest.mark.parametrize("entry", ["path1", "path2"])
def test_each_routine_finds_its_data(entry: str, target: str) -> None:
    read = read_sources([source_from_text("m.mod", MODULE)], "rapid", Diagnostics())
    written = translate_program(read, target, ROBOT, None, Diagnostics())
    assert not written.losses
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    to_entry = written.renamed.get(entry, entry)
    result = prove_programs(read.program, back.program, ROBOT, entry=entry, to_entry=to_entry)
    assert result.verdict in ("equal", "alike"), result.as_text()  # speeds of joints and of turning are approximated
    asked = {f.path: b"CALL" in f.data and b"INITIAL" in f.data.upper() for f in written.files}
    assert [name for name, sets in asked.items() if "PATH2" in name and sets] == []
