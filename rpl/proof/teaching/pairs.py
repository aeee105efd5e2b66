"""Which taught data of one program are which of another: by the numbers that a translation gave, by names, by comments,
and where these say nothing by equal values.

One datum may be kept in several places of the other program (a FANUC program has points of its own). Then each of
these is a copy of it, and all of them have to be taught.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath

from rpl.passes import rigid
from rpl.proof.teaching.data import FRAME, NUMBER, TOOL, Datum

# A datum of A and the one of B that a translation made of it: `pPick` and `main.p1`, folded (see `key_of`).
Given = tuple[str, str]
_SAME_MM, _SAME_DEG, _SAME_SHARE = 0.01, 0.01, 1e-5
_LEAST_CUT = 10  # letters of a comment that a longer name begins with
_NUMBERED = re.compile(r"([^\d\[\]]+?)0*(\d+)")
_SIGNS = re.compile(r"[\W_]+")
# What people put in front of a name for its kind: pPick, XPick, tGrip, wobjTable.
_KIND_OF_NAME = re.compile(r"(?:wobj|tool|[a-zX])(?=[A-Z])")
BY_NUMBER, BY_NAME, BY_COMMENT, BY_WORD, BY_VALUE = "number", "name", "comment", "part of the name", "value"
_BY_SURENESS = {4: BY_NUMBER, 3: BY_NAME, 2: BY_COMMENT, 1: BY_WORD}


@dataclass(frozen=True, slots=True)
class Copy:
    """A datum of B that is one of A, and how that was seen (BY_...)."""

    datum: Datum
    how: str

    def as_json(self) -> dict[str, object]:
        return {**self.datum.as_json(), "matched": self.how}


def paired(
    ours: Sequence[Datum], theirs: Sequence[Datum], given: Iterable[Given] = ()
) -> dict[Datum, tuple[Copy, ...]]:
    """By the datum of A its copies in B, as many as there are."""
    given = tuple(given)
    found: dict[Datum, list[Copy]] = {one: [] for one in ours}
    left = []
    for other in theirs:
        best = max(
            (
                (_likeness(one, other, given), same_value(one, other), _at_home(one, other), one.first, -at, one)
                for at, one in enumerate(ours)
            ),
            key=lambda row: row[:5],
            default=None,
        )
        if best is None or best[0] == 0:
            left.append(other)
        else:
            found[best[5]].append(Copy(other, _BY_SURENESS[best[0]]))
    alone = []
    for other in left:
        same = [one for one in ours if same_value(one, other) and not _is_nothing(other)]
        without = [one for one in same if not found[one]]
        at_home = [one for one in same if _at_home(one, other)]
        chosen = next((some for some in (same, at_home, without) if len(some) == 1), [])
        for one in chosen:
            found[one].append(Copy(other, BY_VALUE))
        alone += [other] if not same else []
    for other in alone:  # frames that begin elsewhere: of one number, where nothing says otherwise
        chosen = [one for one in ours if not found[one] and _same_number(one, other)]
        for one in chosen[:1]:
            found[one].append(Copy(other, BY_NUMBER))
    return {one: tuple(copies) for one, copies in found.items()}


def key_of(datum: Datum) -> str:
    """What tells a datum from others of its program, folded, numbers without leading zeros: `main.p1`, `uframe2`."""
    part = datum.part.replace("[", "").replace("]", "") if datum.part.startswith("[") else datum.part
    variable = datum.variable.replace("[", "").replace("]", "") + part
    numbered = _NUMBERED.fullmatch(variable)
    name = f"{numbered[1]}{numbered[2]}" if numbered is not None else variable
    return (f"{datum.routine}.{name}" if datum.routine else name).lower()


def _likeness(one: Datum, other: Datum, given: Sequence[Given]) -> int:
    """How sure it is that two data are one: 0 for not at all."""
    if (one.kind == NUMBER) != (other.kind == NUMBER):
        return 0
    names = _names(one)
    key = key_of(other)
    if any(called == key and _bare(name) in names for name, called in given):
        return 4
    if one.routine and other.routine and _bare(one.routine) != _bare(other.routine) and not same_value(one, other):
        return 0  # numbers of two programs tell nothing
    if names & _names(other) or (_list_of(one) and _list_of(one) == _list_of(other) and same_value(one, other)):
        return 3
    mine, there = _bare(one.label), _bare(other.label)
    called = (
        {mine, _bare(f"{one.routine}{one.label}")} if mine else set()
    )  # as points of many programs in one place are
    if called & (_names(other) | {there}) or (there and any(_is_cut(there, name) for name in names)):
        return 2
    return 1 if _words(one) & _words(other) else 0


def _at_home(one: Datum, other: Datum) -> bool:
    """Do the programs that hold them have one name, or one the other's with something behind it? Points of several
    programs may have one name and one value."""
    mine, there = sorted((_home(one), _home(other)), key=len)
    return bool(mine) and there.startswith(mine)


def _home(datum: Datum) -> str:
    return _bare(datum.routine or PurePosixPath(datum.place.file).stem)


def _same_number(one: Datum, other: Datum) -> bool:
    """Are both the tool, or the frame, of one number?"""
    numbers = [re.search(r"(\d+)\]?$", each.variable + each.part) for each in (one, other)]
    known = [int(each[1]) for each in numbers if each is not None]
    return one.kind == other.kind in (TOOL, FRAME) and len(known) == len(numbers) and known[0] == known[1]


def _names(datum: Datum) -> set[str]:
    """Its names without signs, folded; its first part has the name of the whole too. One of a routine has also that of
    its routine in front, as it is called where points of all routines stand beside each other."""
    found = {_bare(datum.variable + datum.part)}
    if datum.routine:
        found.add(_bare(f"{datum.routine}{datum.variable}{datum.part}"))
    return found | {_bare(datum.variable)} if datum.first and not datum.part.startswith("[") else found


def _list_of(datum: Datum) -> str:
    """The list that it is an element of, folded: the numbers of two languages may begin elsewhere."""
    name, bracket, _ = (datum.variable + datum.part).partition("[")
    return _bare(name) if bracket else ""


def _words(datum: Datum) -> set[str]:
    """Its names and comment without what says their kind."""
    bare = datum.variable + datum.part if not datum.first else datum.variable
    found = {_bare(_KIND_OF_NAME.sub("", bare, count=1)), _bare(datum.label)}
    return {word for word in found if word and not _NUMBERED.fullmatch(word)}


def _bare(name: str) -> str:
    return _SIGNS.sub("", name).lower()


def _is_cut(text: str, name: str) -> bool:
    """Is it the name, or as much of it as a comment holds?"""
    return text == name or (len(text) >= _LEAST_CUT and name.startswith(text))


def same_value(one: Datum, other: Datum) -> bool:
    """Do both hold the same place, joints or number?"""
    match one.value, other.value:
        case rigid.Pose() as a, rigid.Pose() as b:
            return same_place(a, b)
        case tuple() as a, tuple() as b:
            return len(a) == len(b) and all(abs(p - q) <= _SAME_DEG for p, q in zip(a, b, strict=True))
        case float() as a, float() as b:
            return math.isclose(a, b, rel_tol=_SAME_SHARE)
    return False


def same_place(one: rigid.Pose, other: rigid.Pose) -> bool:
    """Are two poses one, as near as files say them?"""
    apart = one.inverse.then(other)
    return apart.position.length <= _SAME_MM and apart.rotation.angle <= _SAME_DEG


def _is_nothing(datum: Datum) -> bool:
    """Too usual a value to tell anything."""
    match datum.value:
        case rigid.Pose(position=position, rotation=rotation):
            return position.length <= _SAME_MM and rotation.angle <= _SAME_DEG
        case tuple() as joints:
            return not any(joints)
    return True


def given_by(
    renamed: Iterable[tuple[str, str]], registers: Iterable[tuple[str, int, str]], theirs: Sequence[Datum]
) -> tuple[Given, ...]:
    """What a translation has called its data and which numbers it gave: (old name, new name), (bank, number, name)."""
    known = {key_of(one): one for one in theirs}
    bare = {_bare(one.variable): key for key, one in known.items() if one.first}
    found = {(old, bare[_bare(new)]) for old, new in renamed if _bare(new) in bare}
    found |= {(name, key) for bank, number, name in registers if (key := f"{bank}{number}".lower()) in known}
    return tuple(sorted(found))


__all__ = ["Copy", "Given", "given_by", "key_of", "paired", "same_place", "same_value"]
