"""Places that tell no turn, reached from where a path has left the arm: their CONFIG has the turn the arm is in."""

import pytest

from tests.there_and_back import there_and_back

PROGRAM = """DEF main( )
DECL E6AXIS AX
BAS(#INITMOV,0)
PTP {A1 0.0,A2 -90.0,A3 90.0,A4 0.0,A5 90.0,A6 0.0}
PTP {X 420.0,Y -210.0,Z 300.0,A -30.0,B 0.0,C 180.0,S 'B010',T 'B100010'}
%s
PTP {FRAME: X 420.0,Y -230.0,Z 300.0,A -30.0,B 0.0,C 180.0}
AX=$AXIS_ACT
$OUT[1]=AX.A6<-175.0
PTP {A1 0.0,A2 -90.0,A3 90.0,A4 0.0,A5 90.0,A6 0.0}
END
"""
BY_WAY = {
    "by a line, whatever its point tells": "LIN {X 420.0,Y -210.0,Z 300.0,A -30.0,B 0.0,C 180.0,S 'B010',T 'B000010'}",
    "by an arc": "CIRC {X 430.0,Y -220.0,Z 300.0,A -30.0,B 0.0,C 180.0},"
    "{X 420.0,Y -225.0,Z 300.0,A -30.0,B 0.0,C 180.0,S 'B010',T 'B000010'}",
    "from the place itself": "",
}


@pytest.mark.parametrize("way", BY_WAY.values(), ids=BY_WAY)
@pytest.mark.parametrize("target", ["tp", "vplus", "urscript", "inform", "rapid", "krl"])
def test_the_arm_stays_in_the_turn_of_its_axes(way: str, target: str) -> None:
    trip = there_and_back({"main.src": PROGRAM % way}, "krl", target, "kuka_kr6r900sixx")
    result = trip.run()
    assert result.status == "finished", result.fault
    assert trip.switched_on(result) == {1}
