"""Records as one variable for each component: what the declarations become, and that the program shows the same."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rpl import ir
from rpl.passes.legalise.records.flatrecords import flat_records

from .executed import WEAK, context, read, same
from .helpers import lines

MODULE = """
MODULE m
    RECORD size (length: REAL, width: REAL)
    RECORD box (outer: size, count: INT, sizes: ARRAY[2] OF size)
    VAR one: box = {outer: {length: 1.0, width: 2.0}, count: 3, sizes: {{4.0, 5.0}, {6.0, 7.0}}}
    VAR row: ARRAY[2] OF box
    VAR plain: ARRAY[2] OF size = {{length: 1.5, width: 2.5}, {length: 3.5, width: 4.5}}
    PROCEDURE t()
        VAR s, u: size
        VAR i: INT = 1
        VAR x: REAL = 0.5
        s = plain[2]
        u = s
        row[1] = one
        row[2] = one
        %s
        MESSAGE value_text(x) & " " & value_text(s.length) & " " & value_text(u.width) & " " & value_text(i)
        show(row[1])
        show(row[2])
        show(one)
    END PROCEDURE
    PROCEDURE show(b: box)
        MESSAGE value_text(b.outer.length) & " " & value_text(b.outer.width) & " " & value_text(b.count)
        MESSAGE value_text(b.sizes[1].width) & " " & value_text(b.sizes[2].length)
    END PROCEDURE
    PROCEDURE grow(REFERENCE given: size, by: REAL)
        given.length = given.length + by
        given = {given.width, given.length}
    END PROCEDURE
    FUNCTION sum(a: size, b: size): size
        MESSAGE "sum"
        RETURN {length: a.length + b.length, width: a.width + b.width}
    END FUNCTION
    FUNCTION area(a: size): REAL
        RETURN a.length * a.width
    END FUNCTION
END MODULE
"""
CASES = [
    ("s.length = 4.0", ["s_length := 4.0"]),
    ("s = {1.0, 2.0}", ["s_length := 1.0", "s_width := 2.0"]),
    ("u = {width: 2.0}", ["u_width := 2.0"]),
    ("s = {s.width, s.length}", ["part := s_width", "part2 := s_length", "s_length := part", "s_width := part2"]),
    ("row[i].outer = s", ["row_outer_length[i] := s_length", "row_outer_width[i] := s_width"]),
    ("x = row[i].sizes[2].width", ["x := row_sizes_width[i, 2]"]),
    ("grow(s, 1.0)", ["grow(s_length, s_width, 1.0)"]),
    ("x = area(plain[i])", ["x := area(plain_length[i], plain_width[i])"]),
    ("s = sum(s, u)", ["part := sum(s_length, s_width, u_length, u_width)", "part2 := sum_width", "s_length := part",
                       "s_width := part2"]),
    ("IF s = u THEN x = 1.0", ["if ((s_length = u_length) and (s_width = u_width))", "  x := 1.0"]),
]  # fmt: skip


@pytest.mark.parametrize(("source", "wanted"), CASES)
def test_table(source: str, wanted: list[str]) -> None:
    before = read(MODULE % source)
    after = same(before, (flat_records,), context(before, WEAK), entry="t")
    start = lines(same(read(MODULE % ""), (flat_records,), context(read(MODULE % ""), WEAK), entry="t"))
    found = lines(after)
    first = next(at for at, (a, b) in enumerate(zip(found, start, strict=False)) if a != b)
    assert found[first : first + len(wanted)] == wanted
    assert not [one for one in after.modules[0].declarations if isinstance(one, ir.RecordDeclaration)]


_SIZES = st.sampled_from(("s", "u", "row[1].outer", "row[i].sizes[2]", "plain[i]", "one.outer", "one.sizes[i]"))
_PARTS = st.tuples(_SIZES, st.sampled_from(("length", "width"))).map(".".join)
_NUMBERS = st.one_of(_PARTS, st.sampled_from(("x", "1.5", "2.0")), _SIZES.map(lambda s: f"area({s})"))
_VALUES = st.one_of(
    _SIZES,
    st.tuples(_NUMBERS, _NUMBERS).map(lambda t: f"{{{t[0]}, {t[1]}}}"),
    st.tuples(_SIZES, _SIZES).map(lambda t: f"sum({t[0]}, {t[1]})"),
    st.tuples(_SIZES, _SIZES, _SIZES).map(lambda t: f"sum(sum({t[0]}, {t[1]}), {t[2]})"),
)
_STATEMENTS = st.one_of(
    st.tuples(_SIZES, _VALUES).map(" = ".join),
    st.tuples(_PARTS, _NUMBERS).map(lambda t: f"{t[0]} = {t[1]}"),
    st.tuples(_VALUES, _VALUES).map(lambda t: f"x = area(sum({t[0]}, {t[1]}))"),
    st.tuples(_VALUES, _VALUES).map(lambda t: f"x = sum({t[0]}, {t[1]}).width"),
    st.tuples(_SIZES, _NUMBERS).map(lambda t: f"grow({t[0]}, {t[1]})"),
    st.tuples(_SIZES, _SIZES).map(lambda t: f"IF {t[0]} <> {t[1]} THEN x = x + 1.0"),
    st.tuples(_SIZES, _SIZES).map(lambda t: f"row[i] = {{{t[0]}, 7, {{{t[1]}, {t[0]}}}}}"),
    st.sampled_from(("i = 1", "i = 2", "one = row[i]", "row[2] = row[1]")),
)


@settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.lists(_STATEMENTS, min_size=1, max_size=5))
def test_any_program_shows_the_same(body: list[str]) -> None:
    before = read(MODULE % "\n".join(body))
    given_ = context(before, WEAK)
    same(before, (flat_records,), given_, entry="t")
    assert not list(given_.diagnostics)


def test_a_function_that_the_project_lacks_gives_no_components() -> None:
    before = read(MODULE % "s = missing(1.0)")
    given_ = context(before, WEAK)
    flat_records(before, given_)
    assert [item.code.name for item in given_.diagnostics] == ["record-as-a-whole"]
