"""What is left of refused statements: one stop or remark each, and no routine that is prepared to start the program."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

RAPID = """MODULE m
  VAR intnum i;
  VAR num seen;
  VAR num more;
  PROC main()
    VelSet 50,400;
    MoveAbsJ [[0,0,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;
    CONNECT i WITH look;
    ISignalDI di1,1,i;
    WaitTime 1;
    IDelete i;
    CONNECT i WITH look_again;
    ISignalDI di2,1,i;
    WaitTime 1;
    SetGO go1,seen+more;
  ENDPROC
  TRAP look
    seen:=seen+1;
  ENDTRAP
  TRAP look_again
    more:=more+1;
  ENDTRAP
ENDMODULE
"""


@pytest.mark.parametrize(("target", "prepared"), [("krl", "$ADVANCE"), ("vplus", "ALWAYS"), ("inform", "PSTART")])
def test_what_a_refused_statement_would_run_is_not_started_alone(target: str, prepared: str) -> None:
    read = read_sources([source_from_text("m.mod", RAPID)], "rapid", Diagnostics())
    diagnostics = Diagnostics()
    done = translate_program(read, target, "abb_irb1200_5_90", None, diagnostics)
    assert "interrupt-connected-anew" in {one.code.name for one in diagnostics}
    text = "\n".join(one.data.decode("latin-1") for one in done.files)
    assert "CONNECT i WITH look" in text and text.count(prepared) <= 1, text


STOPPED = """DEF m()
INTERRUPT DECL 10 WHEN $IN[1] DO HELD()
INTERRUPT ON 10
LIN {X 400}
INTERRUPT OFF 10
END
DEF HELD()
BRAKE F
WAIT SEC 1
END
"""


@pytest.mark.parametrize("target", ["vplus", "tp", "inform", "urscript"])
def test_each_refused_statement_is_said_once(target: str) -> None:
    read = read_sources([source_from_text("m.src", STOPPED)], "krl", Diagnostics())
    done = translate_program(read, target, "kuka_kr6r900sixx", None, Diagnostics())
    text = "\n".join(one.data.decode("latin-1") for one in done.files)
    assert [text.count(word) for word in ("INTERRUPT ON 10", "INTERRUPT OFF 10", "BRAKE F")] == [1, 1, 1], text
    assert "ControlInterrupt" not in text
