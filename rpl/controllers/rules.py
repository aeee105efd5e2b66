"""What may be sent to a controller, and under which name: its maker's data, and the questions that are asked of it."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import PurePosixPath

from rpl import registry
from rpl.controllers.link import GarbledError

# Parts of a name that no file of a controller may bring to this machine, on whatever system it is written.
_RESERVED = re.compile(r"(?i)(con|prn|aux|nul|com\d|lpt\d)(\..*)?")
_FORBIDDEN = re.compile(r'[<>:"|?*\\\x00-\x1f\x7f]')
_LONGEST_NAME = 255


def same_bytes(name: str, sent: bytes, found: bytes) -> bool:
    """The controller keeps files as they were written."""
    return sent == found


def known_programs() -> tuple[str, ...]:
    """Patterns of the files of all languages, for a way of carrying files that belongs to no maker."""
    return tuple(f"*{end}" for name in registry.dialect_names() for end in registry.dialect(name).extensions)


@dataclass(frozen=True, slots=True)
class SendingRules:
    """programs: patterns of file names that are programs (others of a folder are left out, which is said). denied:
    patterns of names that are never written: safety parameters, configuration of inputs and outputs, system files.
    pairs: suffix -> suffix of the file that must travel with it where there is one (first the one that is to be
    written first). name: what
    a program's file may be called, as a regular expression, and `names` the same in words. flat: the controller has no
    folders. encoding: how its texts are written (a profile may say another), line_ends: `lf`, `crlf` or empty (as they
    are). binary: patterns of programs that are no texts. same(name, sent, found): is what the controller gives back
    what was written to it? It may write a text anew.
    """

    programs: tuple[str, ...]
    denied: tuple[str, ...] = ()
    pairs: Mapping[str, str] | None = None
    name: str = r".+"
    names: str = "any name"
    flat: bool = False
    encoding: str = "utf-8"
    line_ends: str = ""
    binary: tuple[str, ...] = ()
    same: Callable[[str, bytes, bytes], bool] = same_bytes

    def is_program(self, name: str) -> bool:
        return _matches(name, self.programs)

    def is_denied(self, name: str) -> bool:
        return _matches(name, self.denied)

    def complaints(
        self, name: str, data: bytes, encoding: str, names: frozenset[str], there: frozenset[str] = frozenset()
    ) -> Iterator[str]:
        """Why this file may not be sent, in whole sentences. `names`: all that are to be sent, `there`: those that the
        controller has, in small letters."""
        if self.is_denied(name):
            yield f"{name}: safety, system and configuration files are never sent"
        stem = PurePosixPath(name).stem
        if re.fullmatch(self.name, stem) is None:
            yield f"{name}: {stem!r} is no name for a program there: {self.names}"
        for first, second in (self.pairs or {}).items():
            other = _partner(name, first, second)
            missing = other is not None and other.lower() not in {one.lower() for one in names}
            if missing and str(other).lower() in there:
                yield f"{name}: {other} must travel with it: the controller has one, and here there is none"
        if not _matches(name, self.binary):
            yield from _unwritable(name, data, encoding)

    def in_order(self, names: list[str]) -> list[str]:
        """The order in which files are written: of a pair first the one that the other needs."""
        firsts = [suffix.lower() for suffix in (self.pairs or {})]

        def place(name: str) -> tuple[str, int]:
            path = PurePosixPath(name.lower())
            return str(path.with_suffix("")), firsts.index(path.suffix) if path.suffix in firsts else len(firsts)

        return sorted(names, key=place)


def _matches(name: str, patterns: tuple[str, ...]) -> bool:
    path, base = name.lower(), PurePosixPath(name.lower()).name
    return any(fnmatchcase(path if "/" in pattern else base, pattern.lower()) for pattern in patterns)


def _partner(name: str, first: str, second: str) -> str | None:
    path = PurePosixPath(name)
    for here, there in ((first, second), (second, first)):
        if path.suffix.lower() == here.lower():
            return str(path.with_suffix(there.upper() if path.suffix.isupper() else there))
    return None


def _unwritable(name: str, data: bytes, encoding: str) -> Iterator[str]:
    """What is not in the controller's encoding, with its line: nothing is written in another one in silence."""
    try:
        data.decode(encoding)
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        yield f"{name}:{line}: byte 0x{data[error.start]:02x} is none of {encoding}, which the controller reads"


def safe_name(name: str) -> str:
    """The name of a controller's file as one for a file here. Raises GarbledError for names that lead elsewhere."""
    parts = name.replace("\\", "/").split("/")
    for part in parts:
        wrong = (
            part in ("", ".", "..")
            or len(part) > _LONGEST_NAME
            or _FORBIDDEN.search(part)
            or _RESERVED.fullmatch(part)
            or part != part.strip()
        )
        if wrong:
            raise GarbledError(f"the controller names a file {name[:_LONGEST_NAME]!r}, which is no name for one here")
    return "/".join(parts)
