"""An output that changes later is the one at which the pulse began, whatever the program counts meanwhile."""

from rpl.cell import Cell, parse_cell
from tests.there_and_back import there_and_back

LOOP = "DEF q()\nDECL INT i\nFOR i=4 TO 6\nPULSE($OUT[i],TRUE,0.5)\nWAIT SEC 0.1\nENDFOR\nWAIT SEC 1\nEND\n"
ONCE = "DEF q()\nDECL INT i\ni=4\nPULSE($OUT[i],TRUE,0.5)\ni=5\n$OUT[5]=TRUE\nWAIT SEC 1\nEND\n"


LEVEL = "DEF q()\nPULSE($OUT[4],$IN[3],0.5)\nWAIT SEC 1\nEND\n"
PARTS = (
    "DEF q()\nDECL INT i\nDECL INT k[3]\nREAL t\nBOOL b\ni=2\nk[2]=3\nt=0.5\nb=TRUE\nPULSE($OUT[k[i]+1],b,t)\n"
    "i=1\nk[2]=7\nt=0.1\nb=FALSE\nWAIT SEC 1\nEND\n"
)
COUNTED = """DEF q()
DECL GLOBAL INT n
n=3
PULSE($OUT[next()],TRUE,0.5)
WAIT SEC 1
END
DEFFCT INT next()
n=n+1
RETURN n
ENDFCT
"""


def _changes(text: str, cell: Cell | None = None) -> list[tuple[float, int, object]]:
    given = there_and_back({"q.src": text}, "krl", "urscript")
    assert not given.losses
    result = given.run("q", cell)
    return sorted((round(t, 1), int(name.partition("[")[2][:-1]) + 1, value) for t, name, value in result.outputs)


def test_each_pulse_ends_its_own_output() -> None:
    begun = [(0.0, 4, True), (0.1, 5, True), (0.2, 6, True)]
    assert _changes(LOOP) == [*begun, (0.5, 4, False), (0.6, 5, False), (0.7, 6, False)]


def test_a_number_that_changes_at_once_changes_nothing() -> None:
    assert _changes(ONCE) == [(0.0, 4, True), (0.0, 5, True), (0.5, 4, False)]


def test_the_level_is_that_of_the_beginning() -> None:
    """Off at the beginning, so on at the end, though the input that gave the level has changed meanwhile."""
    cell = parse_cell('[[input]]\ntime = 0.3\nsignal = "$IN[3]"\nvalue = true\n')
    assert _changes(LEVEL, cell) == [(0.5, 4, True)]


def test_number_level_and_time_are_computed_once() -> None:
    assert _changes(PARTS) == [(0.0, 4, True), (0.5, 4, False)]


def test_a_function_is_not_called_twice() -> None:
    given = there_and_back({"q.src": COUNTED}, "krl", "urscript")
    assert any("by a function, which would be called twice" in item.as_text() for item in given.found)
