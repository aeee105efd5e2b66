"""Several robots in one run: each motion task has its own, and they move at the same time."""

import numpy as np
import pytest

from rpl.cell import parse_cell
from rpl.diagnostics import Diagnostics
from rpl.emulator.model import load_robot
from rpl.errors import UsageError
from rpl.project import ReadProgram, read_sources
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program
from rpl.source import source_from_text

FIRST, SECOND = "kuka_kr10r1420", "kuka_kr6r900sixx"
TEXT = """SIGNAL ready = do[1]
TASK left ENTRY weld
TASK right ENTRY hold

PROCEDURE weld()
    MOVE TO joints {j1: 0, j2: -90, j3: 90, j4: 0, j5: 90, j6: 0} FINE
    MOVE LINEAR TO pose {x: 700, y: 100, z: 600, a: 0, b: 180, c: 0} SPEED 100 mm/s FINE
    ready = TRUE
END PROCEDURE

PROCEDURE hold()
    MOVE TO joints {j1: 20, j2: -90, j3: 90, j4: 0, j5: 90, j6: 0} FINE
    WAIT UNTIL ready
    MOVE TO joints {j1: -20, j2: -90, j3: 90, j4: 0, j5: 90, j6: 0} FINE
    SET do[2] TO ON
END PROCEDURE
"""


def program() -> ReadProgram:
    return read_sources([source_from_text("two.rpl", TEXT)], "rpl", Diagnostics())


def run() -> RunResult:
    return run_program(program().program, FIRST, parse_cell(""), further=(SECOND,))


def test_each_task_moves_its_own_robot_at_the_same_time() -> None:
    result = run()
    assert result.status == "finished", result.fault
    moves = {name: [e for e in result.trace if e.kind == "move" and e.task == name] for name in ("left", "right")}
    assert {name: len(found) for name, found in moves.items()} == {"left": 2, "right": 2}
    assert moves["left"][0].legs[0].start_s == moves["right"][0].legs[0].start_s == 0.0
    for name, arm in (("left", FIRST), ("right", SECOND)):
        for event in moves[name]:
            flange = load_robot(arm).forward(np.array(event.data["joints"]))
            assert event.data["xyz_mm"] == pytest.approx(list(flange[:3, 3]), abs=1e-3)
    assert moves["left"][1].data["xyz_mm"] == pytest.approx([700.0, 100.0, 600.0], abs=1e-3)
    # the second one waited for the signal of the first
    assert moves["right"][1].legs[0].start_s == pytest.approx(moves["left"][1].t, abs=1e-6)
    assert [name for _, name, _ in result.outputs] == ["do[1]", "do[2]"]


def test_two_runs_are_equal() -> None:
    assert [event.as_json() for event in run().trace] == [event.as_json() for event in run().trace]


def test_a_second_motion_task_does_not_take_the_robot_of_the_first() -> None:
    result = run_program(program().program, FIRST, parse_cell(""))
    assert result.fault is not None
    assert result.fault.code == "second-robot"
    assert "task right moves a robot of its own" in result.fault.message
    assert result.fault.origin.line == 12


def test_a_robot_without_a_task_is_refused() -> None:
    single = read_sources(
        [source_from_text("one.rpl", "PROCEDURE main()\n    SET do[1] TO ON\nEND PROCEDURE\n")], "rpl", Diagnostics()
    )
    with pytest.raises(UsageError, match="2 robots are named, and the program has 1 motion tasks"):
        run_program(single.program, FIRST, parse_cell(""), further=(SECOND,))
