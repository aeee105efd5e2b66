"""The comment of a numbered variable (FANUC `R[1:count]`, `P[3:above]`, `F[2:ready]`) is its name where variables have
names.

Only a comment that is a word by itself: `Teller ontstapel` stays a remark behind the declaration, and the number the
name. What the controller calls it takes the place of the comment, so that the number is not lost to the reader. Points
of a program need no number: theirs come from the order in which they were taught.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import partial

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.capabilities import ModulePoints
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import changed

__all__ = ["labels_as_names"]

_WORD = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


@legalising(unless=lambda context: bool(context.capabilities.storage.banks))
def labels_as_names(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose variables have names. Long runs of moves name their places by number and stay."""
    if any(
        isinstance(node, ir.Rows | ir.VariableRows) for node in walk_for({"Rows", "VariableRows"}, *program.modules)
    ):
        return program
    program = _with_flags(program, context)
    routines = [routine for module in program.modules for routine in module.routines]
    everywhere = _named(one for module in program.modules for one in module.declarations)
    own = (one for routine in routines for one in (*routine.declarations, *routine.parameters))
    hidden = {one.name.lower() for one in own if isinstance(one, ir.Variable | ir.Parameter)}
    shared = {
        name: word
        for name, word in everywhere.items()
        if name not in hidden and word.lower() not in context.taken | hidden
    }
    context.taken.update(word.lower() for word in shared.values())
    context.unknown = {shared.get(name, name).lower() for name in context.unknown}
    points = context.capabilities.storage.module_points is not ModulePoints.GLOBAL
    modules = []
    for module in program.modules:
        done = tuple(
            _with_own(routine, context) if points and not routine.parameters else routine for routine in module.routines
        )
        modules.append(changed(module, routines=done))
    if not shared:
        return changed(program, modules=tuple(modules))
    return replace(program, modules=tuple(rewrite(one, partial(_renamed, names=shared)) for one in modules))


def _named(declarations: Iterable[ir.Declaration]) -> dict[str, str]:
    """The variables whose comment is a word that no other one has: the comment by the folded name."""
    labelled = [one for one in declarations if isinstance(one, ir.Variable) and _WORD.fullmatch(one.label.strip())]
    times = Counter(one.label.strip().lower() for one in labelled)
    return {one.name.lower(): word for one in labelled if times[(word := one.label.strip()).lower()] == 1}


def _with_flags(program: ir.Program, context: Context) -> ir.Program:
    """Flags that the controller has names for are truth values of these names, where each use says its flag by number
    and nothing makes a pulse of one."""
    declared = [
        one for module in program.modules for one in module.declarations if isinstance(one, ir.SignalDeclaration)
    ]
    names = {number: one.name for one in declared if (number := _flag(one.signal))}
    nodes = [*walk(*(routine for module in program.modules for routine in module.routines))]
    own = {node.name.lower() for node in nodes if isinstance(node, ir.Variable | ir.Parameter | ir.Routine)}
    uses = [node for node in nodes if isinstance(node, ir.Signal) and node.kind == "flag"]
    needed = any(isinstance(node, ir.Pulse | ir.SetAfter) and node.signal in uses for node in nodes)
    if needed or not all(map(_flag, uses)) or any(name.lower() in own for name in names.values()):
        return program

    def placed(node: object) -> object:
        match node:
            case ir.Signal(origin=origin) if _flag(node) in names:
                return ir.Name(names[_flag(node)], origin=origin)
        return node

    def declaration(one: ir.Declaration) -> ir.Declaration:
        if not isinstance(one, ir.SignalDeclaration) or not _flag(one.signal):
            return rewrite(one, placed)
        return ir.Variable(one.name, ir.BoolType(), ir.BoolLiteral(False), "persistent", "global", origin=one.origin)

    if not names:
        return program
    modules = (
        replace(
            module,
            declarations=tuple(map(declaration, module.declarations)),
            routines=tuple(rewrite(routine, placed) for routine in module.routines),
        )
        for module in program.modules
    )
    return replace(program, modules=tuple(modules))


def _flag(signal: ir.Signal) -> int:
    """The number of a flag that is said by a constant one; else 0."""
    number = signal.index if signal.kind == "flag" and signal.last is None else None
    return number.value if isinstance(number, ir.IntLiteral) else 0


def _with_own(routine: ir.Routine, context: Context) -> ir.Routine:
    """The routine with names for its own points; two routines may use a word for different ones."""
    taken = context.taken - {one.name.lower() for one in routine.declarations if isinstance(one, ir.Variable)}
    names = {name: word for name, word in _named(routine.declarations).items() if word.lower() not in taken}
    return rewrite(routine, partial(_renamed, names=names)) if names else routine


def _renamed(node: object, names: Mapping[str, str]) -> object:
    match node:
        case ir.Name(id=name) if name.lower() in names:
            return replace(node, id=names[name.lower()])
        case ir.Variable(name=name, scope=scope) if name.lower() in names:
            return replace(node, name=names[name.lower()], label=name if scope == "global" else "")
        case ir.For(counter=name) if name.lower() in names:
            return replace(node, counter=names[name.lower()])
    return node
