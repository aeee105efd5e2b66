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


def written(
    text: str, name: str, dialect: str, target: str, robot: str, severity: str = "LOSS"
) -> tuple[str, list[str]]:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text(name, text)], dialect, diagnostics)
    done = translate_program(read, target, robot, None, diagnostics)
    losses = [item.code.name for item in diagnostics if item.severity.name == severity]
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
        ("        BREAK\n        TOOL TRANS(0,0,50)", True),
        ("        IF n > 1 THEN\n            MOVES SHIFT(there BY 10)\n        END", False),
    ],
)
def test_behind_a_move_it_is_its_target(between: str, known: bool) -> None:
    program = VPLUS.format(between=between)
    losses = written(program, "main.v2", "vplus", "urscript", "adept_viper_s650")[1]
    assert losses == (["concurrent-move"] if "HERE" in between else [])  # what looks on beside the move
    warnings = written(program, "main.v2", "vplus", "urscript", "adept_viper_s650", "WARNING")[1]
    assert ("destination-waited-for" in warnings) != known, warnings


def test_a_language_that_waits_is_there() -> None:
    text, losses = written(KRL, "t.src", "krl", "rapid", "kuka_kr6r900sixx")
    assert not losses
    assert "CRobT(" in text


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "urscript", "inform"])
def test_the_ready_position_is_that_of_the_arm(target: str) -> None:
    text = ".PROGRAM main()\n READY\n BREAK\n SIGNAL 1\n.END\n"
    _, losses = written(text, "main.v2", "vplus", target, "adept_viper_s650")
    assert not losses


STOPPING = """.PROGRAM main()
        MOVE TRANS(400,50,400,0,180,0)
        DEPARTS 40
{between}
        ALIGN
        BREAK
        SIGNAL 1
.END
.PROGRAM note(n)
        n = n+1
        BREAK
.END
.PROGRAM count(n)
        n = n+1
.END
"""


@pytest.mark.parametrize(
    ("between", "waited"),
    [
        ("        BREAK", False),
        ("        CALL note(n)\n        n = 5", False),
        ("        BREAK\n        CALL count(n)", False),
        ("        CALL count(n)", True),
        ("        n = 5", True),
    ],
)
@pytest.mark.parametrize("target", ["rapid", "tp", "urscript", "inform"])
def test_where_it_is_not_known_the_robot_stands_first(target: str, between: str, waited: bool) -> None:
    program = STOPPING.format(between=between)
    assert not written(program, "main.v2", "vplus", target, "adept_viper_s650")[1]
    warnings = written(program, "main.v2", "vplus", target, "adept_viper_s650", "WARNING")[1]
    assert ("destination-waited-for" in warnings) == waited, warnings


def test_a_wait_that_looks_on_does_not_stop_the_robot_first() -> None:
    program = STOPPING.format(between="        WAIT DISTANCE(HERE,DEST) < 50")
    assert written(program, "main.v2", "vplus", "urscript", "adept_viper_s650")[1]
