"""What a plant's own templates wrote means what the target's own would have written: both are read back and compared.

A template decides layout, order and comments. One that loses a word (the tool of a move) or adds an instruction would
write another program, and nobody would see it: it is an error at the line that was written.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, is_dataclass

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.project import ReadProgram, read_sources
from rpl.source import NOWHERE, Origin, source_from_bytes
from rpl.writing.target import OutputFile

__all__ = ["compare_house_style"]

CHANGES_PROGRAM = code(
    "template-changes-program",
    Severity.ERROR,
    "a template of the plant's own writes another program here: {text}",
    "a template decides layout, order and comments: each word that it gets has to stand in its text, and nothing more",
)
NOT_READ = code(
    "template-not-read",
    Severity.ERROR,
    "what a template of the plant's own wrote cannot be read back: {reason}",
    "a template writes the target's language",
)
_LAYOUT = frozenset(("attributes", "comment"))  # of a file's head: not what it does


def compare_house_style(
    own: Sequence[OutputFile], shipped: Sequence[OutputFile], language: str, diagnostics: Diagnostics
) -> None:
    """Report where the files that a plant's templates gave mean something else than those of the target's templates."""
    found, wanted = Diagnostics(), Diagnostics()
    ours, theirs = _read(own, language, found), _read(shipped, language, wanted)
    if found.has_errors and not wanted.has_errors:
        first = found.of(Severity.ERROR)[0]
        diagnostics.report(NOT_READ, first.origin, reason=first.message)
        return
    left, right = ours.program.modules, theirs.program.modules
    if len(left) != len(right):
        diagnostics.report(CHANGES_PROGRAM, NOWHERE, text=f"{len(left)} files instead of {len(right)}")
        return
    for one, other in zip(left, right, strict=True):
        place = _difference(one, other, one.origin)
        if place is not None:
            text = " ".join(place.text.split())[:60] or one.name
            diagnostics.report(CHANGES_PROGRAM, place, text=text)


def _read(files: Sequence[OutputFile], language: str, diagnostics: Diagnostics) -> ReadProgram:
    return read_sources([source_from_bytes(file.path, file.data) for file in files], language, diagnostics)


def _difference(own: object, shipped: object, at: Origin) -> Origin | None:
    """The place of the innermost part of the plant's text that differs; None where nothing does. Remarks are none."""
    if isinstance(own, tuple) and isinstance(shipped, tuple):
        mine, others = _said(own), _said(shipped)
        for one, other in zip(mine, others, strict=False):
            place = _difference(one, other, at)
            if place is not None:
                return place
        if len(mine) == len(others):
            return None
        return _origin(mine[len(others)], at) if len(mine) > len(others) else at
    if is_dataclass(own) and not isinstance(own, type) and own.__class__ is shipped.__class__:
        here = _origin(own, at)
        for part in fields(own):
            if part.compare and part.name not in _LAYOUT:
                place = _difference(getattr(own, part.name), getattr(shipped, part.name), here)
                if place is not None:
                    return place
        return None
    return None if own == shipped else _origin(own, at)


def _said(parts: tuple[object, ...]) -> tuple[object, ...]:
    """Without the statements that only carry remarks, and declarations that are none."""
    return tuple(part for part in parts if not isinstance(part, ir.Nothing | ir.ExternalDeclaration))


def _origin(part: object, at: Origin) -> Origin:
    found = getattr(part, "origin", None)
    return found if isinstance(found, Origin) and found.source else at
