"""The override as a factor of the moves' speeds, for controllers whose programs cannot set it.

Where the program's course tells its value at a move, the speed is multiplied by it beforehand. A move at which the run
decides the override is refused, and so is a setting that the run works out. A move that has begun keeps its speed,
which is the difference that is told.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import rewrite, walk
from rpl.passes.fold import constant_number
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.settingsinforce import SettingsInForce
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.stopping import stopped
from rpl.passes.legalise.stages import legalising
from rpl.passes.values import real

SCALED = code(
    "override-in-speeds",
    Severity.WARNING,
    "the target's programs cannot set the override; the moves behind this have their speeds multiplied by it",
    "a move that has begun keeps its speed; what the operator sets comes on top",
)
READ = code(
    "override-taken-as-full",
    Severity.WARNING,
    "the target's programs cannot read the override, which this one never sets; it is taken as 100 percent",
)
COMPUTED = code(
    "override-hangs-on-run",
    Severity.LOSS,
    "the target's programs cannot set the override, and what it is {where} hangs on the run",
    "say the speed of each move, or set the override by hand",
    stops=True,
)
_FULL = 100.0
_OVERRIDE = ir.System("override")


@legalising(
    unless=lambda context: "override" in context.capabilities.system_variables or context.capabilities.carries_rules,
    sees=("system override",),
)
def scaled_override(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without the override among their system variables, whose moves say their own speeds."""
    if not any(_sets(node) for node in walk_for({"Assign"}, program)):
        return _as_full(program, context)
    moves = [node for node in walk_for({"Move"}, program) if isinstance(node, ir.Move)]
    if any(isinstance(node, ir.Spline) for node in walk_for({"Spline"}, program)) or not all(map(_says_speed, moves)):
        return program
    if any(
        isinstance(node, ir.DeclareInterrupt) and any(map(_sets, walk((node.action,))))
        for node in walk_for({"DeclareInterrupt"}, program)
    ):
        return program

    def settings(editor: Editor, routine: ir.Routine) -> ir.Routine:
        def refused(statement: ir.Statement) -> ir.Body:
            match statement:
                case ir.Assign(value=value) if _sets(statement) and constant_number(value, editor.scope) is None:
                    return (stopped(statement, COMPUTED, context, where="behind this"),)
            return (inside(statement, lambda inner: map_body(inner, refused)),)

        return edit_bodies(routine, lambda body: map_body(body, refused))

    program = edit_routines(program, context, settings)
    flow = SettingsInForce.of(program, {})

    def factors(editor: Editor, routine: ir.Routine) -> ir.Routine:
        worker = _Factor(flow, editor)
        return edit_bodies(routine, worker.body)

    return edit_routines(program, context, factors)


def _as_full(program: ir.Program, context: Context) -> ir.Program:
    """An override that the program only reads."""
    first = next((node for node in walk_for({"System"}, program) if _is_override(node)), None)
    if first is None:
        return program
    assert isinstance(first, ir.System)
    context.diagnostics.report(READ, first.origin)
    return rewrite(program, lambda node: ir.RealLiteral(_FULL) if _is_override(node) else node)


@dataclass(slots=True)
class _Factor:
    """The rewriting of one routine, whose settings are all constants."""

    flow: SettingsInForce
    editor: Editor

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def statement(self, statement: ir.Statement) -> ir.Body:
        context = self.editor.context
        match statement:
            case ir.Assign() if _sets(statement):
                context.diagnostics.report(SCALED, statement.origin)
                return (ir.Nothing(origin=statement.origin),)
            case ir.Move() if self.flow.never_comes_to(statement):
                return (statement,)
            case ir.Move():
                state = self.flow.at(statement)["override"]
                known = None if state is None else constant_number(state, self.editor.scope)
                if known is None or known <= 0:
                    return (stopped(statement, COMPUTED, context, where="at this move"),)
                return (statement if known == _FULL else replace(statement, speed=self.scaled(statement.speed, known)),)
        return (inside(statement, self.body),)

    def scaled(self, speed: ir.Speed | None, percent: float) -> ir.Speed | None:
        if speed is None:
            return None
        share = percent / _FULL
        return replace(
            speed,
            path=self.times(speed.path, share),
            rotation=self.times(speed.rotation, share),
            joint=self.times(speed.joint, share),
            axis=self.times(speed.axis, share),
            duration=self.times(speed.duration, 1 / share),
        )

    def times(self, value: ir.Expression | None, factor: float) -> ir.Expression | None:
        match value:
            case None:
                return None
            case ir.Quantity(value=inner):
                return replace(value, value=self.times(inner, factor) or inner)
            case ir.IntLiteral() | ir.RealLiteral():
                return real(float(f"{value.value * factor:.9g}"))
        return ir.Binary("*", value, real(factor))


def _is_override(node: object) -> bool:
    return isinstance(node, ir.System) and node == _OVERRIDE


def _sets(node: object) -> bool:
    return isinstance(node, ir.Assign) and _is_override(node.target)


def _says_speed(move: ir.Move) -> bool:
    speed = move.speed
    if speed is None or speed.profile is not None:
        return False
    return any(one is not None for one in (speed.path, speed.rotation, speed.joint, speed.axis, speed.duration))


__all__ = ["COMPUTED", "scaled_override"]
