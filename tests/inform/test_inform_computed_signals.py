"""Signals whose number is an element with a computed number are asked by a variable that holds it."""

from __future__ import annotations

import re

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program


@pytest.mark.parametrize(
    ("condition", "asked"),
    [("NOT $IN[G[N]]", "=OFF"), ("$IN[G[N]]", "=ON"), ("$IN[G[N]] AND NOT $IN[N]", "=ON")],
)
@pytest.mark.parametrize("statement", ["WAIT FOR {}", "IF {} THEN\nN=3\nENDIF"])
def test_a_signal_whose_number_is_a_computed_element_is_asked_by_a_number(
    condition: str, asked: str, statement: str
) -> None:
    """INFORM takes a variable as the number of a signal, not an element of an array (IN#(D[D001]))."""
    text = "DEF d()\nDECL INT N\nDECL INT G[3]\nG[1]=1\nN=G[1]\n" + statement.format(condition) + "\nEND\n"
    read = read_sources([source_from_text("d.src", text)], "krl", Diagnostics())
    written = translate_program(read, "inform", diagnostics=Diagnostics())
    assert written.losses == ()
    shown = written.files[0].data.decode()
    assert re.search(rf"IN#\(D\d+\){asked}", shown)
    assert "IN#(D[" not in shown
