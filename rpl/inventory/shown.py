"""The contents of a project as a tree for the terminal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from rpl.inventory.contents import Contents, Program
from rpl.inventory.robots import ArmFound
from rpl.showing import counted

_STEP = "  "
_MOST_PLACES = 6


def lines(found: Contents, arms: Sequence[ArmFound]) -> Iterator[str]:
    """What was found, a line each; a routine that stands in the tree already is not taken apart again."""
    statements = sum(count for _, _, count, _ in found.files)
    unread = sum(count for _, _, _, count in found.files)
    parts = [
        " and ".join(found.languages),
        counted(len(found.files), "file"),
        counted(statements, "statement"),
        counted(len(found.programs), "routine"),
        counted(sum(one.moves for one in found.programs), "move"),
    ]
    yield ", ".join(parts) + (f"; {unread} statements not readable" if unread else "")
    yield from (f"arm: {arm_text(one)}" for one in arms)
    yield from (f"task {name}: {entry} ({kind})" for name, entry, kind in found.tasks)
    yield from _section("programs that can be started", _tree(found))
    yield from _section("called by nobody", (_STEP + _head(one) for one in found.unused))
    missing = [f"{_STEP}{one.kind} {one.name}: {some(one.places)}" for one in found.missing]
    yield from _section("missing", missing)
    signals = [
        f"{_STEP}{' '.join(part for part in (one.kind, one.number, one.name) if part)}: "
        f"written by {some(one.writers)}; read by {some(one.readers)}"
        for one in found.signals
    ]
    yield from _section("signals", signals)
    data = [f"{_STEP}{one.kind} {one.name} ({one.place}): used by {some(one.used_by)}" for one in found.data]
    yield from _section("points, frames and tools", data)


def arm_text(arm: ArmFound) -> str:
    """What the files call the arm, and which of ours that is."""
    said = f"{arm.called} ({arm.file})"
    if arm.robot:
        return f"{said}: --robot {arm.robot}"
    near = f"; of that model there are {', '.join(arm.near)}" if arm.near else ""
    return f"{said}: no robot file has this name{near}"


def _section(title: str, rows: Iterator[str] | Sequence[str]) -> Iterator[str]:
    shown = list(rows)
    if shown:
        yield f"{title}:"
        yield from shown


def _tree(found: Contents) -> Iterator[str]:
    by_name: dict[str, Program] = {}
    for one in found.programs:
        by_name.setdefault(one.name.lower(), one)
    seen: set[str] = set()
    stack = [(one, 1) for one in reversed(found.entries)]
    while stack:
        one, depth = stack.pop()
        again = one.name.lower() in seen and bool(one.calls)
        yield _STEP * depth + _head(one) + (" (see above)" if again else "")
        if not again:
            seen.add(one.name.lower())
            yield from (f"{_STEP * (depth + 1)}{name} (missing)" for name in one.missing)
            called = [by_name[name.lower()] for name in one.calls if name.lower() in by_name]
            stack += [(each, depth + 1) for each in reversed(called)]


def _head(one: Program) -> str:
    moves = f", {counted(one.moves, 'move')}" if one.moves else ""
    text = ", named by a text" if one.by_text else ""
    return f"{one.name} ({one.place}; {counted(one.statements, 'statement')}{moves}{text})"


def some(names: Sequence[str], most: int = _MOST_PLACES) -> str:
    """The first of them, and how many more there are."""
    if not names:
        return "nobody"
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(names[:most]) + more
