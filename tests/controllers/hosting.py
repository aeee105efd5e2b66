"""A virtual controller in a thread of the test's own process: quick to start, and its inside can be looked at."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rpl.controllers.profile import Profile
from rpl.controllers.vendors import vendor
from rpl.controllers.virtual.cabinet import Cabinet
from rpl.controllers.virtual.endpoints import Endpoints
from rpl.controllers.virtual.faults import fault_of
from rpl.controllers.virtual.store import Store
from rpl.emulator.model import load_robot

HOST = "127.0.0.1"
_STARTED_S = 60.0
# What no transfer of programs may ever ask for.
MOTION = {"start", "select", "servo"}


@dataclass
class Hosted:
    """The controller's inside, and where its interfaces listen."""

    cabinet: Cabinet
    endpoints: Endpoints

    def profile(self, folder: Path, patience_s: float = 10.0, **more: Any) -> Profile:
        made = vendor(self.cabinet.vendor)
        return Profile(
            "here",
            made.name,
            made.rules,
            made.ports,
            made.path,
            host=HOST,
            ports=self.endpoints.ports,
            patience_s=patience_s,
            state_folder=folder / ".rpl",
            **{"user": "robot", "given_password": "robot", **more},
        )

    def kinds(self) -> set[str]:
        """What kinds of requests came."""
        return {one.kind for one in self.cabinet.transcript.requests}


@contextmanager
def hosted(maker: str, files: Mapping[str, bytes], fault: str = "", robot: str = "") -> Iterator[Hosted]:
    """The controller of a maker with these files and that fault, until the block ends."""
    made, faults = vendor(maker), fault_of(fault)
    assert made.start is not None and made.dialect is not None
    store = Store(faults)
    cabinet = Cabinet(made.name, made.dialect, load_robot(robot) if robot else None, store, faults)
    store.may_write = cabinet.may_write
    store.put(files.items())
    endpoints = Endpoints(HOST, any_port=True)
    loop = asyncio.new_event_loop()
    thread = threading.Thread(target=loop.run_forever, daemon=True)
    thread.start()
    try:
        asyncio.run_coroutine_threadsafe(_start(made.start(cabinet, endpoints)), loop).result(_STARTED_S)
        yield Hosted(cabinet, endpoints)
    finally:
        asyncio.run_coroutine_threadsafe(_ended(endpoints), loop).result(_STARTED_S)
        loop.call_soon_threadsafe(loop.stop)
        thread.join(_STARTED_S)
        loop.close()


async def _start(started: Any) -> None:
    await started


async def _ended(endpoints: Endpoints) -> None:
    """Close, and let what still serves a client come to its end."""
    await endpoints.close()
    serving = [task for task in asyncio.all_tasks() if task is not asyncio.current_task()]
    for task in serving:
        task.cancel()
    await asyncio.gather(*serving, return_exceptions=True)
