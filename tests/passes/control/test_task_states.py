"""Whether another task runs: asked in V+ (TASK(1, n), 4 while the task executes) and kept as a flag elsewhere."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import ReadProgram, read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """.PROGRAM main()
 IF TASK(1,1) <> 4 THEN
 SIGNAL 1
 END
 EXECUTE 1 work()
 WAIT.EVENT , 0.2
 IF TASK(1,1) == 4 THEN
 SIGNAL 2
 END
 WAIT TASK(1,1) <> 4
 IF done == 3 THEN
 SIGNAL 3
 END
 EXECUTE 1 work()
 state = TASK(1,1)
 IF state == 4 THEN
 SIGNAL 4
 END
.END
.PROGRAM work()
 done = 0
 FOR i = 1 TO 3
 WAIT.EVENT , 0.3
 done = done+1
 END
.END
"""


def read(text: str) -> tuple[ReadProgram, Diagnostics]:
    diagnostics = Diagnostics()
    return read_sources([source_from_text("p.v2", text)], "vplus", diagnostics), diagnostics


def on(program: ReadProgram, entry: str, first: int = 0) -> list[int]:
    """Numbers of the outputs that are switched on."""
    run = run_program(program.program, None, None, entry, 20.0)
    assert run.status == "finished", run.as_json()["fault"]
    digits = ("".join(filter(str.isdigit, str(name))) for _, name, value in run.outputs if value)
    return [int(one) + first for one in digits]


def test_in_the_language_itself() -> None:
    program, diagnostics = read(PROGRAM)
    assert not list(diagnostics)
    assert on(program, "main") == [1, 2, 3, 4]


@pytest.mark.parametrize("target", ["rpl", "rapid", "krl", "tp", "inform", "urscript", "vplus"])
def test_the_answer_is_the_same(target: str) -> None:
    program, diagnostics = read(PROGRAM)
    written = translate_program(program, target, None, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    files = [source_from_bytes(one.path, one.data) for one in written.files if not one.path.endswith(".csv")]
    back = read_sources(files, target, Diagnostics())
    first = 1 if target == "urscript" else 0  # its outputs count from 0
    assert on(back, written.renamed.get("main", "main"), first) == [1, 2, 3, 4]


def test_a_task_that_nobody_executes_stays_with_the_controller() -> None:
    program, _ = read(".PROGRAM main()\n IF TASK(1,5) == 4 THEN\n SIGNAL 1\n END\n.END\n")
    diagnostics = Diagnostics()
    translate_program(program, "rapid", None, None, diagnostics)
    assert len(list(diagnostics.of(Severity.LOSS))) == 1
