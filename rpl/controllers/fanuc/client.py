"""A FANUC controller: its programs by FTP, its state from the reports that it makes of itself, values by SNPX."""

from __future__ import annotations

import re
import struct
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from pathlib import PurePosixPath

from rpl.controllers.fanuc import LOGS, reports, snpx
from rpl.controllers.ftp.channel import Channel
from rpl.controllers.ftp.client import FtpLink, channel_of, folder_of
from rpl.controllers.link import Identity, LoginError, LostError, RefusedError, RemoteFile, State
from rpl.controllers.profile import Profile
from rpl.controllers.showing import Sample, Status
from rpl.errors import UsageError

_WATCHED = re.compile(r"(R|SR|DI|DO|RI|RO|UI|UO)\[(\d+)\]|(\$[\w.$\[\]]+)|(JOINTS|PLACE)", re.IGNORECASE)
# Where banks of signals begin in the two segments of bits.
_BANKS = {
    "DI": (snpx.INPUTS, 0),
    "DO": (snpx.OUTPUTS, 0),
    "RI": (snpx.INPUTS, 5000),
    "RO": (snpx.OUTPUTS, 5000),
    "UI": (snpx.INPUTS, 6000),
    "UO": (snpx.OUTPUTS, 6000),
}
Read = Callable[[], int | float | bool | str | tuple[float, ...]]
_REASON = re.compile(r"(ASBN-009 on line \d+, column \d+)\s*\"\s*\"?\s*(ASBN-\d+ [^\"]*?)\s*\"")


class FanucLink(FtpLink):
    """Files of MD:, which is the memory of the controller: a listing that is written there is loaded."""

    # M: nobody has seen a controller rename a program by FTP.
    can_rename = False

    def __init__(self, channel: Channel, folder: str) -> None:
        super().__init__(channel, folder)
        self._identity: Identity | None = None

    def files(self) -> Sequence[RemoteFile]:
        """Names only: what MD: lists is made when it is read, and has no size before. Logs are left out: they look like
        programs and cannot be sent back."""
        return sorted((one for one in self._names() if one.name.lower() not in LOGS), key=lambda one: one.name)

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
    with ExitStack() as failing:
        failing.callback(channel.close)
        link = FanucLink(channel, folder_of(profile))
        failing.pop_all()
    return link


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


def watch(profile: Profile, names: Sequence[str], period_s: float) -> Iterator[Sample]:
    """Values by the panel interface: R[1], SR[1], DI[1], DO[1], RI, RO, UI, UO, a system variable that is a whole
    number ($MCR.$GENOVERRIDE), joints (degrees) and place (X Y Z mm, W P R degrees, in the world). Without names:
    joints. Raises LinkError, UsageError."""
    wanted = [_watched(name) for name in names or ("joints",)]
    client = snpx.SnpxClient(profile.host, profile.port_of("snpx"), profile.patience_s)
    try:
        reads = {name: _reader(client, found) for name, found in zip(names or ("joints",), wanted, strict=True)}
        began = time.monotonic()
        due = began
        while True:
            yield Sample(time.monotonic() - began, {name: read() for name, read in reads.items()})
            due = max(due + period_s, time.monotonic())
            time.sleep(due - time.monotonic() if due > time.monotonic() else 0.0)
    finally:
        client.close()


def _watched(name: str) -> re.Match[str]:
    found = _WATCHED.fullmatch(name)
    if found is None:
        raise UsageError(f"{name}: there are R[1], SR[1], DI[1], DO[1], RI, RO, UI, UO, $NAME, joints and place")
    return found


def _reader(client: snpx.SnpxClient, found: re.Match[str]) -> Read:
    """Lays the window that a value needs; gives what reads it."""
    bank, number = (found[1] or "").upper(), int(found[2] or 0)
    if bank in _BANKS:
        segment, begin = _BANKS[bank]
        return lambda: client.bits(segment, begin + number, 1)[0]
    if bank == "SR":
        start = client.window(f"SR[{number}]", snpx.TEXT_WORDS)
        return lambda: snpx.text_of(client.words(start, snpx.TEXT_WORDS))
    if bank == "R":
        start = client.window(f"R[{number}]", snpx.NUMBER_WORDS, "0")
        return lambda: float(struct.unpack("<f", client.words(start, snpx.NUMBER_WORDS))[0])
    if found[3]:
        start = client.window(found[3], snpx.NUMBER_WORDS)
        return lambda: int(struct.unpack("<i", client.words(start, snpx.NUMBER_WORDS))[0])
    start = client.window("POS[0]", snpx.POSITION_WORDS, "0.0")
    if found[4].upper() == "JOINTS":
        return lambda: snpx.position_of(client.words(start, snpx.POSITION_WORDS)).joints[:6]
    return lambda: snpx.position_of(client.words(start, snpx.POSITION_WORDS)).xyzwpr
