"""Interrupts whose routine does nothing (the one for stop messages that KRL's inline forms declare in every program):
they are left out, and so is what switches them on and off. A routine of the program leaves a remark; what the source's
controller calls of its own is its own affair.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.rewriting.editing import edit_bodies, map_body
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies
from rpl.passes.scope import ProgramScope, Scope
from rpl.source import Comment, Origin

LEFT_OUT = code(
    "empty-reaction-left-out",
    Severity.WARNING,
    "{text} calls a routine that does nothing; it is left out",
    "write down by hand what should happen then on the target's controller",
)

CONTROLLERS_OWN = code(
    "controller-reaction-left-out",
    Severity.INFO,
    "{text} calls what the source's controller does of its own then; it is left out",
)


@legalising(sees=("DeclareInterrupt",))
def without_empty_reactions(program: ir.Program, context: Context) -> ir.Program:
    """The program without such interrupts, unless another one has the same number."""
    scopes = ProgramScope(program)
    facts = _Facts(context)
    for module, routine in scopes.routines():
        facts.note(routine, scopes.routine(module, routine))
    if not facts.empty - facts.others:
        return program
    modules = []
    for module in program.modules:
        done = (edit_bodies(routine, _Left(facts, scopes.routine(module, routine)).body) for routine in module.routines)
        modules.append(replace(module, routines=tuple(done)))
    return replace(program, modules=tuple(modules))


def _does_nothing(statement: ir.DeclareInterrupt, scope: Scope) -> bool:
    """Does it call a routine without statements, and nothing happens besides?"""
    action = statement.action
    if not isinstance(action, ir.CallRoutine) or action.arguments or action.dynamic is not None or statement.stops:
        return False
    called = scope.routine(action.name)
    return called is not None and all(isinstance(one, ir.Nothing) for one in called.body)


@dataclass(slots=True)
class _Facts:
    """Numbers of interrupts whose routine does nothing, and of the others (None: a computed one)."""

    context: Context
    empty: set[int] = field(default_factory=set)
    others: set[int] = field(default_factory=set)
    any_other: bool = False

    def note(self, routine: ir.Routine, scope: Scope) -> None:
        for node in walk(routine):
            match node:
                case ir.DeclareInterrupt():
                    number = _number(node)
                    nothing = _does_nothing(node, scope) and number is not None
                    self.any_other = self.any_other or not nothing
                    if number is not None:
                        (self.empty if nothing else self.others).add(number)
                case ir.ConnectInterrupt() | ir.OrderInterrupt():
                    self.any_other = True


def _number(statement: ir.DeclareInterrupt) -> int | None:
    number = statement.priority if statement.identity is None else statement.identity
    return number.value if isinstance(number, ir.IntLiteral) else None


@dataclass(slots=True)
class _Left:
    facts: _Facts
    scope: Scope

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def statement(self, statement: ir.Statement) -> ir.Body:
        gone = self.facts.empty - self.facts.others
        match statement:
            case ir.DeclareInterrupt() if _number(statement) in gone:
                text = _words(statement.origin)
                if self.is_controllers(statement):
                    self.facts.context.diagnostics.report(CONTROLLERS_OWN, statement.origin, text=text)
                    return (ir.Nothing(origin=statement.origin),) if statement.origin.comments else ()
                self.facts.context.diagnostics.report(LEFT_OUT, statement.origin, text=text)
                remark = Comment(f" left out: {text}")
                origin = replace(statement.origin, comments=(*statement.origin.comments, remark))
                return (ir.Nothing(origin=origin),)
            case ir.ControlInterrupt(handle=ir.IntLiteral(value=number), op=op) if number in gone and op != "mask":
                return (ir.Nothing(origin=statement.origin),) if statement.origin.comments else ()
            case ir.ControlInterrupt(handle=None) if not self.facts.any_other:
                return (ir.Nothing(origin=statement.origin),) if statement.origin.comments else ()
        if blocks(statement):
            return (rewrite_bodies(statement, self.body),)
        return (statement,)

    def is_controllers(self, statement: ir.DeclareInterrupt) -> bool:
        """Is the routine one that the source's controller brings along?"""
        called = self.scope.routine(statement.action.name) if isinstance(statement.action, ir.CallRoutine) else None
        return called is not None and self.scope.program.home(called) is None


def _words(origin: Origin) -> str:
    """The statement as it stands in the source."""
    return origin.text.strip() if origin.text else "an interrupt"
