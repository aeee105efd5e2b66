"""The tool and the frame of one move beside those that are set, for targets where both are modal.

There the tool of one move would stay for the next ones, and for what asks where the robot is. So in a program that sets
the tool (or frame) and also has moves that name their own, every move and every question names it: as the constant that
is known to be set there (`modalflow`), or else by a variable that is set along with it. Where the source's questions
never mean the tool of the last move, they are named also without a tool that is set.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.settingsinforce import SettingsInForce
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_all, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.shadows import NO_SHIFT, Shadow, with_shadows
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.signatures import PLACES

# Solvers that a move may have around its goal (`configurations`): the move says with which tool.
_GOALS = ("target_to_joints", "target_to_joints_near")


@legalising(unless=lambda context: not context.capabilities.settings.modal)
def own_places(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets with modal motion; programs that set a tool or frame and have moves with one of their own."""
    nodes = [*walk_for({"Move", "Assign", "System", "Builtin"}, *program.modules)]
    named = {
        name
        for node in nodes
        if isinstance(node, ir.Move)
        for name, own in (("tool", node.tool), ("base", node.frame))
        if own is not None
    }
    made = {node.target.name for node in nodes if isinstance(node, ir.Assign) and isinstance(node.target, ir.System)}
    asked = any(_asks(node) for node in nodes)
    # Without a tool that is set, a question may mean the tool and frame of the last move, as these targets do.
    questions = asked and ("tool" in made or not rules_of(context.source).last_tool)
    if not named & made and not (named and questions):
        return program
    worker = _Places(program, context, frozenset(named & made), frozenset(made), questions)
    return worker.done(program)


def _asks(node: object) -> bool:
    """Does it ask for a place without saying with which tool and in which frame?"""
    match node:
        case ir.System(name="actual_pose"):
            return True
        case ir.Builtin(function=function, arguments=given) if function in PLACES:
            return len(given) <= PLACES[function][1]
    return False


class _Places:
    """`moving`: which of tool and base moves are given; `set`: which the program sets; `questions`: name them there."""

    def __init__(
        self, program: ir.Program, context: Context, moving: frozenset[str], set: frozenset[str], questions: bool
    ) -> None:
        self.context, self.moving, self.set, self.questions = context, moving, set, questions
        self.flow = SettingsInForce.begun_by(program, context.source)
        self.kept: dict[str, Shadow] = {}

    def done(self, program: ir.Program) -> ir.Program:
        program = edit_all(program, lambda body: map_body(body, self.statement))
        return with_shadows(program, self.context, self.kept, read=False)

    def statement(self, statement: ir.Statement) -> ir.Body:
        state = self.flow.at(statement)
        if self.questions:
            goal = statement.target if isinstance(statement, ir.Move) else None
            done = rewrite_parts(
                statement,
                lambda one: self.goal(one, state) if one is goal else self.expression(one, state),
                lambda body: map_body(body, self.statement),
            )
        else:
            done = inside(statement, lambda body: map_body(body, self.statement))
        if not isinstance(done, ir.Move):
            return (done,)
        tool = self.value("tool", state) if done.tool is None and "tool" in self.moving else done.tool
        frame = self.value("base", state) if done.frame is None and "base" in self.moving else done.frame
        return (done if tool is done.tool and frame is done.frame else replace(done, tool=tool, frame=frame),)

    def value(self, name: str, state: dict[str, ir.Expression | None]) -> ir.Expression:
        """The tool or frame that is set there."""
        if name not in self.set:
            return ir.System("null_frame")
        known = state.get(name)
        if known is not None:
            return known
        if name not in self.kept:
            self.kept[name] = Shadow(ir.Name(self.context.fresh(f"{name}_set")), NO_SHIFT)
        return self.kept[name].name

    def goal(self, goal: ir.Expression, state: dict[str, ir.Expression | None]) -> ir.Expression:
        """The goal of a move: joints that are asked for there are those with the move's own tool and frame."""
        if isinstance(goal, ir.Builtin) and goal.function in _GOALS:
            return rewrite_parts(goal, lambda one: self.expression(one, state))
        return self.expression(goal, state)

    def expression(self, expression: ir.Expression, state: dict[str, ir.Expression | None]) -> ir.Expression:
        done = rewrite_parts(expression, lambda one: self.expression(one, state))
        if not _asks(done):
            return done
        if isinstance(done, ir.System):
            here = ir.Builtin("current_target", (self.value("tool", state), self.value("base", state)))
            return ir.Builtin("pose_of", (here,), origin=done.origin)
        assert isinstance(done, ir.Builtin)
        given = done.arguments
        at, _ = PLACES[done.function]
        missing = ("tool", "base")[max(0, len(given) - at) :]
        return replace(done, arguments=(*given, *(self.value(name, state) for name in missing)))


__all__ = ["own_places"]
