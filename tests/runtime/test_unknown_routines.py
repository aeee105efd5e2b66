"""Calls of routines that are not in what was read: a fault, or what the cell file says of them."""

from __future__ import annotations

import pytest

from rpl.cell import parse_cell
from rpl.diagnostics import Diagnostics
from rpl.errors import UsageError
from rpl.project import read_sources
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program
from rpl.source import source_from_text

TEXT = "DEF main()\nDECL INT n\nGRIP(1,TRUE)\nWAIT FOR $IN[3]\nn=COUNTED(2)\n$OUT[n]=TRUE\nEND\n"
BOTH = '[[routine]]\nname = "grip"\nseconds = 0.5\nmessage = "gripped"\nset = [["$IN[3]", true]]\n'
VALUE = '[[routine]]\nname = "Counted"\nvalue = 4\n'


def run(cell: str) -> RunResult:
    read = read_sources([source_from_text("main.src", TEXT)], "krl", Diagnostics())
    return run_program(read.program, cell=parse_cell(cell))


def test_a_cell_file_says_what_a_call_stands_for() -> None:
    result = run(BOTH + VALUE)
    assert result.status == "finished", result.fault
    assert [(round(at, 3), name, value) for at, name, value in result.outputs] == [(0.5, "$OUT[4]", True)]
    assert list(result.messages) == ["gripped"]


@pytest.mark.parametrize(
    ("cell", "told"),
    [
        ("", "the routine GRIP is not in what was read (see [[routine]] of a cell file)"),
        (BOTH, "the routine COUNTED is not in what was read"),
        (BOTH + '[[routine]]\nname = "counted"\n', "the routine COUNTED gives no value in the cell file"),
    ],
)
def test_what_it_does_not_say_is_a_fault(cell: str, told: str) -> None:
    result = run(cell)
    assert result.status == "fault" and result.fault is not None and told in str(result.fault)


@pytest.mark.parametrize(
    ("cell", "told"),
    [
        ("[[routine]]\nseconds = 1\n", "name"),
        ('[[routine]]\nname = "x"\nset = [1]\n', "must be a list of [signal, value] pairs"),
        ('[[routine]]\nname = "x"\neffect = "time"\n', "effect"),
    ],
)
def test_mistakes_are_told_with_their_key(cell: str, told: str) -> None:
    with pytest.raises(UsageError) as error:
        parse_cell(cell)
    assert told in str(error.value)
