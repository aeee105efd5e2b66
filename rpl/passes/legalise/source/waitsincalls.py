"""Routines that do nothing but wait for what they are given: the wait stands where they are called.

People write them in languages whose only way to wait is a loop (URScript `wait_input(number)`); where waiting is one
statement nobody has a routine for it, nor signals that are chosen by a number.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import bodies, rewrite, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import is_constant, statements_in
from rpl.passes.legalise.facts.mentioned import naming_of_routines
from rpl.passes.legalise.facts.usage import usage_of
from rpl.passes.legalise.facts.values.heldtexts import named_by_texts
from rpl.passes.legalise.rewriting.editing import edit_bodies, edit_each, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import changed
from rpl.source import Comment

__all__ = ["waits_in_calls"]

_CALLS = frozenset(("CallRoutine",))


@legalising(unless=lambda context: not context.foreign, sees=_CALLS)
def waits_in_calls(program: ir.Program, context: Context) -> ir.Program:
    """Only routines that every call can do without. What is said about them is said at the first call."""
    waits = _waits(program)
    if not waits:
        return program
    done = edit_each(program, _Calls(waits).routine, _CALLS)
    modules = (
        changed(one, routines=tuple(each for each in one.routines if each.name.lower() not in waits))
        for one in done.modules
    )
    return changed(done, modules=tuple(modules))


def _waits(program: ir.Program) -> dict[str, ir.Routine]:
    """Such routines by their folded names."""
    routines = [one for module in program.modules for one in module.routines]
    named, mentioned = Counter(one.name.lower() for one in routines), naming_of_routines(program)
    kept = {program.entry.lower(), *(task.entry.lower() for task in program.tasks)} | named_by_texts(program)
    assigned = usage_of(program).assigned
    found = {
        key: one
        for one in routines
        if (key := one.name.lower()) not in kept and named[key] == 1 and mentioned[key] and _only_waits(one, assigned)
    }
    plain: Counter[str] = Counter()
    for routine in routines if found else ():
        hidden = {one.name.lower() for one in (*routine.parameters, *routine.declarations) if hasattr(one, "name")}
        for body in bodies(routine):
            for statement in statements_in(body):
                if not isinstance(statement, ir.CallRoutine) or (key := statement.name.lower()) not in found:
                    continue
                plain[key] += _is_plain(statement, found[key], assigned) and not _others(found[key]) & hidden
    return {key: one for key, one in found.items() if plain[key] == mentioned[key]}


def _only_waits(routine: ir.Routine, assigned: set[str]) -> bool:
    """Is a wait without an end all that the routine does, for what it is given and what nothing assigns?"""
    match routine:
        case ir.Routine(
            kind="procedure",
            parameters=(_, *_),
            body=(ir.WaitUntil(timeout=None, timed_out=None, error=None) as wait,),
            handlers=(),
            undo=(),
            backward=(),
        ):
            pass
        case _:
            return False
    plain = all(one.mode == "value" and not one.optional for one in routine.parameters)
    own = {one.name.lower() for one in routine.parameters}
    declared = {one.name.lower() for one in routine.declarations if isinstance(one, ir.Variable)}
    calls = any(isinstance(node, ir.Call) for node in walk(wait))
    return plain and not calls and declared <= own and not _others(routine) & assigned


def _others(routine: ir.Routine) -> set[str]:
    """What the routine names beside its parameters, folded."""
    given = {one.name.lower() for one in routine.parameters}
    return {node.id.lower() for node in walk(routine.body) if isinstance(node, ir.Name)} - given


def _is_plain(call: ir.CallRoutine, routine: ir.Routine, assigned: set[str]) -> bool:
    """Are the arguments constants, in the order of the parameters?"""
    given = [one.value for one in call.arguments if not one.name and one.if_present is None and one.value is not None]
    if call.dynamic is not None or not len(given) == len(call.arguments) == len(routine.parameters):
        return False
    return all(is_constant(one) or (isinstance(one, ir.Name) and one.id.lower() not in assigned) for one in given)


@dataclass(slots=True)
class _Calls:
    waits: Mapping[str, ir.Routine]
    told: set[str] = field(default_factory=set)  # whose remarks stand at a call by now

    def routine(self, _: ir.Module, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, self.body)

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement, _CALLS)

    def statement(self, statement: ir.Statement) -> ir.Body:
        if not isinstance(statement, ir.CallRoutine) or (called := self.waits.get(statement.name.lower())) is None:
            return (inside(statement, self.body),)
        values = {
            parameter.name.lower(): argument.value
            for parameter, argument in zip(called.parameters, statement.arguments, strict=True)
        }

        def given(node: object) -> object:
            match node:
                case ir.Name(id=name):
                    return values.get(name.lower(), node)
                case ir.Binary(op="+", left=ir.IntLiteral(value=one), right=ir.IntLiteral(value=other)):
                    return ir.IntLiteral(one + other)  # numbers of signals, counted from another first one
            return node

        wait = rewrite(called.body[0], given)
        remarks = (*self.remarks(called), *statement.origin.comments)
        return (replace(wait, origin=replace(statement.origin, comments=remarks)),)

    def remarks(self, routine: ir.Routine) -> tuple[Comment, ...]:
        """What the source says about the routine, once."""
        if routine.name in self.told:
            return ()
        self.told.add(routine.name)
        return (*routine.origin.comments, *routine.body[0].origin.comments)
