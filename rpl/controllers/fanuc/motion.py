"""Remote motion (RMI, TCP 16001) of a virtual controller: a line of JSON for each instruction, which the emulated robot
carries out, as controllers do, by a program RMI_MOVE.

Names of packets and members after fanuc-ucl 2.0.2, whose client accepts this server. The answer to a move comes when it
is done. M: the numbers of errors.
"""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import Awaitable, Callable, Mapping
from typing import Any

from rpl.controllers.fanuc.listing import listing_of
from rpl.controllers.fanuc.snpx import position_of
from rpl.controllers.fanuc.values import Values
from rpl.controllers.virtual.cabinet import Cabinet
from rpl.controllers.virtual.endpoints import Endpoints
from rpl.controllers.virtual.store import NotDoneError
from rpl.controllers.virtual.transcript import Kind

PROGRAM = "RMI_MOVE"
_UNKNOWN, _NOT_INITIALISED, _NOT_DONE = 2556929, 2556930, 2556937
_LONGEST_LINE = 2**16
_LOOK_S = 0.002
Packet = Mapping[str, Any]
_KINDS: dict[str, Kind] = {
    "FRC_Connect": "connect",
    "FRC_Abort": "stop",
    "FRC_Pause": "stop",
    "FRC_Continue": "start",
    "FRC_Call": "start",
    "FRC_Initialize": "start",
    "FRC_Reset": "servo",
    "FRC_WriteDOUT": "set",
    "FRC_SetOverRide": "set",
}


class Remote:
    """The interface: one session at a time moves the robot."""

    def __init__(self, values: Values, session_port: Callable[[], int]) -> None:
        self.values, self.cabinet, self.session_port = values, values.cabinet, session_port
        self.ready = False
        self.frame, self.tool = 0, 1
        self.next_sequence = 1

    async def serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        while line := await reader.readline():
            try:
                packet = json.loads(line)
            except ValueError:
                packet = None
            word = next((word for word in ("Communication", "Command", "Instruction") if _has(packet, word)), "")
            found = await self._answered(word, packet) if word else {"ErrorID": _UNKNOWN}
            writer.write(json.dumps(found).encode() + b"\r\n")
            await writer.drain()

    async def _answered(self, word: str, packet: Packet) -> dict[str, Any]:
        name = str(packet[word])
        kind = "start" if word == "Instruction" else _KINDS.get(name, "look")
        self.cabinet.told("rmi", kind, name, counts=kind != "look")
        if self.cabinet.faults.delay_s:
            await asyncio.sleep(self.cabinet.faults.delay_s)
        answer: dict[str, Any] = {word: name, "ErrorID": 0}
        if word == "Instruction":
            answer["SequenceID"] = packet.get("SequenceID", self.next_sequence)
            self.next_sequence = int(answer["SequenceID"]) + 1
        try:
            answer |= await self._done(word, name, packet)
        except NotDoneError:
            answer["ErrorID"] = _NOT_DONE
        except (KeyError, TypeError, ValueError):
            answer["ErrorID"] = _UNKNOWN
        if kind != "look":
            self.cabinet.after()
        return answer

    async def _done(self, word: str, name: str, packet: Packet) -> dict[str, Any]:
        if word == "Instruction":
            if not self.ready:
                return {"ErrorID": _NOT_INITIALISED}
            return await self._instructed(name, packet)
        known: dict[str, Callable[[Packet], dict[str, Any]]] = {
            "FRC_Connect": lambda _: {"PortNumber": self.session_port(), "MajorVersion": 7, "MinorVersion": 0},
            "FRC_Disconnect": lambda _: self._initialised(False),
            "FRC_Initialize": lambda _: self._initialised(True),
            "FRC_Abort": lambda _: self._stopped(),
            "FRC_Pause": lambda _: self._paused(),
            "FRC_Continue": lambda _: self._continued(),
            "FRC_Reset": lambda _: {},
            "FRC_GetStatus": lambda _: self._status(),
            "FRC_ReadJointAngles": lambda _: {"TimeTag": _tag(), "JointAngle": self._joints(), "Group": 1},
            "FRC_ReadCartesianPosition": lambda _: {"TimeTag": _tag(), **self._place(), "Group": 1},
            "FRC_ReadDIN": lambda one: {
                "PortNumber": one["PortNumber"],
                "PortValue": int(bool(self.cabinet.signal(f"DI[{int(one['PortNumber'])}]"))),
            },
            "FRC_WriteDOUT": self._switched,
            "FRC_SetOverRide": self._overridden,
            "FRC_SetUFrameUTool": self._frames,
            "FRC_GetUFrameUTool": lambda _: {"UFrameNumber": self.frame, "UToolNumber": self.tool, "Group": 1},
            "FRC_ReadError": lambda _: {"Count": 1, "ErrorData": next(iter(self.cabinet.messages[-1:]), "")},
            "FRC_ReadTCPSpeed": lambda _: {"TimeTag": _tag(), "Speed": 0.0},
        }
        return known[name](packet)

    # ---- commands

    def _initialised(self, ready: bool) -> dict[str, Any]:
        if ready and self.cabinet.phase == "running":
            raise NotDoneError("busy")
        self.ready, self.next_sequence = ready, 1
        return {"GroupMask": 1} if ready else {}

    def _stopped(self) -> dict[str, Any]:
        self.cabinet.stop()
        self.ready = False
        return {}

    def _paused(self) -> dict[str, Any]:
        self.cabinet.pause()
        return {}

    def _continued(self) -> dict[str, Any]:
        self.cabinet.start()
        return {}

    def _status(self) -> dict[str, Any]:
        return {
            "ServoReady": int(self.cabinet.motors_on),
            "TPMode": int(self.cabinet.mode == "manual"),
            "RMIMotionStatus": int(self.ready),
            "ProgramStatus": {"stopped": 2, "paused": 1, "running": 0}[self.cabinet.phase],
            "SingleStepMode": 0,
            "NumberUTool": 10,
            "NextSequenceID": self.next_sequence,
            "NumberUFrame": 9,
            "Override": int(self.values.system["$MCR.$GENOVERRIDE"]),
        }

    def _joints(self) -> dict[str, float]:
        joints = (*(self.cabinet.joints or ()), *(0.0,) * 9)[:9]
        return {f"J{number}": value for number, value in enumerate(joints, 1)}

    def _place(self) -> dict[str, Any]:
        here = position_of(self.values.place())
        position = dict(zip("XYZWPR", here.xyzwpr, strict=True)) | {f"Ext{number}": 0.0 for number in (1, 2, 3)}
        names = ("Flip", "Left", "Up", "Front", "Turn4", "Turn5", "Turn6")
        frames = {"UToolNumber": self.tool, "UFrameNumber": self.frame}
        return {"Configuration": frames | dict(zip(names, here.posture, strict=True)), "Position": position}

    def _switched(self, packet: Packet) -> dict[str, Any]:
        self.cabinet.set_signal(f"DO[{int(packet['PortNumber'])}]", packet["PortValue"] in ("ON", 1))
        return {}

    def _overridden(self, packet: Packet) -> dict[str, Any]:
        value = int(packet["Value"])
        if not 0 < value <= 100:
            raise ValueError(value)
        self.values.system["$MCR.$GENOVERRIDE"] = float(value)
        return {}

    def _frames(self, packet: Packet) -> dict[str, Any]:
        self.frame, self.tool = int(packet["UFrameNumber"]), int(packet["UToolNumber"])
        return {"Group": 1}

    # ---- instructions

    async def _instructed(self, name: str, packet: Packet) -> dict[str, Any]:
        if name == "FRC_SetUFrame":
            self.frame = int(packet["FrameNumber"])
        elif name == "FRC_SetUTool":
            self.tool = int(packet["ToolNumber"])
        elif name != "FRC_SetPayLoad":
            listing = _lines(name, packet, self.frame, self.tool)
            await carried_out(self.cabinet, PROGRAM, listing, calls=name == "FRC_Call")
        return {}


async def carried_out(cabinet: Cabinet, program: str, listing: str, calls: bool = False) -> None:
    """Run a program of one instruction, from where the robot stands, to its end. calls: one that calls others, which
    are read with it. Raises NotDoneError."""
    name = f"{program}.LS"
    cabinet.store.put([(name, listing.encode("latin-1"))])
    others = [one for one in cabinet.store.names() if one.lower().endswith((".ls", ".va")) and ".." not in one]
    if cabinet.select([name, *(one for one in others if one != name)] if calls else [name], program):
        raise NotDoneError("syntax", listing)
    before = len(cabinet.messages)
    cabinet.start()
    while cabinet.phase != "stopped":
        await asyncio.sleep(_LOOK_S)
        cabinet.advance()
    if len(cabinet.messages) > before:
        raise NotDoneError("emergency-stop", cabinet.messages[-1])


def _has(packet: object, word: str) -> bool:
    return isinstance(packet, dict) and isinstance(packet.get(word), str)


def _tag() -> int:
    """A moment in ms that fits into 32 bits."""
    return int(time.monotonic() * 1000.0) % 2**31


def _lines(name: str, packet: Packet, frame: int, tool: int) -> str:
    """The listing of an instruction. Raises KeyError, ValueError."""
    if name == "FRC_WaitTime":
        return listing_of(f"WAIT {float(packet['Time']):.2f}(sec)", "", PROGRAM)
    if name == "FRC_WaitDIN":
        value = "ON" if packet["PortValue"] in ("ON", 1) else "OFF"
        return listing_of(f"WAIT DI[{int(packet['PortNumber'])}]={value}", "", PROGRAM)
    if name == "FRC_Call":
        return listing_of(f"CALL {packet['ProgramName']}", "", PROGRAM)
    letter = {"FRC_JointMotion": "J", "FRC_LinearMotion": "L"}[name.removesuffix("JRep")]
    term = str(packet["TermType"])
    ending = term if term == "FINE" else f"CNT{int(packet.get('TermValue', 100))}"
    move = f"{letter} P[1] {_speed(packet, letter)} {ending}"
    return listing_of(
        f"UFRAME_NUM={frame} ;\n   2:  UTOOL_NUM={tool} ;\n   3:{move}", target_text(packet, frame, tool), PROGRAM
    )


def _speed(packet: Packet, letter: str) -> str:
    """A speed as listings have it: percent, mm/s, or the time that the move takes."""
    kind, value = str(packet["SpeedType"]), float(packet["Speed"])
    if kind in ("Time", "TimeSec"):
        return f"{value / 10.0:.1f}sec" if kind == "Time" else f"{value:.1f}sec"
    if kind in ("mSec", "MilliSeconds"):
        return f"{int(value)}msec"
    if kind in ("InchMin",):
        return f"{value / 10.0:.1f}inch/min"
    return f"{int(value)}{'%' if letter == 'J' else 'mm/sec'}"


def target_text(packet: Packet, frame: int, tool: int) -> str:
    """P[1] of a listing, of joints or of a place."""
    if "JointAngle" in packet:
        values = packet["JointAngle"]
        body = ",\n".join(f"\tJ{number}= {float(values[f'J{number}']):.4f} deg" for number in range(1, 7))
        return f"P[1]{{\n   GP1:\n\tUF : {frame}, UT : {tool},\n{body}\n}};\n"
    place, bits = packet["Position"], packet["Configuration"]
    letters = [
        "F" if bits["Flip"] else "N",
        *(["L"] if bits["Left"] else []),
        "U" if bits["Up"] else "D",
        "T" if bits["Front"] else "B",
    ]
    turns = f"0, {int(bits['Turn4'])}, {int(bits['Turn6'])}"  # M: a listing has those of joints 1, 4 and 6
    units = {"X": "mm", "Y": "mm", "Z": "mm", "W": "deg", "P": "deg", "R": "deg"}
    body = ",\n".join(f"\t{axis} = {float(place[axis]):.4f} {unit}" for axis, unit in units.items())
    config = f"CONFIG : '{' '.join(letters)}, {turns}'"
    return f"P[1]{{\n   GP1:\n\tUF : {frame}, UT : {tool}, {config},\n{body}\n}};\n"


async def start_remote(cabinet: Cabinet, endpoints: Endpoints, values: Values) -> None:
    """Open the port that connections are asked for at, and the one of sessions."""
    remote = Remote(values, lambda: endpoints.ports["rmi-session"])
    handler: Callable[[asyncio.StreamReader, asyncio.StreamWriter], Awaitable[None]] = remote.serve
    await endpoints.stream("rmi", 16001, handler)
    await endpoints.stream("rmi-session", 16002, handler)
