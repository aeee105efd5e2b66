"""Texts that may get longer than those of the target: RAPID stops at the 81st character, KRL leaves out what does not
fit.

How long a text may get is taken from all that is stored in it. One that is lengthened in a loop, or in a routine that
is called from one, has no end that is known here.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, children, walk
from rpl.passes.fold import constant_number
from rpl.passes.legalise.context import Context, ProgramScope, rules_of
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.facts.values.wholes import Key, place_key
from rpl.passes.legalise.rewriting.jumps import LOOPS
from rpl.passes.legalise.rewriting.textroom import declared_types, with_room
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import Scope
from rpl.passes.typing import type_of
from rpl.source import Origin

TOO_LONG = code(
    "text-may-not-fit",
    Severity.WARNING,
    "{what} may get longer than {most} characters, which is all that a text of the target holds",
    "begin a new text before it is full",
)
_LATER = (ir.DeclareInterrupt, ir.ConnectInterrupt, ir.OrderInterrupt)  # what these name runs whenever they come
_NUMBER, _ANY = 20, 40  # characters of a number, and of what is asked for or read
_AS_LONG = frozenset(("text_upper", "text_lower", "text_map"))
_SHAPED = frozenset(("format", "message_text"))


@legalising()
def text_lengths(program: ir.Program, context: Context) -> ir.Program:
    """Reports, and gives texts more room where the target declares how much each has."""
    usual, most = context.capabilities.texts.room or (0, rules_of(context.target).text_length)
    least = rules_of(context.source).text_length
    if not most or (least and least <= (usual or most)) or not any(map(_is_text, declared_types(program))):
        return program
    lengths = _Lengths(program, most + 1, least or most + 1)
    for name, origin in lengths.beyond(most):
        context.diagnostics.report(TOO_LONG, origin, what=name, most=most)
    return with_room(program, most) if usual and any(True for _ in lengths.beyond(usual)) else program


def _is_text(type: ir.Type | None) -> bool:
    return isinstance(type, ir.StringType)


@dataclass(frozen=True, slots=True)
class _Flow:
    """What is stored in a text; `times`: put to what is there, and how often (0: it takes the place of it)."""

    value: ir.Expression
    scope: Scope
    origin: Origin
    name: str
    times: int = 0


class _Lengths:
    """`longest` of each place; `end`: what counts as without end; `most`: what a text of the source holds."""

    def __init__(self, program: ir.Program, end: int, most: int) -> None:
        self.end, self.most = end, most
        self.flows: defaultdict[Key, list[_Flow]] = defaultdict(list)
        self.longest: dict[Key, int] = {}
        self.scopes = ProgramScope(program)
        self.inside = {id(one): self.scopes.routine(module, one) for module, one in self.scopes.routines()}
        self.times = _Calls(self.scopes).times()
        for module in program.modules:
            self.declarations(module.declarations, self.scopes.module(module))
            for routine in module.routines:
                self.declarations(routine.declarations, self.inside[id(routine)])
                self.routine(routine, self.inside[id(routine)])
        self.settle()

    # ---- what is stored

    def declarations(self, declarations: tuple[ir.Declaration, ...], scope: Scope) -> None:
        for one in declarations:
            if isinstance(one, ir.Variable):
                for node in walk((one.initial,)) if one.initial is not None else ():
                    if isinstance(node, ir.TextLiteral):
                        self.flows[id(one)].append(_Flow(node, scope, one.origin, one.name))

    def routine(self, routine: ir.Routine, scope: Scope) -> None:
        own = {id(one) for one in routine.declarations}
        times = self.times.get(routine.name.lower())
        for body in bodies(routine):
            for statement, looped in _statements(body):
                match statement:
                    case ir.Assign(target=target, value=value) if _is_text(type_of(target, scope)):
                        key = place_key(target, scope)
                        often = None if looped else 1 if key in own else times
                        self.flow(key, _Flow(value, scope, statement.origin, _name(target)), target, often)
                    case ir.Return(value=value) if value is not None:
                        self.flow(id(routine), _Flow(value, scope, statement.origin, routine.name))
        for node in walk(routine):
            if isinstance(node, ir.Call | ir.CallRoutine):
                self.passed(node, scope)

    def flow(self, key: Key | None, flow: _Flow, target: ir.Expression | None = None, times: int | None = None) -> None:
        added = _added(target, flow.value) if target is not None and times is not None else None
        if key is not None:
            self.flows[key].append(flow if added is None else replace(flow, value=added, times=times or 0))

    def passed(self, call: ir.Call | ir.CallRoutine, scope: Scope) -> None:
        """Arguments go to the parameters by their place or name, and come back from those by reference."""
        routine = scope.routine(call.name)
        if routine is None or id(routine) not in self.inside:
            return
        named = {one.name.lower(): one for one in routine.parameters}
        for parameter, argument in zip(routine.parameters, call.arguments, strict=False):
            parameter = named.get((argument.name or "").lower(), parameter)
            if argument.value is None or not _is_text(scope.resolve(parameter.type)):
                continue
            self.flow(id(parameter), _Flow(argument.value, scope, call.origin, parameter.name))
            if parameter.mode != "value":
                back = _Flow(ir.Name(parameter.name), self.inside[id(routine)], call.origin, _name(argument.value))
                self.flow(place_key(argument.value, scope), back)

    # ---- how long that is

    def settle(self) -> None:
        changed = True
        while changed:
            changed = False
            for key, flows in self.flows.items():
                found = max((self.length(one.value, one.scope) for one in flows if not one.times), default=0)
                found += sum(one.times * self.length(one.value, one.scope) for one in flows if one.times)
                found = min(found, self.most, self.end)
                if found > self.longest.get(key, 0):
                    self.longest[key], changed = found, True

    def length(self, value: ir.Expression, scope: Scope) -> int:
        """Characters of a value at most, as far as is known now."""
        match value:
            case ir.TextLiteral(value=text):
                return len(text)
            case ir.Builtin(function="from_code"):
                return 1
            case ir.Builtin(function=name, arguments=(shape, *rest)) if name in _SHAPED:
                return min(self.end, self.length(shape, scope) + sum(self.length(one, scope) for one in rest))
        if not _is_text(type_of(value, scope)):
            return _NUMBER
        match value:
            case ir.Name() | ir.Index() | ir.Field():
                key = place_key(value, scope)
                return _ANY if key is None else self.longest.get(key, 0)
            case ir.Binary(op="&" | "+", left=left, right=right):
                return min(self.end, self.length(left, scope) + self.length(right, scope))
            case ir.Builtin(function="text_part", arguments=(whole, _, count)):
                known, most = constant_number(count, scope), self.length(whole, scope)
                return most if known is None else min(most, max(0, int(known)))
            case ir.Builtin(function=name, arguments=arguments) if name in _AS_LONG:
                return self.length(arguments[0], scope)
            case ir.Call(name=name):
                routine = scope.routine(name)
                return _ANY if routine is None else self.longest.get(id(routine), 0)
            case ir.Convert(operand=operand):
                return self.length(operand, scope)
        return _ANY

    def beyond(self, most: int) -> Iterator[tuple[str, Origin]]:
        """Name and first place of each text that gets longer by what is put to it."""
        for key, flows in self.flows.items():
            if self.longest.get(key, 0) > most:
                own = [one for one in flows if one.times or isinstance(one.value, ir.Binary | ir.TextLiteral)]
                own.sort(key=lambda one: isinstance(one.value, ir.TextLiteral))
                if own:  # else it is only handed on, and too long where it comes from
                    yield own[0].name, own[0].origin


class _Calls:
    """How often each routine runs at most, by its folded name; none of what loops, tasks or interrupts call."""

    def __init__(self, scopes: ProgramScope) -> None:
        self.callers: defaultdict[str, list[str | None]] = defaultdict(list)  # None: any number of times
        self.names = {routine.name.lower() for _, routine in scopes.routines() if routine.kind != "trap"}
        for _, routine in scopes.routines():
            for number, body in enumerate(bodies(routine)):
                for statement, looped in _statements(body):
                    often = looped or isinstance(statement, (*LOOPS, *_LATER)) or number > 0
                    for node in _own_nodes(statement):
                        match node:
                            case ir.Call(name=name) | ir.CallRoutine(name=name, dynamic=None):
                                self.callers[name.lower()].append(None if often else routine.name.lower())
                            case ir.TaskControl(task=name):
                                self.callers[name.lower()].append(None)
                            case ir.CallRoutine():
                                self.names = set()  # any routine could be meant

    def times(self) -> dict[str, int]:
        """Routines that call each other are in none of the rounds."""
        found: dict[str, int] = {}
        ready = [name for name in self.names if name not in self.callers]
        waiting = {name: len(callers) for name, callers in self.callers.items()}
        inside: defaultdict[str, list[str]] = defaultdict(list)
        for name, callers in self.callers.items():
            for one in callers:
                if one is not None:
                    inside[one].append(name)
        while ready:
            name = ready.pop()
            found[name] = sum(found[one] for one in self.callers.get(name, ()) if one is not None) or 1
            for callee in inside[name]:
                waiting[callee] -= 1
                if not waiting[callee] and callee in self.names:
                    ready.append(callee)
        return found


def _own_nodes(statement: ir.Statement) -> Iterator[object]:
    """The statement and its expressions, without the statements inside."""
    inner = {id(one) for block in blocks(statement) for one in block}
    stack: list[object] = [statement]
    while stack:
        node = stack.pop()
        yield node
        stack += [one for one in children(node) if id(one) not in inner]


def _statements(body: ir.Body) -> Iterator[tuple[ir.Statement, bool]]:
    """All statements, and whether each may come several times while its routine runs once: in loops, and between a
    label and a jump back to it."""
    found: list[tuple[ir.Statement, bool]] = []
    labels: dict[str, int] = {}
    back: list[tuple[int, int]] = []
    stack = [(one, False) for one in reversed(body)]
    while stack:
        statement, again = stack.pop()
        if isinstance(statement, ir.Label):
            labels[statement.name.lower()] = len(found)
        elif isinstance(statement, ir.Goto) and statement.label.lower() in labels:
            back.append((labels[statement.label.lower()], len(found)))
        found.append((statement, again))
        inner = again or isinstance(statement, LOOPS)
        stack += [(one, inner) for block in blocks(statement) for one in reversed(block)]
    steps = [0] * (len(found) + 1)
    for first, last in back:
        steps[first] += 1
        steps[last] -= 1
    within = 0
    for (statement, again), step in zip(found, steps, strict=False):
        within += step
        yield statement, again or within > 0


def _added(target: ir.Expression, value: ir.Expression) -> ir.Expression | None:
    """What is put behind, or in front of, what the place holds."""
    if isinstance(value, ir.Binary) and value.op in ("&", "+"):
        parts = [value.right]
        left = value.left
        while isinstance(left, ir.Binary) and left.op == value.op:
            parts.append(left.right)
            left = left.left
        parts.append(left)
        if parts.count(target) == 1:
            parts.remove(target)
            done = parts.pop()
            while parts:
                done = ir.Binary(value.op, done, parts.pop())
            return done
    return None


def _name(place: ir.Expression) -> str:
    match place:
        case ir.Name(id=name) | ir.Field(name=name):
            return name
        case ir.Index(base=base):
            return _name(base)
    return "a text"


__all__ = ["text_lengths"]
