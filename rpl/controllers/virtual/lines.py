"""Interfaces that are asked by lines of words: one line there, one answer back, and how they misbehave."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from rpl.controllers.virtual.cabinet import Cabinet
from rpl.controllers.virtual.transcript import Kind

_LONGEST = 4096
_NOISE = bytes(range(128, 256)) * 2


async def line_of(reader: asyncio.StreamReader) -> str | None:
    """The next line, None at the end and for one that is too long to be meant."""
    try:
        line = await reader.readuntil(b"\n")
    except (asyncio.IncompleteReadError, asyncio.LimitOverrunError):
        return None
    return line.decode("utf-8", "replace").strip() if len(line) <= _LONGEST else None


async def answer(
    cabinet: Cabinet,
    writer: asyncio.StreamWriter,
    interface: str,
    asked: tuple[Kind, str],
    work: Callable[[], str],
) -> None:
    """Carry out what was asked and answer with a line, or misbehave. Raises DroppedError."""
    faults = cabinet.faults
    cabinet.told(interface, *asked)
    await asyncio.sleep(faults.delay_s)
    said = work()
    cabinet.after()
    if faults.comes("endless"):
        while True:
            writer.write(b"and so on " * 100)
            await writer.drain()
    writer.write(_NOISE + b"\n" if faults.comes("garbage") else f"{said}\n".encode())
    await writer.drain()
