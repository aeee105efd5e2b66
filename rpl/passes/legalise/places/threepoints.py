"""Arcs for targets that know only start, via and end.

An arc whose length is an angle (KRL's CA) ends at a computed point: a constant where the points that fix the circle are
constants, or data that nothing assigns; else the program computes it (`arcends`). An angle of a full turn or more is
written in parts, which meet in a small corner because three points fix less than one turn. And where the target's tool
turns otherwise on the way (seen from the base or from the tangent) and has no setting for it, an arc on which that
makes a difference is reported.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes import rigid
from rpl.passes.capabilities import PathRule
from rpl.passes.fold import Unchanged, constant, constant_number, lasting
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.settingsinforce import SettingsInForce
from rpl.passes.legalise.facts.usage import base_name
from rpl.passes.legalise.facts.values.straightplaces import StraightPlaces
from rpl.passes.legalise.facts.values.taughtvalues import tell_written
from rpl.passes.legalise.kinds import has_arcs, walk_for
from rpl.passes.legalise.places.arcends import COMPUTED, computed_arc
from rpl.passes.legalise.places.arctriggers import placeable, shared_out
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.typewords import type_word
from rpl.passes.values import pose_of, real

IN_PARTS = code(
    "arc-in-parts",
    Severity.WARNING,
    "an arc of {angle:g} degrees is written as {count} arcs, which meet in corners of {corner:g} mm",
)
NOT_KNOWN = code(
    "arc-angle-lost",
    Severity.LOSS,
    "the target's arcs have no angle, and where this one ends cannot be computed: {reason}",
    "write the arc with the point where it ends",
    stops=True,
)
TURNS_OTHERWISE = code(
    "arc-orientation",
    Severity.WARNING,
    "on the way along this arc the tool is turned otherwise by the target ({how})",
    "write the arc in shorter parts",
)
CORNER_MM = 1.0
_NOTICED_DEG = 0.01
_MOST_TURN_DEG = 150.0  # in one part: at half a turn either way around is the shortest
_FLAT = 1e-9
_HALF_TURN = 1e-4  # rad: turns that near to half a turn have two ways
_PLACES = 9  # of mm and degrees: a millionth of what any controller keeps
_COUNTS = (1, 2, 3, 4, 6, 8, 12)
_MODAL = ("tool", "base")
_RULE = ir.System("circle_orientation")

Rotations = Callable[[float], rigid.Rotation]  # fraction of an arc -> the tool's rotation there


@dataclass(frozen=True, slots=True)
class Circle:
    """Centre (mm), unit axis, and the arm from the centre to the start."""

    centre: rigid.Vector
    axis: rigid.Vector
    arm: rigid.Vector

    def at(self, degrees: float) -> rigid.Vector:
        """The point that far from the start, about the axis."""
        turn = math.radians(degrees)
        across = self.axis.cross(self.arm)
        return self.centre.plus(self.arm, math.cos(turn)).plus(across, math.sin(turn))

    def angle(self, point: rigid.Vector) -> float:
        """How far (deg, 0..360) a point of the circle is from the start, about the axis."""
        other = point.plus(self.centre, -1.0)
        return math.degrees(math.atan2(self.axis.dot(self.arm.cross(other)), self.arm.dot(other))) % 360.0

    def turned(self, degrees: float) -> rigid.Rotation:
        """The turn about the axis."""
        half = math.radians(degrees) / 2.0
        along = self.axis.times(math.sin(half))
        return rigid.Rotation((math.cos(half), along.x, along.y, along.z))

    def rotations(self, angle: float, begin: rigid.Rotation, end: rigid.Rotation, turns: bool) -> Rotations:
        """The tool's rotation at each fraction of an arc: from `begin` to `end` by the shortest turn, as seen from the
        base, or from the tangent when it `turns` with the path. Of the two equal ways on a half circle with the same
        rotation at both ends the one that turns the tool back is taken, not the one once more round."""
        goal = self.turned(-angle).then(end) if turns else end
        about = self.axis if angle > 0.0 else self.axis.times(-1.0)

        def at(fraction: float) -> rigid.Rotation:
            seen = _between(begin, goal, fraction, about if turns else None)
            return self.turned(angle * fraction).then(seen) if turns else seen

        return at


def circle_through(start: rigid.Vector, via: rigid.Vector, end: rigid.Vector) -> Circle | None:
    """The circle from start over via to end; None when they lie on a line."""
    one, two = via.plus(start, -1.0), end.plus(start, -1.0)
    normal = one.cross(two)
    if normal.length <= _FLAT * max(one.length * two.length, 1e-9):
        return None
    weight = 1.0 / (2.0 * normal.dot(normal))
    lift = normal.cross(one).times(two.dot(two)).plus(two.cross(normal).times(one.dot(one)))
    centre = start.plus(lift, weight)
    return Circle(centre, normal.times(1.0 / normal.length), start.plus(centre, -1.0))


@legalising(
    unless=lambda context: (
        PathRule.ARCS_BY_ANGLE in context.capabilities.motion.paths
        and "circle_orientation" in context.capabilities.system_variables
    )
)
def three_point_arcs(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose arcs have no angle, or one way for the tool to turn."""
    if not has_arcs(program):
        return program
    known, ours = unchanged_in(program), _default(context.source)
    flow = SettingsInForce.begun_by(program, context.source)
    default = (
        ""
        if any(isinstance(node, ir.Assign) and node.target == _RULE for node in walk_for({"Assign"}, program))
        else ours
    )

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, _Arcs(context, editor, known, flow, default).body)

    return edit_routines(program, context, work)


def _default(dialect: str) -> str:
    return str(rules_of(dialect).system_defaults.get("circle_orientation") or "base")


@dataclass(slots=True)
class _Arcs:
    context: Context
    editor: Editor
    known: Unchanged
    flow: SettingsInForce
    default: str  # how the tool turns where the flow is not known; empty: the program sets it
    last: ir.Move | None = None  # the move before, under the same tool and frame
    temporaries: dict[tuple[str, ir.Type], ir.Name] = field(default_factory=dict)
    pending: list[ir.Statement] = field(default_factory=list)  # the actions on the path in front of the arc at hand
    places: StraightPlaces = field(default_factory=StraightPlaces)

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        self.last, self.places = None, StraightPlaces()
        for statement in body:
            self.places.follow(statement, self.editor.scope, self.known)
            match statement:
                case ir.Move(kind="circular", swept=swept) if swept is not None and self.without_angle:
                    self.pending = _taken(done)
                    written = self.arc(statement, swept)
                    done.extend(self.pending)
                    done.extend(written)
                    self.last = None
                    continue
                case ir.Move(kind="circular"):
                    self.pending = _taken(done)
                    written = self.look(statement, self.rule(statement))
                    done.extend(self.pending)
                    done.extend(written)
                    self.last = statement
                    continue
                case ir.Move():
                    self.last = statement
                case ir.Assign(target=ir.System(name=name)) if name in _MODAL:
                    self.last = None
                case ir.Assign(target=target) if self.last is not None and base_name(target) in _names(
                    self.last.target
                ):
                    self.last = replace(self.last, target=ir.System("actual_pose"))
                case ir.Assign() | ir.Nothing() | ir.LookAhead() | ir.Trigger() | ir.WaitForMotion() | ir.Wait():
                    pass
                case _:
                    statement = inside(statement, self.body)
                    self.last, self.places = None, StraightPlaces()
            done.append(statement)
        return tuple(done)

    @property
    def without_angle(self) -> bool:
        return PathRule.ARCS_BY_ANGLE not in self.context.capabilities.motion.paths

    def rule(self, move: ir.Move) -> str:
        """How the tool turns on an arc: `base`, `path`; empty text: it is not known."""
        return move.circle_orientation or self.flow.arc_rule(move) or self.default

    def look(self, move: ir.Move, ours: str) -> ir.Body:
        """The arc; in parts where that turns the target's tool as the source's, which would be turned otherwise.
        `ours`: how the source turns it."""
        if "circle_orientation" in self.context.capabilities.system_variables or ours == _default(self.context.target):
            return (move,)
        start = None if self.last is None or not _alike(self.last, move) else self.pose(self.last.target)
        via = None if move.via is None else self.pose(move.via)
        end = self.pose(move.target)
        if start is None or via is None or end is None:
            self.context.diagnostics.report(TURNS_OTHERWISE, move.origin, how="how far is not known here")
            return (move,)
        circle = circle_through(start.position, via.position, end.position)
        if circle is None:
            return (move,)
        angle = circle.angle(end.position)
        assert self.last is not None  # its place is known
        rotations = circle.rotations(angle, start.rotation, end.rotation, ours == "path")
        splits = bool(ours) and self.placeable(move)
        apart = 0.0
        for count in _COUNTS if splits else (1,):
            apart = _apart(circle, angle / count, start.rotation, rotations(1.0 / count))
            if apart <= _NOTICED_DEG and _turn(start.rotation, rotations(1.0 / count)) <= _MOST_TURN_DEG + 1e-6:
                break
        else:
            self.context.diagnostics.report(TURNS_OTHERWISE, move.origin, how=f"by {apart:.3g} degrees between")
        if count > 1:
            self.tell("the parts of this arc", move, self.last.target)
        return self.parts(move, circle, angle, count, rotations)

    def tell(self, what: str, move: ir.Move, start: ir.Expression) -> None:
        """Name the taught points that decide the numbers of an arc."""
        points = self.places.rest_on(start, move.via, move.target)
        tell_written(self.context, self.editor.scope, move.origin, what, *points)

    def arc(self, move: ir.Move, swept: ir.Expression) -> ir.Body:
        """The arc, or the arcs, without an angle."""
        angle = constant_number(swept, self.editor.scope, self.known)
        start = None if self.last is None or not _alike(self.last, move) else self.pose(self.last.target)
        via = None if move.via is None else self.pose(move.via)
        end = self.pose(move.target)
        if angle is None:
            return self.lost(move, "its angle changes in a run")
        if move.relative or start is None or via is None or end is None:
            return self.computed(move, angle)
        circle = circle_through(start.position, via.position, end.position)
        if circle is None or angle == 0.0:
            return self.lost(move, "its points fix no circle")
        count = 1 if abs(angle) < 360.0 else _parts_of(angle)
        if self.follows(move, count):
            return self.computed(move, angle)
        if count == 1:
            return self.look(_to(move, circle, angle, end.rotation, self.context.source), self.rule(move))
        rule = self.rule(move)
        if not rule:
            return self.lost(move, "it goes around, and how the tool turns on the way changes in a run")
        if not self.placeable(move):
            return self.lost(move, "it goes around, and actions or a search belong to it")
        rotations = circle.rotations(angle, start.rotation, end.rotation, rule == "path")
        return self.parts(move, circle, angle, count, rotations)

    def follows(self, move: ir.Move, count: int) -> bool:
        """Is the end of this arc better computed in the run, because its points are taught? Not where the arc is
        written in parts, or where how the tool turns on the way hangs on where the end is."""
        assert self.last is not None and move.via is not None  # the caller knows all three points
        points = (self.last.target, move.via, move.target)
        if all(lasting(one, self.editor.scope) is not None for one in points):
            return False
        own = "circle_orientation" in self.context.capabilities.system_variables
        if count == 1 and _steady(self.last.target) and (own or self.rule(move) == _default(self.context.target)):
            return True
        self.tell("the end of this arc", move, self.last.target)
        return False

    def computed(self, move: ir.Move, angle: float) -> ir.Body:
        """The arc to a point that the program computes."""
        start: ir.Expression = ir.System("actual_pose")
        last = self.last
        if last is not None and _alike(last, move) and _steady(last.target) and self.place(last.target) is not None:
            start = last.target
        filled: list[ir.Statement] = []
        goals = [self.filled(one, start, move, filled) for one in (move.via, move.target) if one is not None]
        places = tuple((one, type) for one in (start, *goals) if (type := self.place(one)) is not None)
        if len(places) != 3 or move.relative is not None:
            return self.lost(move, "its point on the way or its end is not whole, or counted from its start")
        if angle == 0.0:
            return self.lost(move, "its points fix no circle")
        self.context.diagnostics.report(COMPUTED, move.origin, angle=angle)
        if abs(angle) >= 360.0:
            return (*filled, *self.around(move, places, angle))
        done = computed_arc(move, places, angle, self.temporary)
        arc = done[-1]
        assert isinstance(arc, ir.Move)  # computed_arc ends with it
        self.last = None
        return (*filled, *done[:-1], *self.look(arc, self.rule(move)))

    def around(self, move: ir.Move, places: tuple[tuple[ir.Expression, ir.Type], ...], angle: float) -> ir.Body:
        """An arc of a turn or more in parts that the program computes."""
        if move.triggers or move.search is not None or any(isinstance(one, ir.Trigger) for one in self.pending):
            return self.lost(move, "it goes around, and actions or a search belong to it")
        if self.rule(move) != "base":
            return self.lost(move, "it goes around, and the tool turns with the path")
        count = math.ceil(abs(angle) / _MOST_TURN_DEG)
        self.context.diagnostics.report(IN_PARTS, move.origin, angle=angle, count=count, corner=CORNER_MM)
        self.context.diagnostics.report(TURNS_OTHERWISE, move.origin, how="in its first part, if it turns at all")
        self.last = None
        return computed_arc(move, places, angle, self.temporary, count, ir.BlendDistance(ir.RealLiteral(CORNER_MM)))

    def filled(
        self, place: ir.Expression, start: ir.Expression, move: ir.Move, steps: list[ir.Statement]
    ) -> ir.Expression:
        """A place of some components with those of the start of the move for the others, in a variable."""
        type = self.editor.type_of(place)
        parts = isinstance(type, ir.PoseType | ir.TargetType) and isinstance(place, ir.Aggregate)
        if not parts or _complete(place) or move.relative is not None or self.place(start) is None:
            return place
        assert isinstance(place, ir.Aggregate) and type is not None  # parts
        whole = self.editor.temporary("whole", type)
        steps.append(ir.Assign(whole, start, origin=replace(move.origin, comments=())))
        steps += [ir.Assign(ir.Field(whole, name), value) for name, value in place.entries if name is not None]
        return whole

    def place(self, place: ir.Expression) -> ir.Type | None:
        """The type of a place of which all components are given."""
        type = self.editor.type_of(place)
        return type if isinstance(type, ir.PoseType | ir.TargetType) and _complete(place) else None

    def temporary(self, stem: str, type: ir.Type) -> ir.Name:
        """One variable for all arcs of the routine."""
        if (stem, type) not in self.temporaries:
            self.temporaries[stem, type] = self.editor.temporary(stem, type)
        return self.temporaries[stem, type]

    def parts(self, move: ir.Move, circle: Circle, angle: float, count: int, rotations: Rotations) -> ir.Body:
        """Arcs of the same length."""
        if count == 1:
            return (move,)
        self.context.diagnostics.report(IN_PARTS, move.origin, angle=angle, count=count, corner=CORNER_MM)
        done: list[ir.Statement] = []
        for number in range(count):
            first, last = angle * number / count, angle * (number + 1) / count
            part = _to(move, circle, last, rotations((number + 1) / count), self.context.source, first)
            if number:
                part = replace(part, origin=replace(part.origin, comments=()))
            if number < count - 1:
                part = replace(part, blend=ir.BlendDistance(ir.RealLiteral(CORNER_MM)))
            done.append(part)
        length = abs(math.radians(angle)) * circle.arm.length
        before, self.pending = self.pending, []
        return shared_out(before, done, length, self.editor.scope, self.known)

    def placeable(self, move: ir.Move) -> bool:
        """Can the parts of the arc have what acts on its way?"""
        acting = [one for one in self.pending if isinstance(one, ir.Trigger)]
        known = all(placeable(one, self.editor.scope, self.known) for one in acting)
        return known and not move.triggers and move.search is None

    def pose(self, expression: ir.Expression) -> rigid.Pose | None:
        return pose_of(constant(expression, self.editor.scope, self.known, self.places.values))

    def lost(self, move: ir.Move, reason: str) -> ir.Body:
        self.context.diagnostics.report(NOT_KNOWN, move.origin, reason=reason)
        return (move,)


def _taken(done: list[ir.Statement]) -> list[ir.Statement]:
    """The actions at the end of a body, taken off it."""
    at = len(done)
    while at and isinstance(done[at - 1], ir.Trigger):
        at -= 1
    taken = done[at:]
    del done[at:]
    return taken


def _parts_of(angle: float) -> int:
    """How many arcs of clearly less than a turn make one of so many degrees."""
    return math.ceil((abs(angle) + 1.0) / 270.0)


def _names(place: ir.Expression) -> set[str]:
    return {one.id.lower() for one in walk(place) if isinstance(one, ir.Name)}


def _complete(place: ir.Expression) -> bool:
    """Are all components of a place given?"""
    return not isinstance(place, ir.Aggregate) or {"x", "y", "z", "a", "b", "c"} <= {name for name, _ in place.entries}


def _steady(place: ir.Expression) -> bool:
    """Is it the same when it is computed again behind the move, if nothing in it is assigned?"""
    match place:
        case ir.Aggregate(entries=entries):
            return all(_steady(one) for _, one in entries)
        case ir.Unary(operand=inner) | ir.Field(base=inner):
            return _steady(inner)
        case ir.Index(base=base, indices=indices):
            return all(map(_steady, (base, *indices)))
    return isinstance(place, ir.Name | ir.IntLiteral | ir.RealLiteral)


def _alike(last: ir.Move, move: ir.Move) -> bool:
    """Do both name the same tool and frame, and does the last one end at a place that is written?"""
    return last.relative is None and last.search is None and (last.tool, last.frame) == (move.tool, move.frame)


def _to(
    move: ir.Move, circle: Circle, end: float, rotation: rigid.Rotation, notation: str, begin: float = 0.0
) -> ir.Move:
    """The arc from one place (deg from the start) to another."""
    middle, last = (_written(circle.at(at), rotation, notation) for at in ((begin + end) / 2.0, end))
    return replace(move, via=middle, target=last, swept=None)


def _written(place: rigid.Vector, rotation: rigid.Rotation, notation: str) -> ir.Aggregate:
    """A target without flags."""
    values = (place.x, place.y, place.z, *rotation.zyx)
    entries = tuple((name, real(round(value, _PLACES))) for name, value in zip("xyzabc", values, strict=True))
    return ir.Aggregate(entries, type_name=type_word(ir.TargetType(notation)))


def _turn(one: rigid.Rotation, other: rigid.Rotation) -> float:
    """The shortest turn from one rotation to the other, in degrees."""
    return one.inverse.then(other).angle


def _apart(circle: Circle, angle: float, begin: rigid.Rotation, end: rigid.Rotation) -> float:
    """The angle in degrees, in the middle of an arc, between a tool that turns as seen from the base and one that turns
    as seen from the tangent."""
    base, path = (circle.rotations(angle, begin, end, turns)(0.5) for turns in (False, True))
    return _turn(base, path)


def _between(
    one: rigid.Rotation, other: rigid.Rotation, fraction: float, about: rigid.Vector | None = None
) -> rigid.Rotation:
    """Part of the shortest turn from one rotation to the other; of half a turn, the way that is not `about`."""
    w, x, y, z = one.inverse.then(other).quaternion
    if w < 0.0:
        w, x, y, z = -w, -x, -y, -z
    sine = math.sqrt(x * x + y * y + z * z)
    whole = math.atan2(sine, w)
    if about is not None and 2.0 * whole > math.pi - _HALF_TURN and one.turn(rigid.Vector(x, y, z)).dot(about) > 0.0:
        whole -= math.pi
    half = fraction * whole
    scale = math.sin(half) / sine if sine > 1e-12 else 0.0
    part = rigid.Rotation((math.cos(half), x * scale, y * scale, z * scale))
    return one.then(part)


__all__ = ["Circle", "circle_through", "three_point_arcs"]
