"""The stop that a translation writes for an error that nobody handles.

A language with error handlers ends such a run in a fault. In one without, the outermost routine says that the error is
not handled and stops. Where one run ends in such a fault and the other one in exactly that message and stop, both have
come to the same end: the stop is taken for the fault. Whether they have come there on the same way is compared as ever.
"""

from __future__ import annotations

from dataclasses import replace

from rpl.ir.errornames import unhandled_text
from rpl.proof.record import Happening, Record

_FAULT, _STOPPED = "fault", "stopped"
_SOON_S = 1e-9


def with_written_stop(record: Record, other: Record) -> Record:
    """The record with the fault of the other one in place of the stop that is written for it; the same record where it
    does not end so. The robot must not move, and no task do anything, behind the message."""
    if record.language == other.language or record.status != _STOPPED or other.status != _FAULT:
        return record
    fault = next((one for every in other.tasks.values() for one in every if one.kind == _FAULT and one.names), None)
    if fault is None:
        return record
    texts = {_bare(unhandled_text(name)) for name in fault.names}
    for task, happenings in record.tasks.items():
        count = _said(happenings, texts)
        if not count:
            continue
        message = happenings[-count - 1]
        if _goes_on(record, task, message):
            return record
        stop = replace(message, kind=_FAULT, value=fault.value, names=fault.names)
        tasks = {**record.tasks, task: (*happenings[: -count - 1], stop, happenings[-1])}
        ended = {name: tuple(map(_as_fault, one)) for name, one in tasks.items()}
        return replace(record, status=_FAULT, tasks=ended)
    return record


def _said(happenings: tuple[Happening, ...], texts: set[str]) -> int:
    """In how many messages, all at one moment, a task says one of the texts just before its end; 0: it does not."""
    said = ""
    for count, one in enumerate(reversed(happenings[:-1]), 1):
        if one.kind != "message" or one.t != happenings[-2].t:
            return 0
        said = _bare(str(one.value)) + said
        if said in texts:
            return count
    return 0


def _goes_on(record: Record, task: str, message: Happening) -> bool:
    """Does anything move or happen behind the message, in any task?"""
    moves = any(move.times[-1] > message.t + _SOON_S for every in record.motion.values() for move in every)
    shown = any(
        one.number > message.number and one.kind not in ("end", "wait")
        for name, every in record.tasks.items()
        for one in every
        if name != task
    )
    return moves or shown or record.time_s > message.t + _SOON_S


def _as_fault(one: Happening) -> Happening:
    return replace(one, value=_FAULT) if one.kind == "end" and one.value == _STOPPED else one


def _bare(text: str) -> str:
    return "".join(text.split())


__all__ = ["with_written_stop"]
