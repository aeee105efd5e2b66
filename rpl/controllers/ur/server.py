"""The virtual controller: SFTP, dashboard, RTDE, and the ports that take text and run it, in front of one cabinet."""

from __future__ import annotations

from functools import partial

from rpl.controllers.sftp.server import open_sftp
from rpl.controllers.ur import VENDOR
from rpl.controllers.ur.dashboard_server import serve_dashboard
from rpl.controllers.ur.panel import Panel
from rpl.controllers.virtual.cabinet import Cabinet
from rpl.controllers.virtual.endpoints import Endpoints


async def start(cabinet: Cabinet, endpoints: Endpoints) -> None:
    """Raises UsageError when a port cannot be had."""
    panel = Panel(cabinet)
    await open_sftp(cabinet, endpoints, VENDOR.ports["sftp"], VENDOR.path)
    await endpoints.stream("dashboard", VENDOR.ports["dashboard"], partial(serve_dashboard, panel))
