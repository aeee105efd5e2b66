"""User functions as procedures that leave their result in a variable, for targets without functions.

Calls inside of expressions move in front of the statement, left to right as they were evaluated; a result that nothing
can overwrite before it is used is taken from the function's variable itself.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies
from rpl.passes.capabilities import RoutineRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import blocks, children, everything, statements_in
from rpl.passes.legalise.rewriting.bodies import Hoister, Lowered, written_arguments
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts

CALL_LEFT = code(
    "function-in-place",
    Severity.LOSS,
    "{name} is called where no statement can stand in front, and the target has no functions",
)


@legalising(unless=lambda context: RoutineRule.FUNCTIONS in context.capabilities.routines.rules)
def functions_to_procedures(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without user functions."""
    results: dict[int, str] = {}
    for module in program.modules:
        for routine in module.routines:
            if routine.kind == "function" and routine.returns is not None:
                results[id(routine)] = context.fresh(f"{routine.name}_result")
    if not results:
        return program

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return _rewritten(editor, routine, results)

    done = edit_routines(program, context, work)
    modules = []
    for old, module in zip(program.modules, done.modules, strict=True):
        declared = tuple(
            ir.Variable(results[id(one)], one.returns, scope=one.scope)
            for one in old.routines
            if id(one) in results and one.returns is not None
        )
        modules.append(replace(module, declarations=(*module.declarations, *declared)) if declared else module)
    return replace(done, modules=tuple(modules))


def _rewritten(editor: Editor, routine: ir.Routine, results: dict[int, str]) -> ir.Routine:
    names = set(results.values())

    def rule(expression: ir.Expression) -> Lowered | None:
        if not isinstance(expression, ir.Call):
            return None
        called = editor.scope.routine(expression.name)
        if called is None or id(called) not in results or called.returns is None:
            return None
        kept = editor.temporary("result", editor.scope.resolve(called.returns))
        call = ir.CallRoutine(expression.name, expression.arguments)
        return (call, ir.Assign(kept, ir.Name(results[id(called)]))), kept

    done = edit_bodies(routine, Hoister(editor, rule).body)
    done = _without_left(editor, done, results)
    own = results.get(id(routine))
    if own is not None:
        done = edit_bodies(done, lambda body: _assigned(body, own))
        done = replace(done, kind="procedure", returns=None, body=_without_last_return(done.body))
    return _direct(editor, done, names)


def _without_left(editor: Editor, routine: ir.Routine, results: dict[int, str]) -> ir.Routine:
    """Calls where no statement can stand in front are reported; the target has no such value."""

    def change(statement: ir.Statement) -> ir.Body:
        def expression(one: ir.Expression) -> ir.Expression:
            called = editor.scope.routine(one.name) if isinstance(one, ir.Call) else None
            if isinstance(one, ir.Call) and called is not None and id(called) in results and called.returns is not None:
                editor.context.diagnostics.report(CALL_LEFT, statement.origin, name=one.name)
                return ir.VendorValue(editor.context.source, f"{one.name}(...)", called.returns, origin=one.origin)
            return rewrite_parts(one, expression)

        return (rewrite_parts(statement, expression, lambda body: map_body(body, change)),)

    return edit_bodies(routine, lambda body: map_body(body, change))


# ---- the function's own side


def _assigned(body: ir.Body, result: str) -> ir.Body:
    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Return) and statement.value is not None:
            give = ir.Assign(ir.Name(result), statement.value)
            return expansion(statement.origin, (give, replace(statement, value=None)))
        return (inside(statement, lambda inner: map_body(inner, change)),)

    return map_body(body, change)


def _without_last_return(body: ir.Body) -> ir.Body:
    match body:
        case (*rest, ir.Return(value=None, origin=origin)) if not origin.comments:
            return tuple(rest)
    return body


# ---- results that need no variable in between


def _direct(editor: Editor, routine: ir.Routine, results: set[str]) -> ir.Routine:
    """`CALL f; t = f_result; x = t + 1` is `CALL f; x = f_result + 1` where t is used nowhere else."""
    uses: dict[str, int] = {}
    for body in bodies(routine):
        for statement in statements_in(body):
            for name in _names(statement):
                uses[name] = uses.get(name, 0) + 1
    gone: set[str] = set()

    def on_body(body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        for old in body:
            statement = inside(old, on_body)
            match done[-1:]:
                case [ir.Assign(target=ir.Name(id=kept), value=ir.Name(id=result))] if result in results:
                    key = kept.lower()
                    if key in editor.own and uses.get(key) == 2 and _read_first(editor, statement, key):
                        before = done.pop()
                        statement = _named(statement, key, result)
                        if before.origin.comments:
                            done.append(ir.Nothing(origin=before.origin))
                        gone.add(key)
            match statement:
                case ir.Assign(target=ir.Name(id=to), value=ir.Name(id=of)) if to == of and to in results:
                    continue
            done.append(statement)
        same = len(done) == len(body) and all(new is old for new, old in zip(done, body, strict=True))
        return body if same else tuple(done)

    changed = edit_bodies(routine, on_body)
    editor.added = [one for one in editor.added if one.name.lower() not in gone]
    return changed


def _names(statement: ir.Statement) -> Iterator[str]:
    for child in children(statement):
        yield from (one.id.lower() for one in everything(child) if isinstance(one, ir.Name))
    if isinstance(statement, ir.For):
        yield statement.counter.lower()


def _read_first(editor: Editor, statement: ir.Statement, name: str) -> bool:
    """Does the statement read the variable once, at its beginning, and not write it?"""
    match statement:
        case ir.If(branches=((condition, _), *_)):
            looked: list[ir.Expression] = [condition]
        case ir.While() | ir.Repeat() | ir.WaitUntil() | ir.DeclareInterrupt() | ir.OrderInterrupt() | ir.Trigger():
            return False
        case ir.CallRoutine(name=called, arguments=arguments):
            written = written_arguments(called, arguments, editor.scope)
            values = [argument.value for argument in arguments if argument.value is not None]
            looked = [value for value, writes in zip(values, written, strict=True) if not writes]
        case ir.Assign(target=target, value=value):
            looked = [value, *(children(target) if isinstance(target, ir.Index) else [])]
        case ir.Do():
            return False
        case _:
            looked = children(statement)
    found = [one for part in looked for one in everything(part) if isinstance(one, ir.Name) and one.id.lower() == name]
    return len(found) == 1


def _named(statement: ir.Statement, old: str, new: str) -> ir.Statement:
    def expression(one: ir.Expression) -> ir.Expression:
        if isinstance(one, ir.Name) and one.id.lower() == old:
            return replace(one, id=new)
        return rewrite_parts(one, expression)

    return rewrite_parts(statement, expression, (lambda body: body) if blocks(statement) else None)
