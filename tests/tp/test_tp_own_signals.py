"""RI[1..8] and RO[1..8] are the signals of the end of the arm, beside DI and DO (FANUC handling tool manual).

Elsewhere such a signal is called RO2; with that name it is RO[2] again, and takes no number of the others.
"""

import pytest

from tests.tp.tp_translating_helpers import same_in_tp

RAPID = """MODULE m
  PROC main()
    SetDO ro2,1;
    SetDO do1,1;
    SetDO doOther,1;
    WaitTime 0.1;
    SetDO RO2,0;
    SetDO ro9,1;
  ENDPROC
ENDMODULE
"""
KRL = """DEF m( )
DECL INT i
SIGNAL RO3 $OUT[7]
$OUT[3]=TRUE
RO3=TRUE
WAIT SEC 0.1
RO3=FALSE
END
"""


@pytest.mark.parametrize(
    ("dialect", "text", "expected"),
    [
        ("rapid", RAPID, ["RO[2]=ON", "DO[1]=ON", "DO[2:doOther]=ON", "RO[2]=OFF", "DO[3:ro9]=ON"]),
        ("krl", KRL, ["DO[3]=ON", "RO[3]=ON", "RO[3]=OFF"]),
    ],
)
def test_signals_of_the_end_of_the_arm_keep_their_word(dialect: str, text: str, expected: list[str]) -> None:
    files, _ = same_in_tp(dialect, text)
    (listing,) = (text for path, text in files.items() if path in ("MAIN.LS", "M.LS"))
    lines = [line.partition(":")[2].strip(" ;") for line in listing.splitlines()]
    assert [line for line in lines if line.startswith(("RO[", "DO["))] == expected
