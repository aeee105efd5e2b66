"""Threads that hold the motion, for targets where only the program itself moves the robot: the thread is called;
one that the program ends on its way is refused."""

from __future__ import annotations

import re

import pytest

from rpl import registry
from rpl.cell import Cell
from rpl.cell.cellfile import parse_cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import ReadProgram, read_sources
from rpl.proof.record import Record
from rpl.proof.recording import record_of
from rpl.proof.wiring import in_words_of, with_signal_names
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

TARGETS = ["krl", "rapid", "tp", "inform"]
ROBOT = "ur5e"
# Input 2 lets the way of 100 mm begin, which lasts for 5 s; input 0 comes meanwhile for a short time.
CELL = """
[[input]]
time = 8.0
signal = "digital_in[2]"
value = true

[[input]]
time = 10.0
signal = "digital_in[0]"
value = true

[[input]]
time = 10.3
signal = "digital_in[0]"
value = false
"""
HEAD = """def tending():
  home = p[0.4, -0.1, 0.3, 3.1416, 0, 0]
  corner = p[0.4, 0, 0.3, 3.1416, 0, 0]
  touched = False
  flag = 0
  count = 0
  thread approach():
    flag = 1
    {body}
    flag = 2
  end
  movej([0, -1.5708, 1.5708, -1.5708, -1.5708, 0])
  movej(home)
  while not get_standard_digital_in(2):
    sync()
  end
"""
TAIL = """
  now = get_actual_tcp_pose()
  set_standard_digital_out(0, {reached})
  set_standard_digital_out(1, {expected})
  movel(home)
  set_standard_digital_out(2, True)
end
"""
ONE_MOVE = "movel(corner, v=0.02)"
REGIONS = {
    "joined": ("h = run approach()\n  join h", ONE_MOVE, "norm(now[1]) < 0.0001", "flag == 2"),
    "joined at once": ("h = run approach()\n  count = 3\n  join h", ONE_MOVE, "norm(now[1]) < 0.0001", "count == 3"),
    "waited for": (
        "run approach()\n  while flag < 2:\n    sync()\n  end",
        ONE_MOVE,
        "norm(now[1]) < 0.0001",
        "flag == 2",
    ),
}
WORK = {
    "in a loop": (
        "h = run approach()\n  while flag < 2:\n    count = count + 1\n    sleep(0.5)\n  end",
        "count > 8 and count < 13",
    ),
    "in a row": (
        "h = run approach()\n  sleep(1)\n  set_standard_digital_out(6, True)\n  sleep(0.5)\n  count = 7\n  join h",
        "count == 7 and flag == 2",
    ),
}
UNFIT = {
    "other work": "h = run approach()\n  while flag < 2:\n    count = count + 1\n    sleep(0.5)\n    if count > 5:\n"
    "      kill h\n      stopl(2)\n      flag = 2\n    end\n  end",
    "never awaited": "run approach()\n  sleep(7)",
    "a condition": "h = run approach()\n  while not get_standard_digital_in(0):\n    sync()\n  end\n"
    "  kill h\n  stopl(3)",
    "time": "h = run approach()\n  sleep(2)\n  kill h\n  stopl(2)",
}


def project(region: str, body: str, reached: str, expected: str) -> ReadProgram:
    tail = TAIL.replace("{reached}", reached).replace("{expected}", expected)
    text = HEAD.replace("{body}", body) + "  " + region + tail
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("tending.script", text)], "urscript", diagnostics)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    return read


def cell() -> Cell:
    return parse_cell(CELL)


def on_at_the_end(record: Record) -> set[int]:
    state: dict[int, bool] = {}
    for happening in (each for all in record.tasks.values() for each in all if each.kind == "output"):
        for key in happening.names:
            if found := re.fullmatch(r"digital_out:(\d+)", key):
                state[int(found[1])] = bool(happening.value)
    return {number for number, on in state.items() if on}


def outcome(read: ReadProgram, target: str) -> tuple[set[str], set[int], str]:
    """Losses, outputs that are on at the end, and how the run ends."""
    diagnostics = Diagnostics()
    translation = translate_program(read, target, ROBOT, None, diagnostics)
    files = [source_from_bytes(file.path, file.data) for file in translation.files]
    back = read_sources(files, target, Diagnostics())
    named = with_signal_names(back.program, translation.program)
    entry = translation.renamed.get("tending", "tending")
    result = run_program(named, ROBOT, in_words_of(cell(), read.program, named), entry, 60.0)
    losses = {item.code.name for item in diagnostics.of(Severity.LOSS)}
    return losses, on_at_the_end(record_of(result, named)), result.status


@pytest.mark.parametrize("case", REGIONS)
def test_the_programs_say_what_they_expect(case: str) -> None:
    read = project(*REGIONS[case])
    result = run_program(read.program, ROBOT, cell(), "tending", 60.0)
    assert on_at_the_end(record_of(result, read.program)) == {1, 2, 3}
    assert result.status == "finished"


@pytest.mark.parametrize("case", REGIONS)
@pytest.mark.parametrize("target", TARGETS)
def test_the_thread_is_called(case: str, target: str) -> None:
    assert outcome(project(*REGIONS[case]), target) == (set(), {1, 2, 3}, "finished")


@pytest.mark.parametrize("case", WORK)
@pytest.mark.parametrize("target", TARGETS)
def test_other_work_becomes_a_task_beside_it(case: str, target: str) -> None:
    region, expected = WORK[case]
    losses, on, end = outcome(project(region, ONE_MOVE, "norm(now[1]) < 0.0001", expected), target)
    assert (losses, on - {7}, end) == (set(), {1, 2, 3}, "finished")


@pytest.mark.parametrize("target", TARGETS)
def test_a_program_that_only_watches(target: str) -> None:
    """The thread has the whole motion and is never waited for; the program looks at inputs for ever."""
    watch = (
        "run motion()\n  while True:\n    if get_standard_digital_in(0):\n      set_standard_digital_out(3, True)\n"
        "    end\n    sync()\n  end\nend\n"
    )
    head, _, home = HEAD.partition("  movej([")
    text = head.replace("{body}", ONE_MOVE) + "  thread motion():\n  movej([" + home
    text += f"    {ONE_MOVE}\n    set_standard_digital_out(2, True)\n  end\n  {watch}"
    read = read_sources([source_from_text("tending.script", text)], "urscript", Diagnostics())
    losses, on, end = outcome(read, target)
    assert (losses, on, end) == (set(), {3, 4}, "limit")


@pytest.mark.parametrize("case", UNFIT)
@pytest.mark.parametrize("target", TARGETS)
def test_what_does_not_fit_is_refused_at_the_start(case: str, target: str) -> None:
    diagnostics = Diagnostics()
    read = project(UNFIT[case], ONE_MOVE, "True", "True")
    translate_program(read, target, ROBOT, None, diagnostics)
    (told,) = (item for item in diagnostics.of(Severity.LOSS) if item.code.name == "moving-task-kept")
    assert "run approach()" in told.origin.text


def test_targets_whose_tasks_move_keep_them() -> None:
    read = project(*REGIONS["joined"])
    for target in ("urscript", "vplus", "rpl"):
        assert registry.target(target).capabilities().tasks.moving
        translation = translate_program(read, target, ROBOT, None, Diagnostics())
        assert "approach" in translation.files[0].data.decode("utf-8").lower()
