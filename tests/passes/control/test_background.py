"""Tasks that a program starts, as background programs with flags, and variables that outlive their routine."""

from __future__ import annotations

from dataclasses import replace

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.ir.walk import walk
from rpl.passes.capabilities import Background, Local
from rpl.passes.legalise.context import Context, names_in
from rpl.passes.legalise.interrupts.statics import static_variables
from rpl.passes.legalise.interrupts.tasks.background import background_tasks
from rpl.passes.typing import normalise
from rpl.project import ReadProgram, read_sources
from rpl.proof.prove import prove_programs
from rpl.registry import target
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

EVERYTHING = target("rpl").capabilities()
WITHOUT = replace(
    EVERYTHING,
    statements=EVERYTHING.statements - {"TaskControl"},
    routines=replace(EVERYTHING.routines, locals=EVERYTHING.routines.locals - {Local.STATICS}),
)
KINDS = ["shared", "separate"]

COUNTING = """
MODULE m
VAR ticks: INT = 0
VAR told: INT = 0
PROCEDURE main()
START TASK clock(3)
WAIT 1.05 s
SET do[1] TO ON
JOIN TASK clock
IF ticks = 3 THEN SET do[2] TO ON
START TASK clock(2)
START TASK clock(9)
JOIN TASK clock
IF ticks = 5 THEN SET do[3] TO ON
END PROCEDURE
PROCEDURE clock(most: INT)
VAR n: INT = 0
WHILE n < most
WAIT 0.5 s
n = n + 1
count()
END WHILE
SET do[9] TO NOT do[9]
END PROCEDURE
PROCEDURE count()
ticks = ticks + 1
END PROCEDURE
END MODULE
"""
ENDED = """
MODULE m
VAR ticks: INT = 0
PROCEDURE main()
START TASK clock
WAIT 1.2 s
STOP TASK clock
IF ticks = 2 THEN SET do[1] TO ON
WAIT 2.0 s
IF ticks = 2 THEN SET do[2] TO ON
START TASK clock
WAIT 0.6 s
STOP TASK clock
IF ticks = 3 THEN SET do[3] TO ON
END PROCEDURE
PROCEDURE clock()
LOOP
WAIT 0.5 s
ticks = ticks + 1
WAIT UNTIL ticks > 0
END LOOP
END PROCEDURE
END MODULE
"""


def read(text: str) -> ReadProgram:
    diagnostics = Diagnostics()
    found = read_sources([source_from_text("t.rpl", text)], "rpl", diagnostics)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    return found


def made(text: str, kind: str, **more: object) -> tuple[ir.Program, Diagnostics]:
    program = read(text).program
    given = Context(
        "rpl",
        "other",
        replace(WITHOUT, **more, tasks=replace(WITHOUT.tasks, background=Background(kind))),
        Diagnostics(),
    )  # type: ignore[arg-type]
    given.taken |= names_in(program)
    after = background_tasks(static_variables(program, given), given)
    return normalise(after, Diagnostics()), given.diagnostics


def outputs(program: ir.Program) -> list[tuple[str, object]]:
    result = run_program(program)
    assert result.status == "finished", result.fault
    return [(name, value) for _, name, value in result.outputs]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("text", [COUNTING, ENDED], ids=["started and joined", "ended"])
def test_the_same_outputs_in_the_same_order(text: str, kind: str) -> None:
    after, diagnostics = made(text, kind)
    wanted = outputs(read(text).program)
    assert ("do[2]", True) in wanted and ("do[3]", True) in wanted
    assert outputs(after) == wanted
    assert [item.code.name for item in diagnostics] == ["background-task"]
    assert not any(isinstance(node, ir.TaskControl) for node in walk(*after.modules))


def test_separate_tasks_share_persistent_data_only() -> None:
    after, _ = made(COUNTING, "separate")
    main, task = after.modules
    assert task.task == "TASK2" and [one.name for one in task.routines] == ["main", "clock", "count"]
    assert [one.name for one in main.routines] == ["main", "count"]
    shared = {one.name for one in task.declarations if isinstance(one, ir.Variable)}
    assert shared == {"clock_runs", "clock_most", "ticks"}
    for module in (main, task):
        found = {one.name: one for one in module.declarations if isinstance(one, ir.Variable) and one.name in shared}
        assert {(one.storage, one.scope) for one in found.values()} == {("persistent", "global")}


@pytest.mark.parametrize(
    ("lines", "control", "reason"),
    [
        ("MOVE TO pose {x: 1.0, y: 0.0, z: 0.0, a: 0.0, b: 0.0, c: 0.0}", "START", "it moves the robot"),
        ("$path_speed = 5.0", "START", "it uses path speed"),
        ("START TASK other", "START", "tasks of its own"),
        ("slow()", "STOP", "waits in a routine that it calls"),
        ("WAIT 1 s", "PAUSE", "goes on in the middle"),
    ],
)
def test_what_does_not_fit_is_named(lines: str, control: str, reason: str) -> None:
    text = f"""
PROCEDURE main()
START TASK work
{control} TASK work
END PROCEDURE
PROCEDURE work()
{lines}
END PROCEDURE
PROCEDURE other()
SET do[1] TO ON
END PROCEDURE
PROCEDURE slow()
WAIT 1 s
END PROCEDURE
"""
    after, diagnostics = made(text, "shared")
    lost = [item.as_text() for item in diagnostics if item.code.name == "background-task-lost"]
    assert any(reason in item for item in lost), lost
    assert any(isinstance(node, ir.TaskControl) for node in walk(*after.modules))


@pytest.mark.parametrize("language", ["krl", "rapid"])
@pytest.mark.parametrize("text", [COUNTING, ENDED], ids=["started and joined", "ended"])
def test_controllers_with_background_programs_read_and_run_them(text: str, language: str) -> None:
    diagnostics = Diagnostics()
    first = read(text)
    written = translate_program(first, language, None, None, diagnostics)
    assert not written.losses
    paths = [file.path for file in written.files]
    assert any(path.endswith(".sub") if language == "krl" else path.startswith("TASK2/") for path in paths)
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], language, diagnostics)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    verdict = prove_programs(first.program, back.program)
    assert verdict.agrees, verdict.as_text()


def test_variables_that_outlive_their_routine_become_data_of_the_module() -> None:
    text = """
PROCEDURE main()
tick()
tick()
other()
END PROCEDURE
PROCEDURE tick()
PERSISTENT n: INT = 0
n = n + 1
IF n = 2 THEN SET do[1] TO ON
END PROCEDURE
PROCEDURE other()
PERSISTENT n: INT = 5
PERSISTENT alone: INT = 1
n = n + alone
IF n = 6 THEN SET do[2] TO ON
END PROCEDURE
"""
    after, _ = made(text, "shared")
    assert outputs(after) == outputs(read(text).program) == [("do[1]", True), ("do[2]", True)]
    names = {one.name for one in after.modules[0].declarations if isinstance(one, ir.Variable)}
    assert names == {"tick_n", "other_n", "alone"}
    assert not any(routine.declarations for routine in after.modules[0].routines)
