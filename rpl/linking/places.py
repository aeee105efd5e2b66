"""What can be written: variables, elements, components, signals, system variables; and references to them."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from rpl import ir
from rpl.errors import InternalError
from rpl.ir.rules import Range, refusal
from rpl.ir.walk import walk
from rpl.linking.expressions import HIDDEN, Compiler, Place, unknown
from rpl.linking.types import no_bound
from rpl.runtime.code import (
    AnyRef,
    CallRef,
    ComponentRef,
    Instruction,
    PartRef,
    Read,
    Ref,
    Values,
    WatchedRef,
    Write,
)
from rpl.runtime.faults import ProgramError
from rpl.runtime.functions import procedures, system
from rpl.runtime.values import Array, Record, SignalRef, Value, whole
from rpl.source import Origin

if TYPE_CHECKING:
    from rpl.linking.assembler import Make

MakeRef = Callable[[Values], AnyRef]


def writer(compiler: Compiler, target: ir.Expression, origin: Origin) -> Write:
    """A closure that writes a value to the place that an expression names; one that the controller does not take for
    such a quantity is a fault there."""
    allowed, write = _allowed(compiler, target), _writer(compiler, target, origin)
    return write if allowed is None else _within(*allowed, write)


def _allowed(compiler: Compiler, target: ir.Expression) -> tuple[str, Range] | None:
    """Name and values of what the controller takes only some values of."""
    inputs = compiler.scope.rules.inputs
    match target:
        case ir.System(name=name):
            found = inputs.range_of(name)
        case ir.Name(id=name) | ir.Index(base=ir.Name(id=name)):
            found = inputs.range_of_variable(name) if inputs.variable_ranges else None
        case _:
            return None
    return (name, found) if found is not None else None


def _within(name: str, allowed: Range, write: Write) -> Write:
    def held(f: Values, value: Value) -> None:
        why = refusal(name, value, allowed) if isinstance(value, int | float) else ""
        if why:
            raise ProgramError("bad_value", why)
        write(f, value)

    return held


def _writer(compiler: Compiler, target: ir.Expression, origin: Origin) -> Write:
    match target:
        case ir.Name(id=name):
            return _write_name(compiler, name, origin)
        case ir.Index():
            return _write_element(compiler, target, origin)
        case ir.Field():
            return _write_component(compiler, target, origin)
        case ir.Signal():
            return _write_signal(compiler, target, origin)
        case ir.System(name=name, indices=indices):
            write = system.WRITE.get(name)
            if write is None:
                return _refused(f"the system variable {name} cannot be written")
            if not indices:
                if ir.SYSTEM_VARIABLES[name].indexed and name not in system.SPECIAL_WRITE:
                    write_all = system.write_all(name)
                    return lambda f, value: write_all(f[0], value)
                return lambda f, value: write(f[0], 1, value)
            index = compiler.value(indices[0])
            return lambda f, value: write(f[0], whole(index(f)), value)
        case ir.Convert(operand=operand):
            return _writer(compiler, operand, origin)
    return _refused("this cannot be written to")


def _refused(message: str) -> Write:
    def refuse(f: Values, value: Value) -> None:
        raise ProgramError("wrong_kind", message)

    return refuse


def _write_name(compiler: Compiler, name: str, origin: Origin) -> Write:
    place = compiler.place_of(name)
    if place is None:
        missing = unknown(name)
        return lambda f, value: missing(f)
    if isinstance(place, ir.SignalDeclaration):
        return _write_signal(compiler, place.signal, origin)
    number = place.number
    if place.is_reference:

        def through(f: Values, value: Value) -> None:
            reference = f[number]
            if reference is None:
                raise ProgramError("not_present", f"the optional argument {name} is not present")
            reference.set(value)

        return through
    if not place.is_global:

        def local(f: Values, value: Value) -> None:
            f[number] = value

        return local
    if place.watched:

        def watched(f: Values, value: Value) -> None:
            task = f[0]
            task.g[number] = value
            task.machine.changed()

        return watched

    def plain(f: Values, value: Value) -> None:
        f[0].g[number] = value

    return plain


def watches(compiler: Compiler, target: ir.Expression) -> bool:
    """May writing there wake somebody, so that interrupts have to be looked at afterwards?"""
    match target:
        case ir.Name(id=name):
            place = compiler.place_of(name)
            return not isinstance(place, Place) or place.watched or place.is_reference
        case ir.Index(base=base) | ir.Field(base=base):
            return watches(compiler, base)
        case ir.Signal():
            return True
        case ir.System(name=name):
            return name in ("flag", "cyclic_flag", "timer", "timer_stopped")
    return False


def _write_element(compiler: Compiler, target: ir.Index, origin: Origin) -> Write:
    """An element of an array, or a character of a text."""
    if len(target.indices) > 1:
        inner = ir.Index(target.base, target.indices[:-1], origin=target.origin)
        return _write_element(compiler, ir.Index(inner, target.indices[-1:], origin=target.origin), origin)
    base, index = compiler.raw(target.base), compiler.value(target.indices[0])
    write_base = writer(compiler, target.base, origin) if _is_place(target.base) else _refused("this cannot be written")
    wakes = watches(compiler, target.base)

    def write(f: Values, value: Value) -> None:
        array = base(f)
        place = index(f)
        if array.__class__ is Array:
            array.items[array.at(place)] = value
            if wakes:
                f[0].machine.changed()
            return
        if array is None or isinstance(array, str):
            at = whole(place) - 1
            text = (array or "").ljust(at)
            if at < 0:
                raise ProgramError("out_of_range", f"a text has no character {place}")
            write_base(f, text[:at] + value + text[at + 1 :])
            return
        raise ProgramError("wrong_kind", "only arrays and texts have elements")

    return write


def _write_component(compiler: Compiler, target: ir.Field, origin: Origin) -> Write:
    base, name = compiler.raw(target.base), compiler.field_name(target)
    write_base = writer(compiler, target.base, origin) if _is_place(target.base) else _refused("this cannot be written")
    wakes = watches(compiler, target.base)
    made = _made(compiler, target.base)

    def write(f: Values, value: Value) -> None:
        whole_value = base(f)
        if whole_value is None and made is not None:  # an argument that was not given: of its type, without values
            whole_value = made()
            write_base(f, whole_value)
        if whole_value.__class__ is Record:
            if name not in whole_value.parts:
                raise ProgramError("wrong_kind", f"there is no component {name}")
            whole_value.parts[name] = value
            if wakes:
                f[0].machine.changed()
        elif whole_value is None:
            raise ProgramError("no_value", "the structure that is written to has no value")
        else:
            write_base(f, whole_value.replaced(name, value))

    return write


def _made(compiler: Compiler, base: ir.Expression) -> Callable[[], Value] | None:
    """What makes a structure of the place's type without values; None for a type that has no components."""
    type = compiler.types.of(base) if compiler.unset else None
    record = isinstance(type, ir.NamedType) and isinstance(compiler.scope.type(type.name), ir.RecordDeclaration)
    if type is None or not (record or type.__class__ in ir.COMPONENTS):
        return None
    return lambda: compiler.types.initial(type, no_bound)


def _is_place(expression: ir.Expression) -> bool:
    return isinstance(expression, ir.Name | ir.Index | ir.Field | ir.System | ir.Signal)


def _write_signal(compiler: Compiler, signal: ir.Signal, origin: Origin) -> Write:
    port = compiler.port(signal)
    if isinstance(port, SignalRef):
        fixed = port

        def write(f: Values, value: Value) -> None:
            task = f[0]
            task.machine.set_output(task, fixed, value, origin)

        return write
    dynamic = port

    def write_dynamic(f: Values, value: Value) -> None:
        task = f[0]
        task.machine.set_output(task, dynamic(f), value, origin)

    return write_dynamic


# ---- references

# What turns a truth into a number, or a number into a truth, makes a value of its own: there is no place behind it.
_MADE_OF_TRUTHS = ("bit", "minus_bit", "truth")


def reference(compiler: Compiler, target: ir.Expression, origin: Origin) -> MakeRef:
    """A closure that gives a reference; indices are evaluated when it is made."""
    match target:
        case ir.Name(id=name):
            return _reference_to_name(compiler, name, target, origin)
        case ir.Index(base=base, indices=indices):
            outer = ir.Index(base, indices[:-1]) if len(indices) > 1 else base
            array = compiler.raw(outer)
            last = compiler.value(indices[-1])
            return _reference_to_element(compiler, array, last, target, origin)
        case ir.Field(base=base):
            inner, read, name = reference(compiler, base, origin), compiler.raw(base), compiler.field_name(target)

            def component(f: Values) -> AnyRef:
                value = read(f)
                if value.__class__ is Record:
                    return PartRef(value.parts, name)
                return ComponentRef(inner(f), name)

            return component
        case ir.Signal() | ir.System():
            return _through_calls(compiler, target, origin)
        case ir.Convert(how=how, operand=operand) if how not in _MADE_OF_TRUTHS:
            return reference(compiler, operand, origin)
    read = compiler.value(target)
    return lambda f: Ref([read(f)], 0)


def _through_calls(compiler: Compiler, target: ir.Expression, origin: Origin) -> MakeRef:
    read, write = compiler.value(target), writer(compiler, target, origin)
    return lambda f: CallRef(f, read, write)


def _reference_to_name(compiler: Compiler, name: str, target: ir.Name, origin: Origin) -> MakeRef:
    place = compiler.place_of(name)
    if place is None:
        missing = unknown(name)
        return lambda f: Ref([missing(f)], 0)
    if isinstance(place, ir.SignalDeclaration):
        return _through_calls(compiler, target, origin)
    number = place.number
    if place.is_reference:
        return lambda f: f[number]
    if place.is_global:
        if place.watched:
            return lambda f: WatchedRef(f[0].g, number, f[0])
        return lambda f: Ref(f[0].g, number)
    return lambda f: Ref(f, number)


def _reference_to_element(compiler: Compiler, array: Read, index: Read, target: ir.Index, origin: Origin) -> MakeRef:
    """An element of an array; a character of a text is written through its text."""
    outer = ir.Index(target.base, target.indices[:-1]) if len(target.indices) > 1 else target.base
    write = writer(compiler, outer, origin) if _is_place(outer) else _refused("this cannot be written")

    def element(f: Values) -> AnyRef:
        value, place = array(f), index(f)
        if value.__class__ is Array:
            return Ref(value.items, value.at(place))
        at = whole(place) - 1

        def put(values: Values, character: Value) -> None:
            text = (array(values) or "").ljust(at)
            write(values, text[:at] + character + text[at + 1 :])

        return CallRef(f, lambda values: (array(values) or "")[at : at + 1] or "\0", put)

    return element


# ---- assignment


def assignment(compiler: Compiler, statement: ir.Assign) -> Make:
    """The instruction of an assignment."""
    target = statement.target
    if isinstance(target, ir.System) and target.name == "cyclic_flag" and target.indices:
        return _binding(compiler, target.indices[0], statement.value)
    if isinstance(target, ir.Magnitude):  # a unit on the written side goes to the value
        moved = ir.Quantity(statement.value, target.unit, origin=statement.value.origin)
        return assignment(compiler, ir.Assign(target.value, moved, origin=statement.origin))
    read = compiler.copy_of(statement.value)
    read = _fitted(compiler, target, statement.value, read)
    if watches(compiler, target):
        return _attentive(writer(compiler, target, statement.origin), read)
    if isinstance(target, ir.Name) and _allowed(compiler, target) is None:
        place = compiler.place_of(target.id)
        assert isinstance(place, Place)  # others are watched
        return _store_global(place.number, read) if place.is_global else _store_local(place.number, read)
    write = writer(compiler, target, statement.origin)

    def make(here: int, next: int) -> Instruction:
        def assign(f: Values) -> int:
            write(f, read(f))
            return next

        return assign

    return make


def _binding(compiler: Compiler, number: ir.Expression, value: ir.Expression) -> Make:
    """A cyclic flag keeps the expression, not its value: who reads the flag evaluates it in this routine's frame."""
    index, read = compiler.value(number), compiler.value(value)
    called = any(isinstance(node, ir.Name) and node.id.startswith(HIDDEN) for node in walk(value))

    def make(here: int, next: int) -> Instruction:
        def bind(f: Values) -> int:
            if called:
                raise ProgramError("wrong_kind", "a cyclic flag cannot call a routine of the program")
            task = f[0]
            task.machine.cyclic[whole(index(f))] = (f, read)
            task.machine.changed()
            return next if not task.interrupts.pending and not task.triggers else task.attention(next)

        return bind

    return make


def _fitted(compiler: Compiler, target: ir.Expression, value: ir.Expression, read: Read) -> Read:
    """A text must fit into its variable."""
    if isinstance(target, ir.Name) and target.id.startswith("\0"):
        return read
    if not isinstance(target, ir.Name | ir.Index | ir.Field) or isinstance(value, ir.IntLiteral | ir.RealLiteral):
        return read
    capacity = compiler.capacity(target)
    if capacity is None and isinstance(compiler.types.of(target), ir.StringType):
        capacity = compiler.scope.rules.text_length
    if not capacity:
        return read
    most = capacity

    def fitted(f: Values) -> Value:
        text = read(f)
        if isinstance(text, str) and len(text) > most:
            raise ProgramError("text_too_long", f"a text of {len(text)} characters does not fit into {most}")
        return text

    return fitted


def _attentive(write: Write, read: Read) -> Make:
    def make(here: int, next: int) -> Instruction:
        def assign(f: Values) -> int:
            write(f, read(f))
            task = f[0]
            return next if not task.interrupts.pending and not task.triggers else task.attention(next)

        return assign

    return make


def _store_local(number: int, read: Read) -> Make:
    def make(here: int, next: int) -> Instruction:
        def assign(f: Values) -> int:
            f[number] = read(f)
            return next

        return assign

    return make


def _store_global(number: int, read: Read) -> Make:
    def make(here: int, next: int) -> Instruction:
        def assign(f: Values) -> int:
            f[0].g[number] = read(f)
            return next

        return assign

    return make


# ---- built-in procedures

# Which arguments of a procedure are written, by the letters of its row (see ir.builtins).


def procedure(compiler: Compiler, name: str, arguments: tuple[ir.Expression | None, ...]) -> Read:
    """The call of a neutral procedure as a closure that gives its value."""
    row = ir.PROCEDURES.get(name)
    run = procedures.PROCEDURES.get(name)
    if row is None or run is None:
        raise InternalError(f"no procedure {name}")
    letters = letters_of(row.parameters, len(arguments))
    reads: list[Callable[[Values], Value]] = []
    places: list[procedures.Place] = []
    for letter, argument in zip(letters, arguments, strict=True):
        if argument is None:
            reads.append(lambda f: None)
            places.append(procedures.Place())
        elif letter == "l":
            reads.append(reference(compiler, argument, argument.origin))
            places.append(_known_of(compiler, argument))
        else:
            reads.append(compiler.value(argument))
            places.append(procedures.Place())
    return lambda f: run(places, *[read(f) for read in reads])


def letters_of(parameters: str, count: int) -> list[str]:
    """One letter per argument; `*` repeats the last, `?` marks it optional."""
    plain = parameters.replace("?", "")
    repeats = plain.endswith("*")
    letters = list(plain.rstrip("*"))
    while len(letters) < count:
        letters.append(letters[-1] if repeats else "x")
    return letters[:count]


def _known_of(compiler: Compiler, target: ir.Expression) -> procedures.Place:
    type = compiler.types.of(target)
    if type is None:
        return procedures.Place()
    like: Value = None
    if not isinstance(type, ir.ArrayType | ir.StringType):
        try:
            like = compiler.types.initial(type, lambda bound: 0)
        except ProgramError:
            like = None
    match type:
        case ir.BoolType():
            like = False
        case ir.IntType() | ir.RealType():
            like = 0
        case ir.StringType():
            like = ""
    return procedures.Place(compiler.capacity(target), isinstance(type, ir.IntType), like, compiler.single)


__all__ = ["assignment", "letters_of", "procedure", "reference", "watches", "writer"]
