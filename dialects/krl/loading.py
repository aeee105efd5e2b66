"""What a KUKA controller refuses when it loads and links a module (KSS 5 to 8)."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

from rpl import registry
from rpl.checks.loading import (
    Listing,
    Loader,
    Place,
    Rule,
    Trust,
    beyond,
    having,
    longer,
    reserved,
    spelled,
    twice,
    undefined,
    unlike_file,
)

_GUIDE = "KRL reference guide"
_EXPERT = "expert programming manual"
_PROGRAMS = "public modules (385)"
_TYPE = r"[A-Z_]\w*"
_HEAD = r"^[ \t]*(?:GLOBAL[ \t]+)?(?:DEFDAT|DEFFCT[ \t]+[A-Z_]\w*(?:\[[^\]]*\])?|DEF)[ \t]+"
_ROUTINE = re.compile(
    r"^[ \t]*(?P<open>GLOBAL[ \t]+)?(?:DEFFCT[ \t]+[A-Z_]\w*(?:\[[^\]]*\])?|DEF)[ \t]+(?P<name>[A-Z_$]\w*)[^\r\n]*"
    r"(?P<body>.*?)^[ \t]*END(?:FCT)?\b",
    re.MULTILINE | re.IGNORECASE | re.DOTALL,
)
_DECLARED = rf"^[ \t]*(?:GLOBAL[ \t]+)?(?:DECL[ \t]+(?:GLOBAL[ \t]+)?(?:CONST[ \t]+)?{_TYPE}|SIGNAL|STRUC|ENUM)[ \t]+"
_LIST = re.compile(r"^[ \t]*DEFDAT[ \t]+(?P<name>[\w$]+)[ \t]*(?P<open>PUBLIC\b)?", re.MULTILINE | re.IGNORECASE)
_GLOBAL = re.compile(r"^[ \t]*(?:DECL[ \t]+)?GLOBAL\b", re.MULTILINE | re.IGNORECASE)
_NAMES_TWICE = twice(rf"{_DECLARED}([A-Z_]\w*)")
_BLANKS = re.compile(r"(?P<text>\"[^\"\r\n]*\")|;[^\r\n]*|^&[^\r\n]*", re.MULTILINE)


def _routines(listing: Listing) -> Iterator[tuple[Place, bool, bool]]:
    """Each routine of a file: its name, whether all modules see it, whether it does anything."""
    for number, found in enumerate(_ROUTINE.finditer(listing.code)):
        named = Place(listing, *found.span("name"))
        seen = bool(found["open"]) or (number == 0 and _is_program(listing))
        yield named, seen, bool(found["body"].strip())


def _is_program(listing: Listing) -> bool:
    return Path(listing.source.path).suffix.lower() in (".src", ".sub")


def _twice_seen(listings: Sequence[Listing]) -> Iterator[Place]:
    """Routines that all modules see, named a second time, and routines of a file that bear one name."""
    everywhere: set[str] = set()
    for listing in listings:
        own: set[str] = set()
        for named, seen, _ in _routines(listing):
            name = spelled(named, False)
            if name in own or (seen and name in everywhere):
                yield named
            own.add(name)
            everywhere |= {name} if seen else set()


def _work_elsewhere(listings: Sequence[Listing]) -> Iterator[Place]:
    """The empty first routine of a file whose work is in a `main` behind it."""
    for listing in listings:
        routines = list(_routines(listing))
        others = {spelled(named, False) for named, _, works in routines[1:] if works}
        if routines and not routines[0][2] and "main" in others:
            yield routines[0][0]


def _lists(listings: Sequence[Listing]) -> Iterator[tuple[Listing, re.Match[str]]]:
    """The files that are data lists, with their heads; the system's own is seen by all."""
    for listing in listings:
        head = _LIST.search(listing.code)
        if head is not None:
            yield listing, head


def _hidden(listings: Sequence[Listing]) -> Iterator[Place]:
    """Data lists that are not PUBLIC and hold GLOBAL data."""
    for listing, head in _lists(listings):
        if head["open"] is None and head["name"].upper() != "$CONFIG" and _GLOBAL.search(listing.code):
            yield Place(listing, *head.span("name"))


def _declared_twice(listings: Sequence[Listing]) -> Iterator[Place]:
    """Names that one data list declares a second time."""
    return (place for listing, _ in _lists(listings) for place in _NAMES_TWICE([listing]))


RULES = (
    Rule(
        "krl-named-twice",
        "routines that all modules see have names of their own",
        "the module is not linked: name declared several times",
        "give one of them another name, or take GLOBAL away",
        _GUIDE,
        Trust.MANUAL,
        _twice_seen,
    ),
    Rule(
        "krl-file-name",
        "the first routine is called as its file, the data list as well",
        "the module is not linked",
        "rename the file or the routine",
        _GUIDE,
        Trust.MANUAL,
        unlike_file(rf"{_HEAD}([\w$]+)"),
    ),
    Rule(
        "krl-work",
        "the work stands in the routine that is called as the file",
        "loads; who selects the module starts an empty routine",
        "move the body there",
        f"{_PROGRAMS}",
        Trust.COUNTED,
        _work_elsewhere,
    ),
    Rule(
        "krl-name-length",
        "a name has at most 24 characters",
        "the module is not linked: name too long",
        "shorten the name",
        _GUIDE,
        Trust.MANUAL,
        longer(r"(?<![\w$#'])([A-Z_$]\w*)", 24),
    ),
    Rule(
        "krl-reserved",
        "a word of the language names nothing",
        "the module is not linked",
        "take another name",
        _GUIDE,
        Trust.MANUAL,
        reserved(rf"(?:{_HEAD}|{_DECLARED})([A-Z_]\w*)", registry.words("krl").listed("reserved")),
    ),
    Rule(
        "krl-line",
        "a line has at most 474 characters",
        "the rest of the line is lost",
        "write it in two statements",
        _GUIDE,
        Trust.MANUAL,
        longer(r"^([^\r\n]*)", 474, whole=True),
    ),
    Rule(
        "krl-label",
        "each label that GOTO names stands in the file",
        "the module is not linked",
        "write the label",
        _GUIDE,
        Trust.MANUAL,
        undefined(r"\bGOTO[ \t]+(\w+)", r"^[ \t]*(\w+)[ \t]*:(?![=IO])"),
    ),
    Rule(
        "krl-public",
        "GLOBAL data stand in a data list that is PUBLIC",
        "the module is not linked",
        "write DEFDAT NAME PUBLIC",
        _GUIDE,
        Trust.MANUAL,
        _hidden,
    ),
    Rule(
        "krl-priority",
        "interrupts have priorities 1, 2, 4 to 39 or 81 to 128",
        "the program stops at the declaration",
        "take another priority",
        _EXPERT,
        Trust.MANUAL,
        beyond(r"\bINTERRUPT[ \t]+DECL[ \t]+(\d+)", 1, 128),
    ),
    Rule(
        "krl-priority-reserved",
        "priorities 3 and 40 to 80 are the system's",
        "the program stops at the declaration",
        "take another priority",
        _EXPERT,
        Trust.MANUAL,
        having(r"\bINTERRUPT[ \t]+DECL[ \t]+(3|[4-7]\d|80)\b(?![^\r\n]*\$STOPMESS)"),
    ),
    Rule(
        "krl-declared-twice",
        "a name is declared once in a data list",
        "the module is not linked",
        "take one of them away",
        _GUIDE,
        Trust.MANUAL,
        _declared_twice,
    ),
)
LOADER = Loader(RULES, _BLANKS)
