"""Files and state of a controller by the High-Speed Ethernet Server."""

from __future__ import annotations

import re
import struct
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing
from dataclasses import replace

from rpl.controllers.link import (
    MOST_FILES,
    GarbledError,
    Identity,
    LinkError,
    LostError,
    NotThereError,
    RefusedError,
    RemoteFile,
    State,
)
from rpl.controllers.profile import Profile
from rpl.controllers.rules import safe_name
from rpl.controllers.showing import Sample, Shown, Status
from rpl.controllers.yaskawa import hses
from rpl.controllers.yaskawa.hses import FILES, ROBOT, Answer, Request
from rpl.controllers.yaskawa.line import Line
from rpl.errors import UsageError

# A job has at most 9999 lines; no job is larger (bytes).
LARGEST_JOB = 8 * 2**20
_LONGEST_NAME = 40
_SHOWN_SIGNALS = 16
_VARIABLES = {
    "B": (hses.BYTE, "<B"),
    "I": (hses.INTEGER, "<h"),
    "D": (hses.DOUBLE, "<i"),
    "R": (hses.REAL, "<f"),
    "S": (hses.TEXT, "16s"),
    "P": (hses.PLACE, "<13i"),
}
_WRITES = 2  # how often a job is sent anew when the line broke in the midst of it, before that is said

Watched = Shown | tuple[float, ...] | None


class YaskawaLink:
    """Jobs by the port for files, state by the port for the robot."""

    can_rename = False

    def __init__(self, profile: Profile) -> None:
        self.encoding = profile.text_encoding
        self.name_length = _length(profile)
        self.line = Line(profile.host, profile.port_of("files"), profile.patience_s)
        self.robot = _robot(profile)

    # ---- state

    def identity(self) -> Identity:
        return self.robot.identity()

    def state(self) -> State:
        return self.robot.state()

    # ---- files

    def files(self) -> Sequence[RemoteFile]:
        listed = self._collected(hses.LIST, "*.JBI", MOST_FILES * _LONGEST_NAME)
        names = listed.decode(self.encoding, "replace").split("\r\n")
        if len(names) > MOST_FILES:
            raise GarbledError(f"the controller names more than {MOST_FILES} files")
        return [RemoteFile(safe_name(name.rstrip("\x00"))) for name in sorted(names) if name.rstrip("\x00")]

    def fetch(self, name: str) -> bytes:
        return self._collected(hses.READ, name, LARGEST_JOB)

    def put(self, name: str, data: bytes) -> None:
        """A transfer that breaks is begun anew, whole, once the controller was asked whether it still stands; never a
        single packet of it."""
        stem = name.rpartition(".")[0] or name
        if len(stem.encode(self.encoding, "replace")) > self.name_length:
            raise RefusedError(f"{name}: names of jobs have up to {self.name_length} characters there")
        if not data:
            raise RefusedError(f"{name} is empty, and no job is")
        before = self.state()
        for attempt in range(_WRITES):
            try:
                self._write(name, data)
            except LostError as lost:
                if attempt + 1 == _WRITES:
                    raise
                now = self.state()
                if now.running or now.motors_on != before.motors_on or now.mode != before.mode:
                    raise LostError(f"{lost}; the controller's state has changed meanwhile") from None
            else:
                return

    def rename(self, old: str, new: str) -> None:
        raise RefusedError("this controller gives no file another name")

    def delete(self, name: str) -> None:
        request = Request(FILES, hses.DELETE, self.line.next_number(), data=self._spelled(name))
        try:
            _good(self.line.ask(request, again=False), name)
        except LostError:
            if self._holds(name):
                raise

    def _holds(self, name: str) -> bool:
        return name.lower() in {one.name.lower() for one in self.files()}

    def lock(self) -> None:
        """Nobody asks for it: the controller is in remote mode, or refuses."""

    def unlock(self) -> None:
        """Nothing was taken."""

    def take_in(self, names: Sequence[str]) -> None:
        """The controller reads a job when it is written."""

    def take_out(self, names: Sequence[str]) -> None:
        """A job that is deleted is gone."""

    def close(self) -> None:
        self.line.close()
        self.robot.close()

    # ---- transfers

    def _spelled(self, name: str) -> bytes:
        try:
            return name.encode(self.encoding)
        except UnicodeEncodeError:
            raise RefusedError(f"{name}: the name is not in {self.encoding}, which the controller reads") from None

    def _collected(self, service: int, name: str, most: int) -> bytes:
        """All blocks of a file or a list; each is asked for by acknowledging the one before."""
        request = Request(FILES, service, self.line.next_number(), data=self._spelled(name))
        parts: list[bytes] = []
        size, block = 0, 1
        while True:
            answer = _good(self.line.ask(request, block), name)
            parts.append(answer.data)
            size += len(answer.data)
            if size > most:
                raise GarbledError(f"{name}: the controller sends more than {most // 1024} KiB")
            request = Request(FILES, service, request.number, block=answer.block, acknowledges=True)
            if answer.is_last:
                self.line.tell(request)
                return b"".join(parts)
            if not answer.data:
                raise GarbledError(f"{name}: the controller sends blocks without anything in them")
            block += 1

    def _write(self, name: str, data: bytes) -> None:
        request = Request(FILES, hses.WRITE, self.line.next_number(), data=self._spelled(name))
        _good(self.line.ask(request, 0, again=False), name)
        for block, part in hses.blocks_of(data):
            packet = replace(request, data=part, block=block, acknowledges=True)
            _good(self.line.ask(packet, block & ~hses.LAST, again=False), name)


def _length(profile: Profile) -> int:
    said = profile.option("name_length", "32")
    if said not in ("8", "32"):
        raise UsageError(f"{profile.name}: name_length is 8 or 32, not {said}")
    return int(said)


def _good(answer: Answer, name: str) -> Answer:
    """Raises NotThereError or RefusedError where the controller says no."""
    if not answer.status:
        return answer
    said = f"{name}: {answer.meaning}" if name else answer.meaning
    raise NotThereError(said) if answer.added in hses.NOT_THERE else RefusedError(said)


class Robot:
    """Questions to the port for the robot. None of them changes anything."""

    def __init__(self, line: Line, encoding: str) -> None:
        self.line = line
        self.encoding = encoding

    def asked(self, command: int, instance: int, attribute: int = 0, service: int = hses.GET_ALL) -> bytes:
        """The data of an answer."""
        request = Request(ROBOT, service, self.line.next_number(), command, instance, attribute)
        return _good(self.line.ask(request), "").data

    def numbers(self, command: int, instance: int, count: int) -> tuple[int, ...]:
        """Whole numbers of 32 bits."""
        return tuple(struct.unpack_from(f"<{count}i", _long_enough(self.asked(command, instance), 4 * count)))

    def text(self, data: bytes) -> str:
        return data.split(b"\x00")[0].decode(self.encoding, "replace").strip()

    def identity(self) -> Identity:
        """The controller has no serial number that could be asked for; firmware with the version of its parameters."""
        data = _long_enough(self.asked(hses.SYSTEM, 11), 48)
        firmware, model, parameters = self.text(data[:24]), self.text(data[24:40]), self.text(data[40:48])
        known = f"{firmware} {parameters}".strip()
        return Identity("Yaskawa", model, firmware=known)

    def state(self) -> State:
        """Of the emergency stop nothing is said: it shows by the servos, which go off. A job is always selected, and
        the controller itself refuses to replace what it cannot let go of."""
        first, second = self.numbers(hses.STATUS, 1, 2)
        mode = "teach" if first & 0x20 else "remote" if first & 0x80 else "play" if first & 0x40 else None
        name, line = self.job()
        return State(mode, bool(first & 0x08), bool(second & 0x40), program=name or None, line=line if name else None)

    def job(self) -> tuple[str, int]:
        """Name and line of the job of the master task; no name where there is none."""
        try:
            data = _long_enough(self.asked(hses.JOB, 1), 44)
        except RefusedError:
            return "", 0
        return self.text(data[:32]), struct.unpack_from("<i", data, 32)[0]

    def close(self) -> None:
        self.line.close()

    # ---- where it stands, what its variables hold

    def _position(self, instance: int) -> tuple[int, ...] | None:
        try:
            return self.numbers(hses.POSITION, instance, 13)
        except RefusedError:
            return None

    def pulses(self) -> tuple[float, ...] | None:
        """Motor pulses of the axes of the first robot; None: the controller does not say."""
        found = self._position(1)
        return None if found is None else tuple(float(count) for count in found[5:])

    def pose(self) -> tuple[float, ...] | None:
        """X, Y, Z in mm and Rx, Ry, Rz in degrees of the present tool in the base."""
        found = self._position(101)
        if found is None:
            return None
        return (*(value / 1000.0 for value in found[5:8]), *(value / 10000.0 for value in found[8:11]))

    def signals(self, word: str, first: int, count: int) -> dict[str, Shown]:
        """Inputs or outputs of programs, by their names."""
        found: dict[str, Shown] = {}
        for number in range(first, first + count):
            byte, bit = divmod(number - 1, 8)
            if not found or bit == 0:
                instance = 1 + byte + (1000 if word == "OUT" else 0)
                eight = _long_enough(self.asked(hses.SIGNALS, instance, 1, hses.GET_ONE), 1)[0]
            found[f"{word}{number}"] = bool(eight >> bit & 1)
        return found

    def variable(self, letter: str, number: int) -> Watched:
        """A position as six or more numbers: pulses, or mm and degrees; None: it is not defined."""
        command, kind = _VARIABLES[letter]
        attribute, service = (0, hses.GET_ALL) if letter == "P" else (1, hses.GET_ONE)
        try:
            data = _long_enough(self.asked(command, number, attribute, service), struct.calcsize(kind))
        except RefusedError:
            return None
        found = struct.unpack_from(kind, data)
        if letter == "S":
            return self.text(found[0])
        if letter != "P":
            value: int | float = found[0]
            return value
        if found[0] == 0:
            return tuple(float(count) for count in found[5:])
        return (*(value / 1000.0 for value in found[5:8]), *(value / 10000.0 for value in found[8:11]))

    def alarms(self) -> tuple[str, ...]:
        """The latest alarm, if there is one."""
        try:
            data = _long_enough(self.asked(hses.ALARM, 1), 60)
        except RefusedError:
            return ()
        code = int.from_bytes(data[:4], "little")
        return (f"{code} {self.text(data[28:60])}",) if code else ()


def _long_enough(data: bytes, count: int) -> bytes:
    if len(data) < count:
        raise GarbledError(f"the controller answers with {len(data)} bytes where {count} belong")
    return data


def connect(profile: Profile) -> YaskawaLink:
    """The controller, which must answer. Raises LinkError."""
    link = YaskawaLink(profile)
    try:
        link.state()
    except LinkError:
        link.close()
        raise
    return link


def _robot(profile: Profile) -> Robot:
    return Robot(Line(profile.host, profile.port_of("robot"), profile.patience_s), profile.text_encoding)


def status(profile: Profile) -> Status:
    """One look. Axes are shown in degrees when the profile names the robot, whose pulses per degree are known then.
    Raises LinkError."""
    with closing(_robot(profile)) as robot:
        identity, state = robot.identity(), robot.state()
        pose = robot.pose()
        signals: dict[str, Shown] = {}
        for word in ("IN", "OUT"):
            signals |= robot.signals(word, 1, _SHOWN_SIGNALS)
        xyz, angles = (pose[:3], pose[3:6]) if pose is not None else (None, ())
        orientation = dict(zip(("Rx", "Ry", "Rz"), angles, strict=False))
        return Status(
            identity, state, _degrees(robot.pulses(), profile.robot), xyz, orientation, signals, robot.alarms()
        )


def watch(profile: Profile, names: Sequence[str], period_s: float) -> Iterator[Sample]:
    """Values as they are each `period_s`: variables (`B000`, `I1`, `P010`), signals (`IN3`, `OUT1`), `position`,
    `pulses`, `job`, `line`, `running`, `servo`. Raises LinkError, UsageError."""
    with closing(_robot(profile)) as robot:
        asked = {name: _question(robot, name) for name in names or ("job", "line", "running", "position")}
        began = time.monotonic()
        due = began
        while True:
            yield Sample(time.monotonic() - began, {name: ask() for name, ask in asked.items()})
            due = max(due + period_s, time.monotonic())
            time.sleep(max(0.0, due - time.monotonic()))


def _question(robot: Robot, name: str) -> Callable[[], Watched]:
    """How a value is asked for. Raises UsageError."""
    word = name.lower()
    usual: dict[str, Callable[[], Watched]] = {
        "position": robot.pose,
        "pulses": robot.pulses,
        "job": lambda: robot.job()[0],
        "line": lambda: robot.job()[1],
        "running": lambda: robot.state().running,
        "servo": lambda: robot.state().motors_on,
    }
    if word in usual:
        return usual[word]
    signal = re.fullmatch(r"(in|out|ot)#?\(?(\d+)\)?", word)
    if signal is not None and 1 <= int(signal[2]) <= 4096:
        kind, number = ("IN" if signal[1] == "in" else "OUT"), int(signal[2])
        return lambda: robot.signals(kind, number, 1)[f"{kind}{number}"]
    variable = re.fullmatch(r"([bidrsp])(\d{1,3})", word)
    if variable is not None:
        letter, number = variable[1].upper(), int(variable[2])
        return lambda: robot.variable(letter, number)
    raise UsageError(
        f"{name}: there is no such value; there are {', '.join(usual)}, IN1, OUT1, B000, I000, D000, R000, S000, P000"
    )


def _degrees(pulses: tuple[float, ...] | None, name: str) -> tuple[float, ...] | None:
    """Joints of that robot; None without one, or without its pulses per degree."""
    if pulses is None or not name:
        return None
    from rpl.emulator.model import load_robot

    scale = load_robot(name).pulse_scale
    return None if scale is None else tuple(count / float(each) for count, each in zip(pulses, scale, strict=False))
