"""The files of two versions: which belong together, and where their lines differ without anybody having told it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from pathlib import PurePath

from rpl.comparing.aligning import gaps
from rpl.comparing.changes import ADDED, CHANGED, REMOVED, Change, Spot
from rpl.registry import Dialect
from rpl.source import Source
from rpl.trivia import NOTHING, Trivia

Pair = tuple[Source | None, Source | None]


def paired_sources(old: Sequence[Source], new: Sequence[Source], known: Iterable[Pair]) -> list[Pair]:
    """The files of both sides: those of modules that belong together, then those of one path below what was given, or
    of one name; a single file on each side is one."""
    pairs: list[Pair] = []
    left, right = {one.path: one for one in old}, {one.path: one for one in new}
    for a, b in known:
        if a is not None and b is not None and a.path in left and b.path in right:
            pairs.append((left.pop(a.path), right.pop(b.path)))
    for key in (_relative, _base):
        here, there = key(old), key(new)
        by_key = {there[path]: path for path in right}
        for path in list(left):
            other = by_key.get(here[path])
            if other is not None and other in right:
                pairs.append((left.pop(path), right.pop(other)))
    if len(left) == len(right) == 1:
        pairs.append((next(iter(left.values())), next(iter(right.values()))))
        return pairs
    return [*pairs, *((one, None) for one in left.values()), *((None, one) for one in right.values())]


def _relative(sources: Sequence[Source]) -> dict[str, str]:
    """Paths below the folder that all share, without capitals."""
    parts = {one.path: PurePath(one.path).parts for one in sources}
    shared = 0
    while len({path[: shared + 1] for path in parts.values()}) == 1 and all(
        len(path) > shared + 1 for path in parts.values()
    ):
        shared += 1
    return {path: "/".join(names[shared:]).casefold() for path, names in parts.items()}


def _base(sources: Sequence[Source]) -> dict[str, str]:
    return {one.path: PurePath(one.path).name.casefold() for one in sources}


def unaccounted(
    old: Source, new: Source, dialect: Dialect | None, seen: Mapping[str, Sequence[tuple[int, int]]]
) -> tuple[list[Change], list[tuple[Spot | None, Spot | None]]]:
    """Lines of two versions of a file that differ and that nobody has told: as changes where they may mean something,
    and as places that say the same. seen: what is told, file -> first and last lines."""
    if old.data == new.data:
        return [], []
    trivia = dialect.trivia if dialect is not None else NOTHING
    fold = dialect is not None and not dialect.rules().case_sensitive
    a, b = old.text.splitlines(), new.text.splitlines()
    keys = [_key(line, trivia, fold) for line in a], [_key(line, trivia, fold) for line in b]
    told = _Lines(seen.get(old.path, ())), _Lines(seen.get(new.path, ()))
    untold = [
        (i, i_end, j, j_end)
        for i, i_end, j, j_end in gaps(*keys)
        if not told[0].touch(i + 1, i_end) and not told[1].touch(j + 1, j_end)
    ]
    # What stands elsewhere and is no statement (their order is told) says the same.
    gone = Counter(key for i, i_end, _, _ in untold for key in keys[0][i:i_end] if key)
    come = Counter(key for _, _, j, j_end in untold for key in keys[1][j:j_end] if key)
    changes: list[Change] = []
    same: list[tuple[Spot | None, Spot | None]] = []
    for i, i_end, j, j_end in untold:
        places = _place(old, a, i, i_end), _place(new, b, j, j_end)
        if all(not key or come[key] >= gone[key] for key in keys[0][i:i_end]) and all(
            not key or gone[key] >= come[key] for key in keys[1][j:j_end]
        ):
            same.append(places)
            continue
        what = ADDED if places[0] is None else REMOVED if places[1] is None else CHANGED
        changes.append(Change("text", what, "", "", "", *places))
    if not changes and not same and not told[0].any and not told[1].any:
        same.append((Spot(old.path, 1, 1, ""), Spot(new.path, 1, 1, "")))  # blanks, capitals, ends of lines
    return changes, same


class _Lines:
    """Lines that are told."""

    def __init__(self, ranges: Iterable[tuple[int, int]]) -> None:
        self.numbers = {number for first, last in ranges for number in range(first, last + 1)}

    @property
    def any(self) -> bool:
        return bool(self.numbers)

    def touch(self, first: int, last: int) -> bool:
        return any(number in self.numbers for number in range(first, last + 1))


def _key(line: str, trivia: Trivia, fold: bool) -> str:
    if trivia.attribute(line):
        return ""
    key = trivia.key(line)
    return key.casefold() if fold else key


def _place(source: Source, lines: Sequence[str], first: int, end: int) -> Spot | None:
    if first == end:
        return None
    return Spot(source.path, first + 1, end, " ".join(" ".join(lines[first : min(end, first + 3)]).split())[:200])
