"""Modal speed, frame and blend to settings of each move, as plain quantities, for targets whose moves say them so.

What is known at a move (`flows`) is written there; where it depends on the run, a variable holds it. Runs behind
explicit_to_modal, so it meets modal motion from every source. Settings that a target keeps modal stay, but setting what
is set already goes away.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Code
from rpl.passes.capabilities import MoveSetting, SettingRule
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.motion.saidaccelerations import SAID, Accelerations
from rpl.passes.legalise.facts.settingsinforce import SETTINGS, SettingsInForce, State
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_bodies, edit_each
from rpl.passes.legalise.rewriting.formulas import plain
from rpl.passes.legalise.rewriting.settingwords import DROPPED, DROPPED_SETTINGS, JOINT_BLEND, USUAL, says
from rpl.passes.legalise.rewriting.shadows import Shadow, only_served
from rpl.passes.legalise.settings.coordinatedmoves import REMOTE
from rpl.passes.legalise.settings.coordinatedmoves import SETTING as COORDINATED
from rpl.passes.legalise.stages import legalising
from rpl.passes.percents import ZONE_MM_PER_PERCENT
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.signatures import PLACES
from rpl.passes.typing import type_of

_WORLD = ir.System("null_frame")
# Settings that such a target has no word for, so that they cannot stay modal either.
# What targets with coordinated moves say at a move.
_AT_MOVES = (COORDINATED, "external_speed", REMOTE)
_LEFT_OUT = DROPPED_SETTINGS | {"swivel_speed", "twist_speed", "acceleration_percent"}
_PARTS = {
    "tool": (MoveSetting.TOOL,),
    "base": (MoveSetting.FRAME,),
    "path_speed": (MoveSetting.SPEED,),
    "joint_speed": (MoveSetting.SPEED,),
    "blend_distance": (MoveSetting.BLEND,),
    "blend_joint": (MoveSetting.BLEND,),
}


def _tools(program: ir.Program) -> Iterator[ir.Expression]:
    for node in walk_for({"Assign"}, *program.modules):
        if isinstance(node, ir.Assign) and node.target == ir.System("tool"):
            yield node.value


@legalising(unless=lambda context: not context.capabilities.settings.of_moves)
def settings_at_moves(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose moves say some settings and keep the rest modal."""
    return _Settings(program, context).program()


@dataclass(slots=True)
class _Settings:
    source: ir.Program
    context: Context
    flow: SettingsInForce = field(init=False)
    here: State = field(default_factory=dict)
    variables: dict[str, Shadow] = field(default_factory=dict)
    reported: set[tuple[Code, str]] = field(default_factory=set)
    told: bool = False  # does the program set different tools, or is none ever in force?
    accelerations: Accelerations = field(init=False)
    scopes: ProgramScope = field(init=False)
    scope: Scope | None = None

    def __post_init__(self) -> None:
        self.scopes = ProgramScope(self.source)
        several = len({repr(value) for value in _tools(self.source)}) > 1
        self.told = several or SettingRule.TOOL_IN_FORCE not in self.context.capabilities.settings.rules
        self.flow = SettingsInForce.begun_by(self.source, self.context.source)
        self.accelerations = Accelerations(self.source, self.context, self.flow.start)

    def says(self, name: str) -> bool:
        """Do moves of the target say this setting?"""
        return bool(set(_PARTS[name]) & self.context.capabilities.settings.of_moves)

    def report_once(self, what: Code, statement: ir.Statement, key: str, **arguments: object) -> None:
        if (what, key) not in self.reported:
            self.reported.add((what, key))
            self.context.diagnostics.report(what, statement.origin, **arguments)

    # ---- program

    def program(self) -> ir.Program:
        modules = self.modules()
        if self.variables:  # now it is known which settings need a variable: again, with these set everywhere
            modules = self.modules()
        program = replace(self.source, modules=modules)
        if not self.variables:
            return program
        data = [shadow.variable for shadow in self.variables.values()]
        home = ir.Module(self.context.fresh("rpl_settings"), program.modules[0].dialect, tuple(data), public=True)
        program = replace(program, modules=(*program.modules, home))
        return only_served(program, [one.name for one in data])

    def modules(self) -> tuple[ir.Module, ...]:
        return edit_each(self.source, self.routine).modules

    def routine(self, module: ir.Module, routine: ir.Routine) -> ir.Routine:
        self.scope = self.scopes.routine(module, routine)
        return edit_bodies(routine, self.body)

    def variable(self, name: str) -> ir.Name:
        if name not in self.variables:
            initial = self.flow.start.get(name)
            first = initial if isinstance(initial, ir.RealLiteral | ir.IntLiteral) else ir.RealLiteral(0.0)
            variable = ir.Name(self.context.fresh(f"rpl_{name}"))
            self.variables[name] = Shadow(variable, _WORLD if name in ("tool", "base") else first)
        return self.variables[name].name

    # ---- statements

    def body(self, body: ir.Body) -> ir.Body:
        outer = self.here
        done = tuple(one for statement in body for one in self.statement(statement))
        self.here = outer
        return done

    def statement(self, statement: ir.Statement) -> ir.Body:
        self.here = self.flow.at(statement)
        match statement:
            case ir.Assign(target=ir.System(name=name)) if name in SETTINGS:
                return self.setting(statement, name)
            case ir.Assign(target=ir.System(name=name), value=value) if name in _LEFT_OUT:
                if name in self.context.capabilities.system_variables or name == "interpolation":
                    if not says(value, USUAL.get(name, "")):
                        return (rewrite_parts(statement, self.expression, self.body),)
                elif not says(value, USUAL.get(name, "")) and not (name in SAID and self.accelerations.active):
                    self.report_once(DROPPED, statement, name, name=name.replace("_", " "))
                return (ir.Nothing(origin=statement.origin),)
            case ir.Move():
                return (self.move(statement),)
        return (rewrite_parts(statement, self.expression, self.body),)

    def setting(self, statement: ir.Assign, name: str) -> ir.Body:
        target, value = statement.target, statement.value
        assert isinstance(target, ir.System)  # as the caller has found
        if not self.says(name):
            if self.flow.again(statement):
                return (ir.Nothing(origin=statement.origin),)
            return (rewrite_parts(statement, self.expression, self.body),)
        if name not in self.variables or target.indices not in ((), (ir.IntLiteral(1),)):
            return (ir.Nothing(origin=statement.origin),)
        return (replace(statement, target=self.variable(name), value=plain(self.expression(value))),)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        if isinstance(expression, ir.System) and expression.name in SETTINGS and self.says(expression.name):
            return self.variable(expression.name)
        done = rewrite_parts(expression, self.expression)
        if self.told and self.says("tool"):
            done = self.with_tool(done)
        return self.in_base(done) if MoveSetting.FRAME in self.context.capabilities.settings.of_moves else done

    def with_tool(self, seen: ir.Expression) -> ir.Expression:
        """What depends on the modal tool, told: a target that sets none may take another one."""
        given: tuple[ir.Expression, ...]
        match seen:
            case ir.System(name="actual_pose") | ir.Builtin(function="current_target", arguments=()):
                name, given = "current_target", ()
            case ir.Builtin(function="current_position" as name, arguments=()):
                given = ()
            case ir.Builtin(function="joints_to_target" | "target_to_joints" as name, arguments=(one,)):
                given = (one,)
            case _:
                return seen
        base = self.value("base", self.here, {}) if self.says("base") else _WORLD
        return ir.Builtin(name, (*given, self.value("tool", self.here, {}), base), origin=seen.origin)

    def in_base(self, expression: ir.Expression) -> ir.Expression:
        """What depends on the modal frame, for a target that knows poses in the robot's base only."""
        match expression:
            case ir.System(name="actual_pose") | ir.Builtin(function="current_target", arguments=()):
                return self.framed(expression, inverse=True)
            case ir.Builtin(function="current_position", arguments=()):
                place = ir.Builtin("current_target", (), origin=expression.origin)
                seen = self.framed(place, inverse=True)
                return expression if seen is place else ir.Field(seen, "trans", origin=expression.origin)
            case ir.Builtin(function=function, arguments=given) if len(given) == PLACES.get(function, (0, 0))[1] > 0:
                frame = self.value("base", self.here, {})
                return expression if frame == _WORLD else replace(expression, arguments=(*given, frame))
            case ir.Builtin(function="joints_to_target", arguments=(_,)):
                return self.framed(expression, inverse=True)
            case (
                ir.Builtin(function="target_to_joints", arguments=(place,) as arguments)
                | ir.Builtin(function="target_to_joints_near" | "is_reachable", arguments=(place, _) as arguments)
            ):
                return replace(expression, arguments=(self.framed(place, inverse=False), *arguments[1:]))
        return expression

    def framed(self, pose: ir.Expression, *, inverse: bool) -> ir.Expression:
        frame = self.value("base", self.here, {})
        if frame == _WORLD:
            return pose
        return ir.Binary(":", ir.Builtin("inverse", (frame,)) if inverse else frame, pose, origin=pose.origin)

    # ---- moves

    def move(self, move: ir.Move) -> ir.Move:
        state = self.flow.at(move)
        own = {place.name: value for place, value in move.settings if isinstance(place, ir.System)}
        can = self.context.capabilities
        at_move = set(_AT_MOVES) if COORDINATED in can.system_variables else set()
        at_move |= {"deceleration_percent"} if MoveSetting.DECELERATION in can.settings.of_moves else set()
        for name in own.keys() - SETTINGS - at_move:
            self.report_once(DROPPED, move, name, name=name.replace("_", " "))
        kept = tuple(one for one in move.settings if isinstance(one[0], ir.System) and one[0].name in at_move)
        done = rewrite_parts(replace(move, settings=kept, blend=None), self.expression, self.body)
        near = move.target
        if isinstance(near, ir.Builtin) and near.function == "target_to_joints_near":
            # a posture beside the move's target: the target stands in the frame of the move
            done = replace(done, target=rewrite_parts(near, self.expression))
        says = self.context.capabilities.settings.of_moves
        blend = self.blend(move, state, own) if MoveSetting.BLEND in says else move.blend
        done = replace(done, blend=blend)
        if MoveSetting.FRAME in says and move.frame is None and not self.to_joints_anyhow(move, state):
            frame = self.value("base", state, own)
            done = replace(done, frame=None if frame == ir.System("null_frame") else frame)
        if MoveSetting.TOOL in says and move.tool is None:
            done = replace(done, tool=self.value("tool", state, own))
        if MoveSetting.SPEED in says and move.speed is None:
            done = replace(done, speed=self.speed(move, state, own))
        return self.accelerations.with_acceleration(done, state)

    def to_joints_anyhow(self, move: ir.Move, state: State) -> bool:
        """Does the move go to taught joints, so that the frame, which only the run decides, means nothing to it? Joints
        that are worked out of a place stand in the frame of the move."""
        if state.get("base") is not None or move.kind != "joint" or self.scope is None:
            return False
        taught = isinstance(move.target, ir.Name | ir.Index | ir.Aggregate)
        return taught and isinstance(type_of(move.target, self.scope), ir.JointsType)

    def value(self, name: str, state: State, own: dict[str, ir.Expression]) -> ir.Expression:
        """What the setting is at a move: a constant, or the variable that holds it."""
        found = own.get(name) or state.get(name)
        return self.variable(name) if found is None else plain(self.expression(found))

    def speed(self, move: ir.Move, state: State, own: dict[str, ir.Expression]) -> ir.Speed:
        if move.kind == "joint":
            return ir.Speed(joint=self.value("joint_speed", state, own))
        return ir.Speed(path=self.value("path_speed", state, own))

    def blend(self, move: ir.Move, state: State, own: dict[str, ir.Expression]) -> ir.Blend | None:
        if move.blend.__class__.__name__ in self.context.capabilities.settings.blends and not _modal(move.blend):
            return rewrite_parts(move.blend, self.expression)
        size: ir.Expression
        match move.blend:
            case None | ir.BlendStop():
                return move.blend
            case ir.BlendDistance():
                size = self.value("blend_distance", state, own)
            case ir.BlendLevel(level=ir.IntLiteral(value=level)):
                levels = rules_of(self.context.source).blend_levels
                size = ir.RealLiteral(levels[level] if level < len(levels) else 0.0)
                self.report_once(JOINT_BLEND, move, f"level {level}", size=f"{size.value:g} mm")
            case ir.BlendPercent(path=ir.BlendDistance(distance=distance)) if (
                distance is not None and not _modal(move.blend.path) and move.kind != "joint"
            ):
                size = plain(self.expression(distance))  # the measure of path moves goes before the percent
            case ir.BlendPercent(percent=percent):
                size = self.by_percent(move, percent, state, own)
            case ir.BlendSpeed(percent=percent):
                size = self.by_speed(move, percent, state, own)
            case _:
                return rewrite_parts(move.blend, self.expression)
        if isinstance(size, ir.RealLiteral | ir.IntLiteral) and size.value == 0:
            return ir.BlendStop()
        return ir.BlendDistance(size)

    def by_speed(
        self, move: ir.Move, percent: ir.Expression, state: State, own: dict[str, ir.Expression]
    ) -> ir.Expression:
        """The way in which a move brakes from a part of its speed: v^2 / 2a, in mm."""
        known = {**state, **own}
        if isinstance(percent, ir.System):
            percent = known.get("blend_speed") or percent
        path = (move.speed.path if move.speed is not None else None) or self.value("path_speed", state, own)
        path, factor = plain(self.expression(path)), 1.0
        for value, power in (
            (percent, 2),
            (known.get("path_acceleration"), -1),
            (own.get("acceleration_percent") or move.acceleration or known.get("acceleration_percent"), -1),
        ):
            number = plain(value) if value is not None else None
            if not isinstance(number, ir.RealLiteral) or number.value <= 0.0:
                self.report_once(JOINT_BLEND, move, "speed", size="the modal size")
                return self.value("blend_distance", state, own)
            factor *= number.value**power
        factor /= 2.0 * 100.0  # (percent / 100)^2 over 2 a (percent / 100)
        if isinstance(path, ir.RealLiteral):
            size = ir.RealLiteral(float(f"{path.value**2 * factor:.6g}"))
            self.report_once(JOINT_BLEND, move, f"speed {size.value}", size=f"{size.value:g} mm")
            return size
        self.report_once(JOINT_BLEND, move, "speed", size="the way in which the move brakes")
        return ir.Binary("*", ir.Binary("*", path, path), ir.RealLiteral(float(f"{factor:.6g}")))

    def by_percent(
        self, move: ir.Move, percent: ir.Expression, state: State, own: dict[str, ir.Expression]
    ) -> ir.Expression:
        """A size in mm for a blend that the source measures in percent."""
        if isinstance(percent, ir.System):
            percent = self.value("blend_joint", state, own)
        size = plain(self.expression(percent))
        if isinstance(size, ir.RealLiteral | ir.IntLiteral):
            size = ir.RealLiteral(float(f"{size.value * ZONE_MM_PER_PERCENT:.12g}"))
            if size.value:
                self.report_once(JOINT_BLEND, move, str(size.value), size=f"{size.value:g} mm")
            return size
        self.report_once(JOINT_BLEND, move, "computed", size=f"{ZONE_MM_PER_PERCENT:g} mm a percent")
        return ir.Binary("*", size, ir.RealLiteral(ZONE_MM_PER_PERCENT))


def _modal(blend: ir.Blend | None) -> bool:
    """Is its size a modal one?"""
    match blend:
        case ir.BlendDistance(distance=None) | ir.BlendDistance(distance=ir.System()):
            return True
        case ir.BlendPercent(percent=ir.System()) | ir.BlendSpeed(percent=ir.System()):
            return True
    return False
