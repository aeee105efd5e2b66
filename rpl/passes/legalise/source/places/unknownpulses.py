"""Points in motor pulses of an arm whose pulses per degree nobody has published: taught points without a value.

Their names and the moves to them are as good as any; only where they are has to be taught. So they are data that the
source's controller keeps, which the program asks for at its beginning, and no statements that are lost. Where moves
alone name them they are places and no joints, which straight moves would have to work out.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from typing import TypeGuard

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import rewrite
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.motion.pulsecounts import count_of
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.stages import legalising

UNKNOWN = code(
    "pulses-unknown",
    Severity.WARNING,
    "nobody has said how many pulses of {robot} make a degree: {count} points in pulses stand without a value: {names}",
    "give a robot file with pulses_per_degree, or teach the points on the robot that runs the result",
)
_NAMED = 6  # so many names stand in the report


@legalising(unless=lambda context: not context.foreign)
def unknown_pulses(program: ir.Program, context: Context) -> ir.Program:
    """Only without the arm's pulses per degree; the zero of all joints is known without them."""
    if context.robot is not None and context.robot.pulse_scale is not None:
        return program
    routines = [routine for module in program.modules for routine in module.routines]
    points = [one for module in program.modules for one in module.declarations if _is_counted(one)]
    own = Counter(one.name.lower() for routine in routines for one in routine.declarations if _is_counted(one))
    points += [one for routine in routines for one in routine.declarations if _is_counted(one)]
    if not points:
        return program
    shown = ", ".join(one.name for one in points[:_NAMED]) + (", ..." if len(points) > _NAMED else "")
    robot = context.robot.name if context.robot is not None else "the arm"
    context.diagnostics.report(UNKNOWN, points[0].origin, robot=robot, count=len(points), names=shown)
    places = _places(program)
    modules = []
    for module in program.modules:
        given: list[ir.Declaration] = [
            _unknown(one, one.name, module.dialect, places) if _is_counted(one) else one for one in module.declarations
        ]
        done = []
        for routine in module.routines:
            new = {
                one.name.lower(): one.name
                if own[one.name.lower()] == 1
                else context.fresh(f"{routine.name}_{one.name}")
                for one in routine.declarations
                if _is_counted(one)
            }
            given += [
                _unknown(one, new[one.name.lower()], module.dialect, places)
                for one in routine.declarations
                if _is_counted(one)
            ]
            kept = tuple(one for one in routine.declarations if not _is_counted(one))
            done.append(_renamed(replace(routine, declarations=kept), new) if new else routine)
        modules.append(replace(module, declarations=tuple(given), routines=tuple(done)))
    return replace(program, modules=tuple(modules))


def _is_counted(one: object) -> TypeGuard[ir.Variable]:
    match one:
        case ir.Variable(initial=ir.Builtin(function="joints_from_pulses", arguments=pulses)):
            return any(count_of(each) not in (0.0, None) for each in pulses)
    return False


def _places(program: ir.Program) -> set[str]:
    """Names that nothing but moves says, as where they go."""
    said, gone_to = Counter[str](), Counter[str]()
    for node in walk_for({"Name", "Move"}, *program.modules):
        match node:
            case ir.Name(id=name):
                said[name.lower()] += 1
            case ir.Move(target=ir.Name(id=name), relative=None):
                gone_to[name.lower()] += 1
    return {name for name, count in said.items() if gone_to[name] == count}


def _unknown(one: ir.Variable, name: str, dialect: str, places: set[str]) -> ir.Variable:
    type: ir.Type = ir.TargetType(dialect) if one.name.lower() in places else one.type
    value = ir.VendorValue(dialect, one.name, type, origin=one.origin)
    return replace(one, name=name, type=type, initial=value, storage="persistent", scope="global")


def _renamed(routine: ir.Routine, names: dict[str, str]) -> ir.Routine:
    def change(node: object) -> object:
        if isinstance(node, ir.Name) and node.id.lower() in names:
            return replace(node, id=names[node.id.lower()])
        return node

    return rewrite(routine, change)


__all__ = ["unknown_pulses"]
