"""RPL: the universal robot programming language, and the text of the IR."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rpl.registry import Dialect, ReadResult

from .recognise import recognise
from .words import POSTURE_FLAGS

if TYPE_CHECKING:
    from rpl.diagnostics import Diagnostics
    from rpl.emulator.configuration import Notation
    from rpl.ir import Module
    from rpl.ir.rules import Rules
    from rpl.source import Source


def _read(sources: Sequence[Source], diagnostics: Diagnostics) -> ReadResult:
    from .reader import read

    return read(sources, diagnostics)


def _rules() -> Rules:
    from .rules import RULES

    return RULES


def _prelude() -> Module | None:
    from .rules import prelude

    return prelude()


def _notation() -> Notation:
    from .configuration import NOTATION

    return NOTATION


def _signal_name(kind: str, number: int) -> str:
    from rpl.ir.words import SIGNAL_WORDS

    word = next((word for word, meant in SIGNAL_WORDS.items() if meant == kind), kind)
    return f"{word}[{number}]"


DIALECT = Dialect(
    name="rpl",
    title="RPL, the universal robot programming language",
    extensions=(".rpl",),
    recognise=recognise,
    read=_read,
    rules=_rules,
    prelude=_prelude,
    notation=_notation,
    notation_fields=POSTURE_FLAGS,
    signal_name=_signal_name,
)
