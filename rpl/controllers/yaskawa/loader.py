"""What the virtual controller's loader takes, and what it writes into the head of a job by itself."""

from __future__ import annotations

import re
from datetime import datetime

from rpl.controllers.virtual.store import NotDoneError
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.source import source_from_bytes

_DATE = re.compile(rb"(?m)^///DATE [^\r\n]*")
_FORMAT, _NO_NOP_OR_END, _SYNTAX = "5170", "5130", "5110"


def accepts(name: str, data: bytes) -> None:
    """Raises NotDoneError with the number that the controller gives for what is wrong with a job."""
    if not name.upper().endswith(".JBI"):
        return
    lines = [line.strip() for line in data.replace(b"\r", b"\n").split(b"\n")]
    if not data.lstrip().startswith(b"/JOB"):
        raise NotDoneError("syntax", _FORMAT)
    if b"NOP" not in lines or b"END" not in lines:
        raise NotDoneError("syntax", _NO_NOP_OR_END)
    diagnostics = Diagnostics()
    read_sources([source_from_bytes(name, data)], "inform", diagnostics)
    if diagnostics.of(Severity.ERROR):
        raise NotDoneError("syntax", _SYNTAX)


def kept_as(name: str, data: bytes) -> bytes:
    """The job with the date at which it came."""
    now = datetime.now().strftime("%Y/%m/%d %H:%M").encode()
    return _DATE.sub(b"///DATE " + now, data)


def place_in_job(data: bytes, file_line: int) -> tuple[int, int]:
    """The line and the step of a job at a line (1 ...) of its file: the controller counts lines from NOP, which is
    line 0, and steps by the moves."""
    lines = [line.strip() for line in data.replace(b"\r\n", b"\n").split(b"\n")]
    first = lines.index(b"NOP") if b"NOP" in lines else 0
    before = lines[first:file_line]
    steps = sum(line.startswith((b"MOV", b"SMOV", b"IMOV")) for line in before)
    return max(0, file_line - 1 - first), steps
