"""An output that changes later is the one at which the pulse began, whatever the program counts meanwhile."""

from tests.there_and_back import there_and_back

LOOP = "DEF q()\nDECL INT i\nFOR i=4 TO 6\nPULSE($OUT[i],TRUE,0.5)\nWAIT SEC 0.1\nENDFOR\nWAIT SEC 1\nEND\n"
ONCE = "DEF q()\nDECL INT i\ni=4\nPULSE($OUT[i],TRUE,0.5)\ni=5\n$OUT[5]=TRUE\nWAIT SEC 1\nEND\n"


def _changes(text: str) -> list[tuple[float, int, object]]:
    given = there_and_back({"q.src": text}, "krl", "urscript")
    assert not given.losses
    result = given.run("q")
    return sorted((round(t, 1), int(name.partition("[")[2][:-1]) + 1, value) for t, name, value in result.outputs)


def test_each_pulse_ends_its_own_output() -> None:
    begun = [(0.0, 4, True), (0.1, 5, True), (0.2, 6, True)]
    assert _changes(LOOP) == [*begun, (0.5, 4, False), (0.6, 5, False), (0.7, 6, False)]


def test_a_number_that_changes_at_once_changes_nothing() -> None:
    assert _changes(ONCE) == [(0.0, 4, True), (0.0, 5, True), (0.5, 4, False)]


def test_vplus_says_that_one_pulse_runs_at_a_time() -> None:
    given = there_and_back({"q.src": LOOP}, "krl", "vplus")
    assert "vplus-one-pulse" in [item.code.name for item in given.found]
