"""Moves from here in a loop (V+ DRIVE): the move of the pass before has ended when the place is asked for."""

from __future__ import annotations

import pytest

from tests.there_and_back import there_and_back

PROGRAM = """.PROGRAM main()
 AUTO j[6], k
 MOVE #PPOINT(0,-90,180,0,60,0)
 FOR k = 1 TO 3
 DRIVE k, 2, 100
 DRIVE 6, -1, 100
 END
 BREAK
 DECOMPOSE j[1] = #PHERE
 IF (ABS(j[1]-2) < 0.01) AND (ABS(j[2]+88) < 0.01) AND (ABS(j[3]-182) < 0.01) AND (ABS(j[6]+3) < 0.01) THEN
 SIGNAL 1
 END
.END
"""


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "urscript", "vplus", "rpl"])
def test_every_pass_starts_from_the_end_of_the_one_before(target: str) -> None:
    journey = there_and_back({"main.v2": PROGRAM}, "vplus", target, "adept_viper_s650")
    assert not journey.losses
    result = journey.run()
    assert result.status == "finished" and len(result.outputs) == 1
