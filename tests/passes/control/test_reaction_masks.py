"""V+ LOCK in every language: what is not more urgent waits, and comes when the lock is lifted."""

from __future__ import annotations

import pytest

from rpl import registry
from rpl.cell import Cell, Input
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.recording import record_of
from rpl.proof.wiring import in_words_of, with_signal_names
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ROBOT = "adept_viper_s650"
LOCKED = """.PROGRAM main()
        CALL begin()
        LOCK {locked}
        WAIT.EVENT , 2
        SIGNAL 5
        LOCK {after}
        WAIT.EVENT , 1
        SIGNAL 6
.END
.PROGRAM begin()
        REACT 1001, one, {priority}
        REACT 1002, two, 60
.END
.PROGRAM one()
        SIGNAL 1
        REACT 1001, one, {priority}
.END
.PROGRAM two()
        SIGNAL 2
.END
"""
CELL = Cell(inputs=(Input(0.5, "1001", True), Input(1.0, "1002", True)))
KNOWN = {"DeclareInterrupt", "ConnectInterrupt"}
NONE = [name for name in registry.target_names() if not KNOWN & registry.target(name).capabilities_under({}).statements]
TARGETS = [name for name in registry.target_names() if name not in ("urscript", *NONE)]  # tests/urscript: for threads
# Priority of the first reaction, lock, lock afterwards; what is switched on.
WHOLE = [(10, 127, 0, "5 2 1 6"), (10, 60, 0, "5 2 1 6"), (10, 127, 127, "5 6"), (10, 0, 0, "1 2 5 6")]
PARTS = [(10, 20, 0, "2 5 1 6"), (10, 60, 20, "5 2 6"), (70, 65, 0, "1 5 2 6"), (10, 9, 0, "1 2 5 6")]


def switched(target: str, priority: int, locked: int, after: int) -> tuple[str, list[str]]:
    """Numbers of the outputs in order, and the codes of the losses."""
    text = LOCKED.format(priority=priority, locked=locked, after=after)
    read = read_sources([source_from_text("main.v2", text)], "vplus", Diagnostics())
    diagnostics = Diagnostics()
    translation = translate_program(read, target, ROBOT, None, diagnostics)
    again = Diagnostics()
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, again)
    assert not again.has_errors, [item.as_text() for item in again.of(Severity.ERROR)]
    named = with_signal_names(back.program, translation.program)
    entry = translation.renamed.get("main", "main")
    result = run_program(named, ROBOT, in_words_of(CELL, read.program, named), entry, 20.0)
    happened = [one for many in record_of(result, named).tasks.values() for one in many if one.kind == "output"]
    on = [one for one in sorted(happened, key=lambda one: one.t) if one.value]
    numbers = [key.removeprefix("digital_out:") for one in on for key in one.names if key.startswith("digital_out:")]
    return " ".join(numbers), [item.code.name for item in diagnostics.of(Severity.LOSS)]


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize(("priority", "locked", "after", "order"), WHOLE)
def test_all_reactions_wait(target: str, priority: int, locked: int, after: int, order: str) -> None:
    if target == "rapid":  # its queue knows no urgency, which a warning says
        order = order.replace("2 1", "1 2")
    assert switched(target, priority, locked, after) == (order, [])


@pytest.mark.parametrize("target", [name for name in TARGETS if name != "rapid"])
@pytest.mark.parametrize(("priority", "locked", "after", "order"), PARTS)
def test_some_reactions_wait(target: str, priority: int, locked: int, after: int, order: str) -> None:
    assert switched(target, priority, locked, after) == (order, [])


@pytest.mark.parametrize("target", NONE)
def test_where_there_are_no_interrupts_each_is_refused_and_the_program_stops_there(target: str) -> None:
    order, losses = switched(target, 10, 60, 0)
    assert order == "" and set(losses) == {"interrupt-lost"}


def test_where_all_or_none_wait_a_part_is_refused() -> None:
    assert "interrupt-mask-lost" in switched("rapid", 10, 20, 0)[1]


def test_the_routine_for_errors_may_have_a_name_that_the_target_reserves() -> None:
    text = ".PROGRAM main()\nREACTE trap\nx = SQRT(-1)\nSIGNAL 1\n.END\n.PROGRAM trap()\nSIGNAL 2\nRETURNE\n.END\n"
    read = read_sources([source_from_text("main.v2", text)], "vplus", Diagnostics())
    translation = translate_program(read, "rpl", ROBOT)
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], "rpl", Diagnostics())
    result = run_program(back.program, ROBOT, None, "main")
    assert result.status == "finished" and len(result.outputs) == 2
