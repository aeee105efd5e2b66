"""The stages in their order. Each stands once; `<stage>/stage.py` lists its passes and says what it needs from the
stages before it.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context, names_in
from rpl.passes.legalise.control.stage import STAGE as CONTROL
from rpl.passes.legalise.data.stage import STAGE as DATA
from rpl.passes.legalise.errors.stage import STAGE as ERRORS
from rpl.passes.legalise.interrupts.stage import STAGE as INTERRUPTS
from rpl.passes.legalise.io.stage import STAGE as IO
from rpl.passes.legalise.paths.stage import STAGE as PATHS
from rpl.passes.legalise.places.stage import OTHER_ARM
from rpl.passes.legalise.places.stage import STAGE as PLACES
from rpl.passes.legalise.records.stage import STAGE as RECORDS
from rpl.passes.legalise.refusals.stage import STAGE as REFUSALS
from rpl.passes.legalise.routines.stage import STAGE as ROUTINES
from rpl.passes.legalise.searches.stage import STAGE as SEARCHES
from rpl.passes.legalise.settings.stage import STAGE as SETTINGS
from rpl.passes.legalise.source.stage import STAGE as SOURCE
from rpl.passes.legalise.stages import Pass, Placed, Stage, run_passes, with_placed
from rpl.passes.legalise.statements.stage import STAGE as STATEMENTS
from rpl.passes.legalise.storage.stage import STAGE as STORAGE
from rpl.passes.legalise.tasks.stage import STAGE as TASKS
from rpl.passes.typing import normalise

STAGES: tuple[Stage, ...] = (
    SOURCE,
    TASKS,
    SEARCHES,
    ERRORS,
    PLACES,
    PATHS,
    INTERRUPTS,
    REFUSALS,
    IO,
    DATA,
    ROUTINES,
    STATEMENTS,
    SETTINGS,
    RECORDS,
    CONTROL,
    STORAGE,
)
PASSES: tuple[Pass, ...] = tuple(one for stage in STAGES for one in stage.passes)


def passes_with(own: tuple[Placed, ...]) -> tuple[Pass, ...]:
    """All passes in the order in which they run for a target that brings these of its own."""
    return tuple(one for stage in with_placed(STAGES, own) for one in stage.passes)


def legalise(program: ir.Program, context: Context, own: tuple[Placed, ...] = ()) -> ir.Program:
    """The program rewritten for the context's target and governed by its rules. own: passes that the target brings.

    Same-language writing leaves it as it is.
    """
    context.taken |= names_in(program)
    other_arm = context.robot is not None and context.to_robot is not None and context.robot is not context.to_robot
    if not context.foreign or context.capabilities.carries_rules:
        return run_passes(OTHER_ARM, program, context) if other_arm else program
    program = run_passes(passes_with(own), program, context)
    return normalise(_governed(program, context), context.diagnostics)


def _governed(program: ir.Program, context: Context) -> ir.Program:
    """The program under the target's rules; targets that passes have added take its notation."""
    old, new = ir.TargetType(context.source), ir.TargetType(context.capabilities.places.notation)

    def retyped(type: ir.Type) -> ir.Type:
        match type:
            case ir.TargetType() if type.notation == old.notation:
                return replace(type, notation=new.notation)
            case ir.ArrayType(element=element):
                return replace(type, element=retyped(element))
        return type

    def declared(declaration: ir.Declaration) -> ir.Declaration:
        match declaration:
            case ir.Variable():
                return replace(declaration, type=retyped(declaration.type))
            case ir.VariableRows(sample=sample):
                return replace(declaration, sample=replace(sample, type=retyped(sample.type)))
            case ir.RecordDeclaration(fields=fields):
                return replace(declaration, fields=tuple((name, retyped(type)) for name, type in fields))
        return declaration

    def routine(one: ir.Routine) -> ir.Routine:
        return replace(
            one,
            parameters=tuple(replace(parameter, type=retyped(parameter.type)) for parameter in one.parameters),
            returns=None if one.returns is None else retyped(one.returns),
            declarations=tuple(map(declared, one.declarations)),
        )

    modules = tuple(
        replace(
            module,
            dialect=context.target,
            declarations=tuple(map(declared, module.declarations)),
            routines=tuple(map(routine, module.routines)),
        )
        for module in program.modules
    )
    return replace(program, modules=modules)
