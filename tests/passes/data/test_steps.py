"""Nested expressions as steps: what comes out is simple, in the right order, and shows the same."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rpl import ir
from rpl.passes.capabilities import Aggregate, Limit
from rpl.passes.legalise.control.steps import POLLED, steps
from rpl.passes.legalise.facts.effects import children, statements_in
from rpl.passes.legalise.rewriting.operands import is_operand
from rpl.passes.legalise.statements.logic import decide_logic

from .executed import EVERYTHING, WEAK, context, passed, read, same
from .helpers import lines, show_statement

STEPS = replace(WEAK, operators=EVERYTHING.operators, control=replace(WEAK.control, short_circuit=True))
ALONE = replace(
    EVERYTHING,
    control=replace(EVERYTHING.control, limits=EVERYTHING.control.limits | {Limit.FUNCTIONS_ALONE, Limit.PLAIN_PLACES}),
)


def program(body: str, data: str = "") -> str:
    return f"""
MODULE m
    VAR n: INT = 1
    VAR list: ARRAY[9] OF INT
    PROCEDURE t()
        VAR a, b: INT
        VAR x: REAL
        VAR p, q: BOOL
        {data}
        {body}
    END PROCEDURE
    FUNCTION act(v: INT): INT
        n = n + 1
        MESSAGE "act" & value_text(v)
        RETURN v + n
    END FUNCTION
    FUNCTION yes(v: INT): BOOL
        MESSAGE "yes" & value_text(v)
        RETURN v > 1
    END FUNCTION
END MODULE
"""


CASES = [
    # source, target, what comes out
    ("a = 1 + 2 * b", STEPS, ["step := (2 * b)", "a := (1 + step)"]),
    ("a = b + 1", STEPS, ["a := (b + 1)"]),
    ("x = sin(x + 1.0)", STEPS, ["step := (x + 1.0)", "x := sin(step)"]),
    ("x = 1.0 + sin(x + 1.0) * 2.0", ALONE, ["step := (x + 1.0)", "step2 := sin(step)", "x := (1.0 + (step2 * 2.0))"]),
    ("x = sin(x)", ALONE, ["x := sin(x)"]),
    ("a = list[b + 1]", STEPS, ["step := (b + 1)", "a := list[step]"]),
    ("list[b + 1] = a", STEPS, ["step := (b + 1)", "list[step] := a"]),
    ("a = -b * -2", STEPS, ["step := -b", "a := (step * -2)"]),
    ("a = (a + b) * (a - b)\na = (b + a) * 2", STEPS,
     ["step := (a + b)", "step2 := (a - b)", "a := (step * step2)", "step := (b + a)", "a := (step * 2)"]),
    ("a = b + act(1)", STEPS, ["step := act(1)", "a := (b + step)"]),
    ("a = n + act(1)", STEPS, ["step2 := n", "step := act(1)", "a := (step2 + step)"]),
    # conditions
    ("IF p THEN a = 1", STEPS, ["if (p = True)", "  a := 1"]),
    ("IF NOT p THEN a = 1", STEPS, ["if (p = False)", "  a := 1"]),
    ("IF NOT (p AND a < b) THEN a = 1", STEPS, ["if ((p = False) or (a >= b))", "  a := 1"]),
    ("IF p XOR q THEN a = 1", STEPS, ["if (p <> q)", "  a := 1"]),
    ("IF 1 < a THEN a = 1", STEPS, ["if (a > 1)", "  a := 1"]),
    ("IF a + 1 < b THEN a = 1", STEPS, ["step := (a + 1)", "if (step < b)", "  a := 1"]),
    ("p = a < b", STEPS, ["if (a < b)", "  p := True", "else", "  p := False"]),
    ("p = q", STEPS, ["p := q"]),
    ("p = yes(a)", STEPS, ["p := yes(a)"]),
    ("WHILE a + 1 < b\na = a + 1\nEND WHILE", STEPS,
     ["loop", "  step := (a + 1)", "  if (step >= b)", "    exit", "  a := (a + 1)"]),
    # the right side is computed only where it is wanted
    ("IF p AND THEN yes(a) THEN a = 1", STEPS,
     ["step2 := p", "if (step2 = True)", "  step := yes(a)", "  step2 := step", "if (step2 = True)", "  a := 1"]),
    ("SET do[a + 1] TO a < b", ALONE, ["step := (a + 1)", "step2 := (a < b)", "do[step] := step2"]),
]  # fmt: skip


@pytest.mark.parametrize(("source", "target", "wanted"), CASES)
def test_table(source: str, target: object, wanted: list[str]) -> None:
    text = program(source)
    before = read(text)
    after = passed(before, (steps,), context(before, target))  # type: ignore[arg-type]
    found = [line.replace("Signal", "do[step]") for line in lines(after)]
    assert [line for line in found if line] == wanted


def test_a_wait_for_what_stands_still_is_computed_once() -> None:
    before = read(program("a = 2\nWAIT UNTIL di[a + 1]\nSET do[1] TO ON"))
    given = context(before, STEPS)
    after = same(before, (steps,), given, '[[input]]\ntime = 0.5\nsignal = "di3"\nvalue = true', entry="t")
    assert not list(given.diagnostics)
    assert any(isinstance(one, ir.WaitUntil) for one in statements_in(after.modules[0].routines[0].body))


def test_a_wait_for_a_computed_signal_looks_again_and_again() -> None:
    before = read(program("WAIT UNTIL ai[1] * 2.0 > 5.0\nSET do[1] TO ON"))
    given = context(before, STEPS)
    after = passed(before, (steps,), given)
    assert [item.code.name for item in given.diagnostics] == [POLLED.name]
    assert next(show_statement(one)[0] for one in after.modules[0].routines[0].body) == "loop"


# ---- whatever is written


def _numbers() -> st.SearchStrategy[str]:
    leaf = st.one_of(st.integers(0, 4).map(str), st.sampled_from(("a", "b", "n")))
    return st.recursive(
        leaf,
        lambda inner: st.one_of(
            st.tuples(inner, st.sampled_from("+-*"), inner).map(lambda t: f"({t[0]} {t[1]} {t[2]})"),
            inner.map(lambda e: f"act({e})"),
            inner.map(lambda e: f"list[abs({e}) MOD 9 + 1]"),
            inner.map(lambda e: f"(-{e})"),
            st.tuples(inner, inner).map(lambda t: f"to_int(min({t[0]}, {t[1]}))"),
        ),
        max_leaves=5,
    )


def _conditions() -> st.SearchStrategy[str]:
    leaf = st.one_of(
        st.tuples(_numbers(), st.sampled_from(("=", "<>", "<", ">=")), _numbers()).map(" ".join),
        st.sampled_from(("p", "q", "TRUE")),
        _numbers().map(lambda e: f"yes({e})"),
    )
    joining = st.sampled_from(("AND", "OR", "AND THEN", "OR ELSE", "XOR"))
    return st.recursive(
        leaf,
        lambda inner: st.one_of(
            st.tuples(inner, joining, inner).map(lambda t: f"(({t[0]}) {t[1]} ({t[2]}))"),
            inner.map(lambda c: f"NOT ({c})"),
        ),
        max_leaves=4,
    )


def _statements() -> st.SearchStrategy[str]:
    small = st.one_of(
        _numbers().map(lambda e: f"a = {e} MOD 100"),
        _numbers().map(lambda e: f"list[abs({e}) MOD 9 + 1] = {e} MOD 7"),
        st.tuples(st.sampled_from("pq"), _conditions()).map(" = ".join),
        _numbers().map(lambda e: f"MESSAGE value_text({e})"),
        _conditions().map(lambda c: f"SET do[1] TO {c}"),
        _numbers().map(lambda e: f"SET do[abs({e}) MOD 5 + 2] TO p"),
    )

    def deeper(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
        block = st.lists(inner, min_size=1, max_size=2).map("\n".join)
        return st.one_of(
            st.tuples(_conditions(), block, _conditions(), block, block).map(
                lambda t: f"IF {t[0]} THEN\n{t[1]}\nELSEIF {t[2]} THEN\n{t[3]}\nELSE\n{t[4]}\nEND IF"
            ),
            st.tuples(_conditions(), block).map(lambda t: f"WHILE n < 20 AND {t[0]}\nn = n + 1\n{t[1]}\nEND WHILE"),
            st.tuples(_conditions(), block).map(lambda t: f"REPEAT\nn = n + 1\n{t[1]}\nUNTIL n > 20 OR {t[0]}"),
            st.tuples(_numbers(), _numbers(), block).map(
                lambda t: f"FOR b = {t[0]} MOD 4 TO {t[1]} MOD 5\nn = n + 1\nIF n > 30 THEN EXIT\n{t[2]}\nEND FOR"
            ),
            st.tuples(_numbers(), block, block).map(
                lambda t: f"SWITCH {t[0]}\nCASE 1, 2\n{t[1]}\nDEFAULT\n{t[2]}\nEND SWITCH"
            ),
        )

    return st.recursive(small, deeper, max_leaves=4)


def _is_step(value: ir.Expression) -> bool:
    return is_operand(value) or all(map(is_operand, children(value)))


def _is_condition(value: ir.Expression) -> bool:
    match value:
        case ir.Binary(op="and" | "or" | "cand" | "cor", left=left, right=right):
            return _is_condition(left) and _is_condition(right)
        case ir.Binary(op=op, left=left, right=right):
            return op in ("=", "<>", "<", ">", "<=", ">=") and is_operand(left) and is_operand(right)
    return isinstance(value, ir.BoolLiteral)


def _is_simple(statement: ir.Statement) -> bool:
    match statement:
        case ir.Assign(target=ir.Signal(), value=value):
            return is_operand(value)
        case ir.Assign(value=value):
            return _is_step(value)
        case ir.If(branches=branches):
            return all(_is_condition(condition) for condition, _ in branches)
        case ir.While(condition=condition) | ir.Repeat(until=condition):
            return _is_condition(condition)
        case ir.Switch(selector=selector):
            return is_operand(selector)
    return all(map(is_operand, children(statement)))


@settings(max_examples=20, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.lists(_statements(), min_size=1, max_size=4))
def test_any_program_shows_the_same(body: list[str]) -> None:
    start = "a = 1\nb = 2\np = FALSE\nq = TRUE\nFOR b = 1 TO 9\nlist[b] = 10 - b\nEND FOR"
    before = read(program("\n".join((start, *body, "MESSAGE value_text(a) & value_text(b) & value_text(n)"))))
    after = same(before, (steps,), context(before, STEPS), entry="t", max_statements=20_000)
    body_after = next(one for one in after.modules[0].routines if one.name == "t").body
    assert not [show_statement(one) for one in statements_in(body_after) if not _is_simple(one)]
    strict = passed(before, (decide_logic,), context(before, WEAK))
    same(strict, (steps,), context(strict, WEAK), entry="t", max_statements=20_000)
    same(before, (steps,), context(before, ALONE), entry="t", max_statements=20_000)


SPREAD = """
MODULE m
    VAR p: TARGET = {x: 400, y: 0, z: 300, a: 0, b: 90, c: 0}
    VAR q: POSE = {x: 1, y: 2, z: 3, a: 0, b: 90, c: 0}
    PROCEDURE main()
        VAR h: REAL = 20.0
        MOVE TO p
        MOVE LINEAR TO {x: p.x, y: p.y, z: p.z + h, a: p.a, b: p.b, c: p.c}
        q = {x: h, y: h + 1.0, z: 3, a: 0, b: 90, c: 0}
        q = {x: q.y, y: q.x, z: q.z, a: q.a, b: q.b, c: q.c}
        q = {x: q.x + h, y: q.y, z: q.z, a: q.a, b: q.b, c: q.c}
        MESSAGE value_text(q.x) & " " & value_text(q.y)
        MOVE LINEAR TO offset(p, h, 0, h * 2.0)
    END PROCEDURE
END MODULE
"""


def test_computed_positions_are_put_together_in_a_variable() -> None:
    target = replace(ALONE, data=replace(ALONE.data, aggregates=ALONE.data.aggregates | {Aggregate.CONSTANT}))
    before = read(SPREAD)
    after = same(before, (steps,), context(before, target), robot="kuka_kr6r900sixx", entry="main")
    found = lines(after, "main")
    assert found[:4] == ["joint p", "step := p", "step.z := (p.z + h)", "linear step"]
    assert found[4:10] == ["q.x := h", "q.y := (h + 1.0)", "q.z := 3", "q.a := 0", "q.b := 90", "q.c := 0"]
    assert found[10:15] == ["step2 := q", "step2.x := q.y", "step2.y := q.x", "q := step2", "q.x := (q.x + h)"]
    assert found[-1] == "linear step"
