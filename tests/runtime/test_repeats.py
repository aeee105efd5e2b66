"""Moves made again: kept plans change nothing but the time that planning takes."""

from dataclasses import replace

import numpy as np
import pytest

from rpl.emulator import planner
from rpl.emulator.model import load_robot
from rpl.emulator.planner import MoveRequest
from rpl.runtime.moves import repeats
from tests.runtime.helpers import krl

_plan = planner.plan
MODEL = load_robot("kuka_kr6r900sixx")
START = np.array([0.0, -90.0, 90.0, 0.0, 60.0, 0.0])
REQUEST = MoveRequest("joint", target_joints=START + 10.0, joint_speed=np.full(6, 0.5))

ROUND = """PTP {A1 0,A2 -90,A3 110,A4 0,A5 60,A6 0}
LIN {X 500,Y 0,Z 550,A 180,B 10,C 180} C_DIS
LIN {X 500,Y 150,Z 550,A 170,B 15,C 180} C_DIS
LIN {X 450,Y 150,Z 450,A 160,B 20,C 170}
"""


def test_the_same_question_has_the_same_answer() -> None:
    again = replace(REQUEST, target_joints=START + 10.0, joint_speed=np.full(6, 0.5))
    assert repeats.plan(MODEL, START.copy(), again) is repeats.plan(MODEL, START, REQUEST)


@pytest.mark.parametrize(
    "change",
    [
        {"target_joints": np.nextafter(START + 10.0, np.inf)},
        {"joint_speed": np.full(6, 0.25)},
        {"tool": np.diag([1.0, -1.0, -1.0, 1.0])},
        {"duration_s": 4.0},
        {"controller": replace(REQUEST.controller, joint_ramp_s=0.3)},
    ],
    ids=lambda change: next(iter(change)),
)
def test_another_question_is_planned_anew(change: dict[str, object]) -> None:
    assert repeats.plan(MODEL, START, replace(REQUEST, **change)) is not repeats.plan(MODEL, START, REQUEST)


def test_a_cycle_runs_as_if_each_of_its_moves_were_planned_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    program = f"INT I\nFOR I = 1 TO 4\n{ROUND}ENDFOR"
    kept = krl(program, robot="kuka_kr6r900sixx")
    monkeypatch.setattr(repeats, "_planned", repeats._planned.__wrapped__)
    monkeypatch.setattr(repeats, "joining", repeats.joining.__wrapped__)
    anew = krl(program, robot="kuka_kr6r900sixx")
    assert [event.as_json() for event in kept.trace] == [event.as_json() for event in anew.trace]


def test_a_cycle_asks_the_planner_once_for_each_of_its_moves(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []
    monkeypatch.setattr(planner, "plan", lambda *question: asked.append(question) or _plan(*question))
    repeats._planned.cache_clear()
    krl(f"INT I\nFOR I = 1 TO 9\n{ROUND}ENDFOR", robot="kuka_kr6r900sixx")
    assert len(asked) == 5, "four moves, and the first one once from where the robot stood"
