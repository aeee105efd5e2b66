"""A place that is seen from a frame is reached with that frame as the base: people of KRL set `$BASE` and move to the
place (counted in public programs: 4 % of the moves go to a product of frames)."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

SCRIPT = """def cell():
  global table = p[0.4, -0.2, 0.1, 0, 0, 0.3]
  global above = p[0.1, 0.05, 0.2, 3.14, 0, 0]
  global place = p[0.1, 0.05, 0.1, 3.14, 0, 0]
  global apart = p[0.4, -0.1, 0.4, 3.14, 0, 0]
  global ready = [0, -1.57, 1.57, -1.57, -1.57, 0]
  movej(ready, a=1.4, v=1.05)
  movel(pose_trans(table, above), a=1.2, v=0.25)
  movel(pose_trans(table, place), a=1.2, v=0.25)
  movej(ready, a=1.4, v=1.05)
  movel(pose_trans(table, above), a=1.2, v=0.25)
  movel(apart, a=1.2, v=0.25)
end
"""
CHANGED = SCRIPT.replace("  movej(ready", "  table[2] = 0.12\n  movej(ready", 1)
SEEN = SCRIPT.replace("  movel(apart", "  apart = get_actual_tcp_pose()\n  movel(apart")


def _moves(text: str) -> list[str]:
    read = read_sources([source_from_text("cell.script", text)], "urscript", Diagnostics())
    written = translate_program(read, "krl", "ur10e", None, Diagnostics())
    files = [source_from_bytes(file.path, file.data) for file in written.files if not file.path.endswith(".toml")]
    back = read_sources(files, "krl", Diagnostics())
    proof = prove_programs(read.program, back.program, "ur10e", to_entry=written.renamed.get("cell", "cell"))
    assert proof.agrees, proof.as_text()
    lines = [line.strip() for file in files if file.path.endswith(".src") for line in file.text.splitlines()]
    return [line for line in lines if line.startswith(("$BASE", "LIN", "PTP"))]


def test_the_frame_is_the_base_of_its_moves() -> None:
    assert _moves(SCRIPT) == [
        "PTP ready",
        "$BASE=BASE_DATA[1]",
        "LIN above",
        "LIN place",
        "PTP ready",
        "LIN above",
        "$BASE=$NULLFRAME",
        "LIN apart",
    ]


def test_a_first_move_in_the_world_has_the_world_as_its_base() -> None:
    first = SCRIPT.replace("  movej(ready", "  movel(apart, a=1.2, v=0.25)\n  movej(ready", 1)
    assert _moves(first)[:5] == ["$BASE=$NULLFRAME", "LIN apart", "PTP ready", "$BASE=BASE_DATA[1]", "LIN above"]


@pytest.mark.parametrize("text", [CHANGED, SEEN], ids=["the frame changes", "the program looks where the robot is"])
def test_a_product_stays_where_the_base_would_mean_something_else(text: str) -> None:
    assert "LIN table:above" in _moves(text)


USED = SCRIPT.replace("  movel(apart", "  if pose_dist(above, place) > 0.05:\n    sleep(0.1)\n  end\n  movel(apart")
LISTED = """def cell():
  global table = p[0.4, -0.2, 0.1, 0, 0, 0.3]
  global slots = [p[0.1, 0.05, 0.2, 3.14, 0, 0], p[0.2, 0.05, 0.2, 3.14, 0, 0]]
  i = 0
  while i < 2:
    movel(pose_trans(table, slots[i]), a=1.2, v=0.25)
    i = i + 1
  end
end
"""


@pytest.mark.parametrize(
    ("text", "place"),
    [
        (USED, "LIN above"),  # a pose that is something else as well
        (LISTED, "LIN slots[i+1]"),
        (
            SCRIPT.replace("(table, above)", "(table, pose_trans(above, p[0,0,-0.05,0,0,0.1]))"),
            "LIN above:{FRAME: X 0.0,Y 0.0,Z -50.0,A 5.729578,B 0.0,C 0.0}",
        ),
    ],
)
def test_poses_that_are_no_taught_places_are_in_the_base_too(text: str, place: str) -> None:
    moves = _moves(text)
    assert moves[moves.index("$BASE=BASE_DATA[1]") + 1] == place
