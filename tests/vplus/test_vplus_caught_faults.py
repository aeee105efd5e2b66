"""Faults of the controller that REACTE catches, run and written anew."""

from __future__ import annotations

import pytest

from rpl.simulation import run_program
from tests.there_and_back import there_and_back

PROGRAM = """.PROGRAM main()
 AUTO u, z
 errs = 0
 z = 0
 REACTE bad
 u = 4/z
 u = SQRT(z-1)+1
 u = SQRT(16)/2
 REACTE
 IF (errs == 2) AND (u == 2) AND (code < 0) THEN
 SIGNAL 1
 END
.END
.PROGRAM bad()
 errs = errs+1
 code = ERROR(-1)
 RETURNE
.END
"""


@pytest.mark.parametrize("target", ["vplus", "rpl"])
def test_divisions_and_roots_come_to_the_routine(target: str) -> None:
    journey = there_and_back({"main.v2": PROGRAM}, "vplus", target, "adept_viper_s650")
    assert run_program(journey.source.program, "adept_viper_s650", None, "main").outputs
    assert not journey.losses
    result = journey.run()
    assert result.status == "finished" and len(result.outputs) == 1
