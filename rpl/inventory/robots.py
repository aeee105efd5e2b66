"""Which of our arms a backup is of: the maker's name in its files, beside the names of robot files.

Makers write one arm in several ways (`KR6R900SIXX C4SR FLR`, `ROB1_6700_LeanID_2.65_220`), so a robot file is proposed
when all words of its name stand in the maker's, and named as near when only its model does.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import PurePath

from rpl import registry
from rpl.project import ReadProgram

_WORD = re.compile(r"[a-z]+|\d+(?:\.\d+)?")
_LETTERS = "abcdefghijklmnopqrstuvwxyz"
_SHORTEST = 4  # signs of a name without its maker that say an arm when they stand together


@dataclass(frozen=True, slots=True)
class ArmFound:
    """What a file calls the arm. `robot`: the robot file of that arm, "" when there is none. `near`: those of the same
    model that differ in payload or reach."""

    called: str
    file: str
    robot: str
    near: tuple[str, ...] = ()


def arms_of(read: ReadProgram) -> tuple[ArmFound, ...]:
    """The arms that the files of a project name, each once."""
    from rpl.emulator.robotfile import robot_summaries

    summaries = robot_summaries()
    spoken = {report.path: report.dialect for report in read.files}
    found: dict[str, ArmFound] = {}
    for language in read.dialects:
        dialect = registry.dialect(language)
        title = set(dialect.title.lower().split())
        names = [one.name for one in summaries if title.issuperset(one.maker.lower().split())]
        sources = [one for one in read.sources if spoken.get(one.path) == language]
        sources += [source for name, source in read.beside if name == language]
        for called, path in dialect.arms(sources):
            if called not in found:
                found[called] = ArmFound(called, PurePath(path).name, *named(called, names))
    return tuple(found.values())


def arm_of(read: ReadProgram) -> ArmFound | None:
    """The first arm with a robot file that the files of a backup name; None too where the package for arms is not
    installed."""
    found = next((one for one in arms_of(read) if one.robot), None)
    return found if find_spec("pinocchio") is not None else None


def named(called: str, names: list[str]) -> tuple[str, tuple[str, ...]]:
    """The robot file that a maker's name means, and when there is none files of the same model. names: of robot files
    of that maker."""
    joined = re.sub(r"[^a-z0-9]", "", called.lower())
    said = called.lower().split()
    words = {_centimetres(word) for word in _WORD.findall(called.lower())}
    whole, near = [], []
    for name in names:
        own = name.partition("_")[2] or name
        signs = own.replace("_", "")
        parts = [re.sub(r"^[a-z]+(?=\d{3})", "", part) for part in own.split("_")]
        so_called = signs in said or (len(signs) >= _SHORTEST and _stands_in(signs, joined))
        if so_called or (words.issuperset(parts) and parts[0].isdigit() and _is_series(own, parts[0], called)):
            whole.append(name)
        elif parts[0] in words or (
            (model := own.partition("_")[0].rstrip(_LETTERS)) in joined and len(model) > _SHORTEST
        ):
            near.append(name)
    return (max(whole, key=len), ()) if whole else ("", tuple(near))


def _stands_in(signs: str, joined: str) -> bool:
    """Not where a number goes on: a GP120 is no GP12."""
    return re.search(re.escape(signs) + r"(?!\d)" * signs[-1].isdigit(), joined) is not None


def _is_series(own: str, number: str, called: str) -> bool:
    """Has the number no other letters in front of it than those of the name: `ROB1_6700_` and `IRB6700`, no MA2010 for
    an AR2010?"""
    letters = own.partition(number)[0]
    return re.search(rf"(?:(?<![a-z\d])|{letters}){number}(?!\d)", called.lower()) is not None


def _centimetres(word: str) -> str:
    """A reach in metres as robot files have it in their names (2.65 is 265)."""
    return f"{float(word) * 100:.0f}" if "." in word else word
