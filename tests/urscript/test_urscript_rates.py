"""speedl and speedj: a motion that goes on at its speed until something else takes over."""

from __future__ import annotations

import pytest
from test_urscript_tasks_elsewhere import OTHERS
from urscript_helpers import run

from rpl.cell import Cell
from rpl.cell.cellfile import Input
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.wiring import in_words_of, with_signal_names
from rpl.runtime.values import Value
from rpl.simulation import entry_name, run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

HEAD = "def main():\n  movej([-1.57, -1.57, -1.57, -1.57, 1.57, 0])\n  a = get_actual_tcp_pose()\n"
TAIL = "  b = get_actual_tcp_pose()\n  set_standard_digital_out(0, {expectation})\nend\n"
# What is done, and what holds behind it; b - a is the way.
OWN = [
    # One motion: 100 passes of 10 ms at 50 mm/s, less what speeding up costs (v^2 / 2a), and the way of braking.
    (
        "i = 0\n  while i < 100:\n    speedl([0, 0, 0.05, 0, 0, 0], 0.5, 0.01)\n    i = i + 1\n  end\n  stopl(0.5)",
        "norm(b[2] - a[2] - 0.05) < 0.0003",
    ),
    ("speedl([0, 0, 0.1, 0, 0, 0], 0.5, 2)\n  stopl(0.5)", "norm(b[2] - a[2] - 0.2) < 0.0001"),
    # It goes on behind its time, and without a time it begins when the speed is there.
    ("speedl([0, 0, 0.05, 0, 0, 0], 0.5, 0.5)\n  sleep(0.5)\n  stopl(0.5)", "norm(b[2] - a[2] - 0.05) < 0.0003"),
    ("speedl([0, 0, 0.05, 0, 0, 0], 0.5)\n  sleep(1.0)\n  stopl(0.5)", "norm(b[2] - a[2] - 0.055) < 0.0003"),
    # Negative, none at all, two directions, turning, axes.
    ("speedl([0, 0, -0.05, 0, 0, 0], 0.5, 1)\n  stopl(0.5)", "norm(a[2] - b[2] - 0.05) < 0.0003"),
    ("speedl([0, 0, 0, 0, 0, 0], 0.5, 1)\n  stopl(0.5)", "point_dist(a, b) < 0.00001"),
    (
        "speedl([0.05, 0, 0, 0, 0, 0], 0.5, 1)\n  speedl([0, 0.05, 0, 0, 0, 0], 0.5, 1)\n  stopl(0.5)",
        "norm(b[0] - a[0] - 0.0475) < 0.0003 and norm(b[1] - a[1] - 0.05) < 0.0003",
    ),
    (
        "speedl([0, 0, 0, 0, 0, 0.2], 0.5, 1)\n  stopl(0.5)",
        "point_dist(a, b) < 0.0001 and norm(pose_dist(a, b) - 0.2) < 0.01",
    ),
    ("speedj([0.1, 0, 0, 0, 0, 0], 1, 1)\n  stopj(1)", "norm(get_actual_joint_positions()[0] + 1.47) < 0.001"),
    # Another move brakes first, and goes to its own place.
    ("speedl([0, 0, 0.05, 0, 0, 0], 0.5, 1)\n  movel(a)", "point_dist(a, b) < 0.00001"),
    # Slower from then on.
    (
        "speedl([0, 0, 0.1, 0, 0, 0], 0.5, 1)\n  speedl([0, 0, 0.05, 0, 0, 0], 0.5, 1)\n  stopl(0.5)",
        "norm(b[2] - a[2] - 0.145) < 0.001",
    ),
]


@pytest.mark.parametrize(("lines", "expectation"), OWN)
def test_a_motion_that_goes_on(lines: str, expectation: str) -> None:
    result = run(f"{HEAD}  {lines}\n{TAIL.format(expectation=expectation)}")
    assert result.fault is None
    assert [value for _, _, value in result.outputs] == [True]


def test_the_time_is_that_of_the_program() -> None:
    result = run("def main():\n  speedl([0, 0, 0.05, 0, 0, 0], 0.5, 1.0)\n  set_standard_digital_out(0, True)\nend\n")
    assert result.outputs[0][0] == pytest.approx(1.0)
    assert result.status == "finished"


def test_beyond_the_reach_the_arm_stops_with_an_error() -> None:
    result = run("def main():\n  speedl([0, 0, 0.2, 0, 0, 0], 0.5)\n  sleep(60)\nend\n")
    assert result.fault is not None and result.fault.code in ("unreachable", "joint-limit", "singularity")


# ---- elsewhere

LOOPS = [
    "while not get_standard_digital_in(0):\n    speedl([0, 0, -0.02, 0, 0, 0], 0.5, 0.01)\n  end",
    "while not get_standard_digital_in(0):\n    speedl([0, 0, -0.02, 0, 0, 0], 0.5, 0.01)\n    sync()\n  end",
    "while True:\n    speedl([0, 0, -0.02, 0, 0, 0], 0.5, 0.01)\n    if get_standard_digital_in(0):\n      break\n"
    "    end\n  end",
    "speedl([0, 0, -0.02, 0, 0, 0], 0.5)\n  while not get_standard_digital_in(0):\n    sync()\n  end",
]
CELL = Cell(inputs=(Input(3.0, "digital_in[0]", True),))


def translated(text: str, target: str, cell: Cell = CELL) -> tuple[list[Value], list[str], str]:
    """The outputs of what was written, run in the same cell, the reports, and the text."""
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("main.script", text)], "urscript", diagnostics)
    written = translate_program(read, target, "ur5e", None, diagnostics)
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    named = with_signal_names(back.program, written.program)
    entry = written.renamed.get("main", "main") if target != "rpl" else entry_name(back.program)
    result = run_program(named, "ur5e", in_words_of(cell, read.program, named), entry, controller="plain")
    said = [item.code.name for item in diagnostics if item.severity >= Severity.WARNING]
    shown = "".join(f.data.decode() for f in written.files)
    return [value for _, _, value in result.outputs], said, f"{result.status} {said}\n{shown}"


@pytest.mark.parametrize("target", OTHERS)
@pytest.mark.parametrize("loop", LOOPS)
def test_a_loop_until_a_signal_is_a_search(loop: str, target: str) -> None:
    text = f"{HEAD}  {loop}\n  stopl(2.0)\n{TAIL.format(expectation='a[2] - b[2] > 0.015 and a[2] - b[2] < 0.05')}"
    outputs, said, shown = translated(text, target)
    assert outputs == [True], shown
    assert target in ("rpl", "urscript") or "velocity-search" in said


# What is no such loop: passes that are counted, a second way out that is no signal, other work.
OTHER_LOOPS = [
    "i = 0\n  while i < 10:\n    speedl([0, 0, -0.02, 0, 0, 0], 0.5, 0.1)\n    i = i + 1\n  end",
    "i = 0\n  while i < 10 and not get_standard_digital_in(1):\n    speedl([0, 0, -0.02, 0, 0, 0], 0.5, 0.1)\n"
    "    i = i + 1\n  end",
    'while not get_standard_digital_in(1):\n    speedl([0, 0, -0.02, 0, 0, 0], 0.5, 0.1)\n    textmsg("on")\n  end',
]


@pytest.mark.parametrize("target", [name for name in OTHERS if name not in ("rpl", "urscript")])
@pytest.mark.parametrize("loop", OTHER_LOOPS)
def test_a_loop_that_does_more_is_refused_at_its_motion(loop: str, target: str) -> None:
    text = f"{HEAD}  {loop}\n  stopl(2.0)\n{TAIL.format(expectation='True')}"
    diagnostics = Diagnostics()
    translate_program(
        read_sources([source_from_text("main.script", text)], "urscript", diagnostics),
        target,
        "ur5e",
        None,
        diagnostics,
    )
    motion = next(at for at, line in enumerate(text.splitlines(), 1) if "speedl" in line)
    lost = [(item.code.name, item.origin.line) for item in diagnostics.of(Severity.LOSS)]
    assert ("velocity-motion-lost", motion) in lost and "unread-instruction" not in dict(lost)
    outputs, _, shown = translated(text, target)
    assert outputs == [], shown


@pytest.mark.parametrize("target", ["krl", "rapid", "tp"])
def test_other_work_meanwhile_is_refused_by_name(target: str) -> None:
    lines = "  speedl([0, 0, 0.02, 0, 0, 0], 0.5)\n  set_standard_digital_out(1, True)\n  sleep(1)\n  stopl(1)\nend\n"
    outputs, said, _ = translated(HEAD + lines, target)
    assert "velocity-motion-lost" in said and outputs == []


@pytest.mark.parametrize(
    ("corner", "before", "lost"), [("", "", False), ("", "movel(a)\n  ", False), (", r=0.02", "", True)]
)
def test_a_stop_in_a_function_says_nothing_where_each_call_finds_the_robot_at_rest(
    corner: str, before: str, lost: bool
) -> None:
    """One corner elsewhere in the program changes nothing; one right before the call does."""
    lines = (
        "  def halted(x):\n    stopl(2.0)\n    return x > 1\n  end\n"
        "  movel(pose_trans(a, p[0.05, 0, 0, 0, 0, 0]), r=0.01)\n"
        f"  movel(pose_trans(a, p[0.05, 0.05, 0, 0, 0, 0]){corner})\n"
        f"  {before}set_standard_digital_out(1, halted(2))\n  movel(a)\n"
    )
    _, said, shown = translated(HEAD + lines + TAIL.format(expectation="True"), "krl")
    assert ("krl-guarded-stop" in said) is lost, shown
