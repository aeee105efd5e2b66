"""Numbers, names, texts and lines as a target wants them: what every printer shares, driven by the target's data.

Three promises stand here once for all targets: a value that is not zero never prints as zero and `-0` prints as `0`; a
printed number reads back within half a unit of its last place; two names that differ for the source never become one.
"""

from __future__ import annotations

import math
import unicodedata
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from decimal import ROUND_HALF_EVEN, Decimal
from types import MappingProxyType

from rpl.errors import InternalError
from rpl.writing.target import NameRules


@dataclass(frozen=True, slots=True)
class NumberStyle:
    """How a target spells numbers.

    always_point: a real has a point (`1.0`). exponent: the sign before an exponent, empty when the target knows none.
    smallest_plain, largest_plain: magnitudes outside are written with an exponent. signed_exponent: `1E+20`.
    """

    always_point: bool = False
    exponent: str = "E"
    smallest_plain: float = 1e-4
    largest_plain: float = 1e15
    signed_exponent: bool = False


PLAIN = NumberStyle()
ALWAYS_POINT = NumberStyle(always_point=True)


def number_text(value: float, decimals: int | None = None, style: NumberStyle = PLAIN) -> str:
    """The number as text: with at most `decimals` places (zeros behind cut off), without it exact.

    A value too small for the places asked for is written to three significant digits instead of as zero.
    """
    if isinstance(value, int):
        return str(int(value))
    if not math.isfinite(value):
        raise InternalError(f"the number {value} cannot be written")
    if value == 0:
        return "0.0" if style.always_point else "0"
    return _usual_text(value, decimals, style) or _exact_text(value, decimals, style)


# Magnitudes whose text Python's own formatting gives: there a double has two digits more than the places asked for.
_USUAL_LEAST, _USUAL_MOST, _USUAL_PLACES = 1e-3, 1e4, 6
# How far from the middle between two last places no noise in the two digits behind them reaches it.
_MIDDLE = 0.01


def _usual_text(value: float, decimals: int | None, style: NumberStyle) -> str:
    """What `_exact_text` gives, in a tenth of the time; empty where only that can tell."""
    if not _USUAL_LEAST < abs(value) < _USUAL_MOST or style.smallest_plain > _USUAL_LEAST:
        return ""
    text = repr(float(value))
    if decimals is not None and len(text) - text.index(".") - 1 > decimals:
        scaled = abs(value) * 10.0**decimals
        if decimals > _USUAL_PLACES or scaled < 1.0 or abs(scaled % 1.0 - 0.5) < _MIDDLE:
            return ""
        text = f"{value:.{decimals}f}"
        if decimals > 0:
            text = text.rstrip("0")
    whole, _, places = text.partition(".")
    if places in ("", "0"):
        return f"{whole}.0" if style.always_point else whole
    return text


def _exact_text(value: float, decimals: int | None, style: NumberStyle) -> str:
    exact = Decimal(repr(float(value)))
    if decimals is not None:
        rounded = round_decimal(exact, decimals)
        exact = rounded if rounded else significant(exact, 3)
    exact = exact.normalize()
    magnitude = abs(exact)
    outside = magnitude >= Decimal(style.largest_plain) or magnitude < Decimal(style.smallest_plain)
    if outside and style.exponent and (decimals is None or magnitude < Decimal(1).scaleb(-decimals) or magnitude > 1):
        return _with_exponent(exact, style)
    text = format(exact, "f")
    if style.always_point and "." not in text:
        text += ".0"
    return text


def _with_exponent(exact: Decimal, style: NumberStyle) -> str:
    sign, digits, _ = exact.as_tuple()
    mantissa = str(digits[0]) + ("." + "".join(map(str, digits[1:])) if len(digits) > 1 else "")
    if style.always_point and "." not in mantissa:
        mantissa += ".0"
    power = exact.adjusted()
    plus = "+" if style.signed_exponent and power >= 0 else ""
    return f"{'-' if sign else ''}{mantissa}{style.exponent}{plus}{power}"


def round_decimal(value: Decimal, decimals: int) -> Decimal:
    """Rounded to a count of places, whatever the size of the number. What lies between two of them within the noise
    of its last places lies just there before it is rounded: noise decides no digit."""
    if value.adjusted() + decimals > 25:  # far more digits than a float has: nothing to round
        return value
    finer = min(decimals + 6, 11 - value.adjusted())
    if finer > decimals:
        value = value.quantize(Decimal(1).scaleb(-finer), ROUND_HALF_EVEN)
    return value.quantize(Decimal(1).scaleb(-decimals), ROUND_HALF_EVEN)


def significant(value: Decimal, digits: int) -> Decimal:
    """Rounded to a count of significant digits."""
    return value.quantize(Decimal(1).scaleb(value.adjusted() - digits + 1), ROUND_HALF_EVEN)


def quoted(text: str, quote: str = '"', escapes: Mapping[str, str] | None = None) -> str:
    """The text between quotes; `escapes` says how the target writes single characters (RAPID: `"` and `\\` doubled)."""
    table = {quote: quote * 2} if escapes is None else escapes
    return quote + "".join(table.get(sign, sign) for sign in text) + quote


def wrapped(line: str, width: int) -> list[str]:
    """A line of prose cut at blanks (inside a word only when it alone is too long); joining the parts gives it back."""
    parts, width = [], max(width, 1)
    while len(line) > width:
        at = line.rfind(" ", 1, width) + 1
        cut = at if at > 1 and line[:at].strip() else width
        parts.append(line[:cut])
        line = line[cut:]
    return [*parts, line]


class NameMangler:
    """Names of a program made legal for a target, the same way every time; `restore` gives the source's name back.

    One source name becomes one target name wherever it stands. `names` are all names of the program: those that are
    legal keep their spelling, whatever the others need, and so do the controller's own. `pinned`: what some of them are
    called whatever else there is (each legal and of one name). Taken names are compared as the target compares them.
    """

    __slots__ = ("_back", "_forth", "_routines", "_rules", "_source_sensitive", "_taken")

    def __init__(
        self,
        rules: NameRules,
        names: Iterable[str] = (),
        *,
        source_case_sensitive: bool = False,
        routines: Iterable[str] = (),
        pinned: Mapping[str, str] = MappingProxyType({}),
    ) -> None:
        self._rules = rules
        self._routines = {name.lower() for name in routines}
        self._source_sensitive = source_case_sensitive
        self._forth: dict[str, str] = {}
        self._back: dict[str, str] = {}
        self._taken: set[str] = set()
        ordered = list(dict.fromkeys(names))
        for name, chosen in pinned.items():
            self._keep(name, chosen)
        for name in ordered:
            legal = self.legal(name) or self._folded(name) in rules.predefined
            if self._key(name) not in self._forth and legal and self._folded(name) not in self._taken:
                self._keep(name, name)
        for name in ordered:
            self.name(name)

    def legal(self, name: str) -> bool:
        """May the target use this name as it is (apart from other names)?"""
        rules = self._rules
        return (
            0 < len(name) <= self._longest(name)
            and name[0].lower() in rules.first
            and all(sign.lower() in rules.further for sign in name[1:])
            and not self._reserved(name)
        )

    def name(self, source: str) -> str:
        """The target's name for a source's name."""
        known = self._forth.get(self._key(source))
        if known is not None:
            return known
        return self._keep(source, self._free(self._spelled(source), self._longest(source)))

    def fresh(self, hint: str) -> str:
        """A new name that no source name has; it restores to itself."""
        found = self._free(self._spelled(hint), self._rules.longest)
        self._taken.add(self._folded(found))
        return found

    def restore(self, target: str) -> str:
        """The source's name of a target's name (itself when nothing was renamed to it)."""
        return self._back.get(self._folded(target), target)

    def renamed(self) -> dict[str, str]:
        """Source name -> target name of every name that changed, in order of first use."""
        return {self._back[self._folded(new)]: new for new in self._forth.values() if self.restore(new) != new}

    def _key(self, source: str) -> str:
        return source if self._source_sensitive else source.lower()

    def _folded(self, target: str) -> str:
        return target if self._rules.case_sensitive else target.lower()

    def _reserved(self, name: str) -> bool:
        return self._folded(name) in self._rules.reserved

    def _keep(self, source: str, target: str) -> str:
        self._forth[self._key(source)] = target
        self._back[self._folded(target)] = source
        self._taken.add(self._folded(target))
        return target

    def _spelled(self, source: str) -> str:
        rules = self._rules
        plain = unicodedata.normalize("NFKD", source)
        filler = "_" if "_" in rules.further else ""
        signs = [sign if sign.lower() in rules.further else filler for sign in plain if not unicodedata.combining(sign)]
        text = "".join(signs)
        if not text or text[0].lower() not in rules.first:
            text = f"{'n' if 'n' in rules.first else rules.first[0]}{text}"
        return text

    def _longest(self, source: str) -> int:
        rules = self._rules
        return rules.longest_routine or rules.longest if source.lower() in self._routines else rules.longest

    def _free(self, wanted: str, longest: int) -> str:
        count = 1
        while True:
            tail = "" if count == 1 else f"_{count}" if "_" in self._rules.further else str(count)
            candidate = wanted[: longest - len(tail)] + tail
            if self._folded(candidate) not in self._taken and self.legal(candidate):
                return candidate
            count += 1
            if count > 1_000_000:
                raise InternalError(f"no free name for {wanted!r} in {longest} characters")


__all__ = [
    "ALWAYS_POINT",
    "PLAIN",
    "NameMangler",
    "NumberStyle",
    "number_text",
    "quoted",
    "wrapped",
]
