"""What a move without a tool, frame or turning speed of its own has, where others say theirs: what is usual."""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.kinds import walk_for

TURNING = frozenset(("swivel_speed", "twist_speed"))


def usual_places(program: ir.Program) -> frozenset[str]:
    """Tool and base, where some moves name theirs, others none, and no statement sets it: that is then the flange and
    the world (INFORM moves behind SFTOF)."""
    nodes = [*walk_for({"Move", "Assign"}, *program.modules)]
    moves = [node for node in nodes if isinstance(node, ir.Move)]
    given = {"tool": [one.tool for one in moves], "base": [one.frame for one in moves]}
    mixed = {name for name, values in given.items() if None in values and any(value is not None for value in values)}
    return frozenset(
        mixed
        - {node.target.name for node in nodes if isinstance(node, ir.Assign) and isinstance(node.target, ir.System)}
    )


_TURNING_KINDS = frozenset(("Speed", "Assign", "Aggregate", "function offset", "function tool_offset"))
# Below it, deg/s, somebody wants slow turns.
_CHOSEN_TURN_DEG_S = 100.0


def usual_turns(program: ir.Program, context: Context) -> frozenset[str]:
    """Turning speeds, where some moves say theirs by itself and no statement sets it: the others have the usual one."""
    known = TURNING & context.capabilities.system_variables & rules_of(context.target).system_defaults.keys()
    said = False
    for node in walk_for({"Move", "Assign"}, *program.modules):
        match node:
            case ir.Assign(target=ir.System(name=name)) if name in TURNING:
                return frozenset()
            case ir.Move(speed=ir.Speed(rotation=rotation, path=None, profile=None)) if rotation is not None:
                said = True
    return frozenset(known) if said else frozenset()


def turns_as_usual(program: ir.Program) -> bool:
    """Do all speeds let the tool turn as fast as predefined ones do, and does no move turn in place? Then its path says
    how fast it is, and the turning speed is no setting that anybody has made."""
    for node in walk_for(_TURNING_KINDS, *program.modules):
        match node:
            case ir.Speed(rotation=rotation) if rotation is not None:
                return False
            case ir.Assign(target=ir.Field(name="rotation")):
                return False
            case ir.Aggregate(type_name="speed", entries=((_, _), (_, turning), *_)) if not _is_fast(turning):
                return False
            case ir.Builtin(function="offset" | "tool_offset", arguments=(_, x, y, z, *_)) if all(
                isinstance(one, ir.RealLiteral | ir.IntLiteral) and one.value == 0 for one in (x, y, z)
            ):
                return False
    return True


def _is_fast(turning: ir.Expression) -> bool:
    return isinstance(turning, ir.RealLiteral | ir.IntLiteral) and turning.value >= _CHOSEN_TURN_DEG_S
