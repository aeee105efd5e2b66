"""Variables that begin with a value and that nothing assigns: they are constants, whatever their language calls them,
so that they are written where they are used. Signals whose number is computed of them have that number. What says the
number that it has on the target's controller is a register that people set there, and stays data.
"""

from __future__ import annotations

from collections.abc import Set
from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.fold import Unchanged, constant
from rpl.passes.legalise.context import Context, ProgramScope
from rpl.passes.legalise.facts.saidnumbers import said_number
from rpl.passes.legalise.facts.usage import given_by_reference
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import changed
from rpl.passes.scope import Scope

_SIMPLE = (ir.IntType, ir.RealType, ir.BoolType)


@legalising(unless=lambda context: not context.capabilities.storage.banks)
def fixed_data(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets where data takes numbers, and begins with its value at each start of the program."""
    unchanged, scopes = unchanged_in(program), ProgramScope(program)
    banks = frozenset(bank.name for bank in context.capabilities.storage.banks.values())
    unchanged.assigned |= {
        node.counter.lower() for node in walk_for({"For"}, *program.modules) if isinstance(node, ir.For)
    }
    unchanged.assigned |= given_by_reference(program)  # where a target only has copies, the copy comes back
    modules = []
    for module in program.modules:
        scope = scopes.module(module)
        declarations = tuple(_declared(one, unchanged, scope, banks) for one in module.declarations)
        modules.append(changed(module, declarations=declarations))
    done = changed(program, modules=tuple(modules))
    return program if done is program else _with_signals(done, unchanged)


def _declared(one: ir.Declaration, unchanged: Unchanged, scope: Scope, banks: Set[str]) -> ir.Declaration:
    match one:
        case ir.Variable(storage="variable" | "persistent", initial=initial, type=type, name=name) if (
            initial is not None and said_number(one, banks) is None
        ):
            changes = name.lower() in unchanged.assigned or name.lower() in unchanged.initialised
            if not changes and isinstance(type, _SIMPLE) and constant(initial, scope) is not None:
                return replace(one, storage="constant")
    return one


def _with_signals(program: ir.Program, unchanged: Unchanged) -> ir.Program:
    """The program with signals by their numbers where these are known."""
    scopes, modules = ProgramScope(program), []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            scope = scopes.routine(module, routine)

            def change(node: object, scope: Scope = scope) -> object:
                if not isinstance(node, ir.Signal) or node.index is None or isinstance(node.index, ir.IntLiteral):
                    return node
                if any(one.id.lower() in unchanged.assigned for one in walk(node.index) if isinstance(one, ir.Name)):
                    return node
                number = constant(node.index, scope)
                if isinstance(number, int | float) and number == int(number):
                    return replace(node, index=ir.IntLiteral(int(number)))
                return node

            routines.append(rewrite(routine, change))
        modules.append(changed(module, routines=tuple(routines)))
    return changed(program, modules=tuple(modules))
