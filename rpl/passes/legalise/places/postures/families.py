"""Posture families between two arms: front or back of axis 1, elbow up or down, wrist turned over or not.

Another family is another way of the arm to the same place, over its back at worst, with the cables on the other side.
So the shoulder counts more than the elbow, and that more than the wrist; whole turns are no family.
"""

from __future__ import annotations

from typing import Any

from rpl.passes.legalise.context import Arm

# What changing each costs: a shoulder is never changed to keep elbow and wrist.
_COST = {"shoulder": 4, "elbow": 2, "wrist": 1}
_WORDS = {
    "shoulder": ("in front of axis 1", "behind axis 1"),
    "elbow": ("elbow up", "elbow down"),
    "wrist": ("wrist not turned over", "wrist turned over"),
}
# Where the side changes when one axis moves by so much (degrees), the arm is on the boundary, and no side counts.
_BOUNDARY = 0.01


def differing(one: Any, other: Any) -> int:
    """How much two branches (emulator.arms.Branch) differ, 0 for none."""
    return sum(cost for name, cost in _COST.items() if getattr(one, name) != getattr(other, name))


def changed_posture(arm: Arm, joints: Any, other: Arm, found: Any) -> tuple[str, str] | None:
    """The family at joints (n,) of one arm and at those found for the other, as far as they certainly differ; None
    where they do not, or where the arms are of two builds."""
    if not (arm.has_sides and other.has_sides):
        return None
    before, after = _sides(arm, joints), _sides(other, found)
    apart = [name for name in _COST if None not in (before[name], after[name]) and before[name] != after[name]]
    if not apart:
        return None
    first, second = (", ".join(_WORDS[name][sides[name] or 0] for name in apart) for sides in (before, after))
    return first, second


def _sides(arm: Arm, joints: Any) -> dict[str, int | None]:
    """The side of each part of the posture, None on its boundary."""
    branch = arm.posture(joints).branch
    found: dict[str, int | None] = {name: int(getattr(branch, name)) for name in _COST}
    for axis in range(arm.axes):
        for step in (-_BOUNDARY, _BOUNDARY):
            moved = joints.copy()
            moved[axis] += step
            near = arm.posture(moved).branch
            found = {name: side if getattr(near, name) == side else None for name, side in found.items()}
    return found


__all__ = ["changed_posture", "differing"]
