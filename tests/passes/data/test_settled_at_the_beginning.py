"""Tools that the beginning of a program works out and sets: constants from then on, where nothing else may set them."""

from __future__ import annotations

import pytest

from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.values import pose_of

from .helpers import read

DATA = "DEFDAT t\nDECL FRAME TOOL_DATA[3]\nDECL FRAME PLACES[3]\nDECL FRAME FIRST[2]\nENDDAT\n"
SETUP = (
    "DEF setup(i:IN,z:IN)\nINT i\nREAL z\n"
    + "".join(f"PLACES[i].{one}=0.0\n" for one in "XYABC")
    + "PLACES[i].Z=z\nEND\n"
)
FUNCTION = "DEFFCT FRAME moved(f:IN)\nFRAME f\nf.Z=f.Z+100.0\nRETURN f\nENDFCT\n"
WHOLE = "PLACES[2]={X 0.0,Y 0.0,Z 5.0,A 0.0,B 0.0,C 0.0}\n"
MAKES = "setup(2,900.0)\nTOOL_DATA[2]=PLACES[2]\n"


@pytest.mark.parametrize(
    ("statements", "z"),
    [
        (MAKES + "$TOOL=TOOL_DATA[2]", 900.0),
        ("n=2\nsetup(n,450.0*n)\nTOOL_DATA[n]=PLACES[n]\n$TOOL=TOOL_DATA[2]", 900.0),
        ("n=1\nWHILE n<3\nn=n+1\nsetup(n,450.0*n)\nENDWHILE\nTOOL_DATA[2]=PLACES[2]\n$TOOL=TOOL_DATA[2]", 900.0),
        ("setup(2,800.0)\nTOOL_DATA[2]=moved(PLACES[2])\n$TOOL=TOOL_DATA[2]", 900.0),
        (MAKES + "$TOOL=TOOL_DATA[2]\n" + MAKES, 900.0),
        (MAKES + "$TOOL=TOOL_DATA[2]\nsetup(2,1.0)\nTOOL_DATA[2]=PLACES[2]", None),
        ("$TOOL=TOOL_DATA[2]\n" + MAKES, None),  # it is used before
        ("IF $IN[1] THEN\nGOTO away\nENDIF\n" + MAKES + "away:\n$TOOL=TOOL_DATA[2]", None),
        ("setup(2,900.0)\nIF $IN[1] THEN\nPLACES[2].Z=1.0\nENDIF\nTOOL_DATA[2]=PLACES[2]\n$TOOL=TOOL_DATA[2]", None),
        ("setup(2,900.0)\naway:\nTOOL_DATA[2]=PLACES[2]\n$TOOL=TOOL_DATA[2]\nGOTO away", None),
        (MAKES + "$TOOL=TOOL_DATA[2]\nTOOL_DATA[2].Z=3.0", None),
        (WHOLE + "PLACES[2].Z=7.0\nTOOL_DATA[2]=PLACES[2]\n$TOOL=TOOL_DATA[2]", 7.0),
        (WHOLE + "PLACES[2].Z=$TIMER[1]\nTOOL_DATA[2]=PLACES[2]\n$TOOL=TOOL_DATA[2]", None),  # the run decides
        (MAKES + "$TOOL=TOOL_DATA[2]\nlate( )", None),
    ],
)
def test_a_tool_that_is_set_once(statements: str, z: float | None) -> None:
    late = "DEF late( )\nTOOL_DATA[2]=$NULLFRAME\nEND\n" if "late" in statements else ""
    text = f"DEF t( )\nINT n\n{statements}\nPTP {{A1 1}}\nEND\n{SETUP}{FUNCTION}{late}====\n{DATA}"
    settled = unchanged_in(read(text, "krl")).settled
    found = pose_of(settled.get(("tool_data", (2,))))
    assert (None if found is None else found.position.z) == z


def test_elements_that_nothing_sets_keep_their_first_value() -> None:
    frames = "".join(f"BASES[{at}]={{X {at}.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}}\n" for at in (1, 2))
    data = f"DEFDAT t\nDECL FRAME BASES[2]\n{frames}ENDDAT\n"
    text = f"DEF t( )\nBASES[2]=$POS_ACT\n$BASE=BASES[1]\nPTP {{A1 1}}\nEND\n====\n{data}"
    settled = unchanged_in(read(text, "krl")).settled
    first = pose_of(settled.get(("bases", (1,))))
    assert first is not None and first.position.x == 1.0
    assert ("bases", (2,)) not in settled
