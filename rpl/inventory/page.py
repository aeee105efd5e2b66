"""The contents of a project as one page that opens from disk and loads nothing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from importlib import resources

from rpl.inventory.contents import Contents
from rpl.inventory.graph import graph
from rpl.inventory.robots import ArmFound
from rpl.inventory.shown import arm_text, lines


@dataclass(frozen=True, slots=True)
class _Table:
    title: str
    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


def page(title: str, found: Contents, arms: Sequence[ArmFound]) -> str:
    """The whole page; texts of the program reach it escaped."""
    import jinja2

    text = (resources.files("rpl.inventory") / "page.html.j2").read_text("utf-8")
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True)
    heading = [next(lines(found, ())), *(f"Arm: {arm_text(one)}" for one in arms)]
    return environment.from_string(text).render(
        title=title, heading=heading, graph=graph(found.programs), tables=_tables(found)
    )


def _tables(found: Contents) -> list[_Table]:
    return [
        _Table(
            "Programs",
            ("name", "place", "statements", "moves", "calls", "called by"),
            tuple(
                (one.name, one.place, f"{one.statements}", f"{one.moves}", _list(one.calls), _list(one.called_by))
                for one in found.programs
            ),
        ),
        _Table(
            "Missing",
            ("name", "kind", "places"),
            tuple((one.name, one.kind, _list(one.places)) for one in found.missing),
        ),
        _Table(
            "Signals",
            ("signal", "number", "name", "written by", "read by"),
            tuple((one.kind, one.number, one.name, _list(one.writers), _list(one.readers)) for one in found.signals),
        ),
        _Table(
            "Points, frames and tools",
            ("name", "kind", "place", "used by"),
            tuple((one.name, one.kind, one.place, _list(one.used_by)) for one in found.data),
        ),
        _Table(
            "Files",
            ("file", "language", "statements", "not readable"),
            tuple((path, language, f"{count}", f"{unread}") for path, language, count, unread in found.files),
        ),
    ]


def _list(names: Sequence[str]) -> str:
    return ", ".join(names)
