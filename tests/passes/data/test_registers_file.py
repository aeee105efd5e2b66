"""The file that keeps the numbers of data between translations."""

from __future__ import annotations

import pytest

from rpl.errors import UsageError
from rpl.writing.registers import parse_registers, registers_text

NAMES = {("R", 10): "count", ("R", 2): "list[1,2]", ("main.P", 1): 'pick "left"'}


def test_what_is_written_is_read_back() -> None:
    text = registers_text(NAMES, {("R", 10): "int"})
    assert text.splitlines()[:3] == ["bank,number,name,type", 'R,2,"list[1,2]",', "R,10,count,int"]
    assert parse_registers(text) == NAMES


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", "the first line"),
        ("a,b\n", "the first line"),
        ("bank,number,name,type\nR,x,count,int\n", "r.csv:2: a line has"),
        ("bank,number,name,type\n\nR,1\n", "r.csv:3: a line has"),
    ],
)
def test_another_file_is_refused(text: str, problem: str) -> None:
    with pytest.raises(UsageError, match=problem):
        parse_registers(text, "r.csv")
