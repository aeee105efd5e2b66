"""Declarations of V+: AUTO and LOCAL variables of a program, and values of global ones in data sections."""

from __future__ import annotations

from rpl import ir
from rpl.passes import rigid
from rpl.passes.fold import constant
from rpl.passes.scope import Scope
from rpl.passes.values import Record, Target, component
from rpl.writing.statements import CannotSayError

from . import spelling, tables
from .actions import listed
from .expressions import Expressions

_SECTIONS = {"": ".REALS", "$": ".STRINGS", "#": ".LOCATIONS"}


def declared(variable: ir.Variable, expressions: Expressions) -> str:
    """A name as AUTO and LOCAL take it, with the last indices of an array."""
    name = spelling.spelled(variable.name, variable.type)
    type = variable.type
    if not isinstance(type, ir.ArrayType):
        return name
    bounds = [expressions.text(bound) if bound is not None else "" for bound in type.dimensions]
    return f"{name}[{', '.join(bounds)}]"


def stored(place: ir.Expression, type: ir.Type, value: ir.Expression, scope: Scope) -> tuple[str, str]:
    """Section and line of one value; raises CannotSayError when it is not constant."""
    name = _name(place, type)
    if isinstance(type, ir.JointsType):
        numbers = _joints(value, scope)
        return ".LOCATIONS", f"{name} {' '.join(numbers)}"
    known = constant(value, scope)
    if isinstance(known, Target):
        known = known.pose
    if isinstance(known, rigid.Pose):
        return ".LOCATIONS", f"{name} {' '.join(spelling.components(known))}"
    if isinstance(known, str):
        plain, lost = spelling.pieces(known)
        if lost or len(plain) > 1:
            raise CannotSayError("a text with signs that a data section cannot hold")
        return ".STRINGS", f"{name} {plain[0]}"
    if isinstance(known, bool):
        return ".REALS", f"{name} {-1 if known else 0}"
    if isinstance(known, int | float):
        return ".REALS", f"{name} {spelling.number(known)}"
    raise CannotSayError("a data section takes constants only")


def _name(place: ir.Expression, type: ir.Type) -> str:
    match place:
        case ir.Name(id=name):
            return spelling.spelled(name, type)
        case ir.Index(base=ir.Name(id=name), indices=indices):
            numbers = [str(one.value) for one in indices if isinstance(one, ir.IntLiteral)]
            return f"{spelling.spelled(name, type)}[{','.join(numbers)}]"
    raise CannotSayError("only variables and their elements have values of their own")


def _joints(value: ir.Expression, scope: Scope) -> list[str]:
    known = constant(value, scope)
    if not isinstance(known, Record):
        raise CannotSayError("a data section takes constants only")
    axes = known.part("robax")
    source = axes if isinstance(axes, Record) else known
    found = []
    for axis in tables.AXES:
        number = component(source, axis)
        found.append(spelling.number(rigid.clean(float(number)), 9) if isinstance(number, int | float) else "0")
    return found


def values(variable: ir.Variable) -> list[tuple[ir.Expression, ir.Type, ir.Expression]]:
    """Each place that a variable's first value fills."""
    name, type, value = ir.Name(variable.name), variable.type, variable.initial
    if value is None:
        return []
    if isinstance(type, ir.ArrayType):
        if not isinstance(value, ir.Aggregate):
            raise CannotSayError("an array that is filled by a calculation")
        return [(place, type.element, one) for place, one in listed(name, value, type)]
    return [(name, type, value)]
