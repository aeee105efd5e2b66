"""Robot files that are wrong are refused with the file, the line and the key; so are URDFs with the joint."""

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpl.emulator.model import RobotError, load_robot

RIGHT = """\
name = "arm"
kind = "opw"

[geometry]
a1 = 25
a2 = -35
b = 0
c1 = 400
c2 = 455
c3 = 420
c4 = 80
offsets = [0, -90, 0, 0, 0, 0]
signs = [-1, 1, 1, -1, 1, -1]

[axes]
limits = [[-170, 170], [-190, 45], [-120, 156], [-185, 185], [-120, 120], [-350, 350]]
speeds = [360, 300, 360, 381, 388, 615]
accelerations = [900, 900, 900, 900, 900, 900]
pulses_per_degree = [1, 1, 1, 1, 1, 1]
home = [0, -90, 90, 0, 0, 0]
"""
NUMBERS = ("360, 300, 360, 381, 388, 615", "900, 900, 900, 900, 900, 900", "1, 1, 1, 1, 1, 1", "0, -90, 0, 0, 0, 0")


def refused(folder: Path, old: str, new: str) -> str:
    assert RIGHT.count(old) == 1
    path = folder / "arm.toml"
    path.write_text(RIGHT.replace(old, new), encoding="utf-8")
    with pytest.raises(RobotError) as caught:
        load_robot(str(path))
    return str(caught.value)


def test_the_file_that_the_others_are_made_from_is_right(tmp_path: Path) -> None:
    (tmp_path / "arm.toml").write_text(RIGHT, encoding="utf-8")
    assert load_robot(str(tmp_path / "arm.toml")).axes == 6


@pytest.mark.parametrize(
    ("old", "new", "line", "message"),
    [
        ('kind = "opw"', 'kind = "delta"', 2, "'kind' must be one of opw, ur, scara, chain, found 'delta'"),
        ("a1 = 25", "", 4, "'a1' must be a number, found nothing"),
        ("a1 = 25", 'a1 = "25"', 5, "'a1' must be a number, found '25'"),
        ("a1 = 25", "a1 = true", 5, "'a1' must be a number, found True"),
        ("a1 = 25", "a1 = nan", 5, "'a1' must be a number, found nan"),
        ("c4 = 80", "c4 = inf", 11, "'c4' must be a number, found inf"),
        ("c4 = 80", f"c4 = {10**400}", 11, "'geometry.c4': a whole number has more than 64 bits"),
        ("c4 = 80", f"c4 = {'9' * 5000}", 11, "'c4': a number has more than 4300 digits"),
        ("c4 = 80", f"c4 = 0x{'F' * 5000}", 11, "'geometry.c4': a whole number has more than 64 bits"),
        ("c4 = 80", "c4 = 1e9", 11, "'c4' must be a number of at most 1,000,000"),
        ("c4 = 80", "c4 = 80\noffset = 1", 12, "'offset' is not known here: did you mean 'offsets'?"),
        ("c4 = 80", "c4 = 80\ncolour = 1", 12, "'colour' is not known here: there are offsets, signs"),
        ("speeds = [360", "speeds = [1e-300", 17, "'speeds' must be a list of 6 numbers of at least 0.000001"),
        ("[-190, 45]", "[-1e9, 1e9]", 16, "'limits' of axis 2: no axis goes farther than 1,000,000"),
        ("speeds = [360", "speed = 3\nspeeds = [360", 17, "'speed' is not known here: did you mean 'speeds'?"),
        ("c2 = 455", "c2 = 0", 9, "'c2' must be a length that is not zero"),
        ("c2 = 455", "c2 = -455", 9, "'c2' must be a length above zero"),
        ("a2 = -35\nb = 0\nc1 = 400\nc2 = 455\nc3 = 420", "a2 = 0\nb = 0\nc1 = 1\nc2 = 1\nc3 = 0", 10, "no length"),
        ("[0, -90, 0, 0, 0, 0]", "[0, -inf, 0, 0, 0, 0]", 12, "'offsets' must be a list of 6 numbers"),
        ("[-1, 1, 1, -1, 1, -1]", "[-1, 1, 1, -1, 1]", 13, "'signs' must be a list of 6 numbers"),
        ("[-1, 1, 1, -1, 1, -1]", "[-1, 1, 2, -1, 1, -1]", 13, "'signs' must be a list of 6 numbers, each 1 or -1"),
        ("[-190, 45]", "[45, -190]", 16, "'limits' of axis 2: the lower one, 45, is above the upper one, -190"),
        ("[-190, 45]", "[-190, nan]", 16, "'limits' must be a list of 6 pairs"),
        ("[-190, 45]", "[-190, 45, 0]", 16, "'limits' must be a list of 6 pairs"),
        (", [-350, 350]]", "]", 16, "'limits' must be a list of 6 pairs"),
        ("speeds = [360", "speeds = [0", 17, "'speeds' must be a list of 6 numbers above 0"),
        ("speeds = [360", "speeds = [-1", 17, "'speeds' must be a list of 6 numbers above 0"),
        ("speeds = [360", "speeds = [nan", 17, "'speeds' must be a list of 6 numbers"),
        ("speeds = [360", "speeds = [inf", 17, "'speeds' must be a list of 6 numbers"),
        ("speeds = [360, ", "speeds = [", 17, "'speeds' must be a list of 6 numbers"),
        ("accelerations = [900", "accelerations = [0", 18, "'accelerations' must be a list of 6 numbers above 0"),
        ("accelerations = [900", "accelerations = [inf", 18, "'accelerations' must be a list of 6 numbers"),
        (
            "pulses_per_degree = [1",
            "pulses_per_degree = [0",
            19,
            "'pulses_per_degree' must be a list of 6 numbers above",
        ),
        ("home = [0, -90, 90", "home = [0, -90, 157", 20, "'home' of axis 3 is 157, outside its limits -120..156"),
        ("home = [0, -90, 90", "home = [0, -90, nan", 20, "'home' must be a list of 6 numbers"),
        ("home = [0, -90, 90, 0, 0, 0]", "", 15, "'home' must be a list of 6 numbers, found nothing"),
    ],
)
def test_a_wrong_robot_file_is_refused_at_its_line(tmp_path: Path, old: str, new: str, line: int, message: str) -> None:
    said = refused(tmp_path, old, new)
    assert f"arm.toml:{line}: " in said
    assert message in said


@pytest.mark.parametrize(
    ("kind", "geometry", "message"),
    [
        ("ur", "d1 = 1\na2 = -4\na3 = 0\nd4 = 1\nd5 = 1\nd6 = 1", ":6: 'a3' must be a length that is not zero"),
        ("ur", "d1 = 1\na2 = -4\na3 = 4\nd4 = 1\nd5 = 1\nd6 = 1", ":6: 'a2' and 'a3' must have the same sign"),
        ("scara", "l1 = 300\nl2 = -200\nheight = 300", ":5: 'l2' must be a length above zero"),
        ("chain", "", ":3: a chain needs 'urdf'"),
    ],
)
def test_lengths_that_make_no_arm_of_their_kind(tmp_path: Path, kind: str, geometry: str, message: str) -> None:
    path = tmp_path / "arm.toml"
    path.write_text(f'name = "arm"\nkind = "{kind}"\n[geometry]\n{geometry}\n[axes]\nhome = [0, 0, 0, 0, 0, 0]\n')
    with pytest.raises(RobotError) as caught:
        load_robot(str(path))
    assert f"arm.toml{message}" in str(caught.value)


def test_a_chain_without_axes_and_a_file_that_is_no_text(tmp_path: Path) -> None:
    path = tmp_path / "arm.toml"
    path.write_text('name = "a"\nkind = "chain"\n[geometry]\nurdf = "a.urdf"\n[axes]\nhome = []\n')
    with pytest.raises(RobotError, match=r"arm\.toml:6: 'home' must be a list of one number an axis"):
        load_robot(str(path))
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(RobotError, match="no text in UTF-8"):
        load_robot(str(path))


@settings(max_examples=150, deadline=None)
@given(
    st.sampled_from(NUMBERS),
    st.integers(0, 5),
    st.sampled_from(["nan", "-nan", "inf", "-inf", "+inf", "1e400", "[]", "{}", '"1"', "true", "1979-05-27"]),
)
def test_what_is_no_number_is_refused_in_every_list(
    tmp_path_factory: pytest.TempPathFactory, numbers: str, place: int, wrong: str
) -> None:
    words = numbers.split(", ")
    words[place] = wrong
    assert "arm.toml:" in refused(tmp_path_factory.mktemp("robot"), f"[{numbers}]", f"[{', '.join(words)}]")


URDF = """<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="revolute"><parent link="a"/>
<child link="b"/><axis xyz="0 0 1"/><limit effort="0" velocity="{}" lower="{}" upper="{}"/></joint></robot>"""


@pytest.mark.parametrize(
    ("velocity", "lower", "upper", "message"),
    [
        ("1", "1", "-1", "joint 'j': the limit's 'lower', 57.2958, is above its 'upper', -57.2958"),
        ("1", "nan", "1", "joint 'j': the limit's 'lower' is 'nan', which is no number"),
        ("1", "-1", "inf", "joint 'j': the limit's 'upper' is 'inf', which is no number"),
        ("fast", "-1", "1", "joint 'j': the limit's 'velocity' is 'fast', which is no number"),
        ("-1", "-1", "1", "joint 'j': the limit's 'velocity' is below zero"),
    ],
)
def test_a_wrong_urdf_is_refused_with_its_joint(
    tmp_path: Path, velocity: str, lower: str, upper: str, message: str
) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(URDF.format(velocity, lower, upper))
    with pytest.raises(RobotError) as caught:
        load_robot(str(path))
    assert f"arm.urdf:2: {message}" in str(caught.value)


MOVING = """<robot name="r">
<link name="a"/>
<link name="b"><inertial><mass value="5"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/>
<origin xyz="0 0 0.3" rpy="0 0 0"/><axis xyz="0 0 1"/>
<limit effort="0" velocity="2" lower="-3" upper="3"/></joint></robot>"""


@pytest.mark.parametrize(
    ("right", "wrong", "message"),
    [
        (
            'velocity="2"',
            'velocity="1e-300"',
            "6: joint 'j': the limit's 'velocity' is 1e-300, and no joint is so slow",
        ),
        ('velocity="2"', 'velocity="1e300"', "6: joint 'j': the limit's 'velocity' is 1e+300, and no joint is so fast"),
        ('upper="3"', 'upper="1e9"', "6: joint 'j': the limit's 'upper' is 1e+09, and no joint goes so far"),
        ('upper="3"', f'upper="{"9" * 5000}"', "6: joint 'j': the limit's 'upper' is 'inf', which is no number"),
        ('effort="0"', 'effort="nan"', "6: joint 'j': the limit's 'effort' is 'nan', which is no number"),
        ("0 0 0.3", "0 0 nan", "5: joint 'j': the origin's 'xyz' is 'nan', where three numbers are needed"),
        ("0 0 0.3", "0 0 1e300", "5: joint 'j': the origin's 'xyz' is 1e+300, and no arm is so large"),
        ("0 0 0.3", "0 0", "5: joint 'j': the origin's 'xyz' is '0 0', where three numbers are needed"),
        ('rpy="0 0 0"', 'rpy="0 0 inf"', "5: joint 'j': the origin's 'rpy' is 'inf', where three numbers are needed"),
        ('axis xyz="0 0 1"', 'axis xyz="0 0 0"', "5: joint 'j': the axis has no direction"),
        (
            'axis xyz="0 0 1"',
            'axis xyz="0 0 z"',
            "5: joint 'j': the axis's 'xyz' is 'z', where three numbers are needed",
        ),
        ('mass value="5"', 'mass value="nan"', "3: link 'b': the mass's 'value' is 'nan', which is no number"),
        ('mass value="5"', 'mass value="-5"', "3: link 'b': the mass's 'value' is -5, below zero"),
        ('ixx="1"', 'ixx="1e300"', "3: link 'b': the inertia's 'ixx' is 1e+300, and no link is so heavy or large"),
        ('child link="b"', 'child link="a"', "4: joint 'j': its links hang on each other in a circle"),
    ],
)
def test_numbers_of_a_urdf_that_no_arm_has_are_named_with_line_and_element(
    tmp_path: Path, right: str, wrong: str, message: str
) -> None:
    path = tmp_path / "arm.urdf"
    assert right in MOVING
    path.write_text(MOVING.replace(right, wrong, 1))
    with pytest.raises(RobotError) as caught:
        load_robot(str(path))
    assert f"arm.urdf:{message}" in str(caught.value) and len(str(caught.value)) < 200


@pytest.mark.parametrize("key", ["a1 = 25", "c4 = 80"])
def test_a_key_that_stands_twice_is_named_with_its_line(tmp_path: Path, key: str) -> None:
    message = refused(tmp_path, key, f"{key}\n{key}")
    name, line = key.split(" ")[0], 6 if key.startswith("a1") else 12
    assert f"arm.toml:{line}: '{name}': " in message


def test_a_urdf_whose_joints_hang_on_nothing(tmp_path: Path) -> None:
    pytest.importorskip("pinocchio")
    path = tmp_path / "arm.urdf"
    path.write_text(URDF.format("1", "-1", "1").replace('parent link="a"', 'parent link="z"'))
    with pytest.raises(RobotError, match="describes no robot"):
        load_robot(str(path))
