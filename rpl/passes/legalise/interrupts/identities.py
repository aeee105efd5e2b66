"""Interrupts with a name (RAPID intnum), for targets where a number has one declaration and one action: a variable that
is connected to several routines, or ordered in several ways, and a routine that asks which interrupt has called it.

Each is refused where it is connected; what orders and switches it is a remark. Variables of several routines, or local
ones of several modules, that are called the same are interrupts of their own.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Code, Severity, code
from rpl.ir.walk import rewrite
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import base_name
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_all, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.refusedactions import without_actions
from rpl.passes.legalise.rewriting.stopping import left_out, stopped
from rpl.passes.scope import ProgramScope

__all__ = ["ASKED", "ORDERED", "SEVERAL", "one_meaning_each", "one_name_each"]

SEVERAL = code(
    "interrupt-connected-anew",
    Severity.LOSS,
    "{name} is connected to several routines; an interrupt of the target has one",
    "use one interrupt variable for each routine",
    stops=True,
)
ORDERED = code(
    "interrupt-ordered-anew",
    Severity.LOSS,
    "{name} is ordered in several ways (signals, times, once or each time); an interrupt of the target has one",
    "use one interrupt variable for each way",
    stops=True,
)
ASKED = code(
    "interrupt-number-asked",
    Severity.LOSS,
    "the routine that {name} is connected to asks which interrupt has called it, which the target does not tell",
    "use one routine for each interrupt",
    stops=True,
)
_NUMBER = "interrupt_number"
_HANDLED = ir.OrderInterrupt | ir.ControlInterrupt


def one_name_each(program: ir.Program, context: Context) -> ir.Program:
    """The program in which no two interrupt variables have one name: what follows knows them by their names."""
    names: set[str] = set()
    renamed: dict[int, str] = {}  # by identity of the declaration

    def note(declarations: tuple[ir.Declaration, ...]) -> None:
        for one in declarations:
            if isinstance(one, ir.Variable) and isinstance(_single(one.type), ir.InterruptType):
                if one.name.lower() in names:
                    renamed[id(one)] = context.fresh(one.name)
                names.add(one.name.lower())

    for module in program.modules:
        note(module.declarations)
        for routine in module.routines:
            note(routine.declarations)
    if not renamed:
        return program
    scopes = ProgramScope(program)

    def declared(declarations: tuple[ir.Declaration, ...]) -> tuple[ir.Declaration, ...]:
        return tuple(
            replace(one, name=renamed[id(one)]) if isinstance(one, ir.Variable) and id(one) in renamed else one
            for one in declarations
        )

    def work(module: ir.Module, routine: ir.Routine) -> ir.Routine:
        scope = scopes.routine(module, routine)

        def change(node: object) -> object:
            if isinstance(node, ir.Name):
                symbol = scope.value(node.id)
                if symbol is not None and id(symbol.declaration) in renamed:
                    return replace(node, id=renamed[id(symbol.declaration)])
            return node

        return rewrite(replace(routine, declarations=declared(routine.declarations)), change)

    return replace(
        program,
        modules=tuple(
            replace(
                module,
                declarations=declared(module.declarations),
                routines=tuple(work(module, routine) for routine in module.routines),
            )
            for module in program.modules
        ),
    )


def _single(type: ir.Type) -> ir.Type:
    return type.element if isinstance(type, ir.ArrayType) else type


def one_meaning_each(program: ir.Program, context: Context) -> ir.Program:
    """The program in which every interrupt variable that is left has one routine, one way, and no question."""
    refused = _refused(program, context)
    if not refused:
        return program
    connected = [
        node
        for node in walk_for({"ConnectInterrupt"}, *program.modules)
        if isinstance(node, ir.ConnectInterrupt) and _name(node) in refused
    ]

    def change(statement: ir.Statement) -> ir.Body:
        name = _name(statement)
        if name in refused:
            if isinstance(statement, ir.ConnectInterrupt):
                return (stopped(statement, refused[name], context, name=name),)
            return (left_out(statement, "its interrupt is refused where it is connected"),)
        return (inside(statement, lambda body: map_body(body, change)),)

    return edit_all(without_actions(program, connected), lambda body: map_body(body, change))


def _refused(program: ir.Program, context: Context) -> dict[str, Code]:
    """Interrupt variables (folded) that the target cannot have, and why."""
    can = context.capabilities.system_variables
    asking = {
        routine.name.lower()
        for module in program.modules
        for routine in module.routines
        if any(isinstance(node, ir.System) and node.name == _NUMBER for node in walk_for({"System"}, routine))
    }
    routines: dict[str, set[str]] = {}
    ways: dict[str, list[object]] = {}
    for node in walk_for({"ConnectInterrupt", "OrderInterrupt"}, *program.modules):
        match node:
            case ir.ConnectInterrupt(routine=routine) if name := _name(node):
                routines.setdefault(name, set()).add(routine.lower())
            case ir.OrderInterrupt(event=event, condition=condition, time=time, once=once) if name := _name(node):
                found = ways.setdefault(name, [])
                if (event, condition, time, once) not in found:
                    found.append((event, condition, time, once))
    refused: dict[str, Code] = {}
    for name, connected in routines.items():
        if len(connected) > 1:
            refused[name] = SEVERAL
        elif connected & asking and _NUMBER not in can:
            refused[name] = ASKED
        elif len(ways.get(name, ())) > 1 and "timer_positive" not in can:  # else a number may be declared anew
            refused[name] = ORDERED
    return refused


def _name(statement: object) -> str:
    """The variable, or array, of the interrupt that a statement handles."""
    if not isinstance(statement, _HANDLED | ir.ConnectInterrupt) or statement.handle is None:
        return ""
    return (base_name(statement.handle) or "").lower()
