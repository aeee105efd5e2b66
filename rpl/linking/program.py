"""A whole program for running: its routines as code (made when first called), its global data, its signals' names.

What is made here never changes while a program runs and is shared by all snapshots of all its runs.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.errors import UsageError
from rpl.ir.analog import AnalogRange, AnalogSetting
from rpl.ir.walk import bodies
from rpl.linking.initial import initialise
from rpl.linking.routine import link_initial, link_routine
from rpl.linking.symbols import GlobalSlot
from rpl.linking.types import Types
from rpl.passes.analog import AnalogRanges, analog_ranges
from rpl.passes.roles import Roles, roles_of
from rpl.passes.scope import Fold, ProgramScope, Scope, rules_of
from rpl.passes.typing import normalise
from rpl.passes.undeclared import declared_by_use
from rpl.runtime.code import Code, Values
from rpl.runtime.signals import Key, bit_kind, bits_named, group_bits, is_bit_group, key_of
from rpl.runtime.values import SignalRef

if TYPE_CHECKING:
    from rpl.emulator.configuration import Notation
    from rpl.runtime.machine import Machine


# How far a language's own number of a signal may lie below the neutral one.
_SPELLED_LATER = 20


class LinkedProgram:
    """Symbols of a program and the code of its routines. `assumes`: data without a value gets one where it is read (see
    assuming), by its `roles`."""

    def __init__(self, program: ir.Program, assumes: bool = False) -> None:
        self.program = program
        self.assumes = assumes
        self.roles = roles_of(program) if assumes else Roles()
        self.scopes = ProgramScope(program)
        self.slots: list[GlobalSlot] = []
        self._slot_of: dict[object, int] = {}
        self._codes: dict[int, Code] = {}
        self._homes: dict[int, tuple[ir.Module, ir.Routine]] = {}
        self._keep: list[object] = []  # what ids above refer to stays alive
        self._preludes: dict[str, ir.Module] = {}
        self._predefined: dict[str, dict[str, ir.Variable]] = {}
        self._notations: dict[str, Notation | None] = {}
        self._initialise: dict[str, list[tuple[ir.Module, ir.Assign]]] = {}
        self._aliases: dict[str, SignalRef] = {}
        self._names_of: dict[Key, list[str]] = {}
        self._analog: dict[str, AnalogRanges] = {}
        self.watched = frozenset(_watched_names(program))
        self.cyclic = tuple(_cyclic_values(program))
        for module in program.modules:
            self._enter(module)

    def __deepcopy__(self, memo: object) -> LinkedProgram:
        return self

    def _enter(self, module: ir.Module) -> None:
        for routine in module.routines:
            self._homes[id(routine)] = (module, routine)
        fold = self.scopes.module(module).fold
        for declaration in module.declarations:
            match declaration:
                case ir.Initialise(assign=assign):
                    root = _root(assign.target)
                    if root is not None:
                        self._initialise.setdefault(fold(root), []).append((module, assign))
                case ir.SignalDeclaration():
                    self.declare_signal(declaration)

    # ---- routines

    def code_of(self, routine: ir.Routine) -> Code:
        """The code of a routine, made when it is first needed."""
        found = self._codes.get(id(routine))
        if found is None:
            module = self._homes[id(routine)][0]
            found = link_routine(self, module, routine)
            self._codes[id(routine)] = found
        return found

    def codes(self) -> Iterator[tuple[int, Code]]:
        """The code of each routine of the program (by its number in the program's order) and of the actions in it."""
        routines = (routine for module in self.program.modules for routine in module.routines)
        for number, routine in enumerate(routines):
            code = self.code_of(routine)
            yield from ((number, each) for each in (code, *code.actions))

    def routine(self, scope: Scope, name: str) -> ir.Routine | None:
        """The routine that a call in this scope means; a prelude's is entered when it is met."""
        found = scope.routine(name)
        if found is None or id(found) in self._homes:
            return found
        fold = scope.fold
        for routine in self.prelude(scope.module.dialect).routines:
            if fold(routine.name) == fold(name):
                return routine
        return None

    def prelude(self, dialect: str) -> ir.Module:
        """The dialect's predefined data and routines, in normal form like any program."""
        if dialect not in self._preludes:
            found = _prelude(dialect)
            self._preludes[dialect] = found
            self._enter(found)
            self._predefined[dialect] = {
                rules_fold(dialect)(declaration.name): declaration
                for declaration in found.declarations
                if isinstance(declaration, ir.Variable)
            }
        return self._preludes[dialect]

    def home_of(
        self, declaration: ir.Variable, module: ir.Module | None, dialect: str
    ) -> tuple[ir.Variable, ir.Module]:
        """A global variable with its module; one of the prelude in its normal form."""
        if module is not None:
            return declaration, module
        prelude = self.prelude(dialect)
        return self._predefined[dialect].get(rules_fold(dialect)(declaration.name), declaration), prelude

    def find_routine(self, name: str) -> tuple[ir.Module, ir.Routine] | None:
        """A routine of the program by name, in any module."""
        for module in self.program.modules:
            fold = self.scopes.module(module).fold
            for routine in module.routines:
                if fold(routine.name) == fold(name):
                    return module, routine
        return None

    # ---- global data

    def slot(self, declaration: ir.Variable, module: ir.Module) -> int:
        """The place of a global variable; persistent data of one name is one for all tasks."""
        fold = self.scopes.module(module).fold
        shared = declaration.storage == "persistent" and declaration.scope == "global"
        key: object = ("persistent", fold(declaration.name)) if shared else id(declaration)
        found = self._slot_of.get(key)
        if found is not None:
            return found
        number = len(self.slots)
        self._slot_of[key] = number
        self._keep.append(declaration)
        entry = GlobalSlot(fold(declaration.name), f"{fold(module.name)}.{fold(declaration.name)}")
        entry.watched = declaration.name.lower() in self.watched
        entry.kept = declaration.storage == "persistent" and any(module is one for one in self.program.modules)
        entry.label = declaration.label
        entry.origin = declaration.origin
        self.slots.append(entry)
        link_initial(self, module, declaration, entry)
        return number

    def initial_assigns(self, module: ir.Module, declaration: ir.Variable) -> list[tuple[ir.Module, ir.Assign]]:
        """Assignments of data lists to a variable and its parts: of its own module first, then of those that see it
        (a project's own list gives values to what the prelude declares, and never the other way round)."""
        name = self.scopes.module(module).fold(declaration.name)
        found = self._initialise.get(name, [])
        own = [(home, assign) for home, assign in found if home is module]
        for home, assign in found:
            apart = home is module or any(home is one for one in self._preludes.values())
            symbol = None if apart else self.scopes.module(home).value(name)
            if symbol is None or not isinstance(symbol.declaration, ir.Variable):
                continue
            if self.home_of(symbol.declaration, symbol.module, home.dialect)[0] is declaration:
                own.append((home, assign))
        return own

    def initialise(self, values: Values, machine: Machine) -> None:
        """Give first values to the global data that has none yet."""
        initialise(self, values, machine)

    def variable_slot(self, name: str) -> int | None:
        """The place of a program's global variable by `name` or `module.name`."""
        wanted_module, _, plain = name.rpartition(".")
        for module in self.program.modules:
            scope = self.scopes.module(module)
            if wanted_module and scope.fold(wanted_module) != scope.fold(module.name):
                continue
            symbol = scope.value(plain)
            if symbol is not None and isinstance(symbol.declaration, ir.Variable):
                return self.slot(*self.home_of(symbol.declaration, symbol.module, module.dialect))
        return None

    # ---- signals

    def declare_signal(self, declaration: ir.SignalDeclaration) -> SignalRef | None:
        """A name for a physical signal; None when its number is no constant."""
        port = constant_port(declaration.signal, declaration.name)
        if port is not None:
            self._aliases.setdefault(declaration.name.lower(), port)
            for key in group_bits(port) if is_bit_group(port) else [key_of(port)]:
                names = self._names_of.setdefault(key, [])
                if declaration.name not in names and not is_bit_group(port):
                    names.append(declaration.name)
        return port

    @property
    def signals_named(self) -> int:
        """How many names of signals are known by now."""
        return len(self._aliases)

    def languages(self) -> tuple[str, ...]:
        """The dialects of the program's modules, each once."""
        return tuple(dict.fromkeys(module.dialect for module in self.program.modules))

    def alias(self, name: str) -> SignalRef | None:
        """The signal that a name in the cell file means, by declaration or by a language's own spelling."""
        declared = self._aliases.get(name.strip().lower()) or bits_named(name)
        return declared or self._spelled_group(name.strip()) or self._spelled(name.strip().lower())

    def _spelled_group(self, name: str) -> SignalRef | None:
        for dialect in self.languages():
            signal = registry.dialect(dialect).signal_of(name)
            if signal is not None and (port := constant_port(signal, name)) is not None:
                return port
        return None

    def _spelled(self, name: str) -> SignalRef | None:
        digits = "".join(character for character in name if character.isdigit())
        if not digits:
            return None
        for dialect in self.languages():
            spell = registry.dialect(dialect).signal_name
            for kind in ir.SIGNAL_KINDS:
                written = int(digits)
                added = written - _first_number(spell(kind, 0))  # some add a thousand for inputs, some count from 0
                for number in (added, *range(written, written + _SPELLED_LATER)):
                    if number > 0 and spell(kind, number).lower() == name:
                        return SignalRef(kind, number)
        return None

    def alias_names(self, port: SignalRef) -> tuple[str, ...]:
        """All declared names of a signal."""
        if is_bit_group(port):
            wanted = (bit_kind(port.kind), port.number, port.last)
            groups = ((name, p) for name, p in self._aliases.items() if is_bit_group(p))
            return tuple(name for name, p in groups if (bit_kind(p.kind), p.number, p.last) == wanted)
        return tuple(self._names_of.get(key_of(port), ()))

    def signal_name(self, dialect: str, kind: str, number: int) -> str:
        return registry.dialect(dialect).signal_name(kind, number)

    def analog_range(
        self, dialect: str, settings: Sequence[AnalogSetting], port: SignalRef, names: Sequence[str]
    ) -> AnalogRange | None:
        """What the numbers of an analogue signal stand for; None where only its controller's configuration knows it."""
        if dialect not in self._analog:
            self._analog[dialect] = analog_ranges(self.program, dialect, settings)
        return self._analog[dialect].of(port.kind, port.number, [*names, *([port.name] if port.name else [])])

    # ---- dialects

    def notation(self, dialect: str) -> Notation | None:
        """How a dialect writes arm configurations; None when it has no way or none is known."""
        if dialect not in self._notations:
            make = registry.dialect(dialect).notation
            self._notations[dialect] = make() if make is not None else None
        return self._notations[dialect]

    def types(self, scope: Scope) -> Types:
        return Types(scope)


def link(program: ir.Program, assume_data: bool = False, given: Iterable[str] = ()) -> LinkedProgram:
    """Prepare a normalised program for running. assume_data: what nothing declares is declared by its use, and data
    without a value gets one when it is first read, which the run reports. given: paths of data to which a cell file
    gives values; those that nothing declares are declared too."""
    if not program.modules:
        raise UsageError("there is nothing to run: no module was read")
    roots = None if assume_data else {_name_of(path).lower() for path in given} - _declared(program)
    if roots is None or roots:
        program = declared_by_use(program, roots)
    return LinkedProgram(program, assume_data)


def _declared(program: ir.Program) -> set[str]:
    """Names of all data of modules, folded."""
    declarations = (one for module in program.modules for one in module.declarations)
    return {one.name.lower() for one in declarations if isinstance(one, ir.Variable | ir.VariableRows)}


def _name_of(path: str) -> str:
    """The variable at the beginning of a path of elements and components."""
    return path.partition("[")[0].partition(".")[0]


@cache
def _prelude(dialect: str) -> ir.Module:
    found = registry.dialect(dialect).prelude()
    if found is None:
        return ir.Module(dialect, dialect)
    return normalise(ir.Program((found,)), Diagnostics()).modules[0]


def rules_fold(dialect: str) -> Fold:
    """Names as keys in a dialect."""
    return Fold(rules_of(dialect).case_sensitive)


def constant_port(signal: ir.Signal, name: str | None = None) -> SignalRef | None:
    """The physical signal of an expression whose number is written out; `name`: the alias it is declared as."""
    if signal.name is not None:
        return SignalRef(signal.kind, name=signal.name)
    first = _literal_number(signal.index)
    if first is None:
        return None
    last = _literal_number(signal.last)
    return SignalRef(signal.kind, first, last)


def _first_number(spelled: str) -> int:
    """What a language adds to the numbers of a kind of signal when it writes them (V+: inputs from 1001)."""
    digits = "".join(character for character in spelled if character.isdigit())
    return int(digits) if digits else 0


def _literal_number(expression: ir.Expression | None) -> int | None:
    return expression.value if isinstance(expression, ir.IntLiteral) else None


def _root(target: ir.Expression) -> str | None:
    while isinstance(target, ir.Index | ir.Field):
        target = target.base
    return target.id if isinstance(target, ir.Name) else None


def _watched_names(program: ir.Program) -> Iterator[str]:
    """Names of variables that some waiting condition, interrupt or search reads."""
    for module in program.modules:
        for routine in module.routines:
            for statement in _statements(list(bodies(routine))):
                conditions: list[ir.Expression | None] = []
                match statement:
                    case ir.WaitUntil(condition=condition) | ir.DeclareInterrupt(condition=condition):
                        conditions.append(condition)
                    case ir.OrderInterrupt(condition=condition):
                        conditions.append(condition)
                    case ir.Move(search=ir.Search(condition=condition)):
                        conditions.append(condition)
                    case ir.Assign(target=ir.System(name="cyclic_flag"), value=value):
                        conditions.append(value)
                for condition in conditions:
                    if condition is not None:
                        yield from (n.id.lower() for n in _names(condition))


def _cyclic_values(program: ir.Program) -> Iterator[ir.Expression]:
    """What the program gives cyclic flags to evaluate."""
    for module in program.modules:
        for routine in module.routines:
            for statement in _statements(list(bodies(routine))):
                match statement:
                    case ir.Assign(target=ir.System(name="cyclic_flag"), value=value):
                        yield value


def _statements(bodies: list[Any]) -> Iterator[ir.Statement]:
    stack: list[Any] = list(bodies)
    while stack:
        item = stack.pop()
        if isinstance(item, tuple):
            stack.extend(item)
            continue
        match item:
            case ir.If(branches=branches, otherwise=otherwise):
                stack.extend(body for _, body in branches)
                stack.append(otherwise)
            case ir.Switch(cases=cases, default=default):
                stack.extend(case.body for case in cases)
                stack.append(default or ())
            case ir.For(body=body) | ir.While(body=body) | ir.Repeat(body=body) | ir.Loop(body=body):
                stack.append(body)
            case _:
                yield item


def _names(expression: ir.Expression) -> Iterator[ir.Name]:
    from rpl.ir.walk import expressions

    return (node for node in expressions(expression) if isinstance(node, ir.Name))
