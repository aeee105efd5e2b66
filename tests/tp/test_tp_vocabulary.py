"""Words of TP and their forms, each with what the manual says comes of it: programs that set DO[1] where it holds."""

from __future__ import annotations

import pytest
from tp_reading_helpers import listing, outputs, run

LAMP = '/PROG  SETLAMP Macro\n/ATTR\nCOMMENT\t\t= "Set Lamp";\n/MN\n   1:  R[1]=AR[1]+AR[2] ;\n/POS\n/END\n'

HOLDS = (
    # macros with arguments, among them registers with comments
    ("R[2:much]=4\nSet Lamp(3,R[2:much])", "R[1]=7"),
    # instructions of the controller's administration are passed by
    ("RSR[1] ENABLE\nRSR[2]=DISABLE\nRETURN_PATH_DSBL\nDIAG_REC[1,100,200]\nSample Start[1]\nR[1]=1", "R[1]=1"),
    ("JOINT_MAX_SPEED[1]=100\nLINEAR_MAX_SPEED=500\nTORQ_LIMIT 50%\nR[1]=1", "R[1]=1"),
    # registers behind CNT, ACC and CR without a blank
    ("R[1]=50\nL P[2] 200mm/sec CNTR[1] ACCR[1]\nL P[3] 200mm/sec CRR[1]\nJ P[1] 50% FINE\nR[2]=1", "R[2]=1"),
    # DIV cuts the quotient, of fractional numbers too
    ("R[1]=7.9\nR[2]=R[1] DIV 2", "R[2]=3"),
)


@pytest.mark.parametrize(("lines", "expected"), HOLDS)
def test_words(lines: str, expected: str) -> None:
    main = listing(f"UFRAME_NUM=0\nUTOOL_NUM=1\nJ P[1] 50% FINE\n{lines}\nIF ({expected}),DO[1]=(ON)")
    result = run(main, LAMP)
    assert (result.status, outputs(result)) == ("finished", [("DO[1]", True)])


def test_blocks_in_german() -> None:
    lines = "WENN (E[1]) DANN\nA[2]=AN\nSONST\nA[1]=AN\nENDE WENN"
    assert outputs(run(listing(lines, german=True))) == [("DO[1]", True)]
