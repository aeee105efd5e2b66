"""Paths that are put aside where there is none, in languages that cannot put one aside."""

import pytest

from tests.there_and_back import there_and_back

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
    journey = there_and_back({"Feeler.mod": TEXT}, "rapid", language, ARM)
    assert not journey.losses
    result = journey.run()
    assert result.fault is None and journey.switched_on(result) == {2}


@pytest.mark.parametrize("behind", ["StartMove;", "ClearPath;\n      StartMove;"])
@pytest.mark.parametrize("language", ["rapid", "krl", "tp", "urscript", "vplus", "inform", "rpl"])
def test_the_start_behind_it_has_nothing_to_start(language: str, behind: str) -> None:
    """As the manual's example of SearchL ends its handler (RAPID instructions, SearchL, error handling)."""
    text = TEXT.replace("RestoPath;\n", f"RestoPath;\n      {behind}\n")
    journey = there_and_back({"Feeler.mod": text}, "rapid", language, ARM)
    assert not journey.losses
    result = journey.run()
    assert result.fault is None and journey.switched_on(result) == {2}


def test_a_path_that_an_interrupt_leaves_is_no_such_thing() -> None:
    text = TEXT.replace("IF Felt() SetDO do1,1;", "ISignalDI di2,1,iStop;").replace(
        "  FUNC bool", "  VAR intnum iStop;\n  TRAP tStop\n    StopMove;\n    StorePath;\n  ENDTRAP\n  FUNC bool"
    )
    text = text.replace("PROC main()\n", "PROC main()\n    CONNECT iStop WITH tStop;\n")
    assert there_and_back({"Feeler.mod": text}, "rapid", "krl", ARM).losses
