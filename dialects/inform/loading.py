"""What a Yaskawa controller refuses when it loads a job (NX100 to YRC1000)."""

from __future__ import annotations

import re

from rpl.checks.loading import (
    Loader,
    Rule,
    Trust,
    beyond,
    having,
    longer,
    miscounted,
    outside,
    twice,
    undefined,
    unlike_file,
    used_again,
)
from rpl.source import Source

_FORMAT = "NX100 and DX100 data transmission manuals"
_MANUAL = "operator's manuals"
_JOBS = "public jobs (140)"
_BLANKS = re.compile(r"(?P<text>\"[^\"\r\n]*\")|^'[^\r\n]*|(?<=[ \t])//[^\r\n]*|^///COMM[^\r\n]*", re.MULTILINE)


def _job(source: Source) -> bool:
    return re.search(r"^[ \t\ufeff]*/JOB\b", source.text, re.MULTILINE) is not None


RULES = (
    Rule(
        "inform-step-position",
        "each step has a position C of its own",
        "not so written by any controller: editing a step changes its position",
        "give each step its position",
        f"0 of {_JOBS}",
        Trust.COUNTED,
        used_again(r"^[ \t]*(?:MOV[JLCS]|REFP|IMOV)\b[^\r\n]*?[ \t](C\d+)"),
    ),
    Rule(
        "inform-positions",
        "the first number of ///NPOS is that of the C lines",
        "the job is not loaded",
        "count the C lines",
        _FORMAT,
        Trust.MANUAL,
        miscounted(r"^///NPOS[ \t]+(\d+)", r"^C\d+[ \t]*="),
    ),
    Rule(
        "inform-position",
        "each C that is used stands under //POS",
        "the job is not loaded",
        "write its line",
        _FORMAT,
        Trust.MANUAL,
        undefined(r"^[ \t]*(?:[A-Z]+)\b[^\r\n=]*?[ \t]C(\d+)\b", r"^C(\d+)[ \t]*="),
    ),
    Rule(
        "inform-name",
        "a job's name has at most 32 characters (8 on NX100)",
        "the job is not loaded",
        "shorten the name",
        _FORMAT,
        Trust.MANUAL,
        longer(r"^//NAME[ \t]+([^\r\n]*?)[ \t]*\r?$", 32),
    ),
    Rule(
        "inform-name-characters",
        "a job's name is of capitals, digits, _ and -",
        "the job is not loaded",
        "rename it",
        _FORMAT,
        Trust.M,
        having(r"^//NAME[ \t]+(?-i:(?![A-Z0-9_-]+\s*$))(\S[^\r\n]*)"),
    ),
    Rule(
        "inform-file-name",
        "a file is called as its job",
        "the job is not loaded",
        "rename the file",
        f"{_JOBS}",
        Trust.COUNTED,
        unlike_file(r"^//NAME[ \t]+(\S+)"),
    ),
    Rule(
        "inform-remark",
        "a remark has at most 32 characters",
        "the job is not loaded, or the remark is cut",
        "write two remarks",
        _MANUAL,
        Trust.MANUAL,
        longer(r"^[ \t]*'([^\r\n]*?)[ \t]*\r?$", 32, whole=True),
    ),
    Rule(
        "inform-comment",
        "a job's comment has at most 32 characters",
        "the job is not loaded, or the comment is cut",
        "shorten the comment",
        _FORMAT,
        Trust.MANUAL,
        longer(r"^///COMM[ \t]+([^\r\n]*?)[ \t]*\r?$", 32, whole=True),
    ),
    Rule(
        "inform-label",
        "each label that is jumped to stands in the job",
        "the job is not loaded",
        "write the label",
        _MANUAL,
        Trust.MANUAL,
        undefined(r"\bJUMP[ \t]+\*(\S+)", r"^[ \t]*\*(\S+)"),
    ),
    Rule(
        "inform-label-once",
        "a label stands once in a job",
        "the job is not loaded",
        "rename one of them",
        _MANUAL,
        Trust.MANUAL,
        twice(r"^[ \t]*\*(\S+)"),
    ),
    Rule(
        "inform-label-length",
        "a label has at most 8 characters",
        "the job is not loaded",
        "shorten the label",
        _MANUAL,
        Trust.MANUAL,
        longer(r"^[ \t]*\*(\S+)", 8),
    ),
    Rule(
        "inform-relative",
        "a job whose steps are Cartesian (C, not variables P) is relative and names its frame",
        "its positions are not loaded",
        "write ///ATTR SC,RW,RJ and ////FRAME USER 1 (or BASE)",
        f"{_FORMAT}; {_JOBS}",
        Trust.COUNTED,
        having(
            r"^///POSTYPE[ \t]+(?:BASE|ROBOT|USER|MTOOL|TOOL)\b(?=(?:(?!^///POSTYPE|^//INST)[\s\S])*?^C\d+[ \t]*=)"
            r"(?=[\s\S]*?^(///ATTR[^\r\n]*)\r?\n(?!/{3,4}FRAME))",
        ),
    ),
    Rule(
        "inform-byte",
        "a byte is between 0 and 255",
        "the line is refused",
        "use I or D",
        _MANUAL,
        Trust.MANUAL,
        beyond(r"^[ \t]*SET[ \t]+L?B\d+[ \t]+(-?\d+)[ \t]*\r?$", 0, 255),
    ),
    Rule(
        "inform-integer",
        "an integer is between -32768 and 32767",
        "the line is refused",
        "use D",
        _MANUAL,
        Trust.MANUAL,
        beyond(r"^[ \t]*SET[ \t]+L?I\d+[ \t]+(-?\d+)[ \t]*\r?$", -32768, 32767),
    ),
    Rule(
        "inform-text",
        "a text variable holds 32 characters (16 on NX100)",
        "the line is refused",
        "shorten the text",
        _MANUAL,
        Trust.MANUAL,
        longer(r"^[ \t]*SET[ \t]+L?S\d+[ \t]+\"([^\"\r\n]*)\"", 32),
    ),
    Rule(
        "inform-message",
        "a message has at most 32 characters",
        "the line is refused",
        "show it in two messages",
        _MANUAL,
        Trust.MANUAL,
        longer(r"^[ \t]*MSG[ \t]+\"([^\"\r\n]*)\"", 32),
    ),
    Rule(
        "inform-time",
        "a time is between 0.01 and 655.35 s",
        "the line is refused",
        "wait several times",
        _MANUAL,
        Trust.MANUAL,
        beyond(r"^[ \t]*TIMER[ \t]+T=([\d.]+)", 0.01, 655.35),
    ),
    Rule(
        "inform-frame",
        "instructions begin with NOP and end with END",
        "the job is not loaded",
        "write NOP first and END last",
        _FORMAT,
        Trust.MANUAL,
        having(r"^///GROUP1[^\r\n]*\r?\n(?:///[^\r\n]*\r?\n)*(?!///|NOP\b)([^\r\n]+)"),
    ),
    Rule(
        "inform-characters",
        "a job is of ASCII or Shift-JIS characters",
        "shown as other characters",
        "write them out",
        _FORMAT,
        Trust.M,
        outside(r"\x00-\x7f"),
    ),
    Rule(
        "inform-call",
        "each called job is on the controller",
        "the program stops at the line",
        "load it as well",
        _MANUAL,
        Trust.MANUAL,
        undefined(r"\bJOB:([\w-]+)", r"^//NAME[ \t]+(\S+)", among_all=True),
        option=True,
    ),
    Rule(
        "inform-variables",
        "100 variables of each kind (positions 128) are there as delivered",
        "the line is refused; more can be had in maintenance mode",
        "raise the number of variables",
        _MANUAL,
        Trust.M,
        beyond(r"(?<![\w#])[BIDRS](\d{3,5})\b", 0, 99),
        option=True,
    ),
)
LOADER = Loader(RULES, _BLANKS, _job)
