"""When two listings are the same program: a controller writes what it loads anew, in its own way.

Sizes, dates, line counts and line numbers are its own; blanks and the names it gives registers, signals and frames are
no part of the program; numbers below one lose their zero, negative ones get parentheses (measured by others on
ROBOGUIDE, project CrossArm, page on the listing format).
"""

from __future__ import annotations

import re

# What a header says about the program itself; all else the controller fills in.
_KEPT = ("COMMENT", "PROTECT", "DEFAULT_GROUP", "CONTROL_CODE")
_NUMBERED = re.compile(r"^\s*\d*:")
_NAMED = re.compile(r"\b([A-Z]+\[\s*(?:\d+|[A-Z]*R\[\d+\])(?:,\s*\d+)?)\s*:[^\[\]]*\]")
_PLAIN = re.compile(r"(?<![\w.\[])(-?)0*(\d*)\.(\d+?)0*(?![\w.\]])")
_NEGATIVE = re.compile(r"(?<=[=,(])\((-[\d.]+)\)")
_VALUE = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)")
_BLANK = re.compile(r"[ \t]+")
_PROTECTED = re.compile(r"^[ \t]*PROTECT[ \t]*=[ \t]*READ[ \t]*;", re.MULTILINE)
_IS_LISTING = re.compile(rb"^[ \t]*/PROG\b", re.MULTILINE)


def is_listing(data: bytes) -> bool:
    """Is it a program as text (no log, no binary)?"""
    return _IS_LISTING.search(data[:4096]) is not None


def is_protected(text: str) -> bool:
    """Does the listing say that its program is write-protected?"""
    return _PROTECTED.search(text) is not None


def same_program(name: str, sent: bytes, found: bytes) -> bool:
    """Does the controller hold what was sent? Binary files keep every byte."""
    if sent == found:
        return True
    if not is_listing(sent) or not is_listing(found):
        return False
    return normalised(sent.decode("latin-1")) == normalised(found.decode("latin-1"))


def normalised(text: str) -> tuple[str, ...]:
    """The listing without what the controller decides."""
    kept: list[str] = []
    section = "/PROG"
    for line in text.replace("\r\n", "\n").split("\n"):
        bare = _BLANK.sub(" ", line).strip(" ")
        if not bare:
            continue
        if bare.startswith("/"):
            section = bare.split()[0].upper()
            kept.append(" ".join(bare.split(" ")[:2]).upper() if section == "/PROG" else bare)
        elif section == "/ATTR":
            name, sign, value = bare.partition("=")
            if sign and name.strip().upper() in _KEPT:
                kept.append(f"{name.strip().upper()}={value.strip(' ;')}")
        elif section == "/MN":
            kept.append(_instruction(bare))
        elif section == "/POS":
            kept += _position(bare)
        else:
            kept.append(bare)
    return tuple(kept)


def _instruction(line: str) -> str:
    """A line of the program; remarks and messages keep their spelling."""
    bare = _NUMBERED.sub("", line, count=1).strip(" ")
    if not bare.endswith(";"):
        return bare
    bare = bare[:-1].rstrip(" ")
    if bare.startswith(("!", "--", "//", "MESSAGE")):
        return bare
    bare = _NEGATIVE.sub(r"\1", _NAMED.sub(r"\1]", bare))
    return _PLAIN.sub(_number, bare).replace(" ", "")


def _number(found: re.Match[str]) -> str:
    sign, whole, rest = found[1], found[2], found[3]
    rest = "" if set(rest) <= {"0"} else rest
    return f"{sign}{whole or ('' if rest else '0')}{'.' if rest else ''}{rest}"


def _position(line: str) -> list[str]:
    """The words and numbers of a line of /POS: where lines break is the controller's."""
    named = _NAMED.sub(r"\1]", line)
    if "CONFIG" in named.upper():
        return [named.replace(" ", "").replace("\t", "")]
    return [
        _VALUE.sub(lambda found: f"{float(found[0]) + 0.0:.3f}", part).replace(" ", "")
        for part in re.split(r",", named)
        if part.strip()
    ]


def listing_of(body: str, places: str, program: str) -> str:
    """A program of this instruction (the first line of several) and these positions."""
    head = f"/PROG  {program}\n/ATTR\nPROTECT = READ_WRITE;\nDEFAULT_GROUP = 1,*,*,*,*;\n"
    return f"{head}/MN\n   1:  {body} ;\n/POS\n{places}/END\n"
