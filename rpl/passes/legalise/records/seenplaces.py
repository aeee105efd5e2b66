"""Functions that see the robot with a given tool and in a given frame, for targets whose functions know only the tool
in use and the robot's base: the tool and the frame are composed around them.

Runs behind settings_at_moves, which composes the modal frame. Stationary tools are left to the writer.
"""

from __future__ import annotations

from rpl import ir
from rpl.passes import rigid
from rpl.passes.capabilities import Composite, PlaceRule
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import usage_of
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.settings.explicit import Modal
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.signatures import PLACES

_INTO_JOINTS = frozenset(("target_to_joints", "target_to_joints_near", "is_reachable"))
_SEEN = frozenset(("current_target", "current_position", "joints_to_target"))
_ACTS_ON = frozenset(f"function {one}" for one in PLACES)


@legalising(unless=lambda context: PlaceRule.IN_BASE not in context.capabilities.places.rules, sees=_ACTS_ON)
def seen_places(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that say so."""
    return _Seen(program, context).program()


@legalising(
    unless=lambda context: (
        PlaceRule.IN_BASE in context.capabilities.places.rules
        or Composite.RECORDS in context.capabilities.data.composites
        or "ToolType" in context.capabilities.types
    ),
    sees=_ACTS_ON,
)
def posed_places(program: ir.Program, context: Context) -> ir.Program:
    """Tool and work object data in such functions as poses, for targets without records."""
    return _Posed(program, context).program()


class _Seen(Rewriter):
    acts_on = _ACTS_ON

    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        self.assigned = set(usage_of(program).assigned)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        done = rewrite_parts(expression, self.expression)
        if not isinstance(expression, ir.Builtin) or expression.function not in PLACES:
            return done
        assert isinstance(done, ir.Builtin)  # only its arguments were rewritten
        tool_at, frame_at = PLACES[expression.function]
        if len(expression.arguments) <= tool_at:
            return done
        tool = self.tool(expression.arguments[tool_at])
        frame = self.frame(expression.arguments[frame_at]) if len(expression.arguments) > frame_at else None
        own = ir.System("tool")
        if expression.function in _SEEN:
            name = "current_target" if expression.function == "current_position" else expression.function
            place: ir.Expression = ir.Builtin(name, done.arguments[:tool_at], origin=expression.origin)
            if tool is not None:
                place = _composed(_composed(place, ir.Builtin("inverse", (own,))), tool)
            if frame is not None:
                place = _composed(ir.Builtin("inverse", (frame,)), place)
            return ir.Field(place, "trans") if expression.function == "current_position" else place
        place = done.arguments[0]
        if tool is not None:
            place = _composed(_composed(place, ir.Builtin("inverse", (tool,))), own)
        if frame is not None:
            place = _composed(frame, place)
        return ir.Builtin(expression.function, (place, *done.arguments[1:tool_at]), origin=expression.origin)

    def tool(self, tool: ir.Expression) -> ir.Expression | None:
        """The pose of a tool; None: the one in use."""
        if tool == ir.System("tool") or (isinstance(tool, ir.Builtin) and tool.function == "current_tool"):
            return None
        if isinstance(self.type_of(tool), ir.ToolType):
            return self.data().component(tool, "frame")
        return rewrite_parts(tool, self.expression)

    def frame(self, frame: ir.Expression) -> ir.Expression | None:
        """The pose of a frame; None: the robot's base."""
        if isinstance(self.type_of(frame), ir.WorkObjectType):
            new = self.data().frame_of_work_object(frame)
        else:
            new = rewrite_parts(frame, self.expression)
        return None if new == ir.System("null_frame") or constant(new, self.scope) == rigid.IDENTITY else new

    def data(self) -> Modal:
        """What is known of tool and work object data here."""
        return Modal(self.context, self.scope, self.assigned, set())


class _Posed(_Seen):
    """The functions stay; the data that they name become poses."""

    def expression(self, expression: ir.Expression) -> ir.Expression:
        done = rewrite_parts(expression, self.expression)
        if not isinstance(expression, ir.Builtin) or expression.function not in PLACES:
            return done
        assert isinstance(done, ir.Builtin)  # only its arguments were rewritten
        arguments = list(done.arguments)
        for at, old in enumerate(expression.arguments):
            if at == PLACES[expression.function][0] and isinstance(self.type_of(old), ir.ToolType):
                arguments[at] = self.data().component(old, "frame")
            if at == PLACES[expression.function][1] and isinstance(self.type_of(old), ir.WorkObjectType):
                arguments[at] = self.frame(old) or ir.System("null_frame")
        return ir.Builtin(done.function, tuple(arguments), origin=done.origin)


def _composed(one: ir.Expression, other: ir.Expression) -> ir.Expression:
    return ir.Binary(":", one, other)


__all__ = ["posed_places", "seen_places"]
