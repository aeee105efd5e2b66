"""Pulses to the opposite of what an output is, of outputs that only pulses switch on: pulses to high.

`PulseDO doReset` inverts the output. Where no other statement of the program can switch it on, it is low whenever no
pulse runs, so targets that pulse to high need neither the question nor a task that sets it back.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes.capabilities import PulseRule
from rpl.passes.legalise.context import Context, ProgramScope
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import Scope

PULSED = code(
    "pulse-to-high",
    Severity.WARNING,
    "nothing but pulses switches {name} on, so its pulse is written to high; one that begins while another runs would "
    "be to low",
)
_HIGH, _LOW = ir.BoolLiteral(True), ir.BoolLiteral(False)


@legalising(unless=lambda context: PulseRule.ANY_LEVEL in context.capabilities.io.pulses, sees=("Pulse",))
def pulsed_outputs(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose pulses are to high."""
    scopes = ProgramScope(program)
    inverted = set[int]()
    for module in program.modules:
        for routine in module.routines:
            scope = scopes.routine(module, routine)
            for node in walk(routine):
                if isinstance(node, ir.Pulse) and node.value == ir.Unary("not", node.signal):
                    number = _number(node.signal, scope)
                    inverted |= {number} if number is not None else set()
    known = frozenset(inverted - _switched(program, scopes, inverted)) if inverted else frozenset[int]()
    if not known:
        return program

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        def high(statement: ir.Statement) -> ir.Body:
            match statement:
                case ir.Pulse(signal=signal, value=value) if value == ir.Unary("not", signal):
                    if _number(signal, editor.scope) in known:
                        name = signal.id if isinstance(signal, ir.Name) else "the output"
                        context.diagnostics.report(PULSED, statement.origin, name=name)
                        return (replace(statement, value=_HIGH),)
            return (inside(statement, lambda inner: map_body(inner, high)),)

        return edit_bodies(routine, lambda body: map_body(body, high))

    return edit_routines(program, context, work)


def _number(signal: ir.Expression, scope: Scope) -> int | None:
    """The number of a single digital output that is named, or said by its number."""
    if isinstance(signal, ir.Name):
        symbol = scope.value(signal.id)
        declared = symbol.declaration if symbol is not None else None
        return _number(declared.signal, scope) if isinstance(declared, ir.SignalDeclaration) else None
    match signal:
        case ir.Signal(kind="digital_out", index=ir.IntLiteral(value=number), last=None, name=None):
            return number
    return None


def _switched(program: ir.Program, scopes: ProgramScope, asked: set[int]) -> set[int]:
    """Those of the numbers that a statement which is not a pulse may switch on."""
    found: set[int] = set()
    words: set[str] = set()
    for node in walk_for({"Signal", "Vendor", "Opaque"}, *program.modules):
        match node:
            case ir.Signal(kind="digital_out", index=index, last=None) if not isinstance(index, ir.IntLiteral | None):
                return set(asked)  # an output that is known only in the run
            case ir.Signal(kind="digital_out", index=ir.IntLiteral(value=first), last=ir.IntLiteral(value=last)):
                found |= set(range(first, last + 1))
            case ir.Vendor(text=text) | ir.Opaque(text=text):
                words |= set(re.findall(r"\w+", text.lower()))
    for module in program.modules:
        for one in module.declarations:
            if isinstance(one, ir.SignalDeclaration) and one.name.lower() in words:
                found |= set(_numbers(one.signal, scopes.module(module)))
        for routine in module.routines:
            scope = scopes.routine(module, routine)
            every = Counter(_numbers(routine, scope))
            harmless = Counter[int]()
            for body in bodies(routine):
                for statement in walk(*body):
                    harmless.update(_harmless(statement, scope))
            found |= {number for number in asked if every[number] > harmless[number]}
    return found


def _numbers(node: object, scope: Scope) -> Iterator[int]:
    for inner in walk(node):
        if isinstance(inner, ir.Name | ir.Signal):
            number = _number(inner, scope)
            if number is not None:
                yield number


def _harmless(node: object, scope: Scope) -> Iterator[int]:
    """Outputs that the statement itself names without switching them on: reset, pulsed or asked for."""
    match node:
        case ir.Assign(target=target, value=value):
            if value == _LOW:
                yield from _numbers(target, scope)
            yield from _asked(value, scope)
        case ir.Pulse(signal=signal, value=value):
            if value in (_HIGH, ir.Unary("not", signal)):
                yield from _numbers(signal, scope)
                yield from _numbers(value, scope)
        case ir.If(branches=branches):
            for condition, _ in branches:
                yield from _asked(condition, scope)
        case ir.While(condition=condition) | ir.Repeat(until=condition) | ir.WaitUntil(condition=condition):
            yield from _asked(condition, scope)


def _asked(value: ir.Expression | None, scope: Scope) -> Iterator[int]:
    """Outputs in a value, if it calls nothing that could get them handed over."""
    if value is not None and not any(isinstance(one, ir.Call) for one in walk(value)):
        yield from _numbers(value, scope)


__all__ = ["pulsed_outputs"]
