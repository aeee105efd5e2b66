"""Accelerations that the program sets: RAPID AccSet acc, ramp (RAPID reference manual, AccSet: acc in percent of the
normal acceleration, ramp in percent of the rate at which it increases)."""

import pytest
from helpers import ABB, rapid

from rpl.controllerfiles import controller_named

FROM, TO = (
    "MoveL [[400,-200,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tool0;",
    "MoveL [[400,200,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tool0;",
)
START = "MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]]\\NoEOffs,v1000,fine,tool0;\nConfL\\Off;\nConfJ\\Off;"


def seconds(before: str) -> float:
    """How long the last of two moves along the same line of 400 mm takes."""
    start = START + FROM.replace("MoveL", "MoveJ")
    result = rapid(f"{start}\n{before}\nWaitTime 0.5;\n{TO}", robot=ABB)
    assert result.status == "finished", result.fault
    return float(sum(leg.duration_s for event in result.trace[-3:] if event.kind == "move" for leg in event.legs))


@pytest.mark.parametrize(("acceleration", "ramp"), [(100, 100), (50, 100), (100, 50), (20, 25)])
def test_acc_set_makes_the_ramps_longer_and_smoother(acceleration: int, ramp: int) -> None:
    model = controller_named("rapid")
    assert model.path_acceleration_mm_s2 is not None
    steep = model.path_acceleration_mm_s2 * acceleration / 100.0
    smooth = model.path_smoothing_s * 100.0 / ramp
    assert seconds(f"AccSet {acceleration},{ramp};") == pytest.approx(400.0 / 500.0 + 500.0 / steep + smooth, abs=1e-3)
