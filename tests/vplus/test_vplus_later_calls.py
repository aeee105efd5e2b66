"""A call some time behind the start of a move: the program waits for the time and calls."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

KRL = """DEF T( )
DECL INT N
PTP {{A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}}
{more}LIN_REL {{X 100.0}}
END
DEF MARK( )
$OUT[1]=TRUE
END
"""


FIRST = "TRIGGER WHEN DISTANCE=0 DELAY=200 DO MARK( ) PRIO=-1\n"


def written(more: str, first: str = FIRST) -> tuple[str, list[str]]:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("t.src", KRL.format(more=first + more))], "krl", diagnostics)
    done = translate_program(read, "vplus", "kuka_kr6r900sixx", None, diagnostics)
    losses = [item.code.name for item in diagnostics if item.severity.name == "LOSS"]
    return "".join(one.data.decode("latin-1") for one in done.files), losses


def test_the_program_waits_and_calls() -> None:
    text, losses = written("")
    assert not losses
    lines = [line.strip() for line in text.splitlines()]
    assert lines[lines.index("WAIT.EVENT , 0.2") + 1] == "CALL mark()"


def test_nothing_else_may_come_meanwhile() -> None:
    _, losses = written("TRIGGER WHEN DISTANCE=0 DELAY=100 DO $OUT[2]=TRUE\n")
    assert losses


@pytest.mark.parametrize(
    ("events", "steps"),
    [
        (["-60 DELAY=0", "-60 DELAY=300"], ["<= 60", "CALL", "<= 60", ", 0.3", "CALL"]),
        (["-60 DELAY=300", "-80 DELAY=0"], ["<= 80", "CALL", "<= 60", ", 0.3", "CALL"]),
        (["-60 DELAY=300", "-40 DELAY=0"], []),
        (["-60 DELAY=300", "-60 DELAY=400"], []),
    ],
)
def test_what_is_over_before_does_not_matter(events: list[str], steps: list[str]) -> None:
    more = "".join(f"TRIGGER WHEN PATH={one} DO MARK( ) PRIO=-1\n" for one in events)
    text, losses = written(more, first="")
    assert bool(losses) is (not steps)
    if steps:
        lines = [line.strip() for line in text.splitlines()]
        at = next(at for at, line in enumerate(lines) if "WAIT DISTANCE" in line)
        assert all(step in line for step, line in zip(steps, lines[at:], strict=False)), lines[at : at + 5]
