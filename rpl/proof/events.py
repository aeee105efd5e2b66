"""Events of two runs: the same outputs, messages, dialogs, blocking waits and end in each task, in the same order with
the same values. What only one language has (helper tasks, looks of a polling loop) is no event.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from rpl.proof.difference import Difference, Side
from rpl.proof.messages import as_lines, same_message
from rpl.proof.record import Happening, Record, Value
from rpl.proof.tolerance import Tolerance


def event_difference(a: Record, b: Record, tolerance: Tolerance) -> Difference | None:
    """The first event that differs in any task; tasks are paired by name, a single one with a single one."""
    pairs = paired(a, b)
    if isinstance(pairs, Difference):
        return pairs
    found = []
    for task, ours, theirs in pairs:
        if a.language != b.language:
            ours, theirs = without_conditions(ours), without_conditions(theirs)
        difference = _task_events(task, ours, theirs, tolerance, a.language != b.language)
        if difference is not None:
            found.append(difference)
    return min(found, key=_when) if found else None


def without_conditions(happenings: tuple[Happening, ...]) -> tuple[Happening, ...]:
    """Whether a condition had to be waited for depends on how fast each controller was before."""
    return tuple(one for one in happenings if not (one.kind == "wait" and one.value is None))


def _when(difference: Difference) -> float:
    times = [side.t for side in (difference.a, difference.b) if side.t is not None]
    return min(times, default=0.0)


Tasks = dict[str, tuple[Happening, ...]]
Pair = tuple[str, tuple[Happening, ...], tuple[Happening, ...]]


def paired(a: Record, b: Record) -> list[Pair] | Difference:
    if len(a.tasks) == 1 and len(b.tasks) == 1:
        (name, ours), (_, theirs) = next(iter(a.tasks.items())), next(iter(b.tasks.items()))
        return [(name, ours, theirs)]
    left = {name.lower(): happenings for name, happenings in a.tasks.items()}
    right = {name.lower(): happenings for name, happenings in b.tasks.items()}
    if a.language != b.language:
        left, right = _with_helpers(left, right), _with_helpers(right, left)
    if set(left) != set(right):
        lone = sorted(set(left) ^ set(right))[0]
        there = "A" if lone in left else "B"
        return Difference(
            "task",
            "events",
            f"only {there} has a task {lone}",
            Side(f"tasks {', '.join(left)}"),
            Side(f"tasks {', '.join(right)}"),
            lone,
        )
    return [(name, left[name], right[name]) for name in left]


def _with_helpers(tasks: Tasks, others: Tasks) -> Tasks:
    """Tasks that only one language needs, for what the other's controller does by itself, are a part of the first task:
    what they switch and say is, not that they wait and end."""
    first = next((name for name in tasks if name in others), "")
    extra = [name for name in tasks if name not in others]
    if not extra or not first:
        return tasks
    shown = [replace(one, helper=True) for name in extra for one in tasks[name] if one.kind not in ("wait", "end")]
    kept = {name: happenings for name, happenings in tasks.items() if name not in extra}
    every = sorted((*tasks[first], *shown), key=lambda one: (one.kind == "end", round(one.t, 9), one.number))
    return kept | {first: tuple(every)}


def _task_events(
    task: str, ours: Sequence[Happening], theirs: Sequence[Happening], tolerance: Tolerance, foreign: bool
) -> Difference | None:
    """The first two that differ. `foreign`: where only one language looks again and again for what the other waits for
    (which is no event by itself), its looks count for nothing."""
    for first, second in matched(ours, theirs, tolerance, foreign):
        if first is None or second is None or not same_event(first, second, tolerance, foreign):
            return _event_difference(task, first, second)
    return None


def matched(
    ours: Sequence[Happening], theirs: Sequence[Happening], tolerance: Tolerance, foreign: bool
) -> Iterator[tuple[Happening | None, Happening | None]]:
    """Happening beside happening, also where they differ, without the looks that only one language has."""
    at, there = 0, 0
    while at < len(ours) or there < len(theirs):
        first = ours[at] if at < len(ours) else None
        second = theirs[there] if there < len(theirs) else None
        same = first is not None and second is not None and same_event(first, second, tolerance, foreign)
        split = foreign and (not same or (first is not None and first.kind == "message"))
        lines = as_lines(ours[at:], theirs[there:]) if split else (1, 1)
        if first is not None and second is not None and lines != (1, 1):
            whole = second if lines[0] > 1 else first
            yield replace(first, value=whole.value), replace(second, value=whole.value)
            at, there = at + lines[0], there + lines[1]
        elif not same and foreign and first is not None and is_looking(first, tolerance):
            at += 1
        elif not same and foreign and second is not None and is_looking(second, tolerance):
            there += 1
        else:
            yield first, second
            at, there = at + 1, there + 1


def is_looking(happening: Happening, tolerance: Tolerance) -> bool:
    """Is it a loop of short waits, as programs have that look for a condition, or the only cycle of one?"""
    if happening.kind != "wait" or happening.value is None:
        return False
    longest = tolerance.look_s if happening.times > 1 else tolerance.step_s
    return happening.longest_s <= longest


def same_event(a: Happening, b: Happening, tolerance: Tolerance, foreign: bool = True) -> bool:
    """Do two happenings mean the same, apart from when and where on the path? Within one language outputs of one name
    that are declared for two numbers are two outputs; another one may number them anew."""
    if a.kind != b.kind:
        return False
    match a.kind:
        case "output":
            shared = a.names & b.names
            if not foreign and all(":" not in name for name in shared) and _numbered(a) and _numbered(b):
                return False
            return bool(shared) and same_value(a.value, b.value, tolerance.number)
        case "wait":
            return same_value(a.value, b.value, tolerance.wait_s) or _same_polling(a, b, tolerance)
        case "message":
            return same_message(a, b)
        case "dialog":
            return " ".join(str(a.value).split()) == " ".join(str(b.value).split())
        case _:
            return a.value == b.value


def crossed_difference(
    pairs: Sequence[tuple[str, Sequence[Happening], Sequence[Happening]]], tolerance: Tolerance, foreign: bool
) -> Difference | None:
    """Two programs may number their outputs in two ways; but what are two outputs of one are two of the other. The
    first event at which that is not so."""
    met: tuple[dict[frozenset[str], tuple[frozenset[str], Happening]], ...] = ({}, {})
    for task, ours, theirs in pairs:
        for a, b in matched(ours, theirs, tolerance, foreign):
            if a is None or b is None or a.kind != "output":
                continue
            keys = _identity(a), _identity(b)
            for which, one, other in ((0, a, b), (1, b, a)):
                known, before = met[which].setdefault(keys[which], (keys[1 - which], other))
                if known != keys[1 - which]:
                    return _crossed(task, "AB"[which], one, (before, other), (a, b))
    return None


def _identity(output: Happening) -> frozenset[str]:
    """What makes it the same output again: its numbers, where it has some."""
    numbers = frozenset(name for name in output.names if ":" in name)
    return numbers or output.names


def _crossed(
    task: str, who: str, one: Happening, others: tuple[Happening, Happening], both: tuple[Happening, Happening]
) -> Difference:
    names = " and ".join(_shown_name(other.names) for other in others)
    text = f"one output of {who} is two of the other: {_shown_name(one.names)} is {names}"
    return Difference("output", "events", text, side(both[0]), side(both[1]), task)


def _numbered(happening: Happening) -> bool:
    return any(":" in name for name in happening.names)


def _same_polling(a: Happening, b: Happening, tolerance: Tolerance) -> bool:
    """A polling loop may end as much earlier or later as it began later or earlier; and where one language waits for a
    condition with a time-out, another has to look again and again."""
    if (a.value is None) != (b.value is None):
        polling = b if a.value is None else a
        return polling.times > 1 or polling.longest_s <= tolerance.look_s
    if a.times == b.times or not isinstance(a.value, int | float) or not isinstance(b.value, int | float):
        return False
    slack = max(2.0 * max(a.longest_s, b.longest_s), tolerance.polling_share * max(a.t + a.value, b.t + b.value))
    return abs(a.value - b.value) <= slack


def same_value(a: Value, b: Value, slack: float) -> bool:
    """Numbers within the slack (relative above 1); TRUE is 1 and FALSE is 0."""
    if isinstance(a, int | float) and isinstance(b, int | float):
        return abs(float(a) - float(b)) <= slack * max(1.0, abs(float(a)), abs(float(b)))
    return a == b


def in_words(happening: Happening) -> str:
    """What happened, for people."""
    match happening.kind:
        case "output":
            return f"output {_shown_name(happening.names)} becomes {_shown(happening.value)}"
        case "message" | "dialog":
            return f"{happening.kind} {_shown(happening.value)}"
        case "wait":
            return "waits for a condition" if happening.value is None else f"waits {happening.value:g} s"
        case "fault":
            return f"fault {happening.value}"
        case _:
            return f"ends: {happening.value}"


def _shown_name(names: frozenset[str]) -> str:
    return min(names, key=lambda name: (":" in name, name), default="?")


def _shown(value: Value) -> str:
    return str(value).upper() if isinstance(value, bool) else repr(value)


def side(happening: Happening | None) -> Side:
    if happening is None:
        return Side(None)
    return Side(in_words(happening), happening.place, happening.t, happening.value)


def _event_difference(task: str, a: Happening | None, b: Happening | None) -> Difference:
    some = a if a is not None else b
    assert some is not None
    kind = some.kind if a is None or b is None or a.kind == b.kind else "order"
    if a is None or b is None:
        text = f"{'A' if b is None else 'B'} goes on where the other has ended"
    elif a.kind != b.kind:
        text = f"the order differs: {in_words(a)} in A, {in_words(b)} in B"
    elif a.kind == "output" and not a.names & b.names:
        text = f"different outputs are switched: {_shown_name(a.names)} in A, {_shown_name(b.names)} in B"
    else:
        text = f"{some.kind} differs: {_shown(a.value)} in A, {_shown(b.value)} in B"
    return Difference(kind, "events", text, side(a), side(b), task)


__all__ = [
    "crossed_difference",
    "event_difference",
    "in_words",
    "is_looking",
    "matched",
    "paired",
    "same_event",
    "same_value",
    "side",
    "without_conditions",
]
