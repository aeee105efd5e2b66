"""Corners that overlap, between controllers that leave out a move then (Universal Robots) and those that make both
corners smaller. Only places and sizes that are constant can be told.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes import rigid
from rpl.passes.fold import constant, constant_number
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.editing import edit_bodies, edit_each
from rpl.passes.legalise.effects import blocks
from rpl.passes.legalise.jumps import inside
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.values import Record, pose_of

LEFT_OUT = code(
    "move-left-out",
    Severity.WARNING,
    "the blend of this move and the one before it are longer than the {way:g} mm between them: the controller leaves"
    " the move out, and so does this program",
)
SMALLER = code(
    "corner-made-smaller",
    Severity.INFO,
    "two corners share {way:g} mm: each is written with half of that, as the source's controller makes them; the"
    " target's would leave a move out",
)
UNKNOWN = code(
    "corners-may-overlap",
    Severity.WARNING,
    "how large this corner or the next one is, or where it lies, is not known here: if both are longer than the way"
    " between them, the target's controller leaves a move out",
    "look at the places, or give the moves smaller corners",
)
_SLACK_MM = 1e-3
_LOOPS = (ir.For, ir.While, ir.Repeat, ir.Loop)


def left_out_moves(program: ir.Program, context: Context) -> ir.Program:
    """The program without the moves that its own controller leaves out, for controllers that drive them."""
    source, target = (bool(rules_of(one).inputs.overlapping_blends) for one in (context.source, context.target))
    if not source or target:
        return program

    def change(scope: Scope, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        last: _Corner | None = None
        for statement in body:
            corner = _corner(statement, scope)
            paths = last is not None and corner is not None and "joint" not in (last.move.kind, corner.move.kind)
            if paths and corner is not None and last is not None and last.overlaps(corner):
                context.diagnostics.report(LEFT_OUT, statement.origin, way=round(last.way_to(corner), 3))
                continue
            done.append(statement)
            if not isinstance(statement, ir.Nothing):
                last = corner
        return body if len(done) == len(body) else tuple(done)

    return _rewritten(program, change)


def fitting_corners(program: ir.Program, context: Context) -> ir.Program:
    """For controllers that would leave out a move: two corners that overlap get half of the way between them each."""
    source, target = (bool(rules_of(one).inputs.overlapping_blends) for one in (context.source, context.target))
    cornered = any(isinstance(node, ir.Move) and node.blend is not None for node in walk(program.modules))
    if source or not target or not cornered:
        return program

    told: list[ir.Move] = []
    order = _Order(program)

    def change(scope: Scope, body: ir.Body) -> ir.Body:
        done = list(body)
        last: tuple[int, _Corner] | None = None
        flown_by: ir.Move | None = None
        for index, statement in enumerate(body):
            if not isinstance(statement, ir.Move):
                first, end = order.flying((statement,), scope), order.flying((statement,), scope, last=True)
                if first is not None and (flown_by is not None or (isinstance(statement, _LOOPS) and end is not None)):
                    told.append(flown_by or first)
                if isinstance(statement, ir.WaitForMotion):
                    last = flown_by = None
                elif isinstance(statement, ir.Label):
                    last, flown_by = None, flown_by or order.flying(body, scope, last=True)
                elif order.moves(statement):
                    last, flown_by = None, end or flown_by
                continue
            corner = _corner(statement, scope)
            if corner is not None and last is not None:
                if last[1].overlaps(corner):
                    way = last[1].way_to(corner)
                    context.diagnostics.report(SMALLER, last[1].move.origin, way=round(way, 3))
                    done[last[0]] = last[1].of_size(done[last[0]], way / 2.0)
                    done[index] = corner.of_size(statement, way / 2.0)
                    corner = replace(corner, size=min(corner.size, way / 2.0))
            elif flown_by is not None and _flies_by(statement, scope):
                told.append(flown_by)
            last = (index, corner) if corner is not None else None
            flown_by = statement if _flies_by(statement, scope) else None
        return body if all(new is old for new, old in zip(done, body, strict=True)) else tuple(done)

    fitted = _rewritten(program, change)
    for move in told[:1]:
        context.diagnostics.report(UNKNOWN, move.origin)
    return fitted


class _Order:
    """Which path move with a corner may come first or last in a part of the program, into routines that it calls."""

    def __init__(self, program: ir.Program) -> None:
        scopes = ProgramScope(program)
        self.routines = {
            routine.name.lower(): (scopes.routine(module, routine), routine)
            for module in program.modules
            for routine in module.routines
        }
        self.known: dict[tuple[str, bool], ir.Move | None] = {}
        self.moving: dict[str, bool] = {}

    def flying(self, body: ir.Body, scope: Scope, last: bool = False) -> ir.Move | None:
        for statement in reversed(body) if last else body:
            if isinstance(statement, ir.WaitForMotion):
                return None
            if isinstance(statement, ir.Move):
                return statement if _flies_by(statement, scope) else None
            found = [one for inner in blocks(statement) if (one := self.flying(inner, scope, last)) is not None]
            found += [one for name in _called(statement) if (one := self.of_routine(name, last)) is not None]
            if found:
                return found[0]
        return None

    def of_routine(self, name: str, last: bool) -> ir.Move | None:
        if (name, last) not in self.known and name in self.routines:
            self.known[name, last] = None  # a routine that calls itself adds nothing to what it does
            scope, routine = self.routines[name]
            self.known[name, last] = self.flying(routine.body, scope, last)
        return self.known.get((name, last))

    def moves(self, statement: ir.Statement) -> bool:
        """May it move the robot?"""
        return any(
            isinstance(node, ir.Move)
            or (isinstance(node, ir.CallRoutine | ir.Call) and self.routine_moves(node.name.lower()))
            for node in walk(statement)
        )

    def routine_moves(self, name: str) -> bool:
        if name not in self.moving and name in self.routines:
            self.moving[name] = False
            self.moving[name] = any(self.moves(one) for one in self.routines[name][1].body)
        return self.moving.get(name, False)


def _called(statement: ir.Statement) -> list[str]:
    """The routines that a statement itself calls, not those in its bodies."""
    if blocks(statement):
        return []
    return [one.name.lower() for one in walk(statement) if isinstance(one, ir.CallRoutine | ir.Call)]


@dataclass(frozen=True, slots=True)
class _Corner:
    """A path move with a corner of constant size (mm; 0: it stops) at a constant place."""

    move: ir.Move
    place: rigid.Vector
    frames: tuple[object, object]
    size: float

    def way_to(self, other: _Corner) -> float:
        return other.place.plus(self.place, -1.0).length

    def overlaps(self, other: _Corner) -> bool:
        way = self.way_to(other)
        both = min(self.size, other.size) > 0.0 and self.frames == other.frames
        return both and way > _SLACK_MM and self.size + other.size > way + _SLACK_MM

    def of_size(self, statement: ir.Statement, most: float) -> ir.Statement:
        """The move, with at most that size."""
        if self.size <= most or not isinstance(statement, ir.Move):
            return statement
        size = ir.Quantity(ir.RealLiteral(float(f"{most:.9g}")), "mm")
        blend = statement.blend
        new = replace(blend, distance=size) if isinstance(blend, ir.BlendZone) else ir.BlendDistance(size)
        return replace(statement, blend=new)


def _flies_by(statement: ir.Statement, scope: Scope) -> bool:
    """Is it a path move with a corner, as far as can be told?"""
    if not isinstance(statement, ir.Move) or statement.kind == "joint":
        return False
    return _size(statement.blend, scope) != 0.0


def _corner(statement: ir.Statement, scope: Scope) -> _Corner | None:
    if not isinstance(statement, ir.Move) or statement.relative is not None:
        return None
    pose, size = pose_of(constant(statement.target, scope)), _size(statement.blend, scope)
    if pose is None or size is None:
        return None
    return _Corner(statement, pose.position, (statement.tool, statement.frame), size)


def _size(blend: ir.Blend | None, scope: Scope) -> float | None:
    match blend:
        case ir.BlendDistance(distance=distance) if distance is not None:
            return constant_number(distance, scope)
        case ir.BlendZone(distance=distance) if distance is not None:
            return constant_number(distance, scope)
        case ir.BlendZone(zone=zone):
            value = constant(zone, scope)
            if not isinstance(value, Record):
                return None
            path = value.part("path")
            return 0.0 if value.part("stop") else float(path) if isinstance(path, int | float) else None
        case None | ir.BlendStop():
            return 0.0
    return None


def _rewritten(program: ir.Program, change: Callable[[Scope, ir.Body], ir.Body]) -> ir.Program:
    scopes = ProgramScope(program)

    def work(module: ir.Module, routine: ir.Routine) -> ir.Routine:
        scope = scopes.routine(module, routine)

        def on_body(body: ir.Body) -> ir.Body:
            inner = [statement if isinstance(statement, ir.Move) else inside(statement, on_body) for statement in body]
            same = all(new is old for new, old in zip(inner, body, strict=True))
            return change(scope, body if same else tuple(inner))

        return edit_bodies(routine, on_body)

    return edit_each(program, work)


__all__ = ["fitting_corners", "left_out_moves"]
