"""A frame that places are computed from has the posture the program begins with, not one that holds the tool like the
frame; a place that a move goes to through a register has its own."""

from __future__ import annotations

import pytest

from postprocessors.tp.lines import Line
from postprocessors.tp.posture import frames_only, moved_to
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

SCRIPT = """def main():
  global fixture = p[0.42, -0.28, 0.12, 0, 0, 0.5236]
  movej([0, -1.5708, -1.5708, -1.5708, 1.5708, 0])
  above = pose_trans(fixture, p[0.05, 0.02, 0.1, 3.1416, 0, 0])
  movej(above, v=0.8)
  movel(pose_trans(fixture, p[0.05, 0.02, 0.03, 3.1416, 0, 0]), v=0.1)
  inside = pose_trans(pose_inv(fixture), get_actual_tcp_pose())
  set_standard_digital_out(0, inside[2] > 0.029 and inside[2] < 0.031)
end
"""


def test_a_joint_move_to_a_place_computed_from_a_frame() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("main.script", SCRIPT)], "urscript", diagnostics)
    written = translate_program(read, "tp", "ur5e", None, diagnostics)
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], "tp", diagnostics)
    result = run_program(back.program, "ur5e", None, "MAIN")
    assert result.fault is None
    assert [state for _, _, state in result.outputs] == [True]


@pytest.mark.parametrize(
    ("lines", "frames"),
    [
        (("  PR[2:base]=P[1] ;", "J PR[2:base] 25% FINE "), set()),
        (("  PR[2]=P[1] ;", "  PR[3]=PR[2] ;", "L PR[3] 100mm/sec FINE "), set()),
        (("  PR[2]=P[1] ;", "L PR[2] 100mm/sec FINE Tool_Offset,PR[9] "), {1}),
        (("  PR[2]=P[1] ;", "  PR[3]=PR[2] ;", "  PR[3,3]=5 ;", "J PR[3] 25% FINE "), set()),
        (("  PR[2]=P[1] ;", "  PR[3]=PR[2] ;", "  PR[3,6:x]=5 ;", "J PR[3] 25% FINE "), {1}),
        (("  PR[2]=P[1] ;", "  PR[3]=PR[2]+PR[7] ;", "J PR[3] 25% FINE "), set()),
        (("  PR[2]=P[1] ;", "J PR[R[4]] 25% FINE "), set()),
        (("  PR[2]=P[1] ;", "C P[5] ", "  PR[2:end] 100mm/sec FINE "), set()),
    ],
)
def test_which_points_are_only_frames(lines: tuple[str, ...], frames: set[int]) -> None:
    listing = [Line(one) for one in lines]
    assert frames_only(listing, moved_to(listing)) == frames
