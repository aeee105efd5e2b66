"""Generated programs show the same before and after all passes of control, for both kinds of target."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rpl.passes.legalise.control.loops import fit_loops
from rpl.passes.legalise.routines.optional import fit_parameters
from rpl.passes.legalise.statements.calls import rewrite_calls
from rpl.passes.legalise.statements.errors import check_errors
from rpl.passes.legalise.statements.logic import decide_logic
from rpl.passes.legalise.statements.switches import unroll_switches
from rpl.passes.legalise.statements.waits import fit_waits

from .common import PLAIN, RICH, read, same_run

PASSES = (fit_parameters, check_errors, fit_waits, unroll_switches, decide_logic, rewrite_calls, fit_loops)
_NUMBERS = ("a", "b", "n")

# ---- RAPID

_RAPID = """MODULE m
  VAR num n:=1;
  VAR num steps:=0;
  PROC show(num v) TPWrite NumToStr(v,2); ENDPROC
  FUNC num act(num v) n:=n+1; show v; RETURN v+n; ENDFUNC
  FUNC num fail(num v) n:=n+1; IF n MOD 3=0 RAISE 4; RETURN v; ENDFUNC
  FUNC bool yes(num v) show v; RETURN v>1; ENDFUNC
  PROC opt(num v \\num w \\switch s) IF Present(w) show w; IF Present(s) show v; ENDPROC
  PROC inner(num v)
    VAR num a:=1;
    VAR num b:=2;
    steps:=steps+1;
    IF steps>20 RETURN;
%s
%s
  ENDPROC
  PROC main()
    VAR num a:=0;
    VAR num b:=5;
%s
    show a; show b; show n;
%s
  ENDPROC
ENDMODULE
"""


def numbers() -> st.SearchStrategy[str]:
    leaf = st.one_of(st.integers(0, 4).map(str), st.sampled_from(_NUMBERS))
    return st.recursive(
        leaf,
        lambda inner: st.one_of(
            st.tuples(inner, st.sampled_from("+-*"), inner).map(lambda t: f"({t[0]}{t[1]}{t[2]})"),
            inner.map(lambda e: f"act({e})"),
            inner.map(lambda e: f"fail({e})"),
            st.tuples(inner, inner).map(lambda t: f"Min({t[0]},{t[1]})"),
            inner.map(lambda e: f"({e} MOD 3)"),
        ),
        max_leaves=3,
    )


def conditions() -> st.SearchStrategy[str]:
    leaf = st.one_of(
        st.tuples(numbers(), st.sampled_from(("=", "<>", "<", ">=")), numbers()).map(lambda t: f"{t[0]}{t[1]}{t[2]}"),
        numbers().map(lambda e: f"yes({e})"),
    )
    return st.recursive(
        leaf,
        lambda inner: st.one_of(
            st.tuples(inner, st.sampled_from((" AND ", " OR ")), inner).map(lambda t: f"(({t[0]}){t[1]}({t[2]}))"),
            inner.map(lambda c: f"(NOT ({c}))"),
        ),
        max_leaves=3,
    )


def _small() -> st.SearchStrategy[str]:
    return st.one_of(
        st.tuples(st.sampled_from(_NUMBERS), numbers()).map(lambda t: f"{t[0]}:={t[1]};"),
        numbers().map(lambda e: f"show {e};"),
        numbers().map(lambda e: f"inner {e};"),
        st.just("RAISE 7;"),
        st.tuples(numbers(), numbers()).map(lambda t: f"opt {t[0]}\\w:={t[1]};"),
        numbers().map(lambda e: f"opt {e}\\s;"),
        numbers().map(lambda e: f'TPWrite "v"+NumToStr({e},1)+"!";'),
    )


def bodies() -> st.SearchStrategy[str]:
    def deeper(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
        block = st.lists(inner, min_size=1, max_size=3).map(" ".join)
        return st.one_of(
            st.tuples(conditions(), block, block).map(lambda t: f"IF {t[0]} THEN {t[1]} ELSE {t[2]} ENDIF"),
            st.tuples(conditions(), block, conditions(), block).map(
                lambda t: f"IF {t[0]} THEN {t[1]} ELSEIF {t[2]} THEN {t[3]} ENDIF"
            ),
            st.tuples(st.integers(-1, 3), numbers(), block).map(
                lambda t: f"FOR i FROM {t[0]} TO {t[1]} MOD 4 DO show i; {t[2]} ENDFOR"
            ),
            st.tuples(st.integers(0, 4), st.integers(0, 4), st.sampled_from(("1", "-1", "2", "b")), block).map(
                lambda t: f"b:=1; FOR k FROM {t[0]} TO {t[1]} STEP {t[2]} DO show k; {t[3]} ENDFOR"
            ),
            st.tuples(conditions(), block).map(
                lambda t: f"WHILE steps<9 AND {t[0]} DO steps:=steps+1; {t[1]} ENDWHILE"
            ),
            st.tuples(numbers(), block, block).map(
                lambda t: f"TEST {t[0]} CASE 1,2: {t[1]} CASE n: show 1; DEFAULT: {t[2]} ENDTEST"
            ),
        )

    return st.recursive(_small(), deeper, max_leaves=5)


def handlers() -> st.SearchStrategy[str]:
    ways = st.sampled_from(("RETRY;", "TRYNEXT;", "RETURN;", "RAISE;", ""))
    return st.one_of(
        st.just(""),
        ways.map(lambda way: f"ERROR show ERRNO; {way}"),
        st.tuples(ways, ways).map(lambda t: f"ERROR IF ERRNO=4 THEN show 40; {t[0]} ENDIF show 41; {t[1]}"),
        st.tuples(ways, ways, ways).map(
            lambda t: f"ERROR IF n<9 THEN {t[0]} ELSEIF ERRNO=7 THEN {t[1]} ENDIF a:=a+1; {t[2]}"
        ),
        ways.map(lambda way: f"ERROR(7) show 70; {way}"),
    )


def _programs_with_handlers_on_a_plain_target(inner: str, caught: str, main: str, last: str) -> None:
    same_run(read("rapid", _RAPID % (inner, caught, main, last)), PLAIN, *PASSES)


@settings(max_examples=50, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(bodies(), handlers(), st.lists(bodies(), min_size=1, max_size=4).map(" ".join), handlers())
def test_programs_with_handlers_on_a_plain_target(inner: str, caught: str, main: str, last: str) -> None:
    _programs_with_handlers_on_a_plain_target(inner, caught, main, last)


@pytest.mark.slow
@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(bodies(), handlers(), st.lists(bodies(), min_size=1, max_size=4).map(" ".join), handlers())
def test_many_programs_with_handlers_on_a_plain_target(inner: str, caught: str, main: str, last: str) -> None:
    _programs_with_handlers_on_a_plain_target(inner, caught, main, last)


# ---- KRL

# What ends a program that would loop for ever.
GUARD = "steps=steps+1\nIF steps>12 THEN\nRETURN\nENDIF\n"
_KRL = """DEF main()
DECL INT a, b, i, k, n, steps
a = 0
b = 5
n = 1
steps = 0
%s
show(a)
show(b)
show(n)
END
DEF show(v:IN)
REAL v
$ANOUT[1] = v
END
DEFFCT INT act(v:IN, n:OUT)
INT v, n
n = n + 1
show(v)
RETURN v + n
ENDFCT
DEFFCT BOOL yes(v:IN)
INT v
show(v)
RETURN v > 1
ENDFCT
"""


def krl_numbers() -> st.SearchStrategy[str]:
    leaf = st.one_of(st.integers(0, 4).map(str), st.sampled_from((*_NUMBERS, "i", "k")))
    return st.recursive(
        leaf,
        lambda inner: st.one_of(
            st.tuples(inner, st.sampled_from("+-*"), inner).map(lambda t: f"({t[0]}{t[1]}{t[2]})"),
            inner.map(lambda e: f"act({e},n)"),
            inner.map(lambda e: f"({e}/3)"),
            st.tuples(inner, st.sampled_from(("B_AND", "B_OR", "B_EXOR")), inner).map(
                lambda t: f"({t[0]} {t[1]} {t[2]})"
            ),
        ),
        max_leaves=3,
    )


def krl_conditions() -> st.SearchStrategy[str]:
    leaf = st.one_of(
        st.tuples(krl_numbers(), st.sampled_from(("==", "<>", "<", ">=")), krl_numbers()).map(
            lambda t: f"({t[0]}{t[1]}{t[2]})"
        ),
        krl_numbers().map(lambda e: f"yes({e})"),
    )
    return st.recursive(
        leaf,
        lambda inner: st.one_of(
            st.tuples(inner, st.sampled_from((" AND ", " OR ", " EXOR ")), inner).map(
                lambda t: f"(({t[0]}){t[1]}({t[2]}))"
            ),
            inner.map(lambda c: f"(NOT ({c}))"),
        ),
        max_leaves=3,
    )


def krl_bodies() -> st.SearchStrategy[str]:
    small = st.one_of(
        st.tuples(st.sampled_from((*_NUMBERS, "i")), krl_numbers()).map(lambda t: f"{t[0]}={t[1]}"),
        krl_numbers().map(lambda e: f"show({e})"),
    )

    def deeper(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
        block = st.lists(inner, min_size=1, max_size=3).map("\n".join)
        leave = krl_conditions().map(lambda c: f"IF {c} THEN\nEXIT\nENDIF")
        return st.one_of(
            st.tuples(krl_conditions(), block, block).map(lambda t: f"IF {t[0]} THEN\n{t[1]}\nELSE\n{t[2]}\nENDIF"),
            st.tuples(st.sampled_from("ik"), st.integers(-1, 3), krl_numbers(), st.sampled_from((1, -1, 2)), block).map(
                lambda t: f"FOR {t[0]}={t[1]} TO {t[2]} STEP {t[3]}\n{GUARD}show({t[0]})\n{t[4]}\nENDFOR"
            ),
            st.tuples(st.sampled_from("ik"), st.integers(0, 3), block).map(
                lambda t: f"FOR {t[0]}=1 TO {t[1]}\n{GUARD}show({t[0]})\n{t[2]}\nENDFOR"
            ),
            st.tuples(krl_conditions(), block).map(lambda t: f"WHILE {t[0]}\n{GUARD}{t[1]}\nENDWHILE"),
            st.tuples(block, krl_conditions()).map(lambda t: f"REPEAT\n{GUARD}{t[0]}\nUNTIL {t[1]}"),
            st.tuples(block, leave, block).map(lambda t: f"LOOP\n{GUARD}{t[0]}\n{t[1]}\n{t[2]}\nENDLOOP"),
            st.tuples(leave, block).map(lambda t: f"LOOP\n{t[0]}\n{GUARD}{t[1]}\nENDLOOP"),
            st.tuples(krl_numbers(), block, block).map(
                lambda t: f"SWITCH {t[0]}\nCASE 1,2\n{t[1]}\nDEFAULT\n{t[2]}\nENDSWITCH"
            ),
        )

    return st.recursive(small, deeper, max_leaves=5)


def _programs_with_loops_on_a_rich_target(body: str) -> None:
    same_run(read("krl", _KRL % f"i = 0\nk = 0\n{body}"), RICH, *PASSES)


@settings(max_examples=50, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(st.lists(krl_bodies(), min_size=1, max_size=4).map("\n".join))
def test_programs_with_loops_on_a_rich_target(body: str) -> None:
    _programs_with_loops_on_a_rich_target(body)


@pytest.mark.slow
@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(st.lists(krl_bodies(), min_size=1, max_size=4).map("\n".join))
def test_many_programs_with_loops_on_a_rich_target(body: str) -> None:
    _programs_with_loops_on_a_rich_target(body)
