"""The robot's ready position (`home_joints`, V+ READY) for targets that have no name for it: the joints that the arm's
own data say. Without the arm it stays, and the writer refuses it.
"""

from __future__ import annotations

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.passes import rigid
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.stages import legalising

_HOME = "home_joints"


@legalising(sees=(f"system {_HOME}",))
def home_positions(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without such a system variable, and where the arm is known."""
    arm = context.robot
    if arm is None or _HOME in context.capabilities.system_variables:
        return program
    entries = tuple((f"j{at}", _number(float(angle))) for at, angle in enumerate(arm.home, 1))

    def known(node: object) -> object:
        if isinstance(node, ir.System) and node.name == _HOME:
            return ir.Aggregate(entries, "joints", origin=node.origin)
        return node

    return rewrite(program, known)


def _number(angle: float) -> ir.Expression:
    plain = rigid.clean(angle)
    size = ir.RealLiteral(abs(plain))
    return ir.Unary("-", size) if plain < 0 else size


__all__ = ["home_positions"]
