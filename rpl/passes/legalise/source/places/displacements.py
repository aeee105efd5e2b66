"""A modal displacement between the frame and the targets (RAPID PDispSet), for targets that know only frames.

Where it is known to be off a move stays as it is. Elsewhere the target itself is displaced: by the constant where every
way has set the same one, else by a variable of the task. What reads places gives them as they are seen from the
displaced frame: a place that is read, the joints of a place and back, and where a search has found.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.settingsinforce import SettingsInForce
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts

_NAME = "displacement"
_OFF = ir.System("null_frame")
_TURN = ir.Aggregate(tuple((part, ir.IntLiteral(0)) for part in ir.POSE), type_name="pose")
_READ = ("current_target", "joints_to_target")
_GIVEN = ("target_to_joints", "target_to_joints_near", "is_reachable")


@legalising(unless=lambda context: _NAME in context.capabilities.system_variables, sees=(f"system {_NAME}",))
def displacements(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without the system variable, where the program sets it."""
    if not any(map(_sets, walk_for({"Assign"}, *program.modules))):
        return program
    return _Displacements(program, context).program()


def _sets(node: object) -> bool:
    return isinstance(node, ir.Assign) and isinstance(node.target, ir.System) and node.target.name == _NAME


class _Displacements(Rewriter):
    """`at` is the variable with what is in force now; `first` is the module that gets it."""

    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        self.flow = SettingsInForce.begun_by(program, context.source)
        self.at = ir.Name(context.fresh("displacement"))
        self.first = next(one for one in program.modules if any(map(_sets, walk(one))))

    def module(self, module: ir.Module) -> ir.Module:
        done = super().module(module)
        if module is not self.first:
            return done
        variable = ir.Variable(self.at.id, ir.PoseType(), _TURN, scope="task")
        return replace(done, declarations=(*done.declarations, variable))

    def expression(self, expression: ir.Expression) -> ir.Expression:
        done = rewrite_parts(expression, self.expression)
        match done:
            case ir.System(name="displacement"):
                return replace(self.at, origin=expression.origin)
            case ir.Builtin(function=function) if function in _READ:
                return self.displaced(done, self.back())
            case ir.Builtin(function="current_position"):
                return ir.Builtin("transform", (self.back(), done), origin=expression.origin)
            case ir.Builtin(function=function, arguments=(place, *rest)) if function in _GIVEN:
                return replace(done, arguments=(self.displaced(place, self.at), *rest))
        return done

    def undisplaced(self, expression: ir.Expression) -> ir.Expression:
        """An expression at a place where nothing is displaced."""
        done = rewrite_parts(expression, self.undisplaced)
        return replace(self.at, origin=expression.origin) if done == ir.System(_NAME) else done

    def back(self) -> ir.Expression:
        return ir.Builtin("inverse", (self.at,))

    def displaced(self, place: ir.Expression, by: ir.Expression) -> ir.Expression:
        return ir.Builtin("displaced", (place, by), origin=place.origin)

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        if not isinstance(statement, ir.Move):
            off = isinstance(statement, ir.Assign) and self.flow.at(statement).get(_NAME) == _OFF
            return [rewrite_parts(statement, self.undisplaced, self.actions)] if off else super().statement(statement)
        done = rewrite_parts(statement, self.expression, self.actions)
        found = None if done.search is None else done.search.found
        known = self.flow.at(statement).get(_NAME)
        if known == _OFF:
            return [done]
        if not self.to_joints(statement.target) and statement.relative is None:
            by = self.at if known is None or isinstance(known, ir.Aggregate) else known
            via = None if done.via is None else self.displaced(done.via, by)
            done = replace(done, target=self.displaced(done.target, by), via=via)
        if found is None:
            return [done]
        return [done, ir.Assign(found, self.displaced(found, self.back()), origin=statement.origin)]

    def to_joints(self, target: ir.Expression) -> bool:
        return isinstance(self.type_of(target), ir.JointsType | ir.AxesType)


__all__ = ["displacements"]
