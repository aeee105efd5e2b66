"""Conditions of many parts are put together in several lines where one is too short."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.simulation import entry_name
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PARTS = " AND ".join(f"measured_value_{n} * {n} < highest_value_{n}" for n in range(1, 10))
EITHER = " OR ".join(f"measured_value_{n} > highest_value_{n} + {n}" for n in range(1, 9))
DATA = "".join(f"VAR measured_value_{n}: REAL = {n}.0\nVAR highest_value_{n}: REAL = {n * n}.5\n" for n in range(1, 10))
PROGRAM = f"""{DATA}
PROCEDURE main()
    VAR good: BOOL
    SET do[1] TO {PARTS}
    good = NOT ({EITHER})
    IF good AND {PARTS} THEN
        SET do[2] TO ON
    ELSE
        SET do[3] TO ON
    END IF
    measured_value_8 = 100.0
    IF {PARTS} THEN
        SET do[4] TO ON
    END IF
    SET do[5] TO {EITHER}
END PROCEDURE
"""


@pytest.mark.parametrize("target", ["tp", "inform", "vplus"])
def test_long_conditions(target: str) -> None:
    read = read_sources([source_from_text("p.rpl", PROGRAM)], "rpl", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, "kuka_kr6r900sixx", None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    entry = entry_name(back.program, written.renamed.get("main", "main"))
    result = prove_programs(read.program, back.program, "kuka_kr6r900sixx", entry="main", to_entry=entry)
    assert result.equal, result.as_text()
