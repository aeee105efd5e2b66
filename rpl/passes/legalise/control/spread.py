"""Positions with computed components, as assignments of the components, for targets that write positions in constants.

A position that keeps most components of another one starts as a copy of it.
"""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.facts.effects import everything, is_constant
from rpl.passes.legalise.facts.usage import base_name

Entry = tuple[tuple[str, ...], ir.Expression]
_COMPOUND = ("trans", "rot", "robax", "ext")


def is_computed(value: ir.Expression) -> bool:
    """Is it a structure with a component that is no constant?"""
    return isinstance(value, ir.Aggregate) and not all(map(_is_fixed, (one for _, one in value.entries)))


def _is_fixed(value: ir.Expression) -> bool:
    return is_constant(value) or (isinstance(value, ir.Aggregate) and not is_computed(value))


def spread(place: ir.Expression, value: ir.Aggregate) -> list[ir.Assign] | None:
    """place := value, component by component; None when a component has no name. The place must not be read in it."""
    entries = _entries(value, ())
    if entries is None:
        return None
    model = _model(entries)
    done = [] if model is None or model == place else [ir.Assign(place, model)]
    for path, one in entries:
        if model is None or one != _at(model, path):
            done.append(ir.Assign(_at(place, path), one))
    return done


def reads(value: ir.Aggregate, place: ir.Expression) -> bool:
    """Does the value read of the variable of the place more than each component its own?"""
    name = base_name(place)
    for path, one in _entries(value, ()) or [((), value)]:
        parts = list(everything(one))
        read = sum(isinstance(part, ir.Name) and part.id.lower() == name for part in parts)
        if read != sum(part == _at(place, path) for part in parts):
            return True
    return False


def _entries(value: ir.Aggregate, path: tuple[str, ...]) -> list[Entry] | None:
    found: list[Entry] = []
    for name, one in value.entries:
        if name is None:
            return None
        here = path if name in _COMPOUND and isinstance(one, ir.Aggregate) else (*path, name)
        inner = _entries(one, here) if isinstance(one, ir.Aggregate) else [(here, one)]
        if inner is None:
            return None
        found.extend(inner)
    return found


def _at(place: ir.Expression, path: tuple[str, ...]) -> ir.Expression:
    for name in path:
        place = ir.Field(place, name)
    return place


def _model(entries: list[Entry]) -> ir.Expression | None:
    """The place that gives most components their values under the same names."""
    counts: dict[ir.Expression, int] = {}
    for path, one in entries:
        if isinstance(one, ir.Field) and path == (one.name,) and not isinstance(one.base, ir.Builtin | ir.Call):
            counts[one.base] = counts.get(one.base, 0) + 1
    best = max(counts, key=lambda base: counts[base], default=None)
    return best if best is not None and 2 * counts[best] >= len(entries) else None
