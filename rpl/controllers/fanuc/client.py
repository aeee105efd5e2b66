"""A FANUC controller: its programs by FTP, its state from the reports that it makes of itself."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import PurePosixPath

from rpl.controllers.fanuc import reports
from rpl.controllers.ftp.channel import Channel
from rpl.controllers.ftp.client import FtpLink, channel_of, folder_of
from rpl.controllers.link import Identity, LoginError, LostError, RefusedError, RemoteFile, State
from rpl.controllers.profile import Profile
from rpl.controllers.showing import Status

# The longest report that is read of the controller's alarms.
_REASON = re.compile(r"(ASBN-009 on line \d+, column \d+)\s*\"\s*\"?\s*(ASBN-\d+ [^\"]*?)\s*\"")


class FanucLink(FtpLink):
    """Files of MD:, which is the memory of the controller: a listing that is written there is loaded."""

    # M: nobody has seen a controller rename a program by FTP.
    can_rename = False

    def __init__(self, channel: Channel, folder: str) -> None:
        super().__init__(channel, folder)
        self._identity: Identity | None = None

    def files(self) -> Sequence[RemoteFile]:
        """Names only: what MD: lists is made when it is read, and has no size before."""
        return sorted(self._names(), key=lambda one: one.name)

    def report(self, name: str) -> str:
        """A report as text; empty where the controller does not make it."""
        try:
            return self.channel.read(f"RETR {name}").decode("latin-1")
        except (LoginError, LostError):
            raise
        except RefusedError:
            return ""

    def identity(self) -> Identity:
        if self._identity is None:
            said = reports.header(self.report("PRGSTATE.DG"))
            firmware, name = said.get("firmware", ""), said.get("name", "")
            self._identity = Identity("FANUC", serial=said.get("serial", ""), firmware=firmware, name=name)
        return self._identity

    def state(self) -> State:
        """What is selected on the pendant but does not run is not told here: the controller itself refuses then."""
        text = self.report("PRGSTATE.DG")
        found, signals = reports.tasks(text), reports.signals(self.report("SFTYSIG.DG"))
        stop = reports.emergency_stop(signals)
        pendant = signals.get("TP ENABLE")
        mode = None if pendant is None else "pendant enabled" if pendant else "pendant disabled"
        if found is None:
            return State(mode=mode, emergency_stop=stop)
        live = [task for task in found if task.is_live]
        running = [task for task in live if task.state == "RUNNING"]
        first = next(iter(running or live), None)
        return State(
            mode=mode,
            running=bool(running),
            emergency_stop=stop,
            program=first.name if first else None,
            line=first.line if first else None,
            selected=tuple(sorted({name for task in live for name in task.holds})),
        )

    def put(self, name: str, data: bytes) -> None:
        """Raises RefusedError with what the loader says, which the controller keeps among its alarms."""
        try:
            self.channel.write(f"STOR {self.there(name)}", data)
        except (LoginError, LostError):
            raise
        except RefusedError as error:
            reason = _REASON.search(self.report("ERRALL.LS")) if "load" in str(error).lower() else None
            said = f"{error}: {reason[1]}: {reason[2]}" if reason and reason[2] not in str(error) else str(error)
            raise RefusedError(said) from None

    def delete(self, name: str) -> None:
        """A program is deleted by its binary name, whatever it was written as."""
        path = PurePosixPath(name)
        there = str(path.with_suffix(".TP")) if path.suffix.upper() == ".LS" else name
        try:
            self.channel.ask(f"DELE {self.there(there)}")
        except RefusedError as error:
            raise self._why(name, error) from None


def connect(profile: Profile) -> FanucLink:
    """Raises LinkError. Without a user the session is an anonymous one: controllers ask for users only where a password
    option is installed."""
    channel = channel_of(profile, False)
    try:
        return FanucLink(channel, folder_of(profile))
    except BaseException:
        channel.close()
        raise


def status(profile: Profile) -> Status:
    """From the reports that the controller makes of itself."""
    link = connect(profile)
    try:
        position = link.report("CURPOS.DG")
        signals = reports.signals(link.report("SFTYSIG.DG"))
        place = reports.place(position)
        return Status(
            link.identity(),
            link.state(),
            joints=reports.joints(position),
            xyz_mm=None if place is None else (place["X"], place["Y"], place["Z"]),
            orientation={} if place is None else {name: place[name] for name in "WPR"},
            signals=dict(signals),
        )
    finally:
        link.close()
