"""How the lines of a job look: each by its macro, when all decisions about the job have been made on its plain text."""

from __future__ import annotations

from collections.abc import Sequence

from rpl.writing.templates import Macros

_MOVES = frozenset(("MOVJ", "MOVL", "MOVC", "MOVS", "IMOV"))
_WORDS = {"JUMP": ("jump", "label"), "CALL": ("call", "job"), "TIMER": ("timer", "time"), "WAIT": ("wait", "condition")}


def laid_out(lines: Sequence[str], say: Macros) -> list[str]:
    """Each line as the target's or a plant's macro says it."""
    return [said for line in lines for said in _said(line, say)]


def _said(line: str, say: Macros) -> list[str]:
    if line.startswith("'"):
        return say.lines("remark", text=line[1:])
    if line.startswith("*"):
        return say.lines("label", name=line[1:])
    word, _, rest = line.partition(" ")
    if word in _MOVES:
        return say.lines("move", word=word, tags=rest.split(" "))
    macro, name = _WORDS.get(word, ("", ""))
    if macro and rest:
        return say.lines(macro, **{name: rest})
    return say.lines("step", text=line)
