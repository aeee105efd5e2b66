"""How much a run may do before it is ended: no program, however wrong, keeps the emulator busy or fills its memory.

What is reached first ends the run with the place where the program was. The numbers are far above what a controller
could do in the same time; a program that needs more is run with higher ones.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Limits:
    """time_s: simulated seconds of the whole run. statements: executed in the whole run (None: no limit). steps:
    statements of one task without any time passing; of what costs more (entries of the trace, waits, signals and moves
    that come) STEPS_OF_EVENT times fewer. events: entries of the trace of the whole run."""

    time_s: float = 3600.0
    statements: int | None = None
    steps: int = 1_000_000
    events: int = 1_000_000


DEFAULTS = Limits()
STEPS_OF_EVENT = 10
# As many events an arrival or start of a driven move counts for: it takes longest to work out.
EVENTS_OF_MOTION = 20
# Outputs of one run that wait to be switched later, and path events of a task that wait for its next move.
MOST_WAITING = 10_000
# Whole numbers are kept exactly up to this size (64 bits), and texts up to this length.
MOST_WHOLE = 2**63 - 1
MOST_CHARACTERS = 1_000_000
