"""What a program does with the joints and the components of its positions, and whether it goes round corners."""

from __future__ import annotations

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.kinds import walk_for

from .. import tables
from ..operands import numbered
from ..places import Constants


def counts_joints(program: ir.Program) -> bool:
    """Does the program calculate with the joints of positions, or move them by a way?"""
    for node in walk_for({"Field", "System", "Move", "Builtin"}, program):
        match node:
            case ir.Field(name=name) if name.lower() in tables.JOINT_ELEMENTS:
                return True
            case ir.System(name="actual_joint") | ir.Move(kind="joint", relative=str()) | ir.Move(relative="joints"):
                return True
            case ir.Builtin(function="joints_to_target", arguments=(_, _, *_)):
                return True  # seen with a tool of its own: a pose that stands for the joints has the tool in it
    return False


def goes_to_joints(program: ir.Program, constants: Constants) -> bool:
    """Has a move joints as its target?"""
    for module in program.modules:
        for routine in module.routines:
            within = constants.routine(routine)
            for node in walk(routine.body):
                if isinstance(node, ir.Move) and within.is_joints(node.target):
                    return True
    return False


def filled(program: ir.Program) -> list[int]:
    """Position variables that get their values component by component where no whole place has been stored in them.
    They begin as a pose without a posture, which keeps the arm's present one; SETE leaves the posture that the
    controller's memory happens to have."""
    declared = {
        place
        for module in program.modules
        for one in module.declarations
        if isinstance(one, ir.Variable) and (place := _number(ir.Name(one.name))) is not None
    }
    found: set[int] = set()
    for module in program.modules:
        for routine in module.routines:
            for body in bodies(routine):
                found |= _filled_in(body, declared, declared)
    return sorted(found)


def _filled_in(body: ir.Body, before: set[int], declared: set[int]) -> set[int]:
    """The same of a body that begins with these stored. A jump may come to a label from anywhere."""
    stored, found = set(before), set[int]()
    for statement in body:
        match statement:
            case ir.Label():
                stored = set(declared)
            case ir.Assign(target=ir.Field(base=base)) if (place := _number(base)) is not None:
                found |= {place} - stored
            case ir.Assign(target=target) if (place := _number(target)) is not None:
                stored.add(place)
        for inner in blocks(statement):
            found |= _filled_in(inner, stored, declared)
    return found


def _number(place: ir.Expression) -> int | None:
    """The number of a position variable; None for anything else."""
    found = numbered(place)
    return found[1] if found is not None and found[0] == "P" else None


def goes_round_corners(program: ir.Program) -> bool:
    """Does any move of a routine go round a corner?"""
    return any(
        isinstance(node, ir.Move) and not isinstance(node.blend, ir.BlendStop | None)
        for module in program.modules
        for routine in module.routines
        for node in walk(routine.body)
    )
