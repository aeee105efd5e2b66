"""The ports that tell everything and run what they are sent: primary 30001, secondary 30002, real-time 30003.

Universal Robots' "Remote Control via TCP/IP" (16496) and the structures in the headers of its client library. A text
that comes in is run at once: `def` to `end` takes the place of the program that runs; a line by itself is a program
of one statement. `sec` programs, which the real controller runs beside the other one, are taken as programs too.
"""

from __future__ import annotations

import asyncio
import re
import struct
from dataclasses import dataclass, field

from rpl.controllers.ur.panel import VERSION, Panel
from rpl.controllers.ur.variables import ROBOT_MODES, RUNTIME, SAFETY_MODES, Moment, bits
from rpl.controllers.virtual.store import NotDoneError

_LONGEST = 2**21  # bytes of one program
_STATE, _MESSAGE = 16, 20
_EVERY = {"primary": 50, "secondary": 50, "realtime": 1}  # ticks of 2 ms
_OPENS = re.compile(r"\s*(?:def|sec|thread)\s+\w+\s*\(")
BLOCK = re.compile(r"\b(?:def|sec|thread|if|while|for)\b.*:\s*$")
REALTIME_SIZE = 1220


@dataclass
class Pushed:
    """All clients of the three ports."""

    panel: Panel
    moment: Moment
    listening: dict[str, list[asyncio.StreamWriter]] = field(default_factory=lambda: {name: [] for name in _EVERY})

    async def serve(self, port: str, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """One client, to its end."""
        if port != "realtime":
            writer.write(version_message())
        self.listening[port].append(writer)
        try:
            gathered = ""
            while piece := await reader.read(65536):
                gathered += piece.decode("utf-8", "replace")
                programs, gathered = whole_programs(gathered)
                for text in programs:
                    await self._run(port, text)
                if len(gathered) > _LONGEST:
                    return
        finally:
            self.listening[port].remove(writer)

    async def _run(self, port: str, text: str) -> None:
        """Long texts take a second to be read: values go on being told meanwhile."""
        cabinet = self.panel.cabinet
        cabinet.told(port, "start", text)
        try:
            await asyncio.to_thread(self.panel.run_text, text.encode())
        except NotDoneError as error:
            cabinet.messages.append(f"{port}: {error.said or error.why}")
        cabinet.after()

    def send(self, tick: int) -> None:
        """What is due at this tick."""
        for port, every in _EVERY.items():
            writers = self.listening[port]
            if not writers or tick % every:
                continue
            data = realtime_packet(self.moment) if port == "realtime" else state_packet(self.moment)
            for writer in tuple(writers):
                if writer.transport.get_write_buffer_size() > 2**20:
                    writer.transport.abort()
                else:
                    writer.write(data)


def whole_programs(text: str) -> tuple[list[str], str]:
    """The programs that are complete, and the beginning of the next one: a definition ends with the `end` of its block
    at the beginning of a line, a statement with its line."""
    found: list[str] = []
    while "\n" in text:
        if not _OPENS.match(text):
            line, _, text = text.partition("\n")
            if line.strip():
                found.append(f"{line.strip()}\n")
            continue
        ended = _end_of(text)
        if ended is None:
            break
        found.append(text[:ended])
        text = text[ended:]
    return found, text


def _end_of(text: str) -> int | None:
    """Where the block that the text begins with is over; None: not yet."""
    depth = place = 0
    for line in text.splitlines(keepends=True):
        if not line.endswith("\n"):
            return None
        place += len(line)
        said = line.partition("#")[0].strip()
        if BLOCK.match(said):
            depth += 1
        elif said == "end":
            depth -= 1
            if depth == 0:
                return place
    return None


def version_message() -> bytes:
    """The first message of 30001 and 30002: robot message, version (type 20, subtype 3)."""
    name = b"URControl"
    major, minor, bugfix, build = VERSION
    body = struct.pack(">QbbB", 2**64 - 1, -2, 3, len(name)) + name
    body += struct.pack(">BBII", major, minor, bugfix, build) + b"08-09-2022, 00:00:00"
    return struct.pack(">IB", len(body) + 5, _MESSAGE) + body


def _part(kind: int, body: bytes) -> bytes:
    return struct.pack(">IB", len(body) + 5, kind) + body


def state_packet(moment: Moment) -> bytes:
    """Robot state (type 16) of the secondary interface, software 5.x: mode (47 bytes), joints (251), tool (37),
    master board (74), cartesian (101), force mode (61), tool communication (37 without its ports: left out)."""
    panel = moment.panel
    powered = panel.robot_mode in ("IDLE", "RUNNING")
    running, paused = panel.cabinet.phase == "running", panel.cabinet.phase == "paused"
    safety = SAFETY_MODES[panel.safety]
    mode = struct.pack(
        ">Q7BBBdddB",
        int(moment.t * 1e6),
        True,
        True,
        powered,
        panel.cabinet.emergency_stop,
        panel.protective_stop,
        running,
        paused,
        ROBOT_MODES[panel.robot_mode],
        2 if panel.cabinet.mode == "remote" else 0,
        panel.speed,
        panel.speed,
        1.0,
        0,
    )
    joints = b"".join(
        struct.pack(">dddffffB", q, q, qd, 0.0, 48.0, 25.0, 25.0, 253 if panel.robot_mode == "RUNNING" else 239)
        for q, qd in zip(moment.joints, moment.speeds, strict=True)
    )
    tool = struct.pack(">bbddfBffB", 0, 0, 0.0, 0.0, 48.0, 0, 0.0, 25.0, 253)
    inputs, outputs = bits(panel, "di"), bits(panel, "do")
    board = struct.pack(
        ">iibbddbbddffffBBBIBB",
        inputs,
        outputs,
        0,
        0,
        0.0,
        0.0,
        0,
        0,
        0.0,
        0.0,
        25.0,
        48.0,
        0.0,
        0.0,
        safety,
        0,
        0,
        0,
        0,
        0,
    )
    cartesian = struct.pack(">12d", *moment.pose, *(0.0,) * 6)
    force = struct.pack(">7d", *(0.0,) * 7)
    parts = (_part(0, mode), _part(1, joints), _part(2, tool), _part(3, board), _part(4, cartesian), _part(7, force))
    return _part(_STATE, b"".join(parts))


def realtime_packet(moment: Moment) -> bytes:
    """The packet of 30003 as of software 5.12, 1220 bytes: a length and 152 doubles; what older software had not yet
    (1108 bytes for 3.5 to 5.9) stands at its end."""
    panel = moment.panel
    zero6, zero3 = (0.0,) * 6, (0.0,) * 3
    values: list[float] = [moment.t]
    for each in (moment.joints, moment.speeds, zero6, zero6, zero6):  # target: q, qd, qdd, current, moment
        values.extend(each)
    for each in (moment.joints, moment.speeds, zero6, zero6):  # actual: q, qd, current, control current
        values.extend(each)
    values.extend((*moment.pose, *moment.pose_speed, *zero6, *moment.pose, *moment.pose_speed))
    values.append(float(bits(panel, "di")))
    values.extend((25.0,) * 6)  # temperatures of the motors
    values.extend((0.0, 0.0, float(ROBOT_MODES[panel.robot_mode])))  # controller timer, test value, robot mode
    values.extend((253.0,) * 6)  # modes of the joints
    values.append(float(SAFETY_MODES[panel.safety]))
    values.extend(zero6)  # used by Universal Robots only
    values.extend((*zero3, *zero6, panel.speed, 0.0, 0.0, 0.0, 48.0, 48.0, 0.0))  # accelerometer ... robot current
    values.extend((48.0,) * 6)
    values.extend((float(bits(panel, "do")), float(RUNTIME[panel.cabinet.phase])))
    values.extend((*zero3, *zero3, float(SAFETY_MODES[panel.safety])))  # elbow, safety status
    values.extend((*zero3, 0.0, *zero3, *zero6))  # unused, payload with its centre and inertia
    return struct.pack(f">I{len(values)}d", REALTIME_SIZE, *values)
