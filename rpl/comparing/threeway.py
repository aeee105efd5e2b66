"""Three lists of pieces brought together: what one side changed is taken, what both changed alike is taken once, and
what both changed otherwise is a conflict."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from rpl.comparing.aligning import Gap, gaps
from rpl.comparing.pieces import Piece


@dataclass(frozen=True, slots=True)
class Clash:
    """What both sides changed otherwise: the pieces of the base, of ours and of theirs."""

    base: tuple[Piece, ...]
    ours: tuple[Piece, ...]
    theirs: tuple[Piece, ...]


Part = Piece | Clash


def brought_together(base: Sequence[Piece], ours: Sequence[Piece], theirs: Sequence[Piece]) -> list[Part]:
    """The merged pieces in order. What nobody changed is taken from ours, dates and numbers of lines with it."""
    left = gaps([one.key for one in base], [one.key for one in ours])
    right = gaps([one.key for one in base], [one.key for one in theirs])
    parts: list[Part] = []
    at = at_ours = 0
    for low, high, here, there in _regions(left, right):
        parts += ours[at_ours : at_ours + low - at]
        mine, other = ours[here[0] : here[1]], theirs[there[0] : there[1]]
        parts += _region(base[low:high], mine, other)
        at, at_ours = high, here[1]
    parts += ours[at_ours:]
    return parts


def _regions(left: list[Gap], right: list[Gap]) -> Iterator[tuple[int, int, tuple[int, int], tuple[int, int]]]:
    """Ranges of the base that somebody changed, with the ranges of both sides that stand for them. Gaps that overlap in
    the base, or insert at one place, are one."""
    shift_left = shift_right = 0  # how far each side is behind the base, before the region
    i = j = 0
    while i < len(left) or j < len(right):
        low = min(left[i][0] if i < len(left) else right[j][0], right[j][0] if j < len(right) else left[i][0])
        high = low
        first_left, first_right = i, j
        while True:
            if i < len(left) and _joins(left[i], low, high, i == first_left and j == first_right):
                high, i = max(high, left[i][1]), i + 1
            elif j < len(right) and _joins(right[j], low, high, i == first_left and j == first_right):
                high, j = max(high, right[j][1]), j + 1
            else:
                break
        start = low + shift_left, low + shift_right
        shift_left += sum(one[3] - one[2] - (one[1] - one[0]) for one in left[first_left:i])
        shift_right += sum(one[3] - one[2] - (one[1] - one[0]) for one in right[first_right:j])
        yield low, high, (start[0], high + shift_left), (start[1], high + shift_right)


def _joins(gap: Gap, low: int, high: int, first: bool) -> bool:
    """Does the gap belong to the region so far? It overlaps it, or both insert at the same place."""
    if gap[0] == low and (first or high == low):
        return True
    return gap[0] < high or (gap[0] == high == low)


def _region(base: Sequence[Piece], ours: Sequence[Piece], theirs: Sequence[Piece]) -> list[Part]:
    keys = [one.key for one in base], [one.key for one in ours], [one.key for one in theirs]
    if keys[1] == keys[2] or keys[0] == keys[2]:
        return list(ours)
    if keys[0] == keys[1]:
        return list(theirs)
    return _by_names(base, ours, theirs) or [Clash(tuple(base), tuple(ours), tuple(theirs))]


def _by_names(base: Sequence[Piece], ours: Sequence[Piece], theirs: Sequence[Piece]) -> list[Part]:
    """Declarations are brought together by their names, whatever their order; nothing where other pieces are among
    them."""
    named = [{one.name: one for one in side} for side in (base, ours, theirs)]
    if any("" in side or len(side) != len(all_of) for side, all_of in zip(named, (base, ours, theirs), strict=True)):
        return []
    before, mine, other = named
    parts: list[Part] = []
    for name in dict.fromkeys((*mine, *before, *other)):
        was, here, there = ((side[name],) if name in side else () for side in (before, mine, other))
        keys = [[one.key for one in side] for side in (was, here, there)]
        if keys[1] == keys[2] or keys[0] == keys[2]:
            parts += here
        elif keys[0] == keys[1]:
            parts += there
        else:
            parts.append(Clash(was, here, there))
    return parts
