"""The world's answers to outputs: which reactions of the cell a signal, or the number that a group of bits shows, sets
off. They follow from the cell and the linked program alone, so that snapshots of a run share them."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from rpl.runtime.signals import Key, group_bits, is_bit_group, keys_named, usual
from rpl.runtime.values import Value

if TYPE_CHECKING:
    from rpl.cell import Reaction
    from rpl.runtime.linked import Linked


class Reactions:
    """Those of a cell, by what they answer to: a signal, or a group of bits."""

    def __init__(self, linked: Linked, given: Sequence[Reaction]) -> None:
        self.linked, self.given = linked, tuple(dict.fromkeys(given))  # one that is said twice is one answer
        self.names_known = -1  # how many names of signals the linker had when these were sorted
        self.single: list[tuple[frozenset[Key], Reaction]] = []
        self.groups: list[tuple[list[Key], Reaction]] = []

    def sort(self) -> None:
        """Anew where the linker knows more names: a routine that is linked brings names of its own."""
        if self.names_known == self.linked.signals_named:
            return
        self.names_known = self.linked.signals_named
        ports = [(self.linked.alias(each.when), each) for each in self.given]
        self.single = [(keys_named(each.when, p), each) for p, each in ports if p is None or not is_bit_group(p)]
        self.groups = [(group_bits(p), each) for p, each in ports if p is not None and is_bit_group(p)]

    def to_signal(self, value: Value, keys: Collection[Key]) -> Iterator[Reaction]:
        """Those to a signal, by any of its keys, that has got this value."""
        self.sort()
        for wanted, reaction in self.single:
            if reaction.value == value and any(key in wanted or usual(key) in wanted for key in keys):
                yield reaction

    def to_groups(self, turned: Collection[Key], signals: Mapping[Key, Value]) -> Iterator[Reaction]:
        """Those to the number that a group of bits shows now, some of which have just turned."""
        self.sort()
        if not self.groups:
            return
        usually = {usual(key) for key in turned}
        levels = {usual(key): value for key, value in signals.items()}
        for bits, reaction in self.groups:
            if not usually.isdisjoint(bits):
                shown = sum(1 << place for place, key in enumerate(bits) if levels.get(key))
                if shown == reaction.value:
                    yield reaction
