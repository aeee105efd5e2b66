"""Variables never get the number of a flag or timer that the program itself uses."""

import pytest
from tp_translating_helpers import same_in_tp

FLAGS = """&ACCESS RVP
DEF P( )
DECL BOOL A[6]
DECL BOOL B
DECL INT I
FOR I=1 TO 6
  A[I]=TRUE
ENDFOR
B=TRUE
$FLAG[{place}]=FALSE
$OUT[1]=A[1] AND A[6] AND B AND NOT $FLAG[{place}]
$FLAG[{place}]=TRUE
$OUT[2]=A[1] AND $FLAG[{place}]
A[2]=FALSE
B=FALSE
$OUT[3]=$FLAG[{place}] AND NOT B
END
"""


@pytest.mark.parametrize("place", ["1", "2", "7", "I"])
def test_flags_keep_their_numbers(place: str) -> None:
    shown, _ = same_in_tp("krl", FLAGS.format(place=place))
    listing = "".join(shown.values())
    if place != "I":
        assert f"F[{place}]=ON" in listing.replace(" ", "").replace("(", "").replace(")", "")


GROUP = """&ACCESS RVP
DEF P( )
SIGNAL RECIPE $OUT[41] TO $OUT[44]
DECL INT I
RECIPE=11
$OUT[3]=$OUT[41] AND $OUT[42] AND NOT $OUT[43] AND $OUT[44] AND (RECIPE==11)
I=RECIPE-6
RECIPE=I
$OUT[4]=(RECIPE==5)
END
"""


def test_a_declared_group_is_written_bit_by_bit() -> None:
    shown, _ = same_in_tp("krl", GROUP)
    listing = "".join(shown.values())
    assert "DO[41]=ON" in listing
    assert "DO[43]=OFF" in listing


COUNTER = """&ACCESS RVP
DEF P( )
DECL INT I,N,A[3]
DECL REAL R
R=1.5
N=0
FOR I=1 TO 3
  N=N+I
  A[I]=N
ENDFOR
I=N/2+A[2]
$OUT[1]=(I==6)
N=R*4
I=N-7/2
$OUT[2]=(I==3)
END
"""


def test_a_counter_is_calculated_with_elsewhere() -> None:
    shown, _ = same_in_tp("krl", COUNTER)
    assert "TRUNC" not in "".join(shown.values())


def test_a_group_is_set_from_an_input_over_a_register() -> None:
    """`GO[1]=GI[2]` is refused by the loader (CrossArm validation, LS format 10)."""
    text = "MODULE m\n  PROC p()\n    SetGO go1,GInput(gi2);\n  ENDPROC\nENDMODULE\n"
    shown, _ = same_in_tp("rapid", text)
    (line, setting) = [one for one in "".join(shown.values()).splitlines() if "GI[" in one or "GO[" in one]
    assert "R[" in line.partition("=")[0] and line.rstrip(" ;").endswith("=GI[2]")
    assert setting.rstrip(" ;").partition(":")[2].strip().startswith("GO[1]=R[")
