"""Which real variables, parameters, results, elements and record fields of a program hold whole numbers only.

Languages with one number type use it for counters, indices and states as well. Every place is taken as whole until a
value that may have a fraction flows into it; what that makes fractional follows until nothing changes any more. What
gets multiples of itself may outgrow a whole number of 32 bits and stays real. Retained data (RAPID PERS, registers)
can be given another value on the pendant, so it is whole only where the program counts with it: as a subscript, a
bound, a case, in steps, or compared for equality with a whole number.
"""

from __future__ import annotations

import re
from collections import defaultdict
from dataclasses import dataclass, field

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import ProgramScope
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.scope import Scope
from rpl.passes.typewords import component_names
from rpl.passes.typing import type_of

LARGEST = 2**31 - 1
_SINGLE_BITS = 24
_WHOLE_FUNCTIONS = frozenset(
    {
        *("floor", "ceil", "length", "dimension", "bit_shift_left", "bit_shift_right", "text_length", "text_capacity"),
        *("text_find", "text_find_any", "text_match", "character_code"),
    }
)
_WHOLE_SYSTEM = frozenset(("error_number", "interrupt_number"))
# Procedures whose written arguments get numbers of any kind.
_PARSERS = frozenset(("parse_number", "parse_value", "scan_from"))
_WORD = re.compile(r"[A-Za-z_]\w*")
_NOTE = re.compile(r":[^\]:]*\]")  # `R[1:count]`: what a controller shows of a register is no name in the text
Key = int | tuple[int, str]


@dataclass(slots=True)
class Wholes:
    """`fractional` are places that may hold a fraction; every other number place is whole. `counters` are stand-ins for
    the own counters of loops, by the loop's identity."""

    scopes: ProgramScope
    fractional: set[Key] = field(default_factory=set)
    flows: list[tuple[Key, ir.Expression, Scope]] = field(default_factory=list)
    equal: defaultdict[Key, set[Key]] = field(default_factory=lambda: defaultdict(set))
    counters: dict[int, ir.Variable] = field(default_factory=dict)
    retained: set[Key] = field(default_factory=set)
    counting: set[Key] = field(default_factory=set)

    @classmethod
    def of(cls, program: ir.Program, scopes: ProgramScope) -> Wholes:
        wholes = cls(scopes)
        for module in program.modules:
            _Collector(wholes, scopes.module(module)).declarations(module.declarations)
            for routine in module.routines:
                collector = _Collector(wholes, scopes.routine(module, routine))
                collector.declarations(routine.declarations)
                for body in bodies(routine):
                    collector.body(body)
        wholes.settle()
        return wholes

    def settle(self) -> None:
        pending = list(self.flows)
        fed = {place for place, _, _ in pending} | {key for key, others in self.equal.items() if others}
        for _, routine in self.scopes.routines():  # what only other programs pass may be anything
            self.fractional.update(id(one) for one in routine.parameters if id(one) not in fed)
        self.fractional |= self.retained - self.counted()
        self.fractional.update(place for place, value, scope in pending if _multiplied(place, value, scope))
        for key in list(self.fractional):
            self.demote(key)
        changed = True
        while changed:
            changed = False
            kept = []
            for flow in pending:
                place, value, scope = flow
                if place in self.fractional:
                    continue
                if self.whole(value, scope):
                    kept.append(flow)
                else:
                    self.demote(place)
                    changed = True
            pending = kept

    def counted(self) -> set[Key]:
        """What the program counts with, also by handing its value on to what it counts with."""
        givers: defaultdict[Key, list[Key]] = defaultdict(list)
        for place, value, scope in self.flows if self.retained else ():
            key = place_key(value, scope)
            if key is not None:
                givers[place].append(key)
        done, work = set(self.counting), list(self.counting)
        while work:
            one = work.pop()
            for key in (*givers.get(one, ()), *self.equal.get(one, ())):
                if key not in done:
                    done.add(key)
                    work.append(key)
        return done

    def demote(self, key: Key) -> None:
        work = [key]
        while work:
            one = work.pop()
            self.fractional.add(one)
            work.extend(other for other in self.equal[one] if other not in self.fractional)

    def is_whole(self, key: Key) -> bool:
        """Does the place hold whole numbers only?"""
        return key not in self.fractional

    def counts_whole(self, loop: ir.For) -> bool:
        """Does the loop's own counter?"""
        counter = self.counters.get(id(loop))
        return counter is not None and self.is_whole(id(counter))

    def whole(self, value: ir.Expression, scope: Scope) -> bool:
        """Does the expression give a whole number, as far as is known now?"""
        match value:
            case ir.IntLiteral(value=number):
                return abs(number) <= LARGEST
            case ir.RealLiteral(value=number, spelling=spelling):
                return number.is_integer() and abs(number) <= LARGEST and bool(spelling) and spelling.isdigit()
            case ir.Name() | ir.Index() | ir.Field():
                key = place_key(value, scope)
                type = type_of(value, scope)
                if isinstance(type, ir.IntType):
                    return True
                return isinstance(type, ir.RealType) and key is not None and self.is_whole(key)
            case ir.Unary(op="-" | "+", operand=operand):
                return self.whole(operand, scope)
            case ir.Binary(op="+" | "-" | "*", left=left, right=right):
                return self.whole(left, scope) and self.whole(right, scope)
            case ir.Binary(op="div" | "mod" | "band" | "bor" | "bxor"):
                return True
            case ir.Convert(how=how):
                return how in ("round_half_away", "trunc", "bit", "code")
            case ir.Builtin(function="round" | "trunc", arguments=arguments):
                return len(arguments) == 1
            case ir.Builtin(function="abs" | "min" | "max", arguments=arguments):
                return all(self.whole(argument, scope) for argument in arguments)
            case ir.Builtin(function=function):
                return function in _WHOLE_FUNCTIONS
            case ir.Call(name=name):
                routine = scope.routine(name)
                if routine is None:
                    return False
                return isinstance(routine.returns, ir.IntType) or self.is_whole(id(routine))
            case ir.System(name=name):
                return name in _WHOLE_SYSTEM or isinstance(type_of(value, scope), ir.IntType)
            case ir.Signal():
                return isinstance(type_of(value, scope), ir.IntType)
        return False


def _multiplied(place: Key, value: ir.Expression, scope: Scope) -> bool:
    """Does the variable or component get a multiple of itself? Such a number soon has more than 31 bits, which reals
    can hold. Only where the source's own reals have 4 bytes: then REAL loses nothing that they do not lose."""
    if scope.rules.real_bits != _SINGLE_BITS:
        return False
    work = [(value, False)]
    while work:
        one, inside = work.pop()
        match one:
            case ir.Binary(op="+" | "-" | "*" as op, left=left, right=right):
                work.extend(((left, inside or op == "*"), (right, inside or op == "*")))
            case ir.Unary(op="-" | "+", operand=operand):
                work.append((operand, inside))
            case ir.Name() | ir.Field():
                if inside and place_key(one, scope) == place:
                    return True
    return False


def _is_whole(value: ir.Expression) -> bool:
    """Is it a whole number that is written out?"""
    return isinstance(value, ir.IntLiteral | ir.RealLiteral) and float(value.value).is_integer()


def place_key(place: ir.Expression, scope: Scope) -> Key | None:
    """What a number place belongs to: its declaration, or the field of its record."""
    match place:
        case ir.Name(id=name):
            symbol = scope.value(name)
            if symbol is None or isinstance(symbol.declaration, ir.SignalDeclaration):
                return None  # what a signal brings is in its own type: an analog one has a fraction
            return id(symbol.declaration)
        case ir.Index(base=base):
            return place_key(base, scope)
        case ir.Field(base=base, name=name):
            type = type_of(base, scope)
            if isinstance(type, ir.NamedType):
                record = scope.type(type.name)
                return (id(record), name.lower()) if isinstance(record, ir.RecordDeclaration) else None
    return None


class _Collector:
    """Writes down what flows where, in one scope."""

    def __init__(self, wholes: Wholes, scope: Scope) -> None:
        self.wholes, self.scope = wholes, scope

    def flow(self, key: Key | None, value: ir.Expression) -> None:
        if key is not None:
            self.wholes.flows.append((key, value, self.scope))

    def declarations(self, declarations: tuple[ir.Declaration, ...]) -> None:
        for one in declarations:
            match one:
                case ir.Variable(type=type, initial=initial):
                    if one.storage == "persistent":
                        self.wholes.retained.add(id(one))
                    if initial is not None:
                        self.value(id(one), initial, self.scope.resolve(type))
                case ir.Initialise(assign=assign):
                    self.body((assign,))

    def value(self, key: Key | None, value: ir.Expression, type: ir.Type | None) -> None:
        """A value of a type that goes to a place: its numbers flow to the place or to the fields of its record."""
        match type, value:
            case ir.RealType(), _:
                self.flow(key, value)
            case ir.ArrayType(element=element, dimensions=dimensions), ir.Aggregate(entries=entries):
                rest = dimensions[1:]
                inner = ir.ArrayType(element, rest) if rest else self.scope.resolve(element)
                for _, entry in entries:
                    self.value(key, entry, inner)
            case ir.ArrayType(), ir.Name() | ir.Index() | ir.Field():
                self.unite(key, place_key(value, self.scope))
            case ir.ArrayType(), ir.Call(name=called) if (routine := self.scope.routine(called)) is not None:
                self.unite(key, id(routine))
            case ir.ArrayType(), _ if key is not None:
                self.wholes.fractional.add(key)  # a list that nothing is known of
            case ir.NamedType(name=name), ir.Aggregate(entries=entries):
                self.record(name, entries)

    def record(self, name: str, entries: tuple[tuple[str | None, ir.Expression], ...]) -> None:
        record = self.scope.type(name)
        if not isinstance(record, ir.RecordDeclaration):
            return
        fields = {field.lower(): type for field, type in record.fields}
        names = component_names(ir.NamedType(name), self.scope)
        for at, (written, entry) in enumerate(entries):
            key = (written or (names[at] if at < len(names) else "")).lower()
            if key in fields:
                self.value((id(record), key), entry, self.scope.resolve(fields[key]))

    def unite(self, one: Key | None, other: Key | None) -> None:
        if one is not None and other is not None:
            self.wholes.equal[one].add(other)
            self.wholes.equal[other].add(one)

    def fractional(self, place: ir.Expression | None) -> None:
        key = place_key(place, self.scope) if place is not None else None
        if key is not None:
            self.wholes.fractional.add(key)

    def body(self, body: ir.Body) -> ir.Body:
        for statement in body:
            self.statement(statement)
        return body

    def statement(self, statement: ir.Statement) -> None:
        match statement:
            case ir.Assign(target=target, value=value):
                if isinstance(value, ir.Binary) and value.op in "+-" and value.left == target:
                    self.counting(value.left)
                self.value(place_key(target, self.scope), value, type_of(target, self.scope))
            case ir.Return(value=value) if value is not None and self.scope.routine_here is not None:
                routine = self.scope.routine_here
                self.value(id(routine), value, self.scope.resolve(routine.returns) if routine.returns else None)
            case ir.CallRoutine(name=name, arguments=arguments, dynamic=dynamic):
                self.passed(name, arguments, dynamic is not None)
            case ir.For():
                self.loop(statement)
                return
            case ir.Switch(selector=selector):
                self.counting(selector)
            case ir.Do(procedure=procedure, arguments=arguments):
                self.procedure(procedure, arguments)
            case ir.Dialog(answer=answer, kind="number"):
                self.fractional(answer)
            case ir.Vendor(text=text):
                for word in set(_WORD.findall(_NOTE.sub("]", text))):
                    self.fractional(ir.Name(word))
        rewrite_parts(statement, self.expression, self.body)

    def procedure(self, procedure: str, arguments: tuple[ir.Expression | None, ...]) -> None:
        if procedure in ("increment", "decrement"):
            self.counting(*arguments)
        if procedure in ("increment", "decrement") and len(arguments) > 1 and arguments[0] and arguments[1]:
            self.flow(place_key(arguments[0], self.scope), arguments[1])
        if procedure in _PARSERS:
            for argument in arguments:
                self.fractional(argument)

    def counting(self, *values: ir.Expression | None) -> None:
        """Notes what such a value is calculated from."""
        for node in walk(tuple(value for value in values if value is not None)):
            if isinstance(node, ir.Name | ir.Index | ir.Field):
                key = place_key(node, self.scope)
                self.wholes.counting.update(() if key is None else (key,))

    def loop(self, loop: ir.For) -> None:
        self.counting(loop.start, loop.stop, loop.step)
        outer = self.scope
        key: Key | None
        if loop.scoped:
            counter = ir.Variable(loop.counter, ir.RealType(), origin=loop.origin)
            self.wholes.counters[id(loop)] = counter
            key, inner = id(counter), outer.with_value(counter)
        else:
            key, inner = place_key(ir.Name(loop.counter), outer), outer
        for part in (loop.start, loop.step):
            if part is not None:
                self.flow(key, part)
                self.expression(part)
        self.expression(loop.stop)
        self.scope = inner
        self.body(loop.body)
        self.scope = outer

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Call(name=name, arguments=given):
                self.passed(name, given, False)
            case ir.Index(indices=indices):
                self.counting(*indices)
            case ir.Binary(op="div" | "mod" | "band" | "bor" | "bxor", left=left, right=right):
                self.counting(left, right)
            case ir.Binary(op="=" | "<>", left=left, right=right) if _is_whole(left) or _is_whole(right):
                self.counting(left, right)
            case ir.Builtin(function=function, arguments=arguments) if function in _PARSERS:
                self.procedure(function, arguments)
        return rewrite_parts(expression, self.expression)

    def passed(self, name: str, arguments: tuple[ir.Argument, ...], dynamic: bool) -> None:
        routine = self.scope.routine(name)
        if routine is None or dynamic:
            for argument in arguments:
                self.fractional(argument.value)
            if dynamic:
                self.any_routine(arguments)
            return
        required = [one for one in routine.parameters if not one.optional]
        by_name = {one.name.lower(): one for one in routine.parameters}
        for at, argument in enumerate(arguments):
            named = by_name.get(argument.name.lower()) if argument.name else None
            parameter = named or (required[at] if not argument.name and at < len(required) else None)
            if parameter is None or argument.value is None:
                continue
            type = self.scope.resolve(parameter.type)
            self.value(id(parameter), argument.value, type)
            if parameter.mode != "value":
                self.unite(id(parameter), place_key(argument.value, self.scope))

    def any_routine(self, arguments: tuple[ir.Argument, ...]) -> None:
        """A call by name at run time may reach every routine with that many parameters."""
        for _, routine in self.wholes.scopes.routines():
            if len(routine.parameters) == len(arguments):
                self.wholes.fractional.update(id(one) for one in routine.parameters)
