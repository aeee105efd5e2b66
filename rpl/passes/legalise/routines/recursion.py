"""Routines that call themselves on targets that keep one set of variables for all activations of a routine.

Around each call that may run the same routine again, what the routine still wants behind the call is put on a stack (an
array with a number of its own for the next free element) and taken back. A program that goes deeper than the stack
stops with a message. How deep the target's own calls may nest is its capability `call_depth`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.control.jumps import inside
from rpl.passes.legalise.facts.activations import Activations, called
from rpl.passes.legalise.facts.effects import blocks, statements_in
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion, map_body
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.routines.liveness import wanted_behind_calls
from rpl.passes.scope import ProgramScope, Scope

KEPT = code(
    "recursion-limited",
    Severity.WARNING,
    "{name} calls itself, directly or through others; {limits}",
    "the program stops where it goes deeper",
)
TOO_DEEP = "RECURSION TOO DEEP"
_UNKNOWN_DEPTH = 16  # how deep a stack reaches where the target names no limit for its calls
_SHARE = 4  # at most this part of a bank becomes a stack
_STEMS = {
    "IntType": "rpl_stack_whole",
    "RealType": "rpl_stack",
    "BoolType": "rpl_stack_truth",
    "StringType": "rpl_stack_text",
    "CharType": "rpl_stack_sign",
    "PoseType": "rpl_stack_pose",
    "TargetType": "rpl_stack_target",
    "JointsType": "rpl_stack_joints",
}


@dataclass(slots=True)
class _Stack:
    """One stack: its array, the number of its last element in use, the type of its elements, how many there are."""

    name: str
    top: str
    type: ir.Type
    size: int = 0
    most: int = 0  # elements that one call puts on it


@dataclass(slots=True)
class _Stacks:
    """The stacks of a program, by type, and the routine that stops a program that went too deep."""

    context: Context
    found: dict[ir.Type, _Stack] = field(default_factory=dict)
    full: str = ""

    def of(self, type: ir.Type) -> _Stack:
        if type not in self.found:
            name = self.context.fresh(_STEMS[type.__class__.__name__])
            self.found[type] = _Stack(name, self.context.fresh(f"{name}_top"), type)
            self.full = self.full or self.context.fresh("rpl_stack_full")
        return self.found[type]

    def sized(self) -> None:
        """As large as the deepest nest of calls needs, within the bank."""
        depth = self.context.capabilities.routines.call_depth or _UNKNOWN_DEPTH
        for stack in self.found.values():
            stack.size = depth * stack.most
            bank = self.context.capabilities.storage.banks.get(stack.type.__class__.__name__)
            if bank is not None:
                stack.size = max(stack.most, min(stack.size, (bank.last - bank.first + 1) // _SHARE))

    def declared(self) -> list[ir.Declaration]:
        made: list[ir.Declaration] = []
        for stack in self.found.values():
            array = ir.ArrayType(stack.type, (ir.IntLiteral(stack.size),), 1)
            made.append(ir.Variable(stack.top, ir.IntType(), ir.IntLiteral(0), scope="global"))
            made.append(ir.Variable(stack.name, array, scope="global"))
        return made

    def stop(self) -> ir.Routine:
        said = ir.Message("error", ir.TextLiteral(TOO_DEEP))
        return ir.Routine(self.full, body=(said, ir.Halt("exit")), scope="global")


def kept_on_stacks(program: ir.Program, context: Context, facts: Activations) -> tuple[ir.Program, dict[int, str]]:
    """The program whose recursive routines keep their variables around calls of themselves; and those that cannot, by
    identity in the program given, with the reason. Parameters are variables or numbered arguments by now."""
    scopes = ProgramScope(program)
    stacks = _Stacks(context)
    plans: dict[int, dict[int, list[ir.Expression]]] = {}
    lost: dict[int, str] = {}
    for module, routine in scopes.routines():
        if id(routine) in facts.recursive:
            plan, reason = _plan(routine, scopes.routine(module, routine), facts)
            plans[id(routine)] = plan
            if reason:
                lost[id(routine)] = reason
    if lost:
        return program, lost

    for module, routine in scopes.routines():
        scope = scopes.routine(module, routine)
        for places in plans.get(id(routine), {}).values():
            counts: dict[ir.Type, int] = {}
            for place in places:
                counts[_type(place, scope)] = counts.get(_type(place, scope), 0) + 1
            for type, count in counts.items():
                stack = stacks.of(type)
                stack.most = max(stack.most, count)
    stacks.sized()
    done = edit_routines(program, context, lambda editor, one: _saved(editor, one, plans.get(id(one), {}), stacks))
    _report(context, facts, stacks)
    if stacks.found:
        done = with_support(done, context, stacks.declared(), (stacks.stop(),))
    return done, {}


def _report(context: Context, facts: Activations, stacks: _Stacks) -> None:
    parts = []
    if context.capabilities.routines.call_depth:
        parts.append(f"the target's calls nest {context.capabilities.routines.call_depth} deep at most")
    for stack in stacks.found.values():
        parts.append(f"{stack.name} keeps up to {stack.size} values of its activations")
    for key in facts.recursive:
        routine = facts.routines[key]
        limits = "; ".join(parts) or "how deep it may go is up to the target"
        context.diagnostics.report(KEPT, routine.origin, name=routine.name, limits=limits)


# ---- what is kept


def _plan(routine: ir.Routine, scope: Scope, facts: Activations) -> tuple[dict[int, list[ir.Expression]], str]:
    """id of a call -> the places that are kept around it; and why that is not possible, or nothing."""
    own = {
        one.name.lower(): one
        for one in routine.declarations
        if isinstance(one, ir.Variable) and one.storage == "variable"
    }
    wanted = wanted_behind_calls(routine, frozenset(own))
    found: dict[int, list[ir.Expression]] = {}
    for body in bodies(routine):
        for statement in statements_in(body):
            if not any(id(routine) in facts.reached({id(one)}) for one in called(statement, scope)):
                continue
            if not isinstance(statement, ir.CallRoutine):
                return {}, "it is called inside of another statement"
            places: list[ir.Expression] = []
            for name, one in own.items():
                if name in wanted.get(id(statement), ()):
                    elements = list(_elements(one, scope))
                    if not elements:
                        return {}, f"{one.name} cannot be kept on a stack"
                    places.extend(elements)
            found[id(statement)] = places
    return found, ""


def _elements(variable: ir.Variable, scope: Scope) -> Iterator[ir.Expression]:
    """The variable, or the elements of an array of known size; nothing for what has no stack."""
    type = scope.resolve(variable.type)
    if type.__class__.__name__ in _STEMS:
        yield ir.Name(variable.name)
    elif isinstance(type, ir.ArrayType) and len(type.dimensions) == 1:
        last = constant(type.dimensions[0], scope) if type.dimensions[0] is not None else None
        if isinstance(last, int) and scope.resolve(type.element).__class__.__name__ in _STEMS:
            for number in range(type.base, last + 1):
                yield ir.Index(ir.Name(variable.name), (ir.IntLiteral(number),))


def _type(place: ir.Expression, scope: Scope) -> ir.Type:
    base = place.base if isinstance(place, ir.Index) else place
    symbol = scope.value(base.id) if isinstance(base, ir.Name) else None
    assert symbol is not None  # a variable of the routine
    type = scope.resolve(symbol.type)
    return scope.resolve(type.element) if isinstance(type, ir.ArrayType) else type


# ---- the calls


def _saved(editor: Editor, routine: ir.Routine, plan: dict[int, list[ir.Expression]], stacks: _Stacks) -> ir.Routine:
    def change(statement: ir.Statement) -> ir.Body:
        if blocks(statement):
            return (inside(statement, lambda inner: map_body(inner, change)),)
        places = plan.get(id(statement), [])
        if not places:
            return (statement,)
        before: list[ir.Statement] = []
        behind: list[ir.Statement] = []
        for place in places:
            stack = stacks.of(_type(place, editor.scope))
            top = ir.Name(stack.top)
            cell = ir.Index(ir.Name(stack.name), (top,))
            full = ir.Binary(">", top, ir.IntLiteral(stack.size))
            before.append(ir.Assign(top, ir.Binary("+", top, ir.IntLiteral(1))))
            before.append(ir.If(((full, (ir.CallRoutine(stacks.full),)),)))
            before.append(ir.Assign(cell, place))
            behind[:0] = [ir.Assign(place, cell), ir.Assign(top, ir.Binary("-", top, ir.IntLiteral(1)))]
        return expansion(statement.origin, (*before, statement, *behind))

    return edit_bodies(routine, lambda body: map_body(body, change)) if plan else routine
