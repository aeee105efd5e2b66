"""Interrupts on any change of a value, for targets whose interrupts look for a condition that becomes true: the value
that was seen last is kept beside, the condition is that the two differ, and the routine of the interrupt takes the new
one over before it does anything else.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import partial

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import base_name
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_all, edit_bodies, edit_each, expansion, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.rewrite import rewrite_bodies
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typing import type_of

SEEN = code(
    "interrupt-at-difference",
    Severity.WARNING,
    "the target compares the value with the one seen last; what changes and changes back at once may be missed, and"
    " several changes while interrupts are disabled come as one, or as none where the value is the old one again",
)
_PLAIN = ir.BoolType | ir.IntType | ir.RealType


def watched_changes(program: ir.Program, context: Context) -> ir.Program:
    """The program whose interrupts come with a condition that becomes true (or with time)."""
    if not any(
        isinstance(node, ir.OrderInterrupt) and node.event == "change"
        for node in walk_for({"OrderInterrupt"}, *program.modules)
    ):
        return program
    scopes = ProgramScope(program)
    done = _Changes(context)
    for node in walk_for({"ConnectInterrupt"}, *program.modules):
        if isinstance(node, ir.ConnectInterrupt) and (handle := base_name(node.handle)):
            done.traps.setdefault(handle, set()).add(node.routine.lower())
    ordered = edit_each(program, lambda module, one: edit_bodies(one, partial(done.body, scopes.routine(module, one))))
    if not done.seen:
        return program
    watched = edit_all(ordered, done.watching)
    modules = edit_each(watched, lambda _, routine: done.taking_over(routine)).modules
    first = modules[0]
    made = tuple(ir.Variable(one.last, one.type, scope="global") for one in done.seen)
    home = ir.Module(context.fresh("rpl_seen"), first.dialect, made, task=first.task, public=True)
    return replace(program, modules=(*modules, home))


@dataclass(frozen=True, slots=True)
class _Seen:
    """A value that is watched by the interrupt of a name, and the variable that keeps what was seen last."""

    handle: str
    value: ir.Expression
    last: str
    type: ir.Type


@dataclass(slots=True)
class _Changes:
    """`traps`: the routines each interrupt variable is connected to, all names folded."""

    context: Context
    traps: dict[str, set[str]] = field(default_factory=dict)
    seen: list[_Seen] = field(default_factory=list)

    def body(self, scope: Scope, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        for statement in body:
            done.extend(self.statement(statement, scope))
        return tuple(done)

    def statement(self, statement: ir.Statement, scope: Scope) -> list[ir.Statement]:
        match statement:
            case ir.OrderInterrupt(event="change", handle=ir.Name(id=name), condition=value) if value is not None:
                one = self.kept(name.lower(), value, scope) if name.lower() in self.traps else None
                if one is None:
                    return [statement]
                self.context.diagnostics.report(SEEN, statement.origin)
                last = ir.Name(one.last)
                later = replace(statement.origin, comments=())
                return [
                    ir.Assign(last, value, origin=statement.origin),
                    replace(statement, event="edge", condition=ir.Binary("<>", value, last), origin=later),
                ]
        return [rewrite_bodies(statement, partial(self.body, scope))]

    def kept(self, handle: str, value: ir.Expression, scope: Scope) -> _Seen | None:
        """The place for what was seen of a value; None for values that are no plain data."""
        for one in self.seen:
            if (one.handle, one.value) == (handle, value):
                return one
        type = scope.resolve(found) if (found := type_of(value, scope)) is not None else None
        if not isinstance(type, _PLAIN):
            return None
        one = _Seen(handle, value, self.context.fresh(f"seen_{handle}"), type)
        self.seen.append(one)
        return one

    def watching(self, body: ir.Body) -> ir.Body:
        """What changed while an interrupt was off is lost (RAPID ISleep): when it is switched on again, the value of
        that moment is the one that was seen."""
        return map_body(body, self.watched)

    def watched(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.ControlInterrupt(op="on", handle=handle):
                name = None if handle is None else base_name(handle)
                missed = [one for one in self.seen if name in (None, one.handle)]
                now = [ir.Assign(ir.Name(one.last), one.value) for one in missed]
                return expansion(statement.origin, (*now, statement))
        return (inside(statement, self.watching),)

    def taking_over(self, routine: ir.Routine) -> ir.Routine:
        """A trap begins with the values that its interrupts have seen."""
        taken = [
            ir.Assign(ir.Name(one.last), one.value)
            for one in self.seen
            if routine.name.lower() in self.traps.get(one.handle, ())
        ]
        return replace(routine, body=(*taken, *routine.body)) if taken else routine
