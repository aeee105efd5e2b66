"""How two controllers choose among the postures of a place that says none: the solution nearest to where the arm is, or
the posture in which it is.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from rpl import ir, registry
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.context import Context
from rpl.passes.values import real

if TYPE_CHECKING:
    from rpl.passes.legalise.facts.motion.whereabouts import Whereabouts

FREE = code(
    "posture-left-free",
    Severity.WARNING,
    "this place says nothing about the arm's posture: the source's controller and the target's choose it by other "
    "rules, and where the arm stands before is not known here",
    "write the posture into the place, or move to joints before",
)
ASSUMED = code(
    "posture-as-from-known",
    Severity.WARNING,
    "this place says nothing about the arm's posture, and where the arm stands before is not known here: it goes there "
    "as the source's controller does from every place that is known in this program",
    "write the posture into the place, or move to joints before",
)
SAME_DEG = 0.01
_TRIED = 60  # pairs of places, spread evenly by chance over the ranges of the axes
_OFTEN = 0.05  # of them; what differs less often is a matter of the limits of the axes


@dataclass(frozen=True, slots=True)
class Choices:
    """The rules of both controllers on the arm that the program was written for."""

    arm: Any
    ours: Any
    theirs: Any

    @classmethod
    def of(cls, context: Context) -> Choices | None:
        """None where no arm is named, the result runs on another one, or a language says nothing of postures."""
        arm, other, can = context.robot, context.to_robot, context.capabilities
        if arm is None or can.carries_rules or not context.foreign or (other is not None and other is not arm):
            return None
        ours, theirs = registry.dialect(context.source).notation, registry.dialect(can.places.notation).notation
        return None if ours is None or theirs is None else cls(arm, ours(), theirs())

    @property
    def apart(self) -> bool:
        """Do the controllers often choose otherwise on this arm, with nothing said?"""
        ours: Any = type(self.ours)
        theirs: Any = type(self.theirs)
        return _apart(self.arm, ours, theirs)

    def source(self, flange: Any, before: Any) -> Any:
        """The joints (n,) to which the source's controller goes for a flange pose (4, 4), from joints (n,); None where
        it does not come there."""
        return self.ours.select(self.arm, flange, {}, before).joints

    def target(self, flange: Any, before: Any, flags: Mapping[str, int] | None = None) -> Any:
        """The same of the target's controller, which may be told flags."""
        return self.theirs.select(self.arm, flange, flags or {}, before).joints

    def differ(self, flange: Any, before: Any) -> bool:
        """Do both controllers come there, but otherwise?"""
        first = self.source(flange, before)
        second = None if first is None else self.target(flange, before)
        return second is not None and bool(abs(first - second).max() > SAME_DEG)

    def from_everywhere(self, flange: Any, stands: Whereabouts) -> Any:
        """The joints that the source's controller takes from all places where the arm is known to be; None where these
        are not the same."""
        import numpy as np  # most translations ask nothing of the arm

        known = {one.joints for one in stands.ends.values() if one.joints is not None}
        found = [self.source(flange, np.array(one)) for one in sorted(known)]
        return found[0] if found and _same(found) else None


def _same(found: Iterable[Any]) -> bool:
    first, *others = found
    return first is not None and all(one is not None and abs(one - first).max() <= SAME_DEG for one in others)


@lru_cache(maxsize=64)
def _apart(arm: Any, ours: Any, theirs: Any) -> bool:
    """ours, theirs: classes of notations."""
    import numpy as np

    low, high = arm.limits[:, 0], arm.limits[:, 1]
    spread = np.random.default_rng(1).uniform(-0.9, 0.9, size=(_TRIED, 2, len(low)))
    pairs = np.clip((low + high) / 2 + spread * (high - low) / 2, -170.0, 170.0)
    rules = Choices(arm, ours(), theirs())
    differ = sum(rules.differ(arm.forward(to), at) for at, to in pairs)
    return differ > _OFTEN * _TRIED


def to_a_place(node: object) -> bool:
    """A joint move whose place may leave the posture open."""
    return isinstance(node, ir.Move) and node.kind == "joint" and node.relative is None


def joint_target(joints: Any, digits: int = 9) -> ir.Aggregate:
    """Joints (n,) as a target, written out."""
    entries = tuple((name, real(round(float(one), digits))) for name, one in zip(ir.AXES, joints, strict=False))
    return ir.Aggregate(entries, type_name="joints")


__all__ = ["ASSUMED", "FREE", "SAME_DEG", "Choices", "joint_target", "to_a_place"]
