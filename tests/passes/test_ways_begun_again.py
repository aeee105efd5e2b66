"""A relative move that an interrupt stops goes on to its own end, whatever other interrupts of the program do."""

from __future__ import annotations

import pytest

from rpl.cell.cellfile import Cell, Input
from tests.there_and_back import there_and_back

PROGRAM = """DEF STOPGO( )
DECL E6POS NOW
INTERRUPT DECL 20 WHEN $IN[21]==TRUE DO LOW( )
{other}
BAS(#INITMOV,0)
SETUP( )
$BASE = BASE_DATA[1]
$TOOL = TOOL_DATA[1]
PTP {{X 60.0,Y 40.0,Z 80.0,A 0.0,B 180.0,C 0.0,S 2,T 2}}
INTERRUPT ON 20
$VEL.CP = 0.03
LIN_REL {{Y 90.0}}
WAIT SEC 0
INTERRUPT OFF 20
NOW = $POS_ACT
$OUT[1] = (ABS(NOW.Y-130.0)<0.5) AND (ABS(NOW.X-60.0)<0.5)
FEEL( )
END

DEF LOW( )
BRAKE
$OUT[2] = TRUE
WAIT SEC 0.6
END

DEF FEEL( )
{on}
LIN_REL {{Z 20.0}}
CIRC {{X 70.0,Y 110.0,Z 100.0,A 0.0,B 180.0,C 0.0}},{{X 60.0,Y 90.0,Z 100.0,A 0.0,B 180.0,C 0.0}}
WAIT SEC 0
{off}
$OUT[3] = ABS($POS_ACT.Y-90.0)<0.5
END

DEF SETUP( )
BASE_DATA[1] = {{X 400.0,Y -180.0,Z 150.0,A 0.0,B 0.0,C 0.0}}
TOOL_DATA[1] = {{X 0.0,Y 0.0,Z 120.0,A 0.0,B 0.0,C 0.0}}
END
"""
TOUCHED = """
DEF TOUCHED( )
INTERRUPT OFF 22
BRAKE
RESUME
END
"""
ALONE = {"other": "", "on": "", "off": ""}
WITH_ONE_THAT_LEAVES = {
    "other": "INTERRUPT DECL 22 WHEN $IN[22]==TRUE DO TOUCHED( )",
    "on": "INTERRUPT ON 22",
    "off": "INTERRUPT OFF 22",
}


@pytest.mark.parametrize("target", ["rapid", "tp", "urscript", "vplus", "inform", "rpl"])
@pytest.mark.parametrize("leaves", [False, True], ids=["alone", "with one that leaves its level"])
def test_the_way_ends_where_it_would_have_ended(leaves: bool, target: str) -> None:
    text = PROGRAM.format(**WITH_ONE_THAT_LEAVES) + TOUCHED if leaves else PROGRAM.format(**ALONE)
    journey = there_and_back({"stopgo.src": text}, "krl", target, "kuka_kr6r900sixx")
    assert journey.losses == []
    cell = Cell(inputs=(Input(2.0, "$IN[21]", True),))
    result = journey.run("STOPGO", cell)
    assert result.fault is None
    assert journey.switched_on(result) == {1, 2, 3}
