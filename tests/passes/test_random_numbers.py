"""Random numbers in languages that have none: calculated, evenly spread, with a warning that they are others."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import entry_name, run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

KUKA = "kuka_kr6r900sixx"
PROGRAM = """VAR seen: INT = 0
VAR low: INT = 0
VAR one: REAL
VAR total: REAL = 0
VAR i: INT
PROCEDURE main()
    FOR i = 1 TO 40
        one = random()
        IF one >= 0 AND one < 1 THEN seen = seen + 1
        IF random() < 0.5 THEN low = low + 1
        total = total + one
    END FOR
    SET do[1] TO seen = 40
    SET do[2] TO total > 12 AND total < 28
    SET do[3] TO low > 8 AND low < 32
    one = random() - random()
    SET do[4] TO one <> 0 AND abs(one) < 1
END PROCEDURE
"""


@pytest.mark.parametrize(
    ("target", "calculated"), [("rapid", True), ("tp", True), ("inform", True), ("krl", False), ("vplus", False)]
)
def test_random_numbers_are_spread_in_every_language(target: str, calculated: bool) -> None:
    read = read_sources([source_from_text("p.rpl", PROGRAM)], "rpl", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, KUKA, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    assert ("random-numbers-calculated" in {item.code.name for item in diagnostics}) == calculated
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    result = run_program(back.program, KUKA, entry=entry_name(back.program))
    assert result.status == "finished"
    assert len({name for _, name, value in result.outputs if value}) == 4
