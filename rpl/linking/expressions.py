"""Expressions compiled to closures over a frame's values. Calls of user functions are not here: `flatten` has moved
them in front of their statement.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rpl import ir
from rpl.errors import InternalError
from rpl.linking.operators import (
    NUMBERS,
    OPERATIONS,
    WITH_NUMBER,
    bounded,
    converted,
    divided,
    equality,
    logic,
    rounded,
    scaled,
    single,
    single_number,
    whole_product,
)
from rpl.linking.signalreads import signal_reader
from rpl.linking.types import Types
from rpl.passes.scope import Scope
from rpl.runtime import answers
from rpl.runtime.code import Read, Values
from rpl.runtime.faults import ProgramError
from rpl.runtime.functions import neutral, system
from rpl.runtime.signals import as_port, number_from
from rpl.runtime.values import (
    MUTABLE,
    Array,
    Member,
    SignalRef,
    Value,
    copied,
    is_unset,
    whole,
)

if TYPE_CHECKING:
    from rpl.linking.symbols import Symbols

_COMPARING = frozenset(("<", ">", "<=", ">=", "=", "<>"))
# Operators of whole numbers, texts and places: nothing of theirs is rounded.
_OF_WHOLES = frozenset(("band", "bor", "bxor", "&", ":", "@"))
# A name that stands for a place in the frame: what flattening and loops make.
HIDDEN = "\0"


Precision = Callable[[Value], Value]


@dataclass(frozen=True, slots=True)
class Place:
    """Where a variable lives: in the frame or among the globals, directly or as a reference."""

    number: int
    is_global: bool = False
    is_reference: bool = False
    watched: bool = False


def hidden(place: int) -> ir.Name:
    return ir.Name(f"{HIDDEN}{place}")


CompileProcedure = Callable[["Compiler", str, tuple[ir.Expression | None, ...]], Read]
CompileAssuming = Callable[["Compiler", ir.Expression, Read, bool], Read | None]


class Compiler:
    """Compiles expressions of one routine (or of a module's declarations). `procedure`: how the call of a neutral
    procedure is compiled, which writes to places; `assuming`: how a place is read that gets a value where it has none
    (see the module of that name)."""

    def __init__(self, linked: Symbols, scope: Scope, procedure: CompileProcedure, assuming: CompileAssuming) -> None:
        self.linked = linked
        self.procedure = procedure
        self.assuming = assuming
        self.scope = scope
        self.types: Types = linked.types(scope)
        self.unset = scope.rules.undefined
        self.two_types = any(isinstance(one, ir.IntType) for one in scope.rules.type_names.values())
        self.single: Precision | None = None
        if scope.rules.real_bits == 24:
            self.single = single_number if scope.rules.whole_bits == 24 else single
        self.places: dict[str, Place] = {}
        self.size = 1

    def new_place(self) -> int:
        """Another place in the frame."""
        self.size += 1
        return self.size - 1

    # ---- names

    def place_of(self, name: str) -> Place | ir.SignalDeclaration | None:
        """Where a name lives; its declaration when it is an alias of a signal; None when nothing is known."""
        if name.startswith(HIDDEN):
            return Place(int(name[1:]))
        key = self.scope.fold(name)
        found = self.places.get(key)
        if found is not None:
            return found
        symbol = self.scope.value(name)
        if symbol is None:
            return None
        declaration = symbol.declaration
        if isinstance(declaration, ir.SignalDeclaration):
            return declaration
        if isinstance(declaration, ir.Parameter):
            return None
        declaration, module = self.linked.home_of(declaration, symbol.module, self.scope.module.dialect)
        number = self.linked.slot(declaration, module)
        return Place(number, True, watched=self.linked.slots[number].watched)

    def name(self, expression: ir.Name, checked: bool = True) -> Read:
        place = self.place_of(expression.id)
        if place is None:
            return unknown(expression.id)
        if isinstance(place, ir.SignalDeclaration):
            return self.signal(place.signal)
        raw = _raw(place)
        if not checked or not (self.unset or place.is_reference) or expression.id.startswith(HIDDEN):
            return raw
        return self.assumed(expression, raw) or _checked(raw, place, expression.id)

    def assumed(self, expression: ir.Expression, raw: Read, goal: bool = False) -> Read | None:
        """What reads the place in a run that goes on where data has no value; None in any other, and where there is no
        value to assume. goal: a move goes there."""
        return self.assuming(self, expression, raw, goal) if self.linked.assumes else None

    # ---- entry

    def value(self, expression: ir.Expression) -> Read:
        """A closure that gives the expression's value."""
        constant = self.constant(expression)
        if constant is not None:
            return constant
        match expression:
            case ir.Name():
                return self.name(expression)
            case ir.Index() | ir.Field():
                return self.part(expression)
            case ir.Unary():
                return self.unary(expression)
            case ir.Binary():
                return self.binary(expression)
            case ir.Builtin():
                return self.builtin(expression)
            case ir.Aggregate():
                return self.aggregate(expression)
            case ir.System():
                return self.system(expression)
            case ir.Signal():
                return self.signal(expression)
            case ir.Quantity(value=value, unit=unit):
                return scaled(self.value(value), ir.UNITS[unit])
            case ir.Magnitude(value=value, unit=unit):
                return divided(self.value(value), ir.UNITS[unit])
            case ir.Convert(how=how, operand=operand):
                return self.in_range(expression, converted(how, self.value(operand)))
            case ir.Present(name=name):
                place = self.place_of(name)
                if not isinstance(place, Place):
                    return unknown(name)
                number = place.number
                return lambda f: f[number] is not None
            case ir.VendorValue(text=text):
                return lambda f: answers.vendor_value(f[0].machine, text)
            case ir.Call(name=name):
                raise InternalError(f"the call of {name} was not moved in front of its statement")
        raise InternalError(f"no code for {expression.__class__.__name__}")

    def constant(self, expression: ir.Expression) -> Read | None:
        """Literals, and aggregates and signs of literals, are evaluated once."""
        value: Value
        match expression:
            case ir.IntLiteral(value=value) | ir.RealLiteral(value=value):
                pass
            case ir.BoolLiteral(value=value) | ir.TextLiteral(value=value):
                pass
            case ir.EnumLiteral(member=member):
                value = Member(member.lower())
            case ir.Unary(op="-", operand=ir.IntLiteral(value=number) | ir.RealLiteral(value=number)):
                value = -number
            case ir.Quantity(value=ir.IntLiteral(value=number) | ir.RealLiteral(value=number), unit=unit):
                value = number * ir.UNITS[unit]
            case _:
                return None
        return lambda f: value

    def copy_of(self, expression: ir.Expression) -> Read:
        """A value to keep: records and arrays are copied, unless they were made just now."""
        read = self.value(expression)
        match expression:
            case ir.Name() | ir.Index() | ir.Field():
                return lambda f: copied(read(f))
        return read

    # ---- parts of structures

    def part(self, expression: ir.Index | ir.Field) -> Read:
        raw = self.raw_part(expression)
        what = _words(expression)
        if self.unset:
            assumed = self.assumed(expression, raw)
            if assumed is not None:
                return assumed

            def checked(f: Values) -> Value:
                value = raw(f)
                if value is None:
                    raise ProgramError("no_value", f"{what} has no value yet")
                return value

            return checked

        def or_zero(f: Values) -> Value:
            value = raw(f)
            return value if value is not None else 0.0

        return or_zero

    def raw_part(self, expression: ir.Index | ir.Field) -> Read:
        """A component as it is stored; None when it has no value."""
        base = self.raw(expression.base)
        if isinstance(expression, ir.Field):
            name = self.field_name(expression)
            return lambda f: base(f).get(name)
        indices = [self.value(index) for index in expression.indices]
        if len(indices) == 1:
            return _element(base, indices[0])
        for index in indices:
            base = _element(base, index)
        return base

    def field_name(self, expression: ir.Field) -> str:
        """The key of a component: neutral names as they are, a record's own folded."""
        return self.scope.fold(expression.name)

    def raw(self, expression: ir.Expression) -> Read:
        """Like value, without a complaint about what has no value."""
        match expression:
            case ir.Name():
                return self.name(expression, checked=False)
            case ir.Index() | ir.Field():
                return self.raw_part(expression)
        return self.value(expression)

    # ---- operators

    def unary(self, expression: ir.Unary) -> Read:
        operand = self.value(expression.operand)
        match expression.op:
            case "-":
                return lambda f: -operand(f)
            case "+":
                return operand
            case "not":
                return lambda f: not operand(f)
        return lambda f: ~whole(operand(f))

    def binary(self, expression: ir.Binary) -> Read:
        op = expression.op
        if op in ("and", "or", "xor", "cand", "cor"):
            return logic(op, self.value(expression.left), self.value(expression.right))
        left, right = self.operand(expression.left), self.operand(expression.right)
        if op in ("=", "<>"):
            return equality(op, left, right, self._is_plain(expression.left) or self._is_plain(expression.right))
        if op == "*" and self._is_whole(expression.left) and self._is_whole(expression.right):
            return self.in_range(expression, whole_product(left, right))
        done = self.operation(op, left, right, _constant_number(expression.right))
        if op in _COMPARING:
            return done
        if self.single is not None and op not in _OF_WHOLES:
            done = rounded(done, self.single)
        return self.in_range(expression, done) if op in ("+", "-") else done

    def operation(self, op: str, left: Read, right: Read, number: float | None) -> Read:
        if number is not None and op in WITH_NUMBER:
            return WITH_NUMBER[op](left, number if self.single is None else self.single(number))
        operation = OPERATIONS[op]
        if op in NUMBERS:
            return NUMBERS[op](left, right)
        return lambda f: operation(left(f), right(f))

    def operand(self, expression: ir.Expression) -> Read:
        """An operand in the precision of the language: what was not calculated with (a component of a place, a result
        of a function) may have more."""
        if self.single is None:
            return self.value(expression)
        number = _constant_number(expression)
        if number is not None:
            fixed = self.single(number)
            return lambda f: fixed
        calculated = isinstance(expression, ir.Binary) and expression.op not in _OF_WHOLES
        logical = isinstance(expression, ir.BoolLiteral | ir.TextLiteral | ir.EnumLiteral)
        read = self.value(expression)
        return read if calculated or logical else rounded(read, self.single)

    def in_range(self, expression: ir.Expression, read: Read) -> Read:
        """A result that must fit into the language's type of whole numbers."""
        bits = self.scope.rules.whole_bits
        return bounded(read, bits) if bits < 64 and self.two_types and self._is_whole(expression) else read

    def _is_whole(self, expression: ir.Expression) -> bool:
        return isinstance(self.types.of(expression), ir.IntType)

    def _is_plain(self, expression: ir.Expression) -> bool:
        """Certainly a number, BOOL, text or member: compared by Python's own equality."""
        match expression:
            case ir.IntLiteral() | ir.RealLiteral() | ir.BoolLiteral() | ir.TextLiteral() | ir.EnumLiteral():
                return True
            case ir.Binary(op=op):
                return op not in (":", "@", "+", "-", "*")
            case ir.Unary(op="not") | ir.Convert() | ir.Magnitude():
                return True
        return False

    # ---- functions

    def builtin(self, expression: ir.Builtin) -> Read:
        name = expression.function
        if name in neutral.BY_PLACE:
            return self.by_place(name, expression.arguments)
        if name in ir.PROCEDURES:
            return self.procedure(self, name, expression.arguments)
        if name == "text_length" and self.scope.rules.unset_length:
            text = self.raw(expression.arguments[0])
            return lambda f: len(text(f) or "")
        arguments = [self.value(argument) for argument in expression.arguments]
        pure = neutral.PURE.get(name)
        if pure is not None:
            return _applied(pure, arguments)
        of_task = neutral.OF_TASK.get(name)
        if of_task is None:
            raise InternalError(f"no function {name}")
        called = _place_in_words(expression) if name.startswith("target_to_joints") else ""
        if called:
            return _telling(of_task, arguments, called)
        return lambda f: of_task(f[0], *[argument(f) for argument in arguments])

    def by_place(self, name: str, arguments: tuple[ir.Expression, ...]) -> Read:
        argument = arguments[0]
        if name == "is_uninitialised":
            place = self.place_of(argument.id) if isinstance(argument, ir.Name) else None
            if isinstance(place, Place) and place.is_reference:
                number = place.number
                return lambda f: f[number] is None or is_unset(f[number].get())
            read = self.raw(argument)
            return lambda f: is_unset(read(f))
        capacity = self.capacity(argument)
        if capacity is not None:
            return lambda f: capacity
        read = self.raw(argument)
        return lambda f: len(read(f) or "")

    def capacity(self, expression: ir.Expression) -> int | None:
        """The declared capacity of a text variable."""
        type = self.types.of(expression)
        if isinstance(type, ir.StringType) and isinstance(type.capacity, ir.IntLiteral):
            return type.capacity.value
        return None

    # ---- aggregates

    def aggregate(self, expression: ir.Aggregate) -> Read:
        type = self.types.aggregate_type(expression)
        values = [self.copy_of(value) for _, value in expression.entries]
        if type is None or isinstance(type, ir.ArrayType):
            base = self.scope.rules.array_base
            return lambda f: Array([value(f) for value in values], base)
        names = self.types.positions(type)
        fold = self.scope.fold if isinstance(type, ir.NamedType) else str
        keys = []
        for position, (written, _) in enumerate(expression.entries):
            if written is None and position >= len(names):
                return _failing("wrong_kind", "the list has more elements than the type has components")
            keys.append(fold(written if written is not None else names[position]))
        types, known = self.types, type
        if all(self.constant(value) is not None or _is_constant(value) for _, value in expression.entries):
            return _once(lambda f: types.composed(known, {k: v(f) for k, v in zip(keys, values, strict=True)}))
        return lambda f: types.composed(known, {k: v(f) for k, v in zip(keys, values, strict=True)})

    # ---- system variables and signals

    def system(self, expression: ir.System) -> Read:
        read = system.READ[expression.name]
        if not expression.indices:
            return lambda f: read(f[0], 1)
        index = self.value(expression.indices[0])
        return lambda f: read(f[0], whole(index(f)))

    def port(self, signal: ir.Signal) -> Callable[[Values], SignalRef] | SignalRef:
        """The physical signal that an expression means; a closure when only running can tell."""
        kind = signal.kind
        if signal.name is not None:
            place = self.place_of(signal.name)
            if isinstance(place, ir.SignalDeclaration):
                return self.port(place.signal)
            if isinstance(place, Place):
                held = self.name(ir.Name(signal.name))
                return lambda f: as_port(held(f), kind)
            return SignalRef(kind, name=signal.name)
        first = _constant_number(signal.index)
        last = _constant_number(signal.last)
        if first is not None and (signal.last is None or last is not None):
            return SignalRef(kind, whole(first), None if last is None else whole(last))
        index = self.value(signal.index) if signal.index is not None else None
        end = self.value(signal.last) if signal.last is not None else None
        least = self.scope.rules.first_signal
        return lambda f: SignalRef(
            kind, number_from(index(f), least) if index is not None else 0, whole(end(f)) if end is not None else None
        )

    def signal(self, expression: ir.Signal) -> Read:
        return signal_reader(self.port(expression), expression.kind)


def _words(expression: ir.Expression) -> str:
    """A variable's part as people write it, for messages."""
    match expression:
        case ir.Name(id=name):
            return "a result" if name.startswith(HIDDEN) else name
        case ir.Field(base=base, name=name):
            return f"{_words(base)}.{name}"
        case ir.Index(base=base):
            return f"an element of {_words(base)}"
    return "this"


# ---- closures


def unknown(name: str) -> Read:
    return _failing("unknown_data", f"{name} is not declared in what was read")


def _failing(error: str, message: str) -> Read:
    def fail(f: Values) -> Value:
        raise ProgramError(error, message)

    return fail


def _raw(place: Place) -> Read:
    number = place.number
    if place.is_global:
        return lambda f: f[0].g[number]
    if place.is_reference:

        def through(f: Values) -> Value:
            reference = f[number]
            if reference is None:
                raise ProgramError("not_present", "the optional argument is not present")
            return reference.get()

        return through
    return operator.itemgetter(number)


def _checked(raw: Read, place: Place, name: str) -> Read:
    number = place.number
    if place.is_global:

        def of_globals(f: Values) -> Value:
            value = f[0].g[number]
            if value is None:
                raise ProgramError("no_value", f"{name} has no value yet")
            return value

        return of_globals
    if place.is_reference:

        def of_reference(f: Values) -> Value:
            value = raw(f)
            if value is None:
                raise ProgramError("no_value", f"{name} has no value yet")
            return value

        return of_reference

    def of_frame(f: Values) -> Value:
        value = f[number]
        if value is None:
            raise ProgramError("no_value", f"{name} has no value yet")
        return value

    return of_frame


def _element(base: Read, index: Read) -> Read:
    def read(f: Values) -> Value:
        array = base(f)
        place = index(f)
        if array.__class__ is Array:
            return array.items[array.at(place)]
        if isinstance(array, str) or array is None:
            at = whole(place) - 1
            if array is None or at < 0:
                raise ProgramError("no_value" if array is None else "out_of_range", "there is no such character")
            return array[at] if at < len(array) else "\0"
        raise ProgramError("wrong_kind", "only arrays and texts have elements")

    return read


def _constant_number(expression: ir.Expression | None) -> float | None:
    match expression:
        case ir.IntLiteral(value=value) | ir.RealLiteral(value=value):
            return value
        case ir.Unary(op="-", operand=ir.IntLiteral(value=value) | ir.RealLiteral(value=value)):
            return -value
    return None


def _is_constant(expression: ir.Expression) -> bool:
    match expression:
        case ir.Aggregate(entries=entries, type_name=name):
            return name is not None and all(_is_constant(value) for _, value in entries)
        case ir.IntLiteral() | ir.RealLiteral() | ir.BoolLiteral() | ir.TextLiteral() | ir.EnumLiteral():
            return True
        case ir.Unary(operand=operand):
            return _is_constant(operand)
    return False


def _once(make: Read) -> Read:
    """A structure of literals: made at its first use; a mutable one is copied for each user."""
    kept: list[Value] = []

    def read(f: Values) -> Value:
        if not kept:
            kept.append(make(f))
        value = kept[0]
        return value.copy() if value.__class__ in MUTABLE else value

    return read


def _telling(function: Callable[..., Value], arguments: list[Read], called: str) -> Read:
    """A function that tells by name what cannot be reached."""

    def read(f: Values) -> Value:
        try:
            return function(f[0], *[argument(f) for argument in arguments])
        except ProgramError as error:
            if error.name == "unreachable":
                raise ProgramError(error.name, f"{error.message} ({called})") from None
            raise

    return read


def _place_in_words(call: ir.Builtin) -> str:
    """Target, tool and frame of inverse kinematics, as far as the program has names for them."""
    target, *reference = call.arguments
    if call.function.endswith("_near"):
        reference = reference[1:]
    told = zip(("", "tool ", "frame "), (target, *reference), strict=False)
    return ", ".join(word + one.id for word, one in told if isinstance(one, ir.Name))


def _applied(function: Callable[..., Value], arguments: list[Read]) -> Read:
    if len(arguments) == 1:
        only = arguments[0]
        return lambda f: function(only(f))
    if len(arguments) == 2:
        first, second = arguments
        return lambda f: function(first(f), second(f))
    return lambda f: function(*[argument(f) for argument in arguments])
