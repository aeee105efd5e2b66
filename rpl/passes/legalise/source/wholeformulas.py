"""Formulas that a language without nested expressions (INFORM) writes in steps, as one expression.

`SET D000 B001`, `MUL D000 140000`, `SETE P010 (1) D000` work out one number in a variable that says nothing besides:
each time that it is read, the line in front has set it. Where a language has expressions, its programmer writes the
product, and needs no variable.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

from rpl import ir, registry
from rpl.ir.walk import bodies, walk
from rpl.passes.capabilities import Limit
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import Effects, blocks
from rpl.passes.legalise.facts.runbeside import RunBeside
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_bodies, edit_each
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import changed, rewrite_parts
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typing import type_of
from rpl.passes.values import real

_NUMBERS = ir.IntType | ir.RealType


def _no_use(context: Context) -> bool:
    if not context.foreign or context.capabilities.carries_rules:
        return True
    if Limit.STEPS in context.capabilities.control.limits or context.source not in registry.target_names():
        return True
    return Limit.STEPS not in registry.target(context.source).capabilities().control.limits


@legalising(unless=_no_use, sees=("Binary",))
def whole_formulas(program: ir.Program, context: Context) -> ir.Program:
    """From a language whose assignments have one operator to one that nests them; only variables that nothing else
    needs, and that what runs beside the program does not name."""
    gone = _scratch(program)
    if not gone:
        return program
    done = edit_each(program, lambda _, routine: edit_bodies(routine, lambda body: _joined(body, gone)))
    modules = tuple(
        changed(one, declarations=tuple(d for d in one.declarations if not _declares(d, gone))) for one in done.modules
    )
    return replace(done, modules=modules)


def _declares(declaration: ir.Declaration, names: frozenset[str]) -> bool:
    return isinstance(declaration, ir.Variable) and declaration.name.lower() in names


@dataclass(frozen=True, slots=True)
class _Step:
    """A variable and what it is set to, and the remarks that stand there."""

    name: str
    value: ir.Expression
    statement: ir.Assign


def _step(statement: ir.Statement) -> _Step | None:
    match statement:
        case ir.Assign(target=ir.Name(id=name), value=value):
            return _Step(name.lower(), value, statement)
    return None


def _scratch(program: ir.Program) -> frozenset[str]:
    """Numbers of modules that are read nowhere but directly behind a line that sets them to a value of their type, and
    are named in nothing that runs beside."""
    named = Counter(node.id.lower() for node in walk_for({"Name"}, *program.modules) if isinstance(node, ir.Name))
    counters = {node.counter.lower() for node in walk_for({"For"}, *program.modules) if isinstance(node, ir.For)}
    effects, scopes, beside = Effects(program), ProgramScope(program), RunBeside.of(program).beside
    covered, refused = Counter[str](), set(counters)
    for module in program.modules:
        for routine in module.routines:
            if routine.name.lower() in beside:
                refused |= {node.id.lower() for node in walk(*bodies(routine)) if isinstance(node, ir.Name)}
                continue
            scope = scopes.routine(module, routine)
            for body in _all_bodies(routine):
                for name, times in _steps_in(body, scope, effects):
                    covered[name] += times
    variables = {
        one.name.lower()
        for module in program.modules
        for one in module.declarations
        if isinstance(one, ir.Variable) and isinstance(one.type, _NUMBERS)
    }
    return frozenset(name for name in variables - refused if covered[name] > 0 and covered[name] == named[name])


def _steps_in(body: ir.Body, scope: Scope, effects: Effects) -> Iterator[tuple[str, int]]:
    """The variables that a line of the body sets, and how often they are named there and where the next line reads
    them once."""
    for statement, behind in pairwise((*body, ir.Nothing())):
        step = _step(statement)
        if step is None or not effects.safe(step.value):
            continue
        reads = _reads(behind, step.name) if isinstance(behind, ir.Assign) and effects.safe(behind.value) else 0
        if reads > 1 or type_of(step.value, scope) != type_of(step.statement.target, scope):
            continue
        yield step.name, 1 + reads


def _reads(statement: ir.Assign, name: str) -> int:
    """How often an assignment reads the variable, where it is not only set."""
    target = () if isinstance(statement.target, ir.Name) else (statement.target,)
    return sum(isinstance(one, ir.Name) and one.id.lower() == name for one in walk(statement.value, *target))


def _all_bodies(routine: ir.Routine) -> Iterator[ir.Body]:
    todo = list(bodies(routine))
    while todo:
        body = todo.pop()
        yield body
        for statement in body:
            todo.extend(blocks(statement))


def _joined(body: ir.Body, gone: frozenset[str]) -> ir.Body:
    """The body without the variables: each value stands where it is read."""
    done: list[ir.Statement] = []
    held: _Step | None = None
    for statement in body:
        one = inside(statement, lambda inner: _joined(inner, gone))
        if held is not None and isinstance(one, ir.Assign) and _reads(one, held.name):
            comments = (*held.statement.origin.comments, *one.origin.comments)
            one = replace(_with(one, held), origin=replace(one.origin, comments=comments))
        elif held is not None:
            done.extend(_remark(held))
        step = _step(one)
        held = step if step is not None and step.name in gone else None
        if held is None:
            done.append(one)
    return tuple(done) if held is None else (*done, *_remark(held))


def _remark(step: _Step) -> ir.Body:
    """What is left of a line that nothing reads."""
    return (ir.Nothing(origin=step.statement.origin),) if step.statement.origin.comments else ()


def _with(statement: ir.Assign, step: _Step) -> ir.Assign:
    def put(expression: ir.Expression) -> ir.Expression:
        if isinstance(expression, ir.Name) and expression.id.lower() == step.name:
            return step.value
        return _product(rewrite_parts(expression, put))

    target = statement.target if isinstance(statement.target, ir.Name) else rewrite_parts(statement.target, put)
    return replace(statement, target=target, value=put(statement.value))


def _product(expression: ir.Expression) -> ir.Expression:
    """`(n * 140000) * 0.001` as `n * 140.0`: a factor that is a whole number and one of a unit."""
    match expression:
        case ir.Binary(
            op="*",
            left=ir.Binary(op="*", left=one, right=ir.IntLiteral(value=whole)),
            right=ir.RealLiteral(value=factor),
        ):
            return replace(expression, left=one, right=real(whole * factor))
    return expression


__all__ = ["whole_formulas"]
