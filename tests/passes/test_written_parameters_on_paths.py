"""Places on the path, said at the move or stored, whose routine writes a parameter of its caller."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import entry_name, run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

KUKA = "kuka_kr16_2"
PROGRAM = """ENTRY main
MODULE cell
    VAR hand: POSE = {{x: 0, y: 0, z: 200, a: 0, b: 0, c: 0}}
    VAR middle: POSE = {{x: 900, y: 0, z: 500, a: 0, b: 180, c: 0}}
    VAR passed: REAL = 0.0
    PROCEDURE note(REFERENCE mark: REAL)
        mark = 7.0
    END PROCEDURE
    PROCEDURE main()
        VAR glue: TRIGGER
        $tool = hand
        MOVE TO {{j1: 0, j2: -90, j3: 90, j4: 0, j5: 90, j6: 0}} JOINT SPEED 50 %
        MOVE LINEAR TO middle SPEED 200 mm/s
{lines}
        WAIT FOR MOTION
        SET do[1] TO passed = 7.0
    END PROCEDURE
END MODULE
"""
SAID = """        TRIGGER AT end DISTANCE -50 mm DO note(passed)
        MOVE LINEAR TO offset(middle, 0, 200, 0) SPEED 100 mm/s"""
STORED = """        DEFINE TRIGGER glue AT start DISTANCE 30 mm DO note(passed)
        MOVE LINEAR TO offset(middle, 0, 200, 0) SPEED 100 mm/s TRIGGER glue"""
ASSIGNED = """        DEFINE TRIGGER glue AT start DISTANCE 30 mm DO passed = 7.0
        MOVE LINEAR TO offset(middle, 0, 200, 0) SPEED 100 mm/s TRIGGER glue"""


@pytest.mark.parametrize("target", ["urscript", "rapid"])
@pytest.mark.parametrize("lines", [SAID, STORED, ASSIGNED], ids=["said", "stored", "stored assignment"])
def test_what_the_routine_writes_arrives(lines: str, target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("cell.rpl", PROGRAM.format(lines=lines))], "rpl", diagnostics)
    done = translate_program(read, target, KUKA, None, diagnostics)
    lost = [item.as_text() for item in diagnostics.of(Severity.LOSS) if item.code.name != "angles-normalised"]
    assert not lost
    back = read_sources([source_from_bytes(file.path, file.data) for file in done.files], target, Diagnostics())
    entry = entry_name(read.program, None)
    begins = back.program.entry or done.renamed.get(entry or "", entry or "")
    result = run_program(back.program, KUKA, None, begins, 60.0)
    assert (result.status, result.fault) == ("finished", None)
    switched = [event for event in result.trace if event.kind == "output"]
    assert switched and switched[-1].data["value"]
