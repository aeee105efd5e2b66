"""`MD:` of a virtual controller: programs as listings, and the reports that are made when they are read."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Sequence
from pathlib import PurePosixPath

from rpl.controllers.fanuc.listing import is_listing, is_protected
from rpl.controllers.fanuc.loader import Alarms, checked
from rpl.controllers.virtual.cabinet import Cabinet
from rpl.controllers.virtual.store import NotDoneError

_KEPT = (".ls", ".va", ".pc")
_STATES = {"running": "RUNNING", "paused": "PAUSED"}
_VERSION = "V9.40P/01"
# M: the words behind the number of a refusal, but for "in use", which public tools look for.
_SAID = {
    "missing": "File not found",
    "protected": "Program is write protected",
    "full": "No more available memory",
    "busy": "Program is in use",
    "name": "Illegal file name",
    "exists": "Program already exists",
    "emergency-stop": "Emergency stop",
}


class Memory:
    """The shelf of the FTP server. Names are in capitals; programs are deleted by their binary name."""

    folds = True
    renames = False

    def __init__(self, cabinet: Cabinet) -> None:
        self.cabinet = cabinet
        self.store = cabinet.store
        self.alarms = Alarms()
        self._made: dict[str, Callable[[], str]] = {
            "PRGSTATE.DG": self._program_states,
            "SFTYSIG.DG": self._safety_signals,
            "CURPOS.DG": self._position,
        }

    def names(self) -> Sequence[str]:
        kept = [self._shown(name) for name in self.store.names() if name.lower().endswith(_KEPT) or ".." in name]
        return [*kept, *self._made, "ERRALL.LS"]

    def _shown(self, name: str) -> str:
        return name if ".." in name else PurePosixPath(name).name.upper()

    def size(self, name: str) -> int:
        return len(self.read(name))

    def read(self, name: str) -> bytes:
        known = name.upper()
        if known == "ERRALL.LS":
            return self.alarms.listing(self._head())
        if known in self._made:
            return (self._head() + "\r\n" + self._made[known]()).replace("\n", "\r\n").encode("latin-1")
        return self.store.read(name)

    def write(self, name: str, data: bytes) -> None:
        """A listing is loaded: its name is that of the program."""
        if PurePosixPath(name).suffix.lower() not in (".ls", ".pc"):
            raise NotDoneError("name", name)
        if name in self.store and is_listing(old := self.store.kept(name)) and is_protected(old.decode("latin-1")):
            raise NotDoneError("protected", PurePosixPath(name).stem)
        self.store.write(name.upper(), data)

    def delete(self, name: str) -> None:
        path = PurePosixPath(name)
        self.store.delete(str(path.with_suffix(".LS")) if path.suffix.lower() == ".tp" else name)

    def rename(self, old: str, new: str) -> None:
        raise NotDoneError("name", old)

    def lets_in(self, user: str, password: str) -> bool:
        """Without the password option everybody is let in; a user with a name has to know the password here."""
        anybody = user.lower() in ("anonymous", "")
        return self.cabinet.login(user, self.cabinet.password if anybody else password)

    def said(self, error: NotDoneError) -> str:
        return error.said if error.why == "syntax" else f"{_SAID[error.why]}: {error.said}"

    # ---- how the loader treats what is written

    def loads(self, name: str, data: bytes) -> None:
        if name.lower().endswith(".ls"):
            checked(name, data, self.alarms)

    def may_write(self, name: str) -> None:
        """The program that is selected, whether it runs or stands, cannot be replaced, nor can any while one runs
        (which programs a task holds is not looked up)."""
        self.cabinet.may_write(name)
        if self.cabinet.phase != "stopped" and PurePosixPath(name).stem.upper() == self._selected():
            raise NotDoneError("busy", name)

    def _selected(self) -> str:
        return PurePosixPath(self.cabinet.program).stem.upper()

    # ---- reports

    def _head(self) -> str:
        return (
            f"F Number: F{self.cabinet.serial}\nVERSION : HandlingTool\n$VERSION: {_VERSION}      1/1/2026\n"
            f"DATE:     {time.strftime('%d-%b-%y %H:%M').upper()}\n"
        )

    def _program_states(self) -> str:
        name, state = self._selected() or "MAIN", _STATES.get(self.cabinet.phase)
        lines = ["TASK STATES:"]
        if state is not None:
            line = self.cabinet.line
            lines += [f"   1  {name} {state} @ {line} in {name} of {name}"]
            lines += [f"Routine depth: 1  Routine: {name}", f"Line: {line:5}       Program: {name}   Type: TP"]
        elif self.cabinet.program:
            lines += [f"   1  {name} status = ABORTED"]
        lines += ["", "PROGRAM STATES:"]
        for each in self.store.names():
            if each.lower().endswith(".ls"):
                text = self.store.kept(each).decode("latin-1") if each in self.store else ""
                held = "yes" if state is not None and self._shown(each)[:-3] == name else "no"
                lines += [f"{self._shown(each)[:-3]:<14}TP", f"Task: {held}"]
                lines += [f"Protection: {'ON' if is_protected(text) else 'OFF'}", ""]
        return "\n".join([*lines, ""])

    def _safety_signals(self) -> str:
        on = {
            "TP Enable": self.cabinet.mode == "manual",
            "TP Deadman": self.cabinet.mode != "manual",
            "TP ESTOP": self.cabinet.emergency_stop,
            "SOP Estop": False,
            "External ESTOP": False,
            "Fence Open": False,
            "OverTravel": False,
            "Hand Broken": False,
        }
        return "".join(f"{name:<20}{'TRUE' if value else 'FALSE'}\n" for name, value in on.items())

    def _position(self) -> str:
        joints, flange = self.cabinet.joints, self.cabinet.flange
        lines = ["CURRENT JOINT POSITION:", "Tool #:  1"]
        lines += [f"Joint   {number}: {value:10.4f}" for number, value in enumerate(joints or (), 1)]
        if flange is not None:
            from rpl.emulator.rotations import matrix_to_xyz_fixed

            values = [*(float(value) for value in flange[:3, 3]), *map(float, matrix_to_xyz_fixed(flange[:3, :3]))]
            lines += ["", "CURRENT WORLD POSITION:", "Frame #:  0"]
            lines += [f"{name}: {value:10.4f}" for name, value in zip("XYZWPR", values, strict=True)]
        return "\n".join([*lines, ""])


_FIELDS = re.compile(rb"^(LINE_COUNT|PROG_SIZE|MEMORY_SIZE)([ \t]*=[ \t]*)\d+", re.MULTILINE)
_MODIFIED = re.compile(rb"^(MODIFIED[ \t]*=[ \t]*)DATE[^;\r\n]*", re.MULTILINE)
_LINE = re.compile(rb"^[ \t]*\d*:", re.MULTILINE)


def as_kept(data: bytes) -> bytes:
    """A listing with the line ends that controllers have."""
    return data.replace(b"\r\n", b"\n").replace(b"\n", b"\r\n") if is_listing(data) else data


def rewritten(name: str, data: bytes) -> bytes:
    """A listing as the controller gives it back: its own sizes, dates and line numbers, lines that end with CR LF."""
    if not is_listing(data):
        return data
    lines, count, inside = [], 0, False
    for line in data.replace(b"\r\n", b"\n").split(b"\n"):
        if line.startswith(b"/"):
            inside = line.startswith(b"/MN")
        elif inside and (numbered := _LINE.match(line)):
            count += 1
            line = b"%4d:" % count + line[numbered.end() :]
        lines.append(line)
    text = b"\n".join(lines)
    sizes = {b"LINE_COUNT": count, b"PROG_SIZE": len(text) // 2, b"MEMORY_SIZE": len(text)}
    text = _FIELDS.sub(lambda found: found[1] + found[2] + b"%d" % sizes[found[1]], text)
    now = time.strftime("DATE %y-%m-%d  TIME %H:%M:%S").encode()
    return _MODIFIED.sub(lambda found: found[1] + now, text).replace(b"\n", b"\r\n")
