"""V+ scales accelerations by the programmed speed without being told: that is left to the arm where the program says
nothing of accelerations and nothing hangs on the times of its moves, with a warning. What it says itself is kept."""

from __future__ import annotations

import pytest

from tests.there_and_back import Journey, there_and_back

LOCATIONS = """.LOCATIONS
#start 0 -90 180 0 60 0
place 300 100 160 0 180 0
.END
"""
SLOW = "SPEED 200 MMPS ALWAYS\n"  # a fifth of the full speed


def translated(settings: str, target: str, more: str = "") -> tuple[Journey, bool, bool]:
    """The journey, whether the text sets accelerations, and whether the rule is said to be left out."""
    text = f".PROGRAM main()\nMOVE #start\n{settings}MOVES place\nBREAK\nSIGNAL 1\n.END\n{more}{LOCATIONS}"
    journey = there_and_back({"main.v2": text}, "vplus", target, "adept_viper_s650")
    said = any(word in journey.text for word in ("AccSet", "PathAccLim", "$ACC", "#ACC", "ACC20", "ACC50", "a=1,"))
    return journey, said, "acceleration-usual" in [item.code.name for item in journey.found]


@pytest.mark.parametrize(
    ("settings", "target", "said", "warned"),
    [
        (SLOW, "rapid", False, True),
        (SLOW, "krl", False, True),
        (SLOW, "tp", True, False),  # a word of each move
        (SLOW, "urscript", True, False),
        ("", "rapid", False, False),  # the full speed: nothing is scaled
        ("", "krl", False, False),
        (SLOW + "ACCEL 50,50\n", "rapid", True, False),
        (SLOW + "ACCEL 50,50\n", "krl", True, False),
        ("ACCEL 50,50\n", "rapid", True, False),
        ("ACCEL 50,50\n", "krl", True, False),
        ("DISABLE SCALE.ACCEL\n" + SLOW, "rapid", False, False),
        ("DISABLE SCALE.ACCEL\n" + SLOW, "krl", False, False),
        ("DISABLE SCALE.ACCEL\nACCEL 50,50\n" + SLOW, "rapid", True, False),
        ("DISABLE SCALE.ACCEL\nACCEL 50,50\n" + SLOW, "krl", True, False),
    ],
)
def test_what_nobody_said_is_left_to_the_arm(settings: str, target: str, said: bool, warned: bool) -> None:
    journey, *found = translated(settings, target)
    assert found == [said, warned], journey.text
    result = journey.prove()
    assert result.agrees, result.as_text()
    assert result.level in ("geometry", "time"), result.as_text()


@pytest.mark.parametrize("target", ["rapid", "krl"])
def test_where_something_happens_beside_the_moves_their_times_stay(target: str) -> None:
    reaction = ".PROGRAM stopped()\nSIGNAL 3\n.END\n"
    _, said, warned = translated(SLOW + "REACT 1001, stopped\n", target, reaction)
    assert said and not warned
