"""A Switch that the target cannot say (its selector's type, or cases that are computed) as a chain of Ifs."""

from __future__ import annotations

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.capabilities import Composite, Limit
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import is_constant, root
from rpl.passes.legalise.rewriting.bodies import Hoister
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion
from rpl.passes.legalise.stages import legalising


@legalising(sees=("Switch",))
def unroll_switches(program: ir.Program, context: Context) -> ir.Program:
    """The program with only such Switch statements as the target has."""

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, _Switches(editor, lambda _: None).body)

    return edit_routines(program, context, work)


class _Switches(Hoister):
    def switch(self, statement: ir.Switch) -> ir.Body:
        chosen = self._chosen(statement)
        if chosen is not None:
            return expansion(statement.origin, self.body(chosen) or (ir.Nothing(),))
        done = super().switch(statement)
        last = done[-1]
        if not isinstance(last, ir.Switch) or self._sayable(last):
            return done
        return (*done[:-1], *self._chain(last))

    def _chosen(self, statement: ir.Switch) -> ir.Body | None:
        """What is done where selector and cases are known, for targets whose constants stand in no register that could
        be selected by; None where the run chooses."""
        scope = self.editor.scope
        selector = constant(statement.selector, scope) if self.editor.capabilities.storage.banks else None
        if selector is None or any(isinstance(node, ir.Label) for node in walk(statement)):
            return None
        for case in statement.cases:
            values = [constant(value, scope) for value in case.values]
            if None in values:
                return None
            if selector in values:
                return case.body
        return statement.default or ()

    def _sayable(self, statement: ir.Switch) -> bool:
        capabilities = self.editor.capabilities
        if "Switch" not in capabilities.statements:
            return False
        values = [value for case in statement.cases for value in case.values]
        if not all(self.editor.effects.quiet(value) for value in values):
            return False  # a case that is looked at acts
        if Limit.CONSTANT_CASES in capabilities.control.limits and not all(map(is_constant, values)):
            return False
        if not capabilities.control.switch_types:
            return True
        kinds = {self._kind(value) for value in (statement.selector, *values)}
        return kinds <= capabilities.control.switch_types

    def _kind(self, expression: ir.Expression) -> str:
        type = self.editor.type_of(expression)
        if isinstance(type, ir.NamedType):
            if not isinstance(self.editor.scope.type(type.name), ir.EnumDeclaration):
                return "RecordDeclaration"
            return (
                "NamedType" if Composite.ENUMS in self.editor.capabilities.data.composites else "IntType"
            )  # its members become whole numbers
        return type.__class__.__name__

    def _chain(self, statement: ir.Switch) -> ir.Body:
        before: list[ir.Statement] = []
        selector = statement.selector
        values = [value for case in statement.cases for value in case.values]
        if not self._repeatable(selector, values):
            type = self.editor.type_of(selector)
            if type is None:
                return (statement,)
            kept = self.editor.temporary("selected", type)
            before.append(ir.Assign(kept, selector))
            selector = kept
        branches = []
        for case in statement.cases:
            condition: ir.Expression | None = None
            for value in case.values:
                equal = ir.Binary("=", selector, value)
                # `cor`: a case behind the one that matches is never looked at
                condition = equal if condition is None else ir.Binary("cor", condition, equal)
            if condition is not None:
                branches.append((condition, case.body))
        default = statement.default or ()
        if not branches:
            return expansion(statement.origin, (*before, *default)) or (ir.Nothing(origin=statement.origin),)
        return expansion(statement.origin, (*before, ir.If(tuple(branches), default)))

    def _repeatable(self, selector: ir.Expression, values: list[ir.Expression]) -> bool:
        """A plain variable needs no temporary while nothing changes it between the comparisons."""
        plain = isinstance(root(selector), ir.Name) and self.editor.effects.safe(selector)
        return plain and all(map(self.editor.effects.quiet, values))
