"""The programs of a whole: who starts them, which are condition programs, which move and select; and how they move."""

from __future__ import annotations

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.facts.entries import started_first
from rpl.passes.legalise.facts.usage import doing
from rpl.passes.legalise.kinds import walk_for

from ..own import parts_apart, selects_frame


def entries_of(program: ir.Program) -> set[str]:
    """Programs that may be started, folded: the named entry, the tasks', else those that nobody calls."""
    if program.entry:
        return {program.entry.lower()}
    motion = {task.entry.lower() for task in program.tasks if task.kind == "motion"}
    if motion:
        return motion
    return started_first(program)


def _is_monitor(module: ir.Module) -> bool:
    """Is it a condition program (`/PROG X Cond`)?"""
    return dict(module.attributes).get("PROG_TYPE", "").lower().startswith("cond")


def monitors_of(program: ir.Program) -> dict[int, tuple[str, int]]:
    """The condition programs: by the number of the first condition, the name and how many conditions there are."""
    found: dict[int, tuple[str, int]] = {}
    for module in program.modules:
        if not _is_monitor(module):
            continue
        for routine in module.routines[:1]:
            numbers = [
                statement.priority.value
                for statement in parts_apart(routine.body)
                if isinstance(statement, ir.DeclareInterrupt) and isinstance(statement.priority, ir.IntLiteral)
            ]
            if numbers:
                found[numbers[0]] = (routine.name.upper(), len(numbers))
    return found


def quiet_routines(program: ir.Program) -> tuple[frozenset[str], frozenset[str]]:
    """Routines that neither move the robot nor select a tool or frame, nor call one that does; and those that may move
    but select nothing. Folded names."""
    names = {routine.name.lower() for module in program.modules for routine in module.routines}

    def unknown(node: object) -> bool:
        match node:
            case ir.CallRoutine(name=name, dynamic=dynamic):
                return dynamic is not None or name.lower() not in names
            case ir.Vendor() | ir.Opaque():
                return True
        return False

    def selects(node: object) -> bool:
        return unknown(node) or selects_frame(node)

    choosing = doing(program, selects)
    moving = doing(program, lambda node: isinstance(node, ir.Move))
    return frozenset(names - choosing - moving), frozenset(names - choosing)


def steps_in(body: ir.Body) -> set[str]:
    """Names of the points that are the way of relative moves."""
    return {
        node.target.id
        for node in walk(body)
        if isinstance(node, ir.Move) and node.relative is not None and isinstance(node.target, ir.Name)
    }


def coordinates(program: ir.Program) -> bool:
    """Is any move led by the second motion group?"""
    moves = (node for node in walk_for({"Move"}, *program.modules) if isinstance(node, ir.Move))
    return any(place == ir.System("coordinated") for move in moves for place, _ in move.settings)
