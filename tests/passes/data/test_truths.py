"""Truth values as numbers: 1 and 0, or -1 and 0; what decides and what is stored."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.capabilities import DataRule
from rpl.passes.legalise.storage.truths import truths_to_numbers

from .executed import EVERYTHING, context, read, same
from .helpers import lines

BITS = replace(EVERYTHING, types=EVERYTHING.types - {"BoolType"})
MINUS = replace(BITS, data=replace(BITS.data, rules=BITS.data.rules | {DataRule.TRUE_IS_MINUS_ONE}))
MODULE = """
MODULE m
    RECORD state (ready: BOOL, count: INT)
    VAR s: state = {TRUE, 3}
    VAR all: ARRAY[2] OF BOOL = {TRUE, FALSE}
    PROCEDURE t()
        VAR p: BOOL = TRUE
        VAR q: BOOL = FALSE
        VAR n: INT = 1
        %s
        show(p)
        show(q)
        show(s.ready)
        show(all[1] AND NOT all[2])
        SET do[9] TO p
        MESSAGE value_text(n)
    END PROCEDURE
    PROCEDURE show(given: BOOL)
        MESSAGE value_text(to_bit(given))
    END PROCEDURE
    PROCEDURE turn(REFERENCE given: BOOL)
        given = NOT given
    END PROCEDURE
    FUNCTION both(a: BOOL, b: BOOL): BOOL
        RETURN a AND b
    END FUNCTION
END MODULE
"""
CASES = [
    ("p = q", BITS, ["p := q"]),
    ("p = TRUE", BITS, ["p := 1"]),
    ("p = TRUE", MINUS, ["p := -1"]),
    ("p = n > 0", BITS, ["p := bit<(n > 0)>"]),
    ("p = n > 0", MINUS, ["p := minus_bit<(n > 0)>"]),
    ("p = NOT q", BITS, ["p := bit<not (q <> 0)>"]),
    ("p = both(q, n > 0)", BITS, ["p := both(q, bit<(n > 0)>)"]),
    ("IF p THEN n = 2", BITS, ["if (p <> 0)", "  n := 2"]),
    ("IF p = TRUE THEN n = 2", BITS, ["if (p = 1)", "  n := 2"]),
    ("IF p = q THEN n = 2", BITS, ["if (p = q)", "  n := 2"]),
    ("IF both(p, q) OR all[n] THEN n = 2", BITS, ["if ((both(p, q) <> 0) or (all[n] <> 0))", "  n := 2"]),
    ("turn(s.ready)", BITS, ["turn(s.ready)"]),
    ("n = to_bit(p)", BITS, ["n := p"]),
    ("n = to_bit(p)", MINUS, ["n := -p"]),
]


@pytest.mark.parametrize(("source", "target", "wanted"), CASES)
def test_table(source: str, target: object, wanted: list[str]) -> None:
    before = read(MODULE % source)
    given_ = context(before, target)  # type: ignore[arg-type]
    after = same(before, (truths_to_numbers,), given_, entry="t")
    assert lines(after)[: len(wanted)] == wanted
    assert not [node for node in walk(after) if isinstance(node, ir.Variable) and isinstance(node.type, ir.BoolType)]


_TRUTHS = st.recursive(
    st.sampled_from(("p", "q", "s.ready", "all[n]", "all[1]", "TRUE", "n > 1", "di[1]", "do[9]")),
    lambda inner: st.one_of(
        st.tuples(inner, st.sampled_from(("AND", "OR", "XOR", "AND THEN", "=", "<>")), inner).map(
            lambda t: f"(({t[0]}) {t[1]} ({t[2]}))"
        ),
        inner.map(lambda e: f"(NOT ({e}))"),
        st.tuples(inner, inner).map(lambda t: f"both({t[0]}, {t[1]})"),
        inner.map(lambda e: f"(to_bit({e}) = 1)"),
    ),
    max_leaves=4,
)
_STATEMENTS = st.one_of(
    st.tuples(st.sampled_from(("p", "q", "s.ready", "all[n]", "all[2]")), _TRUTHS).map(" = ".join),
    _TRUTHS.map(lambda e: f"SET do[9] TO {e}"),
    _TRUTHS.map(lambda e: f"show({e})"),
    _TRUTHS.map(lambda e: f"IF {e} THEN n = 3 - n"),
    st.sampled_from(("turn(p)", "turn(all[n])", "turn(s.ready)")),
    _TRUTHS.map(lambda e: f"s = {{{e}, 4}}"),
    _TRUTHS.map(lambda e: f"SWITCH {e}\nCASE TRUE\nn = 1\nDEFAULT\nn = 2\nEND SWITCH"),
)


@settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.lists(_STATEMENTS, min_size=1, max_size=5), st.sampled_from((BITS, MINUS)))
def test_any_program_shows_the_same(body: list[str], target: object) -> None:
    before = read(MODULE % "\n".join(body))
    same(before, (truths_to_numbers,), context(before, target), entry="t")  # type: ignore[arg-type]
