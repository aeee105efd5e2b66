"""Numbers that get multiples of themselves outgrow 32 bits: where the source has one number type, they stay real.

RAPID num is a 4-byte float (reference manual, data type num), so 15! goes on; KRL's INT has 32 bits (KUKA reference
guide 2.1.3.1), as have D variables of INFORM and URScript's int.
"""

from __future__ import annotations

import pytest

from tests.there_and_back import there_and_back

GROWING = {
    "a factorial": "FOR k FROM 1 TO 15 DO f:=f*k; ENDFOR",
    "powers of ten": "WHILE f<1E11 DO f:=f*10; ENDWHILE",
    "multiples and a sum": "FOR k FROM 1 TO 12 DO f:=k+10*(f+1); ENDFOR",
}


def _text(body: str) -> dict[str, str]:
    data = "  VAR num f:=1;\n"
    return {
        "m.mod": f"MODULE m\n{data}  PROC main()\n    {body}\n"
        "    IF f>1E10 SetDO do1,1;\n    SetDO do2,1;\n  ENDPROC\nENDMODULE\n"
    }


@pytest.mark.parametrize("target", ("krl", "urscript", "inform", "tp", "vplus"))
@pytest.mark.parametrize("case", GROWING)
def test_numbers_that_outgrow_32_bits_go_on(case: str, target: str) -> None:
    given = there_and_back(_text(GROWING[case]), "rapid", target)
    ended = given.run()
    assert given.switched_on(ended) == {1, 2} and ended.status == "finished", given.text


def test_counters_stay_whole() -> None:
    text = "MODULE m\n  VAR num n:=0;\n  PROC main()\n    n:=n+1;\n    n:=(n*7+3) MOD 100;\n    SetDO do1,1;\n"
    assert "INT n=0" in there_and_back({"m.mod": text + "  ENDPROC\nENDMODULE\n"}, "rapid", "krl").text
