"""Subscripts that may be outside of their arrays, for controllers that do not look: the program stops in front of them.

Where arrays become numbered registers, or grow as they are used, an index that is too large reads or writes something
else without a word. What constants, counting loops and comparisons prove to be inside (passes.legalise.intervals) stays
as it is; everything else is looked at first, and the program ends there with a message, as the source's would.
"""

from __future__ import annotations

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.capabilities import Fault
from rpl.passes.fold import constant_number
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import children
from rpl.passes.legalise.facts.raising import raising_of
from rpl.passes.legalise.facts.values.intervals import unproven
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.bodies import Hoister, Lowered
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion
from rpl.passes.legalise.stages import legalising

_BESIDE = (ir.DeclareInterrupt, ir.ConnectInterrupt, ir.OrderInterrupt, ir.TaskControl, ir.Trigger, ir.DefineTrigger)
_WATCHING = (ir.WaitUntil, ir.DeclareInterrupt, ir.OrderInterrupt, ir.Trigger, ir.DefineTrigger, ir.Spline)


@legalising(unless=lambda context: Fault.INDEX_OUTSIDE in context.capabilities.errors.faults, sees=("Index",))
def checked_subscripts(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose controllers do not stop at such an index themselves. A program that catches the error gets
    its checks with its handlers (passes.legalise.errors)."""
    can = context.capabilities
    if not can.errors.handlers and "out_of_range" in raising_of(program).caught:
        return program
    tasks = {module.task for module in program.modules}
    alone = len(tasks) == 1 and len(program.tasks) <= 1
    alone = alone and not any(
        isinstance(node, _BESIDE)
        for node in walk_for(
            {"DeclareInterrupt", "ConnectInterrupt", "OrderInterrupt", "TaskControl", "Trigger", "DefineTrigger"},
            *program.modules,
        )
    )

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        found = unproven(routine, editor.scope, alone)
        return edit_bodies(routine, Checks(editor, found).body) if found else routine

    return edit_routines(program, context, work)


class Checks(Hoister):
    """One routine; `found` are its Index expressions (by identity) that may be outside."""

    def __init__(self, editor: Editor, found: set[int]) -> None:
        super().__init__(editor, lambda expression: None)
        self.found = found

    def lower(self, expression: ir.Expression, lvalue: bool = False) -> Lowered:
        before, done = super().lower(expression, lvalue)
        if id(expression) not in self.found or not isinstance(done, ir.Index):
            return before, done
        further, index = self.checked(done)
        return (*before, *further), index

    def checked(self, index: ir.Index, kept: bool = True) -> tuple[ir.Body, ir.Index]:
        """The check of an element's subscripts, and the element behind it. `kept`: a subscript that is calculated is
        calculated once."""
        type = self.editor.type_of(index.base)
        before: list[ir.Statement] = []
        subscripts: list[ir.Expression] = []
        bounds = type.dimensions if isinstance(type, ir.ArrayType) else ()
        base = type.base if isinstance(type, ir.ArrayType) else 1
        for at, (value, bound) in enumerate(zip(index.indices, bounds, strict=False)):
            number = constant_number(value, self.editor.scope)
            if number is None and kept and not isinstance(value, ir.Name):
                name = self.editor.temporary("subscript", self.editor.type_of(value) or ir.IntType())
                before.append(ir.Assign(name, value))
                value = name
            before.extend(self.check(index, at, value, bound, base))
            subscripts.append(value)
        subscripts.extend(index.indices[len(subscripts) :])
        return tuple(before), ir.Index(index.base, tuple(subscripts), origin=index.origin)

    def check(
        self, index: ir.Index, at: int, value: ir.Expression, bound: ir.Expression | None, base: int
    ) -> tuple[ir.Statement, ...]:
        high = bound
        if high is None:
            if isinstance(value, ir.IntLiteral) or not isinstance(index.base, ir.Name):
                return ()
            high = ir.Builtin("dimension", (index.base, ir.IntLiteral(at + 1)))
        what = index.base.id if isinstance(index.base, ir.Name) else "a list"
        stop = (ir.Message("error", ir.TextLiteral(f"Index of {what} is outside")), ir.Halt("exit"))
        number, last = constant_number(value, self.editor.scope), constant_number(high, self.editor.scope)
        if number is not None and last is not None:
            return () if base <= number <= last else stop
        low = ir.Binary("<", value, ir.IntLiteral(base))
        return (ir.If(((ir.Binary("or", low, ir.Binary(">", value, high)), stop),)),)

    def placed(self, statement: ir.Statement) -> ir.Body:
        done = super().placed(statement)
        if not isinstance(statement, _WATCHING):
            return done
        looked = [node for node in walk(tuple(children(statement))) if id(node) in self.found]
        before = [one for node in looked if isinstance(node, ir.Index) for one in self.checked(node, kept=False)[0]]
        return expansion(statement.origin, (*before, *done)) if before else done
