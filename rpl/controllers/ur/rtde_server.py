"""RTDE of the virtual controller (TCP 30004): recipes, registers that belong to a client, values at the controller's
cycle.

What one tick gives is worked out once for all clients, at absolute moments, so that nothing drifts. An input that
another client has is IN_USE; a name that there is not is NOT_FOUND. Recipes are numbered 1, 2, ... for each connection,
as ur-rtde takes for granted.
"""

from __future__ import annotations

import asyncio
import struct
from collections.abc import Callable
from dataclasses import dataclass, field

from rpl.controllers.ur import rtde
from rpl.controllers.ur.panel import VERSION, Panel
from rpl.controllers.ur.rtde import Recipe, package
from rpl.controllers.ur.variables import INPUT_TYPES, OUTPUTS, Moment, apply

RATE_HZ = 500.0
_MOST_BEHIND = 2**20  # bytes that a client may leave unread
_WORDS = {
    rtde.PROTOCOL: "protocol version",
    rtde.CONTROLLER: "controller version",
    rtde.MESSAGE: "message",
    rtde.OUTPUTS: "outputs",
    rtde.INPUTS: "inputs",
    rtde.START: "start of values",
    rtde.PAUSE: "pause of values",
}


@dataclass
class Client:
    """One connection. every: how many ticks lie between its values."""

    writer: asyncio.StreamWriter
    wanted: Recipe | None = None
    every: int = 1
    started: bool = False
    inputs: list[Recipe] = field(default_factory=list)
    owned: set[str] = field(default_factory=set)


class Rtde:
    """All clients of the port."""

    def __init__(self, panel: Panel, moment: Moment) -> None:
        self.panel = panel
        self.moment = moment
        self.clients: list[Client] = []

    async def serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """One client, to its end."""
        client = Client(writer)
        self.clients.append(client)
        try:
            while True:
                head = await reader.readexactly(rtde.HEADER.size)
                size, kind = rtde.HEADER.unpack(head)
                if size < rtde.HEADER.size:
                    return
                payload = await reader.readexactly(size - rtde.HEADER.size)
                if kind == rtde.DATA:
                    self._set(client, payload)
                else:
                    await self._answer(client, kind, payload)
        except (struct.error, UnicodeDecodeError):
            return  # what is no package ends the connection
        finally:
            self.clients.remove(client)

    def _set(self, client: Client, payload: bytes) -> None:
        """What is too short for its recipe is passed by, and what is longer is cut: ur-rtde 1.6.5 asks for forward
        kinematics with a tool by more values than the recipe has."""
        number = payload[0] if payload else 0
        if not 0 < number <= len(client.inputs):
            return
        recipe = client.inputs[number - 1]
        if len(payload) < recipe.packing.size:
            return
        values = recipe.unpacked(payload[: recipe.packing.size])
        said = " ".join(f"{name}={value}" for name, value in values.items())
        self.panel.cabinet.told("rtde", "set", said, counts=False)
        apply(self.panel, values)

    async def _answer(self, client: Client, kind: int, payload: bytes) -> None:
        cabinet = self.panel.cabinet
        cabinet.told("rtde", "look", f"{_WORDS.get(kind, f'type {kind}')} {_shown(kind, payload)}".strip())
        await asyncio.sleep(cabinet.faults.delay_s)
        said = self._said(client, kind, payload)
        cabinet.after()
        if cabinet.faults.comes("garbage"):
            said = b"\x00\x01\xff\xfe noise"
        while cabinet.faults.comes("endless"):
            cabinet.faults.stays = True
            client.writer.write(package(rtde.MESSAGE, b"\x02no\x02us\x03") * 100)
            await client.writer.drain()
        if said:
            client.writer.write(said)
            await client.writer.drain()
        if kind == rtde.START:
            client.started = client.wanted is not None

    def _said(self, client: Client, kind: int, payload: bytes) -> bytes:
        if kind == rtde.PROTOCOL:
            return package(kind, bytes([payload == struct.pack(">H", rtde.VERSION)]))
        if kind == rtde.CONTROLLER:
            return package(kind, struct.pack(">4I", *VERSION))
        if kind == rtde.OUTPUTS:
            return package(kind, self._wanted(client, payload))
        if kind == rtde.INPUTS:
            return package(kind, self._given(client, payload))
        if kind == rtde.START:
            return package(kind, bytes([client.wanted is not None]))
        if kind == rtde.PAUSE:
            client.started = False
            return package(kind, b"\x01")
        return b""  # a message of the client: into its log, unanswered

    def _wanted(self, client: Client, payload: bytes) -> bytes:
        (rate,) = struct.unpack(">d", payload[:8])
        names = _names(payload[8:])
        types = [OUTPUTS[name][0] if name in OUTPUTS else "NOT_FOUND" for name in names]
        if "NOT_FOUND" in types or not 0.0 < rate <= RATE_HZ:
            return b"\x00" + ",".join(types).encode()
        client.wanted = rtde.recipe(1, names, types)
        client.every = max(round(RATE_HZ / rate), 1)
        return b"\x01" + ",".join(types).encode()

    def _given(self, client: Client, payload: bytes) -> bytes:
        names = _names(payload)
        taken = {name for other in self.clients if other is not client for name in other.owned}
        types = [
            "NOT_FOUND" if name not in INPUT_TYPES else "IN_USE" if name in taken else INPUT_TYPES[name]
            for name in names
        ]
        if "NOT_FOUND" in types or "IN_USE" in types:
            return b"\x00" + ",".join(types).encode()
        number = len(client.inputs) + 1
        client.inputs.append(rtde.recipe(number, names, types))
        client.owned.update(names)
        return bytes([number]) + ",".join(types).encode()

    def send(self, tick: int) -> None:
        """The values of this tick to all that want them."""
        packed: dict[tuple[str, ...], bytes] = {}
        for client in tuple(self.clients):
            wanted = client.wanted
            if not client.started or wanted is None or tick % client.every:
                continue
            if client.writer.transport.get_write_buffer_size() > _MOST_BEHIND:
                client.writer.transport.abort()
                continue
            data = packed.get(wanted.names)
            if data is None:
                data = packed[wanted.names] = wanted.packed([OUTPUTS[name][1](self.moment) for name in wanted.names])
            client.writer.write(data)


def _names(text: bytes) -> list[str]:
    """ur-rtde ends the list with a comma; the empty name behind it is none."""
    return [name for name in text.decode("ascii").split(",") if name]


def _shown(kind: int, payload: bytes) -> str:
    text = payload[8:] if kind == rtde.OUTPUTS else payload if kind in (rtde.INPUTS, rtde.MESSAGE) else b""
    return text.decode("ascii", "replace")


async def tick(moment: Moment, listeners: list[Callable[[int], None]]) -> None:
    """Let the program run on and tell all who listen, at the controller's rate; a cycle that comes late shortens the
    next wait, and cycles that were missed altogether are left out."""
    loop = asyncio.get_running_loop()
    began, number = loop.time(), 0
    while True:
        moment.panel.cabinet.advance()
        moment.look()
        for listener in listeners:
            listener(number)
        number = max(number + 1, int((loop.time() - began) * RATE_HZ))
        await asyncio.sleep(began + number / RATE_HZ - loop.time())
