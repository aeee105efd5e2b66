"""Functions that give a text or a list, for targets whose functions cannot: procedures that write their first
parameter."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.capabilities import RoutineRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import blocks, children, everything
from rpl.passes.legalise.rewriting.bodies import Hoister, Lowered, Rule
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion, map_body
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies


@legalising()
def list_results(program: ir.Program, context: Context) -> ir.Program:
    """The program with no function that gives a list of known size, where the target has none."""
    return (
        program
        if RoutineRule.LIST_RESULTS in context.capabilities.routines.rules
        else _as_parameters(program, context, ir.ArrayType, "list")
    )


def text_results(program: ir.Program, context: Context) -> ir.Program:
    """The program with no function that gives a text."""
    return _as_parameters(program, context, ir.StringType, "text")


def _as_parameters(program: ir.Program, context: Context, kind: type[ir.Type], stem: str) -> ir.Program:
    results: dict[str, tuple[str, ir.Type]] = {}
    for module in program.modules:
        for routine in module.routines:
            type = routine.returns
            open_size = isinstance(type, ir.ArrayType) and None in type.dimensions
            if routine.kind == "function" and isinstance(type, kind) and type is not None and not open_size:
                results[routine.name.lower()] = (context.fresh("result"), type)
    if not results:
        return program
    names = frozenset(results)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        def rule(expression: ir.Expression) -> Lowered | None:
            if not isinstance(expression, ir.Call) or expression.name.lower() not in names:
                return None
            kept = editor.temporary(stem, results[expression.name.lower()][1])
            arguments = (ir.Argument(kept), *expression.arguments)
            return (ir.CallRoutine(expression.name, arguments),), kept

        done = edit_bodies(routine, _Direct(editor, rule, names).body)
        if routine.name.lower() not in names or routine.kind != "function":
            return done
        result, type = results[routine.name.lower()]
        parameter = ir.Parameter(result, type, "reference")
        done = edit_bodies(done, lambda body: _assigned(body, result))
        return replace(done, kind="procedure", returns=None, parameters=(parameter, *done.parameters))

    return edit_routines(program, context, work)


class _Direct(Hoister):
    """`t = f(x)` lets the procedure write `t` itself where its arguments do not mention `t`."""

    def __init__(self, editor: Editor, rule: Rule, names: frozenset[str]) -> None:
        super().__init__(editor, rule)
        self.names = names

    def placed(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.Assign(target=ir.Name(id=name) as target, value=ir.Call() as call) if self.private(name):
                others = [one for child in children(call) for one in everything(child)]
                used = any(isinstance(one, ir.Name) and one.id.lower() == name.lower() for one in others)
                if call.name.lower() in self.names and not used:
                    arguments = (ir.Argument(target), *call.arguments)
                    return super().placed(ir.CallRoutine(call.name, arguments, origin=statement.origin))
        return super().placed(statement)

    def private(self, name: str) -> bool:
        """A variable of the routine, which the called one cannot see."""
        symbol = self.editor.scope.value(name)
        return symbol is not None and symbol.routine is not None and isinstance(symbol.declaration, ir.Variable)


def _assigned(body: ir.Body, result: str) -> ir.Body:
    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Return) and statement.value is not None:
            give = ir.Assign(ir.Name(result), statement.value)
            return expansion(statement.origin, (give, replace(statement, value=None)))
        if blocks(statement):
            return (rewrite_bodies(statement, lambda inner: map_body(inner, change)),)
        return (statement,)

    return map_body(body, change)
