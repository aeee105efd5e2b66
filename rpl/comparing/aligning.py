"""Which parts of two long lists differ: what both have once anchors the rest, so that nothing is compared with all.

The way is that of "patience" diffs: common ends are cut off, then keys that each side has exactly once, in the longest
order that both share, split the lists; only the small rest goes to difflib.
"""

from __future__ import annotations

from bisect import bisect_left
from collections import Counter
from collections.abc import Hashable, Iterator, Sequence
from difflib import SequenceMatcher

# Pairs of keys that difflib may look at within one gap; a larger one without an anchor counts as different as a whole.
_MOST_PAIRS = 4_000_000

Gap = tuple[int, int, int, int]


def gaps(a: Sequence[Hashable], b: Sequence[Hashable]) -> list[Gap]:
    """Ranges (i1, i2, j1, j2) in which a[i1:i2] stands for b[j1:j2], in order; between them both are equal."""
    found: list[Gap] = []
    ahead: list[Gap] = [(0, len(a), 0, len(b))]
    while ahead:
        i, i_end, j, j_end = ahead.pop()
        while i < i_end and j < j_end and a[i] == b[j]:
            i, j = i + 1, j + 1
        while i < i_end and j < j_end and a[i_end - 1] == b[j_end - 1]:
            i_end, j_end = i_end - 1, j_end - 1
        if i == i_end or j == j_end:
            if i < i_end or j < j_end:
                found.append((i, i_end, j, j_end))
            continue
        anchors = _anchors(a, b, (i, i_end, j, j_end))
        if anchors:
            ahead += reversed(list(_between(anchors, (i, i_end, j, j_end))))
        else:
            found += _by_difflib(a, b, (i, i_end, j, j_end))
    return found


def _between(anchors: list[tuple[int, int]], gap: Gap) -> Iterator[Gap]:
    i, i_end, j, j_end = gap
    for at, other in anchors:
        if i < at or j < other:
            yield i, at, j, other
        i, j = at + 1, other + 1
    if i < i_end or j < j_end:
        yield i, i_end, j, j_end


def _anchors(a: Sequence[Hashable], b: Sequence[Hashable], gap: Gap) -> list[tuple[int, int]]:
    """Places of keys that both sides have once, as many as stand in one order on both."""
    i, i_end, j, j_end = gap
    here, there = Counter(a[i:i_end]), Counter(b[j:j_end])
    places = {key: at for at, key in enumerate(b[j:j_end], j) if there[key] == 1 and here.get(key) == 1}
    pairs = [(at, places[key]) for at, key in enumerate(a[i:i_end], i) if key in places]
    return _rising(pairs)


def _rising(pairs: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """The longest part of the pairs whose second numbers rise."""
    least: list[int] = []  # the least last number of a rising part, by its length
    ends: list[int] = []
    before: list[int] = []
    for at, (_, number) in enumerate(pairs):
        length = bisect_left(least, number)
        before.append(ends[length - 1] if length else -1)
        if length == len(least):
            least.append(number)
            ends.append(at)
        else:
            least[length], ends[length] = number, at
    found = []
    at = ends[-1] if ends else -1
    while at >= 0:
        found.append(pairs[at])
        at = before[at]
    return found[::-1]


def _by_difflib(a: Sequence[Hashable], b: Sequence[Hashable], gap: Gap) -> list[Gap]:
    i, i_end, j, j_end = gap
    if (i_end - i) * (j_end - j) > _MOST_PAIRS:
        return [gap]
    matcher = SequenceMatcher(None, a[i:i_end], b[j:j_end], autojunk=False)
    return [
        (i + low, i + high, j + other, j + end)
        for tag, low, high, other, end in matcher.get_opcodes()
        if tag != "equal"
    ]
