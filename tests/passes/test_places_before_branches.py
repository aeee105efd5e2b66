"""Ways from the place before (V+ DEPARTS, KRL LIN_REL #TOOL) in a branch: the move to that place stands before it."""

from __future__ import annotations

import pytest

from tests.there_and_back import Journey, there_and_back

PROGRAM = """.PROGRAM main()
 AUTO k
 AUTO LOC spot
 SET spot = SHIFT(corner BY 0,0,20)
 MOVE #start
 BREAK
{lines}
 SIGNAL 1
.END
.PROGRAM aside()
 MOVES spare
 BREAK
.END
.LOCATIONS
corner 400 50 300 0 180 0
spare 400 -50 300 0 180 0
#start 0 -90 180 0 60 0
.END
"""
BRANCH = " IF NOT SIG(1001) THEN\n{inside} DEPARTS 30\n BREAK\n END"
KNOWN = {
    "place": (" MOVES corner\n BREAK\n", "", "RelTool(corner,0,0,-30)"),
    "what is worked out": (" MOVES spot\n BREAK\n SIGNAL 2\n", " SIGNAL -2\n", "RelTool(spot,0,0,-30)"),
}
UNKNOWN = {
    "another move between": " MOVES corner\n BREAK\n CALL aside()\n" + BRANCH.format(inside=""),
    "the place is another one by then": " MOVES spot\n BREAK\n SET spot = spare\n" + BRANCH.format(inside=""),
    "the first of a loop": " MOVES corner\n BREAK\n FOR k = 1 TO 2\n DEPARTS 30\n BREAK\n END",
}


def written(lines: str) -> Journey:
    journey = there_and_back({"main.v2": PROGRAM.format(lines=lines)}, "vplus", "rapid", "adept_viper_s650")
    assert not journey.losses
    assert journey.prove().agrees
    return journey


@pytest.mark.parametrize("name", KNOWN)
def test_the_place_before_a_branch_is_known_in_it(name: str) -> None:
    before, inside, said = KNOWN[name]
    text = written(before + BRANCH.format(inside=inside)).text
    assert said in text
    assert "CRobT" not in text


@pytest.mark.parametrize("name", UNKNOWN)
def test_else_the_robot_is_asked(name: str) -> None:
    assert "RelTool(CRobT(" in written(UNKNOWN[name]).text
