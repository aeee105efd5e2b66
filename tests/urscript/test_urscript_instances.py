"""`run t()` more than once: each run begins another thread, with a handle of its own."""

from __future__ import annotations

import pytest
from urscript_helpers import codes, read, run

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.ir.walk import walk
from rpl.project import read_sources
from rpl.source import source_from_bytes
from rpl.translation import translate_program
from tests.refusing import refused

WORKERS = """def p():
  count = 0
  thread worker():
    sleep(0.5)
    count = count + 1
  end
  thread tick():
    while True:
      count = count + 10
      sleep(0.1)
    end
  end
{lines}
  set_standard_digital_out(0, count == {wanted})
end
"""
# What is run, and what is counted.
CASES = [
    ("  run worker()\n  run worker()\n  sleep(1)", 2),
    ("  run worker()\n  count = 0\n  run worker()\n  run worker()\n  sleep(1)", 3),
    ("  a = run worker()\n  b = run worker()\n  join a\n  join b", 2),
    ("  a = run worker()\n  b = run worker()\n  kill a\n  sleep(1)", 1),
    ("  a = run tick()\n  b = run tick()\n  sleep(0.45)\n  kill a\n  sleep(0.2)\n  kill b\n  sleep(0.5)", 120),
    ("  i = 0\n  while i < 3:\n    run worker()\n    i = i + 1\n  end\n  sleep(1)", 3),
    ("  i = 0\n  while i < 3:\n    h = run worker()\n    join h\n    i = i + 1\n  end", 3),
    ("  h = [0, 0]\n  h[0] = run worker()\n  h[1] = run worker()\n  kill h[1]\n  sleep(1)", 1),
    (
        "  h = 0\n  def begin():\n    h = run worker()\n  end\n  def stop():\n    kill h\n  end\n"
        "  begin()\n  sleep(1)\n  stop()",
        1,
    ),
    ("  def begin():\n    run worker()\n  end\n  begin()\n  begin()\n  sleep(1)", 2),
]


@pytest.mark.parametrize(("lines", "wanted"), CASES)
def test_each_run_begins_a_thread(lines: str, wanted: int) -> None:
    result = run(WORKERS.format(lines=lines, wanted=wanted))
    assert [(name, value) for _, name, value in result.outputs] == [("digital_out[0]", True)]


def started(lines: str) -> list[str]:
    program, _ = read(WORKERS.format(lines=lines, wanted=1))
    return [node.task for node in walk(*program.modules) if isinstance(node, ir.TaskControl) and node.op == "start"]


def test_one_handle_has_one_thread() -> None:
    assert started("  h = run worker()\n  join h\n  h = run worker()\n  join h") == ["worker", "worker"]
    assert started("  run worker()\n  sleep(1)\n  run worker()") == ["worker", "worker"]
    assert started("  a = run worker()\n  b = run worker()") == ["worker", "worker_2"]


def lost(lines: str, target: str) -> set[str]:
    diagnostics = Diagnostics()
    source = source_from_bytes("p.script", WORKERS.format(lines=lines, wanted=1).encode())
    read_program = read_sources([source], "urscript", diagnostics)
    translate_program(read_program, target, "ur5e", None, diagnostics)
    return set(codes(diagnostics))


@pytest.mark.parametrize("target", ["vplus", "tp", "krl"])
def test_what_starts_again_is_named_elsewhere(target: str) -> None:
    loop = "  i = 0\n  while i < 3:\n    run {name}()\n    i = i + 1\n  end"
    assert "task-started-again" in lost(loop.format(name="worker"), target)
    assert "second-task-lost" in lost(loop.format(name="tick"), target)
    endless = WORKERS.format(lines=loop.format(name="tick"), wanted=1)
    assert "second-task-lost" in dict(refused(endless, "urscript", target, "ur5e"))
    ended = "  i = 0\n  while i < 3:\n    h = run tick()\n    sleep(1)\n    kill h\n    i = i + 1\n  end"
    assert not {"task-started-again", "second-task-lost"} & lost(ended, target)
