"""Waits for the end of a motion: none where the robot rests anyway, and none in KRL in front of what stops its advance
run by itself.
"""

import re

import pytest

from rpl.proof.verdict import DIFFERENT
from tests.there_and_back import there_and_back

VIPER = "adept_viper_s850"
LOCATIONS = """.LOCATIONS
pick 400 -200 150 0 180 90
grip 0 0 100 0 0 0
#start 0 -90 180 0 90 0
.END
"""


def vplus(main: str, other: str = "SIGNAL 9") -> dict[str, str]:
    bodies = {"main": main, "other": other}
    programs = "".join(f".PROGRAM {name}()\n{body}\n.END\n" for name, body in bodies.items())
    return {"main.v2": programs + LOCATIONS}


# V+ TOOL and BREAK wait for the end of the motion.
@pytest.mark.parametrize(
    ("main", "other", "waits"),
    [
        ("TOOL grip\nMOVE #start", "SIGNAL 9", 0),  # nothing has moved yet
        ("CALL other()\nMOVE #start\nMOVES pick", "TOOL grip\nSIGNAL 1", 0),  # nor in what is called first
        ("MOVE #start\nCALL other()\nMOVES pick", "BREAK\nBREAK\nSIGNAL 1", 1),  # the second one finds it at rest
        ("MOVE #start\nCALL other()\nMOVES pick\nCALL other()", "BREAK\nSIGNAL 1", 1),
        ("CALL other()\nMOVES pick\nCALL other()", "BREAK\nSIGNAL 1", 1),  # called again behind a move
    ],
)
def test_nobody_waits_for_a_motion_that_is_none(main: str, other: str, waits: int) -> None:
    trip = there_and_back(vplus(main, other), "vplus", "rapid", VIPER)
    assert trip.text.count("WaitRob\\InPos") <= waits
    assert trip.prove().verdict != DIFFERENT


@pytest.mark.parametrize(
    ("behind", "waits"),
    [
        ("SIGNAL 1", False),  # $OUT stops the advance run
        ("WAIT SIG(1001)", False),
        ("n = n+1", True),  # a variable does not
        ("CALL other()", True),
    ],
)
def test_krl_goes_exactly_to_its_point_and_waits_only_where_it_has_to(behind: str, waits: bool) -> None:
    body = f"n = 0\nMOVE #start\nMOVES pick\nBREAK\n{behind}\nMOVE #start\nBREAK\nSIGNAL 5"
    trip = there_and_back(vplus(body), "vplus", "krl", VIPER)
    text = trip.text.replace("\r", "")
    assert re.search(r"^ *LIN pick$", text, re.MULTILINE)
    assert ("WAIT SEC 0\n" in text) is waits
    if "1001" not in behind:
        assert trip.prove().verdict != DIFFERENT
