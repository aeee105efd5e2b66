"""A virtual ABB controller: Robot Web Services 1.0 (HTTP, digest) and 2.0 (HTTPS, basic), websockets, EGM.

Both web servers stand in front of one controller. Sessions are cookies (`-http-session-`, `ABBCX`), seventy at most.
Every request is told to the cabinet before it is carried out, and its answer goes the way that a fault wants it to.
"""

from __future__ import annotations

import asyncio
import base64
import hashlib
import re
import secrets
import ssl
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from aiohttp import WSMsgType, web

from rpl.controllers.abb import egm
from rpl.controllers.abb.asked import Asked, asked, kind_of
from rpl.controllers.abb.certificate import context_of_server
from rpl.controllers.abb.inside import UNKNOWN, Inside, RefusalError
from rpl.controllers.abb.pages import MEDIA, NOTHING, Frame, Page, page_text, refusal_text
from rpl.controllers.abb.resources import answer
from rpl.controllers.abb.subscriptions import Subscriptions
from rpl.controllers.virtual.cabinet import Cabinet
from rpl.controllers.virtual.endpoints import Endpoints, not_had
from rpl.controllers.virtual.faults import DroppedError

if TYPE_CHECKING:
    from collections.abc import Mapping

# How many sessions there are at most, how long one lasts that is not used, and how long at all: README of
# abb-rws-client (M. Safari, tried on RobotWare 6.16 and 7.21) for IRC5; for 2.0 the same, which nobody has published.
# In scaled time, but never sooner than `_SHORTEST_S`.
_MOST_SESSIONS = 70
_UNUSED_S, _LONGEST_S, _SHORTEST_S = 300.0, 1500.0, 10.0
_SWEPT_S = 0.5
_LARGEST_BODY = 80 * 2**20
_REALM = "validusers@robapi.abb"
_CHUNK = 2**16
USUAL = {"rws": 80, "rws2": 443}


@dataclass
class Held:
    """A session: when it began and when it was used last (s of the machine's clock)."""

    began: float
    used: float


@dataclass
class Front:
    """One of the two web servers. `generation`: 1 or 2."""

    cabinet: Cabinet
    inside: Inside
    subscriptions: Subscriptions
    interface: str
    sessions: dict[str, Held] = field(default_factory=dict)
    nonces: set[str] = field(default_factory=set)

    @property
    def is_second(self) -> bool:
        return self.interface == "rws2"

    # ---- who asks

    def session_of(self, request: web.Request) -> str | None:
        """The session of a cookie that is known."""
        now = time.monotonic()
        self.sweep(now)
        for name in ("-http-session-", "ABBCX"):
            known = request.cookies.get(name, "")
            if known in self.sessions:
                self.sessions[known].used = now
                return known
        return None

    def sweep(self, now: float) -> None:
        """End the sessions whose time is over: a client that was killed holds the mastership no longer. M: one whose
        websocket is open is in use."""
        heard = {group.session for group in self.subscriptions.groups.values() if group.is_heard}
        unused, longest = (max(s / self.cabinet.time_scale, _SHORTEST_S) for s in (_UNUSED_S, _LONGEST_S))
        for session, held in tuple(self.sessions.items()):
            if session in heard:
                held.used = now
            elif now - held.used > unused or now - held.began > longest:
                self.end(session)

    async def sweeping(self) -> None:
        """Goes on until the controller is switched off: sessions end when nobody asks for anything, too."""
        while True:
            self.sweep(time.monotonic())
            await asyncio.sleep(_SWEPT_S)

    def end(self, session: str) -> None:
        """What a session held is free, and what it subscribed to is told no more."""
        self.sessions.pop(session, None)
        self.inside.forget(session)
        self.subscriptions.forget(session)

    def is_let_in(self, request: web.Request) -> bool:
        """Do the words of the request show that somebody knows the password?"""
        scheme, _, words = request.headers.get("Authorization", "").partition(" ")
        if self.is_second and scheme.lower() == "basic":
            try:
                user, _, password = base64.b64decode(words).decode("utf-8", "replace").partition(":")
            except ValueError:
                return False
            return self.cabinet.login(user, password)
        if not self.is_second and scheme.lower() == "digest":
            said = dict(re.findall(r'(\w+)="?([^",]*)"?', words))
            right = said.get("nonce") in self.nonces and said.get("response") == self._expected(request, said)
            return self.cabinet.login(said.get("username", ""), self.cabinet.password if right else "")
        return False

    def _expected(self, request: web.Request, said: Mapping[str, str]) -> str:
        def hashed(text: str) -> str:
            return hashlib.md5(text.encode(), usedforsecurity=False).hexdigest()

        who = hashed(f"{said.get('username', '')}:{_REALM}:{self.cabinet.password}")
        what = hashed(f"{request.method}:{said.get('uri', '')}")
        return hashed(f"{who}:{said.get('nonce')}:{said.get('nc')}:{said.get('cnonce')}:{said.get('qop')}:{what}")

    def challenge(self) -> str:
        if self.is_second:
            return f'Basic realm="{_REALM}"'
        nonce = secrets.token_hex(16)
        self.nonces.add(nonce)
        return f'Digest realm="{_REALM}", domain="/", nonce="{nonce}", qop="auth", algorithm=MD5, opaque="rpl"'

    # ---- one request

    async def handle(self, request: web.Request) -> web.StreamResponse:
        session, is_new = self.session_of(request), False
        if session is None:
            if "Authorization" not in request.headers:
                return self._closed_door()
            self.cabinet.told(self.interface, "login", f"{request.method} {request.path_qs}", counts=False)
            if not self.is_let_in(request):
                return self._closed_door()
            if len(self.sessions) >= _MOST_SESSIONS:
                return web.Response(status=503, body=b"", content_type=MEDIA["json"])
            session, is_new = secrets.token_hex(8), True
            now = time.monotonic()
            self.sessions[session] = Held(now, now)
        try:
            response = await self._carried_out(request, session)
        except DroppedError:
            if request.transport is not None:
                request.transport.abort()
            return web.Response(status=500)
        if is_new and not response.prepared:
            response.set_cookie("-http-session-", session, path="/")
            response.set_cookie("ABBCX", session, path="/")
        return response

    def _closed_door(self) -> web.Response:
        frame: Frame = "hal2" if self.is_second else "json"
        response = web.Response(status=401, body=refusal_text(UNKNOWN, "who are you?", frame))
        response.headers["Content-Type"] = MEDIA[frame]
        response.headers["WWW-Authenticate"] = self.challenge()
        return response

    async def _carried_out(self, request: web.Request, session: str) -> web.StreamResponse:
        asks = asked(
            request.method,
            request.raw_path.partition("?")[0],
            request.query_string,
            await request.read(),
            request.content_type,
            session,
            self._frame(request),
            f"{'https' if self.is_second else 'http'}://{request.host}",
        )
        is_folder = asks.path.startswith("/fileservice/") and self._is_folder(asks)
        kind = kind_of(asks, is_folder)
        self.cabinet.told(self.interface, kind, f"{request.method} {request.path_qs} {dict(asks.form) or ''}".rstrip())
        if self.cabinet.faults.delay_s:
            await asyncio.sleep(self.cabinet.faults.delay_s)
        if self.cabinet.faults.comes("garbage"):
            return _noise(request)
        if self.cabinet.faults.comes("endless"):
            return await _endless(request, asks.frame)
        if request.path.startswith("/poll/"):
            return await self._poll(request)
        try:
            page = self._page(asks)
        except RefusalError as error:
            response = web.Response(status=error.status, body=refusal_text(error.code, error.message, asks.frame))
            response.headers["Content-Type"] = MEDIA[asks.frame]
            self.cabinet.after()
            return response
        self.cabinet.after()
        return self._said(asks, page)

    def _is_folder(self, asks: Asked) -> bool:
        try:
            return self.inside.is_folder(self.inside.place(asks.path.removeprefix("/fileservice/")))
        except RefusalError:
            return False

    def _frame(self, request: web.Request) -> Frame:
        if self.is_second:
            return "xhtml2" if "xhtml" in request.headers.get("Accept", "") else "hal2"
        return "json" if request.query.get("json") == "1" else "xhtml"

    def _page(self, asks: Asked) -> Page:
        if asks.is_second and asks.method == "POST" and asks.body and not asks.form:
            raise RefusalError(415, UNKNOWN, "the media type of the form is not understood")
        if asks.path == "/logout":
            self.end(asks.session)
            return NOTHING
        if asks.path == "/subscription" and asks.method == "POST":
            return self.subscriptions.add(asks)
        dropped = re.fullmatch(r"/subscription/(\d+)", asks.path)
        if dropped is not None and asks.method == "DELETE":
            self.subscriptions.drop(int(dropped[1]))
            return NOTHING
        return answer(self.inside, asks)

    def _said(self, asks: Asked, page: Page) -> web.StreamResponse:
        if page.status == 204:
            return web.Response(status=204)
        if page.data is not None:
            response = web.Response(status=page.status, body=page.data)
            response.headers["Content-Type"] = "application/octet-stream" + (";v=2.0" if self.is_second else "")
            if self.cabinet.faults.comes("huge", counted=False):
                return _huge(page.data)
            return response
        # A subscription is answered in XHTML whatever was asked for: clients look for its link there.
        frame = asks.frame if not asks.path.startswith("/subscription") else ("xhtml2" if self.is_second else "xhtml")
        response = web.Response(status=page.status, body=page_text(page, frame, f"{asks.base}{asks.path}/"))
        response.headers["Content-Type"] = MEDIA[frame] if frame == asks.frame else MEDIA["xhtml"]
        if page.location:
            response.headers["Location"] = page.location
        return response

    # ---- events

    async def _poll(self, request: web.Request) -> web.StreamResponse:
        number = request.path.rpartition("/")[2]
        group = self.subscriptions.groups.get(int(number)) if number.isdigit() else None
        if group is None:
            return web.Response(status=404)
        protocol = "rws_subscription" if self.is_second else "robapi2_subscription"
        if protocol not in request.headers.get("Sec-WebSocket-Protocol", ""):
            return web.Response(status=400, text="Unsupported Sec-WebSocket-Protocol")
        socket = web.WebSocketResponse(protocols=(protocol,))
        await socket.prepare(request)

        async def send() -> None:
            while True:
                await socket.send_str((await group.events.get()).decode())

        sending, group.is_heard = asyncio.create_task(send()), True
        try:
            async for message in socket:
                if message.type == WSMsgType.ERROR:
                    break
        finally:
            sending.cancel()
            group.is_heard = False
        return socket


# ---- what faults make of an answer


def _noise(request: web.Request) -> web.Response:
    if request.transport is not None:
        request.transport.write(bytes(range(128, 256)) * 8 + b"\r\n")
        request.transport.close()
    return web.Response(status=500)


async def _endless(request: web.Request, frame: Frame) -> web.StreamResponse:
    response = web.StreamResponse()
    response.headers["Content-Type"] = MEDIA[frame]
    response.enable_chunked_encoding()
    await response.prepare(request)
    while request.transport is not None and not request.transport.is_closing():
        await response.write(b" " * _CHUNK)
        await asyncio.sleep(0.001)  # others are answered meanwhile
    return response


def _huge(data: bytes) -> web.StreamResponse:
    """A file that is announced larger than any is; it never comes whole."""
    response = web.Response(body=data)
    response.headers["Content-Length"] = str(2**40)
    return response


async def start(cabinet: Cabinet, endpoints: Endpoints) -> None:
    """Open all interfaces. Raises UsageError when a port cannot be had."""
    cabinet.store.may_write = lambda name: None  # files are written while a program runs: it runs from its memory
    inside = Inside(cabinet)
    subscriptions = Subscriptions(inside)
    for interface, usual in USUAL.items():
        front = Front(cabinet, inside, subscriptions, interface)
        context = context_of_server(endpoints.host) if front.is_second else None
        await _listen(front, endpoints, usual, context)
        endpoints.beside(front.sweeping())
    endpoints.beside(subscriptions.look())
    await egm.start(cabinet, endpoints)


async def _listen(front: Front, endpoints: Endpoints, usual: int, context: ssl.SSLContext | None) -> None:
    application = web.Application(client_max_size=_LARGEST_BODY)
    application.router.add_route("*", "/{path:.*}", front.handle)
    runner = web.AppRunner(application, access_log=None, shutdown_timeout=0.2)
    await runner.setup()
    port = endpoints.port(front.interface, usual)
    site = web.TCPSite(runner, endpoints.host, port, ssl_context=context)
    try:
        await site.start()
    except OSError as error:
        raise not_had(endpoints.host, front.interface, port, error) from None
    addresses = runner.addresses
    endpoints.opened(front.interface, addresses[0][1], runner.cleanup)
