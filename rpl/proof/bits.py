"""Outputs that one program writes as a group of bits and another bit by bit, in one form for the comparison.

A group is taken apart into the bits that change, at its moment and lowest bit first, in both records alike: wherever
either of them switches one of its bits singly, or writes another group over some of them.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace

from rpl.proof.record import Happening, Record

Range = tuple[int, int]

_GROUP, _BIT = re.compile(r"group_out:(\d+)-(\d+)"), re.compile(r"digital_out:(\d+)")


def in_bits(a: Record, b: Record) -> tuple[Record, Record]:
    """Both records with the groups taken apart that they do not share as they are."""
    groups: set[Range] = set()
    singles: set[int] = set()
    for record in (a, b):
        for happenings in record.tasks.values():
            for one in happenings:
                group, bit = _group(one), _bit(one)
                groups |= {group} if group is not None else set()
                singles |= {bit} if bit is not None else set()
    apart = frozenset(
        group
        for group in groups
        if any(group[0] <= bit <= group[1] for bit in singles)
        or any(other != group and other[0] <= group[1] and group[0] <= other[1] for other in groups)
    )
    return (_apart(a, apart), _apart(b, apart)) if apart else (a, b)


def with_wired_groups(record: Record, bits: Mapping[str, str]) -> Record:
    """The record with the bits of groups that have a name or a number only, as the other program's wiring gives them
    (wiring.wired_bits)."""

    def named(one: Happening) -> Happening:
        more = {bits[name] for name in one.names if name in bits} if one.kind == "output" else None
        return replace(one, names=one.names | more) if more and _group(one) is None else one

    return replace(record, tasks={task: tuple(map(named, many)) for task, many in record.tasks.items()})


def _group(happening: Happening) -> Range | None:
    """First and last bit of the group that is written; None for anything else."""
    for name in happening.names if happening.kind == "output" else ():
        if match := _GROUP.fullmatch(name):
            return int(match[1]), int(match[2])
    return None


def _bit(happening: Happening) -> int | None:
    """The number of the single output that is switched; None for anything else."""
    for name in happening.names if happening.kind == "output" else ():
        if match := _BIT.fullmatch(name):
            return int(match[1])
    return None


def _apart(record: Record, groups: frozenset[Range]) -> Record:
    """The record with these groups as the bits that change. What the bits were is known from all tasks."""
    in_time = sorted(
        ((one.t, number, task, one) for task, many in record.tasks.items() for number, one in enumerate(many)),
        key=lambda entry: entry[:2],
    )
    state: dict[int, bool] = {}
    done: dict[str, list[Happening]] = {task: [] for task in record.tasks}
    for _, _, task, one in in_time:
        group, bit = _group(one), _bit(one)
        if group is not None and isinstance(one.value, int | float):
            bits = _changes(group, int(one.value), state)
            state.update(bits)
            if group in groups:
                single = (replace(one, names=frozenset((f"digital_out:{n}",)), value=on) for n, on in bits.items())
                done[task].extend(single)
                continue
        elif bit is not None:
            state[bit] = bool(one.value)
        done[task].append(one)
    return replace(record, tasks={task: tuple(many) for task, many in done.items()})


def _changes(group: Range, value: int, state: dict[int, bool]) -> dict[int, bool]:
    """The bits that get another value, lowest first."""
    first, last = group
    wanted = {number: bool(value >> (number - first) & 1) for number in range(first, last + 1)}
    return {number: on for number, on in wanted.items() if state.get(number, False) != on}
