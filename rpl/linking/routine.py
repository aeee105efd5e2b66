"""Links one routine: places in the frame, body, handlers, undo; and the first values of global data."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from rpl import ir
from rpl.errors import InternalError
from rpl.linking.assembler import Assembler, Label
from rpl.linking.assuming import assuming
from rpl.linking.calls import FIRST, Calls, leaving
from rpl.linking.expressions import Compiler, Place
from rpl.linking.flatten import Flattener
from rpl.linking.places import procedure, writer
from rpl.linking.statements import Statements
from rpl.passes.kept import zero_of
from rpl.runtime import answers
from rpl.runtime.code import Code, HandlerCode, Instruction, Read, Values
from rpl.runtime.faults import ProgramError
from rpl.runtime.values import Value

if TYPE_CHECKING:
    from rpl.linking.assembler import Make
    from rpl.linking.symbols import GlobalSlot, Symbols


class RoutineLinker:
    """Holds what the parts of linking one routine share."""

    def __init__(self, linked: Symbols, compiler: Compiler, module: ir.Module) -> None:
        self.linked = linked
        self.module = module
        self.compiler = compiler
        self.assembler = Assembler()
        self.flattener = Flattener(self)
        self.calls = Calls(self)
        self.statements = Statements(self)
        self.code = Code("", compiler.scope.rules)

    def vendor_function(self, vendor: ir.Vendor, result: int | None) -> Make:
        """A function that only one controller has: the cell file gives its value."""

        def make(here: int, next: int) -> Instruction:
            def run(f: Values) -> int:
                task = f[0]
                value = answers.vendor_value(task.machine, vendor.text)
                if result is not None:
                    f[result] = value
                return next

            return run

        return make

    def action(self, action: ir.Assign | ir.CallRoutine, name: str) -> Code:
        """The action of an interrupt or trigger as code of its own that runs on this routine's values."""
        outer = self.assembler
        self.assembler = Assembler()
        code = Code(name, self.compiler.scope.rules, "action")
        self.code.actions.append(code)
        self.statements.statement(action)
        self.assembler.emit(leaving(None))
        self.assembler.assemble(code)
        self.assembler = outer
        return code


def link_routine(linked: Symbols, module: ir.Module, routine: ir.Routine) -> Code:
    """The code of a routine."""
    scope = linked.scopes.routine(module, routine)
    compiler = Compiler(linked, scope, procedure, assuming)
    linker = RoutineLinker(linked, compiler, module)
    code = linker.code = Code(routine.name, scope.rules, routine.kind)
    code.predefined = not any(module is own for own in linked.program.modules)
    for place, parameter in enumerate(routine.parameters):
        compiler.places[scope.fold(parameter.name)] = Place(
            FIRST + place, is_reference=parameter.mode == "reference" and not _is_signal(linker, parameter.type)
        )
    compiler.size = FIRST + len(routine.parameters)
    declared = _declare(linker, routine)
    prepares = [_preparation(linker, declaration, place) for declaration, place in declared]
    linker.statements.body(routine.body)
    linker.assembler.emit(_falling_off(routine) if routine.kind == "function" else leaving(None))
    handlers = []
    for handler in routine.handlers:
        start = Label()
        codes = tuple(compiler.value(each) for each in handler.codes)
        linker.assembler.place(start)
        linker.statements.body(handler.body)
        linker.assembler.emit(leaving(None))
        handlers.append((codes, start))
    undo = None
    if routine.undo:
        undo = Label()
        linker.assembler.place(undo)
        linker.statements.body(routine.undo)
        linker.assembler.emit(lambda here, next: lambda f: f[0].undone())
    linker.assembler.assemble(code)
    code.size = compiler.size
    code.handlers = tuple(HandlerCode(codes, start.pc) for codes, start in handlers)
    code.undo = undo.pc if undo is not None else None
    code.prepare = tuple(prepares)
    code.places = {name: (place.number, place.is_reference) for name, place in compiler.places.items()}
    code.globals_needed = len(linked.slots)
    return code


def _is_signal(linker: RoutineLinker, type: ir.Type) -> bool:
    return isinstance(linker.compiler.scope.resolve(type), ir.SignalType)


def _declare(linker: RoutineLinker, routine: ir.Routine) -> list[tuple[ir.Variable, int]]:
    """Places for the routine's own data. Persistent data of a routine lives with the globals."""
    compiler = linker.compiler
    declared = []
    for declaration in routine.declarations:
        key = compiler.scope.fold(declaration.name) if isinstance(declaration, ir.Variable) else ""
        match declaration:
            case ir.Variable(storage="persistent"):
                number = linker.linked.slot(declaration, linker.module)
                compiler.places[key] = Place(number, True, watched=linker.linked.slots[number].watched)
            case ir.Variable() if key not in compiler.places:
                place = compiler.new_place()
                compiler.places[key] = Place(place)
                declared.append((declaration, place))
            case ir.SignalDeclaration():
                linker.linked.declare_signal(declaration)
            case _:
                continue
    return declared


def _preparation(linker: RoutineLinker, declaration: ir.Variable, place: int) -> Callable[[Values], None]:
    """What gives a local variable its first value at each call."""
    make = first_value(linker.compiler, declaration)

    def prepare(f: Values) -> None:
        f[place] = make(f)

    return prepare


def first_value(compiler: Compiler, declaration: ir.Variable) -> Read:
    """A closure that makes a variable's first value."""
    types, type = compiler.types, declaration.type
    # The bounds are linked with the rest: they may be constants, of any module, that have to have their value first.
    written = types.bounds(type) if declaration.initial is None else ()
    bounds = {id(bound): compiler.value(bound) for bound in written}

    def number(f: Values) -> Callable[[ir.Expression], Value]:
        def evaluate(bound: ir.Expression) -> Value:
            found = bounds.get(id(bound))
            if found is None:
                found = bounds[id(bound)] = compiler.value(bound)
            return found(f)

        return evaluate

    if declaration.initial is not None:
        read = compiler.copy_of(declaration.initial)
        resolved = compiler.scope.resolve(type)
        if isinstance(resolved, ir.ArrayType) and resolved.base != 1:
            base = resolved.base
            return lambda f: _rebased(read(f), base)
        return read
    resolved = compiler.scope.resolve(type)
    if isinstance(resolved, ir.IntType | ir.RealType | ir.BoolType | ir.StringType | ir.CharType):
        value = types.initial(resolved, lambda bound: 0)
        return lambda f: value
    return lambda f: types.initial(type, number(f))


def _rebased(value: Value, base: int) -> Value:
    value.base = base
    return value


def _falling_off(routine: ir.Routine) -> Make:
    def make(here: int, next: int) -> Instruction:
        def fail(f: Values) -> int:
            raise ProgramError("no_result", f"the function {routine.name} ends without a value")

        return fail

    return make


def link_initial(linked: Symbols, module: ir.Module, declaration: ir.Variable, slot: GlobalSlot) -> None:
    """How a global variable gets its first value, and what a data list then assigns to its parts."""
    own = len(linked.slots) - 1  # linking may give places to the data that the value reads
    scope = linked.scopes.module(module)
    compiler = _Tracking(linked, scope)
    slot.fitted = lambda value: compiler.types.fitted(declaration.type, value)
    slot.initial = first_value(compiler, declaration)
    for home, assign in linked.initial_assigns(module, declaration):
        there = compiler if home is module else _Tracking(linked, linked.scopes.module(home))
        slot.assigns.append(_initial_assign(there, assign))
        compiler.used |= there.used
    slot.needs = compiler.used - {own}


def _initial_assign(compiler: Compiler, assign: ir.Assign) -> Read:
    read, write = compiler.copy_of(assign.value), writer(compiler, assign.target, assign.origin)

    def run(f: Values) -> Value:
        write(f, read(f))
        return None

    return run


class _Tracking(Compiler):
    """Remembers which global data an initial value reads."""

    def __init__(self, linked: Symbols, scope: object) -> None:
        from rpl.passes.scope import Scope

        if not isinstance(scope, Scope):
            raise InternalError("a scope is needed")
        super().__init__(linked, scope, procedure, assuming)
        self.used: set[int] = set()

    def value(self, expression: ir.Expression) -> Read:
        """A value that the controller keeps and no file gives: zero, as on a controller on which nobody has set it."""
        if not isinstance(expression, ir.VendorValue):
            return super().value(expression)
        zero = zero_of(expression.type)
        if zero is not None:
            return super().value(zero)
        return lambda f: self.types.initial(expression.type, lambda bound: 0)

    def place_of(self, name: str) -> Place | ir.SignalDeclaration | None:
        place = super().place_of(name)
        if isinstance(place, Place) and place.is_global:
            self.used.add(place.number)
        return place


__all__ = ["RoutineLinker", "link_initial", "link_routine"]
