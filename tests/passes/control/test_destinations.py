"""Where a motion will end, in languages that do not say so: the target of the move, while it is known."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

VPLUS = """.PROGRAM main()
        AUTO now, there, n
        SET there = TRANS(400,50,400,0,180,0)
        MOVES there
{between}
        SET now = DEST
        IF DX(now) > 390 THEN
            SIGNAL 1
        END
.END
"""
KRL = """DEF T( )
DECL POS P
PTP {A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}
P=$POS_FOR
$OUT[1]=P.X>100.0
END
"""


def written(text: str, name: str, dialect: str, target: str, robot: str) -> tuple[str, list[str]]:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text(name, text)], dialect, diagnostics)
    done = translate_program(read, target, robot, None, diagnostics)
    losses = [item.code.name for item in diagnostics if item.severity.name == "LOSS"]
    return "".join(one.data.decode("latin-1") for one in done.files), losses


@pytest.mark.parametrize(
    ("between", "known"),
    [
        ("        SIGNAL 2", True),
        ("        BREAK", True),
        ("        n = 5", True),
        ("        WAIT SIG(1001)\n        WAIT.EVENT , 0.2", True),
        ("        WAIT DISTANCE(HERE,DEST) < 50\n        SIGNAL 2", True),
        ("        SET there = SHIFT(there BY 10)", False),
        ("        SPEED 50\n        MOVE there\n        BREAK", True),
        ("        TOOL TRANS(0,0,50)", False),
        ("        IF n > 1 THEN\n            MOVES SHIFT(there BY 10)\n        END", False),
    ],
)
def test_behind_a_move_it_is_its_target(between: str, known: bool) -> None:
    _, losses = written(VPLUS.format(between=between), "main.v2", "vplus", "urscript", "adept_viper_s650")
    assert bool(losses) != known, losses


def test_a_language_that_waits_is_there() -> None:
    text, losses = written(KRL, "t.src", "krl", "rapid", "kuka_kr6r900sixx")
    assert not losses
    assert "CRobT(" in text


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "urscript", "inform"])
def test_the_ready_position_is_that_of_the_arm(target: str) -> None:
    text = ".PROGRAM main()\n READY\n BREAK\n SIGNAL 1\n.END\n"
    _, losses = written(text, "main.v2", "vplus", target, "adept_viper_s650")
    assert not losses
