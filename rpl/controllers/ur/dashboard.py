"""Asking the dashboard (TCP 29999): one line of words there, one line back.

Only questions are here: `load`, `play`, `power on` and the like are words that this client does not have.
"""

from __future__ import annotations

import re
import socket
import time
from types import TracebackType
from typing import Literal, Self

from rpl.controllers.link import GarbledError, Identity, LostError, State
from rpl.controllers.profile import Profile

Question = Literal[
    "PolyscopeVersion",
    "get serial number",
    "get robot model",
    "robotmode",
    "safetystatus",
    "programState",
    "running",
    "get loaded program",
    "is in remote control",
    "get operational mode",
]
BANNER = "Connected: Universal Robots Dashboard Server"
_LONGEST = 4096  # bytes of one line
_POWERED = ("POWER_ON", "IDLE", "BACKDRIVE", "RUNNING")
_STOPS = ("SYSTEM_EMERGENCY_STOP", "ROBOT_EMERGENCY_STOP")
_VERSION = re.compile(r"URSoftware\s+(\d[\w.]*)")


class Dashboard:
    """A connection that asks. Raises LostError when there is none, GarbledError when something else answers."""

    def __init__(self, profile: Profile) -> None:
        self.place = f"{profile.host}:{profile.port_of('dashboard')}"
        self.patience_s = profile.patience_s
        try:
            self._socket = socket.create_connection((profile.host, profile.port_of("dashboard")), profile.patience_s)
        except OSError as error:
            raise LostError(f"dashboard {self.place}: {error.strerror or error}") from None
        self._left = b""
        banner = self._line()
        if not banner.startswith(BANNER):
            self.close()
            raise GarbledError(f"dashboard {self.place}: {banner[:80]!r} is not how a dashboard greets")

    def ask(self, question: Question) -> str:
        try:
            self._socket.sendall(f"{question}\n".encode())
        except OSError as error:
            raise LostError(f"dashboard {self.place}: {error.strerror or error}") from None
        return self._line()

    def _line(self) -> str:
        """The next line, within the patience and of bounded length."""
        due = time.monotonic() + self.patience_s
        while b"\n" not in self._left:
            if len(self._left) > _LONGEST:
                self.close()
                raise GarbledError(f"dashboard {self.place}: a line of more than {_LONGEST} bytes")
            try:
                self._socket.settimeout(max(due - time.monotonic(), 0.001))
                piece = self._socket.recv(_LONGEST)
            except TimeoutError:
                raise LostError(f"dashboard {self.place}: no answer within {self.patience_s:g} s") from None
            except OSError as error:
                raise LostError(f"dashboard {self.place}: {error.strerror or error}") from None
            if not piece:
                raise LostError(f"dashboard {self.place}: the connection is lost")
            self._left += piece
        line, _, self._left = self._left.partition(b"\n")
        try:
            return line.decode("utf-8").strip()
        except UnicodeDecodeError:
            raise GarbledError(f"dashboard {self.place}: {line[:40]!r} is no line of text") from None

    def close(self) -> None:
        self._socket.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.close()


def identity_by(dashboard: Dashboard) -> Identity:
    """Who the controller is. Older ones do not know every question; what they do not know is left empty."""
    version = _VERSION.search(dashboard.ask("PolyscopeVersion"))
    serial, model = dashboard.ask("get serial number"), dashboard.ask("get robot model")
    return Identity(
        "Universal Robots",
        model if re.fullmatch(r"UR\d+\w*", model) else "",
        serial if serial.isdigit() else "",
        version[1] if version else "",
        axes=6,
    )


def state_by(dashboard: Dashboard, folder: str) -> State:
    """What it does; what its words do not say stays unknown. `folder`: names of programs are below it."""
    said = _valued(dashboard.ask("robotmode"), "Robotmode")
    safety = _valued(dashboard.ask("safetystatus"), "Safetystatus")
    running = _valued(dashboard.ask("running"), "Program running")
    loaded = dashboard.ask("get loaded program")
    remote, operational = dashboard.ask("is in remote control"), dashboard.ask("get operational mode")
    path = _valued(loaded, "Loaded program")
    selected: tuple[str, ...] | None = None if path is None else (_below(path, folder),)
    if loaded.startswith("No program loaded"):
        selected = ()
    return State(
        mode=_mode(remote, operational),
        running={"true": True, "false": False}.get((running or "").lower()),
        motors_on=None if said is None else said in _POWERED,
        emergency_stop=None if safety is None else safety in _STOPS,
        program=selected[0] if selected else None,
        selected=selected,
    )


def _mode(remote: str, operational: str) -> str | None:
    if remote == "true":
        return "remote"
    if operational.upper() in ("MANUAL", "AUTOMATIC"):
        return operational.lower()
    return "local" if remote == "false" else None


def _valued(line: str, word: str) -> str | None:
    """What stands behind `word:`."""
    name, sign, value = line.partition(":")
    return value.strip() if sign and name.strip().lower() == word.lower() else None


def _below(path: str, folder: str) -> str:
    start = folder.rstrip("/") + "/"
    return path.removeprefix(start)
