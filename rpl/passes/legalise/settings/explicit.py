"""Explicit motion to modal motion, for targets where tool, frame, speed and blend are modal (KRL).

Before a move the modal variables that differ from what is known to be set are set; at labels, loops and calls nothing
is known. Components of constant data are written as numbers. Mappings that change the measure are those of modal.py,
read backwards, and reported once.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache

from rpl import ir
from rpl.diagnostics import Code, Severity, code
from rpl.ir.walk import walk
from rpl.passes.capabilities import MoveSetting, PathRule, PlaceRule
from rpl.passes.legalise.context import Context, ProgramScope, rules_of
from rpl.passes.legalise.facts.entries import moving_entries
from rpl.passes.legalise.facts.forward import reactions
from rpl.passes.legalise.facts.usage import assigned_below, assigned_in, base_name, doing, each_statement, usage_of
from rpl.passes.legalise.kinds import kinds_in, walk_for
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.rewriting.settingwords import DROPPED, JOINT_BLEND
from rpl.passes.legalise.settings import carriedframes
from rpl.passes.legalise.settings.leastspeeds import with_least
from rpl.passes.legalise.settings.strengths import is_usual_ramp
from rpl.passes.legalise.settings.usualplaces import TURNING, turns_as_usual, usual_places, usual_turns
from rpl.passes.legalise.stages import legalising
from rpl.passes.percents import MM_S_PER_PERCENT, ZONE_MM_PER_PERCENT
from rpl.passes.rewrite import rewrite_bodies, rewrite_parts
from rpl.passes.scope import Scope
from rpl.passes.signatures import PLACES
from rpl.passes.typewords import component_names
from rpl.passes.typing import type_of
from rpl.source import NOWHERE, Origin

JOINT_TOOL_SPEED = code(
    "approximated-tool-speed",
    Severity.WARNING,
    "a joint move's tool speed has no counterpart; it is written in percent of the axes ({factor:g} mm/s a percent)",
)
TIMED_MOVE = code(
    "approximated-move-time", Severity.WARNING, "the target has no move of a given time; the move keeps its speed"
)
FIXED_TOOL = code("fixed-tool", Severity.LOSS, "a tool that the robot does not hold is not carried over")
EARLY_LOGIC = code(
    "early-logic",
    Severity.WARNING,
    "behind a move that does not stop the source's controller switches near its corner; with the look-ahead permission "
    "that keeps the corner, the target may switch up to its look-ahead earlier",
    "check the place on the robot, or write the output as a trigger on the path",
)

CORNER_OUTPUT = code(
    "corner-output",
    Severity.WARNING,
    "the source's controller switches this where the corner of the move begins, the target in the middle of the corner",
    "give the trigger a distance where the place matters",
)

# Settings of the source's controller that only steer how it interpolates or checks; a target without them drops them.
_OF_NO_MOVE = frozenset(("timer", "timer_stopped", "flag"))
_OF_EACH_AXIS = ("joint_speed", "joint_acceleration")
_CHECKS = frozenset(
    {
        *("joint_configuration_check", "path_configuration_check", "singularity_mode", "acceleration_percent"),
        *("acceleration_ramp", "deceleration_percent", "speed_limit", "load", "end_tolerance", "move_duration"),
        *("posture_shoulder", "posture_elbow", "posture_wrist", "blending", "stop_ramp"),
    }
)


_ASKING = frozenset(("system actual_pose", *(f"function {name}" for name in PLACES)))
_BRAKES = frozenset(("deceleration_percent",))  # beside acceleration_percent, where a target has both


@legalising(unless=lambda context: not context.capabilities.settings.modal)
def explicit_to_modal(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets with modal motion; moves without explicit settings stay as they are."""
    scopes = ProgramScope(program)
    assigned = usage_of(program).assigned
    reported: set[Code] = set()
    usual = usual_places(program) | usual_turns(program, context)
    entries = moving_entries(program)
    looks_ahead = "advance" in context.capabilities.system_variables
    on_paths = any(isinstance(node, ir.Move) and node.kind != "joint" for node in walk_for({"Move"}, *program.modules))
    quiet, below, turns = _quiet(program), assigned_below(program), not turns_as_usual(program)
    # Where joints are points too they have a frame as places have.
    asks = PlaceRule.UNTYPED in context.capabilities.places.rules or not _ASKING.isdisjoint(kinds_in(program))
    restless = not quiet.issuperset(name.lower() for name in reactions(program))
    modules = []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            if looks_ahead and routine.name.lower() in entries and routine.body:
                routine = _looking_ahead(routine, rules_of(context.target).advance.moves)
                routine = _slowing(routine, context) if on_paths else routine
            scope = scopes.routine(module, routine)
            worker = Modal(context, scope, assigned, reported, usual, quiet, below, restless, turns, asks)
            routines.append(edit_bodies(routine, worker.whole))
        modules.append(replace(module, routines=tuple(routines)))
    return with_least(replace(program, modules=tuple(modules)), context)


def _looking_ahead(routine: ir.Routine, moves: int) -> ir.Routine:
    """A routine that a program may start with allows the look-ahead that blending needs."""
    return replace(routine, body=(ir.Assign(ir.System("advance"), ir.IntLiteral(moves)), *routine.body))


def _slowing(routine: ir.Routine, context: Context) -> ir.Routine:
    """Where the source slows down on a path that its axes cannot follow, and the target would stop with an error."""
    name = "path_limit_rule"
    source, target = (rules_of(one).system_defaults.get(name, "reduce") for one in (context.source, context.target))
    if source == target or source != "reduce" or name not in context.capabilities.system_variables:
        return routine
    return replace(routine, body=(ir.Assign(ir.System(name), ir.EnumLiteral("reduce")), *routine.body))


# What a blend that begins where the braking would begin is for joint moves, of the largest corner of the target.
JOINT_SPEED_BLEND = 0.2

Environment = dict[str, ir.Expression]


class Modal:
    def __init__(
        self,
        context: Context,
        scope: Scope,
        assigned: set[str],
        reported: set[Code],
        usual: frozenset[str] = frozenset(),
        quiet: frozenset[str] = frozenset(),
        below: Mapping[str, set[str]] | None = None,
        restless: bool = False,
        turns: bool = True,
        asks: bool = True,
    ) -> None:
        self.context, self.can, self.scope = context, context.capabilities, scope
        self.assigned, self.reported = assigned, reported
        # Nearly every move names the same few tools, frames and speeds.
        self.type_of_name = cache(lambda name: type_of(name, scope))
        self.data_of_name = cache(self.constant_data)
        self.usual, self.quiet, self.below = usual, quiet, below or {}
        self.turns, self.asks = (
            turns,
            asks,
        )  # does any move say how fast the tool turns, is the robot's place asked for?
        self.restless = restless  # an interrupt may set what is modal between any two statements
        self.brakes = _BRAKES & self.can.system_variables
        ours = rules_of(context.source).advance
        self.at_corners = (
            {"Trigger", "LookAhead"} <= context.capabilities.statements
            and ours.runs_ahead_of == "fly_by"
            and not ours.signals_stop
        )

    def report_once(self, what: Code, statement: ir.Statement, **arguments: object) -> None:
        if what not in self.reported:
            self.reported.add(what)
            self.context.diagnostics.report(what, statement.origin, **arguments)

    # ---- flow

    def whole(self, body: ir.Body) -> ir.Body:
        """A body of a routine, in front of which nothing is known."""
        return self.body(body, {})

    def body(self, body: ir.Body, known: Environment) -> ir.Body:
        done: list[ir.Statement] = []
        fly_by = False
        corner: int | None = None  # where the move stands whose outputs follow directly
        for statement in body:
            if self.restless:
                known.clear()
            if isinstance(statement, ir.Move):
                new = self.move(statement, known)
                done.extend(new)
                last = new[-1]
                fly_by = isinstance(last, ir.Move) and last.blend not in (None, ir.BlendStop()) and not last.concurrent
                corner = len(done) - 1 if fly_by and self.at_corners else None
                continue
            if corner is not None and _plain_output(statement, self.scope):
                assert isinstance(statement, ir.Assign)
                self.context.diagnostics.report(CORNER_OUTPUT, statement.origin)
                action = replace(statement, origin=replace(statement.origin, comments=()))
                done.insert(corner, ir.Trigger("middle", action, origin=statement.origin))
                corner += 1
                continue
            corner = corner if isinstance(statement, ir.Nothing) else None
            fly_by = fly_by and not (isinstance(statement, ir.WaitUntil) and statement.in_position)
            if fly_by and isinstance(statement, ir.WaitUntil | ir.Assign) and _stops(statement):
                allowed = bool(done) and isinstance(done[-1], ir.LookAhead)
                if "LookAhead" in self.context.capabilities.statements and not allowed:
                    self.context.diagnostics.report(EARLY_LOGIC, statement.origin)
                    done.append(ir.LookAhead(origin=replace(statement.origin, comments=())))
            elif not isinstance(statement, ir.Assign | ir.Nothing | ir.WaitUntil):
                fly_by = False
            done.extend(self.other(statement, known))
        return tuple(done)

    def other(self, statement: ir.Statement, known: Environment) -> list[ir.Statement]:
        match statement:
            case ir.Assign(target=ir.System(name="acceleration_percent")) if self.can.settings.of_moves:
                return [statement]  # it decides on corners; movesettings leaves it out then
            case ir.Assign(target=ir.System(name=name), value=value) if name in _CHECKS and name not in self.brakes:
                if is_usual_ramp(name, value):
                    return [ir.Nothing(origin=statement.origin)]
                setting = name.replace("_", " ")
                self.context.diagnostics.report(DROPPED, statement.origin, name=setting)
                return [ir.Nothing(origin=statement.origin)]
            case ir.Assign(target=ir.System(name=name, indices=()), value=value) if name in _OF_EACH_AXIS:
                self.changed(name, known)
                first, *rest = _set(name, value, replace(statement.origin, comments=()))
                return [replace(first, origin=statement.origin), *rest]
            case ir.Assign(target=ir.System(name="speed_percent"), value=value):
                return [replace(statement, target=ir.System("override"), value=value)]
            case ir.Assign(target=target):
                self.changed(base_name(target), known)
                return [statement]
            case ir.Label():
                known.clear()
                return [statement]
            case ir.TaskControl():
                known.clear()
                return [statement]
            case ir.CallRoutine() | ir.Do():
                self.passed(statement, known)
                return [statement]
            case ir.Spline():
                return self.spline(statement, known)
            case ir.If() | ir.Switch():
                choice = rewrite_bodies(statement, lambda inner: self.body(inner, dict(known)))
                self.passed(statement, known)
                return [choice]
        new = rewrite_bodies(statement, lambda inner: self.body(inner, {}))
        if new is not statement:
            self.passed(statement, known)
        return [new]

    def passed(self, statement: ir.Statement, known: Environment) -> None:
        """What is still known behind a statement that may set something, itself or in what it calls."""
        if not known or not self.leaves_modal_state(statement):
            known.clear()
        elif calls := [node for node in walk(statement) if isinstance(node, ir.CallRoutine | ir.Call | ir.Do)]:
            changed = assigned_in((statement,))
            for node in calls:
                below = None if isinstance(node, ir.Do) else self.below.get(node.name.lower())
                changed |= self.assigned if below is None else below
            for key in [key for key, value in known.items() if _names(value) & changed]:
                del known[key]
        else:
            each_statement((statement,), lambda inner: self.changed(_assigned(inner), known))

    def leaves_modal_state(self, statement: ir.Statement) -> bool:
        """Can nothing inside change what was set: no move, no setting, no label to jump to, no call that does such?"""
        for node in walk(statement):
            match node:
                case ir.CallRoutine(name=name, dynamic=None) | ir.Call(name=name):
                    if name.lower() not in self.quiet:
                        return False
                case ir.Label():
                    return False
                case _ if _sets(node):
                    return False
        return True

    def changed(self, name: str | None, known: Environment) -> None:
        """Forget what was set from a variable that changes now."""
        for key, value in list(known.items()):
            if name is not None and _mentions(value, name):
                del known[key]

    # ---- moves

    def move(self, move: ir.Move, known: Environment) -> list[ir.Statement]:
        wanted: dict[str, ir.Expression] = {}
        if move.tool is not None:
            wanted["tool"] = self.frame_of_tool(move.tool, move)
        if move.frame is not None:
            wanted["base"] = self.frame_of_work_object(move.frame)
        for name in sorted(self.usual - wanted.keys() - TURNING - self.idle(move)):  # another move may have set it
            wanted[name] = ir.System("null_frame")
        own = self.own_speed(move)
        if move.speed is not None and own is None:
            self.speed(move, move.speed, wanted)
        for name in sorted((self.usual & TURNING) - wanted.keys()) if move.kind != "joint" else ():
            wanted[name] = ir.RealLiteral(float(rules_of(self.context.target).system_defaults.get(name, 0.0)))
        blend = self.blend(move, wanted)
        before: list[ir.Statement] = []
        origin = move.origin
        for name, value in wanted.items():
            if known.get(name) != value:
                known[name] = value
                before.extend(_set(name, value, replace(origin, comments=())))
        if (move.tool is not None and self.is_fixed(move.tool)) or self.is_carried_away(move):
            before.insert(0, ir.Halt(origin=replace(origin, comments=())))  # no controller may drive on from here
        done = replace(move, tool=None, frame=None, load=None, speed=own, blend=blend, configuration=None)
        if before:
            before[0] = replace(before[0], origin=origin)
            done = replace(done, origin=replace(origin, comments=()))
        return [*before, done]

    def idle(self, move: ir.Move) -> frozenset[str]:
        """What is modal and does not matter to a move to joints: its frame, where nothing asks for places."""
        to_joints = move.relative is None and isinstance(self.type(move.target), ir.JointsType)
        return frozenset(("base",)) if to_joints and not self.asks else frozenset()

    def spline(self, spline: ir.Spline, known: Environment) -> list[ir.Statement]:
        """A block: what its first point needs, and its corner, is set in front of it."""
        before: list[ir.Statement] = []
        body: list[ir.Statement] = []
        moves = [item for item in spline.body if isinstance(item, ir.Move)]
        for item in spline.body:
            new: list[ir.Statement] = self.move(item, known) if isinstance(item, ir.Move) else [item]
            if moves and item is moves[0]:
                before, new = new[:-1], new[-1:]
            body += new
        wanted: dict[str, ir.Expression] = {}
        blend = self.blend(replace(moves[-1], blend=spline.blend), wanted) if moves and spline.blend else spline.blend
        for name, value in wanted.items():
            if known.get(name) != value:
                known[name] = value
                before.extend(_set(name, value, replace(spline.origin, comments=())))
        return [*before, rewrite_parts(replace(spline, blend=blend), lambda e: e, None, {"body": tuple(body)})]

    def frame_of_tool(self, tool: ir.Expression, move: ir.Move) -> ir.Expression:
        if not isinstance(self.type(tool), ir.ToolType):
            return tool
        if self.is_fixed(tool):
            self.context.diagnostics.report(FIXED_TOOL, move.origin)
        return self.component(tool, "frame")

    def is_fixed(self, tool: ir.Expression) -> bool:
        """Is it data of a tool that the robot does not hold?"""
        if not isinstance(self.type(tool), ir.ToolType):
            return False
        held = self.component(tool, "held")
        return isinstance(held, ir.BoolLiteral) and not held.value

    def unit_of(self, frame: ir.Expression | None) -> str | None:
        """The mechanism that carries the work object."""
        is_data = frame is not None and isinstance(self.type(frame), ir.WorkObjectType)
        return carriedframes.unit_of(frame, self.component) if frame is not None and is_data else None

    def is_carried_away(self, move: ir.Move) -> bool:
        """Is its frame on a mechanism, which the target cannot say? Then that is reported."""
        unit = self.unit_of(move.frame)
        lost = carriedframes.is_lost(unit, self.context)
        if lost:
            self.context.diagnostics.report(carriedframes.CARRIED_FRAME, move.origin, unit=unit)
        return lost

    def frame_of_work_object(self, frame: ir.Expression) -> ir.Expression:
        return carriedframes.both(self.placed(frame), self.unit_of(frame), self.context)

    def placed(self, frame: ir.Expression) -> ir.Expression:
        """The pose of a work object."""
        if not isinstance(self.type(frame), ir.WorkObjectType):
            return frame
        user, item = self.component(frame, "user_frame"), self.component(frame, "object_frame")
        if _is_identity(item):
            if not _is_identity(user):
                return user
            return ir.Field(frame, "user_frame") if self.is_taught(frame) else ir.System("null_frame")
        return item if _is_identity(user) else ir.Binary(":", user, item)

    def type(self, expression: ir.Expression) -> ir.Type | None:
        return self.type_of_name(expression) if isinstance(expression, ir.Name) else type_of(expression, self.scope)

    def component(self, value: ir.Expression, name: str) -> ir.Expression:
        """The component; of constant data its initial value."""
        aggregate = self.constant_aggregate(value)
        if aggregate is not None:
            type = self.type(value)
            names = component_names(type, self.scope) if type is not None else ()
            for position, (written, entry) in enumerate(aggregate.entries):
                if (written or (names[position] if position < len(names) else "")) == name:
                    taught = name == "frame" and self.is_taught(value)
                    if name in ("frame", "user_frame", "object_frame") and (taught or not _is_identity(entry)):
                        break  # frames stay by name: people re-teach them
                    return entry
        return ir.Field(value, name)

    def is_taught(self, value: ir.Expression) -> bool:
        """Is it data that the program declares, which may still be zero? Else the language has it (tool0, wobj0)."""
        symbol = self.scope.value(value.id) if isinstance(value, ir.Name) else None
        declared = None if symbol is None else symbol.declaration
        return isinstance(declared, ir.Variable) and declared.origin is not NOWHERE

    def constant_aggregate(self, value: ir.Expression) -> ir.Aggregate | None:
        if isinstance(value, ir.Aggregate):
            return value
        return self.data_of_name(value) if isinstance(value, ir.Name) else None

    def constant_data(self, value: ir.Name) -> ir.Aggregate | None:
        symbol = self.scope.value(value.id)
        if symbol is None or not isinstance(symbol.declaration, ir.Variable):
            return None
        declaration = symbol.declaration
        fixed = declaration.storage == "constant" or value.id.lower() not in self.assigned
        initial = declaration.initial
        return self.constant_aggregate(initial) if fixed and initial is not None else None

    def timed(self, move: ir.Move) -> ir.Speed | None:
        """The time of a move that says one, for targets whose moves can."""
        if move.speed is None or move.speed.duration is None:
            return None
        kept = MoveSetting.SPEED in self.can.settings.of_moves and "duration" in self.can.settings.speeds
        kept = kept and (move.kind != "circular" or PathRule.TIMED_ARCS in self.can.motion.paths)
        return ir.Speed(duration=move.speed.duration) if kept else None

    def own_speed(self, move: ir.Move) -> ir.Speed | None:
        """A time, a turning speed or a leading axis' speed that the target's moves say themselves, so that it does not
        become a modal one."""
        timed, speed, can = self.timed(move), move.speed, self.can
        if timed is not None or speed is None or MoveSetting.SPEED not in can.settings.of_moves:
            return timed
        if move.kind == "joint" and speed.axis is not None and speed.joint is None and "axis" in can.settings.speeds:
            rate = speed.axis_acceleration if "axis_acceleration" in can.settings.speeds else None
            return ir.Speed(axis=speed.axis, axis_acceleration=rate)
        alone = speed.path is None and speed.profile is None and speed.rotation is not None and move.kind != "joint"
        return ir.Speed(rotation=speed.rotation) if alone and "rotation" in can.settings.speeds else None

    def speed(self, move: ir.Move, speed: ir.Speed, wanted: dict[str, ir.Expression]) -> None:
        if speed.duration is not None:
            self.report_once(TIMED_MOVE, move)
        path = speed.path or (self.component(speed.profile, "path") if speed.profile is not None else None)
        rotation = speed.rotation or (self.component(speed.profile, "rotation") if speed.profile is not None else None)
        if move.kind == "joint":
            percent = speed.joint
            if percent is None and path is not None:
                self.report_once(JOINT_TOOL_SPEED, move, factor=MM_S_PER_PERCENT)
                percent = _limited(_divided(path, MM_S_PER_PERCENT))
            if percent is not None:
                wanted["joint_speed"] = percent
            return
        if path is not None:
            wanted["path_speed"] = _quantity(path, "mm/s")
        if rotation is not None and self.turns:
            wanted["swivel_speed"] = _quantity(rotation, "deg/s")
            wanted["twist_speed"] = _quantity(rotation, "deg/s")

    def blend(self, move: ir.Move, wanted: dict[str, ir.Expression]) -> ir.Blend | None:
        match move.blend:
            case ir.BlendDistance(distance=size) if size is not None and not isinstance(size, ir.System):
                return self.blend_of_size(move, size, wanted)
            case ir.BlendSpeed(percent=percent) if not isinstance(percent, ir.System):
                if move.kind == "joint":  # no measure of joint moves knows a speed: a small corner is the safe one
                    self.report_once(JOINT_BLEND, move, size="a fifth of the largest one for joint moves")
                    wanted["blend_joint"] = _divided(percent, 1.0 / JOINT_SPEED_BLEND)
                    return ir.BlendPercent(ir.System("blend_joint"))
                wanted["blend_speed"] = percent
                return ir.BlendSpeed(ir.System("blend_speed"))
            case ir.BlendPercent(percent=percent) if move.kind == "joint" and not isinstance(percent, ir.System):
                wanted["blend_joint"] = percent
                return ir.BlendPercent(ir.System("blend_joint"))
            case ir.BlendZone():
                pass
            case _:
                return move.blend
        zone = move.blend
        stop = self.component(zone.zone, "stop")
        if zone.distance is None and isinstance(stop, ir.BoolLiteral) and stop.value:
            return ir.BlendStop()
        size = zone.distance or self.component(zone.zone, "path")
        return self.blend_of_size(move, size, wanted)

    def blend_of_size(self, move: ir.Move, size: ir.Expression, wanted: dict[str, ir.Expression]) -> ir.Blend:
        if move.kind == "joint":
            self.report_once(JOINT_BLEND, move, size="the same radius where the move is long enough")
            wanted["blend_joint"] = _limited(_divided(size, ZONE_MM_PER_PERCENT))
            return ir.BlendPercent(ir.System("blend_joint"))
        wanted["blend_distance"] = _quantity(size, "mm")
        return ir.BlendDistance(ir.System("blend_distance"))


def _quiet(program: ir.Program) -> frozenset[str]:
    """Routines (folded names) that set nothing modal, in themselves or in what they call."""
    routines = frozenset(routine.name.lower() for module in program.modules for routine in module.routines)

    def loud(node: object) -> bool:
        match node:
            case ir.CallRoutine(name=name, dynamic=None) | ir.Call(name=name):
                return name.lower() not in routines
        return _sets(node)

    return routines - doing(program, loud)


def _sets(node: object) -> bool:
    """Is it something that sets what is modal, or may do so?"""
    match node:
        case ir.Assign(target=ir.System(name=name)) if name in _OF_NO_MOVE:
            return False
        case ir.Move() | ir.MoveExternal() | ir.Spline() | ir.Assign(target=ir.System()) | ir.CallRoutine():
            return True
        case ir.TaskControl() | ir.Vendor() | ir.Opaque():
            return True
    return False


def _assigned(statement: ir.Statement) -> str | None:
    return base_name(statement.target) if isinstance(statement, ir.Assign) else None


def _set(name: str, value: ir.Expression, origin: Origin) -> list[ir.Statement]:
    if name in _OF_EACH_AXIS:
        return [ir.Assign(ir.System(name, (ir.IntLiteral(axis),)), value, origin=origin) for axis in range(1, 7)]
    carried = carriedframes.assignments(value, origin)
    return carried if carried is not None else [ir.Assign(ir.System(name), value, origin=origin)]


def _quantity(value: ir.Expression, unit: str) -> ir.Expression:
    return value if isinstance(value, ir.Quantity) else ir.Quantity(value, unit)


def _divided(value: ir.Expression, divisor: float) -> ir.Expression:
    match value:
        case ir.Quantity(value=inner, unit=unit):
            return _divided(inner, divisor / ir.UNITS[unit])
        case ir.RealLiteral(value=number) | ir.IntLiteral(value=number):
            return ir.RealLiteral(float(f"{number / divisor:.6g}"))
    return ir.Binary("/", value, ir.RealLiteral(divisor))


def _limited(percent: ir.Expression) -> ir.Expression:
    """Percentages are at least one hundredth and at most 100."""
    if isinstance(percent, ir.RealLiteral):
        return ir.RealLiteral(min(100.0, max(0.01, percent.value)))
    return ir.Builtin("min", (ir.RealLiteral(100.0), percent))


def _names(value: ir.Expression) -> set[str]:
    return {node.id.lower() for node in walk(value) if isinstance(node, ir.Name)}


def _mentions(value: ir.Expression, name: str) -> bool:
    found = False

    def look(expression: ir.Expression) -> ir.Expression:
        nonlocal found
        found = found or (isinstance(expression, ir.Name) and expression.id.lower() == name)
        return rewrite_parts(expression, look)

    look(value)
    return found


def _is_identity(value: ir.Expression) -> bool:
    """Is it written as the identity pose?"""
    numbers: list[tuple[str, float]] = []

    def look(entry: ir.Expression, path: str) -> bool:
        match entry:
            case ir.Aggregate(entries=entries):
                return all(look(inner, f"{path}.{name or at}") for at, (name, inner) in enumerate(entries))
            case ir.IntLiteral(value=number) | ir.RealLiteral(value=number):
                numbers.append((path.rsplit(".", 1)[-1], float(number)))
                return True
            case ir.Unary(op="-", operand=operand):
                return look(operand, path)
        return False

    if isinstance(value, ir.System):
        return value.name == "null_frame"
    if not isinstance(value, ir.Aggregate) or not look(value, ""):
        return False
    values = [number for _, number in numbers]
    quaternion = len(values) == 7
    return (values == [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]) if quaternion else not any(values)


def _plain_output(statement: ir.Statement, scope: Scope) -> bool:
    """Does it switch one output, by its number or its declared name, to a value that is known beforehand?"""
    if not isinstance(statement, ir.Assign) or not isinstance(statement.value, ir.BoolLiteral):
        return False
    signal = statement.target
    if isinstance(signal, ir.Name):
        symbol = scope.value(signal.id)
        declaration = None if symbol is None else symbol.declaration
        signal = declaration.signal if isinstance(declaration, ir.SignalDeclaration) else signal
    match signal:
        case ir.Signal(kind="digital_out", index=ir.IntLiteral(), last=None, name=None):
            return True
    return False


def _stops(statement: ir.WaitUntil | ir.Assign) -> bool:
    """Would the statement stop an advance run: does it touch a signal?"""
    found = False

    def look(expression: ir.Expression) -> ir.Expression:
        nonlocal found
        found = found or isinstance(expression, ir.Signal)
        return rewrite_parts(expression, look)

    rewrite_parts(statement, look)
    return found
