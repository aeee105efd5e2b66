"""Interrupts of a task: who is declared, armed, remembered, and what may run now.

One model for both styles: an interrupt has an identity and a priority (lower is more urgent). While one runs, those of
the same or lower urgency are remembered, once each. `off` forgets, `disable` remembers.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from rpl.runtime.code import Code, Frame, Read, Values

# Priority of interrupts that a language does not rank: all alike.
UNRANKED = 1000


@dataclass(slots=True, eq=False)
class Interrupt:
    """event: edge (condition becomes true), change (the value changes), timer (`period`), error. `level`: the frame
    that declared it; with it the declaration ends, unless `everywhere`. `stops`: the robot brakes at once when it acts.
    `last` is the value seen last."""

    key: int
    priority: int
    action: Code
    values: Values | None
    level: Frame | None = None
    everywhere: bool = False
    event: str = "edge"
    condition: Read | None = None
    condition_values: Values | None = None
    polls: bool = False
    period: float = 0.0
    once: bool = False
    stops: bool = False
    on: bool = False
    enabled: bool = True
    last: object = None
    token: int = 0

    def seen(self) -> object:
        """The value of what it watches, now."""
        assert self.condition is not None and self.condition_values is not None  # only edge and change watch
        return self.condition(self.condition_values)

    def has_come(self) -> bool:
        """Look again: is this the edge or change it waits for?"""
        now, before = self.seen(), self.last
        self.last = now
        return bool(now) and not before if self.event == "edge" else now != before


@dataclass(slots=True, eq=False)
class Interrupts:
    """All interrupts of one task. `pending`: keys in the order they came. `mask`: those that are not more urgent than
    this wait."""

    known: dict[int, Interrupt] = field(default_factory=dict)
    pending: list[int] = field(default_factory=list)
    all_enabled: bool = True
    mask: int | None = None
    next_key: int = UNRANKED

    def new_key(self) -> int:
        self.next_key += 1
        return self.next_key

    def declare(self, interrupt: Interrupt) -> None:
        """A new declaration of the same identity replaces the old one and is off."""
        self.known[interrupt.key] = interrupt
        self.forget(interrupt.key)

    def forget(self, key: int) -> None:
        if key in self.pending:
            self.pending.remove(key)

    def arm(self, interrupt: Interrupt) -> None:
        """From now on its next edge counts."""
        interrupt.on = True
        interrupt.token += 1
        if interrupt.condition is not None:
            interrupt.last = interrupt.seen()

    def look(self) -> None:
        """Something changed: remember the armed interrupts whose event has come."""
        for interrupt in self.known.values():
            if interrupt.on and interrupt.condition is not None and interrupt.has_come():
                self.came(interrupt)

    def came(self, interrupt: Interrupt) -> None:
        if interrupt.key not in self.pending:
            self.pending.append(interrupt.key)
        if interrupt.once:
            interrupt.on = False

    def urgent(self, running: int | None) -> Interrupt | None:
        """The pending interrupt that may run now."""
        best: Interrupt | None = None
        for key in self.pending:
            interrupt = self.known.get(key)
            if interrupt is None or not interrupt.enabled or not self.all_enabled:
                continue
            if running is not None and interrupt.priority >= running:
                continue
            if self.mask is not None and interrupt.priority >= self.mask:
                continue
            if best is None or interrupt.priority < best.priority:
                best = interrupt
        return best

    def drop_level(self, frame: Frame) -> None:
        """The routine that declared them returns."""
        gone = [key for key, interrupt in self.known.items() if interrupt.level is frame and not interrupt.everywhere]
        for key in gone:
            del self.known[key]
            self.forget(key)

    def control(self, op: str, key: int | None, watch_time: Callable[[Interrupt], None]) -> None:
        """on, off, enable, disable, delete; without a key: all of them. mask: `key` is the priority, None lifts it."""
        if op == "mask":
            self.mask = key
            return
        if key is None and op in ("enable", "disable"):
            self.all_enabled = op == "enable"
            return
        chosen = list(self.known.values()) if key is None else [self.known[key]] if key in self.known else []
        for interrupt in chosen:
            match op:
                case "on":
                    self.arm(interrupt)
                    watch_time(interrupt)
                case "off":
                    interrupt.on = False
                    self.forget(interrupt.key)
                case "enable":
                    interrupt.enabled = True
                case "disable":
                    interrupt.enabled = False
                case "delete":
                    interrupt.on = False
                    self.forget(interrupt.key)
                    del self.known[interrupt.key]
