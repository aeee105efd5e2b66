"""Files that stand beside robot programs and are none: what this package writes or is given besides programs.

A folder may hold them, so they are no strangers there; one that is given as a program is refused by what it is. No
language's files look like this, so the name of a language does not make programs of them either.
"""

from __future__ import annotations

import json
from dataclasses import dataclass

from rpl.errors import UsageError
from rpl.source import Source
from rpl.tomlfile import TomlError, read_toml

# A first line longer than this is no event of a trace.
_LONGEST_EVENT = 100_000


@dataclass(frozen=True, slots=True)
class SideFile:
    """What a file is, and what to do with it. `own`: a part of our own projects, not worth a note in a folder."""

    kind: str
    use: str
    own: bool = True


MAP = SideFile("the map of names and numbers that a translation wrote", "translate takes it with --map")
CELL = SideFile("a cell file", "run, translate and prove take it with --cell")
ROBOT = SideFile("a robot file", "give it with --robot")
CONTROLLER = SideFile("a controller file", "run, prove and fit take it with --controller")
EXPECTED = SideFile("what a run of the program beside it must show", "give the program or the folder")
TRACE = SideFile("the trace of a run", "give the program that was run")
URDF = SideFile("a robot description (URDF)", "give it with --robot", own=False)
SETTINGS = SideFile("settings in TOML", "give the program", own=False)
DATA = SideFile("data in JSON", "give the program", own=False)
PAGE = SideFile("a page in HTML", "give the program", own=False)


def side_file(source: Source) -> SideFile | None:
    """What the file is, if by its content (and for TOML its name) it is one that stands beside programs."""
    path, text = source.path.lower(), source.text
    head = text[:200].lstrip("\ufeff \t\r\n").lower()
    if path.endswith(".toml"):
        return _toml(source)
    if head.startswith("<!doctype html"):
        return PAGE
    if path.endswith(".urdf") or head.startswith("<robot"):
        return URDF
    if head.startswith("{"):
        return _json(text)
    return None


def _toml(source: Source) -> SideFile | None:
    """Which of the files in TOML it is; by its keys, because wrong values do not make another file of it."""
    try:
        keys = set(read_toml(source.text))
    except TomlError:
        return SETTINGS
    from rpl.cell import parse_cell
    from rpl.motionmodel import UNCERTAIN
    from rpl.writing.namemap import is_map

    if is_map(dict.fromkeys(keys)):
        return MAP
    if {"kind", "geometry", "axes"} <= keys:
        return ROBOT
    if {"status", "title"} <= keys:
        return EXPECTED
    if keys & {"uncertainty", *UNCERTAIN}:
        return CONTROLLER
    try:
        parse_cell(source.text, source.path)
    except UsageError:
        return SETTINGS
    return CELL


def _json(text: str) -> SideFile | None:
    """A trace has an event a line; else one document."""
    first = text[: text.find("\n") + 1 or len(text)]
    for part in (first, text):
        if len(part) > _LONGEST_EVENT and part is first:
            continue
        try:
            document = json.loads(part)
        except (ValueError, RecursionError):
            continue
        if isinstance(document, dict):
            return TRACE if {"t", "task", "kind"} <= set(document) else DATA
    return None
