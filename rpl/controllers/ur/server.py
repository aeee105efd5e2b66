"""The virtual controller: SFTP, dashboard, RTDE, and the ports that take text and run it, in front of one
cabinet."""

from __future__ import annotations

from functools import partial

from rpl.controllers.sftp.server import open_sftp
from rpl.controllers.ur import VENDOR
from rpl.controllers.ur.dashboard_server import serve_dashboard
from rpl.controllers.ur.interpreter import Interpreter
from rpl.controllers.ur.panel import Panel
from rpl.controllers.ur.pushed import Pushed
from rpl.controllers.ur.rtde_server import Rtde, tick
from rpl.controllers.ur.variables import Moment
from rpl.controllers.virtual.cabinet import Cabinet
from rpl.controllers.virtual.endpoints import Endpoints


async def start(cabinet: Cabinet, endpoints: Endpoints) -> None:
    """Raises UsageError when a port cannot be had."""
    panel = Panel(cabinet)
    await open_sftp(cabinet, endpoints, VENDOR.ports["sftp"], VENDOR.path)
    await endpoints.stream("dashboard", VENDOR.ports["dashboard"], partial(serve_dashboard, panel))
    moment = Moment(panel)
    rtde, pushed = Rtde(panel, moment), Pushed(panel, moment)
    await endpoints.stream("rtde", VENDOR.ports["rtde"], rtde.serve)
    for port in ("primary", "secondary", "realtime"):
        await endpoints.stream(port, VENDOR.ports[port], partial(pushed.serve, port))
    interpreter = Interpreter(panel)
    await endpoints.stream("interpreter", VENDOR.ports["interpreter"], interpreter.serve)
    endpoints.beside(tick(moment, [interpreter.look, rtde.send, pushed.send]))
