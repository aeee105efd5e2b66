"""How a virtual controller says what it has to say: JSON and XHTML of 1.0, and both as 2.0 frames them.

The frames are those of ABB's examples (3HAC050973-001) and what clients compare: `_embedded._state[]` with `_type` and
`_title` in 1.0, `state[]` in 2.0 and `_embedded.resources[]` for its file service; a media type without a charset, also
of empty answers; spans by class in XHTML, events in one line.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal
from xml.sax.saxutils import escape, quoteattr

Frame = Literal["json", "xhtml", "hal2", "xhtml2"]
MEDIA: dict[Frame, str] = {
    "json": "application/json",
    "xhtml": "application/xhtml+xml",
    "hal2": "application/hal+json;v=2.0",
    "xhtml2": "application/xhtml+xml;v=2.0",
}


@dataclass(frozen=True, slots=True)
class Thing:
    """One thing of an answer: its class, its title, what is said of it, and where it is found (relative)."""

    kind: str
    title: str
    values: Mapping[str, str] = field(default_factory=dict)
    href: str = ""


@dataclass(frozen=True, slots=True)
class Page:
    """An answer. `of_files`: of the file service, which 2.0 frames otherwise. `location`: of what was created."""

    things: Sequence[Thing] = ()
    status: int = 200
    of_files: bool = False
    data: bytes | None = None
    location: str = ""
    links: Mapping[str, str] = field(default_factory=dict)


NOTHING = Page(status=204)


def page_text(page: Page, frame: Frame, base: str) -> bytes:
    """The page in that frame; `base`: its address."""
    if frame in ("json", "hal2"):
        return json.dumps(_json(page, frame, base)).encode()
    return (
        '<?xml version="1.0" encoding="UTF-8"?><html xmlns="http://www.w3.org/1999/xhtml"><head><title>rws</title>'
        f'<base href={quoteattr(base)}/></head><body><div class="state">{_links(page)}<ul>'
        + "".join(_listed(thing) for thing in page.things)
        + "</ul></div></body></html>"
    ).encode("utf-8", "replace")


def _json(page: Page, frame: Frame, base: str) -> dict[str, object]:
    things = [
        {"_links": {"self": {"href": thing.href or thing.title}}, "_type": thing.kind, "_title": thing.title}
        | dict(thing.values)
        for thing in page.things
    ]
    links = {"base": {"href": base}} | {rel: {"href": href} for rel, href in page.links.items()}
    if frame == "json":
        return {"_links": links, "_embedded": {"_state": things}}
    if page.of_files:
        return {"_links": links, "status": {"code": 294912}, "_embedded": {"resources": things}}
    return {"_links": links, "status": {"code": 294912}, "state": things}


def _links(page: Page) -> str:
    return "".join(f'<a href={quoteattr(href)} rel="{rel}"></a>' for rel, href in page.links.items())


def _listed(thing: Thing) -> str:
    spans = "".join(f'<span class="{key}">{escape(value)}</span>' for key, value in thing.values.items())
    link = f'<a href={quoteattr(thing.href or thing.title)} rel="self"/>'
    return f'<li class="{thing.kind}" title={quoteattr(thing.title)}>{link}{spans}</li>'


def refusal_text(code: int, message: str, frame: Frame) -> bytes:
    """Why something was not done, with the controller's own number."""
    status = {"code": code, "msg": message}
    if frame == "json":
        return json.dumps({"_embedded": {"status": status}}).encode()
    if frame == "hal2":
        return json.dumps({"status": status}).encode()
    return (
        '<?xml version="1.0" encoding="UTF-8"?><html xmlns="http://www.w3.org/1999/xhtml"><head><title>rws</title>'
        f'</head><body><div class="status"><span class="code">{code}</span><span class="msg">{escape(message)}</span>'
        "</div></body></html>"
    ).encode()
