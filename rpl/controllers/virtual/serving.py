"""One virtual controller from switching on to SIGTERM."""

from __future__ import annotations

import asyncio
import gc
import selectors
import signal
from collections.abc import Callable

from rpl.controllers.vendors import Vendor
from rpl.controllers.virtual.cabinet import Cabinet
from rpl.controllers.virtual.endpoints import Endpoints
from rpl.errors import UsageError

# How often the program of the controller is let run on while nobody asks (s of real time).
CYCLE_S = 0.004


def serve(vendor: Vendor, cabinet: Cabinet, endpoints: Endpoints, ready: Callable[[dict[str, object]], None]) -> None:
    """Open the maker's interfaces, tell `ready` where they are, and go on until SIGTERM or Ctrl-C."""
    with asyncio.Runner(loop_factory=_fine_loop) as runner:
        runner.run(_serve(vendor, cabinet, endpoints, ready))


def _fine_loop() -> asyncio.AbstractEventLoop:
    """Cycles of 2 ms need moments finer than the whole milliseconds that epoll and poll wait for."""
    return asyncio.SelectorEventLoop(selectors.SelectSelector())


async def _serve(
    vendor: Vendor, cabinet: Cabinet, endpoints: Endpoints, ready: Callable[[dict[str, object]], None]
) -> None:
    start = vendor.start
    if start is None:
        raise UsageError(f"there is no virtual controller of {vendor.name}")
    over = asyncio.Event()
    loop = asyncio.get_running_loop()
    for number in (signal.SIGTERM, signal.SIGINT):
        loop.add_signal_handler(number, over.set)
    try:
        await start(cabinet, endpoints)
        gc.freeze()  # what was loaded stays: looking through it would cost several cycles each time
        ready({"vendor": vendor.name, "host": endpoints.host, "ports": dict(endpoints.ports)})
        endpoints.beside(_run_on(cabinet))
        await over.wait()
    finally:
        await endpoints.close()


async def _run_on(cabinet: Cabinet) -> None:
    """Scheduled on absolute moments, so that what a cycle takes does not make it drift."""
    loop = asyncio.get_running_loop()
    due = loop.time()
    while True:
        cabinet.advance()
        due = max(due + CYCLE_S, loop.time())
        await asyncio.sleep(due - loop.time())
