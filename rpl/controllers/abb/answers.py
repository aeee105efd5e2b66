"""What a controller answers, as a list of things with values: both generations say the same in other frames."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from rpl.controllers.link import GarbledError, LinkError, LoginError, LostError, NotThereError, RefusedError

_LONGEST_SAID = 300


@dataclass(frozen=True, slots=True)
class Answer:
    """status: of HTTP. body: whole."""

    status: int
    body: bytes


@dataclass(frozen=True, slots=True)
class Item:
    """One thing: its class (`fs-file`, `rap-task-li`), its title and what is said of it. `has_self`: it is linked, as
    what lies in a folder is, and the folder itself, which some lists begin with, is not."""

    kind: str
    title: str
    values: Mapping[str, str]
    has_self: bool


def items(answer: Answer) -> tuple[Item, ...]:
    """The things of an answer in JSON: `_embedded._state` (1.0), `state` and `_embedded.resources` (2.0)."""
    return tuple(_items(_document(answer.body)))


def one(answer: Answer, *kinds: str) -> Mapping[str, str]:
    """The values of the first thing of one of these classes; of none: empty."""
    return next((item.values for item in items(answer) if item.kind in kinds), {})


def _document(body: bytes) -> Mapping[str, object]:
    try:
        found = json.loads(body.decode("utf-8", "replace"))
    except (ValueError, RecursionError):
        raise GarbledError("the controller answers with what is no JSON") from None
    if not isinstance(found, dict):
        raise GarbledError("the controller answers with JSON that is no object")
    return found


def _items(document: Mapping[str, object]) -> Iterator[Item]:
    embedded = document.get("_embedded")
    lists = [document.get("state")]
    if isinstance(embedded, dict):
        lists += [embedded.get("_state"), embedded.get("resources")]
    for entries in lists:
        if entries is None:
            continue
        if not isinstance(entries, list):
            raise GarbledError("the controller answers with a list that is none")
        yield from (_item(entry) for entry in entries if isinstance(entry, dict))


def _item(entry: Mapping[str, object]) -> Item:
    links = entry.get("_links")
    values = {key: str(value) for key, value in entry.items() if isinstance(value, str | int | float)}
    has_self = "self" in links if isinstance(links, dict) else True
    return Item(values.pop("_type", ""), values.pop("_title", ""), values, has_self)


def checked(answer: Answer, what: str) -> Answer:
    """The answer, if the controller did what was asked. Raises a LinkError with what it says otherwise."""
    if 200 <= answer.status < 300:
        return answer
    raise _error(answer.status)(f"{what}: {_said(answer)}")


def _error(status: int) -> type[LinkError]:
    if status == 401:
        return LoginError
    if status == 404:
        return NotThereError
    return LostError if status >= 500 and status != 503 else RefusedError


def _said(answer: Answer) -> str:
    """The controller's own words, as well as they can be read."""
    try:
        document = _document(answer.body)
    except GarbledError:
        return f"the controller says no (HTTP {answer.status})"
    embedded = document.get("_embedded")
    status = document.get("status", embedded.get("status") if isinstance(embedded, dict) else None)
    if isinstance(status, dict) and ("msg" in status or "code" in status):
        return f"{str(status.get('msg', 'no'))[:_LONGEST_SAID]} (HTTP {answer.status}, code {status.get('code', '-')})"
    return f"the controller says no (HTTP {answer.status})"
