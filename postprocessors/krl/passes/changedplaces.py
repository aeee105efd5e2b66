"""Joint moves to places that were changed by components, for controllers whose targets say the sign of every axis.

A register with another Y may want axis 1 on the other side, and its old flags then name a posture that does not exist.
Controllers with coarse flags (elbow, wrist) do not notice. Such a move goes to the place without flags: the controller
keeps its posture and turns each axis the short way.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.fold import constant, constant_number
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import base_name
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_bodies, edit_each
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typing import type_of

FLAGS_LEFT_OUT = code(
    "changed-target-nearest",
    Severity.INFO,
    "this place was changed by its components, so the move says no arm configuration: it is kept as it is",
)

_PARTS = ("x", "y", "z", "a", "b", "c", "trans", "rot")
_FLAGGED = ("current_target", "joints_to_target")
_COMPUTED = (
    *("element_sum", "element_difference", "element_product", "displaced", "displaced_in_tool"),
    *("offset", "tool_offset", "rel_tool"),
)


@legalising()
def changed_places(program: ir.Program, context: Context) -> ir.Program:
    """The program in whose joint moves changed targets are poses; where no place says a posture there is none to leave
    out."""
    if not says_postures(program):
        return program
    changed = _changed(program)
    scopes = ProgramScope(program)

    def work(routine: ir.Routine, scope: Scope) -> ir.Routine:
        def body(statements: ir.Body) -> ir.Body:
            return tuple(fitted(rewrite_bodies(one, body)) for one in statements)

        def fitted(one: ir.Statement) -> ir.Statement:
            if not isinstance(one, ir.Move) or one.kind != "joint" or one.relative is not None:
                return one
            if not isinstance(type_of(one.target, scope), ir.TargetType) or not _stale(one.target, changed, scope):
                return one
            context.diagnostics.report(FLAGS_LEFT_OUT, one.origin)
            return replace(one, target=_without_flags(one.target, scope))

        return edit_bodies(routine, body)

    return edit_each(program, lambda module, one: work(one, scopes.routine(module, one)))


def says_postures(program: ir.Program) -> bool:
    """May a place of the program have flags? One that is written out with more than its pose has, and the place of the
    robot."""
    for one in walk_for({"Aggregate", *(f"function {name}" for name in _FLAGGED)}, *program.modules):
        match one:
            case ir.Aggregate(type_name=word, entries=entries):
                if (word is None or word.startswith("target")) and not {name for name, _ in entries} <= {*ir.POSE}:
                    return True
            case ir.Builtin(function=name) if name in _FLAGGED:
                return True
    return False


def _without_flags(target: ir.Expression, scope: Scope) -> ir.Expression:
    """The place alone; of a place that a constant way moves, the way in front of it, as a product has no flags."""
    match target:
        case ir.Builtin(function="offset", arguments=(ir.Name() as base, *way)):
            numbers = [constant_number(one, scope) for one in way]
            if None not in numbers and len(numbers) == 3:
                values = (*(one or 0.0 for one in numbers), 0.0, 0.0, 0.0)
                entries = tuple((part, ir.RealLiteral(one)) for part, one in zip(ir.POSE, values, strict=True))
                return ir.Binary(":", ir.Aggregate(entries, "pose"), base, origin=target.origin)
    return ir.Builtin("pose_of", (target,), origin=target.origin)


def _stale(target: ir.Expression, changed: frozenset[str], scope: Scope) -> bool:
    """May the flags of this target belong to another place? Constant offsets are reckoned with elsewhere."""
    if constant(target, scope, None) is not None:
        return False
    return _computed(target, changed)


def _computed(value: ir.Expression, changed: frozenset[str]) -> bool:
    match value:
        case ir.Builtin(function=name):
            return name in _COMPUTED or (name != "pose_of" and any(_computed(one, changed) for one in value.arguments))
        case ir.Call(name=name):
            return name.lower() in changed
        case ir.Name() | ir.Index() | ir.Field():
            return base_name(value) in changed
    return False


def _changed(program: ir.Program) -> frozenset[str]:
    """Variables, parameters and functions whose place was changed by components, or that were set from such ones;
    by name, so one that is changed in one scope counts as changed in all."""
    parameters = {
        one.name.lower(): [each.name.lower() for each in one.parameters]
        for module in program.modules
        for one in module.routines
    }
    pairs: list[tuple[str, ir.Expression]] = []
    found: set[str] = set()
    for module in program.modules:
        for routine in module.routines:
            for node in walk(routine):
                match node:
                    case ir.Assign(target=ir.Field(name=name, base=base)) if name in _PARTS:
                        found.add(base_name(base) or "")
                    case ir.Assign(target=target, value=value) if base_name(target) is not None:
                        pairs.append((base_name(target) or "", value))
                    case ir.Return(value=value) if value is not None:
                        pairs.append((routine.name.lower(), value))
                    case ir.CallRoutine(name=name, arguments=given) | ir.Call(name=name, arguments=given):
                        pairs.extend(_given(parameters.get(name.lower(), []), given))
    found.discard("")
    size = -1
    while size != len(found):
        size = len(found)
        known = frozenset(found)
        found.update(name for name, value in pairs if name not in known and _computed(value, known))
    return frozenset(found)


def _given(names: list[str], given: tuple[ir.Argument, ...]) -> list[tuple[str, ir.Expression]]:
    made: list[tuple[str, ir.Expression]] = []
    for at, argument in enumerate(given):
        name = argument.name.lower() if argument.name else names[at] if at < len(names) else None
        if name is not None and argument.value is not None:
            made.append((name, argument.value))
    return made
