"""Looking at an ABB controller: one look (`status`), and values as they change (`watch`), by a subscription.

Names that can be watched: `execution`, `mode`, `control`, a signal by its name or `network/device/name`, and data of
RAPID as `TASK/MODULE/NAME`.
"""

from __future__ import annotations

import asyncio
import hashlib
import re
import time
from collections.abc import Awaitable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import TypeVar

from aiohttp import ClientError, ClientSession, ClientTimeout, Fingerprint, WSMessage, WSMsgType

from rpl.controllers.abb.answers import Answer, checked, items, one
from rpl.controllers.abb.calls import Generation
from rpl.controllers.abb.rws import RwsLink, connect
from rpl.controllers.link import GarbledError, LinkError, LostError, RefusedError
from rpl.controllers.profile import Profile
from rpl.controllers.showing import Sample, Shown, Status

Result = TypeVar("Result")
_UNIT, _DEVICE = "ROB_1", "Local/DRV_1"
_MOST_SIGNALS, _MOST_MESSAGES = 40, 5
_LONGEST_EVENT = 2**20
_NO_AXIS = 8e8
_SPAN = re.compile(r'<span\s+class="(lvalue|value|ctrlexecstate|opmode|ctrlstate)">([^<]*)<')
_LINK = re.compile(r'<a\s+href="([^"]*)"\s+rel="self"')


def status(profile: Profile) -> Status:
    """One look. What a controller does not say is left out; raises LinkError when it does not answer."""
    link = connect(profile)
    try:
        joints = _asked(link, "joints", "ms-jointtarget", unit=_UNIT)
        pose = _asked(link, "pose", "ms-robtargets", unit=_UNIT)
        signals = _listed(link, "signals")[:_MOST_SIGNALS]
        log = _listed(link, "log")[:_MOST_MESSAGES]
        return Status(
            link.identity(),
            link.state(),
            joints=_numbers(joints, [f"rax_{number}" for number in range(1, 7)]),
            xyz_mm=_numbers(pose, ["x", "y", "z"]),
            orientation=dict(zip(_QUATERNION, _numbers(pose, _QUATERNION) or (), strict=False)),
            signals={values.get("name", title): _shown(values.get("lvalue", "")) for title, values in signals},
            messages=tuple(f"{values.get('tstamp', '')} {values.get('title', title)}".strip() for title, values in log),
        )
    finally:
        link.close()


_QUATERNION = ("q1", "q2", "q3", "q4")


def _asked(link: RwsLink, wanted: str, kind: str, **names: str) -> Mapping[str, str]:
    """Nothing, where there is no robot or the question is not known."""
    try:
        path = link.generation.path(wanted, **names)
        return one(checked(link.session.get(path), path), kind)
    except RefusedError:
        return {}


def _listed(link: RwsLink, wanted: str) -> list[tuple[str, Mapping[str, str]]]:
    try:
        path = link.generation.path(wanted)
        return [(item.title, item.values) for item in items(checked(link.session.get(path), path))]
    except RefusedError:
        return []


def _numbers(values: Mapping[str, str], names: Sequence[str]) -> tuple[float, ...] | None:
    """Those that are numbers of axes that are there; none at all: None."""
    found = []
    for name in names:
        with suppress(ValueError):
            number = float(values.get(name, ""))
            if abs(number) < _NO_AXIS:
                found.append(number)
    return tuple(found) or None


def _shown(text: str) -> Shown:
    try:
        number = float(text)
    except ValueError:
        return text
    return int(number) if number.is_integer() else number


# ---- watching


def resource_of(name: str, generation: Generation) -> str:
    """Where a value is subscribed to, by its name."""
    fixed = {"execution": "/rw/rapid/execution;ctrlexecstate", "mode": "/rw/panel/opmode"}
    fixed["control"] = generation.paths["ctrlstate"]
    if name in fixed:
        return fixed[name]
    parts = name.split("/")
    if len(parts) == 3 and parts[0].upper().startswith("T_"):
        return generation.path("data", task=parts[0], module=parts[1], name=parts[2]) + ";value"
    return f"/rw/iosystem/signals/{name if len(parts) > 1 else f'{_DEVICE}/{name}'};state"


def watch(profile: Profile, names: Sequence[str], period_s: float) -> Iterator[Sample]:
    """A sample at once and at each change, at least one every `period_s`; goes on until the caller ends it. Raises
    LinkError."""
    link = connect(profile)
    wanted = list(names) or ["execution", "mode", "control"]
    resources = {resource_of(name, link.generation): name for name in wanted}
    try:
        form: dict[str, str] = {"resources": "1"}
        body = {str(number): resource for number, resource in enumerate(resources, 1)}
        priorities = {f"{number}-p": "1" for number in range(1, len(resources) + 1)}
        path = link.generation.path("subscription")
        answer = checked(link.session.post(path, **(form | body | priorities)), f"{profile.name}: {', '.join(wanted)}")
        values: dict[str, Shown | tuple[float, ...] | None] = dict.fromkeys(wanted)
        values |= _events(answer.body.decode("utf-8", "replace"), resources)
        began = time.monotonic()
        yield Sample(0.0, dict(values))
        for text in _messages(link, _poll_path(answer), period_s):
            values |= _events(text, resources)
            yield Sample(time.monotonic() - began, dict(values))
    finally:
        link.close()


def _poll_path(answer: Answer) -> str:
    found = re.search(rb'href="wss?://[^/"]*(/poll/[\w-]+)"', answer.body)
    if found is None:
        raise GarbledError("the controller does not say where its events are")
    return found[1].decode()


def _events(text: str, resources: Mapping[str, str]) -> dict[str, Shown]:
    """Values by name of an answer or event in XHTML."""
    found: dict[str, Shown] = {}
    for part in text.split("<li ")[1:]:
        link, span = _LINK.search(part), _SPAN.search(part)
        if link is not None and span is not None and link[1] in resources:
            found[resources[link[1]]] = _shown(span[2])
    return found


def _messages(link: RwsLink, path: str, period_s: float) -> Iterator[str]:
    """Events of a websocket; an empty one when none came for so long."""
    socket = _Socket(link, path)
    try:
        while True:
            yield socket.next(period_s)
    finally:
        socket.close()


class _Socket:
    """A websocket of the controller, one event after the other."""

    def __init__(self, link: RwsLink, path: str) -> None:
        self.link = link
        self._loop = asyncio.new_event_loop()
        self._waiting: asyncio.Task[WSMessage] | None = None
        session, generation = link.session, link.generation
        self._client = self._done(_client())
        try:
            self._socket = self._done(
                self._client.ws_connect(
                    f"{'wss' if generation.secure else 'ws'}://{link.profile.host}:{session.port}{path}",
                    headers={"Cookie": session.cookie_header},
                    protocols=(generation.protocol,),
                    max_msg_size=_LONGEST_EVENT,
                    ssl=Fingerprint(hashlib.sha256(session.certificate).digest()) if generation.secure else True,
                )
            )
        except LinkError:
            self.close()
            raise

    def _done(self, work: Awaitable[Result]) -> Result:
        name = self.link.profile.name
        try:
            return self._loop.run_until_complete(asyncio.wait_for(work, self.link.profile.patience_s))
        except TimeoutError:
            raise LostError(f"{name}: no answer came in time") from None
        except (ClientError, OSError) as error:
            raise LostError(f"{name}: events cannot be had: {error}") from None

    def next(self, wait_s: float) -> str:
        """The next event; empty when none comes in that time. Raises LinkError when there are no more."""
        if self._waiting is None:
            self._waiting = self._loop.create_task(self._socket.receive())
        self._loop.run_until_complete(asyncio.wait({self._waiting}, timeout=wait_s))
        if not self._waiting.done():
            return ""
        message, self._waiting = self._waiting.result(), None
        if message.type is WSMsgType.TEXT:
            return str(message.data)
        if message.type is WSMsgType.ERROR:
            raise GarbledError(f"{self.link.profile.name}: an event is none: {message.data}")
        raise LostError(f"{self.link.profile.name}: the controller sends no more events")

    def close(self) -> None:
        if self._waiting is not None:
            self._waiting.cancel()
        with suppress(LinkError):
            self._done(self._client.close())
        self._loop.close()


async def _client() -> ClientSession:
    return ClientSession(timeout=ClientTimeout(total=None))
