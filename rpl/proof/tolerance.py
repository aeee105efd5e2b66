"""What still counts as equal, and what somebody accepts besides."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from rpl.errors import UsageError
from rpl.proof.deviations import KINDS, Deviation
from rpl.proof.paths import TURN_LEVER_MM


@dataclass(frozen=True, slots=True)
class Tolerance:
    """Below these, two runs are equal; above, a measure deviates. The printed precision decides: three decimals of a
    millimetre leave 0.0005 mm per coordinate and four of a degree 0.00005 deg, which a reach of 2 m turns into less
    than 0.002 mm; 0.01 mm is safely above and far below anything that a robot repeats.

    place_mm: where on a moving path an output may switch. wait_s: up to there two timed waits are one event; they
    deviate above exact_s, as pulses do. helped_s: a pulse that one side makes by a program that looks in its cycle.
    looking_share: of a time, by which a program that looks again and again sees its end later. time_share: of a whole
    run's time. measure_share: of speeds and accelerations.
    polling_share: of the time since the start, by which two polling loops may differ (other accelerations before them).
    look_s: a single wait up to this long may be one look of a polling loop. step_s: a controller's cycle.
    """

    path_mm: float = 0.01
    turn_deg: float = 0.01
    joint_deg: float = 0.01
    place_mm: float = 1.0
    wait_s: float = 0.002
    exact_s: float = 1e-5
    helped_s: float = 0.02
    looking_share: float = 0.005
    time_s: float = 0.01
    time_share: float = 0.01
    measure_share: float = 0.001
    polling_share: float = 0.05
    look_s: float = 0.1
    step_s: float = 0.01
    number: float = 1e-6
    load_kg: float = 0.001
    load_mm: float = 0.1
    corner_mm: float = 0.1

    def as_text(self) -> str:
        """The tolerances of the tool's path, for the verdict."""
        return f"{self.path_mm:g} mm and {self.turn_deg:g} deg"


# Kinds of deviation that a limit accepts, by the name of the limit.
_LIMITED = {
    "corner": "corner_mm",
    "turning": "corner_mm",
    "corner-size": "corner_mm",
    "path": "path_mm",
    "time": "time_share",
}


@dataclass(frozen=True, slots=True)
class Accepted:
    """Deviations that somebody accepts: whole kinds (deviations.KINDS), or up to a limit. path_mm: how far the
    tool's paths may be apart away from corners; corner_mm: in corners, and by how much their programmed sizes may
    differ; time_share: of the moments since the start."""

    kinds: frozenset[str] = frozenset()
    path_mm: float | None = None
    corner_mm: float | None = None
    time_share: float | None = None

    def takes(self, deviation: Deviation) -> bool:
        """Is the deviation accepted?"""
        if deviation.kind in self.kinds:
            return True
        limit = getattr(self, _LIMITED.get(deviation.kind, ""), None) if deviation.kind in _LIMITED else None
        amount = deviation.share if deviation.kind == "time" else deviation.amount
        if deviation.kind == "turning":  # in a corner; as far as it moves a point of the tool at the usual lever
            amount = math.radians(amount) * TURN_LEVER_MM
        return limit is not None and amount <= limit


def accepted_kinds(words: Iterable[str]) -> frozenset[str]:
    """Kinds as `--accept` names them; raises UsageError for one that is none."""
    kinds = frozenset(words)
    for word in sorted(kinds):
        if word not in KINDS:
            raise UsageError(f"--accept {word}: no measure of a proof; they are {', '.join(KINDS)}")
    return kinds
