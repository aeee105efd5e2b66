"""What a wait asks for that can only come from outside: nothing in the project changes it.

Beside inputs that is an output which the project never gives another value than the one it begins with (a controller
next to it, another task or the operator sets it: `WAIT OT#(890)=ON` of Yaskawa's motion server), and data that nothing
assigns, counts with or hands over by reference (in KRL a signal of a module that is not there, or a flag that the
visualisation writes).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rpl import ir, registry
from rpl.ir.walk import bodies, walk
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.undeclared import declared_by_use
from rpl.source import Origin

if TYPE_CHECKING:
    from rpl.runtime.trace import RunResult

_BEGINNING = (ir.BoolLiteral(False), ir.IntLiteral(0), ir.RealLiteral(0.0))


class Outside:
    """One walk over a normalised program; then ask for any place."""

    def __init__(self, program: ir.Program) -> None:
        self.program = program
        self.scopes = ProgramScope(program)
        self.switched: set[ir.Signal] = set()  # to another value than the one that they begin with
        self.changed: set[int] = set()  # data, by the identity of its declaration
        self.computed: set[str] = set()  # kinds of signals that are set by a number that only running tells
        self.waits: dict[tuple[str, int], tuple[ir.Expression, Scope]] = {}
        for module, routine in self.scopes.routines():
            scope = self.scopes.routine(module, routine)
            for node in walk(*bodies(routine)):
                self._node(node, scope)

    def inputs(self, origin: Origin) -> tuple[str, ...]:
        """The inputs that the condition there looks at."""
        condition, scope = self.waits.get((origin.file, origin.start), (ir.BoolLiteral(True), None))
        signals = (node for node in walk(condition) if isinstance(node, ir.Signal) and node.kind.endswith("_in"))
        return tuple(dict.fromkeys(_spelled(one, scope) for one in signals if scope is not None))

    def names(self, origin: Origin) -> tuple[str, ...]:
        """Those of the signals and data that the condition there looks at which nothing in the project changes, as the
        language of the statement spells them."""
        found = self.waits.get((origin.file, origin.start))
        if found is None:
            return ()
        condition, scope = found
        return tuple(dict.fromkeys(name for node in walk(condition) if (name := self._name(node, scope))))

    def _name(self, node: object, scope: Scope) -> str:
        """Of a signal or datum that only something outside changes; empty for any other."""
        match node:
            case ir.Signal():
                return "" if self._is_switched(node) else _spelled(node, scope)
            case ir.Name(id=name):
                symbol = scope.value(name)
                if symbol is None or symbol.routine is not None:
                    return ""
                declared = symbol.declaration
                if isinstance(declared, ir.SignalDeclaration):
                    return "" if self._is_switched(declared.signal) else name
                constant = isinstance(declared, ir.Variable) and declared.storage == "constant"
                return "" if constant or id(declared) in self.changed else name
        return ""

    def _is_switched(self, signal: ir.Signal) -> bool:
        return not signal.kind.endswith("_in") and (signal in self.switched or signal.kind in self.computed)

    def _node(self, node: object, scope: Scope) -> None:
        match node:
            case ir.Assign(target=target, value=value):
                self._set(target, value, scope)
            case ir.Pulse(signal=signal) | ir.SetAfter(signal=signal):
                self._set(signal, None, scope)
            case ir.For(counter=counter, scoped=False):
                self._set(ir.Name(counter), None, scope)
            case (
                ir.CallRoutine(arguments=arguments) | ir.Call(arguments=arguments) | ir.TaskControl(arguments=arguments)
            ):
                for one in arguments:
                    if one.value is not None:
                        self._set(one.value, None, scope)
            case ir.Do(arguments=arguments):
                for each in arguments:
                    if each is not None:
                        self._set(each, None, scope)
        for condition, origin in _conditions(node):
            self.waits.setdefault((origin.file, origin.start), (condition, scope))

    def _set(self, target: ir.Expression, value: ir.Expression | None, scope: Scope) -> None:
        while isinstance(target, ir.Index | ir.Field | ir.Convert):
            target = target.operand if isinstance(target, ir.Convert) else target.base
        if isinstance(target, ir.Name):
            symbol = scope.value(target.id)
            declared = symbol.declaration if symbol is not None else None
            if not isinstance(declared, ir.SignalDeclaration):
                self.changed.add(id(declared))
                return
            target = declared.signal
        if not isinstance(target, ir.Signal) or value in _BEGINNING:
            return
        plain = target.name is not None or isinstance(target.index, ir.IntLiteral)
        if plain and target.last is None:
            self.switched.add(target)
        else:
            self.computed.add(target.kind)


def from_outside(result: RunResult, program: ir.Program) -> tuple[str, ...]:
    """What the tasks of a run that stands for good wait for and nothing in the program changes, inputs aside. program:
    in normal form, as it was run; what nothing declares is looked at too."""
    waiting = [one for one in result.awaited if one.kind in ("condition", "") and not one.inputs]
    if result.status != "deadlock" or not waiting:
        return ()
    outside = Outside(declared_by_use(program))
    return tuple(dict.fromkeys(name for one in waiting for name in outside.names(one.origin)))


def _conditions(node: object) -> Iterator[tuple[ir.Expression, Origin]]:
    match node:
        case ir.WaitUntil(condition=condition, origin=origin) | ir.While(condition=condition, origin=origin):
            yield condition, origin
        case ir.Repeat(until=condition, origin=origin) | ir.If(branches=((condition, _), *_), origin=origin):
            yield condition, origin


def _spelled(signal: ir.Signal, scope: Scope) -> str:
    if signal.name is not None:
        return signal.name
    if isinstance(signal.index, ir.IntLiteral):
        return registry.dialect(scope.module.dialect).signal_name(signal.kind, signal.index.value)
    return f"a {signal.kind.replace('_', ' ')}"


__all__ = ["Outside", "from_outside"]
