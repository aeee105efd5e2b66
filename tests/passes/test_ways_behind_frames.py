"""A frame times a place times a way along the tool (URScript): the place is taught, and the way stands beside it."""

from __future__ import annotations

import pytest

from tests.there_and_back import there_and_back

PROGRAM = """def main():
  global rack = p[0.5, -0.2, 0.1, 0, 0, 0]
  global spot = p[0, 0, 0.04, 2.2214, 2.2214, 0]
  BACK = 0.05
  movej([0, -1.5708, -1.5708, -1.5708, 1.5708, 0], a=1.4, v=1.05)
  movel(pose_trans(rack, spot), a=1.2, v=0.2)
  movel({back}, a=1.2, v=0.2)
  set_standard_digital_out(0, True)
end
"""
FRAME_FIRST = "pose_trans(pose_trans(rack, spot), p[0, 0, -BACK, 0, 0, 0])"
PLACE_FIRST = "pose_trans(rack, pose_trans(spot, p[0, 0, -BACK, 0, 0, 0]))"
TURNED = "pose_trans(rack, pose_trans(spot, p[0, 0, -BACK, 0, 0, 0.3]))"


@pytest.mark.parametrize("back", [FRAME_FIRST, PLACE_FIRST])
@pytest.mark.parametrize(
    ("target", "said"),
    [
        ("rapid", "RelTool(spot,0,0,(-BACK)*1000)"),
        ("tp", "Tool_Offset,PR["),
        ("vplus", "rack:spot"),
        ("krl", "LIN spot:shift_zm50"),
    ],
)
def test_the_place_is_a_taught_one(back: str, target: str, said: str) -> None:
    journey = there_and_back({"main.script": PROGRAM.format(back=back)}, "urscript", target, "ur10e")
    assert not journey.losses
    assert said in journey.text
    assert journey.prove().agrees


def test_a_way_that_turns_is_a_product_still() -> None:
    journey = there_and_back({"main.script": PROGRAM.format(back=TURNED)}, "urscript", "rapid", "ur10e")
    assert "RelTool" not in journey.text
    assert journey.prove().agrees
