"""A corner behind which V+ waits at once (BREAK) is `fine` in RAPID; other corners keep their zones and their waits."""

from __future__ import annotations

import re

import pytest

from tests.there_and_back import there_and_back

LOCATIONS = """.LOCATIONS
#start 0 -90 180 0 60 0
a 300 100 160 0 180 0
b 300 -100 160 0 180 0
.END
"""
# Steps behind the move to the start, the sizes of corners from there on, and how often is waited in a line of its own.
CASES = [
    ("MOVES a\nBREAK\nSIGNAL 2\nMOVES b\nBREAK", ["fine", "fine"], 0),
    ("MOVES a\nMOVES b\nBREAK", ["z100", "fine"], 0),
    ("MOVES a\nSIGNAL 2\nMOVES b\nBREAK", ["z100", "fine"], 0),
    ("MOVES a\nn = 1\nMOVES b\nBREAK", ["z100", "fine"], 0),
    ("MOVES a\nBREAK\nBREAK\nMOVES b\nBREAK", ["fine", "fine"], 0),
    ("MOVES a\nBREAK ; the part is held\nMOVES b\nBREAK", ["fine", "fine"], 0),
    ("MOVES a\nSIGNAL 2\nBREAK\nMOVES b\nBREAK", ["fine", "fine"], 0),  # the output comes as the move begins
    ("MOVES a\nIF SIG(1001) THEN\nMOVES b\nEND\nBREAK", ["z100", "z100"], 1),
    ("FOR n = 1 TO 2\nMOVES a\nMOVES b\nEND\nBREAK", ["z100", "z100"], 1),
]


@pytest.mark.parametrize(("steps", "zones", "waits"), CASES, ids=[steps.replace("\n", "/") for steps, *_ in CASES])
def test_only_a_corner_with_a_wait_right_behind_is_fine(steps: str, zones: list[str], waits: int) -> None:
    text = f".PROGRAM main()\nMOVE #start\nBREAK\n{steps}\nSIGNAL 1\n.END\n{LOCATIONS}"
    journey = there_and_back({"main.v2": text}, "vplus", "rapid", "adept_viper_s650")
    assert not journey.losses
    assert re.findall(r"MoveL \w+,v1000,(\w+),tool0", journey.text) == zones, journey.text
    assert journey.text.count(r"WaitRob\InPos;") == waits, journey.text
    assert ("! the part is held" in journey.text) == ("held" in steps)
    result = journey.prove()
    assert result.agrees, result.as_text()
    assert journey.switched_on(journey.run()) == {1, *({2} if "SIGNAL 2" in steps else ())}
