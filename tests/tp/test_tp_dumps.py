"""Dumps of registers and frames: a value that cannot be read is named with its place."""

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text

NUMREG = "[*NUMREG*]$NUMREG  Storage: CMOS  Access: RW  : ARRAY[1,200] OF Numeric Reg\n"
POSREG = "[*POSREG*]$POSREG  Storage: CMOS  Access: RW  : ARRAY[1,100] OF Position Reg\n"


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        (NUMREG + "  [1] = 5  'count'\n  [2] = -2.5  ''\n  [3] = 1.5e-06  ''\n", []),
        (NUMREG + "  [1] = 5x  'count'\n", [2]),
        (NUMREG + "  [1] = 5  ''\n  [2] = five  ''\n", [3]),
        (POSREG + "    [1,1] =   'home' Uninitialized\n", []),
        (POSREG + "    [1,1] =   'home'\n  Group: 1   Config: N U T, 0, 0, 0\n  nothing here\n", [2]),
    ],
)
def test_a_wrong_value_is_named(text: str, wanted: list[int]) -> None:
    found = Diagnostics()
    read_sources([source_from_text("NUMREG.VA", text)], "tp", found)
    assert [item.origin.line for item in found if item.code.name == "tp-bad-value"] == wanted
