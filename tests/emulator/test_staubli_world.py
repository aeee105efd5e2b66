"""Where the poses of Staubli arms count from: the point where axes 1 and 2 meet, not the foot.

Public applications for a TX60 teach points on its table at z -360 mm and below with a tool of 170 mm: counted from the
foot (375 mm lower) they would be out of the arm's reach below the table.
"""

from __future__ import annotations

import numpy as np
import pytest

from rpl.emulator.model import load_robot
from rpl.emulator.robotfile import robot_names

ARMS = [name for name in robot_names() if name.startswith("staubli")]


@pytest.mark.parametrize("name", ARMS)
def test_the_shoulder_is_at_height_zero(name: str) -> None:
    """Stretched forward (joint 2 at 90, the others at 0) all of the arm is at the height of axis 2."""
    model = load_robot(name)
    assert model.forward(np.array([0.0, 90.0, 0.0, 0.0, 0.0, 0.0]))[2, 3] == pytest.approx(0.0, abs=1e-6)
