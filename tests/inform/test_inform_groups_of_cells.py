"""Groups of signals in a cell file, in INFORM's words: IG#(2) is IN#(9) to IN#(16), OGH#(4) is OT#(13) to OT#(16)
(data transmission manual of the NX100). The cell answers the number that a group shows, also where the program sets
its signals one by one, and does the same for the program in every other language."""

import pytest

from rpl.cell import parse_cell
from tests.inform.inform_helpers import job
from tests.there_and_back import there_and_back

ANSWERS = parse_cell(
    """
[[input]]
time = 0.5
signal = "IG#(2)"
value = 77
[[reaction]]
when = "OG#(3)"
becomes = 5
after = 1.0
signal = "IG#(4)"
value = 9
[[reaction]]
when = "OGH#(8)"
becomes = 6
after = 0.5
signal = "IGH#(10)"
value = 12
"""
)

WHOLE = """
DOUT OG#(3) 5
WAIT IG#(2)=77 T=2.0
JUMP *NO IF IG#(2)<>77
DOUT OT#(1) ON
*NO
WAIT IG#(4)=9 T=2.0
JUMP *NEVER IF IG#(4)<>9
DOUT OT#(2) ON
*NEVER
DOUT OGH#(8) 6
WAIT IGH#(10)=12 T=2.0
JUMP *END IF IGH#(10)<>12
DOUT OT#(3) ON
*END
"""
BIT_BY_BIT = """
DOUT OT#(17) ON
DOUT OT#(19) ON
WAIT IN#(9)=ON
DIN B000 IG#(2)
JUMP *NO IF B000<>77
DOUT OT#(1) ON
*NO
WAIT IN#(28)=ON T=2.0
JUMP *NEVER IF IN#(25)=OFF
DOUT OT#(2) ON
*NEVER
DOUT OT#(30) ON
DOUT OT#(31) ON
WAIT IN#(40)=ON T=2.0
JUMP *END IF IN#(39)=OFF
DOUT OT#(3) ON
*END
"""


@pytest.mark.parametrize("body", [WHOLE, BIT_BY_BIT], ids=["whole", "bit-by-bit"])
@pytest.mark.parametrize("target", ["inform", "krl", "rapid", "rpl", "tp", "urscript", "vplus"])
def test_groups_of_a_cell_are_their_signals(body: str, target: str) -> None:
    journey = there_and_back({"TEST.JBI": job(body)}, "inform", target)
    assert not journey.losses
    result = journey.run("TEST", ANSWERS)
    assert result.fault is None and {1, 2, 3} <= journey.switched_on(result)
