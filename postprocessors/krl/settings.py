"""Assignments, and settings that KRL writes as one: a whole structure ($VEL, $ACC, $APO), the axes of a spline move."""

from __future__ import annotations

from collections.abc import Sequence

from rpl import ir
from rpl.writing.statements import CannotSayError
from rpl.writing.text import number_text

from . import tables
from .expressions import Expressions

Pair = tuple[ir.Expression, ir.Expression]
_AXES = 6
FULL = 100.0  # percent


def whole_structure(pairs: Sequence[Pair]) -> tuple[str, ir.Expression] | None:
    """The structure and its value when the first pairs set all its components from the components of one value."""
    for name, parts in tables.STRUCTURES.items():
        values = [
            _component(pair, component, neutral) for pair, (component, neutral) in zip(pairs, parts, strict=False)
        ]
        first = values[0] if len(values) == len(parts) else None
        if first is not None and all(value == first for value in values):
            return name, first
    return None


def _component(pair: Pair, component: str, neutral: str) -> ir.Expression | None:
    target, value = pair
    if isinstance(value, ir.Quantity):
        value = value.value
    if not (isinstance(target, ir.System) and target.name == neutral and isinstance(value, ir.Field)):
        return None
    return value.base if value.name.upper() == component and isinstance(value.base, ir.Call) else None


def coupled_base(pairs: Sequence[Pair]) -> tuple[str, ir.Expression, ir.Expression, ir.Expression | None] | None:
    """The number of external kinematics, the frame on it and its root, when the first pairs put the base on one."""
    names = [target.name for target, _ in pairs[:3] if isinstance(target, ir.System)]
    if names[:2] != ["base", "base_unit"]:
        return None
    frame, unit = pairs[0][1], pairs[1][1]
    word = unit.value.upper() if isinstance(unit, ir.TextLiteral) else ""
    if word and word not in tables.EXTERNAL_KINEMATICS:
        raise CannotSayError(f"external kinematics are {', '.join(tables.EXTERNAL_KINEMATICS)}; '{word}' is none")
    root = pairs[2][1] if len(names) > 2 and names[2] == "base_root" else None
    return word, frame, unit, root


def coupled(pairs: Sequence[Pair], expressions: Expressions) -> tuple[dict[str, str], int] | None:
    """The words of `$BASE=EK(...)` for such pairs, and how many they are. The root that nobody says is the machine's
    own."""
    found = coupled_base(pairs)
    if found is None:
        return None
    word, frame, unit, root = found
    number = tables.EXTERNAL_KINEMATICS.index(word) + 1 if word else 0
    if root is None and not number:
        if not isinstance(unit, ir.Field):
            raise CannotSayError("external kinematics that are chosen at run time")
        place = expressions.text(unit.base) + ".ROOT"
    else:
        place = setting("base_root", root, expressions) if root is not None else f"EX_AX_DATA[{number}].ROOT"
    kind = f"#{word}" if word else expressions.text(unit)
    words = {"place": place, "kind": kind, "frame": setting("base", frame, expressions)}
    return words, 2 if root is None else 3


def all_axes(pairs: Sequence[Pair]) -> bool:
    """Do the first pairs set one axis variable to one value for every axis, in order?"""
    if len(pairs) < _AXES:
        return False
    target, value = pairs[0]
    if not isinstance(target, ir.System) or target.name not in ("joint_speed", "joint_acceleration"):
        return False
    wanted = [(ir.System(target.name, (ir.IntLiteral(n),)), value) for n in range(1, _AXES + 1)]
    return list(pairs[:_AXES]) == wanted


def speed_of_axes(pairs: Sequence[Pair]) -> bool:
    """Are these the speeds of all axes, as the basis package sets them? It multiplies by its default (DEF_VEL_PTP),
    which is 100 as shipped; that of the accelerations (DEF_ACC_PTP) is not, so these stay as they are."""
    if not all_axes(pairs):
        return False
    target, value = pairs[0]
    named = isinstance(target, ir.System) and target.name == "joint_speed"
    if isinstance(value, ir.IntLiteral | ir.RealLiteral):
        return named and 0.0 < value.value <= FULL and value.value * FULL / FULL == value.value
    return named


def percent_text(value: ir.Expression, expressions: Expressions) -> str:
    """The percentage of all axes: one that is worked out to two places, as people read it."""
    if isinstance(value, ir.RealLiteral) and not value.spelling:
        return number_text(value.value, 2)
    return expressions.text(value)


def grouped(pairs: Sequence[Pair]) -> list[tuple[str, ir.Expression] | Pair]:
    """Settings of a spline move, with structures and axes that belong together as one (their name and value)."""
    done: list[tuple[str, ir.Expression] | Pair] = []
    at = 0
    while at < len(pairs):
        rest = pairs[at:]
        whole = whole_structure(rest)
        if whole is not None:
            done.append(whole)
            at += len(tables.STRUCTURES[whole[0]])
        else:
            done.append(pairs[at])
            at += _AXES if all_axes(rest) else 1
    return done


def assignment(statement: ir.Assign, expressions: Expressions) -> str:
    """An assignment inside of another statement."""
    words = assigned(statement, expressions)
    return f"{words['target']}={words['value']}"


def assigned(statement: ir.Assign, expressions: Expressions) -> dict[str, str]:
    """The words of an assignment; modal variables take their value in KRL's unit, modes their own member."""
    target, value = statement.target, statement.value
    match target:
        case ir.System(name=name):
            place, shown = expressions.system(target, _own_unit(name)), setting(name, value, expressions)
        case ir.Signal():
            place, shown = expressions.signal(target), expressions.text(value)
        case ir.Name() | ir.Index() | ir.Field():
            known = expressions.type(target) is not None
            place = expressions.place(target)
            shown = expressions.stored(value) if known else expressions.text(value)
        case _:
            raise CannotSayError("this cannot be assigned to")
    return {"target": place, "value": shown}


def _own_unit(name: str) -> str:
    return tables.SYSTEM.get(name, ("", ""))[1]


def setting(name: str, value: ir.Expression, expressions: Expressions) -> str:
    """The value of a modal variable as KRL writes it."""
    if isinstance(value, ir.EnumLiteral) and name in tables.MODES:
        return f"#{tables.MODES[name].get(value.member, value.member)}"
    if isinstance(value, ir.Aggregate):
        return expressions.stored(value)
    return expressions.measured(value, _own_unit(name))
