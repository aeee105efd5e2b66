"""Words of TP and their forms, each with what the manual says comes of it: programs that set DO[1] where it holds."""

from __future__ import annotations

import pytest
from tp_reading_helpers import as_rpl, listing, outputs, read, reports, run

LAMP = '/PROG  SETLAMP Macro\n/ATTR\nCOMMENT\t\t= "Set Lamp";\n/MN\n   1:  R[1]=AR[1]+AR[2] ;\n/POS\n/END\n'
LOCALS = listing("R[10001]=R[10001]+1\nR[1]=R[10001]", name="LOCALS")

HOLDS = (
    # macros with arguments, among them registers with comments
    ("R[2:much]=4\nSet Lamp(3,R[2:much])", "R[1]=7"),
    # instructions of the controller's administration are passed by
    ("RSR[1] ENABLE\nRSR[2]=DISABLE\nRETURN_PATH_DSBL\nDIAG_REC[1,100,200]\nSample Start[1]\nR[1]=1", "R[1]=1"),
    ("JOINT_MAX_SPEED[1]=100\nLINEAR_MAX_SPEED=500\nTORQ_LIMIT 50%\nR[1]=1", "R[1]=1"),
    # registers behind CNT, ACC and CR without a blank
    ("R[1]=50\nL P[2] 200mm/sec CNTR[1] ACCR[1]\nL P[3] 200mm/sec CRR[1]\nJ P[1] 50% FINE\nR[2]=1", "R[2]=1"),
    # a component or a signal by a computed number, where a block opens
    ("PR[1]=P[2]\nR[1]=3\nIF (PR[1,R[1]]=200) THEN\nR[2]=1\nELSE\nR[2]=2\nENDIF", "R[2]=1"),
    ("PR[1]=P[2]\nR[1]=1\nPR[1,1]=3\nFOR R[2]=1 TO PR[1,R[1]]\nR[3]=R[3]+1\nENDFOR", "R[3]=3"),
    ("R[1]=2\nRO[R[1]]=ON\nR[2]=RO[R[1]]\nRO[R[1]]=OFF", "R[2]=1 AND !RO[2]"),
    # frames and tools by their variables
    (
        "PR[1]=P[2]\nUFRAME[3]=PR[1]\nPR[2]=$MNUFRAME[1,3]\n$MNUTOOL[1,2]=PR[1]\nPR[3]=UTOOL[2]",
        "PR[2,1]=400 AND PR[3,1]=400",
    ),
    # M: registers of a call begin at 0 and are nobody else's
    ("R[10001]=7\nCALL LOCALS", "R[10001]=7 AND R[1]=1"),
    # M: what a text begins with is its number
    (
        "SR[1]='12abc'\nR[1]=SR[1]\nSR[2]='abc'\nR[2]=SR[2]\nSR[3]='-2.5'\nR[3]=SR[3]",
        "R[1]=12 AND R[2]=0 AND R[3]=(-2.5)",
    ),
    ("TIMER[1]=RESET\nR[1]=TIMER_OVERFLOW[1]\nL P[2] 200mm/sec CNT50 RT_LD10 AP_LDR[1]", "R[1]=0"),
    # DIV cuts the quotient, of fractional numbers too
    ("R[1]=7.9\nR[2]=R[1] DIV 2", "R[2]=3"),
)


@pytest.mark.parametrize(("lines", "expected"), HOLDS)
def test_words(lines: str, expected: str) -> None:
    main = listing(f"UFRAME_NUM=0\nUTOOL_NUM=1\nJ P[1] 50% FINE\n{lines}\nIF ({expected}),DO[1]=(ON)")
    result = run(main, LAMP, LOCALS)
    assert (result.status, outputs(result)[-1:]) == ("finished", [("DO[1]", True)])


def test_blocks_in_german() -> None:
    lines = "WENN (E[1]) DANN\nA[2]=AN\nSONST\nA[1]=AN\nENDE WENN"
    assert outputs(run(listing(lines, german=True))) == [("DO[1]", True)]


def test_pallet_registers_are_the_controllers_own() -> None:
    program, diagnostics = read(listing("PL[1]=[1,R[2],*]\nIF PL[1]=[1,2,3],R[1]=1\nDO[1]=ON"))
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    assert 'VENDOR tp "PL[1]=[1,R[2],*]" EFFECT unknown' in as_rpl(program)


def test_a_marker_is_worked_out_once_and_that_is_told() -> None:
    _, diagnostics = read(listing("M[1]=(DO[1] AND DI[1])\nM[2]=(ON)"))
    assert reports(diagnostics) == ["tp-marker-once"]
