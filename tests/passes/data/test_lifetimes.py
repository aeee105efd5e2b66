"""Temporaries of one routine that are not needed at the same time take one place."""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.storage.lifetimes import companions

REAL = ir.RealType()


def _set(name: str, *read: str) -> ir.Assign:
    value: ir.Expression = ir.RealLiteral(1.0)
    for one in read:
        value = ir.Binary("+", value, ir.Name(one))
    return ir.Assign(ir.Name(name), value)


def _shared(*body: ir.Statement) -> dict[str, str]:
    routine = ir.Routine("work", body=tuple(body))
    found = companions(routine, [ir.Variable(name, REAL) for name in ("a", "b", "c")])
    return {name: one.name for name, one in found.items()}


def test_one_behind_the_other() -> None:
    done = _shared(_set("a"), _set("x", "a"), _set("b"), _set("x", "b"), _set("c"), _set("x", "c"))
    assert done == {"a": "a", "b": "a", "c": "a"}


def test_needed_together() -> None:
    assert _shared(_set("a"), _set("b"), _set("x", "a", "b"), _set("c"), _set("x", "c")) == {
        "a": "a",
        "b": "b",
        "c": "a",
    }


def test_read_and_set_by_one_statement_are_needed_together() -> None:
    assert _shared(_set("a"), _set("b", "a"), _set("x", "b"))["b"] == "b"


def test_a_label_may_be_jumped_to() -> None:
    body = (_set("a"), ir.Label("again"), _set("x", "a"), _set("b"), ir.Goto("again"), _set("x", "b"))
    done = _shared(*body)
    assert done["a"] == "a" and done["b"] != "a"


def test_inside_of_a_branch_and_around_it() -> None:
    branch = ir.If(((ir.BoolLiteral(True), (_set("b"), _set("x", "b"))),))
    assert _shared(_set("a"), branch, _set("x", "a"), _set("c"), _set("x", "c")) == {"a": "a", "b": "b", "c": "a"}


def test_what_a_trigger_looks_at_later_keeps_its_place() -> None:
    trigger = ir.Trigger("end", _set("x", "a"))
    assert _shared(_set("a"), trigger, _set("b"), _set("x", "b"))["b"] == "b"
