"""When two messages say the same: by their text, apart from blanks, and by the registers that one names for the values
that the other shows.

A language whose messages show constant text only says in its rules what names a register there; such a name stands for
what the register holds then, and for any value of its kind where that is not known. Where a screen shows a message in
several lines, the lines together are one message.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from rpl.proof.record import Happening, Named, Value

_BLANKS = r"\s*"
_NUMBER, _TEXT = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", r".*"


def same_message(a: Happening, b: Happening) -> bool:
    """Do two messages say the same?"""
    return _same([a], [b])


def as_lines(ours: Sequence[Happening], theirs: Sequence[Happening]) -> tuple[int, int]:
    """How many messages of each side are one message of the other, which a screen shows in several lines: they come at
    the same time, and nothing but blanks is more or less. (1, 1): none."""
    found = (1, 1)
    for one, several, turned in ((ours, theirs, False), (theirs, ours, True)):
        if not one or one[0].kind != "message":
            continue
        for count in range(1, _together(several) + 1):
            if not _same(one[:1], several[:count]):
                continue
            found = (count, 1) if turned else (1, count)
            if _goes_on(one[1:], several[count:]):
                return found
    return found


def _together(several: Sequence[Happening]) -> int:
    """How many messages come at the same time."""
    for count, line in enumerate(several):
        if line.kind != "message" or line.t != several[0].t:
            return count
    return len(several)


def _goes_on(ours: Sequence[Happening], theirs: Sequence[Happening]) -> bool:
    """May what follows be the same? A name of a value leaves open where a message ends."""
    messages = (_together(ours[:1]), _together(theirs[:1]))
    if messages != (1, 1):
        return messages == (0, 0)
    return any(_same(ours[:1], theirs[:count]) for count in range(1, _together(theirs) + 1))


@dataclass(frozen=True, slots=True)
class _Said:
    """A text as it was shown and without blanks, and the expression that says what else would say the same; `held`: the
    values of its groups, which stand for what the named registers hold."""

    shown: str
    text: str
    pattern: str
    held: tuple[Value, ...]

    @classmethod
    def of(cls, lines: Sequence[Happening]) -> _Said:
        named = next((one.named for one in lines), Named())
        known = {name: value for one in lines for name, value in one.held}
        texts, patterns, held = [str(one.value) for one in lines], [], []
        for text in texts:
            pattern, values = _pattern(text, named, known)
            patterns.append(pattern)
            held += values
        pattern = _BLANKS.join(patterns)
        return cls(" ".join(texts), "".join(map(_bare, texts)), rf"\s*{pattern}\s*", tuple(held))

    def stands_for(self, shown: str) -> bool:
        """Does a text show what this one names?"""
        found = re.fullmatch(self.pattern, shown, re.DOTALL)
        return found is not None and all(map(_shows, found.groups(), self.held))


def _shows(text: str, value: Value) -> bool:
    """Is a text the value? A number may be shown with as many decimals as a language likes."""
    if isinstance(value, str):
        return _bare(text) == _bare(value)
    assert isinstance(value, int | float)  # what _pattern makes groups for
    number = text.lower().partition("e")
    decimals = len(number[0].partition(".")[2])
    slack = 0.5 * 10.0 ** (int(number[2] or 0) - decimals) + 1e-6 * abs(value)
    return abs(float(text) - value) <= slack


def _same(ours: Sequence[Happening], theirs: Sequence[Happening]) -> bool:
    a, b = _Said.of(ours), _Said.of(theirs)
    if a.text == b.text:
        return True
    if ours[0].named == theirs[0].named:
        return False
    return a.stands_for(b.shown) or b.stands_for(a.shown)


def _pattern(text: str, named: Named, known: Mapping[str, Value]) -> tuple[str, list[Value]]:
    """The text with what it names left open, as groups where it is known what the names hold, and these values; blanks
    may stand anywhere but inside of a number."""
    if not named.numbers and not named.texts:
        return _constant(text), []
    names = re.compile(rf"\b(?:(?P<number>{named.numbers or '(?!)'})|(?P<text>{named.texts or '(?!)'}))\b")
    done: list[str] = []
    held: list[Value] = []
    at = 0
    for found in names.finditer(text):
        kind, value = _NUMBER if found["number"] else _TEXT, known.get(found[0])
        wanted = int | float if found["number"] else str
        shown = isinstance(value, wanted) and not isinstance(value, bool)
        held += [value] if shown else []
        done += [_constant(text[at : found.start()]), f"({kind})" if shown else kind]
        at = found.end()
    return _BLANKS.join((*done, _constant(text[at:]))), held


def _constant(text: str) -> str:
    return _BLANKS.join(map(re.escape, _bare(text)))


def _bare(text: str) -> str:
    return "".join(text.split())
