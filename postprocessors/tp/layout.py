"""How the lines of a listing look: each by its macro, when all decisions about the listing have been made on its plain
text."""

from __future__ import annotations

from collections.abc import Mapping

from rpl.writing.templates import Macros

from .lines import Line

_WORDS = {"CALL ": ("call", "program"), "WAIT ": ("wait", "what")}
_WORD = len("CALL ")
_MARK = "\ue000"  # stands for the place of a move; no text has it


def laid_out(lines: list[Line], say: Macros) -> list[tuple[str, list[str]]]:
    """Each line as the target's or a plant's macro says it: the first, and those that continue it."""
    found = []
    forms: dict[tuple[str, ...], list[str]] = {}  # of moves, by their other words, with a mark for their place
    for line in lines:
        if line.words is not None and not line.further:
            first, *further = _move(line.words, say, forms)
        else:
            first, *further = _said(line, say)
        found.append((first, further))
    return found


def _move(words: Mapping[str, str], say: Macros, forms: dict[tuple[str, ...], list[str]]) -> list[str]:
    """The lines of a move; its macro is asked once for moves that are alike but for their place."""
    target = words["target"]
    alike = words["letter"], words["speed"], words["term"], words["options"]
    form = forms.get(alike)
    if form is None:
        said = say.lines("move", **words)
        form = say.lines("move", **{**words, "target": _MARK})
        form = forms[alike] = form if _filled(form, target) == said else []
    return _filled(form, target) if form else say.lines("move", **words)


def _filled(form: list[str], target: str) -> list[str]:
    return [one.replace(_MARK, target) for one in form]


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
