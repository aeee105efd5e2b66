"""Relative moves and targets with missing components, for targets whose moves want a whole target.

Both start from where the last move ends. Where that is the move before in the same straight run of statements, its
target is used; moves of a loop or a choice before it note where they go; else the robot is asked where it stands, and
the move before must not be blended.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes import rigid
from rpl.passes.capabilities import PlaceRule
from rpl.passes.fold import Unchanged, constant, constant_number, lasting
from rpl.passes.legalise.context import Context, ProgramScope
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.paths.movebefore import MovesBefore, passes, says_how
from rpl.passes.legalise.rewriting.editing import edit_bodies, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies
from rpl.passes.scope import Scope
from rpl.passes.typing import type_of
from rpl.passes.values import Record, Target, real

STOPPED_FOR_POSITION = code(
    "stopped-for-position",
    Severity.WARNING,
    "the next move starts from where the robot stands, so this move is no longer blended",
)
TURNED = code(
    "relative-rotation", Severity.LOSS, "a relative move that also turns the tool is not carried over; teach its end"
)
SHIFT_ONLY = code(
    "relative-shift-only",
    Severity.WARNING,
    "of what a relative move adds only the position is carried over; that it does not turn the tool is not known",
)

_POSITION = ("x", "y", "z")


@legalising(
    unless=lambda context: (
        context.capabilities.motion.relative and PlaceRule.PARTIAL in context.capabilities.places.rules
    )
)
def whole_targets(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without relative moves or partial targets."""
    scopes, unchanged = ProgramScope(program), unchanged_in(program)
    before = MovesBefore(program, unchanged)
    goes_on = any(isinstance(node, ir.Move) and _goes_on(node) for node in walk_for({"Move"}, *program.modules))
    modules = []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            worker = Whole(context, scopes.routine(module, routine), unchanged, before, goes_on)
            done = edit_bodies(routine, worker.body)
            routines.append(replace(done, declarations=(*routine.declarations, *worker.declared)))
        modules.append(replace(module, routines=tuple(routines)))
    return replace(program, modules=tuple(modules))


class Whole:
    """The moves of one routine, and the variables that they need. `goes_on`: does any move of the program go on into
    the next one?"""

    def __init__(
        self, context: Context, scope: Scope, unchanged: Unchanged, before: MovesBefore, goes_on: bool = False
    ) -> None:
        self.context, self.scope, self.unchanged = context, scope, unchanged
        self.before, self.goes_on = before, goes_on
        self.declared: list[ir.Declaration] = []
        self.around: tuple[ir.Statement, ...] = ()  # what was done in any case before the body that is looked at

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        for statement in body:
            if isinstance(statement, ir.Move) and (self.needs_work(statement) or self.via_needs_work(statement)):
                first, arc = self.whole_via(statement, done)
                moved = self.whole(arc, done) if self.needs_work(arc) else [arc]
                done.extend([*first, *moved])
            elif isinstance(statement, ir.Move) and self.is_partial_way(statement):
                self.stop_before(done, statement)  # such a way begins where the robot is
                done.append(replace(statement, target=self.whole_way(statement.target)))
            else:
                done.append(self.within(statement, done))
        return tuple(done)

    def within(self, statement: ir.Statement, done: list[ir.Statement]) -> ir.Statement:
        """The bodies of a statement. What was done before a branch is known in it; a loop may come from its end."""
        outside = self.around
        self.around = (*outside, *done) if _branches(statement) else ()
        rewritten = rewrite_bodies(statement, self.body)
        self.around = outside
        return rewritten

    def needs_work(self, move: ir.Move) -> bool:
        can = self.context.capabilities
        if move.relative is not None:
            along_tool = move.relative == "tool" and isinstance(move.target, ir.Aggregate) and not _turns(move.target)
            return not can.motion.relative or (along_tool and not can.motion.tool_ways)
        return PlaceRule.PARTIAL not in can.places.rules and self.missing(move.target)

    def is_partial_way(self, move: ir.Move) -> bool:
        """A way from here that the target can say, of some components that are computed: the place that it is computed
        in has to have them all."""
        can, way = self.context.capabilities, move.target
        if (
            move.relative is None
            or not can.motion.relative
            or PlaceRule.PARTIAL in can.places.rules
            or move.via is not None
        ):
            return False
        parts = way.entries if isinstance(way, ir.Aggregate) and self.missing(way) else ()
        return any(constant_number(value, self.scope, self.unchanged) is None for _, value in parts)

    def whole_way(self, way: ir.Expression) -> ir.Aggregate:
        """What is left out of a way is nothing."""
        assert isinstance(way, ir.Aggregate)
        names = ir.AXES if way.type_name == "joints" else (*_POSITION, *ir.ANGLES)
        given = dict(way.entries)
        others = tuple((name, value) for name, value in way.entries if name not in names)
        return replace(way, entries=(*((name, given.get(name, ir.RealLiteral(0.0))) for name in names), *others))

    def via_needs_work(self, move: ir.Move) -> bool:
        """Has the point on the way of an arc components missing, or is it counted from the start?"""
        if move.via is None or isinstance(self.type_of(move.via), ir.JointsType):
            return False
        if move.relative is not None:
            return not self.context.capabilities.motion.relative and isinstance(move.via, ir.Aggregate)
        return PlaceRule.PARTIAL not in self.context.capabilities.places.rules and self.missing(move.via)

    def whole_via(self, move: ir.Move, done: list[ir.Statement]) -> tuple[list[ir.Statement], ir.Move]:
        """What the point on the way of an arc needs first, and the arc with this point in full."""
        if not self.via_needs_work(move):
            return [], move
        assert isinstance(move.via, ir.Aggregate)
        aim = replace(move, target=move.via, via=None, kind="linear")
        if move.relative is not None:
            found = self.offset(aim, move.via, done)
        else:
            found = self.from_here(aim, move.via, ir.TargetType(self.scope.rules.name), done)
        whole = found[-1]
        assert isinstance(whole, ir.Move)
        return found[:-1], replace(move, via=whole.target, origin=whole.origin)

    def missing(self, target: ir.Expression) -> bool:
        """Is it written with some of its components only? Flags and external axes may always be left out."""
        if not isinstance(target, ir.Aggregate):
            return False
        named = {name for name, _ in target.entries}
        if None in named or named & {"trans", "robax"}:
            return False
        wanted = ir.AXES if target.type_name == "joints" else (*_POSITION, *ir.ANGLES)
        return not set(wanted) <= named

    def whole(self, move: ir.Move, done: list[ir.Statement]) -> list[ir.Statement]:
        if isinstance(move.target, ir.Aggregate) and move.target.type_name == "joints":
            return self.from_here(move, move.target, ir.JointsType(), done)
        if isinstance(self.type_of(move.target), ir.JointsType) and move.relative == "joints":
            axes = tuple((name, ir.Field(move.target, name)) for name in ir.AXES)
            return self.from_here(move, ir.Aggregate(axes, type_name="joints"), ir.JointsType(), done)
        if not isinstance(move.target, ir.Aggregate):
            return self.shifted(move, done)
        if move.relative is not None:
            return self.offset(move, move.target, done)
        return self.from_here(move, move.target, ir.TargetType(self.scope.rules.name), done)

    def from_here(
        self, move: ir.Move, target: ir.Aggregate, type: ir.Type, done: list[ir.Statement]
    ) -> list[ir.Statement]:
        """The components given are set or added: in the values themselves where these are known, else in a temporary
        that takes the place where the last move went to, or where the robot stands."""
        joints = isinstance(type, ir.JointsType)
        start = self.last_joints(done) if joints else self.last_pose(done, move)
        known = self.folded(start, target, move.relative is not None) if joints else None
        if known is not None:
            return [replace(move, target=known, relative=None)]
        name = self.context.fresh("rpl_here")
        self.declared.append(ir.Variable(name, type, scope="routine"))
        if start is None:
            self.stop_before(done, move)
            start = ir.System("actual_joints") if joints else here(move)
        later = replace(move.origin, comments=())
        steps: list[ir.Statement] = [ir.Assign(ir.Name(name), start, origin=move.origin)]
        for component, value in target.entries:
            assert component is not None
            part = ir.Field(ir.Name(name), component)
            new = ir.Binary("+", part, value) if move.relative is not None else value
            steps.append(ir.Assign(part, new, origin=later))
        return [*steps, replace(move, target=ir.Name(name), relative=None, origin=later)]

    def last_joints(self, done: list[ir.Statement]) -> ir.Expression | None:
        """The joint values that the move before went to, when nothing in between can have moved the robot."""
        for statement in reversed(done):
            match statement:
                case ir.Move(target=target, relative=None, search=None):
                    given = isinstance(target, ir.Aggregate) or _is_place(target)
                    whole = given and not self.missing(target) and _is_steady(target)
                    return target if whole and isinstance(self.type_of(target), ir.JointsType) else None
                case ir.Assign(target=ir.System()):
                    continue  # tools and frames do not move the joints
            if not passes(statement):
                return None
        return None

    def last_pose(self, done: list[ir.Statement], move: ir.Move) -> ir.Expression | None:
        """The place that the move before went to. A joint move keeps the posture too, which only another one's place
        tells."""
        before = next((one for one in reversed(done) if isinstance(one, ir.Move)), None)
        if before is None or (move.kind == "joint" and before.kind != "joint") or self.missing(before.target):
            return None
        return self.last_target(done, move)

    def folded(self, start: ir.Expression | None, target: ir.Aggregate, adds: bool) -> ir.Aggregate | None:
        """Joint values with those of the target in their places, where all are constants."""
        value = None if start is None else lasting(start, self.scope)
        if not isinstance(value, Record):
            return None
        axes = {name: part for name, part in value.parts if isinstance(part, int | float)}
        if len(axes) != len(value.parts) or "j1" not in axes:
            return None
        for name, entry in target.entries:
            number = constant_number(entry, self.scope, self.unchanged)
            if number is None or name is None or name not in axes:
                return None
            axes[name] = axes[name] + number if adds else number
        return replace(target, entries=tuple((name, real(float(part))) for name, part in axes.items()))

    def offset(self, move: ir.Move, target: ir.Aggregate, done: list[ir.Statement]) -> list[ir.Statement]:
        values = {name: value for name, value in target.entries if name is not None}
        if _turns(target):
            self.context.diagnostics.report(TURNED, move.origin)
            return [move]
        seen = self.seen_alike(done, move)
        start = self.last_target(done, seen)
        if start is not None:
            move = seen
        elif self.context.capabilities.motion.relative:
            return [move]  # as the target says it, from where the robot stands
        else:
            start = self.noted(done, move)
        if start is None:
            self.stop_before(done, move)
            start = here(move)
        function = "tool_offset" if move.relative == "tool" else "offset"
        steps = tuple(values.get(name, ir.RealLiteral(0.0)) for name in _POSITION)
        return [replace(move, target=ir.Builtin(function, (start, *steps)), relative=None)]

    def shifted(self, move: ir.Move, done: list[ir.Statement]) -> list[ir.Statement]:
        """A relative move by data: its position; of its turn only that it is none can be known."""
        target = move.target
        if move.relative not in ("base", "tool") or isinstance(self.type_of(target), ir.JointsType | None):
            return [move]
        if not _is_place(target):
            return [move]
        value = constant(target, self.scope)
        pose = value.pose if isinstance(value, Target) else value
        if isinstance(pose, rigid.Pose) and abs(pose.rotation.quaternion[0]) < 1.0 - 1e-9:
            self.context.diagnostics.report(TURNED, move.origin)
            return [move]
        if not isinstance(pose, rigid.Pose):
            self.context.diagnostics.report(SHIFT_ONLY, move.origin)
        entries = tuple((name, ir.Field(target, name)) for name in _POSITION)
        return self.offset(move, ir.Aggregate(entries, "pose"), done)

    def last_target(self, done: list[ir.Statement], move: ir.Move) -> ir.Expression | None:
        """The target of the move before, when nothing in between can have moved the robot or changed the frame."""
        known = [*self.around, *done]
        at = self.before.found(known)
        before = None if at is None else known[at]
        if at is None or not isinstance(before, ir.Move) or before.relative is not None or before.search is not None:
            return None
        target = before.target
        same = before.tool == move.tool and before.frame == move.frame and says_how(before)
        if isinstance(target, ir.Builtin) and target.function == "target_to_joints_near":
            target = target.arguments[0]  # the same place, in a posture of its own
        if not same or isinstance(self.type_of(target), ir.JointsType | None):
            return None
        if not (isinstance(target, ir.Aggregate | ir.Builtin) or _is_product(target) or _is_place(target)):
            return None
        if _is_steady(target) and not self.before.may_change(target, known[at + 1 :], self.scope):
            return target
        at -= len(self.around)
        return self.kept(done, at, before) if at >= 0 else None

    def seen_alike(self, done: list[ir.Statement], move: ir.Move) -> ir.Move:
        """The move in the frame of the one before: along the tool it is the same way in every frame."""
        known = [*self.around, *done]
        at = self.before.found(known) if move.relative == "tool" and move.frame is None else None
        before = None if at is None else known[at]
        return replace(move, frame=before.frame) if isinstance(before, ir.Move) else move

    def type_of(self, target: ir.Expression) -> ir.Type | None:
        """The type of a target, which may rest on a variable that was made here."""
        while isinstance(target, ir.Builtin) and target.function in ("offset", "tool_offset"):
            target = target.arguments[0]
        made = (one.type for one in self.declared if isinstance(one, ir.Variable) and target == ir.Name(one.name))
        return next(made, None) or type_of(target, self.scope)

    def kept(self, done: list[ir.Statement], at: int, move: ir.Move) -> ir.Expression | None:
        """The target of a move that would be another one when it is computed again: a variable keeps it."""
        type = self.type_of(move.target)
        if not isinstance(type, ir.PoseType | ir.TargetType):
            return None
        place = ir.Name(self.context.fresh("rpl_place"))
        self.declared.append(ir.Variable(place.id, type, scope="routine"))
        later = replace(move.origin, comments=())
        done[at:] = [
            ir.Assign(place, move.target, origin=move.origin),
            replace(move, target=place, origin=later),
            *done[at + 1 :],
        ]
        return place

    def noted(self, done: list[ir.Statement], move: ir.Move) -> ir.Expression | None:
        """Where the last move of the block before ends: a variable that its moves set, where they can be blended."""
        at = len(done) - 1
        while at >= 0 and passes(done[at]):
            at -= 1
        if at < 0 or not isinstance(done[at], _BLOCKS):
            return None
        moves = [node for node in walk((done[at],)) if isinstance(node, ir.Move)]
        types = {type_of(one.target, self.scope) for one in moves}
        quiet = not any(isinstance(node, _UNKNOWN_MOVES) for node in walk((done[at],)))
        same = all(
            (one.tool, one.frame, one.relative, one.search) == (move.tool, move.frame, None, None) for one in moves
        )
        type = types.pop() if len(types) == 1 else None
        blended = any(one.blend not in (None, ir.BlendStop()) for one in moves)
        if not (quiet and same and blended) or not isinstance(type, ir.PoseType | ir.TargetType):
            return None
        before, block = done[:at], done[at]
        place = ir.Name(self.context.fresh("rpl_place"))
        self.declared.append(ir.Variable(place.id, type, scope="routine"))
        start = self.last_target(before, move)
        if start is None:
            self.stop_before(before, move)
            start = here(move)

        def note(statement: ir.Statement) -> ir.Body:
            if isinstance(statement, ir.Move):
                later = replace(statement.origin, comments=())
                return ir.Assign(place, statement.target, origin=statement.origin), replace(
                    statement, target=place, origin=later
                )
            return (inside(statement, lambda body: map_body(body, note)),)

        done[at:] = [*note(block), *done[at + 1 :]]
        done[:at] = [*before, ir.Assign(place, start, origin=replace(block.origin, comments=()))]
        return place

    def stop_before(self, done: list[ir.Statement], move: ir.Move) -> None:
        """The move before must end where it says, or the robot is asked on its way. Where it is not in these steps (in
        a loop, behind a call), the robot's end is waited for."""
        rests = False
        for at in range(len(done) - 1, -1, -1):
            statement = done[at]
            if isinstance(statement, ir.Move):
                if _goes_on(statement):
                    self.context.diagnostics.report(STOPPED_FOR_POSITION, statement.origin)
                    done[at] = replace(statement, blend=ir.BlendStop())
                return
            rests = rests or isinstance(statement, ir.WaitForMotion)
            if isinstance(statement, (*_BLOCKS, *_UNKNOWN_MOVES)):
                break
        if self.goes_on and not rests:
            self.context.diagnostics.report(STOPPED_FOR_POSITION, move.origin)
            at = len(done)
            while at and isinstance(done[at - 1], ir.Trigger):  # what belongs to the move stays in front of it
                at -= 1
            done.insert(at, ir.WaitForMotion(origin=replace(move.origin, comments=())))


_BLOCKS = (ir.If, ir.Switch, ir.For, ir.While, ir.Repeat, ir.Loop)
_UNKNOWN_MOVES = (ir.CallRoutine, ir.Call, ir.Goto, ir.Label, ir.Spline, ir.MoveExternal)


def _branches(statement: ir.Statement) -> bool:
    """Does it choose one of its bodies, by conditions that call nothing?"""
    match statement:
        case ir.If(branches=branches):
            asked = tuple(condition for condition, _ in branches)
        case ir.Switch(selector=selector, cases=cases):
            asked = (selector, *(value for case in cases for value in case.values))
        case _:
            return False
    return not any(isinstance(node, ir.Call) for node in walk(asked))


def _goes_on(move: ir.Move) -> bool:
    return move.blend not in (None, ir.BlendStop())


def here(move: ir.Move) -> ir.Expression:
    """Where the robot stands, with the tool and in the frame that the move has."""
    if move.tool is None and move.frame is None:
        return ir.System("actual_pose")
    return ir.Builtin("current_target", (move.tool or ir.System("tool"), move.frame or ir.System("base")))


def _turns(way: ir.Aggregate) -> bool:
    return any(name in ir.ANGLES and not _is_zero(value) for name, value in way.entries)


def _is_zero(value: ir.Expression) -> bool:
    return isinstance(value, ir.IntLiteral | ir.RealLiteral) and value.value == 0


_MOVING = frozenset(("current_target", "current_joints", "current_position", "random"))


def _is_steady(target: ir.Expression) -> bool:
    """Is it the same when it is computed again behind the move?"""
    for node in walk((target,)):
        match node:
            case ir.Call() | ir.Signal() | ir.VendorValue():
                return False
            case ir.System(name=name) if name not in ("tool", "base"):
                return False
            case ir.Builtin(function=function) if function in _MOVING:
                return False
    return True


def _is_product(target: ir.Expression) -> bool:
    """A place that is seen from a frame with a name."""
    return isinstance(target, ir.Binary) and target.op == ":" and _is_place(target.left) and _is_place(target.right)


def _is_place(target: ir.Expression) -> bool:
    """A variable, or an element of one that can be named again."""
    match target:
        case ir.Name():
            return True
        case ir.Field(base=base):
            return _is_place(base)
        case ir.Index(base=base, indices=indices):
            return _is_place(base) and all(isinstance(one, ir.IntLiteral) or _is_place(one) for one in indices)
    return False
