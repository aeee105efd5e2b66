"""Reading a statement for a trial."""

from __future__ import annotations

from collections.abc import Callable

from rpl.diagnostics import Diagnostics
from rpl.reading.shapes import ShapeParser, StatementError, SyntaxTree
from rpl.source import Origin


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
