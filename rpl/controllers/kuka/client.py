"""Files of a controller by C3 Bridge Interface, its state by the variables that it shows."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from contextlib import closing
from pathlib import Path

from rpl.controllers.folder.client import FolderLink
from rpl.controllers.kuka import c3
from rpl.controllers.kuka.c3 import MessageError, Reader
from rpl.controllers.kuka.krl import read_structure, read_value
from rpl.controllers.kuka.wire import Wire
from rpl.controllers.link import (
    LARGEST_FILE,
    MOST_FILES,
    GarbledError,
    Identity,
    Link,
    NotThereError,
    RefusedError,
    RemoteFile,
    State,
)
from rpl.controllers.profile import Profile
from rpl.controllers.rules import safe_name
from rpl.controllers.showing import Sample, Shown, Status
from rpl.errors import UsageError

_STATES = {"#P_ACTIVE": True, "#P_FREE": False, "#P_RESET": False, "#P_STOP": False, "#P_END": False}
_SHOWN_SIGNALS = 8
_USUALLY_WATCHED = ("$PRO_STATE1", "$PRO_NAME1[]", "$OV_PRO", "$AXIS_ACT")


class Variables:
    """What the controller's variables say. One that it does not have is not said."""

    def __init__(self, wire: Wire) -> None:
        self.wire = wire

    def value(self, name: str) -> Shown | None:
        try:
            return read_value(self.wire.value(name))
        except NotThereError:
            return None

    def text(self, name: str) -> str:
        found = self.value(name)
        return "" if found is None else str(found).strip()

    def truth(self, name: str) -> bool | None:
        found = self.value(name)
        return found if isinstance(found, bool) else None

    def structure(self, name: str) -> dict[str, float]:
        """The numbers of a structure, by their names; empty when the controller does not have it."""
        try:
            parts = read_structure(self.wire.value(name))
        except NotThereError:
            return {}
        return {part: float(value) for part, value in parts.items() if isinstance(value, int | float)}

    def watched(self, name: str) -> Shown | tuple[float, ...] | None:
        try:
            text = self.wire.value(name)
        except NotThereError:
            return None
        parts = [value for value in read_structure(text).values() if isinstance(value, int | float)]
        return tuple(map(float, parts)) if parts else read_value(text)

    def identity(self) -> Identity:
        """Serial number of the robot, its machine data's name, the version of the system."""
        serial = self.text("$KR_SERIALNO")
        return Identity("KUKA", self.text("$TRAFONAME[]"), serial, self.text("$RCV_INFO[]"), self.text("$ROBNAME[]"))

    def state(self) -> State:
        """$ALARM_STOP is FALSE while an emergency stop is pressed; $PERI_RDY: the drives are on."""
        mode, program = self.text("$MODE_OP").lstrip("#"), self.text("$PRO_NAME1[]")
        well = self.truth("$ALARM_STOP")
        line = self.value("$PRO_IP1.SNR") if program else None
        return State(
            mode or None,
            _STATES.get(self.text("$PRO_STATE1").upper()),
            self.truth("$PERI_RDY"),
            None if well is None else not well,
            program or None,
            line if isinstance(line, int) else None,
            (program,) if program else (),
        )


class KukaLink:
    """`folder`: where the programs are, as the controller spells it."""

    can_rename = True

    def __init__(self, wire: Wire, folder: str) -> None:
        self.wire = wire
        self.folder = folder
        self.variables = Variables(wire)

    def identity(self) -> Identity:
        return self.variables.identity()

    def state(self) -> State:
        return self.variables.state()

    def _path(self, name: str) -> str:
        return f"{self.folder}\\{safe_name(name)}".replace("/", "\\")

    def files(self) -> Sequence[RemoteFile]:
        """Programs of the folder and of those in it."""
        asked = c3.number(c3.ITEM_FILES) + c3.number(c3.RECURSIVE | c3.EXPAND) + c3.wide(self.folder)
        told = self.wire.ask(c3.LIST, asked, self.folder)
        try:
            names = Reader(told).texts()
        except MessageError as error:
            raise GarbledError(f"{self.wire.place}: {error}") from None
        if len(names) > MOST_FILES:
            raise GarbledError(f"the controller names more than {MOST_FILES} files")
        return [RemoteFile(name) for name in sorted(self._name(path) for path in names)]

    def _name(self, path: str) -> str:
        """A file's name as seen from the folder, whether the controller gives its path or the part below the folder."""
        before = f"{self.folder}\\".lower()
        below = path[len(before) :] if path.lower().startswith(before) else path
        return safe_name(below)

    def fetch(self, name: str) -> bytes:
        begun = bytes((c3.BEGIN,)) + c3.number(0) + c3.wide(self._path(name))
        size = self._told(c3.READ_FILE, begun, name, missing=True)[0]
        if size > LARGEST_FILE:
            raise GarbledError(f"{name} is said to have {size} bytes, and no file has more than {LARGEST_FILE}")
        parts: list[bytes] = []
        place = 0
        while place < size:
            asked = bytes((c3.DATA,)) + c3.number(place) + c3.number(c3.CHUNK)
            offset, part = self._chunk(self.wire.ask(c3.READ_FILE, asked, name), name)
            if offset != place or not part or place + len(part) > size:
                raise GarbledError(f"{name}: the controller gives other bytes than were asked for")
            parts.append(part)
            place += len(part)
        self.wire.ask(c3.READ_FILE, bytes((c3.END,)), name, 1)
        return b"".join(parts)

    def put(self, name: str, data: bytes) -> None:
        """The controller collects the pieces, and writes the file when the last word comes."""
        size = self._told(c3.WRITE_FILE, bytes((c3.BEGIN,)) + c3.number(len(data)), name)[0]
        if size != len(data):
            raise RefusedError(f"{name}: the controller has room for {size} bytes of {len(data)}")
        for place in range(0, len(data), c3.CHUNK):
            part = data[place : place + c3.CHUNK]
            asked = bytes((c3.DATA,)) + c3.number(place) + c3.number(len(part)) + part
            if self._told(c3.WRITE_FILE, asked, name, 2) != (place, len(part)):
                raise GarbledError(f"{name}: the controller took other bytes than it was given")
        end = bytes((c3.END,)) + c3.number(c3.OVERWRITE) + c3.wide(self._path(name))
        self.wire.ask(c3.WRITE_FILE, end, name, 1)

    def rename(self, old: str, new: str) -> None:
        asked = c3.number(c3.OVERWRITE) + c3.wide(self._path(old)) + c3.wide(self._path(new))
        self.wire.ask(c3.MOVE, asked, new, 0)

    def delete(self, name: str) -> None:
        asked = b"\x00" + c3.wide(self._path(name))
        try:
            self.wire.ask(c3.DELETE, asked, name, 0)
        except RefusedError as error:
            raise self._missing(name, error) from None

    def _missing(self, name: str, error: RefusedError) -> RefusedError:
        """The protocol has no word for a file that is not there: the list tells."""
        there = {one.name.lower() for one in self.files()}
        return error if name.lower() in there else NotThereError(f"{name}: the controller has no such file")

    def _told(self, kind: int, asked: bytes, name: str, count: int = 1, missing: bool = False) -> tuple[int, ...]:
        """The numbers behind the operation's own, of an answer."""
        try:
            reader = Reader(self.wire.ask(kind, asked, name, 1 + 4 * count))
            reader.byte()
            return tuple(reader.number() for _ in range(count))
        except RefusedError as error:
            raise (self._missing(name, error) if missing else error) from None

    def _chunk(self, told: bytes, name: str) -> tuple[int, bytes]:
        try:
            reader = Reader(told)
            reader.byte()
            offset, size = reader.number(), reader.number()
            return offset, reader.take(size)
        except MessageError as error:
            raise GarbledError(f"{name}: {error}") from None

    def lock(self) -> None:
        """The protocol has nothing of the kind."""

    def unlock(self) -> None:
        """Nothing was taken."""

    def take_in(self, names: Sequence[str]) -> None:
        """The controller's own file service writes them: they are in its list of programs."""

    def take_out(self, names: Sequence[str]) -> None:
        """Nothing was loaded."""

    def close(self) -> None:
        self.wire.close()


GUIDE = "operator.txt"
_GUIDE_TEXT = """These programs were brought to this folder; the controller does not have them yet.

1. Log on at the pendant as expert, with no program selected.
2. In the navigator, open the folder that this share is on the controller (often D:\\Transfer).
3. Mark each module below and copy it.
4. Open R1\\Program, paste, and answer that what is there is to be replaced.
5. Look at the list of errors: a module with errors stays as it is, and cannot be selected.

"""


class TransferLink(FolderLink):
    """A folder that stands for a share of the controller. What is done at the pendant then is said in a file beside."""

    def files(self) -> Sequence[RemoteFile]:
        return [one for one in super().files() if one.name != GUIDE]

    def take_in(self, names: Sequence[str]) -> None:
        listed = "\n".join(f"   {name}" for name in names)
        self.put(GUIDE, f"{_GUIDE_TEXT}{listed}\n".replace("\n", "\r\n").encode("cp1252", "replace"))

    def take_out(self, names: Sequence[str]) -> None:
        if (self.root / GUIDE).exists():
            self.delete(GUIDE)


def folder_of(path: str) -> str:
    """`/KRC:/R1/Program` of a profile as the controller spells it."""
    bare = path.strip("/").replace("/", "\\")
    return bare if ":" in bare else f"KRC:\\{bare}"


def connect(profile: Profile) -> Link:
    """C3 Bridge, or the folder that stands for the controller's share. Raises LinkError, UsageError."""
    transfer = profile.option("transfer", "")
    if transfer:
        if not Path(transfer).is_dir():
            raise UsageError(f"{profile.name}: transfer: there is no folder {transfer}")
        return TransferLink(Path(transfer))
    return KukaLink(Wire(profile.host, profile.port_of("c3"), profile.patience_s), folder_of(profile.folder))


def status(profile: Profile) -> Status:
    """One look: axes in degrees, the tool in mm and A, B, C. Raises LinkError."""
    with closing(Wire(profile.host, profile.port_of("c3"), profile.patience_s)) as wire:
        variables = Variables(wire)
        axes, place = variables.structure("$AXIS_ACT"), variables.structure("$POS_ACT")
        joints = tuple(axes[f"A{number}"] for number in range(1, 7) if f"A{number}" in axes)
        xyz = tuple(place[name] for name in "XYZ" if name in place)
        orientation = {name: place[name] for name in "ABC" if name in place}
        signals: dict[str, Shown] = {}
        for word in ("$IN", "$OUT"):
            for number in range(1, _SHOWN_SIGNALS + 1):
                value = variables.truth(f"{word}[{number}]")
                if value is not None:
                    signals[f"{word}[{number}]"] = value
        identity, state = variables.identity(), variables.state()
        return Status(identity, state, joints or None, xyz or None, orientation, signals)


def watch(profile: Profile, names: Sequence[str], period_s: float) -> Iterator[Sample]:
    """Variables by their names in KRL, as they are each `period_s`; a structure by its numbers. Raises LinkError."""
    with closing(Wire(profile.host, profile.port_of("c3"), profile.patience_s)) as wire:
        variables = Variables(wire)
        began = time.monotonic()
        due = began
        while True:
            values = {name: variables.watched(name) for name in names or _USUALLY_WATCHED}
            yield Sample(time.monotonic() - began, values)
            due = max(due + period_s, time.monotonic())
            time.sleep(max(0.0, due - time.monotonic()))
