"""What clients of a virtual controller have subscribed to: looked at in a short cycle, told when it changes.

Events are XHTML in one line, with the classes and links that clients look for (abb-robot-client compares them).
"""

from __future__ import annotations

import asyncio
import itertools
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rpl.controllers.abb.data import signal_text, symbol_text
from rpl.controllers.abb.inside import UNKNOWN, Inside, RefusalError
from rpl.controllers.abb.pages import Page, Thing, page_text
from rpl.controllers.abb.resources import control_state, execution_state, operation_mode

if TYPE_CHECKING:
    from rpl.controllers.abb.asked import Asked

CYCLE_S = 0.02  # how often the values are looked at; real controllers take longer
Looks = Callable[[Inside, str], Mapping[str, str]]


@dataclass(frozen=True, slots=True)
class _Watched:
    """Resources of one kind: their path, the class of their events, and their values at present."""

    path: re.Pattern[str]
    kind: str
    looks: Looks


def _queue(inside: Inside, name: str) -> Mapping[str, str]:
    messages = inside.queues.get(name, [])
    last = messages[-1] if messages else {}
    return {key: last.get(key, "") for key in ("dipc-data", "dipc-userdef", "dipc-msgtype", "dipc-cmd")} | {
        "count": str(len(messages))
    }


_KINDS = (
    _Watched(
        re.compile(r"/rw/iosystem/signals/(.+);state"),
        "ios-signalstate-ev",
        lambda inside, path: {"lvalue": signal_text(inside, path), "lstate": "not simulated"},
    ),
    _Watched(
        re.compile(r"/rw/rapid/symbol/data/RAPID/(.+);value"),
        "rap-data",
        lambda inside, path: {"value": symbol_text(inside, path)},
    ),
    _Watched(
        re.compile(r"/rw/rapid/execution();ctrlexecstate"),
        "rap-ctrlexecstate-ev",
        lambda inside, _: {"ctrlexecstate": execution_state(inside)},
    ),
    _Watched(re.compile(r"/rw/panel/opmode()"), "pnl-opmode-ev", lambda inside, _: {"opmode": operation_mode(inside)}),
    _Watched(
        re.compile(r"/rw/panel/ctrl-?state()"),
        "pnl-ctrlstate-ev",
        lambda inside, _: {"ctrlstate": control_state(inside)},
    ),
    _Watched(
        re.compile(r"/rw/elog/0()"), "elog-message-ev", lambda inside, _: {"seqnum": str(len(inside.cabinet.messages))}
    ),
    _Watched(re.compile(r"/rw/dipc/([^;/]+)"), "dipc-msg-ev", _queue),
)


def _event(inside: Inside, resource: str) -> Thing:
    """The present value of a resource as an event. Raises RefusalError when it is none."""
    found = _SECOND_DATA.fullmatch(resource)
    place = f"/rw/rapid/symbol/data/RAPID/{found[1]};value" if found else resource
    for watched in _KINDS:
        match = watched.path.fullmatch(place)
        if match is not None:
            values = watched.looks(inside, match[1])
            href = f"{resource}/{values['seqnum']}" if "seqnum" in values else resource
            return Thing(watched.kind, match[1] or resource.rpartition("/")[2].partition(";")[0], values, href)
    raise RefusalError(400, UNKNOWN, f"{resource}: nobody can subscribe to that")


_SECOND_DATA = re.compile(r"/rw/rapid/symbol/RAPID/(.+)/data;value")


@dataclass
class Group:
    """One subscription: its resources, and the events that wait to be sent. `is_heard`: its websocket is open."""

    number: int
    session: str
    resources: tuple[str, ...]
    seen: dict[str, Thing]
    is_heard: bool = False
    events: asyncio.Queue[bytes] = field(default_factory=asyncio.Queue)


@dataclass
class Subscriptions:
    inside: Inside
    groups: dict[int, Group] = field(default_factory=dict)
    _numbers: itertools.count[int] = field(default_factory=lambda: itertools.count(1))

    def add(self, request: Asked) -> Page:
        """Raises RefusalError when a resource is none."""
        numbers = [key for key in request.form if key.isdigit()]
        resources = tuple(request.form[key] for key in sorted(numbers, key=int))
        if not resources:
            raise RefusalError(400, UNKNOWN, "no resource is named")
        seen = {resource: _event(self.inside, resource) for resource in resources}
        group = Group(next(self._numbers), request.session, resources, seen)
        self.groups[group.number] = group
        location = f"{request.base.replace('http', 'ws', 1)}/poll/{group.number}"
        links = {"group": f"subscription/{group.number}", "self": location}
        return Page(tuple(seen.values()), 201, location=location, links=links)

    def drop(self, number: int) -> None:
        if self.groups.pop(number, None) is None:
            raise RefusalError(404, UNKNOWN, f"there is no subscription {number}")

    def forget(self, session: str) -> None:
        """A session is over: its subscriptions too."""
        self.groups = {number: group for number, group in self.groups.items() if group.session != session}

    async def look(self) -> None:
        """Goes on until the controller is switched off."""
        while True:
            for group in self.groups.values():
                self._look_at(group)
            await asyncio.sleep(CYCLE_S)

    def _look_at(self, group: Group) -> None:
        for resource in group.resources:
            try:
                event = _event(self.inside, resource)
            except RefusalError:
                continue  # the data is gone with its module
            if event != group.seen[resource]:
                group.seen[resource] = event
                page = Page((event,), links={"group": f"subscription/{group.number}"})
                group.events.put_nowait(page_text(page, "xhtml", "http://controller/"))
