"""The FTP server of the virtual controller: the same jobs as by the High-Speed Ethernet Server.

That controllers of Yaskawa have one is known; in which words it answers is not.
"""

from __future__ import annotations

from rpl.controllers.ftp.server import StoreShelf, serve_files
from rpl.controllers.virtual.cabinet import Cabinet
from rpl.controllers.virtual.endpoints import Endpoints
from rpl.controllers.virtual.store import NotDoneError


class Jobs(StoreShelf):
    """Jobs are written and removed in remote mode only, and have no other names."""

    folds = True
    renames = False

    def write(self, name: str, data: bytes) -> None:
        self._in_remote_mode(name)
        super().write(name, data)

    def delete(self, name: str) -> None:
        self._in_remote_mode(name)
        super().delete(name)

    def _in_remote_mode(self, name: str) -> None:
        if self.cabinet.mode != "remote":
            raise NotDoneError("busy", name)


def serve_jobs(cabinet: Cabinet, endpoints: Endpoints) -> None:
    """Raises UsageError when the port cannot be had."""
    serve_files(cabinet, endpoints, Jobs(cabinet), banner="FTP server ready.")
