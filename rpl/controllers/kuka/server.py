"""A virtual controller of KUKA: C3 Bridge Interface, and KukavarProxy by its first two messages, on one port.

What the messages hold is in `c3`; what the controller's file service answers in which case is not said anywhere, and is
guessed from the names of the error codes.
"""

from __future__ import annotations

import asyncio
import re
from collections.abc import Callable, Mapping
from pathlib import PurePosixPath

from rpl.controllers.kuka import c3
from rpl.controllers.kuka.c3 import MessageError, Reader
from rpl.controllers.kuka.variables import SystemVariables, VariableError
from rpl.controllers.virtual.cabinet import Cabinet
from rpl.controllers.virtual.endpoints import Endpoints
from rpl.controllers.virtual.store import ROOM, NotDoneError, Why
from rpl.controllers.virtual.transcript import Kind

_CODES: Mapping[Why, int] = {
    "missing": c3.GENERAL,
    "protected": c3.ACCESS,
    "full": c3.MEMORY,
    "busy": c3.ACCESS,
    "syntax": c3.GENERAL,
    "name": c3.ARGUMENT,
    "exists": c3.ACCESS,
    "emergency-stop": c3.ACCESS,
}
_KINDS: Mapping[int, Kind] = {
    c3.READ_ASCII: "look",
    c3.READ: "look",
    c3.READ_MANY: "look",
    c3.WRITE_ASCII: "set",
    c3.WRITE: "set",
    c3.WRITE_MANY: "set",
    c3.MOTION: "start",
    c3.KEYS: "start",
    c3.PROXY_INFO: "look",
    c3.PROXY_FEATURES: "look",
    c3.LIST: "list",
    c3.PROPERTIES: "list",
    c3.READ_FILE: "read",
    c3.DELETE: "delete",
    c3.SET_ATTRIBUTES: "write",
    c3.CREATE: "write",
    c3.COPY: "write",
    c3.MOVE: "write",
    c3.WRITE_FILE: "write",
}
_PROGRAM: Mapping[int, Kind] = {
    c3.PROGRAM_RESET: "select",
    c3.PROGRAM_START: "start",
    c3.PROGRAM_STOP: "stop",
    c3.PROGRAM_CANCEL: "stop",
    c3.PROGRAM_SELECT: "select",
    c3.PROGRAM_RUN: "start",
}
_PROGRAMS = "R1/Program"
_MODULE = re.compile(r"([^\\/()]+?)(?:\.src)?(?:\(\s*\))?", re.IGNORECASE)
_MUCH = bytes(range(256)) * 256


def place_of(path: str) -> str:
    """Where a file is, by the path that a client gives: `KRC:\\R1\\Program\\A.SRC` or `/R1/A.SRC`, both mean the same;
    a file of no folder is a program."""
    parts = [part for part in path.replace("\\", "/").split("/") if part]
    if parts and parts[0].endswith(":"):
        parts = parts[1:]
    elif parts and "R1" in [part.upper() for part in parts]:
        parts = parts[[part.upper() for part in parts].index("R1") :]
        if len(parts) < 2 or parts[1].lower() not in ("program", "system", "mada", "tp"):
            parts = ["R1", "Program", *parts[1:]]
    else:
        parts = ["R1", "Program", *parts]
    return "/".join(parts)


class Session:
    """One client: what it writes and reads is collected here until it says that it is done."""

    def __init__(self, cabinet: Cabinet, variables: SystemVariables) -> None:
        self.cabinet = cabinet
        self.store = cabinet.store
        self.variables = variables
        self.coming = bytearray()
        self.going = b""
        self.endless = False
        self.carried: Mapping[int, Callable[[Reader], bytes]] = {
            c3.READ_ASCII: self._read,
            c3.WRITE_ASCII: self._write,
            c3.READ: self._read_wide,
            c3.WRITE: self._write_wide,
            c3.PROGRAM: self._program,
            c3.SET_ATTRIBUTES: self._attributes,
            c3.LIST: self._list,
            c3.CREATE: self._create,
            c3.DELETE: self._delete,
            c3.COPY: self._copy,
            c3.MOVE: self._move,
            c3.PROPERTIES: self._properties,
            c3.FULL_NAME: self._full_name,
            c3.KRC_NAME: self._krc_name,
            c3.WRITE_FILE: self._write_file,
            c3.READ_FILE: self._read_file,
        }

    def answered(self, tag: int, kind: int, said: bytes) -> bytes | None:
        """The bytes of the answer; None: the connection is ended, as C3 Bridge does for types that it does not know."""
        about = _PROGRAM.get(said[0], "other") if kind == c3.PROGRAM and said else _KINDS.get(kind, "other")
        self.cabinet.told("c3", about, f"#{kind} {_shown(said)}")
        carried = self.carried.get(kind)
        if carried is None:
            return None
        faults = self.cabinet.faults
        garbled, self.endless = faults.comes("garbage"), faults.comes("endless")
        code = c3.SUCCESS
        try:
            told = carried(Reader(said))
        except MessageError:
            told, code = b"", c3.PROTOCOL
        except VariableError:
            told, code = c3.narrow(b""), c3.GENERAL
        except NotDoneError as why:
            told, code = said[:1] if kind in (c3.WRITE_FILE, c3.PROGRAM) else b"", _CODES[why.why]
            if kind == c3.READ_FILE:
                told = said[:1] + c3.number(0)
        self.cabinet.after()
        if len(told) > c3.CHUNK + 16:
            told, code = b"", c3.LONG_ANSWER
        packet = c3.answer(tag, kind, told, code)
        if garbled:
            return bytes(reversed(packet)) + b"noise"
        return packet[:2] + b"\xff\xff" + packet[4:5] if self.endless else packet

    # ---- variables

    def _read(self, reader: Reader) -> bytes:
        return c3.narrow(self.variables.read(reader.narrow().decode("cp1252")).encode("cp1252", "replace"))

    def _read_wide(self, reader: Reader) -> bytes:
        return c3.wide(self.variables.read(reader.wide()))

    def _write(self, reader: Reader) -> bytes:
        name, value = (reader.narrow().decode("cp1252") for _ in range(2))
        self.variables.write(name, value)
        return c3.narrow(value.encode("cp1252", "replace"))

    def _write_wide(self, reader: Reader) -> bytes:
        name, value = reader.wide(), reader.wide()
        self.variables.write(name, value)
        return c3.wide(value)

    # ---- the program

    def _program(self, reader: Reader) -> bytes:
        command, _ = reader.byte(), reader.short()
        cabinet = self.cabinet
        if command in (c3.PROGRAM_SELECT, c3.PROGRAM_RUN):
            self._select(reader.wide())
        if command == c3.PROGRAM_RESET and cabinet.program:
            self._select(cabinet.program)
        if command in (c3.PROGRAM_START, c3.PROGRAM_RUN):
            if not cabinet.motors_on:
                raise NotDoneError("emergency-stop" if cabinet.emergency_stop else "busy")
            cabinet.start()
        if command == c3.PROGRAM_STOP:
            cabinet.pause()
        if command == c3.PROGRAM_CANCEL:
            cabinet.stop()
            cabinet.program = ""
        return bytes((command,))

    def _select(self, name: str) -> None:
        found = _MODULE.fullmatch(re.split(r"[\\/]", name)[-1])
        stem = found[1] if found is not None else name
        modules = [one for one in self.store.names() if one.lower().endswith((".src", ".dat"))]
        if stem.lower() not in {PurePosixPath(one).stem.lower() for one in modules}:
            raise NotDoneError("missing", name)
        if self.cabinet.phase == "running":
            raise NotDoneError("busy")
        if self.cabinet.select(modules, stem):
            raise NotDoneError("syntax", name)

    # ---- files

    def _list(self, reader: Reader) -> bytes:
        reader.number()
        flags, path = reader.number(), reader.wide()
        below = place_of(path).lower().rstrip("/") + "/"
        names = []
        for name in self.store.names():
            rest = name[len(below) :] if name.lower().startswith(below) else name if name.startswith("..") else ""
            if rest and (flags & c3.RECURSIVE or "/" not in rest.removeprefix("../..")):
                names.append(rest.replace("/", "\\"))
        listed = len(names).to_bytes(2, "big") + b"".join(c3.wide(name) for name in names)
        return listed + bytes(2)

    def _delete(self, reader: Reader) -> bytes:
        reader.byte()
        self.store.delete(place_of(reader.wide()))
        return b""

    def _create(self, reader: Reader) -> bytes:
        reader.take(4)
        self.store.write(place_of(reader.wide()), b"")
        return b""

    def _copy(self, reader: Reader) -> bytes:
        flags, source, destination = reader.number(), place_of(reader.wide()), place_of(reader.wide())
        self._may_replace(destination, flags)
        self.store.write(destination, self.store.read(source))
        return b""

    def _move(self, reader: Reader) -> bytes:
        flags, source, destination = reader.number(), place_of(reader.wide()), place_of(reader.wide())
        self._may_replace(destination, flags)
        self.store.rename(source, destination)
        return b""

    def _may_replace(self, name: str, flags: int) -> None:
        if name in self.store and not flags & c3.OVERWRITE:
            raise NotDoneError("exists", name)

    def _attributes(self, reader: Reader) -> bytes:
        attributes, mask, name = reader.number(), reader.number(), place_of(reader.wide())
        self.store.kept(name)
        if mask & c3.ATTRIBUTE_READ_ONLY:
            self.store.protect(name, bool(attributes & c3.ATTRIBUTE_READ_ONLY))
        return b""

    def _properties(self, reader: Reader) -> bytes:
        reader.number()
        path = reader.wide()
        size = self.store.size(place_of(path))
        numbers = (16, size & 0xFFFF_FFFF, size >> 32, 32, *[0] * 9, 0)
        return b"".join(map(c3.number, numbers)) + c3.wide(re.split(r"[\\/]", path)[-1])

    def _full_name(self, reader: Reader) -> bytes:
        return c3.wide("KRC:\\" + place_of(reader.wide()).replace("/", "\\"))

    def _krc_name(self, reader: Reader) -> bytes:
        place = place_of(reader.wide())
        return c3.wide("/" + (f"R1{place[len(_PROGRAMS) :]}" if place.startswith(_PROGRAMS) else place))

    def _write_file(self, reader: Reader) -> bytes:
        operation = reader.byte()
        head = bytes((operation,))
        if operation == c3.BEGIN:
            size = reader.number()
            if size > ROOM:
                raise NotDoneError("full")
            self.coming = bytearray(size)
            return head + c3.number(size)
        if operation == c3.GET_SIZE:
            return head + c3.number(len(self.coming))
        if operation == c3.DATA:
            offset, size = reader.number(), reader.number()
            size = min(size, max(0, len(self.coming) - offset))
            self.coming[offset : offset + size] = reader.take(size)
            return head + c3.number(offset) + c3.number(size)
        if operation == c3.END:
            flags, name = reader.number(), place_of(reader.wide())
            self._may_replace(name, flags)
            self.store.write(name, bytes(self.coming))
            self.coming = bytearray()
            return head
        raise MessageError

    def _read_file(self, reader: Reader) -> bytes:
        operation = reader.byte()
        head = bytes((operation,))
        if operation == c3.BEGIN:
            reader.number()
            name = place_of(reader.wide())
            self.going = self.store.read(name)
            return head + c3.number(min(self.store.size(name), 0xFFFF_FFFF))
        if operation == c3.GET_SIZE:
            return head + c3.number(len(self.going))
        if operation == c3.DATA:
            offset, size = reader.number(), reader.number()
            part = self.going[offset : offset + min(size, c3.CHUNK)]
            return head + c3.number(offset) + c3.number(len(part)) + part
        if operation == c3.END:
            self.going = b""
            return head
        raise MessageError


def _shown(said: bytes) -> str:
    """What a message says, for the transcript: letters as they are, what is none of them left out."""
    return "".join(chr(byte) for byte in said[:400] if 32 <= byte < 127)


async def start(cabinet: Cabinet, endpoints: Endpoints) -> None:
    """Open the port."""
    cabinet.store.renamed(place_of)
    cabinet.store.fold_names()
    variables = SystemVariables(cabinet)

    async def handle(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        session = Session(cabinet, variables)
        cabinet.transcript.add("c3", "connect", str(writer.get_extra_info("peername")))
        while True:
            tag, count, kind = c3.HEAD.unpack(await reader.readexactly(c3.HEAD.size))
            if count < 1:
                return
            packet = session.answered(tag, kind, await reader.readexactly(count - 1))
            if packet is None:
                return
            await asyncio.sleep(cabinet.faults.delay_s)
            writer.write(packet)  # one answer is one segment: py-openshowvar reads but once
            await writer.drain()
            while session.endless:
                writer.write(_MUCH)
                await writer.drain()

    await endpoints.stream("c3", 7000, handle)
