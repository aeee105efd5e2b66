"""Sums and conditions as newer controllers print them, flags, and elements of positions by a variable."""

from __future__ import annotations

import pytest
from inform_helpers import job, outputs, read, run

# Instruction behind SET D001 13, SET D002 -40, SET B001 3, SET R001 7.5, and the condition that then holds.
SUMS = {
    "SET D000 (D001 + D002) * 5 / 4 - 7": "D000=-40",
    "SET D000 D001 - 5": "D000=8",
    "SET D000 D001 -5": "D000=8",
    "SET D000 -5": "D000=-5",
    "SET D000 (D002)": "D000=-40",
    "SET D000 (3)": "D000=3",
    "SET D000 D001*2+D002/4": "D000=16",
    "SET D000 2 * (D001 - D002)": "D000=106",
    "SET B[B001] B001 * 3": "B003=9",
    "SET R000 R001 * 2.0 - 1.0": "R000=14.0",
    "SET D000 D001": "D000=13",
    'SET S000 "A-B"': 'S000="A-B"',
    "SET FL0010 LOGICEXP (D001=13 AND D002<0)": "FL0010=ON",
    "SET FL0010 LOGICEXP (D001=13 AND D002>0)": "FL0010=OFF",
    "SET FL10 ON": "FL0010=ON",
    "SET OT#(9) LOGICEXP (D001=14 OR (D002<0 AND B001=3))": "OT#(9)=ON",
}


@pytest.mark.parametrize("line", SUMS)
def test_sums(line: str) -> None:
    given = "SET D001 13\nSET D002 -40\nSET B001 3\nSET R001 7.5"
    result = run(job(f"{given}\n{line}\nIFTHEN {SUMS[line]}\nDOUT OT#(1) ON\nENDIF"))
    assert result.status == "finished" and ("OT#(1)", True) in outputs(result)


POINT = """///TOOL 0
///POSTYPE ROBOT
///RECTAN
///RCONF 1,0,0,0,0,0
P00001=400.000,10.000,300.000,180.0000,0.0000,0.0000
"""
# M: the number of an element may be a variable's value.
ELEMENTS = {
    "SET B000 2\nGETE D000 P001 (B000)": "D000=10000",
    "SET I000 3\nSETE P001 (I000) 250000\nGETE D000 P001 (3)": "D000=250000",
    "SET B000 1\nSET D001 5\nSETE P001 (B000) D001\nGETE D000 P001 (1)": "D000=5",
    "MUL P001 (2) 3\nGETE D000 P001 (2)": "D000=30000",
    "SET D001 7\nDIV P001 (2) D001\nGETE D000 P001 (2)": "D000=1428",
    "SET B000 2\nMUL P001 (B000) 0.5\nGETE D000 P001 (2)": "D000=5000",
}


@pytest.mark.parametrize("lines", ELEMENTS)
def test_elements_by_a_variable(lines: str) -> None:
    result = run(job(f"{lines}\nIFTHEN {ELEMENTS[lines]}\nDOUT OT#(1) ON\nENDIF", POINT))
    assert result.status == "finished" and outputs(result) == [("OT#(1)", True)]


def test_an_element_that_a_position_has_not() -> None:
    result = run(job("SET B000 9\nGETE D000 P001 (B000)\nDOUT OT#(1) ON", POINT))
    assert result.status == "stopped" and not result.outputs


def test_what_is_no_element() -> None:
    _, diagnostics = read(job("GETE D000 P001 (9)", POINT))
    assert diagnostics.has_errors
