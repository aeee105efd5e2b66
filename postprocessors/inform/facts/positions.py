"""What a program does with the joints and the components of its positions, and whether it goes round corners."""

from __future__ import annotations

from rpl import ir
from rpl.ir.walk import walk
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
    """Position variables that get their values component by component. They begin as a pose without a posture, which
    keeps the arm's present one; SETE leaves the posture that the controller's memory happens to have."""
    places: set[int] = set()
    declared = {
        numbered(ir.Name(one.name))
        for module in program.modules
        for one in module.declarations
        if isinstance(one, ir.Variable)
    }
    for module in program.modules:
        for routine in module.routines:
            for node in walk(routine.body):
                if not isinstance(node, ir.Assign) or not isinstance(node.target, ir.Field):
                    continue
                place = numbered(node.target.base)
                if place is not None and place[0] == "P" and place not in declared:
                    places.add(place[1])
    return sorted(places)


def goes_round_corners(program: ir.Program) -> bool:
    """Does any move of a routine go round a corner?"""
    return any(
        isinstance(node, ir.Move) and not isinstance(node.blend, ir.BlendStop | None)
        for module in program.modules
        for routine in module.routines
        for node in walk(routine.body)
    )
