"""A reaction that moves the robot comes between the frame of a move and the move, where that frame is modal: frames of
places stay in the places then."""

from __future__ import annotations

import pytest
from there_and_back import Journey, entry_of, there_and_back

from rpl.cell.cellfile import parse_cell
from rpl.proof.prove import prove_programs

ARM = "adept_viper_s650"
# The signal comes while the program is locked, so that the reaction runs right in front of the second move.
TEXT = """.PROGRAM main()
REACTI 1001, side, 1
MOVE table:above
BREAK
LOCK 5
DELAY 3
LOCK 0
MOVES table:pick
BREAK
.END
.PROGRAM side()
{side}
SIGNAL 2
.END
.LOCATIONS
above 60.0 0.0 300.0 0.0 180.0 0.0
pick 60.0 0.0 250.0 0.0 180.0 0.0
over 0.0 0.0 300.0 0.0 180.0 0.0
table 300 0 100 0 0 0
shelf 0 350 150 0 0 0
.END
"""
MOVING, QUIET = TEXT.format(side="MOVE shelf:over\nBREAK"), TEXT.format(side="SIGNAL 3")
CELL = """[[input]]
time = 3.0
signal = "1001"
value = true
[[input]]
time = 3.5
signal = "1001"
value = false
"""


def _journey(text: str, target: str) -> Journey:
    """There and back, with a proof that it means the same while the reaction comes."""
    journey = there_and_back({"main.v2": text}, "vplus", target, ARM)
    to_entry, cell = entry_of(journey.written, "main"), parse_cell(CELL)
    proof = prove_programs(journey.source.program, journey.program, ARM, ARM, cell, entry="main", to_entry=to_entry)
    assert proof.agrees, proof.as_text()
    return journey


@pytest.mark.parametrize("target", ["tp", "inform"])
def test_no_frame_is_selected_where_a_reaction_may_select_another_one(target: str) -> None:
    assert not _journey(MOVING, target).losses


def test_a_reaction_that_does_not_move_leaves_the_frames_to_the_moves() -> None:
    journey = _journey(QUIET, "tp")
    assert "L P[2:pick]" in journey.text and "UFRAME_NUM=1" in journey.text


def test_a_frame_that_is_said_at_each_move_is_the_move_s_own() -> None:
    text = there_and_back({"main.v2": MOVING}, "vplus", "rapid", ARM).text
    assert "MoveL pick," in text and r"\WObj:=table" in text
