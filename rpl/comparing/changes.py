"""What two projects differ in, as plain data."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field

# What a change is about, in the order in which people want to hear of them.
KINDS = (
    *("file", "routine", "point", "frame", "tool", "load", "speed", "io", "logic", "data", "header", "text"),
    "comment",
)
ADDED, REMOVED, CHANGED = "added", "removed", "changed"


@dataclass(frozen=True, slots=True)
class Spot:
    """A place in a file: its first line (from 1), its last one, and the text that stands there."""

    file: str
    line: int
    last: int
    text: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}"


@dataclass(frozen=True, slots=True)
class Moved:
    """How far a point is from where it was: its way in mm, by axes, the turn between both orientations in degrees, and
    the axes of joint targets (name, degrees, as the robot counts them; external axes in their own unit)."""

    mm: float = 0.0
    offset_mm: tuple[float, float, float] = (0.0, 0.0, 0.0)
    degrees: float = 0.0
    axes: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True, slots=True)
class Change:
    """One thing that differs. kind: one of KINDS. what: added, removed, changed. `name`: of the point, datum, routine
    or file, empty for a statement; `routine`: where it stands. `a`, `b`: the places on both sides. `words`: what has
    changed, in words; `moved`: how far, for points and frames that are known numbers on both sides."""

    kind: str
    what: str
    name: str = ""
    module: str = ""
    routine: str = ""
    a: Spot | None = None
    b: Spot | None = None
    words: tuple[str, ...] = ()
    moved: Moved | None = None

    def as_json(self) -> dict[str, object]:
        return asdict(self)


@dataclass(frozen=True, slots=True)
class Differences:
    """All of it, in the order of the files. `meaningless`: places that are written otherwise and say the same."""

    changes: tuple[Change, ...]
    meaningless: int = 0
    languages: tuple[str, ...] = ()
    counts: dict[str, int] = field(init=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "counts", counted_by_kind(self.changes))

    @property
    def same(self) -> bool:
        """Do both sides mean the same? Remarks mean nothing."""
        return all(one.kind == "comment" for one in self.changes)

    def of(self, *kinds: str) -> tuple[Change, ...]:
        """The changes of these kinds."""
        return tuple(one for one in self.changes if one.kind in kinds)

    def as_json(self) -> dict[str, object]:
        """The same for machines."""
        return {
            "same": self.same,
            "languages": list(self.languages),
            "counts": self.counts,
            "meaningless": self.meaningless,
            "changes": [one.as_json() for one in self.changes],
        }


def counted_by_kind(changes: Iterable[Change]) -> dict[str, int]:
    found = Counter(one.kind for one in changes)
    return {kind: found[kind] for kind in KINDS if found[kind]}
