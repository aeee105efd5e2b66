"""A program of V+ that runs is not executed again, so pulses of one statement follow each other, which is said."""

from tests.there_and_back import there_and_back

LOOP = "DEF q()\nDECL INT i\nFOR i=4 TO 6\nPULSE($OUT[i],TRUE,0.5)\nWAIT SEC 0.1\nENDFOR\nWAIT SEC 1\nEND\n"


def test_vplus_says_that_one_pulse_runs_at_a_time() -> None:
    given = there_and_back({"q.src": LOOP}, "krl", "vplus")
    assert "vplus-one-pulse" in [item.code.name for item in given.found]
