"""Routines that only their module sees (RAPID LOCAL PROC, KRL DEF without GLOBAL): two modules may have the same."""

from __future__ import annotations

import pytest

from tests.there_and_back import there_and_back

RAPID = {
    "A.mod": """MODULE A
  VAR num order:=0;
  PROC main()
    init;
    prepare;
    IF order=12 AND given(3)=6 AND other(3)=9 SetDO do1,1;
  ENDPROC
  LOCAL PROC init()
    order:=1;
  ENDPROC
  LOCAL FUNC num given(num n)
    RETURN n*2;
  ENDFUNC
ENDMODULE
""",
    "B.mod": """MODULE B
  LOCAL VAR intnum iSeen;
  PROC prepare()
    init;
  ENDPROC
  LOCAL PROC init()
    order:=order*10+2;
  ENDPROC
  LOCAL FUNC num given(num n)
    RETURN n*3;
  ENDFUNC
  FUNC num other(num n)
    RETURN given(n);
  ENDFUNC
ENDMODULE
""",
}
KRL = {
    "first.src": """DEF FIRST( )
  IF (HELPER(2)==4) AND (SECOND(2)==6) THEN
    $OUT[1]=TRUE
  ENDIF
END
DEFFCT INT HELPER(N:IN)
  INT N
  RETURN N*2
ENDFCT
""",
    "second.src": """DEFFCT INT SECOND(N:IN)
  INT N
  RETURN HELPER(N)
ENDFCT
DEFFCT INT HELPER(N:IN)
  INT N
  RETURN N*3
ENDFCT
""",
}


@pytest.mark.parametrize("language", ["rapid", "krl", "tp", "urscript", "vplus", "inform", "val3", "rpl"])
@pytest.mark.parametrize(
    ("files", "source", "arm", "entry"),
    [(RAPID, "rapid", "abb_irb1200_5_90", "main"), (KRL, "krl", "kuka_kr6r900sixx", "FIRST")],
)
def test_each_module_calls_its_own(files: dict[str, str], source: str, arm: str, entry: str, language: str) -> None:
    journey = there_and_back(files, source, language, arm)
    assert not journey.losses and not journey.found.has_errors
    result = journey.run(entry)
    assert result.fault is None and journey.switched_on(result) == {1}
