"""Generated well-typed programs mean the same in every target. A few run each time, many with `make test-long`.

The programs are written in RPL: numbers, BOOLs, an array, routines with parameters and results, all structures, outputs
and moves. What a target refuses with a guarded stop is no failure here; what it writes must show the same.
"""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from outcomes import DIFFERENT, outcome_of

from rpl import registry
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text

ARM = "kuka_kr6r900sixx"
TARGETS = registry.target_names()

_FRAME = """MODULE generated
    CONST home: JOINTS = {{j1: 0, j2: -90, j3: 90, j4: 0, j5: 60, j6: 0}}
    CONST left: JOINTS = {{j1: 30, j2: -80, j3: 85, j4: 10, j5: 65, j6: -20}}
    CONST near: POSE = {{x: 480, y: 80, z: 680, a: 170, b: 30, c: 180}}
    CONST far: POSE = {{x: 520, y: -60, z: 640, a: 180, b: 20, c: 170}}
    VAR i: INT = 0
    VAR k: INT = 0
    VAR n: INT = 3
    VAR m: INT = -2
    VAR x: REAL = 0.5
    VAR y: REAL = -1.25
    VAR b: BOOL = FALSE
    VAR list: ARRAY[4] OF INT
    PROCEDURE main()
        list[1] = 1
        list[2] = -4
        list[3] = 7
        list[4] = 0
        MOVE TO home JOINT SPEED 50 %
{main}
        SET do[9] TO n > m
        SET do[10] TO b
    END PROCEDURE
    PROCEDURE work(c: INT, r: REAL)
{work}
    END PROCEDURE
    FUNCTION pick(c: INT): INT
        IF c > 2 THEN
            RETURN c - n
        END IF
        RETURN list[c MOD 2 + 2] + c
    END FUNCTION
END MODULE
"""

_small = st.integers(-9, 9)
_whole_names = st.sampled_from(("n", "m"))


def _whole(depth: int = 2) -> st.SearchStrategy[str]:
    leaf = st.one_of(_small.map(lambda v: f"({v})" if v < 0 else str(v)), _whole_names, st.just("list[2]"))
    if depth == 0:
        return leaf
    inner = _whole(depth - 1)
    return st.one_of(
        leaf,
        st.tuples(inner, st.sampled_from("+-"), inner).map(lambda t: f"({t[0]} {t[1]} {t[2]})"),
        st.tuples(inner, st.integers(2, 5)).map(lambda t: f"({t[0]} * {t[1]})"),
        st.tuples(inner, st.sampled_from(("div", "mod")), st.integers(2, 7)).map(lambda t: f"({t[0]} {t[1]} {t[2]})"),
        inner.map(lambda e: f"abs({e})"),
        inner.map(lambda e: f"pick({e} mod 2 + 2)"),
    )


def _real() -> st.SearchStrategy[str]:
    leaf = st.one_of(st.sampled_from(("x", "y", "0.5", "2.25", "-3.75")), _whole(0).map(lambda e: f"to_real({e})"))
    return st.one_of(
        leaf,
        st.tuples(leaf, st.sampled_from("+-*"), leaf).map(lambda t: f"({t[0]} {t[1]} ({t[2]}))"),
        st.tuples(leaf, st.sampled_from(("2", "8"))).map(lambda t: f"(({t[0]}) / {t[1]})"),
    )


def _truth(depth: int = 2) -> st.SearchStrategy[str]:
    comparison = st.tuples(_whole(1), st.sampled_from(("<", ">", "<=", ">=", "=", "<>")), _whole(1))
    leaf = st.one_of(comparison.map(lambda t: f"({t[0]} {t[1]} {t[2]})"), st.just("b"))
    if depth == 0:
        return leaf
    inner = _truth(depth - 1)
    return st.one_of(
        leaf,
        inner.map(lambda e: f"(NOT {e})"),
        st.tuples(inner, st.sampled_from(("AND", "OR")), inner).map(lambda t: f"({t[0]} {t[1]} {t[2]})"),
    )


def _simple() -> st.SearchStrategy[str]:
    return st.one_of(
        st.tuples(_whole_names, _whole()).map(lambda t: f"{t[0]} = {t[1]} mod 50"),
        _real().map(lambda e: f"x = {e}\nIF abs(x) > 100 THEN\nx = 1.5\nEND IF"),
        _truth().map(lambda e: f"b = {e}"),
        st.tuples(st.integers(1, 4), _whole(1)).map(lambda t: f"list[{t[0]}] = {t[1]} mod 20"),
        _whole(1).map(lambda e: f"list[abs({e}) mod 4 + 1] = 2"),
        st.tuples(st.integers(1, 8), _truth(1)).map(lambda t: f"SET do[{t[0]}] TO {t[1]}"),
        st.sampled_from(
            (
                "MOVE TO left JOINT SPEED 40 %",
                "MOVE TO home JOINT SPEED 80 %",
                "MOVE LINEAR TO near SPEED 200 mm/s",
                "MOVE LINEAR TO far SPEED 250 mm/s",
                "WAIT 0.1 s",
            )
        ),
    )


def _block(depth: int) -> st.SearchStrategy[str]:
    statement = _simple() if depth == 0 else st.one_of(_simple(), _simple(), _nested(depth))
    return st.lists(statement, min_size=1, max_size=4).map("\n".join)


def _nested(depth: int) -> st.SearchStrategy[str]:
    inner = _block(depth - 1)
    counter = "ik"[depth % 2]
    leaving = st.sampled_from(("", "IF n > 20 THEN EXIT", "IF m < -5 THEN CONTINUE"))
    return st.one_of(
        st.tuples(_truth(1), inner, inner).map(lambda t: f"IF {t[0]} THEN\n{t[1]}\nELSE\n{t[2]}\nEND IF"),
        st.tuples(_truth(1), inner, _truth(0), inner).map(
            lambda t: f"IF {t[0]} THEN\n{t[1]}\nELSEIF {t[2]} THEN\n{t[3]}\nEND IF"
        ),
        st.tuples(st.integers(-1, 2), st.integers(0, 3), leaving, inner).map(
            lambda t: f"FOR {counter} = {t[0]} TO {t[1]}\n{t[2]}\n{t[3]}\nEND FOR"
        ),
        st.tuples(st.integers(1, 3), leaving.filter(lambda e: "CONTINUE" not in e), inner).map(
            lambda t: f"{counter} = {t[0]}\nWHILE {counter} > 0\n{counter} = {counter} - 1\n{t[1]}\n{t[2]}\nEND WHILE"
        ),
        st.tuples(_whole(1), inner, inner, inner).map(
            lambda t: f"SWITCH abs({t[0]}) mod 4\nCASE 0, 1\n{t[1]}\nCASE 2\n{t[2]}\nDEFAULT\n{t[3]}\nEND SWITCH"
        ),
    )


@st.composite
def programs(draw: st.DrawFn) -> str:
    calls = st.tuples(_whole(1), _real()).map(lambda t: f"work({t[0]}, {t[1]})")
    parts = draw(st.lists(st.one_of(_block(2), _block(2), calls), min_size=1, max_size=4))
    work = draw(_block(1))
    return _FRAME.format(main="\n".join(parts), work=f"n = n + c mod 10\ny = r\n{work}")


def check(text: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("generated.rpl", text)], "rpl", diagnostics)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    for target in TARGETS:
        outcome, _ = outcome_of(read, target, ARM, None, "main")
        assert outcome.status != DIFFERENT, f"{target}: {outcome.why}\n{text}"


_QUIET = (HealthCheck.too_slow, HealthCheck.data_too_large, HealthCheck.large_base_example)


@settings(max_examples=6, deadline=None, suppress_health_check=_QUIET)
@given(programs())
def test_generated_programs_mean_the_same_everywhere(text: str) -> None:
    check(text)


@pytest.mark.slow
@settings(max_examples=400, deadline=None, suppress_health_check=_QUIET)
@given(programs())
def test_many_generated_programs_mean_the_same_everywhere(text: str) -> None:
    check(text)
