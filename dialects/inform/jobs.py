"""The lines of a file to jobs: the header is a state machine whose pseudo-instructions hold from their line on.

`///TOOL`, `///USER`, `///POSTYPE`, `///PULSE`, `///RECTAN`, `///ANGLE` and `///RCONF` say how the following points are
written; what else stands in the header is kept for writing it again.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import PureWindowsPath

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.reading.pieces import Item, ModulePart
from rpl.source import Comment, Origin, Source

from .syntax import Command, HeaderLine, Nest, Numbered, PointLine, mentioned

OUTSIDE = code("inform-outside-job", Severity.WARNING, "lines before the first /JOB", "they are read as job {name}")
BAD_HEADER = code(
    "inform-bad-header", Severity.ERROR, "{what}", "compare with the header of a job saved by a controller"
)
SEVENTH = code(
    "inform-seventh-axis", Severity.WARNING, "values behind the sixth are read as further axes of the arm (e1 ...)"
)
MORE_FLAGS = code(
    "inform-form-of-more-axes",
    Severity.WARNING,
    "RCONF {what} sets flags behind the sixth, which only arms of more than six axes have: they are not carried over",
    "check the posture on the arm",
)
CUT_OFF = code(
    "inform-cut-off",
    Severity.INFO,
    "the last job has no END: the file may have been cut off",
    "compare it with the job on the controller",
)

_ENDED = re.compile(r"^\s*END\s*\Z", re.MULTILINE | re.IGNORECASE)
PULSE, ANGLE, POSE = "pulse", "angle", "pose"


@dataclass(frozen=True, slots=True)
class Frame:
    """The frame that a pose is given in: base, tool, master tool, or a user frame with its number."""

    kind: str = "base"
    number: ir.Expression | None = None


@dataclass(frozen=True, slots=True)
class Point:
    """A taught point or the saved value of a position variable. `form`: pulse, angle (deg) or pose (mm, deg)."""

    line: PointLine
    form: str
    tool: int
    frame: Frame
    flags: tuple[int, ...]


@dataclass(slots=True)
class Job:
    """One job before its instructions get their meaning."""

    name: str
    origin: Origin
    header: list[tuple[str, str]] = field(default_factory=list)
    comments: list[Comment] = field(default_factory=list)
    points: dict[tuple[str, int], Point] = field(default_factory=dict)
    body: list[Item] = field(default_factory=list)
    groups: list[str] = field(default_factory=list)
    _mentions: list[tuple[Command, tuple[ir.Index | ir.Signal | Numbered, ...]]] | None = None

    def mentions(self) -> list[tuple[Command, tuple[ir.Index | ir.Signal | Numbered, ...]]]:
        """Every instruction in the order of the text with the variables, signals and numbered things in it."""
        if self._mentions is None:
            self._mentions = [(command, mentioned(command)) for command in commands(self.body)]
        return self._mentions

    def arguments(self) -> int:
        """How many arguments it takes by GETARG."""
        taken = (command.items[1] for command in commands(self.body) if command.word == "GETARG" and command.items[1:])
        numbers = (one.number for one in taken if isinstance(one, Numbered))
        return max((one.value for one in numbers if isinstance(one, ir.IntLiteral)), default=0)

    @property
    def tool(self) -> int:
        """The tool of what has none of its own: the first that the header names."""
        return next((int(value) for name, value in self.header if name == "TOOL" and value.isdigit()), 0)


@dataclass(slots=True)
class _State:
    """What holds for the following points."""

    tool: int = 0
    user: int = 0
    kind: str = "PULSE"
    form: str = PULSE
    flags: tuple[int, ...] = ()

    def frame(self) -> Frame:
        if self.kind == "USER":
            return Frame("user", ir.IntLiteral(self.user))
        return Frame({"TOOL": "tool", "MTOOL": "master"}.get(self.kind, "base"))


class JobReader:
    """Sorts the items of one file into its jobs."""

    def __init__(self, source: Source, diagnostics: Diagnostics) -> None:
        self.source, self.diagnostics = source, diagnostics
        self.jobs: list[Job] = []
        self.state = _State()
        self.comments: list[Comment] = []

    def read(self, items: Iterable[Item]) -> list[Job]:
        for item in items:
            if isinstance(item, ModulePart) and isinstance(item.data, HeaderLine):
                self.header(item.data, item.origin)
            elif isinstance(item, ModulePart) and isinstance(item.data, PointLine):
                self.point(item.data, item.origin)
            else:
                self.job(item.origin).body.append(item)
        text = self.source.text
        if self.jobs and not _ENDED.search(text):
            self.diagnostics.report(CUT_OFF, Origin(self.source, max(len(text) - 1, 0), len(text)))
        return self.jobs

    def job(self, origin: Origin) -> Job:
        """The job that is being read."""
        if not self.jobs:
            stem = PureWindowsPath(self.source.path).stem or "JOB"
            self.diagnostics.report(OUTSIDE, origin, name=stem)
            self.jobs.append(Job(stem, origin))
        return self.jobs[-1]

    def header(self, line: HeaderLine, origin: Origin) -> None:
        if line.level == 1 and line.word == "JOB":
            self.jobs.append(Job(PureWindowsPath(self.source.path).stem or "JOB", origin))
            self.state = _State()
        job = self.job(origin)
        job.comments.extend(origin.comments)
        if line.word == "NAME" and line.level == 2:
            job.name = line.rest or job.name
            job.origin = origin
        elif line.word.startswith("GROUP") and line.level == 3:
            job.groups.append(line.rest)
        if line.level > 1:
            job.header.append((line.word, line.rest))
            self.change(line, origin)

    def change(self, line: HeaderLine, origin: Origin) -> None:
        """A pseudo-instruction about the points behind it."""
        state = self.state
        match line.word:
            case "TOOL":
                state.tool = self.number(line, origin)
            case "USER":
                state.user = self.number(line, origin)
            case "POSTYPE":
                state.kind = line.rest.upper()
                if state.kind == "ANGLE":
                    state.form = ANGLE
            case "PULSE":
                state.form = PULSE
            case "RECTAN":
                state.form = POSE
            case "ANGLE":
                state.form = ANGLE
            case "RCONF":
                fields = [part.strip() for part in line.rest.split(",")]
                if not all(part.isdigit() for part in fields):
                    self.diagnostics.report(BAD_HEADER, origin, what=f"RCONF {line.rest} is no list of flags")
                    return
                if any(map(int, fields[6:])):
                    self.diagnostics.report(MORE_FLAGS, origin, what=line.rest)
                state.flags = tuple(int(part) for part in fields[:6])

    def number(self, line: HeaderLine, origin: Origin) -> int:
        first = line.rest.split(",")[0].split(" ")[0]
        if not first.isdigit():
            self.diagnostics.report(BAD_HEADER, origin, what=f"{line.word} needs a number, not '{line.rest}'")
            return 0
        return int(first)

    def point(self, line: PointLine, origin: Origin) -> None:
        state, job = self.state, self.job(origin)
        form = state.form
        if state.kind in ("PULSE", "ANGLE") and form == POSE:
            form = PULSE if state.kind == "PULSE" else ANGLE
        if form == POSE and line.bank in ("C", "P") and len(line.values) < 6:
            self.diagnostics.report(BAD_HEADER, origin, what=f"a pose has six values, here are {len(line.values)}")
            return
        if len(line.values) > 6 and line.bank in ("C", "P"):
            self.diagnostics.report(SEVENTH, origin)
        flags = state.flags if form == POSE else ()
        job.points[line.bank, line.number] = Point(line, form, state.tool, state.frame(), flags)


def commands(items: Iterable[Item]) -> Iterable[Command]:
    """Every instruction of a body, in the order of the text."""
    for item in items:
        if not isinstance(item, ModulePart):
            continue
        if isinstance(item.data, Command):
            yield item.data
        elif isinstance(item.data, Nest):
            yield item.data.head
            for head, inner in item.data.sections:
                if head is not None:
                    yield head
                yield from commands(inner)
