"""V+ LOCK in URScript: the threads that watch know how urgent the program is, and let the others wait."""

from __future__ import annotations

import re

import pytest
from test_urscript_from_others import ROBOTS

from rpl.cell import Cell, Input
from rpl.diagnostics import Diagnostics
from rpl.project import ReadProgram, read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

LOCKED = """.PROGRAM main()
        REACT 1001, one, {priority}
        REACT 1002, two, 60
        LOCK {locked}
        WAIT.EVENT , 2
        SIGNAL 5
        LOCK {after}
        WAIT.EVENT , 1
        SIGNAL 6
        IGNORE 1001
        IGNORE 1002
.END
.PROGRAM one()
        SIGNAL 1
.END
.PROGRAM two()
        SIGNAL 2
.END
"""
# Outputs and inputs count from 1 in one language and from 0 in the other.
INPUTS = {"vplus": ("1001", "1002"), "urscript": ("digital_in[0]", "digital_in[1]")}


def outputs(read: ReadProgram, language: str) -> str:
    """What is switched on, in order, as numbers from 1."""
    one, two = INPUTS[language]
    cell = Cell(inputs=(Input(0.5, one, True), Input(1.0, two, True)))
    result = run_program(read.program, ROBOTS["vplus"], cell, entry="main")
    assert result.status == "finished", result.fault
    numbers = [int(re.sub(r"\D", "", name)) for _, name, _ in result.outputs]
    return " ".join(str(number + (language == "urscript")) for number in numbers)


@pytest.mark.parametrize(
    ("priority", "locked", "after", "order"),
    [
        (10, 20, 0, "2 5 1 6"),  # the urgent one comes through, the other waits for the end of the lock
        (10, 10, 0, "2 5 1 6"),  # one of the same priority waits too
        (10, 9, 0, "1 2 5 6"),
        (10, 60, 20, "5 2 6"),  # only one of two is let go
        (10, 60, 0, "5 2 1 6"),  # both wait: the urgent one comes first
        (70, 65, 0, "1 5 2 6"),
        (10, 127, 127, "5 6"),
    ],
)
def test_a_lock_holds_back_what_is_not_more_urgent(priority: int, locked: int, after: int, order: str) -> None:
    text = LOCKED.format(priority=priority, locked=locked, after=after)
    read = read_sources([source_from_text("main.v2", text)], "vplus", Diagnostics())
    assert outputs(read, "vplus") == order
    diagnostics = Diagnostics()
    (file,) = translate_program(read, "urscript", ROBOTS["vplus"], diagnostics=diagnostics).files
    assert not diagnostics.has_losses and not diagnostics.has_errors
    script = file.data.decode()
    assert ("rpl_mask = " in script) and "enter_critical" in script
    back = read_sources([source_from_bytes(file.path, file.data)], "urscript", Diagnostics())
    assert outputs(back, "urscript") == order, script
