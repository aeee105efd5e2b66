"""What grippers, sensors and feeders do to the parts of a cell, asked of a world without programs."""

import numpy as np
import pytest

from rpl.cell import parse_cell
from rpl.cell.world import World
from rpl.emulator.rotations import pose_matrix

TEXT = """
[[robot]]
name = "a"
[[robot]]
name = "b"
[[gripper]]
name = "one"
robot = "a"
kind = "jaws"
close = "do1"
gripped = "di1"
opening = [0, 80]
[[gripper]]
name = "two"
robot = "b"
kind = "jaws"
close = "do1"
gripped = "di1"
closed = "di2"
opening = [0, 80]
[[fixture]]
name = "table"
box = [800, 800, 40]
at = [0, 0, -20]
[[part]]
name = "bar"
box = [200, 40, 30]
at = [0, 0, 15]
"""
DOWN = np.diag([1.0, -1.0, -1.0])


class Hand:
    """A robot's machine that stands where it is put, and whose agenda is a list."""

    def __init__(self) -> None:
        self.now = 0.0
        self.place = pose_matrix((0.0, 0.0, 15.0), DOWN)
        self.deeds: list[tuple[float, str]] = []
        self.inputs: list[tuple[float, str, bool]] = []

    def flange_in_cell(self):
        return self.place

    def deed_later(self, time_s, deed):
        self.deeds.append((time_s, deed))

    def input_later(self, time_s, signal, value):
        self.inputs.append((time_s, signal, value))


def two_hands():
    world, a, b = World(parse_cell(TEXT).layout, 1), Hand(), Hand()
    world.join("a", a)
    world.join("b", b)
    return world, a, b


def act(world, robot, deed):
    """A deed, and those that follow at the same moment."""
    hand = world.movers[robot]
    world.happen(robot, deed)
    while due := [one for one in hand.deeds if one[0] <= hand.now]:
        hand.deeds = [one for one in hand.deeds if one not in due]
        for _, following in due:
            world.happen(robot, following)


def test_a_part_goes_from_one_gripper_to_the_other_in_the_air():
    world, a, b = two_hands()
    a.place = pose_matrix((-70.0, 0.0, 15.0), DOWN)
    act(world, "a", "close one")
    a.place = pose_matrix((-70.0, 0.0, 315.0), DOWN)
    b.place = pose_matrix((70.0, 0.0, 315.0), DOWN)
    act(world, "b", "close two")
    assert world.placed[-1].on == "one"  # both have closed, the first one still has it
    act(world, "a", "open one")
    a.place = pose_matrix((-300.0, 0.0, 315.0), DOWN)
    assert (world.placed[-1].state, world.placed[-1].on) == ("held", "two")
    assert [(one.gripper, one.part, one.ok, one.why) for one in world.grasps] == [
        ("one", "bar", True, ""),
        ("two", "bar", True, "from one"),
    ]
    assert [value for _, signal, value in a.inputs if signal == "di1"] == [True, False]
    assert [value for _, signal, value in b.inputs if signal == "di1"] == [True]
    b.place = pose_matrix((70.0, 200.0, 15.0), DOWN)
    act(world, "b", "open two")
    assert world.placed[-1].state == "rests"
    assert world.placed[-1].pose[:3, 3] == pytest.approx([0.0, 200.0, 15.0])


def test_who_opens_before_the_other_one_has_let_go_has_nothing():
    world, a, b = two_hands()
    a.place = pose_matrix((-70.0, 0.0, 15.0), DOWN)
    b.place = pose_matrix((70.0, 0.0, 15.0), DOWN)
    act(world, "a", "close one")
    act(world, "b", "close two")
    act(world, "b", "open two")
    assert world.placed[-1].on == "one"
    act(world, "a", "open one")
    assert (world.placed[-1].state, world.placed[-1].on) == ("rests", "table")
    assert [value for _, signal, value in b.inputs if signal == "di1"] == [True, False]


def test_closing_on_nothing_is_felt():
    world, _, b = two_hands()
    b.place = pose_matrix((0.0, 300.0, 15.0), DOWN)
    act(world, "b", "close two")
    assert [(one.ok, one.why) for one in world.grasps] == [(False, "no part between the jaws")]
    act(world, "b", "open two")
    assert [value for _, signal, value in b.inputs if signal == "di2"] == [True, False]
