"""What a UR controller refuses when a script is sent to it or inserted in a program."""

from __future__ import annotations

import re

from rpl.checks.loading import Loader, Rule, Trust, having, outside, reserved, twice

_MANUAL = "URScript manual"
_KEYWORDS = (
    "and break continue def elif else end enter_critical exit_critical False global halt if in join kill local not or "
    "pass return run sec sync thread True while xor"
)
_BLANKS = re.compile(r"(?P<text>\"[^\"\r\n]*\"|'[^'\r\n]*')|#[^\r\n]*")

RULES = (
    Rule(
        "urscript-characters",
        "a script is of ASCII characters",
        "the script is refused by the parser",
        "write them out",
        _MANUAL,
        Trust.MANUAL,
        outside(r"\x00-\x7f"),
    ),
    Rule(
        "urscript-reserved",
        "a keyword names nothing",
        "syntax error, nothing runs",
        "take another name",
        _MANUAL,
        Trust.MANUAL,
        reserved(r"^[ \t]*(?:def|thread|sec|global|local)[ \t]+(\w+)", _KEYWORDS.split(), capitals=True),
    ),
    Rule(
        "urscript-name",
        "a name is of letters, digits and _, a letter or _ first",
        "syntax error, nothing runs",
        "take another name",
        _MANUAL,
        Trust.MANUAL,
        having(r"^[ \t]*(?:def|thread|sec|global|local)[ \t]+(?![A-Za-z_]\w*\b)(\S+)"),
    ),
    Rule(
        "urscript-defined-twice",
        "functions and threads of a program have names of their own",
        "compile error: name is defined already",
        "rename one of them",
        _MANUAL,
        Trust.M,
        twice(r"^[ \t]*(?:def|thread)[ \t]+(\w+)", capitals=True),
    ),
)
LOADER = Loader(RULES, _BLANKS)
