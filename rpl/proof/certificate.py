"""The certificate of a proof: what was asked, of which files, and what came of it, so that anybody can do it again.

It is a JSON document. Files are named from where it lies and by the hash of their bytes, so that a change in any of
them is seen before the proof is made anew.
"""

from __future__ import annotations

import hashlib
import json
import os
import platform
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING

from rpl.errors import UsageError
from rpl.proof.deviations import measures
from rpl.proof.tolerance import Accepted
from rpl.source import read_bytes

if TYPE_CHECKING:
    from rpl.proof.teaching.outcome import Retaught
    from rpl.proof.verdict import ProofResult
    from rpl.proof.wiring import Named
    from rpl.source import Source

FORMAT = "rpl proof certificate 1"
_LIBRARIES = ("numpy", "pin")
# Amounts of one proof made twice agree to this share: libraries of two machines differ in the last place.
_SAME_SHARE = 1e-3
_SAME_AMOUNT = 1e-3


@dataclass(frozen=True, slots=True)
class Question:
    """What a proof was asked: paths of both programs, of the cell and of files that describe arms or controllers, else
    names; accepted deviations; limits of the runs (None: the usual ones). Where B is a translation of A: `signals`,
    which of A's signals have which numbers in it, `names`, what A's variables are called in it, and `approximations`
    that it was written with, by code, `taught`, which of B's taught data it made of which of A's (pairs.Given); these
    are left out of the document where there are none. `teach`: the seed of --teach, `teach_mm` how far it moves."""

    a: str
    b: str
    robot: str | None = None
    to_robot: str | None = None
    cell: str | None = None
    entry: str | None = None
    to_entry: str | None = None
    language_a: str | None = None
    language_b: str | None = None
    controller: str = "plain"
    explore: bool = False
    accept: tuple[str, ...] = ()
    path_mm: float | None = None
    corner_mm: float | None = None
    time_share: float | None = None
    max_time: float | None = None
    max_steps: int | None = None
    max_events: int | None = None
    signals: tuple[Named, ...] = ()
    names: tuple[tuple[str, str], ...] = ()
    approximations: tuple[tuple[str, int], ...] = ()
    teach: int | None = None
    teach_mm: float | None = None
    taught: tuple[tuple[str, str], ...] = ()

    @property
    def accepted(self) -> Accepted:
        return Accepted(frozenset(self.accept), self.path_mm, self.corner_mm, self.time_share)


PATHS = ("a", "b", "cell")
OPTIONAL = ("signals", "names", "approximations", "taught")
OPTIONAL_NUMBERS = ("teach", "teach_mm")
FILES_OR_NAMES = ("robot", "to_robot", "controller")


def certificate(
    question: Question, sources: Sequence[Sequence[Source]], result: ProofResult, beside: Path
) -> dict[str, object]:
    """The document. `sources`: the files that A and B were read from; `beside`: where the certificate will lie."""
    asked: dict[str, object] = asdict(question) | {"accept": sorted(question.accept)}
    for name in OPTIONAL:
        if asked.pop(name):
            asked[name] = [list(one) for one in getattr(question, name)]
    for name in OPTIONAL_NUMBERS:
        if asked[name] is None:
            del asked[name]
    for name in (*PATHS, *FILES_OR_NAMES):
        value = getattr(question, name)
        if value is not None and (name in PATHS or _is_file(value)):
            asked[name] = _from(beside, value)
    return {
        "format": FORMAT,
        "versions": _versions(),
        "question": asked,
        "programs": {
            name: [{"path": _from(beside, one.path), "sha256": _hash(one.data)} for one in some]
            for name, some in zip("ab", sources, strict=True)
        },
        "files": {name: _hash(data) for name, data in _described(question).items()},
        "tolerance": asdict(result.tolerance),
        "verdict": result.verdict,
        "result": _outcome(result, beside),
    }


def as_bytes(document: Mapping[str, object]) -> bytes:
    """The document as it is written to a file. Raises UsageError for a name of a file that is no text."""
    text = json.dumps(document, indent=1, ensure_ascii=False, sort_keys=True) + "\n"
    try:
        return text.encode("utf-8")
    except UnicodeEncodeError as error:
        name = ascii(text[max(0, error.start - 20) : error.end + 20])
        raise UsageError(f"a certificate cannot hold a name of a file that is no UTF-8: {name}") from None


def changes(then: Mapping[str, object], now: Mapping[str, object]) -> list[str]:
    """What no longer holds of a certificate, in words; nothing when all of it does. Versions are no reason by
    themselves."""
    found = [*_changed_files(then, now)]
    for name in ("question", "tolerance"):
        if then.get(name) != now.get(name):
            found.append(f"the {name} is another one")
    if then.get("verdict") != now.get("verdict"):
        found.append(f"the verdict was {then.get('verdict')} and is {now.get('verdict')}")
    elif not _same(then.get("result"), now.get("result")):
        found.append("the verdict is the same, but other measures deviate, or by other amounts")
    return found


def _changed_files(then: Mapping[str, object], now: Mapping[str, object]) -> list[str]:
    found = []
    for name, title in (("a", "A"), ("b", "B")):
        old, new = ({one["path"]: one["sha256"] for one in _programs(side, name)} for side in (then, now))
        for path in sorted(set(old) | set(new)):
            if path not in new:
                found.append(f"{title}: {path} is not there any more")
            elif path not in old:
                found.append(f"{title}: {path} is new")
            elif old[path] != new[path]:
                found.append(f"{title}: {path} has changed")
    before, after = (files if isinstance(files := side.get("files"), Mapping) else {} for side in (then, now))
    beside = sorted(set(before) | set(after))
    return found + [f"the {name} has changed" for name in beside if before.get(name) != after.get(name)]


def _programs(document: Mapping[str, object], name: str) -> list[dict[str, str]]:
    programs = document.get("programs")
    some = programs.get(name) if isinstance(programs, dict) else None
    return [one for one in some if isinstance(one, dict)] if isinstance(some, list) else []


def _outcome(result: ProofResult, beside: Path) -> dict[str, object]:
    """What is compared when the proof is made again: words, counts and amounts."""
    taught = {"taught": _taught(result.taught, beside)} if result.taught is not None else {}
    return taught | {
        "level": result.level,
        "reason": result.reason,
        "difference": result.difference.explanation if result.difference is not None else "",
        "deviations": [
            {"kind": one.kind, "count": one.count, "worst": round(one.worst.amount, 6), "accepted": accepted}
            for accepted, some in ((False, result.open), (True, result.accepted))
            for one in some
        ],
        "measures": [one.as_text() for one in measures(result.deviations)],
        "max_path_mm": round(result.max_path_mm, 6),
        "max_joint_deg": round(result.max_joint_deg, 6),
        "reach": _reach(result, beside),
        "notes": list(result.notes),
    }


def _reach(result: ProofResult, beside: Path) -> dict[str, object]:
    """As the verdict has it, with the paths of its files from there."""
    found: dict[str, object] = {"explored": result.explored.as_json() if result.explored is not None else None}
    for side, reach in (("a", result.reach_a), ("b", result.reach_b)):
        if reach is not None:
            rows = [one.as_json() for one in reach.unreached]
            found[side] = reach.as_json() | {
                "unreached": [row | {"file": _from(beside, str(row["file"]))} for row in rows]
            }
    return found


def _taught(taught: Retaught, beside: Path) -> dict[str, object]:
    """As the verdict has it, with the paths of its files from there."""

    def from_there(row: dict[str, object]) -> dict[str, object]:
        return row | {"file": _from(beside, str(row["file"]))}

    rows = [
        from_there(one.as_json()) | {"copies": [from_there(copy.as_json()) for copy in one.copies], "reason": ""}
        for one in taught.outcomes
    ]
    return taught.as_json() | {"data": rows}


def _same(then: object, now: object) -> bool:
    """Equal documents, numbers within what two machines make differ; words that show such numbers do not count."""
    if isinstance(then, dict) and isinstance(now, dict):
        shown = {"measures", "difference"}
        return set(then) == set(now) and all(_same(then[key], now[key]) for key in then if key not in shown)
    if isinstance(then, list) and isinstance(now, list):
        return len(then) == len(now) and all(map(_same, then, now))
    if isinstance(then, bool) or isinstance(now, bool):
        return then is now
    if isinstance(then, float | int) and isinstance(now, float | int):
        return abs(then - now) <= max(_SAME_AMOUNT, _SAME_SHARE * max(abs(then), abs(now)))
    return then == now


def _versions() -> dict[str, str]:
    from rpl import __version__

    found = {"rpl": __version__, "python": platform.python_version()}
    for name in _LIBRARIES:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            continue
    return found


def _described(question: Question) -> dict[str, bytes]:
    """The files that say what the arms, the cell and the controller are like."""
    from rpl.emulator.robotfile import robot_bytes

    found: dict[str, bytes] = {}
    if question.robot is not None:
        found["robot"] = robot_bytes(question.robot)
    if question.to_robot is not None:
        found["to_robot"] = robot_bytes(question.to_robot)
    for name in ("cell", "controller"):
        value = getattr(question, name)
        if value is not None and (name == "cell" or _is_file(value)):
            found[name] = read_bytes(value)
    return found


def looks_like_file(word: str) -> bool:
    return word.endswith((".toml", ".urdf"))


def _is_file(word: str) -> bool:
    return looks_like_file(word) and Path(word).is_file()


def _from(beside: Path, path: str) -> str:
    """The path from there, with slashes; of a member of an archive that of the archive and its own."""
    return Path(os.path.relpath(path, beside.parent)).as_posix()


def _hash(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


__all__ = [
    "FILES_OR_NAMES",
    "FORMAT",
    "OPTIONAL",
    "OPTIONAL_NUMBERS",
    "PATHS",
    "Question",
    "as_bytes",
    "certificate",
    "changes",
    "looks_like_file",
]
