"""What a controller does with a listing that is written to it: its loader takes it, or says where it cannot.

The errors are those of our reader, and of the measured rules of what a controller refuses (`dialects/tp/loading.py`),
with the codes that controllers have: ASBN-009 for the place, ASBN-092 for an instruction that it does not know (both
seen in alarm logs of controllers). M: the sentence of the FTP answer.
"""

from __future__ import annotations

import re
import time
from dataclasses import dataclass

from rpl import registry
from rpl.checks.loading import Trust
from rpl.controllers.fanuc.listing import is_listing
from rpl.controllers.virtual.store import NotDoneError
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.source import Source, source_from_bytes

_CODE = re.compile(r"ASBN-\d+")
_REFUSED = re.compile(r"refused|ASBN-")
_UNKNOWN = "ASBN-092 Undefined instruction"


@dataclass(frozen=True, slots=True)
class Refusal:
    """Where the loader stops, and what it says."""

    line: int
    column: int
    said: str

    def alarm(self, number: int, now: str) -> str:
        """The line of ERRALL.LS."""
        place = f"ASBN-009 on line {self.line}, column {self.column}"
        return f'{number:4}" {now} " {place:<44} " " {self.said:<32} " WARN   00000000"    "'

    @property
    def answer(self) -> str:
        return f"Error during load: ASBN-009 on line {self.line}, column {self.column}; {self.said}"


def refusal(name: str, data: bytes) -> Refusal | None:
    """Why the loader does not take a listing; None: it does."""
    if not is_listing(data):
        return Refusal(1, 1, "ASBN-001 Syntax error")
    source = source_from_bytes(name, data)
    diagnostics = Diagnostics()
    read_sources([source], "tp", diagnostics)
    for error in diagnostics.of(Severity.ERROR):
        return Refusal(error.origin.line or 1, error.origin.column or 1, _UNKNOWN)
    return _broken_rule(source)


def _broken_rule(source: Source) -> Refusal | None:
    """The first place where a measured rule says that the load is refused."""
    loading = registry.dialect("tp").loading
    for rule, place in loading().broken([source]) if loading is not None else ():
        if rule.trust is Trust.MEASURED and not rule.option and _REFUSED.match(rule.answer):
            line = source.text.count("\n", 0, place.start) + 1
            code = _CODE.search(rule.answer)
            said = _UNKNOWN if code is None or code[0] in _UNKNOWN else f"{code[0]} Operation not allowed"
            return Refusal(line, place.start - source.text.rfind("\n", 0, place.start), said)
    return None


class Alarms:
    """What ERRALL.LS holds, the newest first."""

    def __init__(self) -> None:
        self._lines: list[str] = []

    def add(self, refused: Refusal) -> None:
        self._lines.insert(0, refused.alarm(len(self._lines) + 1, stamp()))

    def listing(self, head: str) -> bytes:
        return "\r\n".join([head, "ERRALL.LS  Robot Name ROBOT " + stamp(), *self._lines, ""]).encode("latin-1")


def stamp() -> str:
    """The moment as alarm logs have it."""
    return time.strftime("%d-%b-%y %H:%M:%S").upper()


def checked(name: str, data: bytes, alarms: Alarms) -> None:
    """Raises NotDoneError("syntax") with the loader's words, which are kept among the alarms."""
    refused = refusal(name, data)
    if refused is not None:
        alarms.add(refused)
        raise NotDoneError("syntax", refused.answer)
