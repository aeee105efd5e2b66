"""Parameters that only say the number of a signal are signals, for targets whose signals have names.

`def wait_input(number)` waits for `get_standard_digital_in(number)`, and each of its calls says one input: its author
had no type for a signal. Where there is one, the signal itself is passed (RAPID `VAR signaldi`, VAL3 `dio`), as the
target's people write such a routine; a computed number would need a routine over all signals in reach.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import replace

from rpl import ir
from rpl.ir.walk import bodies, rewrite, walk
from rpl.passes.fold import constant
from rpl.passes.legalise.facts.entries import never_called
from rpl.passes.scope import ProgramScope, Scope

__all__ = ["signals_as_parameters"]

_NUMBERS = (ir.IntType, ir.RealType)
_Call = ir.CallRoutine | ir.Call
# By folded name of the routine: place of the parameter -> kind of the signal, and what is added to its number.
_Places = dict[str, dict[int, tuple[str, int]]]


def signals_as_parameters(program: ir.Program, values: Mapping[str, int]) -> ir.Program:
    """The program with signals for such parameters, and for the arguments of all calls. values: variables (folded
    names) that always hold one whole number. A routine is left as it is where something else than a call with constant
    numbers begins it."""
    found = _candidates(program)
    if not found:
        return program
    scopes = ProgramScope(program)
    for module, routine in scopes.routines():
        scope = scopes.routine(module, routine)
        for call in walk(*bodies(routine)):
            if isinstance(call, _Call):
                _kept_by(call, scope, values, found)
    if not any(found.values()):
        return program
    modules = tuple(
        replace(module, routines=tuple(_with_signals(one, found) for one in module.routines))
        for module in program.modules
    )
    return replace(program, modules=modules)


def _candidates(program: ir.Program) -> _Places:
    """Parameters that say nothing but the number of signals of one kind, in routines that only calls by name begin."""
    nodes = [*walk(*(routine for module in program.modules for routine in module.routines))]
    if any(isinstance(node, ir.CallRoutine) and node.dynamic is not None for node in nodes):
        return {}
    told = {node.routine.lower() for node in nodes if isinstance(node, ir.ConnectInterrupt)}
    told |= {node.routine.lower() for node in nodes if isinstance(node, ir.OnError) and isinstance(node.routine, str)}
    told |= {node.task.lower() for node in nodes if isinstance(node, ir.TaskControl)}
    told |= {task.entry.lower() for task in program.tasks} | never_called(program)
    routines = [routine for module in program.modules for routine in module.routines]
    named = Counter(routine.name.lower() for routine in routines)
    return {
        routine.name.lower(): places
        for routine in routines
        if named[routine.name.lower()] == 1 and routine.name.lower() not in told
        if (places := dict(_of_signals(routine)))
    }


def _of_signals(routine: ir.Routine) -> Iterator[tuple[int, tuple[str, int]]]:
    names = Counter(node.id.lower() for node in walk(routine) if isinstance(node, ir.Name))
    local = {one.name.lower() for one in routine.declarations if isinstance(one, ir.Variable)}
    local |= {node.counter.lower() for node in walk(routine) if isinstance(node, ir.For)}
    said: dict[str, list[tuple[str, int]]] = {}
    for node in walk(routine):
        if isinstance(node, ir.Signal) and (found := _number_of(node)) is not None:
            said.setdefault(found[0], []).append((node.kind, found[1]))
    for place, one in enumerate(routine.parameters):
        key, plain = one.name.lower(), one.mode == "value" and not (one.optional or one.switch)
        uses = said.get(key, [])
        alone = len(set(uses)) == 1 and names[key] == len(uses) and key not in local
        if plain and alone and isinstance(one.type, _NUMBERS):
            yield place, uses[0]


def _number_of(signal: ir.Signal) -> tuple[str, int] | None:
    """The variable (folded) that says a single signal's number, and what is added to it."""
    if signal.last is not None or signal.kind.startswith("group") or signal.kind == "flag":
        return None
    match _bare(signal.index):
        case ir.Name(id=name):
            return name.lower(), 0
        case ir.Binary(op="+" | "-" as op, left=left, right=ir.IntLiteral(value=more)):
            inner = _bare(left)
            return (inner.id.lower(), more if op == "+" else -more) if isinstance(inner, ir.Name) else None
    return None


def _bare(index: ir.Expression | None) -> ir.Expression | None:
    while isinstance(index, ir.Convert):
        index = index.operand
    return index


def _kept_by(call: _Call, scope: Scope, values: Mapping[str, int], found: _Places) -> None:
    """Takes back what this call does not say by constant numbers."""
    places = found.get(call.name.lower(), {})
    for place, (_, more) in list(places.items()):
        argument = call.arguments[place] if place < len(call.arguments) else None
        named = any(one.name for one in call.arguments)
        if argument is None or named or _said(argument, scope, values, more) is None:
            del places[place]


def _said(argument: ir.Argument, scope: Scope, values: Mapping[str, int], more: int) -> int | None:
    value = None if argument.value is None else constant(argument.value, scope, known=values)
    if isinstance(value, bool) or not isinstance(value, int | float) or value != int(value):
        return None
    return int(value) + more if value + more >= 1 else None


def _with_signals(routine: ir.Routine, found: _Places) -> ir.Routine:
    own = found.get(routine.name.lower(), {})
    kinds = {routine.parameters[place].name.lower(): kind for place, (kind, _) in own.items()}

    def change(node: object) -> object:
        match node:
            case ir.Signal() if (said := _number_of(node)) is not None and said[0] in kinds:
                name = next(one.id for one in walk(node.index) if isinstance(one, ir.Name))
                return replace(node, name=name, index=None)
            case ir.Parameter(name=name) if name.lower() in kinds:
                return replace(node, type=ir.SignalType(kinds[name.lower()]), mode="reference")
            case ir.CallRoutine() | ir.Call() if places := found.get(node.name.lower()):
                arguments = tuple(
                    _signal(one, *places[place]) if place in places else one for place, one in enumerate(node.arguments)
                )
                return replace(node, arguments=arguments)
        return node

    return rewrite(routine, change)


def _signal(argument: ir.Argument, kind: str, more: int) -> ir.Argument:
    number = _bare(argument.value)
    assert number is not None
    if isinstance(number, ir.IntLiteral):
        return replace(argument, value=ir.Signal(kind, ir.IntLiteral(number.value + more)))
    index = ir.Binary("+" if more > 0 else "-", number, ir.IntLiteral(abs(more))) if more else number
    return replace(argument, value=ir.Signal(kind, index))
