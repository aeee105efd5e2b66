"""Every neutral function, procedure and system variable is there; values behave as languages have them."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rpl import ir
from rpl.cell import parse_cell
from rpl.errors import UsageError
from rpl.passes import rigid
from rpl.runtime.faults import ProgramError
from rpl.runtime.functions import neutral, procedures, system, texts
from rpl.runtime.values import Array, PoseValue, Record, RotationValue, Value, VectorValue, copied, pose_of


def test_nothing_of_the_neutral_tables_is_missing() -> None:
    assert set(neutral.PURE) | set(neutral.OF_TASK) | neutral.BY_PLACE == set(ir.FUNCTIONS)
    assert set(procedures.PROCEDURES) == set(ir.PROCEDURES)
    assert set(system.READ) == set(ir.SYSTEM_VARIABLES)
    assert set(system.WRITE) == {row.name for row in ir.SYSTEM_VARIABLES.values() if row.access == "rw"}


ANGLE = st.floats(-179.0, 179.0)


@given(ANGLE, st.floats(-89.0, 89.0), ANGLE)
def test_components_read_back_exactly_as_given(a: float, b: float, c: float) -> None:
    pose = PoseValue(VectorValue(1.0, 2.0, 3.0), RotationValue("zyx", (a, b, c)))
    assert [pose.get(name) for name in ("x", "y", "z", "a", "b", "c")] == [1.0, 2.0, 3.0, a, b, c]
    quaternion = tuple(pose.get(name) for name in ("q1", "q2", "q3", "q4"))
    again = RotationValue("quaternion", quaternion)
    assert [again.get(name) for name in ("a", "b", "c")] == pytest.approx([a, b, c], abs=1e-6)


@given(ANGLE, ANGLE, ANGLE, st.floats(-1e3, 1e3))
def test_a_pose_times_its_inverse_is_nothing(a: float, b: float, c: float, x: float) -> None:
    pose = PoseValue(VectorValue(x, -x, 2 * x), RotationValue("zyx", (a, b, c)))
    done = neutral.compose(pose, neutral.inverse(pose)).rigid()
    assert done.position.length < 1e-6 and abs(abs(done.rotation.quaternion[0]) - 1.0) < 1e-9
    moved = neutral.PURE["tool_offset"](neutral.PURE["tool_offset"](pose, 0, 0, 10), 0, 0, -10)
    assert math.dist(moved.trans, pose.trans) < 1e-6


def test_offset_keeps_the_rotation_and_tool_offset_turns_about_moving_axes() -> None:
    pose = pose_of(rigid.Pose(rigid.Vector(0, 0, 0), rigid.rotation_of_zyx(90, 0, 0)), "zyx")
    assert neutral.PURE["offset"](pose, 1, 2, 3).trans == (1, 2, 3)
    assert neutral.PURE["tool_offset"](pose, 10, 0, 0).trans == pytest.approx((0, 10, 0), abs=1e-12)
    turned = neutral.PURE["tool_offset"](pose, 0, 0, 0, 90, 0, 90)  # about x, then about the new z
    wanted = rigid.rotation_of_zyx(90, 0, 0).then(rigid.rotation_of_zyx(0, 0, 90)).then(rigid.rotation_of_zyx(90, 0, 0))
    assert turned.rot.same(RotationValue("quaternion", wanted.quaternion))


def test_records_and_arrays_are_copied_when_assigned() -> None:
    one = Record("r", {"list": Array([1, 2]), "n": 1})
    other = copied(one)
    other.parts["list"].items[0] = 9
    assert one.parts["list"].items == [1, 2] and one != other


@pytest.mark.parametrize(("index", "good"), [(1, True), (3, True), (0, False), (4, False), (2.5, False)])
def test_indices_are_checked(index: float, good: bool) -> None:
    array = Array([1, 2, 3])
    if good:
        assert array.at(index) == index - 1
    else:
        with pytest.raises(ProgramError):
            array.at(index)


@pytest.mark.parametrize(
    ("function", "arguments", "result"),
    [
        ("text_part", ("abcdef", 2, 3), "bcd"),
        ("text_find", ("abcabc", 2, "bc"), 2),
        ("text_find", ("abc", 1, "x"), 0),
        ("text_find_any", ("Robotics", 1, "aeiou"), 2),
        ("text_match", ("Robotics", 1, "bo"), 3),
        ("text_match", ("Robotics", 1, "xx"), 9),
        ("text_map", ("Robotics", "aeiou", "AEIOU"), "RObOtIcs"),
        ("text_equal", ("Ab", "aB", True), True),
        ("text_order", ("FIRST", "SECOND", "ABCDEFGHIJKLMNOPQRSTUVWXYZ"), True),
        ("number_text", (2.456, 1), "2.5"),
        ("number_text", (-0.04, 1), "0.0"),
        ("number_text", (2.5, 0), "3"),
        ("format", ("%d-%5.2f-%s|%3d|%c", 5, 3.14159, "x", 7, "A"), "5- 3.14-x|  7|A"),
        ("message_text", ("%1 of %2, %3", 1, 2), "1 of 2, %3"),
        ("round", (2.5,), 3),
        ("round", (-2.5,), -3),
        ("round", (3.14159, 2), 3.14),
        ("trunc", (-2.7,), -2),
    ],
)
def test_functions_by_example(function: str, arguments: tuple[object, ...], result: object) -> None:
    assert neutral.PURE[function](*arguments) == result


def test_numbers_written_in_texts_are_read_by_the_marks_of_the_language() -> None:
    assert texts.text_value(" -1.5 ") == -1.5


def test_values_are_read_from_text_in_the_shape_of_the_variable() -> None:
    assert texts.parsed("[1,2.5,-3]", VectorValue(0, 0, 0)) == (1, 2.5, -3)
    assert texts.parsed("TRUE", False) is True
    for text, like in (("[1,2]", VectorValue(0, 0, 0)), ("x", 1.0), ("1", True)):
        with pytest.raises(ValueError):
            texts.parsed(text, like)


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("nonsense = 1", "cell:1: nonsense: unknown"),
        ("[[input]]\ntime = 1\nsignal = 'di1'", r"cell:1: input\[1\].value: is missing"),
        ("[[input]]\ntime = -1\nsignal = 'di1'\nvalue = true", r"cell:2: input\[1\].time"),
        ("[[input]]\ntime = 1\nsignal = 'di1'\nvalue = 'x'", r"cell:4: input\[1\].value"),
        ("[[reaction]]\nwhen = 'do1'\nsignal='di1'\nvalue=true\nwhile=3", r"cell:5: reaction\[1\].while: unknown"),
        ("[[vendor]]\nmatch = '('", r"cell:2: vendor\[1\].match: is no regular expression"),
        ("[[vendor]]\nmatch = 'x'\neffect = 'magic'", r"cell:3: vendor\[1\].effect"),
        ("[system]\nwarp = 9", "cell:2: system.warp: is no system variable"),
        ("x = [", "cell: Invalid value"),
    ],
)
def test_a_wrong_cell_file_names_the_key(text: str, complaint: str) -> None:
    with pytest.raises(UsageError, match=complaint):
        parse_cell(text)


@pytest.mark.parametrize(
    ("value", "decimals", "text"),
    [
        (True, 0, "TRUE"),
        (VectorValue(1.5, 2, -3), 0, "[1.5,2,-3]"),
        (1.0 / 3.0, 0, "0.333333"),
        (100.0 / 3.0, 6, "33.333333"),
        (2.5, 6, "2.5"),
    ],
)
def test_values_as_texts(value: Value, decimals: int, text: str) -> None:
    """`decimals`: so many where a language shows numbers with fractions that way, else six digits in all."""
    assert texts.shown_value(value, decimals) == text
