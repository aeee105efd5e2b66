"""Built-in geometric types in the target's own components: ZYX angles side by side, or a position and a quaternion."""

from __future__ import annotations

from rpl import ir
from rpl.passes.capabilities import PlaceRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.records.angles import to_angles
from rpl.passes.legalise.records.quaternions import to_quaternions
from rpl.passes.legalise.stages import legalising


@legalising()
def geometry(program: ir.Program, context: Context) -> ir.Program:
    """Poses, targets, joints, vectors and rotations as the target writes them; moves, tools and frames are left to the
    passes of motion, which run before."""
    if PlaceRule.QUATERNIONS not in context.capabilities.places.rules:
        return to_angles(program, context)
    return to_quaternions(program, context)
