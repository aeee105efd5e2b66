"""Targets of some components behind a move that ends at a known place, for targets whose moves want whole places.

What is left out stays as it was where the last move ended. Where those components are known, they are written into the
target: as numbers where these stand in the program, as the place with the given components changed where a taught place
decides them, so that a place that is taught anew takes them along. What is not known is left for `whole_targets`, which
takes it from the robot.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.capabilities import PlaceRule
from rpl.passes.fold import constant, constant_number, lasting
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.values.taughtvalues import WRITTEN, taught_names
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies, rewrite_parts
from rpl.passes.rigid import Pose
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typing import type_of
from rpl.passes.values import Target, real

_POSITION = ("x", "y", "z")
_NAMES = (*_POSITION, *ir.ANGLES)
_FRAMES = ("tool", "base", "robot_root", "interpolation")
_PLACES = 9
_STRAIGHT_DEG = 0.01
_BLOCKS = (ir.While, ir.For, ir.Loop, ir.Repeat)


@dataclass(slots=True)
class Known:
    """The last commanded place, seen in the frame in force: its components (mm, degrees), and the taught data that
    decides them. `place`: an expression that gives the whole of it in a run. `joint`: a joint move went there, so that
    its posture is the one that a place says."""

    parts: dict[str, float] = field(default_factory=dict)
    taught: tuple[str, ...] = ()
    place: ir.Expression | None = None
    joint: bool = False

    def copy(self) -> Known:
        return replace(self, parts=dict(self.parts))

    def become(self, other: Known) -> None:
        self.parts, self.taught, self.place, self.joint = other.parts, other.taught, other.place, other.joint

    def has(self, names: tuple[str, ...]) -> bool:
        return all(name in self.parts for name in names)

    def splits(self, missing: tuple[str, ...]) -> bool:
        """Do the angles that a copy of the place keeps stay what they are when others are set? At b = 90 degrees a and
        c turn about the same axis, and controllers share the turn out otherwise."""
        kept = [name for name in ir.ANGLES if name in missing]
        return len(kept) in (0, 3) or abs(abs(self.parts.get("b", 90.0)) - 90.0) > _STRAIGHT_DEG


@legalising(unless=lambda context: PlaceRule.PARTIAL in context.capabilities.places.rules)
def partial_places(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without places of some components."""
    if not any(_is_partial_move(node) for node in walk_for({"Move"}, program)):
        return program
    return _Places(program, context).program()


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
    def __init__(self, program: ir.Program, context: Context) -> None:
        self.source, self.context = program, context
        self.unchanged, self.moving = unchanged_in(program), moving_routines(program)
        self.scope: Scope | None = None
        self.declared: list[ir.Declaration] = []

    def program(self) -> ir.Program:
        scopes = ProgramScope(self.source)
        modules = []
        for module in self.source.modules:
            routines = []
            for routine in module.routines:
                self.scope, self.declared = scopes.routine(module, routine), []
                done = edit_bodies(routine, lambda body: self.body(body, Known()))
                routines.append(replace(done, declarations=(*done.declarations, *self.declared)))
            modules.append(replace(module, routines=tuple(routines)))
        return replace(self.source, modules=tuple(modules))

    def body(self, body: ir.Body, known: Known) -> ir.Body:
        """The body; `known` becomes what is known behind it."""
        return tuple(one for statement in body for one in self.statement(statement, known))

    def statement(self, statement: ir.Statement, known: Known) -> ir.Body:
        if isinstance(statement, ir.Move):
            *first, done = self.filled(statement, known)
            assert isinstance(done, ir.Move)  # `filled` ends with it
            known.become(self.behind(done, statement.target, known))
            return (*first, done)
        stays = not may_move(statement, self.moving)
        if isinstance(statement, _BLOCKS):
            inside = known.copy() if stays else Known()
            new = self.body(statement.body, inside)
            statement = rewrite_parts(statement, lambda value: value, None, {"body": new})
        else:
            statement = rewrite_bodies(statement, lambda body: self.body(body, known.copy()))
        if not stays:
            known.become(Known())
        return (statement,)

    def filled(self, move: ir.Move, known: Known) -> list[ir.Statement]:
        """The move with the components that are known, behind what works them out."""
        if move.relative is not None or _own_frame(move):
            return [move]
        steps: list[ir.Statement] = []
        via = None if move.via is None else self.whole(move.via, move, known, steps)
        target = self.whole(move.target, move, known, steps)
        if steps:
            steps = [replace(steps[0], origin=move.origin), *steps[1:]]
            move = replace(move, origin=replace(move.origin, comments=()))
        return [*steps, replace(move, target=target, via=via)]

    def whole(self, place: ir.Expression, move: ir.Move, known: Known, steps: list[ir.Statement]) -> ir.Expression:
        """A written place with those of its missing components that are known, if that makes it whole."""
        missing = _missing(place)
        if not missing or not isinstance(place, ir.Aggregate):
            return place
        later = replace(move.origin, comments=())
        type = None if known.place is None or self.scope is None else type_of(known.place, self.scope)
        fits = (known.joint or move.kind != "joint") and known.splits(missing)
        if known.taught and known.place is not None and fits and isinstance(type, ir.PoseType | ir.TargetType):
            name = ir.Name(self.context.fresh("rpl_here"))
            self.declare(ir.Variable(name.id, type, scope="routine"))
            steps.append(ir.Assign(name, known.place, origin=later))
            parts = ((part, value) for part, value in place.entries if part is not None)
            steps += [ir.Assign(ir.Field(name, part), value, origin=later) for part, value in parts]
            return name
        if not known.has(missing):
            return place
        if known.taught:
            what = "what this place leaves out"
            self.context.diagnostics.report(WRITTEN, move.origin, what=what, names=", ".join(known.taught))
        given = dict(place.entries)
        entries = tuple((name, given.get(name) or real(known.parts[name])) for name in _NAMES)
        rest = tuple((name, value) for name, value in place.entries if name not in _NAMES)
        return replace(place, entries=(*entries, *rest))

    def declare(self, variable: ir.Variable) -> None:
        assert self.scope is not None  # a routine is being looked at
        self.declared.append(variable)
        self.scope = self.scope.with_value(variable)

    def behind(self, move: ir.Move, asked: ir.Expression, known: Known) -> Known:
        """What is known where the move ends. `asked`: its target as the program has it."""
        if move.search is not None or move.swept is not None or _own_frame(move) or self.scope is None:
            return Known()
        if isinstance(move.target, ir.Aggregate) and (move.relative is not None or _by_components(move.target)):
            return self.changed(move, move.target, known)
        if move.relative is not None:
            return Known()
        joint = move.kind == "joint"
        if isinstance(asked, ir.Aggregate) and isinstance(move.target, ir.Name):
            copied = self.changed(move, asked, known)  # a variable that was made here gives the place
            return replace(copied, taught=copied.taught or known.taught, place=move.target, joint=joint and known.joint)
        value = constant(move.target, self.scope, self.unchanged)
        pose = value.pose if isinstance(value, Target) else value
        if not isinstance(pose, Pose):
            return Known()
        place = (pose.position.x, pose.position.y, pose.position.z, *pose.rotation.zyx)
        parts = {name: round(number, _PLACES) for name, number in zip(_NAMES, place, strict=True)}
        if lasting(move.target, self.scope) is not None:
            return Known(parts, joint=joint)
        return Known(parts, tuple(taught_names(self.scope, move.target)), move.target, joint)

    def changed(self, move: ir.Move, place: ir.Aggregate, known: Known) -> Known:
        """Components that are set, or added to those of the last place."""
        assert self.scope is not None  # the caller has asked
        if (place.type_name or "").startswith("joints"):
            return Known()
        given = {name: constant_number(value, self.scope, self.unchanged) for name, value in place.entries if name}
        taught = tuple(sorted({*known.taught, *taught_names(self.scope, place)}))
        if move.relative is None:
            found = {**known.parts, **{n: value for n, value in given.items() if n in _NAMES and value is not None}}
            found = {name: value for name, value in found.items() if given.get(name, value) is not None}
            return Known(found, () if set(_NAMES) <= given.keys() and not taught_names(self.scope, place) else taught)
        turned = any(given.get(name, 0.0) != 0.0 for name in ir.ANGLES)
        found = {} if turned else {name: value for name, value in known.parts.items() if name in ir.ANGLES}
        if move.relative == "base":
            for name in _POSITION:
                step = given.get(name, 0.0)
                if step is not None and name in known.parts:
                    found[name] = known.parts[name] + step
        return Known(found, taught)


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
