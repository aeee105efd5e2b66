"""What an Adept V+ system refuses when it loads programs."""

from __future__ import annotations

import re

from rpl import registry
from rpl.checks.loading import Loader, Rule, Trust, longer, outside, twice, undefined

_GUIDE = "V+ language user's guide"
_NAME_LENGTH = int(registry.words("vplus").numbers("numbers")["name_length"])
_BLANKS = re.compile(r"(?P<text>\"[^\"\r\n]*\")|;[^\r\n]*")

RULES = (
    Rule(
        "vplus-name-length",
        f"a name has at most {_NAME_LENGTH} characters",
        "the rest is cut without a word, so two names may become one",
        "shorten the name",
        _GUIDE,
        Trust.MANUAL,
        longer(r"(?<![\w.#$%])[#$%]?([A-Z][\w.]*)", _NAME_LENGTH),
    ),
    Rule(
        "vplus-program-once",
        "programs have names of their own",
        "the second one is not loaded",
        "rename one of them",
        _GUIDE,
        Trust.MANUAL,
        twice(r"^\.PROGRAM[ \t]+([\w.]+)", among_all=True),
    ),
    Rule(
        "vplus-text-length",
        "a text has at most 128 characters",
        "the line is marked as wrong and the program does not run",
        "write it as two texts",
        _GUIDE,
        Trust.MANUAL,
        longer(r"\"([^\"\r\n]*)\"", 128),
    ),
    Rule(
        "vplus-line",
        "a line has at most 150 characters",
        "the line is cut",
        "write it in two statements",
        _GUIDE,
        Trust.M,
        longer(r"^([^\r\n]*)", 150, whole=True),
    ),
    Rule(
        "vplus-label",
        "each label that GOTO names stands in the file",
        "the program does not run",
        "write the label",
        _GUIDE,
        Trust.MANUAL,
        undefined(r"\bGOTO[ \t]+(\d+)", r"^[ \t]*(\d+)(?=\s)"),
    ),
    Rule(
        "vplus-characters",
        "a program is of ASCII characters",
        "shown as other characters",
        "write them out",
        _GUIDE,
        Trust.M,
        outside(r"\x00-\x7f"),
    ),
)
LOADER = Loader(RULES, _BLANKS)
