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


AGAIN = """DEFFCT INT FACT(N:IN)
INT N
IF N<=1 THEN
RETURN 1
ENDIF
RETURN N*FACT(N-1)
ENDFCT
DEF m()
$OUT[FACT(3)]=TRUE
END
"""


def test_nothing_is_worked_out_for_a_call_that_is_refused() -> None:
    read = read_sources([source_from_text("m.src", AGAIN)], "krl", Diagnostics())
    done = translate_program(read, "tp", "fanuc_lrmate200id7l", None, Diagnostics())
    (text,) = (one.data.decode() for one in done.files if one.path.upper().startswith("FACT"))
    lines = [line.partition(":")[2].strip(" ;") for line in text.partition("/MN")[2].partition("/POS")[0].splitlines()]
    assert lines[lines.index("!RETURN N*FACT(N-1)") - 1 :] == ["ENDIF", "!RETURN N*FACT(N-1)", "PAUSE"], text


FLYING = """MODULE m
  VAR triggdata t;
  PROC main()
    VAR num limit;
    limit:=GInputDnum(gi1);
    TriggIO t,25\\DOp:=do1,1;
    MoveAbsJ [[0,0,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;
    VelSet 100,limit;
    TriggL [[400,100,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,t,fine,tool0;
  ENDPROC
ENDMODULE
"""


def test_the_actions_of_a_refused_move_are_refused_with_it() -> None:
    read = read_sources([source_from_text("m.mod", FLYING)], "rapid", Diagnostics())
    diagnostics = Diagnostics()
    done = translate_program(read, "krl", "abb_irb1200_5_90", None, diagnostics)
    text = "\n".join(one.data.decode() for one in done.files)
    assert "speed-share-hangs-on-run" in {one.code.name for one in diagnostics}
    assert ";TriggL" in text and "TRIGGER" not in text, text
