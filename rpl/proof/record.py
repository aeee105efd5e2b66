"""What a run showed, in the terms that a comparison needs: happenings per task in order, and the path of the tool.

A record is free of the language that the program was written in. Signals have all the names under which the other
program may know them; see `signal_names`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING

from rpl.runtime.signals import usual_key
from rpl.source import NOWHERE, Origin

if TYPE_CHECKING:
    from rpl.emulator.rotations import FloatArray
    from rpl.runtime.moves.orders import Payload, Programmed
    from rpl.runtime.reached import Reached
    from rpl.runtime.waits import Waited

Value = bool | int | float | str | None


def signal_names(
    kind: str | None, names: Iterable[str], index: int | None = None, last: int | None = None
) -> frozenset[str]:
    """The keys by which a signal of one program is found again in another.

    Its names in lower case; its kind and number when it has one. A name that is made of a usual word and a number
    (`do3`) counts as that number only when no number is known: a name declared for another number keeps its own.
    """
    keys = {name.lower().removeprefix("$") for name in names if name}
    if index is not None and kind and (last is None or last == index):
        return frozenset(keys | {f"{kind}:{index}"})
    if index is not None and kind:  # a group of bits; its name may be the number that it has as a group elsewhere
        numbered = {f"{found[0]}:{found[1]}" for name in keys if (found := usual_key(name)) and "group" in found[0]}
        return frozenset(keys | numbered | {f"{bits_of(kind)}:{index}-{last}"})
    usual = [found for name in keys if (found := usual_key(name)) is not None]
    groups = {group for name in keys if (group := group_key(name)) is not None}
    return frozenset(keys | groups | {f"{word}:{number}" for word, number in usual})


def bits_of(kind: str) -> str:
    """The kind of a group of signals of the kind."""
    return kind.replace("digital_", "group_")


def group_key(name: str) -> str | None:
    """`go9_16` is the group of the signals 9 to 16."""
    first, _, last = name.rpartition("_")
    found = usual_key(first) if last.isdigit() else None
    return f"{found[0]}:{found[1]}-{last}" if found is not None and found[0].startswith("group") else None


@dataclass(frozen=True, slots=True)
class Place:
    """Where in a program: file, line, and the text of the statement."""

    file: str = ""
    line: int = 0
    text: str = ""

    def as_json(self) -> dict[str, object]:
        return {"file": self.file, "line": self.line, "text": self.text}

    def __str__(self) -> str:
        where = f"{self.file}:{self.line}" if self.line else "no place in the source"
        return f"{where}: {self.text}" if self.text else where


def place_of(origin: Origin) -> Place:
    """The place of a node; of a statement over several lines the first."""
    if origin is NOWHERE or origin.source is None:
        return Place()
    lines = origin.text.strip().splitlines()
    return Place(origin.file, origin.line, lines[0].strip() if lines else "")


@dataclass(frozen=True, slots=True)
class Family:
    """The posture of an arm in words, "" where it stands on the boundary. `build`: arms of one build have the same
    families."""

    build: str
    shoulder: str
    elbow: str
    wrist: str

    def differs(self, other: Family) -> list[tuple[str, str]]:
        """The words of both sides that are known and not the same."""
        if self.build != other.build:
            return []
        pairs = [(getattr(self, one.name), getattr(other, one.name)) for one in fields(self)[1:]]
        return [pair for pair in pairs if all(pair) and pair[0] != pair[1]]


@dataclass(frozen=True, slots=True)
class LeftOut:
    """A move that a controller does not make as it is written because its corner overlaps with the one before it.
    `driven`: with smaller corners; else it is left out altogether. `text`: what the controller logs."""

    place: Place
    t: float
    driven: bool
    text: str


@dataclass(frozen=True, slots=True)
class Named:
    """What names a register in a message that shows constant text only: regular expressions for registers of numbers
    and of anything else. Empty: messages show their values."""

    numbers: str = ""
    texts: str = ""


@dataclass(frozen=True, slots=True)
class Happening:
    """Something that can be seen from outside. kind: output, message, dialog, wait, fault, end.

    value: the output's value, the message's text, the seconds of a timed wait (None: on a condition), the fault's code,
    the status at the end. `names`: of a signal, or the routine that an error left unhandled (fault). `along` is how far
    the tool had travelled on its whole path, mm; `moving` whether it moved.
    Timed waits in a row are one wait for their sum: so many `times`, the longest of them `longest_s`.
    `named`: what names a value in the text of a message; `held`: what those hold then, as far as it is known. `number`:
    its place among all events of the run, which tells what comes first where several tasks do something at one moment.
    `at`: where the tool was (mm), None without a robot. `timed`: of an output switched after a time, whether that ends
    a `pulse` or a `delay`, and its seconds. `helper`: a task that only one of the languages needs does it. `sender`:
    who says a message, or its title, where the program says that.
    """

    kind: str
    t: float
    value: Value = None
    names: frozenset[str] = frozenset()
    place: Place = field(default_factory=Place)
    along: float = 0.0
    moving: bool = False
    times: int = 1
    longest_s: float = 0.0
    named: Named = Named()
    number: int = 0
    at: tuple[float, float, float] | None = None
    timed: tuple[str, float] | None = None
    held: tuple[tuple[str, Value], ...] = ()
    helper: bool = False
    sender: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class Stretch:
    """One move as it was driven: tool poses (k, 4, 4) in the robot's base frame, mm, at times (k,), and the joints (n,)
    at its end. motion: joint, linear, circular, spline. `stops`: the robot came to rest at its end. `goal`: the
    programmed end, x y z in mm and the quaternion w x y z (7,), which a blended move passes at a distance. `aim`: the
    pose (4, 4) at the end of what was planned, also of a move that did not come there. `cut`: an interrupt or a search
    ended it on its way. `own_measure`: its corner is as large as the controller's speed or axes make it. `corner_at`:
    the pose with which the corner at its end begins, None without one.
    `asked`: what the program asks of it. `loads`: what the robot carries in it, as the program says. `family`: the
    posture of the arm at the programmed goal; `cut_short`: the controller stopped in place of its corner (postures).
    external: its external axes at its end (deg, mm)."""

    motion: str
    times: FloatArray
    poses: FloatArray
    joints: FloatArray
    stops: bool = True
    place: Place = field(default_factory=Place)
    goal: FloatArray | None = None
    aim: FloatArray | None = None
    cut: bool = False
    own_measure: bool = False
    corner_at: int | None = None
    asked: Programmed | None = None
    loads: tuple[Payload, ...] = ()
    family: Family | None = None
    cut_short: bool = False
    external: FloatArray | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Record:
    """A whole run: how it ended, what happened in each task, the motion of each robot by task name, the moves that a
    controller left out or shortened, and which statements it came to. `waited`: waits for conditions that
    ended. `inputs`: what the surroundings changed."""

    status: str
    time_s: float
    tasks: Mapping[str, tuple[Happening, ...]]
    motion: Mapping[str, tuple[Stretch, ...]]
    robot: str = ""
    language: str = ""
    left_out: Mapping[str, tuple[LeftOut, ...]] = field(default_factory=dict)
    reached: Reached | None = None
    waited: tuple[Waited, ...] = ()
    inputs: tuple[Happening, ...] = ()
