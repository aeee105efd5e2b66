"""A background task that is declared and also controlled: every target runs it."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import entry_name, run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

KUKA = "kuka_kr6r900sixx"
PROGRAM = """ENTRY work
TASK guard ENTRY watch BACKGROUND
MODULE cell
    VAR asked: INT = 0
    VAR served: INT = 0
    VAR beats: INT = 0
    VAR closing: BOOL = FALSE
    PROCEDURE work()
        VAR i: INT
        WAIT 0.1 s
        START TASK guard
        FOR i = 1 TO 3
            asked = asked + 1
            WAIT UNTIL served = asked TIMEOUT 5 s ERROR timeout
        END FOR
        closing = TRUE
        JOIN TASK guard
        SET do[1] TO served = 3 AND beats = 3
    END PROCEDURE
    PROCEDURE watch()
        WHILE NOT closing
            IF served < asked THEN
                beats = beats + 1
                served = served + 1
            END IF
            WAIT 0.05 s
        END WHILE
    END PROCEDURE
END MODULE
"""


@pytest.mark.parametrize("target", ["krl", "rapid", "urscript", "vplus", "inform", "tp"])
def test_a_declared_task_is_controlled(target: str) -> None:
    read = read_sources([source_from_text("cell.rpl", PROGRAM)], "rpl", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, KUKA, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    entry = entry_name(back.program, written.renamed.get("work", "work"))
    result = run_program(back.program, KUKA, None, entry, 30.0)
    assert result.status == "finished", result.fault
    on = [event for event in result.trace if event.kind == "output" and event.data["value"] is True]
    assert any((one.port and one.port[1] == 1) or one.data["signal"] == "do1" for one in on)
