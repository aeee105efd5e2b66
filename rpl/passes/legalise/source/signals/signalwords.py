"""Variables that only say the number of a signal are that signal's name.

`SUCTION = 0` at the head of a URScript program, `suction = 1` in the first routine of a V+ program: the language has no
names for signals, so people keep the numbers in variables. Where signals have names at the controller, the name is what
was meant, and the variable goes; where they have numbers only, it is the number, with the name as its remark where the
target has such. A variable that says something else as well stays; its signals have their numbers.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import usage_of
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.source.signals.signalparameters import signals_as_parameters
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import changed, rewrite_parts
from rpl.passes.scope import ProgramScope, Scope

__all__ = ["signal_words"]

_NUMBERS = (ir.IntType, ir.RealType)


@legalising(unless=lambda context: not context.foreign, sees=("Signal",))
def signal_words(program: ir.Program, context: Context) -> ir.Program:
    """Not in the program's own language, where they stay as they are. One value has such a variable, wherever it is
    set; a program that asks for a signal before it is said is one that its own controller stops. Parameters that only
    say the number of a signal become signals with them."""
    worker = _Words(program)
    if context.capabilities.io.signal_prefixes:
        passed = signals_as_parameters(program, worker.values)
        if passed is not program:
            program, worker = passed, _Words(passed)
    return worker.program() if worker.values else program


@dataclass(slots=True)
class _Words:
    source: ir.Program
    values: dict[str, int] = field(default_factory=dict)  # folded name -> the number that it always has
    scopes: ProgramScope = field(init=False)
    reads: Counter[str] = field(default_factory=Counter)  # where a variable is read, and where it says a signal
    said: Counter[str] = field(default_factory=Counter)
    signals: dict[str, set[tuple[str, int]]] = field(default_factory=dict)
    names: dict[str, ir.SignalDeclaration] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.scopes = ProgramScope(self.source)
        self.values = self.single_values()
        for module, routine in self.scopes.routines() if self.values else ():
            scope = self.scopes.routine(module, routine)
            for node in walk(routine):
                self.look(node, scope)
        for name, found in self.signals.items():
            if len(found) == 1 and self.reads[name] == self.said[name]:
                self.name(name, *next(iter(found)))

    def single_values(self) -> dict[str, int]:
        """The variables of modules that only ever hold one whole number, and that have their name alone."""
        otherwise = usage_of(self.source).otherwise
        declared = Counter(name for module in self.source.modules for name in _declared(module))
        found: dict[str, set[object]] = {}
        for module in self.source.modules:
            scope = self.scopes.module(module)
            for one in module.declarations:
                if isinstance(one, ir.Variable) and isinstance(one.type, _NUMBERS):
                    given = () if one.initial is None else (constant(one.initial, scope),)
                    found.setdefault(one.name.lower(), set()).update(given)
                elif isinstance(one, ir.Initialise):
                    otherwise |= {node.id.lower() for node in walk(one.assign.target) if isinstance(node, ir.Name)}
        for module, routine in self.scopes.routines():
            scope = self.scopes.routine(module, routine)
            for node in walk(routine):
                if isinstance(node, ir.Assign) and isinstance(node.target, ir.Name):
                    found.setdefault(node.target.id.lower(), set()).add(constant(node.value, scope))
        single = {name: next(iter(held)) for name, held in found.items() if len(held) == 1}
        return {
            name: int(value)
            for name, value in single.items()
            if isinstance(value, int | float) and value == int(value) and not isinstance(value, bool)
            if declared[name] == 1 and name not in otherwise
        }

    def look(self, node: object, scope: Scope) -> None:
        match node:
            case ir.Name(id=name):
                self.reads[name.lower()] += 1
            case ir.Assign(target=ir.Name(id=name)):
                self.reads[name.lower()] -= 1  # where it is set it is not read
            case ir.Signal(kind=kind, index=index) if index is not None:
                number, names = self.number(index, scope), _names(index)
                for name in names if number is not None else ():
                    self.said[name] += 1
                    self.signals.setdefault(name, set()).add((kind, number or 0))
                    if len(names) > 1 or node.last is not None:
                        self.signals[name].add(("", 0))  # this one is not its own

    def number(self, index: ir.Expression, scope: Scope) -> int | None:
        if not any(name in self.values for name in _names(index)):
            return None
        value = constant(index, scope, known=self.values)
        whole = isinstance(value, int | float) and value == int(value)
        return int(value) if isinstance(value, int | float) and whole and value >= 1 else None

    def name(self, name: str, kind: str, number: int) -> None:
        signal = ir.Signal(kind, ir.IntLiteral(number))
        taken = [
            node.signal
            for node in walk_for({"SignalDeclaration"}, *self.source.modules)
            if isinstance(node, ir.SignalDeclaration)
        ]
        if name in self.values and signal not in (*taken, *(one.signal for one in self.names.values())):
            self.names[name] = ir.SignalDeclaration(name, signal, scope="global")

    # ---- what it makes of the program

    def program(self) -> ir.Program:
        modules = []
        for module in self.source.modules:
            declarations = tuple(map(self.declared, module.declarations))
            routines = tuple(self.routine(module, one) for one in module.routines)
            modules.append(changed(module, declarations=declarations, routines=routines))
        return changed(self.source, modules=tuple(modules))

    def declared(self, one: ir.Declaration) -> ir.Declaration:
        if not isinstance(one, ir.Variable) or one.name.lower() not in self.names:
            return one
        return replace(self.names[one.name.lower()], name=one.name, origin=one.origin)

    def routine(self, module: ir.Module, routine: ir.Routine) -> ir.Routine:
        scope = self.scopes.routine(module, routine)

        def expression(one: ir.Expression) -> ir.Expression:
            if isinstance(one, ir.Signal) and one.index is not None and not isinstance(one.index, ir.IntLiteral):
                number = self.number(one.index, scope)
                return one if number is None else replace(one, index=ir.IntLiteral(number))
            return rewrite_parts(one, expression)

        def body(statements: ir.Body) -> ir.Body:
            kept = [one for one in map(self.left, statements) if one is not None]
            return tuple(rewrite_parts(one, expression, body) for one in kept)

        return edit_bodies(routine, body)

    def left(self, statement: ir.Statement) -> ir.Statement | None:
        """The statement, unless all it does is to say the number of a signal; its remarks stay."""
        match statement:
            case ir.Assign(target=ir.Name(id=name), origin=origin) if name.lower() in self.names:
                return ir.Nothing(origin=origin) if origin.comments else None
        return statement


def _names(index: ir.Expression) -> list[str]:
    return [node.id.lower() for node in walk(index) if isinstance(node, ir.Name)]


def _declared(module: ir.Module) -> Iterator[str]:
    """Names of the module and of its routines, folded, as often as they are declared."""
    for one in module.declarations:
        name = getattr(one, "name", None)
        if isinstance(name, str):
            yield name.lower()
    for routine in module.routines:
        yield routine.name.lower()
        yield from (one.name.lower() for one in routine.parameters)
        yield from (one.name.lower() for one in routine.declarations if isinstance(one, ir.Variable))
