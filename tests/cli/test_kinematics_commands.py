"""`fk` and `ik` agree for every robot and every notation: the flags that `fk` prints select the joints it was given."""

import json

import numpy as np
import pytest

from rpl import registry
from rpl.cli.main import run
from rpl.emulator.model import load_robot, robot_names

NOTATIONS = [name for name in registry.dialect_names() if registry.dialect(name).notation is not None]


@pytest.mark.parametrize("dialect", NOTATIONS)
@pytest.mark.parametrize("robot", robot_names())
def test_there_and_back(robot: str, dialect: str, capsys: pytest.CaptureFixture[str]) -> None:
    model = load_robot(robot)
    rng = np.random.default_rng(sum(map(ord, robot)))
    low, high = model.limits[:, 0], model.limits[:, 1]
    middle, reach = (low + high) / 2, np.minimum((high - low) * 0.3, 85.0)
    joints = np.round(np.clip(middle + rng.uniform(-1, 1, model.axes) * reach, low, high), 2)
    given = ",".join(f"{value:.2f}" for value in joints)
    assert run(["fk", "--robot", robot, f"--joints={given}", "--dialect", dialect, "--json"]) == 0
    forward = json.loads(capsys.readouterr().out)
    matrix = np.array(forward["matrix"])
    assert matrix.shape == (4, 4)
    assert np.allclose(matrix[:3, :3] @ matrix[:3, :3].T, np.eye(3), atol=1e-8)
    near = ["--near", given] if dialect != "krl" else []
    assert run(["ik", "--robot", robot, "--dialect", dialect, "--pose", forward["pose"], "--json", *near]) == 0
    inverse = json.loads(capsys.readouterr().out)
    selected = [entry for entry in inverse["solutions"] if entry["selected"]]
    assert len(selected) == 1, inverse["reason"]
    assert selected[0]["joints_deg"] == pytest.approx(list(joints), abs=2e-3)
