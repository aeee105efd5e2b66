"""The neutral built-in procedures: they write to the variables they are given, and say whether it worked."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from rpl.runtime.code import AnyRef
from rpl.runtime.faults import ProgramError
from rpl.runtime.functions.texts import formatted, parsed, scanned, text_value
from rpl.runtime.values import Member, Record, Value, whole


@dataclass(frozen=True, slots=True)
class Place:
    """What linking knows of a written argument: the capacity of a text, whether a number must be whole, a value of
    its type (None when nothing is known), and what rounds a sum as the language does."""

    capacity: int | None = None
    is_whole: bool = False
    like: Value = None
    precision: Callable[[Value], Value] | None = None


Arguments = list[Value]


def _text(value: Value) -> str:
    return value if isinstance(value, str) else ""


def _fits(text: str, place: Place) -> bool:
    return place.capacity is None or len(text) <= place.capacity


def _append(places: list[Place], target: AnyRef, text: str) -> bool:
    whole_text = _text(target.get()) + text
    if not _fits(whole_text, places[0]):
        return False
    target.set(whole_text)
    return True


def _append_length(places: list[Place], target: AnyRef, text: str) -> int:
    return len(_text(target.get())) if _append(places, target, text) else 0


def _copy(places: list[Place], target: AnyRef, text: str) -> bool:
    if not _fits(text, places[0]):
        return False
    target.set(text)
    return True


def _clear_text(places: list[Place], target: AnyRef) -> bool:
    target.set("")
    return True


def _parse_number(places: list[Place], text: str, target: AnyRef) -> bool:
    try:
        number = text_value(text)
    except ProgramError:
        return False
    if places[1].is_whole:
        if isinstance(number, float):
            return False
        target.set(number)
        return True
    target.set(float(number) if not isinstance(number, int) else number)
    return True


def _parse_value(places: list[Place], text: str, target: AnyRef) -> bool:
    like = places[1].like if places[1].like is not None else target.get()
    try:
        target.set(parsed(text, like))
    except ValueError:
        return False
    return True


def _state(target: AnyRef, good: bool, hits: int, length: int) -> None:
    """Write what happened where the language has a record for it, else whether it worked."""
    state = target.get()
    if not isinstance(state, Record):
        target.set(good)
        return
    for name, value in (("ret1", Member("data_end" if good else "fmt_err")), ("hits", hits), ("length", length)):
        if name in state.parts:
            state.parts[name] = value


def _format_into(
    places: list[Place], target: AnyRef, state: AnyRef, offset: AnyRef, pattern: str, *values: Value
) -> bool:
    start = whole(offset.get() or 0)
    text = _text(target.get()).ljust(start)[:start] + formatted(pattern, *values)
    good = _fits(text, places[0])
    if good:
        target.set(text)
        offset.set(len(text))
    _state(state, good, len(values), len(text) - start)
    return good


def _scan_from(places: list[Place], text: str, state: AnyRef, offset: AnyRef, pattern: str, *targets: AnyRef) -> bool:
    start = whole(offset.get() or 0)
    found, end = scanned(pattern, text, start)
    for target, value in zip(targets, found, strict=False):
        target.set(value)
    offset.set(end)
    good = len(found) >= len(targets)
    _state(state, good, len(found), end - start)
    return good


def _add(sign: int) -> Callable[..., Value]:
    def add(places: list[Place], target: AnyRef, amount: Value = 1) -> Value:
        to = places[0].precision
        target.set(target.get() + sign * amount if to is None else to(to(target.get()) + sign * to(amount)))
        return target.get()

    return add


def _clear(places: list[Place], target: AnyRef) -> int:
    target.set(0)
    return 0


PROCEDURES: dict[str, Callable[..., Value]] = {
    "text_append": _append,
    "text_append_length": _append_length,
    "text_copy": _copy,
    "text_clear": _clear_text,
    "parse_number": _parse_number,
    "parse_value": _parse_value,
    "format_into": _format_into,
    "scan_from": _scan_from,
    "increment": _add(1),
    "decrement": _add(-1),
    "clear": _clear,
}
