"""The interval of a run's time holds what the controller's parameters can do: whole runs with each of them wrong.

Each parameter is wrong by all of what its file declares, in both directions, and several at once with squares of their
shares that add up to one, which is what independent parameters are counted as. `corner` is the error of the time in a
corner as such, and no parameter to change.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rpl.controllerfiles import controller_named
from rpl.emulator.model import load_robot
from rpl.motionmodel import MotionModel
from rpl.report.times import run_times
from rpl.runtime.trace import RunResult
from tests.runtime.helpers import run

ARMS = {
    "tp": ("fanuc_m20ia", "0, 0, 0, 0, -60, 0"),
    "rapid": ("abb_irb140", "0, 0, 0, 0, 60, 0"),
    "krl": ("kuka_kr6r900sixx", "0, -90, 90, 0, 60, 0"),
    "urscript": ("ur5e", "0, -90, -90, -90, 90, 0"),
    "vplus": ("adept_viper_s650", "0, -90, 180, 0, 60, 0"),
    "inform": ("motoman_gp7", "0, 0, 0, 0, 60, 0"),
}
BLENDS = {"stops": "", "sizes": " BLEND 20 mm", "percents": " BLEND PERCENT 60"}
BODY = """MOVE TO {{j1: {0}, j2: {1}, j3: {2}, j4: {3}, j5: {4}, j6: {5}}}
MOVE BY {{j1: 30, j2: 10, j3: 0, j4: 20, j5: 0, j6: 40}} IN JOINTS JOINT SPEED 60{blend}
MOVE BY {{j1: -30, j2: -10, j3: 0, j4: -20, j5: 0, j6: -40}} IN JOINTS JOINT SPEED 100
MOVE LINEAR BY {{y: 150}} SPEED 300{blend}
MOVE LINEAR BY {{z: 100}} SPEED 500{blend}
$acceleration_percent = 60
MOVE LINEAR BY {{y: -150}} SPEED 200
MOVE LINEAR BY {{z: -100}} SPEED 800
"""


def done(dialect: str, blend: str, controller: MotionModel) -> RunResult:
    robot, start = ARMS[dialect]
    result = run("rpl", BODY.format(*start.split(", "), blend=BLENDS[blend]), robot=robot, controller=controller)
    assert result.status == "finished", result.fault
    return result


def wrong(model: MotionModel, name: str, factor: float) -> MotionModel:
    """The controller with one parameter larger by a factor."""
    if name == "path_acceleration":
        return replace(model, path_acceleration_mm_s2=(model.path_acceleration_mm_s2 or 5000.0) * factor)
    if name == "joint_acceleration":
        return replace(model, joint_acceleration_share=model.joint_acceleration_share * factor)
    if name == "overlap":
        return replace(model, overlap=tuple((percent, min(share * factor, 1.0)) for percent, share in model.overlap))
    return replace(model, **{name: getattr(model, name) * factor})


@pytest.mark.parametrize("blend", BLENDS)
@pytest.mark.parametrize("dialect", ARMS)
def test_a_controller_wrong_by_what_it_declares_ends_within_the_interval(dialect: str, blend: str) -> None:
    model = controller_named(dialect)
    declared = {name: share for name, share in model.uncertainty.items() if name not in ("corner", "joint_speed")}
    times = run_times(done(dialect, blend, model), load_robot(ARMS[dialect][0]))
    cases = [{name: sign} for name in declared for sign in (1.0, -1.0)]
    generator = np.random.default_rng(7)
    for _ in range(3):
        shares = generator.normal(size=len(declared))
        shares /= np.linalg.norm(shares)
        cases.append(dict(zip(declared, shares.tolist(), strict=True)))
    for case in cases:
        other = model
        for name, share in case.items():
            other = wrong(other, name, (1.0 + declared[name]) ** share)
        seconds = done(dialect, blend, other).time_s
        assert times.low_s - 1e-6 <= seconds <= times.high_s + 1e-6, case


@pytest.mark.parametrize("dialect", ARMS)
def test_corners_have_their_share_of_the_interval(dialect: str) -> None:
    model = controller_named(dialect)
    times = run_times(done(dialect, "sizes", model), load_robot(ARMS[dialect][0]))
    late = {name: seconds for name, _, seconds in times.effects}
    assert late["corner"] == pytest.approx(times.blending_s * model.uncertainty["corner"], rel=1e-9)
