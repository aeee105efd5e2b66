"""What a dialect's splitter gives and what its lowering gives back: the vocabulary of statement-wise reading."""

from __future__ import annotations

from dataclasses import dataclass

from rpl.ir import Declaration, Routine, Statement
from rpl.source import Origin

STATEMENT, COMMENT, LAYOUT, AROUND, BLANK = "statement", "comment", "layout", "around", "blank"


@dataclass(frozen=True, slots=True)
class Piece:
    """One logical piece of a source: offsets of its span, the text to parse (joined where the language goes on over
    lines), and the comment that stands behind it on its line (text without the sign; its span is part of the piece).

    kind: STATEMENT, COMMENT (text is the remark), LAYOUT (header, fold, attribute lines: text is kept), AROUND
    (what stands around the program and is no remark of it, such as an XML header), BLANK.
    """

    kind: str
    start: int
    end: int
    text: str
    comment: str | None = None


@dataclass(frozen=True, slots=True)
class Open:
    """A statement that opens a block of this kind; `data` is the dialect's own."""

    kind: str
    data: object
    origin: Origin


@dataclass(frozen=True, slots=True)
class Middle:
    """A statement that starts the next section of the innermost block of this kind (ELSE, CASE, ERROR)."""

    kind: str
    data: object
    origin: Origin


@dataclass(frozen=True, slots=True)
class Close:
    """A statement that ends the innermost block of this kind."""

    kind: str
    data: object
    origin: Origin


@dataclass(frozen=True, slots=True)
class Section:
    """What stands between two structural statements of a block; `head` is None for the first section."""

    head: Middle | None
    items: tuple[Item, ...]


@dataclass(frozen=True, slots=True)
class Block:
    """A closed block, to be built into an IR node by the dialect. `close` None: its end was missing (reported)."""

    open: Open
    sections: tuple[Section, ...]
    close: Close | None


@dataclass(frozen=True, slots=True)
class Attribute:
    """A header or attribute line that belongs to the module (KRL `&ACCESS RVP`, RAPID load header)."""

    name: str
    value: str
    origin: Origin


@dataclass(frozen=True, slots=True)
class ModulePart:
    """A built module (or data list) waiting for the dialect's project assembly; `data` is the dialect's own."""

    name: str
    declarations: tuple[Declaration, ...]
    routines: tuple[Routine, ...]
    data: object
    origin: Origin


# What ends up in a section: statements, declarations, routines, or dialect parts.
Item = Statement | Declaration | Routine | Attribute | ModulePart
# What lowering one statement gives. A tuple when one statement stands for several (`INT A,B`).
Element = Item | Open | Middle | Close
