"""One cell file for a program and its translation: signals by number in each language's own words."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.cell.cellfile import Cell, Input, Reaction
from rpl.proof.wiring import in_words_of


def program(dialect: str) -> ir.Program:
    return ir.Program((ir.Module("m", dialect, (), (ir.Routine("main"),)),))


@pytest.mark.parametrize(
    ("source", "written", "target", "wanted"),
    [
        ("vplus", "1001", "krl", "$in[1]"),
        ("vplus", "1012", "tp", "di[12]"),
        ("urscript", "digital_in[1]", "krl", "$in[2]"),
        ("krl", "$IN[3]", "urscript", "digital_in[2]"),
        ("vplus", "a name of its own", "krl", "a name of its own"),
    ],
)
def test_input_in_the_words_of_the_translation(source: str, written: str, target: str, wanted: str) -> None:
    cell = Cell(inputs=(Input(1.0, written, True),), reactions=(Reaction(written, True, 0.1, written, False),))
    done = in_words_of(cell, program(source), program(target))
    (one,) = done.reactions
    assert [one.signal.lower(), one.when.lower(), done.inputs[0].signal.lower()] == [wanted] * 3


def test_the_same_language_keeps_its_words() -> None:
    cell = Cell(inputs=(Input(1.0, "1001", True),))
    assert in_words_of(cell, program("vplus"), program("vplus")) is cell
