"""The reports that a controller makes of itself when they are read: PRGSTATE.DG, SFTYSIG.DG, CURPOS.DG.

Their layout is as public readers of controllers in use expect it: PRGSTATE.DG has `1 NAME RUNNING @ 47 in MAIN of NAME`
or `2 NAME status = ABORTED` for each task, the routines of a task as `Line: 47 Program: NAME Type: TP`; SFTYSIG.DG has
`TP Enable  TRUE`; CURPOS.DG has `Joint 1: 0.00` and, under CURRENT WORLD POSITION, `X: 0.00`.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

# A task in one of these holds its programs: they cannot be replaced.
_LIVE = ("RUNNING", "PAUSED", "HELD")
_HEADER = {
    "serial": re.compile(r"^F Number:\s*(\S+)", re.MULTILINE),
    "name": re.compile(r"^VERSION *:\s*(.+?)\s*$", re.MULTILINE),
    "firmware": re.compile(r"^\$VERSION:\s*(\S+)", re.MULTILINE),
}
_AT = re.compile(r"^\s*\d+\s+(\S+)\s+([A-Z]+)\s*@\s*(\d+)\s+in\s+\S+\s+of\s+(\S+)")
_ENDED = re.compile(r"^\s*\d+\s+(\S+)\s+status\s*=\s*([A-Z]+)")
_STACK = re.compile(r"^\s*Line:\s*\d+\s+Program:\s*(\S+)")
_SIGNAL = re.compile(r"^\s*(\S.*?)\s{2,}(TRUE|FALSE)\s*$", re.MULTILINE)
_JOINT = re.compile(r"^\s*Joint\s+\d+:\s*(-?\d*\.?\d+)", re.MULTILINE)
_AXIS = re.compile(r"^\s*([XYZWPR]):\s*(-?\d*\.?\d+)", re.MULTILINE)
_STOPS = ("TP ESTOP", "SOP ESTOP", "EXTERNAL ESTOP")


@dataclass(frozen=True, slots=True)
class Task:
    """name: the program that was started; `at`: the one it is in now; `holds`: all that it holds, in capitals."""

    name: str
    state: str
    line: int | None
    at: str
    holds: tuple[str, ...]

    @property
    def is_live(self) -> bool:
        return self.state in _LIVE


def header(text: str) -> dict[str, str]:
    """serial (F number), name (of the software) and firmware, where a report says them."""
    return {word: found[1] for word, pattern in _HEADER.items() if (found := pattern.search(text))}


def tasks(text: str) -> list[Task] | None:
    """The tasks of PRGSTATE.DG; None when it is no such report."""
    if "TASK STATES:" not in text:
        return None
    found: list[Task] = []
    for line in text.split("TASK STATES:", 1)[1].split("PROGRAM STATES:", 1)[0].splitlines():
        if at := _AT.match(line):
            names = tuple(dict.fromkeys((at[1].upper(), at[4].upper())))
            found.append(Task(at[1].upper(), at[2], int(at[3]), at[4].upper(), names))
        elif ended := _ENDED.match(line):
            found.append(Task(ended[1].upper(), ended[2], None, "", ()))
        elif found and (stack := _STACK.match(line)):
            last = found[-1]
            holds = tuple(dict.fromkeys((*last.holds, stack[1].upper())))
            found[-1] = Task(last.name, last.state, last.line, last.at, holds)
    return found


def signals(text: str) -> dict[str, bool]:
    """The signals of SFTYSIG.DG by their names in capitals."""
    return {found[1].upper(): found[2] == "TRUE" for found in _SIGNAL.finditer(text)}


def emergency_stop(found: dict[str, bool]) -> bool | None:
    """Is one of the emergency stops pressed? Nobody has checked by pressing one that TRUE means so."""
    known = [found[name] for name in _STOPS if name in found]
    return any(known) if known else None


def joints(text: str) -> tuple[float, ...] | None:
    """Degrees (mm for linear axes) of CURPOS.DG."""
    found = tuple(float(value) for value in _JOINT.findall(text))
    return found or None


def place(text: str) -> dict[str, float] | None:
    """X Y Z (mm) W P R (degrees) of the tool in the world frame."""
    if "CURRENT WORLD POSITION" not in text:
        return None
    found = {name: float(value) for name, value in _AXIS.findall(text.split("CURRENT WORLD POSITION", 1)[1])}
    return found if len(found) == 6 else None
