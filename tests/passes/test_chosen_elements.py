"""An element chosen at run time and named twice in one statement: its number is computed once."""

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

TEXT = """VAR first: INT
VAR row: ARRAY[4] OF INT
VAR i: INT
FOR i = 1 TO 4
    row[i] = row[i] + 1
END FOR
first = first + 2
second = second + 1
SET do[1] TO row[3] = 1 AND first > second
"""


@pytest.mark.parametrize("target", ["tp", "inform"])
def test_one_number_for_both(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("one.rpl", TEXT)], "rpl", diagnostics)
    text = b"".join(file.data for file in translate_program(read, target, None, None, diagnostics).files).decode()
    made = [line for line in text.splitlines() if ("element]=" in line or "ADD D" in line) and "R[R[" not in line]
    assert len(made) == 1, text
