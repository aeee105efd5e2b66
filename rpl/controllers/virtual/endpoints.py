"""Where the interfaces of a virtual controller listen: streams, datagrams, and servers of libraries beside them.

Every virtual robot has an address of its own, because many clients cannot be told another port; loopback only, unless
the user says otherwise.
"""

from __future__ import annotations

import asyncio
import ipaddress
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass, field

from rpl.controllers.virtual.faults import DroppedError
from rpl.errors import UsageError

Handler = Callable[[asyncio.StreamReader, asyncio.StreamWriter], Awaitable[None]]
# A handler that is cancelled: the controller is switched off.
_LOST = (ConnectionError, asyncio.IncompleteReadError, asyncio.CancelledError, DroppedError)


@dataclass
class Endpoints:
    """host: the address. wanted: ports by interface that are not the usual ones, 0: any free one. any_port: where the
    usual one may not be had, take a free one. `ports`: where each interface listens now."""

    host: str
    wanted: Mapping[str, int] = field(default_factory=dict)
    any_port: bool = False
    ports: dict[str, int] = field(default_factory=dict)
    _closing: list[Callable[[], Awaitable[None] | None]] = field(default_factory=list)
    _running: set[asyncio.Task[None]] = field(default_factory=set)

    def port(self, interface: str, usual: int) -> int:
        """The port that an interface is to take: 0 for any free one."""
        return self.wanted.get(interface, 0 if self.any_port else usual)

    def opened(self, interface: str, port: int, close: Callable[[], Awaitable[None] | None]) -> None:
        """A server of a library listens there."""
        self.ports[interface] = port
        self._closing.append(close)

    async def stream(self, interface: str, usual: int, handler: Handler) -> None:
        """Listen for connections. A handler that raises DroppedError, or whose client goes away, ends its connection.
        Raises UsageError when the port cannot be had."""

        async def guarded(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
            task = asyncio.current_task()
            assert task is not None  # this runs in one
            self._running.add(task)
            try:
                await handler(reader, writer)
            except _LOST:
                writer.transport.abort()
            finally:
                self._running.discard(task)
                writer.close()

        try:
            server = await asyncio.start_server(guarded, self.host, self.port(interface, usual))
        except OSError as error:
            raise not_had(self.host, interface, self.port(interface, usual), error) from None
        self.opened(interface, server.sockets[0].getsockname()[1], server.close)

    async def datagrams(self, interface: str, usual: int, protocol: asyncio.DatagramProtocol) -> None:
        """Listen for datagrams. Raises UsageError when the port cannot be had."""
        loop = asyncio.get_running_loop()
        try:
            transport, _ = await loop.create_datagram_endpoint(
                lambda: protocol, local_addr=(self.host, self.port(interface, usual))
            )
        except OSError as error:
            raise not_had(self.host, interface, self.port(interface, usual), error) from None
        self.opened(interface, transport.get_extra_info("sockname")[1], transport.close)

    def beside(self, work: Awaitable[None]) -> None:
        """Work that goes on until the controller is switched off (a cycle that sends values)."""

        async def awaited() -> None:
            await work

        task = asyncio.get_running_loop().create_task(awaited())
        self._running.add(task)
        task.add_done_callback(self._running.discard)

    async def close(self) -> None:
        """Switch off."""
        running = tuple(self._running)
        for task in running:
            task.cancel()
        await asyncio.gather(*running, return_exceptions=True)
        for close in reversed(self._closing):
            waiting = close()
            if waiting is not None:
                await waiting


def not_had(host: str, interface: str, port: int, error: OSError) -> UsageError:
    """The error of a port that cannot be listened at."""
    return UsageError(
        f"{interface} cannot listen at {host}:{port}: {error.strerror or error}; give another address with --host, or "
        f"another port with --port {interface}=NUMBER, or --any-port"
    )


def checked_host(host: str, anywhere: bool) -> str:
    """The address, if it is one of this machine alone, or the user says that others may come. Raises UsageError."""
    try:
        address = ipaddress.ip_address("127.0.0.1" if host == "localhost" else host)
    except ValueError:
        raise UsageError(f"--host {host}: this is no address; 127.0.0.2, for example, is one of this machine") from None
    if not address.is_loopback and not anywhere:
        raise UsageError(f"--host {host}: others could reach it, and it asks nobody who he is; --anywhere allows it")
    return str(address)
