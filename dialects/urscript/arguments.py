"""The arguments of a call of one of the controller's functions, by the names of the parameters."""

from __future__ import annotations

from rpl import ir

from .expressions import Expressions
from .kinds import Kind
from .nodes import Expr

Bound = dict[str, Expr | None]


def given(reader: Expressions, bound: Bound, name: str, wanted: Kind | None = None) -> ir.Expression:
    """The value of a parameter that has to be given, or has a default."""
    return reader.value(written(bound, name), wanted)


def written(bound: Bound, name: str) -> Expr:
    """What is written for a parameter that has to be given, or has a default."""
    value = bound[name]
    assert value is not None  # else it could not be bound
    return value
