"""What a comparison has found so far: deviations and the greatest distances."""

from __future__ import annotations

from dataclasses import dataclass, field

from rpl.proof.deviations import Deviation
from rpl.proof.difference import Side


@dataclass(slots=True)
class Findings:
    """max_path_mm and max_joint_deg leave nothing out, corners included. `compared`: how many events and moves were
    held against each other."""

    deviations: list[Deviation] = field(default_factory=list)
    max_path_mm: float = 0.0
    max_joint_deg: float = 0.0
    max_time_s: float = 0.0
    compared: int = 0

    def deviates(self, kind: str, amount: float, text: str, a: Side, b: Side, task: str, share: float = 0.0) -> None:
        """One more deviation."""
        self.deviations.append(Deviation(kind, amount, text, a, b, task, share))

    def apart(self, mm: float) -> None:
        """Ways of the tool that are so far apart."""
        self.max_path_mm = max(self.max_path_mm, mm)


__all__ = ["Findings"]
