"""RPL: the universal robot programming language, and the text of the IR."""

from __future__ import annotations

from rpl.registry import Dialect

from .recognise import recognise
from .words import POSTURE_FLAGS


def _signal_name(kind: str, number: int) -> str:
    from rpl.ir.words import SIGNAL_WORDS

    word = next((word for word, meant in SIGNAL_WORDS.items() if meant == kind), kind)
    return f"{word}[{number}]"


DIALECT = Dialect(
    __name__,
    title="RPL, the universal robot programming language",
    extensions=(".rpl",),
    recognise=recognise,
    notation_fields=POSTURE_FLAGS,
    signal_name=_signal_name,
    reader="reader",
)
