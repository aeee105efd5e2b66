"""What an ABB controller refuses when it loads a module or checks a program before it starts."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from rpl import registry
from rpl.checks.loading import (
    Listing,
    Loader,
    Place,
    Rule,
    Trust,
    having,
    longer,
    reserved,
    spelled,
    undefined,
    unlike_file,
)

_KERNEL = "Technical reference, RAPID kernel"
_LISTINGS = "public modules (115)"
_TYPE = r"[A-Za-z]\w*"
# What stands before a name where it is declared.
_HEAD = (
    r"(?:MODULE|(?:LOCAL[ \t]+|TASK[ \t]+)?"
    rf"(?:PROC|TRAP|RECORD|FUNC[ \t]+{_TYPE}|(?:CONST|PERS|VAR)[ \t]+{_TYPE}))[ \t]+"
)
# What begins and ends a scope of a module, and what is named in it.
_SECTION = re.compile(
    rf"^[ \t]*(?:MODULE[ \t]+(?P<module>\w+)|(?P<end>END(?:PROC|FUNC|TRAP|RECORD))\b"
    rf"|(?P<local>LOCAL[ \t]+)?(?:(?:PROC|TRAP|FUNC[ \t]+{_TYPE})[ \t]+(?P<routine>\w+)|RECORD[ \t]+(?P<record>\w+)"
    rf"|(?:TASK[ \t]+)?(?:CONST|PERS|VAR)[ \t]+{_TYPE}[ \t]+(?P<datum>\w+)))",
    re.MULTILINE | re.IGNORECASE,
)
_BLANKS = re.compile(r"(?P<text>\"(?:[^\"\r\n]|\"\")*\")|![^\r\n]*")


def _symbols(listing: Listing) -> Iterator[tuple[str, Place, int]]:
    """What a module names, with its kind, and how deep: 0 for what other modules see, 1 for LOCAL, and from 2 on each
    routine by itself."""
    inside, routines = False, 1
    for found in _SECTION.finditer(listing.code):
        kind = found.lastgroup or ""
        if kind == "end":
            inside = False
            continue
        depth = routines if inside else int(found["local"] is not None)
        yield kind, Place(listing, *found.span(kind)), depth
        if kind in ("routine", "record"):
            inside, routines = True, routines + 1


def _twice_named(listings: Sequence[Listing]) -> Iterator[Place]:
    """Modules and names that all modules see, named a second time; LOCAL ones and those of a routine in their place.
    A module with a `main` of its own belongs to a task of its own, where the program has several."""
    shared: set[str] = set()
    alone = sum(map(_has_main, listings)) > 1
    for listing in sorted(listings, key=_has_main):
        own: dict[int, set[str]] = {0: set(shared) if alone and _has_main(listing) else shared}
        for _, place, depth in _symbols(listing):
            name = spelled(place, False)
            known = own.setdefault(depth, set())
            if name in known:
                yield place
            known.add(name)


def _has_main(listing: Listing) -> bool:
    return any(
        kind == "routine" and depth < 2 and spelled(place, False) == "main" for kind, place, depth in _symbols(listing)
    )


def _data_behind(listings: Sequence[Listing]) -> Iterator[Place]:
    """Data and records of a module behind its first routine."""
    for listing in listings:
        begun = False
        for kind, place, depth in _symbols(listing):
            begun = begun or kind == "routine"
            if begun and kind in ("datum", "record") and depth < 2:
                yield place


def _mains(listings: Sequence[Listing]) -> Iterator[Place]:
    """Modules with routines, none of which is `main`: the first routine is named."""
    routines = [
        place for listing in listings for kind, place, depth in _symbols(listing) if kind == "routine" and depth < 2
    ]
    if routines and all(spelled(place, False) != "main" for place in routines):
        yield routines[0]


RULES = (
    Rule(
        "rapid-named-twice",
        "a module, a routine and a datum that other modules see have names of their own",
        "the module is not loaded: name is ambiguous",
        "give one of them another name, or write LOCAL",
        f"{_KERNEL}; {_LISTINGS}: module and routine of one name in 0 of 372",
        Trust.MANUAL,
        _twice_named,
    ),
    Rule(
        "rapid-main",
        "a task has a PROC main()",
        "the program pointer cannot be set to main",
        "write PROC main() that calls the routine",
        _KERNEL,
        Trust.MANUAL,
        _mains,
        option=True,
    ),
    Rule(
        "rapid-index",
        "the indices of an array stand in one pair of braces",
        "syntax error, the module is not loaded",
        "write x{i,j}",
        _KERNEL,
        Trust.MANUAL,
        having(r"(\}[ \t]*\{)"),
    ),
    Rule(
        "rapid-name-length",
        "a name has at most 32 characters",
        "syntax error, the module is not loaded; 16 before RobotWare 5",
        "shorten the name",
        _KERNEL,
        Trust.MANUAL,
        longer(rf"^[ \t]*{_HEAD}(\w+)", 32),
    ),
    Rule(
        "rapid-reserved",
        "a reserved word names nothing",
        "syntax error, the module is not loaded",
        "take another name",
        _KERNEL,
        Trust.MANUAL,
        reserved(rf"^[ \t]*{_HEAD}(\w+)", registry.words("rapid").listed("reserved")),
    ),
    Rule(
        "rapid-order",
        "a module has its records first, then its data, then its routines",
        "syntax error, the module is not loaded",
        "move the data to the module's head",
        _KERNEL,
        Trust.MANUAL,
        _data_behind,
    ),
    Rule(
        "rapid-text-length",
        "a text has at most 80 characters",
        "syntax error, the module is not loaded",
        "write it as two texts",
        _KERNEL,
        Trust.MANUAL,
        longer(r"\"((?:[^\"\r\n]|\"\")*)\"", 80),
    ),
    Rule(
        "rapid-label",
        "each label that GOTO names stands in the module",
        "reference error when the program is checked",
        "write the label",
        _KERNEL,
        Trust.MANUAL,
        undefined(r"\bGOTO[ \t]+(\w+)[ \t]*;", r"^[ \t]*(\w+):(?!=)"),
    ),
    Rule(
        "rapid-file-name",
        "a file is called as its module",
        "loads under the name of the module; saving makes a second file",
        "rename the file",
        f"{_LISTINGS}",
        Trust.COUNTED,
        unlike_file(r"^[ \t]*MODULE[ \t]+(\w+)"),
    ),
)
LOADER = Loader(RULES, _BLANKS)
