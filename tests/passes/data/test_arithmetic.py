"""Functions of numbers that a target lacks give what the controller's own give."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import given, settings
from hypothesis import strategies as st

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.capabilities import Limit
from rpl.passes.legalise.records.arithmetic import arithmetic

from .executed import EVERYTHING, context, passed, read, run

HAVE = frozenset(("sin", "cos", "atan", "sqrt", "number_text"))
LEAST = replace(
    EVERYTHING,
    functions=HAVE,
    conversions=frozenset(("real", "trunc")),
    operators=EVERYTHING.operators - {"xor"},
    control=replace(EVERYTHING.control, limits=EVERYTHING.control.limits | {Limit.FUNCTIONS_ALONE}),
)
REALS = ("abs({v})", "min({v}, {w})", "max({v}, {w})", "sign({v})", "floor({v})", "ceil({v})", "round({v})",
         "atan2({v}, {w})", "tan({v})", "asin({u})", "acos({u})", "to_nearest({v})", "atan({v})")  # fmt: skip
WHOLES = ("abs({n})", "min({n}, 3)", "max({n}, 3)", "to_bit({n} > 2)", "to_bit(({n} > 2) XOR ({n} < 5))")


def program(v: float, w: float, u: float, n: int) -> str:
    reals = {name: f"({round(value, 6) + 0.0:.6f})" for name, value in (("v", v), ("w", w), ("u", u))}  # no -0.0
    values = {**reals, "n": f"({n})"}
    lines = [f"MESSAGE number_text({one.format(**values)}, 4)" for one in (*REALS, *WHOLES)]
    return "\n".join(("MODULE m", "PROCEDURE main()", *lines, "END PROCEDURE", "END MODULE", ""))


_VALUES = st.one_of(st.sampled_from((0.0, 1.0, -1.0, 0.5, -0.5, 2.5, -2.5, 3.0)), st.floats(-80.0, 80.0))


@settings(max_examples=40, deadline=None)
@given(_VALUES, _VALUES, st.floats(-1.0, 1.0), st.integers(-9, 9))
def test_any_numbers(v: float, w: float, u: float, n: int) -> None:
    before = read(program(v, w, u, n))
    after = passed(before, (arithmetic,), context(before, LEAST))
    used = {node.function for node in walk(after) if isinstance(node, ir.Builtin)}
    assert used <= HAVE
    one, other = run(before, entry="main"), run(after, entry="main")
    assert one.status == other.status == "finished"
    for a, b in zip(one.messages, other.messages, strict=True):
        assert abs(float(a) - float(b)) < 2e-4
