"""What a FANUC controller refuses when it loads a listing, and what loads but stops when it runs.

`measured`: by others on virtual controllers with standard options (public project CrossArm, release 1.5, its page
validation); a controller with other options or other software may take more or less.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from rpl import registry
from rpl.checks.loading import Listing, Loader, Place, Rule, Trust, beyond, having, longer, twice, undefined
from rpl.source import Source

_LINE = r"^[ \t]*\d*:[ \t]*"
_INDEX = r"\[(?:[^\[\]\r\n]|\[[^\[\]\r\n]*\])*\]"
_CROSSARM, _LISTINGS = "CrossArm validation, LS format", "public listings (650 programs)"
_FUNCTIONS = "|".join(sorted(registry.words("tp").pairs("functions"), key=len, reverse=True))
_ARGUMENT = rf"(?:A?R{_INDEX})"

_BLANKS = re.compile(
    r"(?P<text>'[^'\r\n]*'|\"[^\"\r\n]*\")"
    r"|(?<=:)[ \t]*(?:!|--|//)[^;\r\n]*"
    r"|(?<=MESSAGE\[)[^\]\r\n]*"
    r"|(?:(?<=\[\d)|(?<=\[\d\d)|(?<=\[\d{3})|(?<=\[\d{4})|(?<=\[\d{5}))[ \t]*:[^\]\r\n]*"
)
_CALCULATION = re.compile(rf"{_LINE}((?:A?R|PR|GO|AO){_INDEX}[ \t]*=[^;\r\n]*)", re.MULTILINE)
_SUMS, _PRODUCTS = re.compile(r"[+-]"), re.compile(r"[*/]|\bDIV\b|\bMOD\b")


def _listing(source: Source) -> bool:
    return re.search(r"^[ \t\ufeff]*/(?:PROG|MN)\b", source.text, re.MULTILINE) is not None


def _families(listings: Sequence[Listing]) -> Iterator[Place]:
    """Calculations without parentheses that mix sums and products."""
    for listing in listings:
        for found in _CALCULATION.finditer(listing.code):
            value = found[1].split("=", 1)[1]
            bare = re.sub(r"\(-[\d.]+\)", "0", value)
            while (less := re.sub(r"\[[^\[\]]*\]", "", bare)) != bare:
                bare = less
            if "(" not in bare and _SUMS.search(bare) and _PRODUCTS.search(bare):
                yield Place(listing, *found.span(1))


RULES = (
    Rule(
        "tp-flag-condition",
        "a flag in a condition stands in parentheses",
        "not taken as a comparison: real listings have IF (F[1]),JMP only",
        "write IF (F[1]),JMP LBL[1] or WAIT (!F[1])",
        f"{_LISTINGS}; {_CROSSARM} 26",
        Trust.COUNTED,
        having(rf"{_LINE}((?:IF|WAIT)\b(?![ \t]*\()[^;\r\n]*?(?<![A-Z])F{_INDEX}[ \t]*(?:=|<>)[^,;\r\n]*)"),
    ),
    Rule(
        "tp-flag-value",
        "a flag is set to a value in parentheses",
        "only the form with parentheses is stored as it was written",
        "write F[1]=(ON)",
        f"{_CROSSARM} 26",
        Trust.MEASURED,
        having(rf"{_LINE}(F{_INDEX}[ \t]*=[ \t]*(?!\()[^;\r\n]*)"),
    ),
    Rule(
        "tp-function-argument",
        "the argument of a function is a register R[n] or AR[n]",
        "ASBN-092 undefined instruction",
        "put the value into a register on a line before",
        f"{_LISTINGS}; {_CROSSARM} 15",
        Trust.COUNTED,
        having(rf"\b((?:{_FUNCTIONS})\[(?!{_ARGUMENT}(?:\]|,[ \t]*{_ARGUMENT}\]))[^;\r\n]*)"),
    ),
    Rule(
        "tp-function-option",
        "functions of numbers are an option of the controller",
        "ASBN-092 undefined instruction",
        "ask for the option, or calculate without SIN, SQRT and their like",
        f"{_CROSSARM} 15",
        Trust.MEASURED,
        having(rf"\b((?:{_FUNCTIONS})\[)"),
        option=True,
    ),
    Rule(
        "tp-text-argument",
        "a function of texts takes registers",
        "ASBN-092 undefined instruction",
        "pass the text as argument of a CALL and use AR[n] there",
        f"{_CROSSARM} 24",
        Trust.MEASURED,
        having(r"\b((?:STRLEN|SUBSTR|FINDSTR)\b[^;\r\n]*')"),
    ),
    Rule(
        "tp-text-constant",
        "a string register is set from a register, no text in the line",
        "ASBN-092 undefined instruction",
        "pass the text as argument of a CALL: SR[AR[1]]=AR[2] there",
        f"{_CROSSARM} 24",
        Trust.MEASURED,
        having(rf"{_LINE}(SR{_INDEX}[ \t]*=(?![ \t]*(?:SUBSTR|FINDSTR|STRLEN))[^;\r\n]*')"),
    ),
    Rule(
        "tp-text-comparison",
        "texts are compared by IF SR[a]=SR[b],JMP LBL[n] and <> only",
        "ASBN-092 undefined instruction",
        "keep the text in a string register and jump",
        f"{_CROSSARM} 24",
        Trust.MEASURED,
        having(
            rf"{_LINE}((?:SELECT[ \t]+SR|IF[ \t]+SR{_INDEX}[ \t]*(?:=|<>)[ \t]*'"
            rf"|(?:IF|WAIT|F{_INDEX}[ \t]*=)[ \t]*\([^;\r\n]*SR\[)[^;\r\n]*)"
        ),
    ),
    Rule(
        "tp-negative",
        "a negative number stands in parentheses",
        "refused in CALL and FOR; stops the program in a condition (INTP-202)",
        "write (-30)",
        f"{_CROSSARM} 7, 34",
        Trust.MEASURED,
        having(
            r"(\bCALL[ \t]+[\w-]+\((?:-[\d.]|[^;\r\n]*,[ \t]*-[\d.])"
            r"|\bFOR\b[^;\r\n]*(?:=|TO)[ \t]*-[\d.]"
            r"|\b(?:IF|WAIT)\b[^;\r\n]*[<>=][ \t]*-[\d.])"
        ),
    ),
    Rule(
        "tp-families",
        "without parentheses a calculation is of sums or of products only",
        "ASBN-040",
        "put the whole value in parentheses",
        f"{_CROSSARM}",
        Trust.MEASURED,
        _families,
    ),
    Rule(
        "tp-and-or",
        "without parentheses a condition has only AND or only OR",
        "ASBN-092 undefined instruction",
        "put the whole condition in parentheses",
        "manual of the pendant, mixed logic",
        Trust.MANUAL,
        having(
            rf"{_LINE}((?:IF|WAIT)\b(?![ \t]*\()[^,;\r\n]*"
            r"(?:\bAND\b[^,;\r\n]*\bOR\b|\bOR\b[^,;\r\n]*\bAND\b)[^,;\r\n]*)"
        ),
    ),
    Rule(
        "tp-position-product",
        "position registers are added and subtracted only",
        "INTP-202 when the line runs, or refused",
        "use Tool_Offset,PR[n], Offset,PR[n] or a frame",
        f"{_CROSSARM} 15",
        Trust.MEASURED,
        having(rf"{_LINE}(PR\[\d+[ \t]*\][ \t]*=[ \t]*PR\[\d+[ \t]*\][ \t]*[*/:][^;\r\n]*)"),
    ),
    Rule(
        "tp-group-value",
        "a group output is set from a number or a register",
        "refused",
        "put the input into a register first",
        f"{_CROSSARM} 10",
        Trust.MEASURED,
        having(rf"{_LINE}(GO{_INDEX}[ \t]*=[ \t]*[AG][IO]{_INDEX})"),
    ),
    Rule(
        "tp-analog-value",
        "an analogue output is set from a number or a register",
        "refused",
        "calculate in a register first",
        f"{_CROSSARM} 17",
        Trust.MEASURED,
        having(rf"{_LINE}(AO{_INDEX}[ \t]*=[ \t]*(?!\(?-?[\d.]+\)?[ \t]*;|A?R{_INDEX}[ \t]*;)[^;\r\n]*)"),
    ),
    Rule(
        "tp-number",
        "a whole number is between -2147483647 and 2147483646",
        "stored as ******** or as another number",
        "use a smaller number",
        f"{_CROSSARM} 24",
        Trust.MEASURED,
        beyond(rf"{_LINE}R{_INDEX}[ \t]*=[ \t]*\(?(-?\d{{10,}})\)?[ \t]*;", -2147483647, 2147483646),
    ),
    Rule(
        "tp-speed-argument",
        "a speed or a rounding is a number or a register R[n]",
        "refused",
        "copy the argument to a register",
        f"{_CROSSARM} 32",
        Trust.MEASURED,
        having(r"(\bAR\[\d+[ \t]*\](?:mm/sec|%|sec)|\bCNT[ \t]*AR\[)"),
    ),
    Rule(
        "tp-distance-decimals",
        "a distance before the end of a move has its decimals",
        "not written so by any controller",
        "write DB 70.0mm",
        f"{_LISTINGS}",
        Trust.COUNTED,
        having(r"\b(DB[ \t]+\d+mm)"),
    ),
    Rule(
        "tp-corner-region",
        "CR and CD are paid options",
        "refused where the option is not there",
        "write CNT",
        f"{_LISTINGS}: 0 of 5,591 moves",
        Trust.COUNTED,
        having(rf"\b((?:CR|CD)(?:\d+|{_INDEX}))(?=[ \t;])"),
        option=True,
    ),
    Rule(
        "tp-pulse",
        "a pulse lasts from 0.1 to 25.5 s",
        "refused; a shorter one gets the controller's default",
        "switch on, wait, switch off",
        f"{_CROSSARM} 17",
        Trust.MEASURED,
        beyond(r"\bPULSE,[ \t]*([\d.]+)sec", 0.05, 25.5),
    ),
    Rule(
        "tp-text-length",
        "a text as argument has at most 38 characters",
        "refused",
        "pass it in two pieces",
        f"{_CROSSARM} 7",
        Trust.MEASURED,
        longer(r"[(,][ \t]*'([^'\r\n]*)'", 38),
    ),
    Rule(
        "tp-time-limit",
        "$WAITTMOUT can be set by programs",
        "VARS-010 when the line runs on some controllers; 59 public programs set it",
        "where it is write-protected: a loop on a TIMER",
        f"{_CROSSARM} 9; {_LISTINGS}",
        Trust.MEASURED,
        having(r"(\$WAITTMOUT[ \t]*=)"),
        option=True,
    ),
    Rule(
        "tp-system-variable",
        "the number of the frame, tool or load in force cannot be asked for",
        "INTP-103 with VARS-034 when the line runs",
        "keep the number in a register where it is set",
        "CrossArm, tools/make_sysvar_probe.py",
        Trust.MEASURED,
        having(r"(\$(?:MNUTOOLNUM|MNUFRAMENUM|PLST_PARNUM)\[[^\]\r\n]*\]|\$MSKKEY\w*)"),
    ),
    Rule(
        "tp-position",
        "each P[n] of a program is in its /POS",
        "the line stops: the position is not taught",
        "teach the position",
        "every exported listing",
        Trust.COUNTED,
        undefined(r"(?<![A-Z\"])P\[(\d+)[ \t]*\](?![ \t]*\{)", r"^[ \t]*P\[(\d+)[ \t]*\][ \t]*\{"),
    ),
    Rule(
        "tp-position-number",
        "the number of a position is at most 32766",
        "not loaded: numbers have 16 bits",
        "split the program and call its parts",
        "authors of another postprocessor (Institut Maupertuis, issue 43 of fanuc_post_processor)",
        Trust.M,
        beyond(r"^[ \t]*P\[(\d+)[ \t]*\][ \t]*\{", 1, 32766),
    ),
    Rule(
        "tp-label",
        "each label that is jumped to stands in the program",
        "the jump stops the program",
        "write the label",
        "manual of the pendant",
        Trust.MANUAL,
        undefined(r"(?:\bJMP[ \t]+|,[ \t]*)LBL\[(\d+)", rf"{_LINE}LBL\[(\d+)"),
    ),
    Rule(
        "tp-label-once",
        "a label stands once in a program",
        "refused",
        "give one of them another number",
        "manual of the pendant",
        Trust.MANUAL,
        twice(rf"{_LINE}LBL\[(\d+)"),
    ),
    Rule(
        "tp-name",
        "a program's name has at most 36 capitals, digits, _ and -, a letter first",
        "refused; controllers before R-30iA take 8",
        "shorten the name",
        "manual of the pendant",
        Trust.MANUAL,
        having(r"^[ \t]*/PROG[ \t]+(?-i:(?![A-Z_-][A-Z0-9_-]{0,35}(?:\s|$)))(\S+)"),
    ),
    Rule(
        "tp-remark",
        "a remark has at most 32 characters",
        "cut",
        "write two remarks",
        f"{_LISTINGS}",
        Trust.COUNTED,
        longer(r"^[ \t]*\d+:[ \t]*!([^\r\n]*?)[ \t]*;[ \t]*\r?$", 32, whole=True),
    ),
    Rule(
        "tp-comment",
        "comments of programs, registers, signals and labels have at most 16 characters",
        "cut",
        "shorten the comment",
        f"{_CROSSARM}",
        Trust.MEASURED,
        longer(r"(?:^COMMENT[ \t]*=[ \t]*\"|\b[A-Z]+\[\d+:\"?)([^\]\r\n\"']*)(?=\"|\])", 16, whole=True),
    ),
    Rule(
        "tp-message",
        "a message has at most 24 characters",
        "cut without a word",
        "show it in two messages",
        f"{_CROSSARM} 2",
        Trust.MEASURED,
        longer(r"\bMESSAGE\[([^\]\r\n]*)\]", 24, whole=True),
    ),
    Rule(
        "tp-call",
        "each called program is on the controller",
        "INTP-222 with MEMO-073 at the CALL",
        "load it as well",
        f"{_CROSSARM}",
        Trust.MEASURED,
        undefined(r"\b(?:CALL|RUN)[ \t]+([A-Z_][\w-]*)", r"^[ \t]*/PROG[ \t]+(\S+)", among_all=True),
        option=True,
    ),
    Rule(
        "tp-frame-number",
        "10 tools, 9 frames and 10 loads are there as delivered",
        "refused; more can be had at a controlled start",
        "raise $SCR.$MAXNUMUTOOL or $MAXNUMUFRAM",
        f"{_CROSSARM} 10, 17",
        Trust.MEASURED,
        having(
            r"\b(UTOOL_NUM[ \t]*=[ \t]*(?:1[1-9]|[2-9]\d)|UFRAME_NUM[ \t]*=[ \t]*[1-9]\d|PAYLOAD\[(?:1[1-9]|[2-9]\d)\])"
        ),
        option=True,
    ),
)
LOADER = Loader(RULES, _BLANKS, _listing)
