"""How the lines of a listing look: each by its macro, when all decisions about the listing have been made on its plain
text."""

from __future__ import annotations

from rpl.writing.templates import Macros

from .lines import Line

_WORDS = {"CALL ": ("call", "program"), "WAIT ": ("wait", "what")}
_WORD = len("CALL ")


def laid_out(lines: list[Line], say: Macros) -> list[tuple[str, list[str]]]:
    """Each line as the target's or a plant's macro says it: the first, and those that continue it."""
    found = []
    for line in lines:
        first, *further = _said(line, say)
        found.append((first, further))
    return found


def _said(line: Line, say: Macros) -> list[str]:
    if line.words is not None:
        return say.lines("move", **line.words)
    text = line.first
    if not text.startswith("  "):
        return [text, *line.further]
    text = text[2:]
    if text.startswith("!"):
        return [*say.lines("remark", text=text[1:]), *line.further]
    if text.startswith("LBL[") and text.endswith("]"):
        number, _, comment = text[4:-1].partition(":")
        return say.lines("label", number=number, comment=comment)
    if text.startswith("JMP LBL[") and text.endswith("]"):
        return say.lines("jump", number=text[8:-1])
    macro, word = _WORDS.get(text[:_WORD], ("", ""))
    if macro:
        return [*say.lines(macro, **{word: text[_WORD:]}), *line.further]
    return [*say.lines("step", text=text), *line.further]
