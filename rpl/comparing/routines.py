"""Two versions of a routine compared statement by statement."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Sequence

from rpl import ir
from rpl.comparing.aligning import Gap, gaps
from rpl.comparing.changes import ADDED, CHANGED, REMOVED, Change, Spot
from rpl.comparing.data import other_words, spot_of
from rpl.comparing.listing import Listing, Remark, Unit
from rpl.comparing.statements import change_told, kind_of
from rpl.passes.scope import Scope
from rpl.trivia import Trivia

Places = tuple[Spot | None, Spot | None]
Stands = tuple[Unit | None, Unit | None]  # a statement and the one in its place
Way = Callable[[Unit], Hashable]  # by what statements are brought together


def compared(
    old: Listing, new: Listing, scopes: tuple[Scope, Scope], names: tuple[str, str]
) -> tuple[list[Change], list[Places]]:
    """The changes of a routine, and the places that are written otherwise and say the same. names: of the module and
    the routine."""
    changes: list[Change] = []
    same: list[Places] = []
    for gap in gaps(old.keys, new.keys):
        for one, other in _pairs(old, new, gap):
            places = _spot(one), _spot(other)
            if one is None or other is None:
                unit = one or other
                assert unit is not None  # one of both is there
                what = ADDED if one is None else REMOVED
                changes.append(Change(_kind(unit), what, "", *names, *places))
                continue
            a, b = one.statements(), other.statements()
            if a == b and one.mark == other.mark:
                words = _remarked(one, other, scopes[1], new.trivia)
                if words:
                    changes.append(Change("comment", CHANGED, "", *names, *places, words))
                else:
                    same.append(places)
                continue
            told = change_told(a, b, *scopes)
            changes.append(Change(told.kind, CHANGED, told.name, *names, *places, told.words, told.moved))
    changes += comments(old.remarks, new.remarks, names)
    return changes, same


def _remarked(one: Unit, other: Unit, scope: Scope, trivia: Trivia) -> tuple[str, ...]:
    """Words that differ in statements which we read as the same: names for people beside numbers, for instance."""
    if one.mark or one.source is None or other.source is None or one.remarks != other.remarks:
        return ()  # comments are told for themselves
    old, new = one.source.text[one.start : one.end], other.source.text[other.start : other.end]
    return other_words(trivia.key(old), trivia.key(new), not scope.rules.case_sensitive)


def _kind(unit: Unit) -> str:
    return "logic" if unit.mark else kind_of(unit.statements())


def _spot(unit: Unit | None) -> Spot | None:
    """Where it stands; a branch or end of a block on the first line behind what is before it."""
    if unit is None or unit.source is None:
        return None
    if unit.start < unit.end:
        return spot_of((unit.source, unit.start, unit.end))
    text = unit.source.text
    line_end = text.find("\n", unit.end)
    start = len(text) if line_end < 0 else line_end + 1
    while start < len(text) and text[start] in " \t\r\n":
        start += 1
    end = text.find("\n", start)
    return spot_of((unit.source, start, len(text) if end < 0 else end))


def _pairs(old: Listing, new: Listing, gap: Gap) -> Iterator[Stands]:
    """What stands for what in a gap: first what means the same, then what is of one shape, in their order."""
    i, i_end, j, j_end = gap
    here, there = old.units[i:i_end], new.units[j:j_end]
    if len(here) == len(there) == 1 or not here or not there:
        one, other = (here[0] if here else None), (there[0] if there else None)
        if one is not None and other is not None and _loose(one) == _loose(other):
            yield one, other
            return
        yield from ((unit, None) for unit in here)
        yield from ((None, unit) for unit in there)
        return
    yield from _by(here, there, (_meaning, _shape, _loose))


def _by(here: Sequence[Unit], there: Sequence[Unit], ways: tuple[Way, ...]) -> Iterator[Stands]:
    if not ways or not here or not there:
        yield from ((unit, None) for unit in here)
        yield from ((None, unit) for unit in there)
        return
    keys = [ways[0](one) for one in here], [ways[0](one) for one in there]
    at = other = 0
    for i, i_end, j, j_end in [*gaps(*keys), (len(here), len(here), len(there), len(there))]:
        yield from zip(here[at:i], there[other:j], strict=True)
        yield from _by(here[i:i_end], there[j:j_end], ways[1:])
        at, other = i_end, j_end


def _meaning(unit: Unit) -> Hashable:
    return unit.mark, unit.statements()


def _shape(unit: Unit) -> Hashable:
    """What a statement is and what it is about: the goal of a move, what is assigned, who is called."""
    return unit.mark.partition(" ")[0], tuple(_about(node) for node in unit.statements())


def _about(node: object) -> object:
    match node:
        case ir.Move(target=target, kind=kind):
            return ir.Move, target if isinstance(target, ir.Name) else kind
        case ir.Assign(target=target):
            return ir.Assign, target
        case ir.CallRoutine(name=name):
            return ir.CallRoutine, name
    return type(node)


def _loose(unit: Unit) -> Hashable:
    return unit.mark.partition(" ")[0], tuple(type(node) for node in unit.statements())


def comments(old: Sequence[Remark], new: Sequence[Remark], names: tuple[str, str]) -> Iterator[Change]:
    """Comments that were added, removed or changed. names: of the module and the routine."""
    keys = [" ".join(one.text.split()) for one in old], [" ".join(one.text.split()) for one in new]
    for i, i_end, j, j_end in gaps(*keys):
        here, there = [_remark_spot(one) for one in old[i:i_end]], [_remark_spot(one) for one in new[j:j_end]]
        for at in range(max(len(here), len(there))):
            a, b = (here[at] if at < len(here) else None), (there[at] if at < len(there) else None)
            what = ADDED if at >= len(here) else REMOVED if at >= len(there) else CHANGED
            yield Change("comment", what, "", *names, a, b)


def _remark_spot(remark: Remark) -> Spot | None:
    if remark.source is None:
        return None
    text, words = remark.source.text, remark.text.strip()
    at = text.find(words, remark.low, remark.high)
    at = text.find(words) if at < 0 else at
    start = at if at >= 0 else remark.low
    line = remark.source.position(start)[0]
    return Spot(remark.source.path, line, line, words)
