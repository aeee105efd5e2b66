"""Where the robot's motion will end (`end_pose`), for targets that do not say so.

Right behind a move it is the target of that move. Where reading it stops the advance run, or something before lets the
robot stand, it is the actual place. Where a move or an assignment asks for it elsewhere, the program waits for the end
of the motion first, which is said. What is neither stays, and the writer refuses it.
"""

from __future__ import annotations

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.activations import Activations, called
from rpl.passes.legalise.facts.effects import statements_in
from rpl.passes.legalise.facts.usage import assigned_in, base_name, each_expression
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts

WAITED = code(
    "destination-waited-for",
    Severity.WARNING,
    "the target does not say where the motion will end; the robot stops here first, and stands there then",
)
_SETTINGS = frozenset(("tool", "base", "robot_root"))
_WHOLE = 6  # components of a whole place
_QUIET = (ir.Assign, ir.WaitForMotion, ir.Nothing, ir.Wait, ir.WaitUntil)
_MAY_WAIT = (ir.Move, ir.Assign, ir.CallRoutine)
_MOTION = (ir.Move, ir.MoveExternal, ir.Spline)


@legalising(unless=lambda context: "end_pose" in context.capabilities.system_variables)
def destinations(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without such a system variable."""
    return _Destinations(program, context).program()


class _Destinations(Rewriter):
    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        self.standing = rules_of(context.source).advance.signals_stop
        self.last: ir.Move | None = None
        self.stands = self.may_wait = False
        facts = Activations.of(program)
        own = {
            key: [one for body in bodies(item) for one in statements_in(body)] for key, item in facts.routines.items()
        }
        moving = {key for key, found in own.items() if any(isinstance(one, _MOTION) for one in found)}
        self.movers = {key for key in own if facts.reached({key}) & moving}
        self.stopping = {key for key, item in facts.routines.items() if any(map(_stops, item.body))} - self.movers
        self.beside = facts.beside.union(*facts.threads[1:])

    def routine(self, module: ir.Module, routine: ir.Routine) -> ir.Routine:
        self.last, self.stands, self.in_program = None, False, id(routine) not in self.beside
        return super().routine(module, routine)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        if expression == ir.System("end_pose"):
            if self.last is not None and not self.standing:
                return self.goal(self.last)
            if self.standing or self.stands:
                return ir.System("actual_pose", origin=expression.origin)
            if self.may_wait and self.in_program:
                self.before.append(ir.WaitForMotion())
                return ir.System("actual_pose", origin=expression.origin)
        return rewrite_parts(expression, self.expression)

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        outside, self.may_wait = self.may_wait, isinstance(statement, _MAY_WAIT)
        done, waits = super().statement(statement), bool(self.before)
        self.may_wait = outside
        if waits:
            del self.before[1:]
            self.context.diagnostics.report(WAITED, statement.origin)
        return done

    def goal(self, move: ir.Move) -> ir.Expression:
        """The place a move goes to, seen in the modal frame."""
        if isinstance(self.type_of(move.target), ir.JointsType):
            return ir.Builtin("joints_to_target", (move.target,))
        return move.target

    def body(self, body: ir.Body) -> ir.Body:
        outside, self.last, self.stands = self.last, None, False
        done: list[ir.Statement] = []
        for statement in body:
            done.extend(super().body((statement,)) if isinstance(statement, _QUIET) else self.nested(statement))
            self.stands = self.at_rest(statement)
            self.last = self.behind(statement)
        self.last, self.stands = outside, False
        return tuple(done)

    def nested(self, statement: ir.Statement) -> ir.Body:
        """A statement with bodies, or one behind which the motion may be another: only its own first look counts."""
        first = statement.branches[0][0] if isinstance(statement, ir.If) else None
        kept, self.last = (self.last, self.stands), None
        done = Rewriter.body(self, (statement,))
        self.last, self.stands = kept
        if first is None or not done or not isinstance(done[-1], ir.If):
            return done
        branches = done[-1].branches
        asked = (self.expression(first), branches[0][1])
        return (*done[:-1], ir.If((asked, *branches[1:]), done[-1].otherwise, origin=done[-1].origin))

    def at_rest(self, statement: ir.Statement) -> bool:
        """Does the robot stand behind the statement, whatever was before?"""
        if _stops(statement):
            return True
        if not isinstance(statement, (*_QUIET, ir.CallRoutine)):
            return False
        found = called(statement, self.scope)
        if isinstance(statement, ir.CallRoutine) and (statement.dynamic is not None or not found):
            return False
        if any(id(one) in self.movers for one in found):
            return False
        return self.stands or any(id(one) in self.stopping for one in found)

    def behind(self, statement: ir.Statement) -> ir.Move | None:
        """The move that the robot drives behind a statement, as far as it is known."""
        match statement:
            case ir.Move():
                own = (statement.relative, statement.swept, statement.tool, statement.frame, statement.search)
                plain = all(one is None for one in own) and not _moved(statement) and statement.group == 1
                return statement if plain and _repeatable(statement.target) else None
            case ir.Assign(target=ir.System(name=name)):
                return None if name in _SETTINGS else self.last
            case ir.Assign(target=target) if self.last is not None:
                changed, used = base_name(target), _names(self.last)
                return None if changed in used or assigned_in((statement,)) & used else self.last
            case ir.WaitForMotion() | ir.Nothing() | ir.Wait() | ir.WaitUntil(timed_out=None):
                return self.last
        return None


def _stops(statement: ir.Statement) -> bool:
    return isinstance(statement, ir.WaitForMotion) or (isinstance(statement, ir.Wait) and statement.in_position)


def _moved(move: ir.Move) -> bool:
    """Has the move settings of its own that its place hangs on?"""
    return any(not isinstance(one, ir.System) or one.name in _SETTINGS for one, _ in move.settings)


def _names(move: ir.Move) -> set[str]:
    found: set[str] = set()

    def look(expression: ir.Expression) -> None:
        if isinstance(expression, ir.Name):
            found.add(expression.id.lower())

    each_expression(move, look)
    return found


def _repeatable(target: ir.Expression) -> bool:
    """Does the expression give the same place again, whatever the robot has done?"""
    again = True

    def look(expression: ir.Expression) -> ir.Expression:
        nonlocal again
        again = again and not isinstance(expression, ir.Call | ir.System | ir.Signal | ir.VendorValue)
        if isinstance(expression, ir.Aggregate) and (expression.type_name or "").startswith(("target", "joints")):
            again = again and len(expression.entries) >= _WHOLE  # what is left out stays as it is
        if isinstance(expression, ir.Builtin):
            again = again and not expression.function.startswith(("current_", "target_to", "random"))
        return rewrite_parts(expression, look)

    look(target)
    return again


__all__ = ["destinations"]
