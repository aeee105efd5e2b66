"""Where the robot is, seen with a given tool in the frame in use, or with the tool in use in a given frame (RAPID's
`CRobT(\\Tool:=t)`, `CPos(\\WObj:=w)`): what is left out becomes the modal setting, which other languages have.
"""

from __future__ import annotations

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.stages import legalising

_SEEN = frozenset(("current_target", "current_position"))
_IN_USE = (ir.Builtin("current_tool", ()), ir.Builtin("current_frame", ()))
_MODAL = (ir.System("tool"), ir.System("base"))


@legalising(unless=lambda context: not context.capabilities.settings.modal, sees=[f"function {one}" for one in _SEEN])
def seen_half(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets with modal motion, from programs that leave one of the two out."""
    if not any(map(_is_half, walk_for({"Builtin"}, *program.modules))):
        return program

    def fitted(node: object) -> object:
        if not isinstance(node, ir.Builtin) or not _is_half(node):
            return node
        given = (*node.arguments, _MODAL[1])[:2]
        both = tuple(modal if one == used else one for one, used, modal in zip(given, _IN_USE, _MODAL, strict=True))
        return ir.Builtin(node.function, () if both == _MODAL else both, origin=node.origin)

    return rewrite(program, fitted)


def _is_half(node: object) -> bool:
    if not isinstance(node, ir.Builtin) or node.function not in _SEEN or not node.arguments:
        return False
    return len(node.arguments) == 1 or any(one in _IN_USE for one in node.arguments)
