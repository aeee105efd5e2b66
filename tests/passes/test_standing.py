"""Controllers whose stop points hold the program against one that runs ahead over all moves."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.simulation import entry_name, run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

KUKA = "kuka_kr6r900sixx"
HEAD = """VAR seen: INT = 0
VAR watch: CLOCK
VAR part: INTERRUPT
VAR passed: REAL
VAR p: POSE
TRAP counted()
    seen = seen + 1
END TRAP
PROCEDURE watched()
    INTERRUPT DELETE part
END PROCEDURE
PROCEDURE main()
    p = {x: 500, y: 50, z: 400, a: 0, b: 180, c: 0}
    MOVE TO p
    CONNECT part TO counted
    ARM part ON edge WHEN $timer[1] > 0.3
    $timer[1] = 0
    $timer_stopped[1] = FALSE
    MOVE LINEAR TO offset(p, 0, 0, 60) SPEED 100 mm/s
"""
TAIL = "\n    SET do[1] TO {}\nEND PROCEDURE\n"
# What stands behind a move of 0.6 s during which the interrupt comes, and what holds then.
CASES = [
    ("INTERRUPT DELETE part", "seen = 1"),
    ("watched()", "seen = 1"),
    ("IF seen = 1 THEN p.x = 1", "p.x = 1"),
    ("passed = $timer[1]", "passed > 0.55"),
    (
        "CLOCK RESET watch\n    CLOCK START watch\n    MOVE LINEAR TO p SPEED 100 mm/s\n    CLOCK STOP watch",
        "clock_seconds(watch) > 0.55",
    ),
]


@pytest.mark.parametrize(("behind", "holds"), CASES)
def test_nothing_comes_before_the_robot_stands(behind: str, holds: str) -> None:
    text = HEAD + "    " + behind + TAIL.format(holds)
    read = read_sources([source_from_text("p.rpl", text)], "rpl", Diagnostics())
    assert [each[2] for each in run_program(read.program, KUKA).outputs] == [True]
    diagnostics = Diagnostics()
    written = translate_program(read, "krl", KUKA, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], "krl", Diagnostics())
    result = prove_programs(read.program, back.program, KUKA, entry="main", to_entry=entry_name(back.program))
    assert result.equal, result.as_text()
