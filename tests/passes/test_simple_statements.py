"""Which statements hold others is said once by hand, for speed; the IR's own types say the same."""

from __future__ import annotations

import dataclasses
import importlib
import pkgutil
from typing import Any, get_args, get_type_hints

import rpl.source
from rpl import ir
from rpl.passes import rewrite

_STATEMENTS = frozenset(get_args(ir.Statement))
_EXPRESSIONS = frozenset(get_args(ir.Expression))


def _names() -> dict[str, object]:
    """What the annotations of the IR's modules may name."""
    modules = [importlib.import_module(f"{ir.__name__}.{one.name}") for one in pkgutil.iter_modules(ir.__path__)]
    return {name: value for module in (rpl.source, *modules) for name, value in vars(module).items()}


def _holds_statements(kind: type, names: dict[str, object], seen: set[type]) -> bool:
    def within(annotation: Any) -> bool:
        if annotation in _STATEMENTS:
            return True
        if isinstance(annotation, type) and dataclasses.is_dataclass(annotation):
            if annotation in _EXPRESSIONS or annotation in seen:
                return False
            seen.add(annotation)
            return _holds_statements(annotation, names, seen)
        return any(map(within, get_args(annotation)))

    return any(within(type) for name, type in get_type_hints(kind, names).items() if name != "origin")


def test_the_simple_statements_are_those_whose_types_hold_no_statement() -> None:
    names = _names()
    assert {kind for kind in _STATEMENTS if not _holds_statements(kind, names, set())} == rewrite._SIMPLE


def test_bodies_are_shown_and_replaced_in_the_same_order() -> None:
    inner = ir.Assign(ir.Name("a"), ir.IntLiteral(1))
    other = ir.Assign(ir.Name("b"), ir.IntLiteral(2))
    choice = ir.If(((ir.BoolLiteral(True), (inner,)),), (other,))
    shown: list[ir.Body] = []
    rewrite.visit_bodies(choice, shown.append)
    assert shown == [(inner,), (other,)]
    assert rewrite.rewrite_bodies(choice, lambda body: body) is choice
    emptied = rewrite.rewrite_bodies(choice, lambda body: body if body == (inner,) else ())
    assert emptied == ir.If(((ir.BoolLiteral(True), (inner,)),), ())


def test_an_action_is_a_body_of_one_step() -> None:
    action = ir.Assign(ir.Name("a"), ir.IntLiteral(1))
    trigger = ir.Trigger("end", action)
    shown: list[ir.Body] = []
    rewrite.visit_bodies(trigger, shown.append)
    assert shown == [(action,)]
