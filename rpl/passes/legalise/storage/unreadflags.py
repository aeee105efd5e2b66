"""What the passes have made and nothing reads in the end: flags of waits with a limit, numbers of errors that are
handled where they come. So are frames and settings of the source's controller, once the moves say them. It would take
numbers and lines.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.effects import Effects
from rpl.passes.legalise.facts.mentioned import mentioned
from rpl.passes.legalise.facts.usage import base_name
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_all, map_body
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import changed, rewrite_bodies
from rpl.source import NOWHERE


@legalising()
def unread_flags(program: ir.Program, context: Context) -> ir.Program:
    """Data of the source stays: people look at it. Flags of waits and data of modules go where data takes numbers."""
    settings = {name.lower() for name in rules_of(context.source).settings_data} if context.foreign else set()
    numbered = bool(context.capabilities.storage.banks)
    made = settings | {
        one.name.lower()
        for module in program.modules
        for declared in (module.declarations if numbered else (), *(one.declarations for one in module.routines))
        for one in declared
        if isinstance(one, ir.Variable) and one.origin is NOWHERE and one.storage == "variable"
    }
    waits = walk_for({"WaitUntil"}, *program.modules) if numbered else ()
    written = Counter(
        node.timed_out.id.lower()
        for node in waits
        if isinstance(node, ir.WaitUntil) and isinstance(node.timed_out, ir.Name)
    )
    asked = made | written.keys()
    if not asked:
        return program
    named: Counter[str] = Counter()
    effects = Effects(program)
    for node in walk_for({"Name", "Assign"}, *program.modules):
        match node:
            case ir.Name(id=name):
                named[name.lower()] += 1
            case ir.Assign(target=target, value=value):
                whole = isinstance(target, ir.Name)
                base = base_name(target) or ""
                if base in (asked if whole else settings) and effects.safe(value):
                    written[base] += 1
    idle = {name for name in asked if written[name] and named[name] == written[name]}
    idle |= {name for name in made - settings if not named[name]} - mentioned(program)
    return _without(program, idle, settings) if idle else program


def _without(program: ir.Program, idle: set[str], settings: set[str]) -> ir.Program:
    def change(statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.Assign(target=target) if base_name(target) in idle:
                return (ir.Nothing(origin=statement.origin),) if statement.origin.comments else ()
            case ir.WaitUntil(timed_out=ir.Name(id=name)) if name.lower() in idle:
                return (replace(statement, timed_out=None),)
        return (rewrite_bodies(statement, lambda body: map_body(body, change)),)

    done = edit_all(program, lambda body: map_body(body, change))
    return replace(done, modules=tuple(_declaring(one, idle, settings) for one in done.modules))


def _declaring(module: ir.Module, idle: set[str], settings: set[str]) -> ir.Module:
    """The module without what declares such settings and begins such data, and its routines without their own."""

    def goes(one: ir.Declaration) -> bool:
        match one:
            case ir.Initialise(assign=assign):
                return base_name(assign.target) in idle
            case ir.Variable(name=name):
                return name.lower() in idle & settings
        return False

    declarations = tuple(one for one in module.declarations if not goes(one))
    routines = tuple(
        changed(one, declarations=tuple(each for each in one.declarations if not _is_own(each, idle)))
        for one in module.routines
    )
    return changed(module, declarations=declarations, routines=routines)


def _is_own(one: ir.Declaration, idle: set[str]) -> bool:
    return isinstance(one, ir.Variable) and one.origin is NOWHERE and one.name.lower() in idle


__all__ = ["unread_flags"]
