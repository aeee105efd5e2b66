"""Paths on which the tool keeps the orientation of their start (`orientation_mode` constant), for targets whose paths
always turn to the orientation of their end.

The place that such a path reaches has the start's orientation, whatever its target says. Where the start is known (the
move before it goes to taught or written data), the target gets that orientation; where both are the same, nothing
changes; where it cannot be known, the loss is named at the move. An arc that keeps the tool as it is to the arc is
refused.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.capabilities import PathRule
from rpl.passes.fold import constant, real
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.taughtvalues import WRITTEN, taught_names, tell_written
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.rewriting.stopping import stopped
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.rigid import NO_TURN, Pose, Rotation
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typewords import type_word
from rpl.passes.values import Target

LOST = code(
    "constant-orientation-lost",
    Severity.LOSS,
    "this path keeps the orientation of its start, which is not known here; the target's path turns to the one that is"
    " written at its end",
    "write the orientation that the tool has at the start into the target",
)
FIXED = code(
    "fixed-arc-lost",
    Severity.LOSS,
    "along this arc the tool stays as it is to the arc; the target's arcs turn it to the orientation at their end",
    "write the orientation that the tool has at the end of the arc, and arcs of half a circle or more in parts",
    stops=True,
)
_MODE = "orientation_mode"
_FRAMES = ("tool", "base")
_SAME = 1e-9  # of the quaternions' product: less than a hundredth of a degree
_ANGLES = frozenset("abc")


@legalising(unless=lambda context: _MODE in context.capabilities.system_variables)
def constant_orientations(program: ir.Program, context: Context) -> ir.Program:
    """The program whose paths end with the orientation that they reach."""
    if not any(_constant(node) for node in walk(program)):
        return program
    return _Paths(program, context).program()


def _constant(node: object) -> bool:
    match node:
        case ir.Assign(target=ir.System(name="orientation_mode"), value=ir.EnumLiteral(member="constant")):
            return True
        case ir.Move(orientation="constant"):
            return True
        case ir.Move(settings=settings):
            return any(isinstance(place, ir.System) and place.name == _MODE for place, _ in settings)
    return False


@dataclass(slots=True)
class _State:
    """What is known at a place of the run: the mode (empty: not known), the orientation of the last commanded place."""

    mode: str = ""
    last: Rotation | None = None
    taught: tuple[str, ...] = ()  # taught data that decides the orientation

    def met(self, other: _State) -> _State:
        same = self.last is not None and other.last is not None and _same(self.last, other.last)
        taught = tuple(sorted({*self.taught, *other.taught}))
        return _State(self.mode if self.mode == other.mode else "", self.last if same else None, taught)


@dataclass(slots=True)
class _Effect:
    """What a routine and those it calls may change: the mode, the place (or the frames it is seen from)."""

    mode: bool = False
    place: bool = False
    calls: set[str] = field(default_factory=set)


class _Paths:
    def __init__(self, program: ir.Program, context: Context) -> None:
        self.source, self.context = program, context
        self.unchanged = unchanged_in(program)
        self.scopes = ProgramScope(program)
        self.effects = _effects(program)
        self.scope: Scope | None = None
        self.reports = False

    def program(self) -> ir.Program:
        modules = tuple(
            replace(one, routines=tuple(self.routine(one, routine) for routine in one.routines))
            for one in self.source.modules
        )
        return replace(self.source, modules=modules)

    def routine(self, module: ir.Module, routine: ir.Routine) -> ir.Routine:
        self.scope, self.reports = self.scopes.routine(module, routine), True
        return edit_bodies(routine, lambda body: self.body(body, _State()))

    def body(self, body: ir.Body, state: _State) -> ir.Body:
        return tuple(self.statement(one, state) for one in body)

    def statement(self, statement: ir.Statement, state: _State) -> ir.Statement:
        match statement:
            case ir.Assign(target=ir.System(name="orientation_mode"), value=value):
                state.mode = value.member if isinstance(value, ir.EnumLiteral) else ""
            case ir.Assign(target=ir.System(name=name)) if name in _FRAMES:
                state.last = None
            case ir.Move():
                return self.move(statement, state)
            case ir.If(branches=branches, otherwise=otherwise):
                ends: list[_State] = []
                new = tuple((condition, self.inner(body, state, ends)) for condition, body in branches)
                done = replace(statement, branches=new, otherwise=self.inner(otherwise, state, ends))
                return self.joined(done, state, ends)
            case ir.Switch(cases=cases, default=default):
                ends = [] if default is not None else [replace(state)]
                new_cases = tuple(replace(case, body=self.inner(case.body, state, ends)) for case in cases)
                other = None if default is None else self.inner(default, state, ends)
                return self.joined(replace(statement, cases=new_cases, default=other), state, ends)
            case ir.While(body=body) | ir.For(body=body) | ir.Loop(body=body) | ir.Repeat(body=body):
                return self.loop(statement, body, state)
            case ir.Label() | ir.Spline():
                state.mode, state.last = "", None
        self.called(statement, state)
        return statement

    def inner(self, body: ir.Body, state: _State, ends: list[_State]) -> ir.Body:
        inside = replace(state)
        done = self.body(body, inside)
        ends.append(inside)
        return done

    def joined(self, statement: ir.Statement, state: _State, ends: list[_State]) -> ir.Statement:
        met = ends[0]
        for end in ends[1:]:
            met = met.met(end)
        state.mode, state.last, state.taught = met.mode, met.last, met.taught
        return statement

    def loop(self, statement: ir.Statement, body: ir.Body, state: _State) -> ir.Statement:
        """A loop begins as it was entered or as its last pass ended: what holds in both cases."""
        outer, self.reports = self.reports, False
        for _ in range(2):
            after = replace(state)
            self.body(body, after)
            met = state.met(after)
            state.mode, state.last, state.taught = met.mode, met.last, met.taught
        self.reports = outer
        inside = replace(state)
        new = self.body(body, inside)
        return rewrite_parts(statement, lambda expression: expression, None, {"body": new})

    def called(self, statement: ir.Statement, state: _State) -> None:
        """What calls in the statement may change."""
        for node in walk(statement):
            if isinstance(node, ir.CallRoutine | ir.Call):
                effect = self.effects.get(node.name.lower(), _Effect())
                dynamic = isinstance(node, ir.CallRoutine) and node.dynamic is not None
                if effect.mode or dynamic:
                    state.mode = ""
                if effect.place or effect.mode or dynamic:
                    state.last = None

    # ---- moves

    def move(self, move: ir.Move, state: _State) -> ir.Statement:
        settings = {place.name: value for place, value in move.settings if isinstance(place, ir.System)}
        own = settings.get(_MODE)
        mode = move.orientation or (own.member if isinstance(own, ir.EnumLiteral) else state.mode)
        if any(name in settings for name in _FRAMES) or move.tool is not None or move.frame is not None:
            state.last = None
        if move.relative is not None and mode == "constant" and move.kind == "linear":
            return self.unturned(move)
        if move.relative is not None or _says_no_orientation(move.target):
            if mode != "constant" and not _says_no_orientation(move.target):
                state.last = None
            return move
        value = None if self.scope is None else constant(move.target, self.scope, self.unchanged)
        there = (
            value.pose.rotation if isinstance(value, Target) else value.rotation if isinstance(value, Pose) else None
        )
        names = () if self.scope is None else tuple(taught_names(self.scope, move.target))
        if mode != "constant" or move.kind not in ("linear", "circular"):
            state.last, state.taught = there, names
            return move
        start = state.last
        if _is_fixed(move):
            state.last = None
            given = not self.reports or PathRule.FIXED_ARCS in self.context.capabilities.motion.paths
            return move if given else stopped(move, FIXED, self.context)
        if start is None or there is None:
            if self.reports:
                self.context.diagnostics.report(LOST, move.origin)
            state.last = None
            return move
        if _same(start, there):
            return move
        assert isinstance(value, Target | Pose)  # there is a rotation
        if self.reports and (names or state.taught):
            shown = ", ".join(sorted({*names, *state.taught}))
            self.context.diagnostics.report(WRITTEN, move.origin, what="the end of this path", names=shown)
        return replace(move, target=_written(value, start))

    def unturned(self, move: ir.Move) -> ir.Move:
        """A straight move by an amount turns nothing, whatever angles are written; the orientation stays."""
        if _says_no_orientation(move.target):
            return move
        if isinstance(move.target, ir.Aggregate) and all(name for name, _ in move.target.entries):
            entries = tuple(entry for entry in move.target.entries if (entry[0] or "").lower() not in _ANGLES)
            return replace(move, target=replace(move.target, entries=entries))
        value = None if self.scope is None else constant(move.target, self.scope, self.unchanged)
        if isinstance(value, Target | Pose):
            if self.reports and self.scope is not None:
                tell_written(self.context, self.scope, move.origin, "the way of this move", move.target)
            return replace(move, target=_written(value, NO_TURN))
        if self.reports:
            self.context.diagnostics.report(LOST, move.origin)
        return move


def _is_fixed(move: ir.Move) -> bool:
    """Does the move keep the tool as it is to its arc?"""
    return move.kind == "circular" and move.orientation == "constant" and move.circle_orientation == "path"


def _written(value: Target | Pose, rotation: Rotation) -> ir.Aggregate:
    """The place with another orientation."""
    pose = value.pose if isinstance(value, Target) else value
    place = (pose.position.x, pose.position.y, pose.position.z, *rotation.zyx)
    entries: list[tuple[str | None, ir.Expression]] = list(zip("xyzabc", map(real, place), strict=True))
    if not isinstance(value, Target):
        return ir.Aggregate(tuple(entries), type_word(ir.PoseType()))
    entries += [(name, ir.IntLiteral(flag)) for name, flag in value.flags]
    entries += [(name, real(axis)) for name, axis in value.external]
    return ir.Aggregate(tuple(entries), type_word(value.type))


def _same(one: Rotation, other: Rotation) -> bool:
    return abs(sum(p * q for p, q in zip(one.quaternion, other.quaternion, strict=True))) > 1.0 - _SAME


def _says_no_orientation(target: ir.Expression) -> bool:
    """A partial place without angles keeps the orientation anyway; one of joints does not."""
    if not isinstance(target, ir.Aggregate):
        return False
    names = {(key or "").lower() for key, _ in target.entries}
    return names <= {"x", "y", "z"} or (names <= {"x", "y", "z", "s", "t"} and not names & _ANGLES)


def _effects(program: ir.Program) -> dict[str, _Effect]:
    """What each routine of the program may change, with all that it calls."""
    found: dict[str, _Effect] = {}
    for module in program.modules:
        for routine in module.routines:
            effect = found.setdefault(routine.name.lower(), _Effect())
            for node in walk(routine):
                match node:
                    case ir.Assign(target=ir.System(name="orientation_mode")):
                        effect.mode = True
                    case ir.Assign(target=ir.System(name="tool" | "base")) | ir.Move() | ir.Spline():
                        effect.place = True
                    case ir.CallRoutine(name=name) | ir.Call(name=name):
                        effect.calls.add(name.lower())
    size = -1
    while size != (size := sum(effect.mode + effect.place for effect in found.values())):
        for effect in found.values():
            for name in effect.calls & found.keys():
                effect.mode = effect.mode or found[name].mode
                effect.place = effect.place or found[name].place
    return found


__all__ = ["constant_orientations"]
