"""What a pass does in the body of a routine it does in its handlers too: a statement there runs as any other."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.simulation import entry_name
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ROBOT = "kuka_kr6r900sixx"
MODULE = """VAR n: REAL = 0.0
VAR high: TARGET = {x: 500, y: 50, z: 400, a: 0, b: 180, c: 0}

PROCEDURE main()
    MOVE TO {j1: 0, j2: -90, j3: 90, j4: 0, j5: 90, j6: 0}
    MOVE LINEAR TO high SPEED 100 mm/s FINE
    divided()
    MOVE LINEAR TO high SPEED 100 mm/s FINE
END PROCEDURE

PROCEDURE divided()
    VAR way: REAL
    way = 1.0 / n
    MESSAGE "not here"
ON ERROR division_by_zero
%s
    n = 2.0
    RETRY
END PROCEDURE
"""
BASE = "MOVE LINEAR BY {z: 20} IN BASE SPEED 50 mm/s FINE"
HANDLERS = {
    "a way along an axis of the base": BASE,
    "a way that turns the tool": "MOVE LINEAR BY {z: -10, b: 12} IN TOOL SPEED 50 mm/s FINE",
    "two ways in a row": f"{BASE}\n{BASE}",
}


@pytest.mark.parametrize("target", ["rapid", "urscript", "vplus", "krl"])
@pytest.mark.parametrize("name", HANDLERS)
def test_relative_moves_in_a_handler(name: str, target: str) -> None:
    moves_are_equal(MODULE % HANDLERS[name], target)


def moves_are_equal(text: str, target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("t.rpl", text)], "rpl", diagnostics)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics.of(Severity.ERROR)]
    diagnostics = Diagnostics()
    written = translate_program(read, target, ROBOT, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    result = prove_programs(read.program, back.program, ROBOT, entry="main", to_entry=entry_name(back.program))
    assert result.verdict in ("equal", "alike"), result.as_text()  # speeds of joints and of turning are approximated


TASK = """VAR n: REAL = 0.0
VAR seen: REAL = 0.0

PROCEDURE main()
    divided()
    WAIT 0.5 s
    n = seen
    do[3] = n > 4.0
END PROCEDURE

PROCEDURE divided()
    VAR way: REAL
    way = 1.0 / n
ON ERROR division_by_zero
    START TASK beside(5.0)
    n = 2.0
    RETRY
END PROCEDURE

PROCEDURE beside(x: REAL)
    WAIT 0.1 s
    seen = x
END PROCEDURE
"""


@pytest.mark.parametrize("target", ["tp", "inform", "urscript", "vplus"])
def test_a_task_that_a_handler_starts_is_given_its_arguments(target: str) -> None:
    moves_are_equal(TASK, target)


@pytest.mark.parametrize("target", ["rapid", "tp", "vplus", "urscript"])
@pytest.mark.parametrize("ending", ["RETURN", "n = 2.0"])
def test_a_task_that_ends_in_a_handler_has_ended(ending: str, target: str) -> None:
    """Where the target cannot wait for a task, a flag says that it runs: also the end of a handler takes it back."""
    text = TASK.replace("START TASK beside(5.0)\n    n = 2.0\n    RETRY", "seen = 5.0\n    " + ending)
    text = text.replace("    divided()\n    WAIT 0.5 s\n", "    START TASK divided()\n    JOIN TASK divided\n")
    moves_are_equal(text, target)
