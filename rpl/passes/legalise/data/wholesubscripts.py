"""Subscripts that may have a fraction, for controllers that round or cut them: the program stops in front of them.

A language with one number type refuses such an index where it is used (RAPID: ERR_NOTINTVAL), so its programs never get
beyond it. Controllers that take the element beside it go on with another one. Where the flow of values shows that only
whole numbers come to a subscript (passes.legalise.wholes), nothing is written.
"""

from __future__ import annotations

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.capabilities import Fault
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.values.wholes import Wholes
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.routines.subscriptchecks import Checks
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typing import type_of


@legalising(unless=lambda context: Fault.INDEX_FRACTION in context.capabilities.errors.faults, sees=("Index",))
def whole_subscripts(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose controllers do not stop at such an index themselves."""
    scopes = ProgramScope(program)
    asked = [
        (node, subscript, scopes.routine(module, routine))
        for module in program.modules
        for routine in module.routines
        for body in bodies(routine)
        for node in walk(body)
        if isinstance(node, ir.Index)
        for subscript in node.indices
        if not isinstance(subscript, ir.IntLiteral)
    ]
    real = [(node, subscript, scope) for node, subscript, scope in asked if _is_real(subscript, scope)]
    if not real:
        return program
    wholes = Wholes.of(program, scopes)
    found = {id(node) for node, subscript, scope in real if not wholes.whole(subscript, scope)}
    if not found:
        return program

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, _Checks(editor, found).body)

    return edit_routines(program, context, work)


def _is_real(value: ir.Expression, scope: Scope) -> bool:
    return isinstance(type_of(value, scope), ir.RealType)


class _Checks(Checks):
    """The same for fractions: one routine; `found` are its Index expressions that may have one."""

    def check(
        self, index: ir.Index, at: int, value: ir.Expression, bound: ir.Expression | None, base: int
    ) -> tuple[ir.Statement, ...]:
        if not _is_real(value, self.editor.scope):
            return ()
        what = index.base.id if isinstance(index.base, ir.Name) else "a list"
        stop = (ir.Message("error", ir.TextLiteral(f"Fraction in index of {what}")), ir.Halt("exit"))
        cut = ir.Builtin("trunc", (value,))
        return (ir.If(((ir.Binary("<>", value, cut), stop),)),)
