"""servoj drives the robot for its time, however far the target is; the next one takes over on the way."""

from __future__ import annotations

import pytest
from urscript_helpers import run

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

HEAD = "def main():\n  movej([0, -1.57, -1.57, -1.57, 1.57, 0])\n  q = get_actual_joint_positions()\n"
STREAM = (
    "  i = 0\n  while i < {count}:\n    servoj([q[0] + {step} * i, q[1], q[2], q[3], q[4], q[5]], t={t})\n"
    "    i = i + 1\n  end\n"
)
MOVED = "  r = get_actual_joint_positions()\n  w = r[0] - q[0]\n  set_standard_digital_out(0, {holds})\nend\n"

# Statements, what holds of the way of the first axis (rad) behind them, and how long they take (s).
CASES = [
    # Where it stands, and where it cannot be in time: the time is the program's (script manual, servoj).
    ("  servoj(q, t=0.5)\n", "norm(w) < 0.0001", 0.5),
    ("  servoj(q)\n", "norm(w) < 0.0001", 0.002),
    ("  servoj(q, t=0)\n", "norm(w) < 0.0001", 0.002),
    ("  servoj([q[0] + 1, q[1], q[2], q[3], q[4], q[5]], t=0.1)\n", "w > 0.01 and w < 0.3", 0.1),
    ("  servoj([q[0] + 0.1, q[1], q[2], q[3], q[4], q[5]], t=1)\n", "norm(w - 0.1) < 0.0001", 1.0),
    # Targets of one stream are followed, and lag no more than the axis needs to brake.
    (STREAM.format(count=200, step=0.001, t=0.002), "w > 0.16 and w < 0.2", 0.4),
    (STREAM.format(count=40, step=0.005, t=0.008), "w > 0.17 and w < 0.2", 0.32),
    (STREAM.format(count=200, step=0.001, t=0.002) + "  stopj(20)\n", "w > 0.16 and w < 0.2", None),
    # One that is far is gone on with by targets that stay; another move begins at the last target.
    (STREAM.format(count=300, step=0, t=0.002).replace("q[0] + 0 * i", "q[0] + 0.2"), "norm(w - 0.2) < 0.0001", 0.6),
    ("  servoj([q[0] + 0.2, q[1], q[2], q[3], q[4], q[5]], t=0.01)\n  movej(q)\n", "norm(w) < 0.0001", None),
]


@pytest.mark.parametrize(("lines", "holds", "seconds"), CASES)
def test_targets_one_by_one(lines: str, holds: str, seconds: float | None) -> None:
    result = run(f"{HEAD}{lines}{MOVED.format(holds=holds)}")
    assert result.fault is None
    assert [value for _, _, value in result.outputs] == [True]
    if seconds is not None:
        before = run(f"{HEAD}{MOVED.format(holds='True')}").outputs[0][0]
        assert result.outputs[0][0] - before == pytest.approx(seconds, abs=1e-6)


def test_a_thread_that_repeats_it_takes_time() -> None:
    """As ur-rtde's does: its target stays where the arm stands."""
    result = run(
        f"{HEAD}  thread servo():\n    while True:\n      servoj(q, t=0.002)\n    end\n  end\n"
        "  h = run servo()\n  sleep(0.1)\n  kill h\n  stopl(10)\n  set_standard_digital_out(0, True)\nend\n"
    )
    assert result.fault is None and [value for _, _, value in result.outputs] == [True]


@pytest.mark.parametrize("call", ["speedl([0, 0, 0.05, 0, 0, 0], 0.5)", "speedj([0, 0, 0, 0, 0, 0], 0.5)"])
def test_a_speed_that_is_there_takes_a_cycle(call: str) -> None:
    """A loop that does nothing else runs on a controller, and here."""
    result = run(
        f"{HEAD}  i = 0\n  while i < 100:\n    {call}\n    i = i + 1\n  end\n  stopl(1)\n{MOVED.format(holds='True')}"
    )
    assert result.fault is None


def test_in_its_own_language_it_stays_and_in_another_it_comes_to_rest() -> None:
    text = f"{HEAD}  servoj([q[0] + 0.1, q[1], q[2], q[3], q[4], q[5]], t=0.5)\nend\n"
    diagnostics = Diagnostics()
    program = read_sources([source_from_text("p.script", text)], "urscript", diagnostics)
    own = translate_program(program, "urscript", "ur5e", None, diagnostics)
    assert "servoj([q[0] + 0.1, q[1], q[2], q[3], q[4], q[5]], t=0.5)" in own.files[0].data.decode()
    assert not [one for one in diagnostics.of(Severity.WARNING) if one.code.name == "servo-as-move"]
    translate_program(program, "krl", "ur5e", None, diagnostics)
    assert [one.origin.line for one in diagnostics.of(Severity.WARNING) if one.code.name == "servo-as-move"] == [4]
