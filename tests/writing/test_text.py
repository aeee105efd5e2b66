"""Numbers, names and lines: the promises of rpl.writing.text hold for every value."""

from decimal import Decimal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rpl.errors import InternalError
from rpl.writing.target import NameRules
from rpl.writing.text import (
    ALWAYS_POINT,
    NameMangler,
    NumberStyle,
    number_text,
    quoted,
    wrapped,
)

NO_EXPONENT = NumberStyle(exponent="")
STYLES = [NumberStyle(), ALWAYS_POINT, NO_EXPONENT, NumberStyle(exponent="e", signed_exponent=True)]
finite = st.floats(allow_nan=False, allow_infinity=False)


@pytest.mark.parametrize(
    ("value", "decimals", "style", "text"),
    [
        (0, None, NumberStyle(), "0"),
        (-0.0, None, NumberStyle(), "0"),
        (-0.0, 3, ALWAYS_POINT, "0.0"),
        (100.0, None, NumberStyle(), "100"),
        (100.0, None, ALWAYS_POINT, "100.0"),
        (100, None, ALWAYS_POINT, "100"),
        (0.1 + 0.2, 3, NumberStyle(), "0.3"),
        (0.1 + 0.2, None, NumberStyle(), "0.30000000000000004"),
        (12.3456, 3, NumberStyle(), "12.346"),
        (-12.3456, 3, NumberStyle(), "-12.346"),
        (0.0000004, 3, NumberStyle(), "4E-7"),
        (0.0000004, 3, ALWAYS_POINT, "4.0E-7"),
        (0.0000004, 3, NO_EXPONENT, "0.0000004"),
        (-0.00049, 3, NO_EXPONENT, "-0.00049"),
        (1e300, 3, NumberStyle(), "1E300"),
        (1.5e20, None, NumberStyle(exponent="e", signed_exponent=True), "1.5e+20"),
        (1.5e20, None, NO_EXPONENT, "150000000000000000000"),
        (9e9, None, NumberStyle(), "9000000000"),
    ],
)
def test_numbers_read_as_people_write_them(value: float, decimals: int | None, style: NumberStyle, text: str) -> None:
    assert number_text(value, decimals, style) == text


@given(finite, st.sampled_from(STYLES))
def test_without_decimals_a_number_is_exact(value: float, style: NumberStyle) -> None:
    assert float(number_text(value, None, style)) == value


@given(finite, st.integers(0, 9), st.sampled_from(STYLES))
def test_a_printed_number_is_within_half_a_unit_of_its_last_place(
    value: float, decimals: int, style: NumberStyle
) -> None:
    text = number_text(value, decimals, style)
    assert (float(text) == 0) == (value == 0)
    places = -int(Decimal(text.removesuffix(".0")).as_tuple().exponent)  # `.0` only marks a real number
    unit = Decimal(1).scaleb(-max(places, decimals if style.exponent == "" else places))
    assert abs(Decimal(text) - Decimal(repr(value))) <= unit / 2 or Decimal(text) == Decimal(repr(value))
    assert abs(Decimal(text) - Decimal(repr(value))) <= Decimal(1).scaleb(-decimals) / 2


@given(finite, st.integers(0, 9))
def test_a_style_that_wants_points_always_has_one(value: float, decimals: int) -> None:
    assert "." in number_text(value, decimals, ALWAYS_POINT)


def test_what_is_no_number_is_refused() -> None:
    with pytest.raises(InternalError):
        number_text(float("nan"))


RULES = NameRules(longest=8, case_sensitive=False, reserved=frozenset(("for", "if", "x_2")))
names = st.text(st.sampled_from("aAbBxX_$ü29 -"), min_size=1, max_size=20)


@given(st.lists(names, max_size=30))
def test_names_are_legal_apart_and_restored(given_names: list[str]) -> None:
    mangler = NameMangler(RULES, given_names)
    targets = {}
    for name in given_names:
        target = mangler.name(name)
        assert mangler.legal(target)
        targets.setdefault(name.lower(), target)
        assert targets[name.lower()] == target
        assert mangler.restore(target).lower() == name.lower()
        assert mangler.restore(target.upper()).lower() == name.lower()
    assert len({target.lower() for target in targets.values()}) == len(targets)


@given(st.lists(names, max_size=20))
def test_mangling_is_deterministic(given_names: list[str]) -> None:
    first, second = NameMangler(RULES, given_names), NameMangler(RULES, given_names)
    assert [first.name(name) for name in given_names] == [second.name(name) for name in given_names]


def test_a_legal_name_keeps_its_spelling_whatever_stands_before_it() -> None:
    mangler = NameMangler(RULES, ["x y", "x$y", "X_Y"])
    assert mangler.name("X_Y") == "X_Y"
    assert mangler.name("x y") == "x_y_2"
    assert mangler.name("x$y") == "x_y_3"
    assert mangler.renamed() == {"x y": "x_y_2", "x$y": "x_y_3"}


@pytest.mark.parametrize(
    ("source", "target"),
    [
        ("for", "for_2"),
        ("$TOOL", "n_TOOL"),
        ("größe", "gro_e"),
        ("a_very_long_name", "a_very_l"),
        ("9lives", "n9lives"),
    ],
)
def test_single_names(source: str, target: str) -> None:
    assert NameMangler(RULES).name(source) == target


def test_two_names_of_a_case_sensitive_source_stay_two() -> None:
    mangler = NameMangler(RULES, source_case_sensitive=True)
    assert mangler.name("part") == "part"
    assert mangler.name("Part") == "Part_2"
    assert mangler.restore("part_2") == "Part"


def test_fresh_names_meet_nobody() -> None:
    mangler = NameMangler(RULES, ["tmp"])
    assert mangler.fresh("tmp") == "tmp_2"
    assert mangler.fresh("tmp") == "tmp_3"
    assert mangler.name("tmp_2") == "tmp_2_2"


@given(st.text(max_size=200), st.integers(1, 40))
def test_wrapping_loses_nothing(line: str, width: int) -> None:
    parts = wrapped(line, width)
    assert "".join(parts) == line
    assert all(len(part) <= width for part in parts)


@pytest.mark.parametrize("width", [0, -7])
def test_wrapping_ends_where_no_room_is_left(width: int) -> None:
    assert wrapped("abc", width) == ["a", "b", "c"]


def test_quotes() -> None:
    assert quoted('say "hi"') == '"say ""hi"""'
    assert quoted("a\\b", escapes={'"': '""', "\\": "\\\\"}) == '"a\\\\b"'
