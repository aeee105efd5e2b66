"""Targets of some components behind a move that ends at a known place, for targets whose moves want whole places.

What is left out stays as it was where the last move ended. Where those components are known (taught or written data
that nothing assigns), they are written into the target. What is not known is left for `whole_targets`, which takes it
from the robot.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.fold import constant, constant_number
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.editing import edit_bodies
from rpl.passes.legalise.walk import unchanged_in
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.rigid import Pose
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.values import Target, real

_POSITION = ("x", "y", "z")
_ANGLES = ("a", "b", "c")
_NAMES = (*_POSITION, *_ANGLES)
_FRAMES = ("tool", "base", "robot_root", "interpolation")
_PLACES = 9
_BLOCKS = (ir.While, ir.For, ir.Loop, ir.Repeat)

Known = dict[str, float]  # components of the last commanded place, seen in the frame in force: mm, degrees


def partial_places(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without places of some components."""
    if context.capabilities.partial_targets or not any(_is_partial_move(node) for node in walk(program)):
        return program
    return _Places(program).program()


def _is_partial_move(node: object) -> bool:
    return isinstance(node, ir.Move) and bool(_missing(node.target) or _missing(node.via))


def _missing(place: ir.Expression | None) -> tuple[str, ...]:
    """The components that a written place leaves out; none when it is whole, or not written by components."""
    if not isinstance(place, ir.Aggregate) or not _by_components(place):
        return ()
    named = {name for name, _ in place.entries}
    return tuple(name for name in _NAMES if name not in named)


def _by_components(place: ir.Aggregate) -> bool:
    if not (place.type_name or "").startswith(("target", "pose")):
        return False
    return not {name for name, _ in place.entries} & {None, "trans", "rot"}


class _Places:
    def __init__(self, program: ir.Program) -> None:
        self.source = program
        self.unchanged, self.moving = unchanged_in(program), moving_routines(program)
        self.scope: Scope | None = None

    def program(self) -> ir.Program:
        scopes = ProgramScope(self.source)
        modules = []
        for module in self.source.modules:
            routines = []
            for routine in module.routines:
                self.scope = scopes.routine(module, routine)
                routines.append(edit_bodies(routine, lambda body: self.body(body, {})))
            modules.append(replace(module, routines=tuple(routines)))
        return replace(self.source, modules=tuple(modules))

    def body(self, body: ir.Body, known: Known) -> ir.Body:
        """The body; `known` becomes what is known behind it."""
        return tuple(self.statement(statement, known) for statement in body)

    def statement(self, statement: ir.Statement, known: Known) -> ir.Statement:
        if isinstance(statement, ir.Move):
            done = self.filled(statement, known)
            found = self.behind(done, known)
            known.clear()
            known.update(found)
            return done
        stays = not may_move(statement, self.moving)
        if isinstance(statement, _BLOCKS):
            inside: Known = dict(known) if stays else {}
            new = self.body(statement.body, inside)
            statement = rewrite_parts(statement, lambda value: value, None, {"body": new})
        else:
            statement = rewrite_parts(statement, lambda value: value, lambda body: self.body(body, dict(known)))
        if not stays:
            known.clear()
        return statement

    def filled(self, move: ir.Move, known: Known) -> ir.Move:
        """The move with the components that are known."""
        if move.relative is not None or _own_frame(move):
            return move
        via = None if move.via is None else _with(move.via, known)
        return replace(move, target=_with(move.target, known), via=via)

    def behind(self, move: ir.Move, known: Known) -> Known:
        """What is known where the move ends."""
        if move.search is not None or move.swept is not None or _own_frame(move) or self.scope is None:
            return {}
        if isinstance(move.target, ir.Aggregate) and (move.relative is not None or _by_components(move.target)):
            return self.changed(move, move.target, known)
        if move.relative is not None:
            return {}
        value = constant(move.target, self.scope, self.unchanged)
        pose = value.pose if isinstance(value, Target) else value
        if not isinstance(pose, Pose):
            return {}
        place = (pose.position.x, pose.position.y, pose.position.z, *pose.rotation.zyx)
        return {name: round(number, _PLACES) for name, number in zip(_NAMES, place, strict=True)}

    def changed(self, move: ir.Move, place: ir.Aggregate, known: Known) -> Known:
        """Components that are set, or added to those of the last place."""
        assert self.scope is not None  # the caller has asked
        if (place.type_name or "").startswith("joints"):
            return {}
        given = {name: constant_number(value, self.scope, self.unchanged) for name, value in place.entries if name}
        if move.relative is None:
            found = {**known, **{name: value for name, value in given.items() if name in _NAMES and value is not None}}
            return {name: value for name, value in found.items() if given.get(name, value) is not None}
        turned = any(given.get(name, 0.0) != 0.0 for name in _ANGLES)
        found = {} if turned else {name: value for name, value in known.items() if name in _ANGLES}
        if move.relative == "base":
            for name in _POSITION:
                step = given.get(name, 0.0)
                if step is not None and name in known:
                    found[name] = known[name] + step
        return found


def may_move(statement: ir.Statement, moving: set[str]) -> bool:
    """May the robot, or the frame its place is seen from, be another one behind it? `moving`: routines that do that."""
    for node in walk(statement):
        match node:
            case ir.Move() | ir.Spline() | ir.MoveExternal() | ir.Label():
                return True
            case ir.Assign(target=target) if _sets_frame(target):
                return True
            case ir.CallRoutine(dynamic=dynamic) if dynamic is not None:
                return True
            case ir.CallRoutine(name=name) | ir.Call(name=name) if name.lower() in moving:
                return True
    return False


def _own_frame(move: ir.Move) -> bool:
    """Is the place of the move seen otherwise than that of the moves around it?"""
    set_here = any(not isinstance(one, ir.System) or one.name in _FRAMES for one, _ in move.settings)
    return set_here or move.tool is not None or move.frame is not None or move.group != 1


def _with(place: ir.Expression, known: Known) -> ir.Expression:
    """A written place with those of its missing components that are known, if that makes it whole."""
    missing = _missing(place)
    if not missing or not isinstance(place, ir.Aggregate) or not all(name in known for name in missing):
        return place
    given = dict(place.entries)
    whole = tuple((name, given.get(name) or real(known[name])) for name in _NAMES)
    rest = tuple((name, value) for name, value in place.entries if name not in _NAMES)
    return replace(place, entries=(*whole, *rest))


def _sets_frame(target: ir.Expression) -> bool:
    while isinstance(target, ir.Field):
        target = target.base
    return isinstance(target, ir.System) and target.name in _FRAMES


def moving_routines(program: ir.Program) -> set[str]:
    """Routines that move the robot or set a frame, folded, with those that call them."""
    found: set[str] = set()
    calls: dict[str, set[str]] = {}
    for module in program.modules:
        for routine in module.routines:
            name = routine.name.lower()
            for node in walk(routine):
                match node:
                    case ir.Move() | ir.Spline() | ir.MoveExternal():
                        found.add(name)
                    case ir.Assign(target=target) if _sets_frame(target):
                        found.add(name)
                    case ir.CallRoutine(name=called) | ir.Call(name=called):
                        calls.setdefault(name, set()).add(called.lower())
    size = -1
    while size != (size := len(found)):
        found |= {name for name, called in calls.items() if called & found}
    return found


__all__ = ["may_move", "moving_routines", "partial_places"]
