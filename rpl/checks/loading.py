"""Does a program load? The engine for the rules that each language's controller has for its files.

The rules are data in `dialects/<name>/loading.py`, each with its source: what a file must be like, what the controller
says, what to do. They look at the text, not at the tree: our readers accept more than controllers do. A rule only
warns; nothing that can be read is lost by it. `docs/loading.md` is made from them.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path

from rpl.diagnostics import Code, Diagnostics, Severity, code
from rpl.source import Origin, Source

# The longest piece of a program that a warning shows (characters).
_SHOWN = 60


class Trust(StrEnum):
    """How a rule is known."""

    MEASURED = "measured on a controller"
    MANUAL = "the maker's manual"
    COUNTED = "counted: no public program has it"
    M = "M: unverified"


@dataclass(frozen=True, slots=True)
class Listing:
    """One file. `code`: its text with remarks away and the insides of texts blanked, position for position."""

    source: Source
    code: str


@dataclass(frozen=True, slots=True)
class Place:
    """Where a rule is broken: a span of the listing's text."""

    listing: Listing
    start: int
    end: int


Find = Callable[[Sequence[Listing]], Iterable[Place]]


@dataclass(frozen=True, slots=True)
class Rule:
    """What a controller asks of a program's files.

    `says`: what must be so; `answer`: what the controller does otherwise; `advice`: what to write; `source`: where the
    rule is from. `option`: it is no fault but something that the controller must have been given.
    """

    name: str
    says: str
    answer: str
    advice: str
    source: str
    trust: Trust
    finds: Find = field(repr=False)
    option: bool = False

    def code(self) -> Code:
        severity = Severity.INFO if self.option else Severity.WARNING
        return code(f"load-{self.name}", severity, "{text!r}: {says}; otherwise: {answer}", "{advice}")


@dataclass(frozen=True, slots=True)
class Loader:
    """The rules of one language. `blanks` matches remarks, and texts as the group `text`; `holds` says whether a file
    is one that the rules are about."""

    rules: tuple[Rule, ...]
    blanks: re.Pattern[str]
    holds: Callable[[Source], bool] = lambda source: True

    def broken(self, sources: Sequence[Source]) -> Iterator[tuple[Rule, Place]]:
        """The rules that the files break, rule by rule."""
        listings = [Listing(source, blanked(source.text, self.blanks)) for source in sources if self.holds(source)]
        for rule in self.rules:
            for place in rule.finds(listings):
                yield rule, place

    def check(self, sources: Sequence[Source], diagnostics: Diagnostics) -> None:
        """Report what the controller refuses."""
        for rule, place in self.broken(sources):
            origin = Origin(place.listing.source, place.start, place.end)
            text = " ".join(origin.text.split())
            shown = text if len(text) <= _SHOWN else f"{text[:_SHOWN]}..."
            diagnostics.report(rule.code(), origin, text=shown, says=rule.says, answer=rule.answer, advice=rule.advice)


def blanked(text: str, blanks: re.Pattern[str]) -> str:
    """The text with matches as blanks, line ends kept; of a match of the group `text` the first and last sign stay."""

    def away(found: re.Match[str]) -> str:
        whole = found[0]
        kept = re.sub(r"[^\r\n]", " ", whole)
        return f"{whole[0]}{kept[1:-1]}{whole[-1]}" if found.lastgroup == "text" and len(whole) > 1 else kept

    return blanks.sub(away, text)


def having(pattern: str, *, whole: bool = False) -> Find:
    """Every place in the code (`whole`: in the text, remarks included) that the pattern matches; its group 1 if any."""
    wanted = re.compile(pattern, re.MULTILINE | re.IGNORECASE)

    def finds(listings: Sequence[Listing]) -> Iterator[Place]:
        for listing in listings:
            for found in wanted.finditer(listing.source.text if whole else listing.code):
                yield Place(listing, *found.span(1 if wanted.groups else 0))

    return finds


def longer(pattern: str, most: int, *, whole: bool = False) -> Find:
    """Places that the pattern (its group 1) matches with more than so many characters."""
    every = having(pattern, whole=whole)

    def finds(listings: Sequence[Listing]) -> Iterator[Place]:
        return (place for place in every(listings) if place.end - place.start > most)

    return finds


def twice(pattern: str, *, among_all: bool = False, capitals: bool = False) -> Find:
    """Names (group 1) that are defined a second time, in a file or `among_all` files; `capitals` tell names apart."""
    every = having(pattern)

    def finds(listings: Sequence[Listing]) -> Iterator[Place]:
        for group in [listings] if among_all else [[listing] for listing in listings]:
            seen: set[str] = set()
            for place in every(group):
                name = spelled(place, capitals)
                if name in seen:
                    yield place
                seen.add(name)

    return finds


def undefined(use: str, definition: str, *, among_all: bool = False, capitals: bool = False) -> Find:
    """Uses (group 1) of a name that no definition (group 1) has, in the same file or `among_all` files."""
    uses, definitions = having(use), having(definition)

    def finds(listings: Sequence[Listing]) -> Iterator[Place]:
        for group in [listings] if among_all else [[listing] for listing in listings]:
            known = {spelled(place, capitals) for place in definitions(group)}
            yield from (place for place in uses(group) if spelled(place, capitals) not in known)

    return finds


def beyond(pattern: str, least: float, most: float) -> Find:
    """Numbers (group 1) outside of the range."""
    every = having(pattern)

    def finds(listings: Sequence[Listing]) -> Iterator[Place]:
        for place in every(listings):
            if not least <= float(place.listing.code[place.start : place.end]) <= most:
                yield place

    return finds


def unlike_file(pattern: str) -> Find:
    """The name (group 1) that the first match of a file gives it, where the file is called otherwise."""
    first = re.compile(pattern, re.MULTILINE | re.IGNORECASE)

    def finds(listings: Sequence[Listing]) -> Iterator[Place]:
        for listing in listings:
            found = first.search(listing.code)
            if found is not None and found[1].lower() != Path(listing.source.path).stem.lower():
                yield Place(listing, *found.span(1))

    return finds


def reserved(pattern: str, words: Iterable[str], *, capitals: bool = False) -> Find:
    """Names (group 1) that are words of the language; `capitals` tell names apart."""
    kept, every = {word if capitals else word.lower() for word in words}, having(pattern)

    def finds(listings: Sequence[Listing]) -> Iterator[Place]:
        return (place for place in every(listings) if spelled(place, capitals) in kept)

    return finds


def outside(characters: str) -> Find:
    """Characters that are not of the class, the first of each line."""
    return having(rf"^[{characters}\r]*([^{characters}\r\n])", whole=True)


def miscounted(number: str, counted: str) -> Find:
    """The number (group 1) at a file's head that is not that of the lines which `counted` matches."""
    head, lines = re.compile(number, re.MULTILINE), re.compile(counted, re.MULTILINE)

    def finds(listings: Sequence[Listing]) -> Iterator[Place]:
        for listing in listings:
            found = head.search(listing.code)
            if found is not None and int(found[1]) != sum(1 for _ in lines.finditer(listing.code)):
                yield Place(listing, *found.span(1))

    return finds


def used_again(use: str) -> Find:
    """Names (group 1) that a file uses more than once: each use but the first."""
    every = having(use)

    def finds(listings: Sequence[Listing]) -> Iterator[Place]:
        for listing in listings:
            seen: Counter[str] = Counter()
            for place in every([listing]):
                name = spelled(place, True)
                seen[name] += 1
                if seen[name] > 1:
                    yield place

    return finds


def spelled(place: Place, capitals: bool) -> str:
    """The text of a place, in small letters where capitals do not count."""
    text = place.listing.code[place.start : place.end]
    return text if capitals else text.lower()
