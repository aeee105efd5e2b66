"""Reading a statement for a trial, and comparing what two readings give to the spelling and the place."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, is_dataclass

from rpl.diagnostics import Diagnostics
from rpl.reading.shapes import ShapeParser, StatementError, SyntaxTree
from rpl.source import Origin, Source


def quietly(
    parser: ShapeParser,
    lower: Callable[[SyntaxTree, tuple[str, ...], Origin], object],
    diagnostics: Diagnostics,
    text: str,
    origin: Origin,
) -> object:
    """What is read of a statement. None where something is reported: then each line has to be."""
    before = len(diagnostics)
    try:
        done = lower(*parser.parse(text), origin)
    except StatementError:
        return None
    if len(diagnostics) == before:
        return done
    del diagnostics.items[before:]
    return None


def identical(one: object, other: object) -> bool:
    """Equal to the spelling and the place, which comparing nodes leaves out."""
    if one.__class__ is not other.__class__:
        return False
    if isinstance(one, tuple) and isinstance(other, tuple):
        return len(one) == len(other) and all(map(identical, one, other))
    if is_dataclass(one) and not isinstance(one, Source):
        return all(identical(getattr(one, each.name), getattr(other, each.name)) for each in fields(one))
    return one is other or one == other
