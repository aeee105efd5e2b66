"""What the source's own routines note down and nothing reads (KRL FDAT_ACT, $H_POS once calls of BAS are evaluated):
the assignments go, and data of the program in records of the prelude that nothing mentions any more goes with them. So
does what passes keep for a question that nobody asks (the number of the latest error).
"""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import Effects
from rpl.passes.legalise.facts.mentioned import is_linked, mentioned
from rpl.passes.legalise.facts.usage import base_name
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_all, map_body
from rpl.passes.legalise.rewriting.support import SUPPORT
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import changed, rewrite_bodies


@legalising()
def without_bookkeeping(program: ir.Program, context: Context) -> ir.Program:
    """The program without what is set for nobody; data that one dropped value reads may be read by nobody too."""
    while True:
        idle = _idle(program, context)
        done = _without_assignments(program, idle) if idle else program
        if done is program:
            return _without_idle_records(program, context)
        program = done


def _idle(program: ir.Program, context: Context) -> frozenset[str]:
    """Variables of the prelude and of what passes have brought along (folded) that are only ever the place of an
    assignment."""
    own = [
        one
        for module in program.modules
        if is_linked(module, context) or module.name.lower().startswith(SUPPORT)
        for one in module.declarations
        if isinstance(one, ir.Variable)
    ]
    mentions, places = Counter[str](), Counter[str]()
    for node in walk_for({"Name", "For", "Assign", "Move", "Spline", "Variable", "Parameter"}, *program.modules):
        match node:
            case ir.Name(id=name):
                mentions[name.lower()] += 1
            case ir.For(counter=name):
                mentions[name.lower()] += 1
            case ir.Assign(target=target):
                places[base_name(target) or ""] += 1
            case ir.Move(settings=settings) | ir.Spline(settings=settings):
                places.update(base_name(place) or "" for place, _ in settings)
            case ir.Variable(name=name) | ir.Parameter(name=name):
                places[name.lower()] -= 1  # one of its own name elsewhere: then there are fewer places than mentions
    return frozenset(
        name for one in own if (name := one.name.lower()) and mentions[name] == places[name] + 1 and mentions[name]
    )


def _without_assignments(program: ir.Program, idle: frozenset[str]) -> ir.Program:
    effects = Effects(program)

    def is_idle(place: ir.Expression, value: ir.Expression) -> bool:
        return base_name(place) in idle and effects.quiet(value) and effects.quiet(place)

    def statement(one: ir.Statement) -> ir.Body:
        match one:
            case ir.Assign(target=target, value=value) if is_idle(target, value):
                return (ir.Nothing(origin=one.origin),) if one.origin.comments else ()
            case ir.Move(settings=settings) | ir.Spline(settings=settings) if any(is_idle(*each) for each in settings):
                one = replace(one, settings=tuple(each for each in settings if not is_idle(*each)))
        return (rewrite_bodies(one, body),)

    def body(statements: ir.Body) -> ir.Body:
        return map_body(statements, statement)

    done = edit_all(program, body)
    modules = tuple(
        changed(
            module,
            declarations=tuple(
                one
                for one in module.declarations
                if not (isinstance(one, ir.Initialise) and is_idle(one.assign.target, one.assign.value))
            ),
        )
        for module in done.modules
    )
    return changed(done, modules=modules)


def _without_idle_records(program: ir.Program, context: Context) -> ir.Program:
    """The program without its data of the prelude's record types that nothing mentions."""
    linked = [module for module in program.modules if is_linked(module, context)]
    records = {
        one.name.lower() for each in linked for one in each.declarations if isinstance(one, ir.RecordDeclaration)
    }
    routines = {one.name.lower() for each in linked for one in each.routines}
    if not records and not routines:
        return program
    used = mentioned(program)

    def is_kept(one: ir.Declaration) -> bool:
        match one:
            case ir.Variable(name=name, type=ir.NamedType(name=word)):
                return word.lower() not in records or name.lower() in used
            case ir.ExternalDeclaration(name=name):
                return name.lower() not in routines
        return True

    modules = tuple(
        module
        if is_linked(module, context)
        else changed(module, declarations=tuple(one for one in module.declarations if is_kept(one)))
        for module in program.modules
    )
    return changed(program, modules=modules)


__all__ = ["without_bookkeeping"]
