"""Shifts of places as people write them in KRL, which has no function for them: a constant one is a frame of the data
list in front of the place (`LIN shift_z100:XPick`; behind it where it goes along the tool), a computed one is the place
with other components (`Box=XCorner`, `Box.X=XCorner.X+...`). A product of frames has no arm configuration, so a joint
move to a place that may say one goes to such a place as well.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.fold import Unchanged, constant_number
from rpl.passes.legalise.context import Context, ProgramScope
from rpl.passes.legalise.facts.motion.externalaxes import has_external_axes
from rpl.passes.legalise.rewriting.editing import edit_bodies, edit_each, map_body
from rpl.passes.legalise.rewriting.headdata import ShiftFrames, with_data
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies
from rpl.passes.scope import Scope
from rpl.passes.typing import type_of
from rpl.writing.numbers import added

from .changedplaces import says_postures

__all__ = ["said_shifts"]

_PARTS = ("x", "y", "z")


@legalising(sees=("function offset", "function tool_offset"))
def said_shifts(program: ir.Program, context: Context) -> ir.Program:
    """What is neither stays a function."""
    worker = _Shifts(context, has_external_axes(program), says_postures(program), unchanged_in(program))
    scopes = ProgramScope(program)

    def work(module: ir.Module, routine: ir.Routine) -> ir.Routine:
        worker.enter(scopes.routine(module, routine))
        done = edit_bodies(routine, worker.body)
        return replace(done, declarations=(*done.declarations, *worker.moved.values()))

    done = edit_each(program, work)
    return with_data(done, worker.shifts.declared()) if worker.shifts.names else done


@dataclass(slots=True)
class _Shifts:
    """`external`, `postures`: do places say external axes, postures? `unchanged`: data that nothing sets. `moved`: the
    variables of the present routine for places with other components, by the name of the place."""

    context: Context
    external: bool
    postures: bool
    unchanged: Unchanged
    shifts: ShiftFrames = field(init=False)
    scope: Scope = field(init=False)
    moved: dict[str, ir.Variable] = field(init=False)

    def __post_init__(self) -> None:
        self.shifts = ShiftFrames(self.context)

    def enter(self, scope: Scope) -> None:
        self.scope, self.moved = scope, {}

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def statement(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.Assign(
                target=ir.Name(id=name) as target,
                value=ir.Builtin(function="offset", arguments=(ir.Name() as base, *shift)),
            ) if self.can_be_parts(name, base, shift):
                return self.in_parts(statement, target, base, shift)
            case ir.Move(relative=None, target=ir.Builtin() as target) if self.needs_pose_alone(statement.kind, target):
                statement = replace(statement, target=self.in_front(target))
            case ir.Move(
                kind="joint",
                relative=None,
                target=ir.Builtin(function="offset", arguments=(ir.Name() as base, *shift)),
            ) if not any(isinstance(node, ir.Call) for node in walk(*shift)):
                place, later = self.moved_place(base), replace(statement.origin, comments=())
                first = ir.Assign(place, base, origin=statement.origin)
                return *self.in_parts(first, place, base, shift), replace(statement, target=place, origin=later)
            case ir.Move(target=ir.Binary(op=":", left=ir.Aggregate() as way, right=ir.Name()) as target):
                values = [constant_number(one, self.scope) for _, one in way.entries]
                if None not in values and not any(values[3:]):
                    frame = self.shifts.frame([one or 0.0 for one in values[:3]])
                    statement = replace(statement, target=replace(target, left=frame))
        return (rewrite_bodies(statement, self.body),)

    def can_be_parts(self, name: str, base: ir.Name, shift: list[ir.Expression]) -> bool:
        """Does the shift look at nothing that the first of the assignments changes? Then its parts may follow."""
        read = {node.id.lower() for node in walk(*shift) if isinstance(node, ir.Name)}
        calls = any(isinstance(node, ir.Call) for node in walk(*shift))
        kinds = (type_of(one, self.scope) for one in (ir.Name(name), base))
        places = all(isinstance(one, ir.TargetType | ir.PoseType) for one in kinds)
        parts = {node.base.id for node in walk(*shift) if isinstance(node, ir.Field) and isinstance(node.base, ir.Name)}
        aliases = bool(parts) and any(self.is_alias(one) for one in {name, *parts})
        return places and name.lower() not in {base.id.lower(), *read} and not calls and not aliases

    def is_alias(self, name: str) -> bool:
        """May the name stand for a place of another name as well?"""
        symbol = self.scope.value(name)
        declared = symbol.declaration if symbol is not None else None
        return isinstance(declared, ir.Parameter) and declared.mode == "reference"

    def in_parts(self, whole: ir.Assign, target: ir.Name, base: ir.Name, shift: list[ir.Expression]) -> ir.Body:
        done: list[ir.Statement] = [replace(whole, value=base)]
        later = replace(whole.origin, comments=())
        for part, distance in zip(_PARTS, shift, strict=False):
            if constant_number(distance, self.scope) != 0.0:
                value = added(ir.Field(base, part), distance)
                done.append(ir.Assign(ir.Field(target, part), value, origin=later))
        return tuple(done)

    def moved_place(self, base: ir.Name) -> ir.Name:
        """The routine's variable for a place beside this one."""
        key = base.id.lower()
        if key not in self.moved:
            name = self.context.fresh(f"{base.id}_moved")
            self.moved[key] = ir.Variable(name, type_of(base, self.scope) or ir.PoseType(), scope="routine")
        return ir.Name(self.moved[key].name)

    def known(self, number: ir.Expression) -> float | None:
        """Of data that nothing sets and that no controller keeps, so that nobody changes it at the robot."""
        symbols = [self.scope.value(one.id) for one in walk(number) if isinstance(one, ir.Name)]
        kept = (one.declaration for one in symbols if one is not None and isinstance(one.declaration, ir.Variable))
        return constant_number(number, self.scope, None if any(map(_is_kept, kept)) else self.unchanged)

    def needs_pose_alone(self, kind: str, shifted: ir.Builtin) -> bool:
        """Does a move there ask for nothing that a product of frames lacks?"""
        if not shifted.arguments or not isinstance(type_of(shifted.arguments[0], self.scope), ir.TargetType):
            return True
        asks = kind == "joint" and self.postures
        return not asks and (shifted.function == "offset" or not self.external)

    def in_front(self, target: ir.Expression) -> ir.Expression:
        match target:
            case ir.Builtin(function="offset" | "tool_offset" as way, arguments=(base, *shift)) if isinstance(
                base, ir.Name
            ) or (way == "tool_offset" and _is_product(base)):
                numbers = [self.known(one) for one in shift]
                known = [one for one in numbers if one is not None]
                if len(known) < len(numbers) or any(known[3:]):
                    return target
                frame = self.shifts.frame(known[:3])
                left, right = (frame, base) if way == "offset" else (base, frame)
                return ir.Binary(":", left, right, origin=target.origin)
        return target


def _is_kept(one: ir.Variable) -> bool:
    return one.storage == "persistent"


def _is_product(place: ir.Expression) -> bool:
    return (
        isinstance(place, ir.Binary)
        and place.op == ":"
        and all(isinstance(one, ir.Name) or _is_product(one) for one in (place.left, place.right))
    )
