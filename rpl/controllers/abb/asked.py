"""A request to a virtual controller, whichever generation it is spoken in: 2.0 is put as 1.0 says it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from urllib.parse import parse_qsl, unquote

from rpl.controllers.abb.pages import Frame
from rpl.controllers.virtual.transcript import Kind


@dataclass(frozen=True, slots=True)
class Asked:
    """method and path as in 1.0, the path decoded and without its slash at the end; `action`: what a POST is for.
    `session`: who asks. `base`: address of this server, with its scheme."""

    method: str
    path: str
    action: str
    query: Mapping[str, str]
    form: Mapping[str, str]
    body: bytes = field(repr=False)
    session: str
    frame: Frame
    base: str

    @property
    def is_second(self) -> bool:
        return self.frame in ("hal2", "xhtml2")


# 2.0 -> 1.0: method, path of 2.0, path of 1.0, action. The first that fits.
_SECOND = (
    (r"POST", r"/rw/mastership(?:/edit)?/(request|release)", "/rw/mastership/rapid", r"\1"),
    (r"POST", r"/rw/mastership/motion/(request|release)", "/rw/mastership/motion", r"\1"),
    (r"GET", r"/rw/mastership/edit", "/rw/mastership/rapid", ""),
    (r"POST", r"(/rw/rapid/execution)/(start|stop|resetpp)", r"\1", r"\2"),
    (r"POST", r"(/rw/rapid/tasks/[^/]+)/(loadmod|unloadmod)", r"\1", r"\2"),
    (r"POST", r"/rw/rapid/tasks/([^/]+)/modules/([^/]+)/save", r"/rw/rapid/modules/\2?task=\1", "save"),
    (r"GET", r"/rw/rapid/tasks/([^/]+)/modules/([^/]+)/text", r"/rw/rapid/modules/\2/text?task=\1", ""),
    (r"GET", r"/rw/rapid/tasks/([^/]+)/modules", r"/rw/rapid/modules?task=\1", ""),
    (r"GET", r"/rw/rapid/symbol/RAPID/(.+)/data", r"/rw/rapid/symbol/data/RAPID/\1", ""),
    (r"POST", r"/rw/rapid/symbol/RAPID/(.+)/data", r"/rw/rapid/symbol/data/RAPID/\1", "set"),
    (r"POST", r"/rw/rapid/symbols/search", "/rw/rapid/symbols", "search-symbols"),
    (r"GET", r"/rw/panel/ctrl-state", "/rw/panel/ctrlstate", ""),
    (r"POST", r"/rw/panel/ctrl-state", "/rw/panel/ctrlstate", "setctrlstate"),
    (r"POST", r"/rw/panel/speedratio", "/rw/panel/speedratio", "setspeedratio"),
    (r"POST", r"(/rw/iosystem/signals/.+)/set-value", r"\1", "set"),
    (r"POST", r"(/fileservice(?:/.+)?)/(copy|rename|create)", r"\1", r"\2"),
)


def asked(
    method: str,
    raw_path: str,
    query: str,
    body: bytes,
    media: str,
    session: str,
    frame: Frame,
    base: str,
) -> Asked:
    """A request as it came: path still encoded, query without its `?`."""
    path = unquote(raw_path).rstrip("/") or "/"
    words = dict(parse_qsl(query, keep_blank_values=True))
    form: dict[str, str] = {}
    if media.startswith("application/x-www-form-urlencoded"):
        form = dict(parse_qsl(body.decode("utf-8", "replace"), keep_blank_values=True))
    action = words.get("action", "")
    if frame in ("hal2", "xhtml2"):
        path, action = _as_first(method, path)
        path, _, further = path.partition("?")
        words |= dict(parse_qsl(further))
    elif path.startswith("/fileservice") and method == "POST":
        action = form.get("fs-action", "")
    return Asked(method, path, action, words, form, body, session, frame, base)


def _as_first(method: str, path: str) -> tuple[str, str]:
    for verb, second, first, action in _SECOND:
        found = re.fullmatch(second, path) if verb == method else None
        if found is not None:
            return found.expand(first), found.expand(action)
    return path, ""


# What a POST is about, by its action; of others by their path.
_ACTIONS: dict[str, Kind] = {
    "start": "start",
    "startprodentry": "start",
    "stop": "stop",
    "resetpp": "select",
    "set-pp-routine": "select",
    "set-pp-cursor": "select",
    "setctrlstate": "servo",
    "loadmod": "load",
    "unloadmod": "load",
    "loadprog": "load",
    "request": "lock",
    "release": "lock",
    "set": "set",
    "setspeedratio": "set",
    "copy": "write",
    "rename": "write",
    "create": "write",
    "save": "write",
}
_METHODS: dict[str, Kind] = {"PUT": "write", "DELETE": "delete", "GET": "look"}


def kind_of(request: Asked, is_folder: bool) -> Kind:
    """What the request is about. `is_folder`: its path is one of the file service."""
    if request.path.startswith("/fileservice") and request.method == "GET":
        return "list" if is_folder else "read"
    if request.path == "/rw/mastership" and request.method == "POST":
        return "lock"
    return _METHODS.get(request.method) or _ACTIONS.get(request.action, "other")
