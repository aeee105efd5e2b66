"""Words of the system that programs use without declaring them: each clause switches an output where it holds."""

from __future__ import annotations

import pytest
from krl_helpers import sources

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.passes.typing import normalise
from rpl.simulation import run_program

ROBOT = "kuka_kr6r900sixx"
START = "BAS(#INITMOV,0)\nPTP {A1 0.0,A2 -80.0,A3 100.0,A4 0.0,A5 70.0,A6 0.0}\n"
# declarations, lines, the condition that holds behind them
CLAUSES = {
    "no move": ("", "WAIT SEC 0.1", "$ROB_STOPPED AND $PERI_RDY AND NOT $STOPMESS"),
    "a moment ago": (
        "INT T0,T1",
        "WAIT SEC 0\nT0=$ROB_TIMER\nWAIT SEC 0.2\nT1=$ROB_TIMER",
        "(T1-T0>=190) AND (T1-T0<300)",
    ),
    "joints at the end": ("E6AXIS A", "PTP {A1 12.0}\nWAIT SEC 0\nA=$AXIS_FOR", "ABS(A.A1-12.0)<0.01"),
    "one joint at the end": ("", "PTP {A1 12.0}\nWAIT SEC 0", "ABS($AXIS_FOR.A1-12.0)<0.01"),
    "measured joints": ("E6AXIS A", "A=$AXIS_ACT_MES", "(A.A2==-80.0) AND ($AXIS_ACT_MEAS.A5==70.0)"),
    "measured place": ("E6POS P", "P=$POS_ACT_MES", "ABS(P.X-$POS_ACT.X)<0.01"),
    "shared numbers": ("", "$SEN_PINT[3]=7\n$SEN_PREA[2]=1.5", "($SEN_PINT[3]==7) AND ($SEN_PREA[2]==1.5)"),
    "no error": ("", "ON_ERROR_PROCEED", "$ERR.NUMBER==0"),
    "three external axes": (
        "E3POS P\nE3AXIS A",
        "P={X 1.0,Y 2.0,Z 3.0,A 0.0,B 0.0,C 0.0,S 2,T 2,E1 0.0,E2 0.0,E3 0.0}\nA={A1 1.0,A2 -90.0,A3 90.0}",
        "(P.X==1.0) AND (A.A3==90.0)",
    ),
    "settings of the smoothness": (
        "",
        "$FILTER=10\n$SPL_VEL_MODE=#CART\n$SPL_ORI_JOINT_AUTO=#ON\n$ECO_LEVEL=#LOW\n$JERK.CP=400.0\n$ADAP_ACC=#STEP2",
        "($FILTER==10) AND ($JERK.CP==400.0)",
    ),
    "jerk of an inline form": (
        "LDAT D",
        "D=LDAT_ACT\nSLIN_REL {Z 10.0} WITH $JERK=SJERK(D),$COLLMON_TOL_PRO[1]=USE_CM_PRO_VALUES(0) C_SPL\nWAIT SEC 0",
        "$JERK.CP==500.0",
    ),
    "constant speed in a spline": (
        "E6POS P",
        "P=$POS_ACT\nSPLINE\nSLIN_REL {Y 10.0}\nCONST_VEL START=+2\nSLIN_REL {Y 10.0}\nCONST_VEL END=-2\nENDSPLINE",
        "ABS($POS_ACT.Y-P.Y-20.0)<0.05",
    ),
}
MEASURED = {
    "$SOFTN_END[1]": ir.RealType(),
    "$VEL_MA.CP": ir.RealType(),
    "$DATE.YEAR": ir.IntType(),
    "$IN_HOME2": ir.BoolType(),
}


def text_of(declared: str, lines: str, holds: str) -> str:
    return f"DEF WORDS()\n{declared}\n{START}{lines}\n$OUT[1]={holds}\nEND\n"


@pytest.mark.parametrize("name", CLAUSES)
def test_a_word_of_the_system_means_what_the_manual_says(name: str) -> None:
    diagnostics = Diagnostics()
    read = registry.dialect("krl").read(sources({"words.src": text_of(*CLAUSES[name])}), diagnostics)
    result = run_program(normalise(read.program, diagnostics), ROBOT, None, None, 60.0)
    assert not [item.as_text() for item in diagnostics]
    assert result.status == "finished", result.fault
    assert [event.data["value"] for event in result.trace if event.kind == "output"] == [True]


@pytest.mark.parametrize("text", MEASURED)
def test_what_only_a_controller_knows_is_asked_of_the_cell_file(text: str) -> None:
    diagnostics = Diagnostics()
    read = registry.dialect("krl").read(sources({"p.src": f"DEF P()\nX={text}\nEND\n"}), diagnostics)
    (assign,) = read.program.modules[0].routines[0].body
    assert isinstance(assign, ir.Assign)
    assert assign.value == ir.VendorValue("krl", text, MEASURED[text])
