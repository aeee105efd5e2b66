"""Questions to the operator: what they show, the keys that answer them, and the number the controller gives for a key.

Source: reference manual, UIMsgBox and UIMessageBox.
"""

from __future__ import annotations

import re
from dataclasses import replace

from rpl import ir
from rpl.source import NOWHERE, Origin

from .words import WORDS

# buttondata -> keys in their order, and what the controller gives for each (constants resOK ...).
_NUMBERS = WORDS.numbers("numbers")
BUTTONS = {
    name.lower(): tuple((key, int(_NUMBERS[f"res{key}"])) for key in keys.split())
    for name, keys in WORDS.pairs("buttons").items()
}
Options = dict[str, "ir.Expression | None"]
# The functions among the questions; what begins so is looked at more closely (`askingfunctions`).
_FUNCTIONS = re.compile(r"\bUI(?:MessageBox|D?NumEntry|AlphaEntry)\b", re.IGNORECASE)


def may_ask(text: str) -> bool:
    """Does the text of a module name a function that asks the operator?"""
    return _FUNCTIONS.search(text) is not None


def shown(options: Options) -> ir.Expression | None:
    """The text of the question: \\Message, or the lines of a \\MsgArray that is written out."""
    match options.get("msgarray"):
        case None:
            return options.get("message") or ir.TextLiteral("")
        case ir.Aggregate(entries=((_, text), *more)):
            for _, line in more:
                text = ir.Binary("+", ir.Binary("+", text, ir.TextLiteral(" ")), line)
            return text
    return None


def keys_asked(
    answer: ir.Expression, text: ir.Expression, header: ir.Expression | None, limit: ir.Expression | None,
    options: Options, origin: Origin = NOWHERE,
) -> ir.Body | None:  # fmt: skip
    """A choice of keys; the answer becomes the controller's number of the key."""
    own = options.get("btnarray")
    if own is not None:
        if not isinstance(own, ir.Aggregate):
            return None
        return (
            ir.Dialog(answer, text, tuple(key for _, key in own.entries), timeout=limit, sender=header, origin=origin),
        )
    given = options.get("buttons") or ir.Name("btnOK")
    keys = BUTTONS.get(given.id.lower()) if isinstance(given, ir.Name) else None
    if keys is None:
        return None
    names = tuple(ir.TextLiteral(word) for word, _ in keys)
    question = ir.Dialog(answer, text, names, timeout=limit, sender=header, origin=origin)
    numbers = [number for _, number in keys]
    if numbers == [1]:
        return (question,)
    becomes: list[ir.Body] = [(ir.Assign(answer, ir.IntLiteral(number)),) for number in numbers]
    is_key = [ir.Binary("=", answer, ir.IntLiteral(place)) for place in range(1, len(keys))]
    return (
        question,
        ir.If(tuple(zip(is_key, becomes, strict=False)), becomes[-1], origin=replace(origin, comments=())),
    )
