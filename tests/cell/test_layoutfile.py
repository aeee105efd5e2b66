"""Bodies in cell files: what is read, and where each mistake is."""

import numpy as np
import pytest

from rpl.cell import parse_cell
from rpl.cell.world import World
from rpl.errors import UsageError

TABLE = '[[fixture]]\nname = "table"\nbox = [400, 400, 40]\nat = [0, 0, -20]\n'
PART = '[[part]]\nname = "block"\nbox = [60, 40, 20]\nat = [0, 0, 10]\n'
JAWS = '[[gripper]]\nname = "jaws"\nkind = "jaws"\nclose = "do1"\n'
TWO = '[[robot]]\nname = "a"\n[[robot]]\nname = "b"\n'


def test_poses_are_x_y_z_and_turns_about_z_y_x():
    layout = parse_cell(TABLE + PART.replace("[0, 0, 10]", "[1, 2, 10, 90, 0, 0]")).layout
    pose = layout.parts[0].at
    assert np.allclose(pose[:3, 3], [1.0, 2.0, 10.0])
    assert np.allclose(pose[:3, 0], [0.0, 1.0, 0.0])


def test_copies_have_numbers_and_places():
    layout = parse_cell(TABLE + PART + "copies = 3\nstep = [0, 0, 20]\n").layout
    assert [one.name for one in layout.parts] == ["block", "block#2", "block#3"]
    assert [one.at[2, 3] for one in layout.parts] == [10.0, 30.0, 50.0]


def test_a_bin_has_a_floor_and_four_walls():
    (made,) = parse_cell('[[bin]]\nname = "bin"\ninside = [300, 200, 100]\nwall = 4\nat = [10, 0, 5]\n').layout.fixtures
    corners = np.concatenate([body.shape.facets.bounds + body.at[:3, 3] for body in made.bodies])
    assert corners.min(axis=0) == pytest.approx([-144.0, -104.0, 1.0])
    assert corners.max(axis=0) == pytest.approx([164.0, 104.0, 105.0])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (PART.replace("box = [60, 40, 20]\n", ""), "cell:1: part[1]: needs one of box, cylinder"),
        (PART + "sphere = 4\n", "cell:1: part[1]: needs one of box, cylinder, sphere, capsule, extrusion, mesh, not 2"),
        (PART.replace("60, 40", "60000, 40"), "cell:3: part[1].box: 60000 is no length of a body in mm"),
        (PART.replace("60, 40", "0.006, 40"), "cell:3: part[1].box: 0.006 is no length of a body in mm"),
        (PART.replace("[0, 0, 10]", "[0, 0]"), "cell:4: part[1].at: must be 3 or 6 numbers"),
        (PART + "colour = 3\n", "cell:5: part[1].colour: unknown"),
        (PART + "copies = 3\n", "cell:5: part[1].copies: stand in each other"),
        (PART + "copies = 3\nstep = [0, 0, 9]\nagain = 1\n", "part[1].again: copies stand apart (step), come one"),
        (PART + PART, "cell:6: part[2].name: block is part[1] already"),
        (JAWS.replace('"jaws"\nclose', '"claw"\nclose'), "cell:3: gripper[1].kind: must be jaws or suction"),
        (JAWS + 'robot = "a"\n', "gripper[1].robot: no robot a: the cell names none"),
        (TWO + JAWS, "gripper[1].robot: say which robot: there are a, b"),
        (JAWS + "opening = [50, 20]\n", "gripper[1].opening: must be the least and the greatest"),
        (JAWS + "chance_of_miss = 2\n", "gripper[1].chance_of_miss: must be at least 0 and at most 1"),
        (TWO + '[[wire]]\nfrom = "do1"\nto = "b.di1"\n', 'wire[1].from: must be "robot.signal"'),
        (TWO + '[[wire]]\nfrom = "c.do1"\nto = "b.di1"\n', "wire[1].from: no robot c: there are a, b"),
        (
            TWO + '[[wire]]\nfrom = "a.do1"\nto = "b.di1"\n[[wire]]\nfrom = "a.do2"\nto = "b.DI1"\n',
            "wire[2].to: DI1 is driven by wire[1].to already",
        ),
        ('[[removal]]\nwhen = "do1"\nfixture = "shelf"\n', "removal[1].fixture: there is no fixture or bin shelf"),
        ('[[sensor]]\nname = "s"\nsignal = "di1"\nsphere = 9\nparts = ["x"]\n', "sensor[1].parts: there is no part x"),
        (
            PART.replace(
                "box = [60, 40, 20]", "extrusion = { outline = [[0, 0], [9, 9], [9, 0], [0, 9]], height = 5 }"
            ),
            "part[1].extrusion.outline: the outline crosses itself",
        ),
        (PART.replace("box = [60, 40, 20]", 'mesh = "none.stl"'), "part[1].mesh: none.stl: there is no such file"),
    ],
)
def test_mistakes_are_said_with_line_and_key(text, said):
    with pytest.raises(UsageError) as raised:
        parse_cell(text)
    assert said in str(raised.value)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (PART, "part[1].at: nothing is below block: it would fall"),
        (TABLE + PART.replace("[0, 0, 10]", "[0, 0, -20]"), "part[1].at: block stands in table"),
        (TABLE + PART.replace("[0, 0, 10]", "[195, 0, 5]"), "part[1].at: block stands in table"),
    ],
)
def test_cells_that_cannot_be_are_said_with_their_key(text, said):
    with pytest.raises(UsageError) as raised:
        World(parse_cell(text).layout, 1)
    assert said in str(raised.value)
