"""Paths that are put aside where there is none, in languages that cannot put one aside."""

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.recording import record_of
from rpl.proof.wiring import with_signal_names
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "abb_irb1200_5_90"
TEXT = """MODULE Feeler
  CONST robtarget p:=[[450,90,310],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveJ p,v200,fine,tool0;
    IF Felt() SetDO do1,1;
    MoveL p,v100,fine,tool0;
    SetDO do2,1;
  ENDPROC
  FUNC bool Felt()
    VAR robtarget pHit;
    SearchL\\SStop,di1,pHit,Offs(p,0,0,-40),v50,tool0;
    RETURN TRUE;
  ERROR
    IF ERRNO=ERR_WHLSEARCH THEN
      StorePath;
      MoveL p,v100,fine,tool0;
      RestoPath;
      RETURN FALSE;
    ENDIF
  ENDFUNC
ENDMODULE
"""


@pytest.mark.parametrize("language", ["rapid", "krl", "tp", "urscript", "vplus", "inform", "rpl"])
def test_the_handler_of_a_search(language: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("Feeler.mod", TEXT)], "rapid", diagnostics)
    translation = translate_program(read, language, ARM, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    written = [source_from_bytes(one.path, one.data) for one in translation.files]
    back = with_signal_names(read_sources(written, language, Diagnostics()).program, translation.program)
    result = run_program(back, ARM, None, translation.renamed.get("main", "main"), 60)
    assert result.fault is None
    happenings = [one for task in record_of(result, back).tasks.values() for one in task if one.kind == "output"]
    marks = {name for one in happenings for name in one.names if one.value and ":" in name}
    assert marks == {"digital_out:2"}


def test_a_path_that_an_interrupt_leaves_is_no_such_thing() -> None:
    text = TEXT.replace("IF Felt() SetDO do1,1;", "ISignalDI di2,1,iStop;").replace(
        "  FUNC bool", "  VAR intnum iStop;\n  TRAP tStop\n    StopMove;\n    StorePath;\n  ENDTRAP\n  FUNC bool"
    )
    text = text.replace("PROC main()\n", "PROC main()\n    CONNECT iStop WITH tStop;\n")
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("Feeler.mod", text)], "rapid", diagnostics)
    translate_program(read, "krl", ARM, None, diagnostics)
    assert diagnostics.of(Severity.LOSS)
