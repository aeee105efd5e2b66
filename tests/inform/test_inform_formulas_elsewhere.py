"""Arithmetic in steps is one formula where the target nests expressions, if nothing else looks at the variable."""

from __future__ import annotations

import pytest
from inform_helpers import job
from there_and_back import there_and_back

STEPS = """SET B001 7
SET D000 B001
MUL D000 3
ADD D000 2
SET D001 D000
SET D002 B001
JUMP *OFF IF D001<>23
DOUT OT#(2) ON
*OFF"""


def written(text: str, target: str) -> str:
    return there_and_back({"MAIN.JBI": job(text)}, "inform", target).text


@pytest.mark.parametrize(
    "target, formula", [("rapid", "D001:=B001*3+2;"), ("krl", "D001=B001*3+2"), ("vplus", "d001 = b001*3+2")]
)
def test_steps_are_one_formula(target: str, formula: str) -> None:
    text = written(STEPS, target)
    assert formula in text and "d000" not in text.lower()


@pytest.mark.parametrize("target", ["rapid", "krl", "urscript", "vplus"])
def test_the_formula_gives_the_same(target: str) -> None:
    journey = there_and_back({"MAIN.JBI": job(STEPS)}, "inform", target)
    assert journey.switched_on(journey.run("TEST")) == {2}


@pytest.mark.parametrize(
    "why, text",
    [
        ("it is read again later", "SET D000 B001\nMUL D000 3\nSET D001 D000\nSET D002 D000"),
        ("it keeps what it had", "MUL D000 3\nSET D001 D000"),
        ("it counts", "INC D000\nSET D001 D000"),
        ("it is looked at by a condition", "SET D000 B001\nJUMP *A IF D000>3\nDOUT OT#(1) ON\n*A"),
        ("a label stands between", "SET D000 B001\n*A\nADD D000 1\nSET D001 D000\nJUMP *A IF D001<5"),
    ],
)
def test_variables_that_stay(why: str, text: str) -> None:
    assert "D000" in written(text, "rapid"), why
