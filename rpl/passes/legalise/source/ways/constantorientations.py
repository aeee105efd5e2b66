"""Paths on which the tool keeps the orientation of their start (`orientation_mode` constant), for targets whose paths
always turn to the orientation of their end.

Programs set it where all their places have one orientation, and then nothing is to be done: the place in front of the
path, as far as it is written or taught, has the orientation of its end. Where that is not so, the move is refused; so
is an arc that keeps the tool as it is to the arc.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.capabilities import PathRule
from rpl.passes.fold import Unchanged, constant
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.motion.moveorder import pairs_of
from rpl.passes.legalise.facts.settingsinforce import SettingsInForce
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.stopping import stopped
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.rigid import NO_TURN, Rotation
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.values import pose_of

LOST = code(
    "constant-orientation-lost",
    Severity.LOSS,
    "this path keeps the orientation of its start, and its end is written with another one or the start is not known;"
    " the target's path turns to the one that is written",
    "write the orientation that the tool has at the start into the target",
    stops=True,
)
FIXED = code(
    "fixed-arc-lost",
    Severity.LOSS,
    "along this arc the tool stays as it is to the arc; the target's arcs turn it to the orientation at their end",
    "write the orientation that the tool has at the end of the arc, and arcs of half a circle or more in parts",
    stops=True,
)
_MODE = "orientation_mode"
_FIXED = ("constant", "path")
_SAME = 1e-9  # of the quaternions' product: less than a hundredth of a degree
_NO_ANGLES = frozenset(("x", "y", "z", "s", "t"))  # a place without angles keeps the orientation anyway


@legalising(unless=lambda context: _MODE in context.capabilities.system_variables)
def constant_orientations(program: ir.Program, context: Context) -> ir.Program:
    """The program whose paths end with the orientation that is written at their end."""
    if not any(map(_constant, walk_for({"Assign", "Move"}, program))):
        return program
    paths = _Paths.of(program, context)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        def change(statement: ir.Statement) -> ir.Body:
            if not isinstance(statement, ir.Move):
                return (statement if isinstance(statement, ir.Spline) else inside(statement, body),)
            if statement.kind == "circular" and (statement.orientation, statement.circle_orientation) == _FIXED:
                given = PathRule.FIXED_ARCS in context.capabilities.motion.paths
                return (statement if given else stopped(statement, FIXED, context),)
            return (stopped(statement, LOST, context) if paths.turns(statement) else statement,)

        def body(statements: ir.Body) -> ir.Body:
            return map_body(statements, change)

        return edit_bodies(routine, body)

    return edit_routines(program, context, work)


def _constant(node: object) -> bool:
    """Does it set the rule, or is it a move with it?"""
    match node:
        case ir.Assign(target=ir.System(name="orientation_mode"), value=ir.EnumLiteral(member=member)):
            return member.lower() == "constant"
        case ir.Move(orientation="constant"):
            return True
        case ir.Move(settings=settings):
            return any(isinstance(place, ir.System) and place.name == _MODE for place, _ in settings)
    return False


@dataclass(slots=True)
class _Paths:
    """`before`: the moves that may come in front of each, None for one that is not known. `turned`: the orientation
    that a move's target is written with, None where it is not known; moves that say none are not in it. `still`: tool
    and frame where the program leaves them as the operator has them."""

    flow: SettingsInForce
    still: dict[str, ir.Expression]
    before: dict[int, list[ir.Move | None]] = field(default_factory=dict)
    turned: dict[int, Rotation | None] = field(default_factory=dict)

    @staticmethod
    def of(program: ir.Program, context: Context) -> _Paths:
        changed = {node.target for node in walk_for({"Assign"}, program) if isinstance(node, ir.Assign)}
        still = {name: ir.System(name) for name in ("tool", "base") if ir.System(name) not in changed}
        found = _Paths(SettingsInForce.begun_by(program, context.source), dict(still))
        splines = any(
            isinstance(node, ir.Spline) for node in walk_for({"Spline"}, program)
        )  # they stand between moves that are a pair
        for pair in pairs_of(program):
            if pair.second is not None:
                first = None if pair.stands and splines else pair.first
                found.before.setdefault(id(pair.second), []).append(first)
        scopes, unchanged = ProgramScope(program), unchanged_in(program)
        for module, routine in scopes.routines():
            scope = scopes.routine(module, routine)
            for node in walk(routine):
                if isinstance(node, ir.Move):
                    found.note(node, scope, unchanged)
        return found

    def note(self, move: ir.Move, scope: Scope, unchanged: Unchanged) -> None:
        if (
            isinstance(move.target, ir.Aggregate)
            and {(key or "").lower() for key, _ in move.target.entries} <= _NO_ANGLES
        ):
            return
        pose = pose_of(constant(move.target, scope, unchanged))
        rotation = None if pose is None else pose.rotation
        if move.relative is None or rotation is None or not _same(rotation, NO_TURN):
            self.turned[id(move)] = rotation

    def turns(self, move: ir.Move) -> bool:
        """Would the target's path turn the tool, where this one does not?"""
        own = {place.name: value for place, value in move.settings if isinstance(place, ir.System)}
        mode = own.get(_MODE, self.flow.at(move)[_MODE])
        kept = move.orientation == "constant" or (move.orientation is None and _is_constant(mode))
        if not kept or move.kind not in ("linear", "circular") or id(move) not in self.turned:
            return False
        there = self.turned[id(move)]
        if move.relative is not None or there is None:
            return True
        return any(one is None or not _same(one, there) for one in self.starts(move, set()))

    def starts(self, move: ir.Move, seen: set[int]) -> list[Rotation | None]:
        """The orientations that the tool may have in front of a move."""
        found: list[Rotation | None] = []
        for first in self.before.get(id(move), [None]):
            if first is None or self.frames(first) is None or self.frames(first) != self.frames(move):
                found.append(None)
            elif id(first) in self.turned:
                found.append(None if first.relative is not None else self.turned[id(first)])
            elif id(first) not in seen:
                seen.add(id(first))
                found += self.starts(first, seen)
        return found

    def frames(self, move: ir.Move) -> tuple[ir.Expression, ir.Expression] | None:
        """The tool and the frame of a move, as far as they are known."""
        state = self.still | {name: one for name, one in self.flow.at(move).items() if one is not None}
        tool, frame = move.tool or state.get("tool"), move.frame or state.get("base")
        said = any(isinstance(place, ir.System) and place.name in ("tool", "base") for place, _ in move.settings)
        return None if said or tool is None or frame is None else (tool, frame)


def _is_constant(mode: ir.Expression | None) -> bool:
    return isinstance(mode, ir.EnumLiteral) and mode.member.lower() == "constant"


def _same(one: Rotation, other: Rotation) -> bool:
    return abs(sum(p * q for p, q in zip(one.quaternion, other.quaternion, strict=True))) > 1.0 - _SAME


__all__ = ["FIXED", "LOST", "constant_orientations"]
