"""Variables in numbered storage: which number each gets, what the code becomes, and that it shows the same."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rpl import ir
from rpl.passes.capabilities import Bank
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.data.defaults import starting_values
from rpl.passes.legalise.data.numbers import numbers
from rpl.passes.legalise.storage.numbered import number_data

from .executed import NUMBERED, context, passed, read, same
from .helpers import lines, routine, variable

PASSES = (numbers, starting_values, number_data)


def numbered(text: str, **more: object) -> tuple[ir.Program, Context]:
    before = read(text)
    given = context(before, NUMBERED, **more)
    return same(before, PASSES, given, entry="main"), given


def main(body: str, data: str = "", outside: str = "", more: str = "") -> str:
    return f"MODULE m\n{outside}\nPROCEDURE main()\n{data}\n{body}\nEND PROCEDURE\n{more}\nEND MODULE\n"


CASES = [
    # body, declarations of the routine, of the module, what comes out
    ("a = 1\nb = a + 2", "VAR a, b: INT", "", ["R[1] := 1", "R[2] := (R[1] + 2)"]),
    ("p = TRUE\nq = p", "VAR p, q: BOOL", "", ["F[1] := True", "F[2] := F[1]"]),
    ("a = limit * 2.0", "VAR a: REAL", "CONST limit: REAL = 2.5", ["R[1] := 5.0"]),
    ("a = R5", "VAR a: REAL", "VAR R5: REAL = 1.0\nVAR b: REAL = 2.0",
     ["R[5] := 1.0", "R[2] := R[5]"]),  # nobody looks at b
    ("list[2] = 4\na = list[2]", "VAR a: INT\nVAR list: ARRAY[3] OF INT", "",
     ["R[3] := 4", "R[1] := R[3]"]),
    ("i = 2\nlist[i] = 4", "VAR i: INT\nVAR list: ARRAY[3] OF INT = {7, 8, 9}", "",
     ["R[2] := 7", "R[3] := 8", "R[4] := 9", "R[1] := 2", "R[5] := (R[1] + 1)", "R[R[5]] := 4"]),
    ("a = 0\nFOR i = 1 TO 3\na = a + i\nEND FOR", "VAR i, a: INT", "",
     ["R[2] := 0", "for R1 = 1 to 3", "  R[2] := (R[2] + R1)"]),
    ("i = 1\ngrid[i, 2] = 5", "VAR i: INT\nVAR grid: ARRAY[2, 3] OF INT = {{1, 2, 3}, {4, 5, 6}}", "",
     [*(f"R[{2 + k}] := {1 + k}" for k in range(6)), "R[1] := 1", "R[8] := (R[1] * 3)", "R[R[8]] := 5"]),
    ("list[2] = 4\nother = list", "VAR list: ARRAY[2] OF INT = {1, 2}\nVAR other: ARRAY[2] OF INT", "",
     ["R[1] := 1", "R[2] := 2", "R[2] := 4", "R[3] := R[1]", "R[4] := R[2]"]),
]  # fmt: skip


@pytest.mark.parametrize(("body", "data", "outside", "wanted"), CASES)
def test_table(body: str, data: str, outside: str, wanted: list[str]) -> None:
    after, _ = numbered(main(body, data, outside))
    assert lines(after, "main") == wanted


def test_numbers_do_not_move_when_other_lines_change() -> None:
    _, first = numbered(main("a = 1\nb = 2", "VAR a, b: INT"))
    assert first.register_names == {("R", 1): "main.a", ("R", 2): "main.b"}
    _, again = numbered(main("new = 0\na = 1\nb = 2", "VAR new, a, b: INT"), registers=first.register_names)
    assert again.register_names == {("R", 1): "main.a", ("R", 2): "main.b", ("R", 3): "main.new"}
    _, fewer = numbered(main("b = 2", "VAR b: INT"), registers=again.register_names)
    assert fewer.register_names == {("R", 2): "main.b"}


def test_too_many_variables_are_an_error_with_counts() -> None:
    small = replace(
        NUMBERED,
        storage=replace(
            NUMBERED.storage, banks={**NUMBERED.storage.banks, "RealType": Bank("R", 1, 2), "IntType": Bank("R", 1, 2)}
        ),
    )
    before = read(main("a = 1", "VAR a, b, c: INT"))
    given_ = context(before, small)
    passed(before, PASSES, given_)
    assert [item.message for item in given_.diagnostics] == [
        "the program needs 3 numbers of R, which has 2 (1 to 2); main.c gets none"
    ]


POINTS = """MODULE m
    CONST pick: TARGET = {x: 400, y: 0, z: 300, a: 0, b: 90, c: 0}
    CONST home: JOINTS = {j1: 0, j2: -90, j3: 90, j4: 0, j5: 0, j6: 0}
    VAR taught: TARGET = {x: 410, y: 0, z: 300, a: 0, b: 90, c: 0}
    VAR moving: TARGET = {x: 420, y: 0, z: 300, a: 0, b: 90, c: 0}
    CONST row: ARRAY[2] OF TARGET = {{x: 430, y: 0, z: 30, a: 0, b: 90, c: 0}, {x: 440, y: 0, z: 30, a: 0, b: 90, c: 0}}
    VAR line: ARRAY[2] OF TARGET = {{x: 430, y: 9, z: 30, a: 0, b: 90, c: 0}, {x: 440, y: 9, z: 300, a: 0, b: 90, c: 0}}
    PROCEDURE main()
        VAR i: INT
        MOVE TO home
        MOVE TO pick
        MOVE LINEAR TO taught
        moving.x = moving.x + 5.0
        MOVE LINEAR TO moving
        MOVE LINEAR TO row[2]
        i = 1
        MOVE LINEAR TO line[i]
        moving = pick
        MOVE LINEAR TO moving
        MOVE TO pick
        MOVE TO home
        again()
    END PROCEDURE
    PROCEDURE again()
        MOVE LINEAR TO pick
    END PROCEDURE
END MODULE
"""


def test_taught_points_belong_to_the_routines_that_use_them() -> None:
    before = read(POINTS)
    given_ = context(before, NUMBERED)
    after = same(before, PASSES, given_, robot="kuka_kr6r900sixx", entry="main")
    found = [one for one in routine(after, "main").declarations if isinstance(one, ir.Variable)]
    assert [(one.name, one.label) for one in found] == [
        ("P1", "home"),
        ("P2", "pick"),
        ("P3", "taught"),
        ("P4", "row[2]"),
    ]
    assert [(one.name, one.label) for one in routine(after, "again").declarations if isinstance(one, ir.Variable)] == [
        ("P1", "pick")
    ]
    assert lines(after, "rpl_initialise") == ["PR[1] := P1", "PR[2] := P2", "PR[3] := P3"]
    assert lines(after, "main") == [
        "rpl_initialise()",
        *("joint P1", "joint P2", "linear P3", "PR[1].x := (PR[1].x + 5.0)", "linear PR[1]", "linear P4"),
        *("R[1] := 1", "R[2] := (R[1] + 1)", "linear PR[R[2]]", "PR[1] := P2", "linear PR[1]", "joint P2", "joint P1"),
        "again()",
    ]
    assert isinstance(variable(after, "PR").type, ir.ArrayType)


# ---- whatever is written


def _places() -> st.SearchStrategy[str]:
    index = st.one_of(st.integers(1, 3).map(str), st.sampled_from(("i", "j")))
    return st.one_of(
        st.sampled_from(("a", "i", "x", "R7")),
        index.map(lambda e: f"list[{e}]"),
        index.map(lambda e: f"low[{e} - 1]"),
        st.tuples(index, index).map(lambda t: f"grid[{t[0]}, {t[1]}]"),
    )


def _values() -> st.SearchStrategy[str]:
    leaf = st.one_of(st.integers(0, 3).map(str), _places())
    return st.recursive(
        leaf, lambda e: st.tuples(e, st.sampled_from("+-*"), e).map(lambda t: f"({' '.join(t)})"), max_leaves=3
    )


def _assignments() -> st.SearchStrategy[str]:
    other = _places().filter(lambda name: name not in ("i", "j"))
    return st.one_of(
        st.tuples(other, _values()).map(
            lambda t: f"{t[0]} = to_nearest(to_real({t[1]})) MOD 50" if t[0] != "x" else f"x = {t[1]}"
        ),
        st.integers(1, 3).map(lambda n: f"i = {n}"),
        st.tuples(_values(), _values()).map(lambda t: f"p = {t[0]} < {t[1]}"),
        st.tuples(_places(), _values()).map(lambda t: f"IF p THEN SET do[1] TO {t[0]} < {t[1]}"),
        st.tuples(_values(), _values()).map(
            # behind the loop j is past the arrays, where the source would stop and numbered storage goes on
            lambda t: f"FOR j = 1 TO 3\nlist[j] = j\nMESSAGE value_text({t[0]} = {t[1]})\nEND FOR\nj = 2"
        ),
    )


@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.lists(_assignments(), min_size=1, max_size=6))
def test_any_program_shows_the_same(body: list[str]) -> None:
    data = """VAR i: INT = 1
        VAR j: INT = 2
        VAR a: INT = 3
        VAR x: REAL = 0.5
        VAR p: BOOL = TRUE
        VAR low: ARRAY[2] FROM 0 OF INT = {1, 2, 3}"""
    outside = """VAR R7: INT = 4
        VAR list: ARRAY[3] OF INT = {5, 6, 7}
        VAR grid: ARRAY[3, 3] OF INT = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}"""
    end = [
        "FOR j = 1 TO 3",
        *(f"SET do[2] TO grid[j, {k}] > 4" for k in (1, 2, 3)),
        "SET do[3] TO list[j] > low[j - 1]",
        "END FOR",
    ]
    _, given_ = numbered(main("\n".join((*body, *end)), data, outside))
    assert given_.register_names["R", 7] == "R7"
    assert not given_.diagnostics.has_errors


BOTH = """MODULE m
    VAR shelf: ARRAY[2] OF TARGET = {{x: 400, y: 0, z: 30, a: 0, b: 90, c: 0}, {x: 420, y: 0, z: 30, a: 0, b: 90, c: 0}}
    VAR tools: ARRAY[2] OF POSE = {{x: 0, y: 0, z: 10, a: 0, b: 0, c: 0}, {x: 0, y: 0, z: 20, a: 0, b: 0, c: 0}}
    PROCEDURE main()
        VAR i: INT
        FOR i = 1 TO 2
            $tool = tools[i]
            MOVE LINEAR TO shelf[i]
        END FOR
    END PROCEDURE
END MODULE
"""


def test_poses_and_targets_chosen_at_run_time_share_a_bank() -> None:
    before = read(BOTH)
    given_ = context(before, NUMBERED)
    same(before, PASSES, given_, robot="kuka_kr6r900sixx", entry="main")
    assert not given_.diagnostics.has_errors
    assert given_.register_names["PR", 3] == "tools[1]"
