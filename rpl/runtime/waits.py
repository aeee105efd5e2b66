"""What a task waits for, as plain data: the scheduler asks `is_over` whenever something changed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from rpl.runtime.code import Read, Values, Write

if TYPE_CHECKING:
    from rpl.source import Origin

# Waits whose deadline is a time-out: the error is raised then.
TIMED_OUT = frozenset(("condition", "answer", "meeting"))
# How often a condition that depends on time is looked at, s: the cycle in which controllers interpolate.
CYCLE_S = 0.012
# A long wait is looked at less often: at this share of the time it has taken so far, at most every POLL_MOST_S.
POLL_SHARE = 0.002
POLL_MOST_S = 0.1


class Waited(NamedTuple):
    """A wait for a condition that has ended: the task, from and to (s), and whether its time ran out before the
    condition came."""

    task: str
    begin: float
    end: float
    timed_out: bool = False


@dataclass(frozen=True, slots=True)
class Awaited:
    """A task that had not ended: what it waited for (`kind` as of a Wait, "" when it ran), where, since when (s), the
    inputs that it looked at (each with the moment, s), and the text of the wait."""

    task: str
    kind: str
    origin: Origin
    since_s: float
    inputs: tuple[tuple[str, float], ...]
    subject: str = ""


def poll_step(waited_s: float, least_s: float = CYCLE_S) -> float:
    """Seconds until a condition is looked at again."""
    return max(least_s, min(POLL_MOST_S, waited_s * POLL_SHARE))


@dataclass(slots=True, eq=False)
class Wait:
    """kind: time, condition, idle (the robot has driven everything), room (the program pointer may go on), released
    (move `move` lets the program go on), standing (a stop has ended), tick (a polling loop lets time pass), answer,
    task (number `move` has ended), meeting (other tasks are at the same point).

    `at` is the waiting instruction, `next` where to go on; `deadline` ends the wait, then `timed_out` is written or the
    error raised. `counts`: whether the deadline is the purpose (a timed wait) or a time-out.
    """

    kind: str
    at: int
    next: int
    token: int
    since: float
    deadline: float | None = None
    condition: Read | None = None
    values: Values | None = None
    polls: bool = False
    poll_s: float = CYCLE_S
    timed_out: Write | None = None
    error: str | None = None
    move: int = 0
    subject: str = ""

    def describe(self) -> str:
        """What it waits for, in words."""
        words = {
            "time": "a time to pass",
            "condition": "a condition",
            "idle": "the robot to arrive",
            "room": "the robot to drive on",
            "released": "the robot to come near its target",
            "standing": "the robot to stand",
            "tick": "time to pass",
            "answer": "the operator's answer",
            "meeting": "other tasks",
            "task": "another task to end",
        }
        return f"{words[self.kind]} ({self.subject})" if self.subject else words[self.kind]


@dataclass(slots=True, eq=False)
class Arrival:
    """A task (its number) that waits at a point for the tasks of its list; `token`: of its wait."""

    task: int
    identity: str
    mode: str
    group: frozenset[int]
    token: int
