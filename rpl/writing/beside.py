"""What a translation takes from the robot that will run it, what it goes around, and what it replaces there."""

from __future__ import annotations

from collections.abc import Mapping

from rpl.diagnostics import Diagnostics, Severity, code
from rpl.ir.standing import Standing, near
from rpl.writing.namemap import NameMap

TAKEN_NAME = code(
    "name-taken-there",
    Severity.WARNING,
    "the robot has {name} ({file}); here it is called {new}",
    "if it is a former translation of this program, give its map with --map",
    several="{count} names are taken on the robot and have another one here: [{name} ({file}), now {new}]",
)
REPLACED = code(
    "replaced-there",
    Severity.INFO,
    "the robot has {name} ({file}) of an earlier translation; this one replaces it",
    several="{count} programs and data of an earlier translation on the robot are replaced: [{name} ({file})]",
)
OTHER_USE = code(
    "number-used-there",
    Severity.WARNING,
    "the map gives {bank}[{number}] to {name}; on the robot it is {other}",
    "look who uses it there; give {name} another number in the map",
    several="{count} numbers of the map have another use on the robot: [{bank}[{number}] {name}, there {other}]",
)
SIGNAL_THERE = code(
    "signal-name-there",
    Severity.INFO,
    "signal {number} of {kind} is called {name} as on the robot",
    several="{count} signals are called as on the robot: [{kind} {number} {name}]",
)
COMPUTED = code(
    "numbers-computed-there",
    Severity.WARNING,
    "programs on the robot choose numbers of {bank} while they run; whether these are free cannot be told: {numbers}",
    "look which numbers they choose, and give others in the map",
)
POSE_THERE = code(
    "pose-differs-there",
    Severity.WARNING,
    "{bank}[{number}] has another value on the robot: {other}, here {value}",
    "give one of them another number before you load what is written: programs there use it",
    several="{count} tools and frames have other values on the robot: [{bank}[{number}]]",
)
_MOST = 12


def report_beside(
    there: Standing,
    given: NameMap,
    earlier: NameMap,
    apart: Mapping[str, str],
    used: Mapping[tuple[str, int], str],
    diagnostics: Diagnostics,
) -> None:
    """`given`: the map of this translation; `apart`: source name -> new name of what was called otherwise because of
    the robot; `used`: the numbers of this program."""
    for name, new in apart.items():
        diagnostics.report(TAKEN_NAME, name=name, new=new, file=there.names.get(name.lower(), "another name"))
    for name, new in given.names.items():
        if new.lower() in there.names and earlier.names.get(name) == new:
            diagnostics.report(REPLACED, name=new, file=there.names[new.lower()])
    for at, name in used.items():
        other = there.numbers.get(at, "")
        if other and at in earlier.numbers and not _same(name, other):
            diagnostics.report(OTHER_USE, bank=at[0], number=at[1], name=name, other=other)
        if at in there.signals and there.signals[at] == name and at not in earlier.numbers:
            diagnostics.report(SIGNAL_THERE, kind=at[0].replace("_", " "), number=at[1], name=name)
    for bank in sorted(there.computed):
        mine = sorted(number for name, number in used if name == bank)
        if mine:
            shown = ", ".join(map(str, mine[:_MOST])) + (", ..." if len(mine) > _MOST else "")
            diagnostics.report(COMPUTED, bank=bank, numbers=shown)


def report_poses(poses: Mapping[tuple[str, int], tuple[float, ...]], there: Standing, diagnostics: Diagnostics) -> None:
    """Tools and frames of the program whose numbers it keeps, and that are others on the robot."""
    for at, value in poses.items():
        other = there.poses.get(at)
        if other is not None and not near(other, value):
            diagnostics.report(POSE_THERE, bank=at[0], number=at[1], other=_shown(other), value=_shown(value))


def _shown(value: tuple[float, ...]) -> str:
    return ", ".join(f"{one:.3f}".rstrip("0").rstrip(".") for one in value)


def _same(name: str, comment: str) -> bool:
    """Comments are cut on controllers, and the name of a routine in front is left out."""
    short = name.rpartition(".")[2].lower()
    return short.startswith(comment.lower()) or name.lower().startswith(comment.lower())
