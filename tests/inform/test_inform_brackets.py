"""Conditions with brackets, as newer controllers print them."""

from __future__ import annotations

import pytest
from inform_helpers import job, outputs, run

# Condition behind SET B000 1, SET B001 0, SET B002 3, with its value.
CONDITIONS = {
    "(B000=1 AND B001=0)": True,
    "(IN#(1)=ON OR B002>2)": True,
    "(B000=2 OREXP B000=1) ANDEXP B001=1": False,
    "B000=1 OREXP (B000=1 ANDEXP B001=1)": True,
    "((B000=2 OR B001=0) AND (B002=3))": True,
    "(B001=1 AND (B000=1 OR B002=3))": False,
    "((B000=1))": True,
}


@pytest.mark.parametrize("word", ["IFTHEN", "WHILE", "JUMP"])
@pytest.mark.parametrize("condition", CONDITIONS)
def test_brackets(condition: str, word: str) -> None:
    body = {
        "IFTHEN": f"IFTHEN {condition}\nDOUT OT#(1) ON\nENDIF",
        "WHILE": f"WHILE {condition}\nDOUT OT#(1) ON\nSET B000 9\nSET B001 9\nSET B002 0\nENDWHILE",
        "JUMP": f"JUMP *Y IFEXPRESS {condition}\nJUMP *N\n*Y\nDOUT OT#(1) ON\n*N",
    }[word]
    result = run(job(f"SET B000 1\nSET B001 0\nSET B002 3\n{body}"))
    assert result.status == "finished" and bool(outputs(result)) == CONDITIONS[condition]


def test_a_wait_for_a_condition_in_brackets() -> None:
    body = "WAIT FOREXPRESS (IN#(1)=ON AND IN#(2)=OFF) T=5.00\nDOUT OT#(1) ON IF IN#(1)=ON"
    result = run(job(body), cell='[[input]]\ntime = 1.0\nsignal = "IN#(1)"\nvalue = true\n')
    assert [(t, name) for t, name, _ in result.outputs] == [(1.0, "OT#(1)")]
