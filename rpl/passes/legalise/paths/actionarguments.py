"""Calls with arguments that an interrupt or a place on the path makes, for targets that call only routines without any,
or that pass copies only: what the routine writes is taken over behind the call, which is a step of its own.

A routine made for it makes the call. The arguments are looked at when it is made, as in the source; those that are
variables of the routine around become data of its module.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.capabilities import ActionArguments, Parameters, Passing, TriggerRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import ProgramScope, Scope

_NUMBERS = (ir.IntType, ir.RealType, ir.StringType)


@legalising(
    unless=lambda context: (
        context.capabilities.interrupts.action_arguments == frozenset(ActionArguments)
        and TriggerRule.ANY_VARIABLE in context.capabilities.motion.triggers
        and Passing.REFERENCES in context.capabilities.routines.passing
    ),
    sees=(
        "DeclareInterrupt",
        "Trigger",
    ),
)
def action_arguments(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets where one of the two kinds of calls has no arguments."""
    scopes = ProgramScope(program)
    modules = []
    for module in program.modules:
        worker = _Actions(context)
        routines = tuple(worker.routine(routine, scopes.routine(module, routine)) for routine in module.routines)
        if worker.made:
            declarations = (*module.declarations, *worker.variables)
            module = replace(module, routines=(*routines, *worker.made), declarations=declarations)
        modules.append(module)
    return replace(program, modules=tuple(modules))


@dataclass(slots=True)
class _Actions:
    """The actions of one module, and what is made for them."""

    context: Context
    made: list[ir.Routine] = field(default_factory=list)
    variables: list[ir.Variable] = field(default_factory=list)
    known: list[tuple[ir.CallRoutine, str]] = field(default_factory=list)

    def routine(self, routine: ir.Routine, scope: Scope) -> ir.Routine:
        found = map(_action, walk(routine))
        calls = [call for kind, call in found if call is not None and self.needs_work(kind, call, scope)]
        routine = self.only_calls(routine, scope)
        used = {name for call in calls for name in _names(call)}
        moved = {name: self.context.fresh(name) for name in sorted(used) if _is_own(name, routine, scope)}
        calls = [call for call in calls if not _names(call) & _fixed(routine) - set(moved)]
        if not calls:
            return routine
        mine = {id(call) for call in calls}

        def change(node: object) -> object:
            match node:
                case ir.Name(id=name) if name.lower() in moved:
                    return replace(node, id=moved[name.lower()])
                case ir.For(counter=name) if name.lower() in moved:
                    return replace(node, counter=moved[name.lower()])
            return node

        def called(node: object) -> object:
            kind, call = _action(node)
            if call is None or id(call) not in mine:
                return node
            assert isinstance(node, ir.DeclareInterrupt | ir.Trigger)  # _action says so
            return replace(node, action=ir.CallRoutine(self.wrapper(kind, rewrite(call, change)), origin=call.origin))

        own = [one for one in routine.declarations if isinstance(one, ir.Variable) and one.name.lower() in moved]
        self.variables += [replace(one, name=moved[one.name.lower()], scope="module") for one in own]
        kept = tuple(one for one in routine.declarations if one not in own)
        return rewrite(rewrite(replace(routine, declarations=kept), called), change)

    def only_calls(self, routine: ir.Routine, scope: Scope) -> ir.Routine:
        """Other actions than calls and assignments (KRL `DO PULSE(...)`) become a routine too, where calls do; so do
        assignments of an interrupt, where it calls routines without arguments."""
        can = self.context.capabilities
        kinds = {ActionArguments.PATH: ir.Trigger, ActionArguments.REACTION: ir.DeclareInterrupt}
        work = tuple(kind for word, kind in kinds.items() if word not in can.interrupts.action_arguments)
        signals_only = TriggerRule.ANY_VARIABLE not in can.motion.triggers
        if not work and not signals_only:
            return routine

        def called(node: object) -> object:
            own = signals_only and isinstance(node, ir.Trigger) and _of_data(node.action)
            if not isinstance(node, ir.Trigger | ir.DeclareInterrupt) or not (own or isinstance(node, work)):
                return node
            if isinstance(node.action, ir.CallRoutine):
                return node
            if isinstance(node.action, ir.Assign):
                local = any(_is_local(name, scope) for name in _names(node.action))
                if local or (isinstance(node, ir.Trigger) and not own):
                    return node
                name = self.context.fresh("rpl_on_path" if own else "rpl_reaction")
                self.made.append(ir.Routine(name, body=(node.action,)))
                return replace(node, action=ir.CallRoutine(name, origin=node.origin))
            name = self.context.fresh("rpl_on_path")
            self.made.append(ir.Routine(name, body=(node.action,)))
            return replace(node, action=ir.CallRoutine(name, origin=node.origin))

        return rewrite(routine, called)

    def needs_work(self, kind: str, call: ir.CallRoutine, scope: Scope) -> bool:
        """Has the call arguments that the target's cannot have?"""
        if not call.arguments or call.dynamic is not None:
            return False
        can = self.context.capabilities
        if kind not in can.interrupts.action_arguments:
            return True
        if ActionArguments.OWN not in can.interrupts.action_arguments and any(
            _is_local(name, scope) for name in _names(call)
        ):
            return True
        routine = scope.routine(call.name)
        if routine is not None and Passing.REFERENCES not in can.routines.passing:
            return any(one.mode == "reference" for one in routine.parameters)
        if kind != "path" or can.routines.parameters is Parameters.NAMES or routine is None:
            return False
        return any(one.mode != "value" or not isinstance(one.type, _NUMBERS) for one in routine.parameters)

    def wrapper(self, kind: str, call: ir.CallRoutine) -> str:
        """The name of the routine that makes this call."""
        for one, name in self.known:
            if one == call:
                return name
        name = self.context.fresh(f"{call.name}_{'on_path' if kind == 'path' else 'reaction'}")
        self.known.append((call, name))
        self.made.append(ir.Routine(name, body=(replace(call, origin=replace(call.origin, comments=())),)))
        return name


def _action(node: object) -> tuple[str, ir.CallRoutine | None]:
    match node:
        case ir.DeclareInterrupt(action=ir.CallRoutine() as call):
            return "reaction", call
        case ir.Trigger(action=ir.CallRoutine() as call):
            return "path", call
    return "", None


def _of_data(action: ir.Statement) -> bool:
    """Does it assign a variable, and no signal?"""
    return isinstance(action, ir.Assign) and not isinstance(action.target, ir.Signal)


def _names(call: ir.CallRoutine | ir.Assign) -> set[str]:
    return {node.id.lower() for node in walk(call) if isinstance(node, ir.Name)}


def _is_local(name: str, scope: Scope) -> bool:
    symbol = scope.value(name)
    return symbol is not None and symbol.routine is not None


def _fixed(routine: ir.Routine) -> set[str]:
    """Names of the routine that have to stay there: its parameters, and counters that are a loop's own."""
    counters = {node.counter.lower() for node in walk(routine) if isinstance(node, ir.For) and node.scoped}
    declared = {one.name.lower() for one in routine.declarations if isinstance(one, ir.Variable)}
    return {one.name.lower() for one in routine.parameters} | counters | declared


def _is_own(name: str, routine: ir.Routine, scope: Scope) -> bool:
    """A variable of the routine that can be data of the module as well: it begins without a value at each call."""
    declared = [one for one in routine.declarations if isinstance(one, ir.Variable) and one.name.lower() == name]
    counters = {node.counter.lower() for node in walk(routine) if isinstance(node, ir.For) and node.scoped}
    return len(declared) == 1 and declared[0].initial is None and name not in counters


__all__ = ["action_arguments"]
