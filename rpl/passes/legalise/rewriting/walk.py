"""Rewriting a whole program, its declarations and types too, with symbol tables at hand.

A pass subclasses `Rewriter` and overrides `expression`, `statement`, `declaration` or `type`; it is given old nodes and
asks for the types of old expressions. What a rewritten expression needs first goes to `self.before`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.fold import Unchanged
from rpl.passes.legalise.context import Context, ProgramScope
from rpl.passes.legalise.facts.effects import Effects
from rpl.passes.legalise.facts.usage import base_name, usage_of
from rpl.passes.legalise.facts.values.beginning import settled_at_start
from rpl.passes.legalise.kinds import holds_none
from rpl.passes.legalise.rewriting.bodies import Bodies, Lowered
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies
from rpl.passes.rewrite import changed, rewrite_parts, same
from rpl.passes.scope import Scope
from rpl.passes.typewords import word_type
from rpl.passes.typing import type_of

EARLY = code(
    "condition-read-once",
    Severity.LOSS,
    "this condition needs a value that the target computes in a statement of its own; it is computed once, before",
)

POLLED = code(
    "polled-wait",
    Severity.WARNING,
    "the target cannot wait for this condition; it is computed every {seconds:g} s until it holds",
)
# How often a condition is computed that the target cannot wait for, s. Controllers scan every 8 to 16 ms.
POLL_S = 0.012


class Rewriter(Bodies):
    """One pass over one program."""

    def __init__(self, program: ir.Program, context: Context) -> None:
        self.source, self.context = program, context
        self.scopes, self.effects = ProgramScope(program), Effects(program)
        self.before: list[ir.Statement] = []
        self.made_loops = False
        if program.modules:
            self.enter(self.scopes.module(program.modules[0]))

    def enter(self, scope: Scope) -> None:
        """Go on with a module or a routine."""
        self.editor = Editor(self.context, self.effects, scope)

    @property
    def scope(self) -> Scope:
        """Where the rewriting is just now."""
        return self.editor.scope

    # ---- what a pass overrides

    def type(self, type: ir.Type) -> ir.Type:
        """A type in its new form."""
        if isinstance(type, ir.ArrayType):
            return changed(rewrite_parts(type, self.expression), element=self.type(type.element))
        return type

    def expression(self, expression: ir.Expression) -> ir.Expression:
        """An expression in its new form."""
        if expression.__class__ is ir.Binary and expression.op in ("cand", "cor"):
            outside, self.before = self.before, []
            before, done = self.deciding(expression)
            self.before = [*outside, *before]
            return done
        return rewrite_parts(expression, self.expression)

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        """A statement without bodies in its new form, or several."""
        return [rewrite_parts(statement, self.expression, self.actions)]

    def declaration(self, declaration: ir.Declaration) -> list[ir.Declaration]:
        """A declaration in its new form, or several."""
        match declaration:
            case ir.Variable(type=type, initial=initial):
                value = None if initial is None else self.initial(initial, declaration)
                return [changed(declaration, type=self.type(type), initial=value)]
            case ir.RecordDeclaration(fields=fields):
                new = tuple((name, self.type(type)) for name, type in fields)
                return [declaration if new == fields else replace(declaration, fields=new)]
            case ir.AliasDeclaration(type=type):
                return [changed(declaration, type=self.type(type))]
        return [rewrite_parts(declaration, self.expression, self.actions)]

    def initial(self, value: ir.Expression, declaration: ir.Variable) -> ir.Expression | None:
        """An initial value in its new form."""
        return self.expression(value)

    # ---- helpers

    def type_of(self, expression: ir.Expression) -> ir.Type | None:
        """The type of an expression in its old form."""
        match expression:  # the common cases without a walk through the expression
            case ir.Aggregate(type_name=word) if word:
                return word_type(word, self.scope)
            case ir.Name(id=name):
                symbol = self.scope.value(name)
                return self.scope.resolve(symbol.type) if symbol is not None else None
            case ir.IntLiteral():
                return ir.IntType()
            case ir.RealLiteral():
                return ir.RealType()
        return type_of(expression, self.scope)

    def temporary(self, type: ir.Type, stem: str = "tmp") -> ir.Name:
        """A new variable of the routine (of the module, outside of routines)."""
        return self.editor.temporary(stem, type)

    # ---- program, module, routine

    def program(self) -> ir.Program:
        """The whole program in its new form; what nothing changes stays the same object, here and below."""
        return changed(self.source, modules=tuple(self.module(module) for module in self.source.modules))

    def module(self, module: ir.Module) -> ir.Module:
        self.enter(self.scopes.module(module))
        declarations = [new for old in module.declarations for new in self.each_declaration(old)]
        declarations.extend(replace(one, scope="module") for one in self.editor.added)
        routines = tuple(self.routine(module, routine) for routine in module.routines)
        return changed(module, declarations=tuple(declarations), routines=routines)

    def each_declaration(self, declaration: ir.Declaration) -> Sequence[ir.Declaration]:
        """A declaration in its new form; one that holds nothing that the pass acts on is not entered."""
        if holds_none(declaration, self.acts_on):
            return (declaration,)
        return self.declaration(declaration)

    def routine(self, module: ir.Module, routine: ir.Routine) -> ir.Routine:
        if holds_none(routine, self.acts_on):
            return routine
        self.enter(self.scopes.routine(module, routine))
        done = changed(
            routine,
            declarations=tuple([new for old in routine.declarations for new in self.each_declaration(old)]),
            parameters=tuple([changed(one, type=self.type(one.type)) for one in routine.parameters]),
            returns=None if routine.returns is None else self.type(routine.returns),
            handlers=tuple([changed(one, codes=tuple(map(self.expression, one.codes))) for one in routine.handlers]),
        )
        return self.editor.closed(edit_bodies(done, self.body))

    # ---- bodies

    def body(self, body: ir.Body) -> ir.Body:
        outside, self.before = self.before, []
        done = super().body(body)
        self.before = outside
        return done

    def actions(self, body: ir.Body) -> ir.Body:
        """Statements that cannot become several: actions of triggers and interrupts, the inside of a spline."""
        done = [rewrite_parts(statement, self.expression, self.actions) for statement in body]
        return body if same(body, done) else tuple(done)

    def taken(self) -> ir.Body:
        """What must run first, taken off the list."""
        if not self.before:
            return ()
        found, self.before = self.before, []
        return tuple(found)

    def lower(self, expression: ir.Expression, lvalue: bool = False) -> Lowered:
        done = self.expression(expression)
        return self.taken(), done

    def several(self, parts: Sequence[ir.Expression], in_place: Sequence[bool]) -> tuple[ir.Body, list[ir.Expression]]:
        done = list(map(self.expression, parts))
        return self.taken(), done

    def single(self, statement: ir.Statement) -> ir.Body:
        done = self.statement(statement)
        first = self.taken()
        if isinstance(statement, ir.WaitUntil):
            return self.waiting(statement, (*first, *done[:-1]), done[-1])
        if first and isinstance(statement, ir.DeclareInterrupt | ir.OrderInterrupt | ir.Trigger):
            self.context.diagnostics.report(EARLY, statement.origin)
        return _in_order((*first, *done), statement)

    def waiting(self, statement: ir.WaitUntil, first: ir.Body, wait: ir.Statement) -> ir.Body:
        """A wait; one whose condition needs statements first is a loop that computes it again and again."""
        if not first or not isinstance(wait, ir.WaitUntil):
            return _in_order((*first, wait), statement)
        if wait.timeout is not None and wait.timed_out is None:
            self.context.diagnostics.report(EARLY, statement.origin)
            return _in_order((*first, wait), statement)
        shortest = self.context.capabilities.io.shortest_wait_s or POLL_S
        period = ir.RealLiteral(round(round(POLL_S / shortest) * shortest, 6))
        self.context.diagnostics.report(POLLED, statement.origin, seconds=period.value)
        pause = ir.Wait(ir.Quantity(period, "s"))
        leave = ir.If(((wait.condition, (ir.ExitLoop(),)),))
        before: list[ir.Statement] = [ir.WaitForMotion()] if wait.in_position else []
        late: list[ir.Statement] = []
        if wait.timeout is not None and wait.timed_out is not None:
            limit, waited = self.temporary(ir.RealType(), "limit"), self.temporary(ir.RealType(), "waited")
            before.append(ir.Assign(limit, _seconds(wait.timeout)))
            before.append(ir.Assign(waited, ir.RealLiteral(0.0)))
            before.append(ir.Assign(wait.timed_out, ir.BoolLiteral(False)))
            over = (ir.Assign(wait.timed_out, ir.BoolLiteral(True)), ir.ExitLoop())
            late.append(ir.If(((ir.Binary(">=", waited, limit), over),)))
            late.append(ir.Assign(waited, ir.Binary("+", waited, period)))
        self.made_loops = True
        return _in_order((*before, ir.Loop((*_bare(first), leave, *late, pause))), statement)

    def loop(self, statement: ir.While) -> ir.Body:
        done = super().loop(statement)
        self.made_loops = self.made_loops or isinstance(done[0], ir.Loop)
        return done


def _seconds(time: ir.Expression) -> ir.Expression:
    """A time as a plain number of seconds."""
    if isinstance(time, ir.Quantity):
        factor = ir.UNITS[time.unit]
        return time.value if factor == 1.0 else ir.Binary("*", time.value, ir.RealLiteral(factor))
    return time


def _bare(statements: Sequence[ir.Statement]) -> list[ir.Statement]:
    return [replace(one, origin=replace(one.origin, comments=())) for one in statements]


def _in_order(statements: ir.Body, old: ir.Statement) -> ir.Body:
    """An expansion of `old`: all have its place, the first has its comments."""
    if len(statements) == 1:
        return statements
    later = replace(old.origin, comments=())
    return tuple([replace(one, origin=old.origin if at == 0 else later) for at, one in enumerate(statements)])


def unchanged_in(program: ir.Program, places: bool = False) -> Unchanged:
    """Which variables nothing assigns but their declaration and their data list, and what is settled at the start: of
    tools and frames, and `places`: of where moves go."""
    bare = tuple(
        replace(module, declarations=tuple(one for one in module.declarations if not isinstance(one, ir.Initialise)))
        for module in program.modules
    )
    known = Unchanged(usage_of(replace(program, modules=bare)).assigned)
    for module in program.modules:
        for one in module.declarations:
            if isinstance(one, ir.Initialise):
                name = base_name(one.assign.target)
                if name is not None:
                    known.initialised.setdefault(name, []).append((one.assign.target, one.assign.value, module))
    known.settled = settled_at_start(program, known, places)
    return known
