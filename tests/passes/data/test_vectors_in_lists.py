"""Elements that are vectors, and components of elements that are: they are set as a whole and read, in every target."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import entry_name, run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

KUKA = "kuka_kr6r900sixx"
PROGRAM = """MODULE ring
    RECORD gauge (at: VECTOR, reading: REAL)
    VAR gauges: ARRAY[4] OF gauge
    VAR corners: ARRAY[4] OF VECTOR
    PROCEDURE main()
        VAR i: INT
        VAR around: REAL = 0.0
        VAR worst: gauge
        FOR i = 1 TO 4
            gauges[i].at = {x: 50 * cos(to_real(i) * 90), y: 50 * sin(to_real(i) * 90), z: i}
            gauges[i].reading = to_real(i) / 4
            corners[i] = {x: i, y: 2 * i, z: 0}
        END FOR
        FOR i = 1 TO 4
            around = around + distance(gauges[i].at, gauges[i MOD 4 + 1].at)
        END FOR
        worst = gauges[3]
        corners[2] = corners[4]
        SET do[1] TO abs(around - 282.9) < 1 AND abs(gauges[2].at.x + 50) < 0.001
        SET do[2] TO abs(worst.at.y + 50) < 0.001 AND worst.at.z = 3 AND worst.reading = 0.75
        SET do[3] TO corners[2].x = 4 AND corners[2].y = 8 AND corners[1].y = 2
    END PROCEDURE
END MODULE
"""


@pytest.mark.parametrize("target", ["krl", "rapid", "urscript", "vplus", "inform", "tp"])
def test_vectors_in_lists(target: str) -> None:
    read = read_sources([source_from_text("ring.rpl", PROGRAM)], "rpl", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, KUKA, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    result = run_program(back.program, KUKA, None, entry_name(back.program, written.renamed.get("main", "main")), 30.0)
    assert result.status == "finished", result.fault
    on = [event for event in result.trace if event.kind == "output" and event.data["value"] is True]
    assert len(on) == 3
