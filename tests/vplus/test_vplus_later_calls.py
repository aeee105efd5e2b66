"""A call some time behind the start of a move: the program waits for the time and calls."""

from __future__ import annotations

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

KRL = """DEF T( )
DECL INT N
PTP {{A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}}
TRIGGER WHEN DISTANCE=0 DELAY=200 DO MARK( ) PRIO=-1
{more}LIN_REL {{X 100.0}}
END
DEF MARK( )
$OUT[1]=TRUE
END
"""


def written(more: str) -> tuple[str, list[str]]:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("t.src", KRL.format(more=more))], "krl", diagnostics)
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
