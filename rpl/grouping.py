"""Reports as lines that people read: one line for each kind, the worst first, with a number and the lines.

A report is data (a code, an origin, arguments), so that a kind needs no wording of its own: where one argument differs,
its values are listed in the message, or all in the code's own sentence for several (`Code.several`). Errors and losses
stand each for itself while they are few, because each of them needs somebody. Advice that names an option which was
given is left out.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import groupby
from string import Formatter

from rpl.diagnostics import Code, Diagnostic, Severity

# So many errors or losses of one kind that say different things stand each on a line of its own.
_MOST_SINGLE = 10
# A kind is told in so many lines at most, where two arguments differ and one of them has few values.
_MOST_LINES_OF_A_KIND = 3
_MOST_VALUES, _MOST_LETTERS = 12, 160
_MOST_PLACES, _MOST_FILES = 10, 4
# Parts of an advice, each of which can be followed for itself.
_PARTS = re.compile(r"(, and |, or |; )")
_OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]*")
_OTHER_COMMAND = re.compile(r"\brpl [a-z]+( --[a-z-]+)*")


def told(items: Iterable[Diagnostic], verbose: bool = False, followed: frozenset[str] = frozenset()) -> Iterator[str]:
    """The reports as lines of text, the worst first, else in their order. `verbose`: each on a line of its own.
    `followed`: the options that were given (`--robot`)."""
    if verbose:
        ordered = sorted(items, key=lambda item: -item.severity)
        yield from (_line(item, item.message, advised(item, followed)) for item in ordered)
        return
    for kind in _kinds(items).values():
        for group in _groups(kind):
            yield _line(group.items[0], group.message(), _asked(group.advice(), followed)) + group.places()


def sentences(items: Iterable[Diagnostic], followed: frozenset[str] = frozenset()) -> Iterator[tuple[Severity, str]]:
    """What reports about one place say, without the place: one sentence for each kind, the worst first."""
    for kind in _kinds(items).values():
        for group in _groups(kind):
            advice = _asked(group.advice(), followed)
            yield kind[0].severity, group.message() + (f" ({advice})" if advice else "")


def _kinds(items: Iterable[Diagnostic]) -> dict[tuple[Severity, str], list[Diagnostic]]:
    kinds: dict[tuple[Severity, str], list[Diagnostic]] = {}
    for item in sorted(items, key=lambda item: -item.severity):
        kinds.setdefault((item.severity, item.code.name), []).append(item)
    return kinds


def _groups(kind: Sequence[Diagnostic]) -> list[_Said]:
    """The reports of one kind that share a line."""
    said = _Said(tuple(kind), _columns(kind))
    if kind[0].severity >= Severity.LOSS:
        single = said.by_words()
        if len(single) <= _MOST_SINGLE:
            return single
    return said.split()


@dataclass(frozen=True, slots=True)
class _Said:
    """Reports of one code. `columns`: for each field of its texts what the reports have there."""

    items: tuple[Diagnostic, ...]
    columns: dict[str, list[str]]

    @property
    def differing(self) -> list[str]:
        """The fields with more than one value."""
        return [field for field, texts in self.columns.items() if any(text != texts[0] for text in texts)]

    def by_words(self) -> list[_Said]:
        """Those that say the same together."""
        return self._parted(list(zip(*self.columns.values(), strict=True)) or [()] * len(self.items))

    def split(self) -> list[_Said]:
        """Few groups in which one field differs at most; where there is no such division, all of them."""
        differing = self.differing
        if len(differing) <= 1 or self.items[0].code.several:
            return [self]
        fewest = min(differing, key=lambda field: len(set(self.columns[field])))
        if len(set(self.columns[fewest])) > _MOST_LINES_OF_A_KIND:
            return [self]
        parts = [one for part in self._parted(self.columns[fewest]) for one in part.split()]
        simple = len(parts) <= _MOST_LINES_OF_A_KIND and all(len(one.differing) <= 1 for one in parts)
        return parts if simple else [self]

    def _parted(self, keys: Sequence[object]) -> list[_Said]:
        rows: dict[object, list[int]] = {}
        for at, key in enumerate(keys):
            rows.setdefault(key, []).append(at)
        return [
            _Said(
                tuple(self.items[at] for at in row),
                {field: [texts[at] for at in row] for field, texts in self.columns.items()},
            )
            for row in rows.values()
        ]

    def message(self) -> str:
        """What all of them say: the values of the field that differs are listed; where several differ, or a text is
        all that there is, the first report with a remark that others are like it."""
        code, differing = (
            self.items[0].code,
            [field for field in self.differing if field in self.items[0].code.template],
        )
        if not differing:
            return self.items[0].message
        if code.several:
            return self._in_one_sentence(code.several)
        if len(differing) > 1 or code.template == differing[0]:
            others = len({tuple(row) for row in zip(*self.columns.values(), strict=True)}) - 1
            return f"{self.items[0].message} (and {others} other{'s' * (others > 1)} like it: --verbose shows them)"
        return _filled(code.template, self._listing())

    def _in_one_sentence(self, template: str) -> str:
        """The code's own sentence: what stands in brackets once for each different report."""
        before, _, rest = template.partition("[")
        each, _, behind = rest.partition("]")
        rows = [dict(item.arguments) for item in self.items]
        several = list(dict.fromkeys(each.format(**row) for row in rows))
        texts = self._listing() | {"{count}": str(len(several))}
        return _filled(before, texts) + _listed(several) + _filled(behind, texts)

    def advice(self) -> str:
        """What is advised for all of them."""
        return _filled(self.items[0].code.help, self._listing())

    def _listing(self) -> dict[str, str]:
        """For each field the values that the reports have there."""
        return {field: _listed(list(dict.fromkeys(texts))) for field, texts in self.columns.items()}

    def places(self) -> str:
        """` [3 times: lines 2, 5 to 8]`, nothing for a single report; the number is left out where the code's own
        sentence has it."""
        count = len(self.items)
        counted = bool(self.items[0].code.several) and len(self.by_words()) == count
        places = {(item.origin.file, item.origin.line, item.origin.column) for item in self.items}
        said = [] if counted or count == 1 else [f"{count} times"]
        said += [_where(self.items)] if len(places) > 1 else []
        return f" [{': '.join(said)}]" if said else ""


def _line(first: Diagnostic, message: str, advice: str) -> str:
    """`file:line:column: severity CODE message`, the place being the first one."""
    origin = first.origin
    place = f"{origin.file}:{origin.line}:{origin.column}: " if origin.source else ""
    return f"{place}{first.severity.word} {first.code.name} {message}" + (f" ({advice})" if advice else "")


def advised(item: Diagnostic, followed: frozenset[str] = frozenset()) -> str:
    """The advice of a report without the parts that ask for an option which was given."""
    return _asked(item.code.help.format(**dict(item.arguments)), followed)


def _asked(advice: str, followed: frozenset[str]) -> str:
    """What is advised for another command (`rpl run --robot`) stays."""
    parts, kept = _PARTS.split(advice), ""
    for at in range(0, len(parts), 2):
        options = set(_OPTION.findall(_OTHER_COMMAND.sub("", parts[at])))
        if not options & followed:
            kept += (parts[at - 1] if kept else "") + parts[at]
    return kept


@cache
def _pieces(template: str) -> tuple[tuple[str, str], ...]:
    """The template as (text before, field with its format) pairs."""
    found = []
    for text, name, form, conversion in Formatter().parse(template):
        sign = f"!{conversion}" if conversion else ""
        field = "" if name is None else "{" + name + sign + (f":{form}" if form else "") + "}"
        found.append((text, field))
    return tuple(found)


def _columns(items: Sequence[Diagnostic]) -> dict[str, list[str]]:
    """What the reports have in each field of message and advice."""
    code: Code = items[0].code
    fields = dict.fromkeys(field for text in (code.template, code.help) for _, field in _pieces(text) if field)
    rows = [dict(item.arguments) for item in items]
    return {field: [field.format(**row) for row in rows] for field in fields}


def _filled(template: str, texts: dict[str, str]) -> str:
    return "".join(text + (texts[field] if field else "") for text, field in _pieces(template))


def _listed(values: Sequence[str]) -> str:
    """The first values, and how many more there are."""
    shown, letters = 0, 0
    for value in values[:_MOST_VALUES]:
        letters += len(value) + 2
        if shown and letters > _MOST_LETTERS:
            break
        shown += 1
    more = len(values) - shown
    return ", ".join(values[:shown]) + (f" and {more} more" if more else "")


def _where(items: Sequence[Diagnostic]) -> str:
    """`lines 2, 5 to 8; b.src: line 3`; the first file is named where the line of the report begins."""
    lines: dict[str, list[int]] = {}
    for item in items:
        lines.setdefault(item.origin.file if item.origin.source else "", []).append(item.origin.line)
    first = items[0].origin.file
    said = []
    for file in list(lines)[:_MOST_FILES]:
        numbers = sorted(set(lines[file]))
        text = f"line{'s' * (len(numbers) > 1)} {_ranges(numbers)}" if file else "without a place"
        said.append(text if file in (first, "") else f"{file}: {text}")
    more = [f"{len(lines) - _MOST_FILES} more files"] if len(lines) > _MOST_FILES else []
    return "; ".join([*said, *more])


def _ranges(numbers: Sequence[int]) -> str:
    """Rising numbers, three and more that follow each other as `5 to 8`."""
    said: list[str] = []
    for _, run in groupby(enumerate(numbers), key=lambda pair: pair[1] - pair[0]):
        row = [number for _, number in run]
        said += [f"{row[0]} to {row[-1]}"] if len(row) > 2 else [str(number) for number in row]
    return ", ".join(said[:_MOST_PLACES]) + (", ..." if len(said) > _MOST_PLACES else "")
