"""The graph of calls as a drawing: columns from left to right, callers in front of what they call.

A routine stands behind its furthest caller; calls that go back (recursion) do not count for that. In a column routines
are ordered by where their callers stand, which keeps most lines from crossing (barycentre heuristic of Sugiyama, 1981).
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

from rpl.inventory.contents import Program

_WIDE, _HIGH, _GAP, _ROW = 190, 26, 70, 36  # px: a box, the room between columns, a row
_ROUNDS = 4
_LONGEST = 26  # signs of a name in its box


@dataclass(frozen=True, slots=True)
class Box:
    """A routine; x, y of its upper left corner in px. kind: entry, called, alone, missing."""

    name: str
    shown: str
    about: str
    kind: str
    x: int
    y: int


@dataclass(frozen=True, slots=True)
class Line:
    """A call; d: the path of its curve."""

    caller: str
    called: str
    d: str


@dataclass(frozen=True, slots=True)
class Graph:
    """A drawing and its size in px."""

    boxes: tuple[Box, ...]
    lines: tuple[Line, ...]
    width: int
    height: int


def graph(programs: Sequence[Program]) -> Graph:
    """The calls of a project, with what is missing as boxes of their own."""
    by_name = {one.name.lower(): one for one in programs}
    calls = {name: [called.lower() for called in one.calls] for name, one in by_name.items()}
    spelled = {name: one.name for name, one in by_name.items()}
    for name, one in by_name.items():
        for missing in one.missing:
            calls[name].append(missing.lower())
            calls.setdefault(missing.lower(), [])
            spelled.setdefault(missing.lower(), missing)
    columns = _ordered(_columns(calls, [one.name.lower() for one in programs if one.entry]), calls)
    boxes: dict[str, Box] = {}
    for at, column in enumerate(columns):
        for row, name in enumerate(column):
            boxes[name] = _box(name, spelled[name], by_name.get(name), at * (_WIDE + _GAP), row * _ROW)
    lines = [
        Line(name, called, _curve(boxes[name], boxes[called]))
        for name in calls
        for called in dict.fromkeys(calls[name])
    ]
    tallest = max((len(column) for column in columns), default=0)
    return Graph(tuple(boxes.values()), tuple(lines), len(columns) * (_WIDE + _GAP), tallest * _ROW)


def _columns(calls: dict[str, list[str]], entries: list[str]) -> list[list[str]]:
    """Each routine one column behind its furthest caller."""
    forward = _without_circles(calls, entries)
    waiting: dict[str, int] = defaultdict(int)
    for name in calls:
        for called in forward[name]:
            waiting[called] += 1
    depth = dict.fromkeys(calls, 0)
    free = [name for name in calls if not waiting[name]]
    while free:
        name = free.pop()
        for called in forward[name]:
            depth[called] = max(depth[called], depth[name] + 1)
            waiting[called] -= 1
            if not waiting[called]:
                free.append(called)
    columns: list[list[str]] = [[] for _ in range(max(depth.values(), default=-1) + 1)]
    for name in (*entries, *(one for one in calls if one not in set(entries))):
        columns[depth[name]].append(name)
    return columns


def _without_circles(calls: dict[str, list[str]], entries: list[str]) -> dict[str, list[str]]:
    """The calls without those that lead back to a routine on the way to them."""
    forward: dict[str, list[str]] = {name: [] for name in calls}
    state: dict[str, int] = {}  # 1: on the way, 2: done
    for start in (*entries, *calls):
        if start in state:
            continue
        state[start] = 1
        stack = [(start, iter(dict.fromkeys(calls[start])))]
        while stack:
            name, rest = stack[-1]
            called = next(rest, None)
            if called is None:
                state[name] = 2
                stack.pop()
            elif state.get(called) != 1:
                forward[name].append(called)
                if called not in state:
                    state[called] = 1
                    stack.append((called, iter(dict.fromkeys(calls[called]))))
    return forward


def _ordered(columns: list[list[str]], calls: dict[str, list[str]]) -> list[list[str]]:
    """The columns with each routine near its callers, then near what it calls."""
    callers: dict[str, list[str]] = defaultdict(list)
    for name, found in calls.items():
        for called in found:
            callers[called].append(name)
    for turn in range(_ROUNDS):
        beside = callers if turn % 2 == 0 else calls
        row = {name: at for column in columns for at, name in enumerate(column)}
        for column in columns:
            middle = {
                name: sum(row[one] for one in beside[name]) / len(beside[name]) if beside[name] else float(row[name])
                for name in column
            }
            column.sort(key=lambda name: middle[name])
    return columns


def _box(name: str, spelled: str, one: Program | None, x: int, y: int) -> Box:
    shown = spelled if len(spelled) <= _LONGEST else spelled[: _LONGEST - 1] + "…"
    if one is None:
        return Box(name, shown, f"{spelled}: missing", "missing", x, y)
    kind = "entry" if one.entry else "called" if one.called_by else "alone"
    return Box(name, shown, f"{one.name}, {one.place}: {one.statements} statements, {one.moves} moves", kind, x, y)


def _curve(caller: Box, called: Box) -> str:
    x, y = caller.x + _WIDE, caller.y + _HIGH // 2
    to_x, to_y = called.x, called.y + _HIGH // 2
    bend = max(_GAP // 2, abs(to_x - x) // 3)
    return f"M{x},{y} C{x + bend},{y} {to_x - bend},{to_y} {to_x},{to_y}"
