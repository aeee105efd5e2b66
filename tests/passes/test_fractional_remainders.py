"""MOD of numbers that may be fractional (V+, angles) in every language."""

from __future__ import annotations

import pytest

from tests.there_and_back import there_and_back

PROGRAM = """.PROGRAM main()
 AUTO a, i, s, r, v[4]
 a = 7.5
 IF (a MOD 2 == 1.5) AND ((-a) MOD 2 == -1.5) THEN
 SIGNAL 1
 END
 s = 0
 FOR i = 0 TO 2 STEP 0.5
 s = s+(i*400 MOD 360)
 END
 IF s == 560 THEN
 SIGNAL 2
 END
 v[1] = 7
 a = 5.5
 CALL rest(17, 5, r)
 IF (r == 2) AND (v[(a*2) MOD 2] == 7) THEN
 SIGNAL 3
 END
.END
.PROGRAM rest(a, b, r)
 IF (a+1) MOD 3 == 0 THEN
 r = a MOD b
 END
.END
"""


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "urscript", "inform", "vplus", "rpl"])
def test_the_rest_keeps_its_fraction(target: str) -> None:
    journey = there_and_back({"main.v2": PROGRAM}, "vplus", target, "adept_viper_s650")
    assert not journey.losses
    result = journey.run()
    assert result.status == "finished" and len(result.outputs) == 3
