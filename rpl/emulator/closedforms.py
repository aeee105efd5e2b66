"""The closed-form inverse of an arm as plain numbers, for translations that bring the calculation along.

A controller whose programs cannot ask for the joints of a place can still work them out, given the arm's lengths, how
its pendant counts, its limits and its speeds. SCARA arms and arms solved by iteration have no such description here.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING

from rpl.emulator.arms import OpwArm, UrArm

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel


@dataclass(frozen=True, slots=True)
class ClosedForm:
    """`build`: "ur" (axes 2, 3 and 4 parallel) or "opw" (axes 2 and 3 parallel, spherical wrist). `lengths` in mm by
    the names of rpl.emulator.arms. theta = factors . pendant - offsets; degrees, speeds in deg/s."""

    build: str
    lengths: dict[str, float]
    factors: tuple[tuple[float, ...], ...]
    offsets: tuple[float, ...]
    limits: tuple[tuple[float, float], ...]
    speeds: tuple[float, ...]


def closed_form(model: RobotModel) -> ClosedForm | None:
    """None for an arm of another build."""
    arm = model.arm
    if not isinstance(arm, UrArm | OpwArm):
        return None
    return ClosedForm(
        "ur" if isinstance(arm, UrArm) else "opw",
        {name: float(value) for name, value in asdict(arm).items()},
        tuple(tuple(map(float, row)) for row in model.pendant_to_arm),
        tuple(map(float, model.offsets)),
        tuple((float(low), float(high)) for low, high in model.limits),
        tuple(map(float, model.speeds)),
    )


__all__ = ["ClosedForm", "closed_form"]
