"""Is the frame in force the world all the time? Then places of moves that are seen from a named frame may be written as
the place alone, with the frame as that of its move.
"""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.facts.forward import reactions
from rpl.passes.legalise.facts.settingsinforce import IN_FRAME
from rpl.passes.legalise.facts.usage import doing
from rpl.passes.legalise.kinds import walk_for

_ASKING = frozenset(("system actual_pose", *(f"function {name}" for name in IN_FRAME)))
_LOOKED_AT = frozenset({"Move", "Spline", "Vendor", "Opaque", "System", *_ASKING})


def may_select_frames(program: ir.Program, modal: bool) -> bool:
    """May moves have frames of their own? Not beside moves and settings that have one already.

    modal: on the target a frame stays in force behind the move that needs it. Then nothing may ask for a place in the
    frame that is set, and no reaction may move: it would come between the frame of a move and the move.
    """
    for node in walk_for(_LOOKED_AT, *program.modules):
        match node:
            case ir.System(name="base" | "displacement") | ir.Vendor() | ir.Opaque() | ir.Spline():
                return False
            case ir.Move(frame=frame, search=search) if frame is not None or search is not None:
                return False
            case ir.System(name="actual_pose") if modal:
                return False
            case ir.Builtin(function=function, arguments=given) if modal and len(given) == IN_FRAME.get(function, -1):
                return False
    return not (modal and _moving_reaction(program))


def _moving_reaction(program: ir.Program) -> bool:
    """Does an interrupt, a trigger or an error handler run a routine that moves the robot?"""
    reacting = {name.lower() for name in reactions(program)}
    return bool(reacting) and not reacting.isdisjoint(doing(program, lambda node: isinstance(node, ir.Move)))
