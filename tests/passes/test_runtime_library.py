"""The routines of `rpl.library` give what the neutral functions give: both run on the emulated runtime."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import resources

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpl.diagnostics import Diagnostics
from rpl.library import routines
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_text

FILES = ("numbers", "simplenumbers", "wholenumbers", "texts", "textparts", "sourcetexts", "geometry", "geometryparts")


@dataclass(frozen=True)
class Same:
    """A condition that holds for all arguments; `{0}`, `{1}` ... stand for them."""

    file: str
    condition: str
    arguments: tuple[st.SearchStrategy[str], ...]


def _number(least: float, most: float, step: float = 1 / 64) -> st.SearchStrategy[str]:
    """Numbers that are exact, so that both sides decide alike on a half or a border; some are whole."""
    return st.integers(round(least / step), round(most / step)).map(lambda n: repr(n * step))


def _text(signs: str, least: int = 0) -> st.SearchStrategy[str]:
    return st.text(signs, min_size=least, max_size=8).map(lambda text: f'"{text}"')


X = _number(-300, 300)
POSITIVE = _number(1 / 64, 300)
SHARE = _number(-1, 1)
N = st.integers(-1000, 1000).map(str)
COUNT = st.integers(0, 9).map(str)
DECIMALS = st.integers(0, 4).map(str)
BOOL = st.sampled_from(("TRUE", "FALSE"))
WORD, LETTERS = _text("abcABC xyz:09"), _text("abc")
SIGN = st.sampled_from("abcAZ 09:#_").map(lambda sign: f'"{sign}"')
DIGITS = st.integers(-99999, 99999).map(lambda n: f'"{n / 100}"')
ANGLE = _number(-179, 179)
POSE = st.tuples(X, X, X, ANGLE, _number(-85, 85), ANGLE).map(
    lambda six: "pose {" + ", ".join(f"{n}: {v}" for n, v in zip("xyzabc", six, strict=True)) + "}"
)
NONZERO = X.filter(lambda text: float(text) != 0.0)


HEADS = ("    FUNCTION {}(", "    PROCEDURE {}(")


def _rows(file: str, *rows: tuple[str, *tuple[st.SearchStrategy[str], ...]]) -> list[Same]:
    return [Same(file, condition, tuple(arguments)) for condition, *arguments in rows]


CASES = [
    *_rows(
        "numbers",
        ("rpl_trunc({0}) = trunc({0})", X),
        ("rpl_floor({0}) = floor({0})", X),
        ("rpl_ceil({0}) = ceil({0})", X),
        ("near(rpl_round({0}, {1}), round({0}, {1}))", X, DECIMALS),
        ("near(rpl_cut({0}, {1}), trunc({0}, {1}))", X, DECIMALS),
        ("near(rpl_mod({0}, {1}), {0} - trunc({0} / {1}) * {1})", X, NONZERO),
        ("rpl_min({0}, {1}) = min({0}, {1})", X, X),
        ("rpl_max({0}, {1}) = max({0}, {1})", X, X),
        ("rpl_min_int({0}, {1}) = min({0}, {1})", N, N),
        ("rpl_max_int({0}, {1}) = max({0}, {1})", N, N),
        ("near(rpl_exp({0} / 20.0), exp({0} / 20.0))", X),
        ("near(rpl_log({0}), log({0}))", POSITIVE),
        ("near(rpl_power({0}, {1} / 20.0), power({0}, {1} / 20.0))", POSITIVE, N),
        ("rpl_band({0}, {1}) = ({0} BAND {1})", N, N),
        ("rpl_bor({0}, {1}) = ({0} BOR {1})", N, N),
        ("rpl_bxor({0}, {1}) = ({0} BXOR {1})", N, N),
        ("rpl_sign({0}) = sign({0})", X),
        ("rpl_shift_left({0}, {1}) = bit_shift_left({0}, {1})", N, COUNT),
        ("rpl_shift_right({0}, {1}) = bit_shift_right({0}, {1})", N, COUNT),
        ("rpl_bit({0}) = to_bit({0}) AND rpl_minus_bit({0}) = -to_bit({0})", BOOL),
    ),
    *_rows(
        "simplenumbers",
        ("rpl_abs({0}) = abs({0})", X),
        ("rpl_abs_whole({0}) = abs({0})", N),
        ("rpl_min({0}, {1}) = min({0}, {1}) AND rpl_max({0}, {1}) = max({0}, {1})", X, X),
        ("rpl_min_whole({0}, {1}) = min({0}, {1}) AND rpl_max_whole({0}, {1}) = max({0}, {1})", N, N),
        ("rpl_sign({0}) = sign({0})", X),
        ("rpl_floor({0}) = floor({0}) AND rpl_ceil({0}) = ceil({0})", X),
        ("rpl_round({0}) = round({0})", X),
        ("near(rpl_atan2({0}, {1}), atan2({0}, {1}))", X, NONZERO),
        ("near(rpl_atan({0}), atan({0}))", X),
        ("near(rpl_asin({0}), asin({0})) AND near(rpl_acos({0}), acos({0}))", SHARE),
        ("near(rpl_tan({0}), tan({0}))", _number(-85, 85)),
        ("rpl_bit({0}) = to_bit({0}) AND rpl_minus_bit({0}) = -to_bit({0})", BOOL),
    ),
    *_rows(
        "wholenumbers",
        ("rpl_round({0}) = round({0}) AND rpl_trunc({0}) = trunc({0})", X),
        ("rpl_floor({0}) = floor({0}) AND rpl_ceil({0}) = ceil({0})", X),
        ("near(rpl_round_to({0}, {1}), round({0}, {1}))", X, DECIMALS),
        ("near(rpl_trunc_to({0}, {1}), trunc({0}, {1}))", X, DECIMALS),
        ("rpl_mod({0}, {1}) = {0} - ({0} DIV {1}) * {1}", N, N.filter(lambda text: text != "0")),
        ("near(rpl_mod_real({0}, {1}), {0} - trunc({0} / {1}) * {1})", X, NONZERO),
        ("rpl_min({0}, {1}) = min({0}, {1}) AND rpl_max({0}, {1}) = max({0}, {1})", X, X),
        ("rpl_min_whole({0}, {1}) = min({0}, {1}) AND rpl_max_whole({0}, {1}) = max({0}, {1})", N, N),
        ("rpl_bound({0}, {0} + {1}) = floor({0} + {1})", X, POSITIVE),
        ("rpl_bound({0}, {0} - {1}) = ceil({0} - {1})", X, POSITIVE),
        ("near(rpl_asin({0}), asin({0}))", SHARE),
    ),
    *_rows(
        "textparts",
        ("rpl_from_code(rpl_character_code({0})) = {0} AND rpl_character_code({0}) = character_code({0})", SIGN),
        ("rpl_text_find({0}, 1, {1}) = text_find({0}, 1, {1})", WORD, _text("abc", 1)),
        ("rpl_text_match({0}, 1, {1}) = text_match({0}, 1, {1})", WORD, _text("abc", 1)),
        ("rpl_text_member({0}, 1, {1}) = text_member({0}, 1, {1})", _text("abcxyz", 1), LETTERS),
        ("rpl_text_find_any({0}, 1, {1}) = text_find_any({0}, 1, {1})", WORD, LETTERS),
        ('rpl_text_map({0}, "abc", "xyz") = text_map({0}, "abc", "xyz")', WORD),
        ("rpl_text_upper({0}) = text_upper({0}) AND rpl_text_lower({0}) = text_lower({0})", WORD),
        (
            'rpl_text_put({0}, 2, "*") = text_part({0}, 1, 1) & "*" & text_part({0}, 3, text_length({0}) - 2)',
            _text("abc", 2),
        ),
        ("rpl_number_text({0}, {1}) = number_text({0}, {1})", X, DECIMALS),
        ("reads({0})", DIGITS),
        ("reads_nothing({0})", st.sampled_from(('""', '"x"', '"1.2.3"', '"--1"', '"1e"', '"+"', '"1 2"'))),
    ),
    *_rows(
        "sourcetexts",
        (
            "near(rpl_leading_number({0} & {1}), text_value({0}))",
            DIGITS,
            st.sampled_from(('""', '" x"', '"z"', '";1"')),
        ),
        ("rpl_bytes_number(rpl_number_bytes({0}, 4), 1, 4) = {0}", N),
        ("rpl_number_bytes({0}, 4) = number_bytes({0}, 4)", N),
        ("scans({0}, {1})", st.integers(-999, 999).map(str), st.sampled_from(('""', '" "', '"x"', '" 1"'))),
    ),
    *_rows(
        "geometry",
        (
            "near_pose(rpl_frame({0}, {1}, {2}, {3}, 5.0, 6.0), pose {{x: {0}, y: {1}, z: {2}, a: {3}, "
            "b: 5.0, c: 6.0}})",
            X,
            X,
            X,
            ANGLE,
        ),
        (
            "near_pose(rpl_rotation(rpl_quaternion(1, {0}, {1}, {2}), rpl_quaternion(2, {0}, {1}, "
            "{2}), rpl_quaternion(3, {0}, {1}, {2}), rpl_quaternion(4, {0}, {1}, {2})), pose {{x: 0.0, "
            "y: 0.0, z: 0.0, a: {0}, b: {1}, c: {2}}})",
            ANGLE,
            _number(-85, 85),
            ANGLE,
        ),
        ("near_pose(rpl_transform({0}, 1.0, 2.0, 3.0), placed({0}))", POSE),
        ("near(rpl_length({0}, {1}, {2}), sqrt({0} * {0} + {1} * {1} + {2} * {2}))", X, X, X),
        (
            "near_pose(rpl_pose_from_rotation_vector({0}, {1}, {2}, {3}, {4}, {5}), "
            "pose_from_rotation_vector({0}, {1}, {2}, {3}, {4}, {5}))",
            X,
            X,
            X,
            *[_number(-90, 90)] * 3,
        ),
        ("near_pose(rpl_interpolate_pose({0}, {1}, {2}), interpolate_pose({0}, {1}, {2}))", POSE, POSE, _number(0, 1)),
        ("near(rpl_rotation_angle({0}, {1}), rotation_angle({0}, {1}))", POSE, POSE),
        ("near_pose(rpl_pose_sum({0}, {1}), pose_sum({0}, {1}))", POSE, POSE),
        ("near_pose(rpl_pose_difference({0}, {1}), pose_difference({0}, {1}))", POSE, POSE),
        (
            "near(rpl_zyz_part({0}, 1), zyz_yaw({0})) AND near(rpl_zyz_part({0}, 2), zyz_pitch({0})) "
            "AND near(rpl_zyz_part({0}, 3), zyz_roll({0}))",
            POSE,
        ),
        ("near_pose(rpl_aligned({0}), aligned({0}))", POSE),
        ("near_pose(rpl_arc_middle({0}, {1}, {2}), arc_middle({0}, {1}, {2}))", POSE, POSE, POSE),
    ),
    *_rows(
        "geometryparts",
        (
            "near_pose(rpl_frame({0}, {1}, {2}, {3}, 5.0, 6.0), pose {{x: {0}, y: {1}, z: {2}, a: {3}, "
            "b: 5.0, c: 6.0}})",
            X,
            X,
            X,
            ANGLE,
        ),
    ),
]

# What the conditions use; `scans` and `reads` are about routines that set a parameter.
HELPERS = """
FUNCTION near(one: REAL, other: REAL): BOOL
    RETURN abs(one - other) <= 0.0000001 * max(1.0, abs(other))
END FUNCTION
FUNCTION near_pose(one: POSE, other: POSE): BOOL
    IF abs(one.x - other.x) + abs(one.y - other.y) + abs(one.z - other.z) > 0.00001 THEN RETURN FALSE
    RETURN rotation_angle(one, other) < 0.00001
END FUNCTION
"""
MORE = {
    "geometry": """
FUNCTION placed(p: POSE): POSE
    VAR q: POSE
    q = p : pose {x: 1.0, y: 2.0, z: 3.0, a: 0.0, b: 0.0, c: 0.0}
    q.a = 0.0
    q.b = 0.0
    q.c = 0.0
    RETURN q
END FUNCTION
""",
    "textparts": """
FUNCTION reads(t: STRING): BOOL
    VAR value: REAL
    VAR whole: INT
    VAR good: BOOL
    good = rpl_parse_number(t, value)
    IF NOT good OR value <> text_value(t) THEN RETURN FALSE
    good = rpl_parse_whole(t, whole)
    IF good THEN RETURN whole = value
    RETURN value <> to_int(value)
END FUNCTION
FUNCTION reads_nothing(t: STRING): BOOL
    VAR value: REAL
    VAR whole: INT
    RETURN NOT rpl_parse_number(t, value) AND NOT rpl_parse_whole(t, whole)
END FUNCTION
""",
    "sourcetexts": """
FUNCTION scans(number: INT, behind: STRING): BOOL
    VAR value: REAL
    VAR digits: STRING
    VAR end: INT
    digits = number_text(number, 0)
    end = rpl_scan_number("  " & digits & behind, 1, 0, value)
    RETURN end = text_length(digits) + 3 AND value = number
END FUNCTION
""",
}
# Routines of other files that these ones call.
ALSO = {"sourcetexts": "textparts"}


def _wrong(file: str, conditions: list[str]) -> list[str]:
    """The conditions that do not hold on the emulated runtime."""
    texts = {**routines(ALSO.get(file, file)), **routines(file)}
    checks = "".join(f'IF NOT ({one}) THEN MESSAGE "{n}"\n' for n, one in enumerate(conditions))
    module = "\n".join((*texts.values(), HELPERS, MORE.get(file, "")))
    text = f"MODULE m\n{module}\nPROCEDURE main()\n{checks}END PROCEDURE\nEND MODULE\n"
    diagnostics = Diagnostics()
    program = read_sources([source_from_text("m.rpl", text)], "rpl", diagnostics).program
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    result = run_program(program, entry="main")
    assert result.status == "finished", result.fault
    return [conditions[int(message[1])] for message in result.messages]


def _condition(case: Same) -> st.SearchStrategy[str]:
    return st.tuples(*case.arguments).map(lambda given: case.condition.format(*given))


@pytest.mark.parametrize("file", sorted({case.file for case in CASES}))
def test_routines_give_what_the_neutral_functions_give(file: str) -> None:
    cases = [case for case in CASES if case.file == file]
    rows = st.tuples(
        *(st.tuples(*case.arguments).map(lambda given, c=case: c.condition.format(*given)) for case in cases)
    )

    @settings(max_examples=12, deadline=None, derandomize=True)
    @given(rows)
    def holds(conditions: tuple[str, ...]) -> None:
        assert _wrong(file, list(conditions)) == []

    holds()


@pytest.mark.parametrize("file", FILES)
def test_every_routine_has_a_remark_and_is_read(file: str) -> None:
    text = resources.files("rpl.library").joinpath(f"{file}.rpl").read_text("utf-8")
    assert text.startswith("-- ")
    for name in routines(file):
        before, _, _ = text.partition(next(head for head in HEADS if head.format(name) in text).format(name))
        assert before.splitlines()[-1].startswith("    -- "), name
    diagnostics = Diagnostics()
    read = read_sources([source_from_text(f"{file}.rpl", text)], "rpl", diagnostics).program
    assert not diagnostics.has_errors
    assert [routine.name for routine in read.modules[0].routines] == list(routines(file))
