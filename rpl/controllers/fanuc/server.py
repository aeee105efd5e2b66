"""A virtual FANUC controller: FTP over its memory, the panel interface, remote motion, Stream Motion, MAPPDK."""

from __future__ import annotations

from rpl.controllers.fanuc.driver import Driver
from rpl.controllers.fanuc.memory import Memory, as_kept, rewritten
from rpl.controllers.fanuc.motion import start_remote
from rpl.controllers.fanuc.panel import Panel
from rpl.controllers.fanuc.streaming import start_streaming
from rpl.controllers.fanuc.values import Values
from rpl.controllers.virtual.cabinet import Cabinet
from rpl.controllers.virtual.endpoints import Endpoints
from rpl.errors import UsageError


async def start(cabinet: Cabinet, endpoints: Endpoints) -> None:
    """Open all interfaces. Raises UsageError when a port cannot be had, or the extra [ftp] is not installed."""
    memory = Memory(cabinet)
    cabinet.store.fold_names()
    cabinet.store.put([(name, as_kept(cabinet.store.kept(name))) for name in cabinet.store.names() if ".." not in name])
    cabinet.store.may_write, cabinet.store.accepts, cabinet.store.rewrite = memory.may_write, memory.loads, rewritten
    try:
        from rpl.controllers.ftp.server import serve_files
    except ModuleNotFoundError as error:
        if error.name is None or not error.name.startswith("pyftpdlib"):
            raise
        raise UsageError("a virtual FANUC controller needs pyftpdlib: pip install 'robot-rpl[ftp]'") from None
    serve_files(cabinet, endpoints, memory, ("MD:", "MDB:"), banner="R-30iB FTP server ready.")
    values = Values(cabinet)
    values.read_dumps()
    await endpoints.stream("snpx", 60008, lambda reader, writer: Panel(values).serve(reader, writer))
    await start_remote(cabinet, endpoints, values)
    await start_streaming(endpoints, values)
    await endpoints.stream("mappdk", 18735, lambda reader, writer: Driver(values).serve(reader, writer))
