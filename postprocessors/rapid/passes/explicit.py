"""Modal motion to explicit motion: RAPID's moves name their tool, frame, speed and zone.

The modal state becomes global data of the target's own types: setting a modal variable sets a component, and each move
names the data. Where the value at a move is a known constant, the move names the constant. What a target cannot say in
the same measure (speeds in percent of the axes, blends in percent) is mapped by one table here and reported once.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Code, Severity, code
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context, ProgramScope, rules_of
from rpl.passes.legalise.facts.settingsinforce import SettingsInForce, State
from rpl.passes.legalise.kinds import has_arcs, walk_for
from rpl.passes.legalise.rewriting.editing import edit_all, edit_bodies, edit_each, map_body
from rpl.passes.legalise.rewriting.headdata import with_data
from rpl.passes.legalise.rewriting.settingwords import DROPPED, DROPPED_SETTINGS, JOINT_BLEND, ROOT, UNIT, USUAL, says
from rpl.passes.legalise.stages import legalising
from rpl.passes.percents import MM_S_PER_PERCENT, ZONE_MM_PER_PERCENT, ZONE_PROPORTIONS
from rpl.passes.rewrite import rewrite_bodies, rewrite_parts
from rpl.passes.scope import Scope
from rpl.passes.signatures import PLACES
from rpl.passes.typing import type_of
from rpl.source import Origin

from .tooldata import tool_of, work_object_of

JOINT_SPEED = code(
    "approximated-joint-speed",
    Severity.WARNING,
    "joint speed in percent has no counterpart; {percent} percent is written as {factor:g} mm/s a percent",
)
TURNING = code(
    "usual-turning-speed",
    Severity.INFO,
    "the tool turns as fast as the target's usual speeds let it ({limit:g} deg/s), whatever the source allows beside "
    "the path",
    "where a move turns much, give it a slower speed",
)
UNIT_NAME = code(
    "mechanism-name",
    Severity.WARNING,
    "the mechanism that carries the frame keeps its name '{unit}'; the target's configuration must have one called so",
)
UNIT_ROOT = code(
    "mechanism-root",
    Severity.WARNING,
    "where a mechanism stands is not said by the target's programs but by its configuration; it is left out",
)
# The path speed of a move that only its turning speed limits: the largest programmable one.
_FREE_PATH_MM_S = 5000.0
# How fast the tool turns in speeds that say nothing else about it: what all predefined ones have.
_USUAL_TURN_DEG_S = 500.0
# Below it, deg/s, somebody wants slow turns; controllers and their start routines set more.
_CHOSEN_TURN_DEG_S = 100.0
_STANDARD_EXTERNAL = (ir.RealLiteral(5000.0), ir.RealLiteral(1000.0))
_OWN_SETTINGS = DROPPED_SETTINGS | {UNIT, ROOT}


def _real(value: float) -> ir.Expression:
    return ir.RealLiteral(float(value))


@dataclass(slots=True)
class _State:
    """Names of the generated data."""

    names: dict[str, str] = field(default_factory=dict)
    reported: set[tuple[Code, str]] = field(default_factory=set)


# What is generated where the run decides: type, storage, name.
_KINDS: dict[str, tuple[ir.Type, str, str]] = {
    "tool": (ir.ToolType(), "persistent", "tCurrent"),
    "frame": (ir.WorkObjectType(), "persistent", "wobjCurrent"),
    "speed": (ir.SpeedType(), "variable", "vPath"),
    "joint_speed": (ir.SpeedType(), "variable", "vJoint"),
    "zone": (ir.ZoneType(), "variable", "zPath"),
    "joint_zone": (ir.ZoneType(), "variable", "zJoint"),
    "own_zone": (ir.ZoneType(), "variable", "zMove"),
    "with_tool": (ir.ToolType(), "persistent", "tMove"),
    "with_frame": (ir.WorkObjectType(), "persistent", "wobjMove"),
}


@legalising()
def modal_to_explicit(program: ir.Program, context: Context) -> ir.Program:
    """Tool, frame, speed and zone that are set become data that each move names."""
    worker = _Explicit(program, context)
    program = worker.without_dead_settings(edit_each(program, worker.routine))
    declarations = worker.declarations()
    if declarations:
        task = next((module.task for module in program.modules), "")
        shared = tuple(one for one in declarations if isinstance(one, ir.Variable) and one.storage == "persistent")
        modules = tuple(_sharing(module, task, shared) for module in program.modules)
        program = with_data(replace(program, modules=modules), declarations)
    return program


def _sharing(module: ir.Module, home: str, shared: tuple[ir.Variable, ...]) -> ir.Module:
    """The module of another task with the tool and the frame that it asks for: persistent data is one for all tasks."""
    if module.task == home:
        return module
    named = {node.id for node in walk(module) if isinstance(node, ir.Name)}
    needed = tuple(one for one in shared if one.name in named)
    return replace(module, declarations=(*module.declarations, *needed)) if needed else module


Environment = dict[str, ir.Expression]


class _Explicit:
    def __init__(self, program: ir.Program, context: Context) -> None:
        self.context = context
        self.arcs = has_arcs(program)
        self.state = _State()
        self.made = _settings_made(program)
        self.never = {"tool", "base"} - self.made
        self.defaults = rules_of(context.source).system_defaults
        self.flow = SettingsInForce.of(program, dict(self.defaults), {"tool": ir.System("null_frame")})
        self.here: State = {}
        self.task = program.modules[0].task  # that moves; what it has set is not known in one beside it
        self.follows = True
        self.poses = _global_poses(program)
        self.scopes = ProgramScope(program)
        self.scope: Scope | None = None

    # ---- generated data

    def name(self, kind: str) -> ir.Expression:
        if kind not in self.state.names:
            self.state.names[kind] = self.context.fresh(_KINDS[kind][2])
        return ir.Name(self.state.names[kind])

    def without_dead_settings(self, program: ir.Program) -> ir.Program:
        """Data that no move reads, because every move names constants, is neither set nor declared."""
        named = Counter(node.id for node in walk_for({"Name"}, *program.modules) if isinstance(node, ir.Name))
        named.subtract(_set_in_parts(program))
        dead = {name for name in self.state.names.values() if not named[name]}
        self.state.names = {kind: name for kind, name in self.state.names.items() if name not in dead}

        def body(statements: ir.Body) -> ir.Body:
            done: list[ir.Statement] = []
            for statement in statements:
                match statement:
                    case ir.Assign(target=ir.Field(base=ir.Name(id=name))) if name in dead:
                        if statement.origin.comments:
                            done.append(ir.Nothing(origin=statement.origin))
                    case _:
                        done.append(rewrite_bodies(statement, body))
            return tuple(done)

        return edit_all(program, body) if dead else program

    def default(self, name: str, fallback: float) -> float:
        value = self.defaults.get(name, fallback)
        return float(value) if not isinstance(value, str) else fallback

    def declarations(self) -> tuple[ir.Declaration, ...]:
        initial = {
            "tool": tool_of(),
            "with_tool": tool_of(),
            "frame": work_object_of(),
            "with_frame": work_object_of(),
            "speed": _speed(_real(self.default("path_speed", 250.0)), _real(_USUAL_TURN_DEG_S)),
            "joint_speed": _speed(
                _real(self.default("joint_speed", 100.0) * MM_S_PER_PERCENT), _real(_USUAL_TURN_DEG_S)
            ),
            "zone": _zone(_real(self.default("blend_distance", 0.0))),
            "joint_zone": _zone(_real(self.default("blend_joint", 50.0) * ZONE_MM_PER_PERCENT)),
            "own_zone": _zone(_real(self.default("blend_distance", 0.0))),
        }
        return tuple(
            ir.Variable(name, _KINDS[kind][0], initial[kind], storage=_KINDS[kind][1], scope="global")
            for kind, name in self.state.names.items()
        )

    def report_once(self, what: Code, statement: ir.Statement, key: str, **arguments: object) -> None:
        if (what, key) not in self.state.reported:
            self.state.reported.add((what, key))
            self.context.diagnostics.report(what, statement.origin, **arguments)

    # ---- statements

    def routine(self, module: ir.Module, routine: ir.Routine) -> ir.Routine:
        self.follows = module.task == self.task
        self.scope = self.scopes.routine(module, routine)
        return edit_bodies(routine, self.body)

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def statement(self, statement: ir.Statement) -> ir.Body:
        outer, self.here = self.here, self.flow.at(statement) if self.follows else {}
        done = self.rewritten(statement)
        self.here = outer
        return done

    def rewritten(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.Assign(target=ir.System(name=name)) if name in _MODAL or name in _OWN_SETTINGS:
                return tuple(self.setting(statement))
            case ir.Move():
                return tuple(self.move(statement, self.known(statement)))
        return (rewrite_parts(statement, self.expression, self.body),)

    def known(self, move: ir.Move) -> Environment:
        """Settings that the program has set to plain numbers at a move."""
        found = {name: _number(value) for name, value in self.flow.at(move).items() if value is not None}
        return {name: value for name, value in found.items() if value is not None}

    # ---- settings

    def setting(self, statement: ir.Assign) -> list[ir.Statement]:
        target = statement.target
        assert isinstance(target, ir.System)
        name, value = target.name, self.expression(statement.value)
        if name == UNIT:
            return self.carried(statement, value)
        if name == ROOT:
            self.report_once(UNIT_ROOT, statement, name)
            return [ir.Nothing(origin=statement.origin)]
        if name in DROPPED_SETTINGS:
            if name == "circle_orientation" and name in self.context.capabilities.system_variables:
                return [statement if self.arcs else ir.Nothing(origin=statement.origin)]
            if says(value, USUAL.get(name, "")):
                return [ir.Nothing(origin=statement.origin)]
            if name == "interpolation":  # a tool fixed in the room is another motion: the writer stops there
                return [statement]
            self.report_once(DROPPED, statement, name, name=name.replace("_", " "))
            return [ir.Nothing(origin=statement.origin)]
        kind, component = _MODAL[name]
        place = ir.Field(self.name(kind), component)
        made = [ir.Assign(place, _scaled(value, _FACTOR.get(name, 1.0)), origin=statement.origin)]
        if name == "base" and UNIT in self.made:  # it was perhaps on a mechanism
            made.append(ir.Assign(replace(place, name="fixed"), ir.BoolLiteral(True), origin=_later(statement)))
        if component == "path" and kind.endswith("zone"):
            later = replace(statement.origin, comments=())
            for other, factor in ZONE_PROPORTIONS[1:]:
                scaled = _scaled(value, _FACTOR.get(name, 1.0) * factor)
                made.append(ir.Assign(ir.Field(self.name(kind), other), scaled, origin=later))
        return list(made)

    def carried(self, statement: ir.Assign, value: ir.Expression) -> list[ir.Statement]:
        """The modal frame goes on a mechanism: its work object names the unit, under the name that the source has."""
        if not isinstance(value, ir.TextLiteral):
            return [statement]
        if says(value, "none"):
            return [ir.Nothing(origin=statement.origin)]
        word = value.value
        self.report_once(UNIT_NAME, statement, word, unit=word)
        frame = self.name("frame")
        return [
            ir.Assign(ir.Field(frame, "fixed"), ir.BoolLiteral(False), origin=statement.origin),
            ir.Assign(ir.Field(frame, "unit"), ir.TextLiteral(word), origin=_later(statement)),
        ]

    def expression(self, expression: ir.Expression) -> ir.Expression:
        if isinstance(expression, ir.System) and expression.name == "actual_pose":
            return self.seen(ir.Builtin("current_target", (), origin=expression.origin))
        if isinstance(expression, ir.Builtin) and expression.function in PLACES:
            return self.seen(rewrite_parts(expression, self.expression))
        if isinstance(expression, ir.System) and expression.name in _MODAL:
            kind, component = _MODAL[expression.name]
            read = ir.Field(self.name(kind), component, origin=expression.origin)
            factor = _FACTOR.get(expression.name, 1.0)
            return read if factor == 1.0 else ir.Binary("/", read, _real(factor), origin=expression.origin)
        return rewrite_parts(expression, self.expression)

    def modal_data(self, name: str) -> ir.Expression | None:
        """The tool (`tool`) or frame (`base`) in force: the datum that is known to be set here, else the generated one;
        None when nothing ever sets one."""
        if name in self.never:
            return None
        value = None if name == "base" and UNIT in self.made else self.here.get(name)
        return value if value is not None and self.is_datum(value) else self.name(_MODAL[name][0])

    def is_datum(self, value: ir.Expression) -> bool:
        """Can a move name it: no offset at all, numbers, or a pose that the whole program knows by a name?"""
        match value:
            case ir.System(name="null_frame"):
                return True
            case ir.Name(id=name):
                return name.lower() in self.poses
        return isinstance(value, ir.Aggregate) and not any(isinstance(one, ir.Name) for one in walk(value))

    def seen(self, expression: ir.Builtin) -> ir.Builtin:
        """Where the robot is, with the tool and frame that are set, and not with those of the last move."""
        bare, at = self.context.capabilities.settings.bare, PLACES[expression.function][0]
        if len(expression.arguments) != at or bare is None:
            return expression
        tool = self.modal_data("tool") or ir.Name(bare[0])
        frame = self.modal_data("base") or ir.Name(bare[1])
        return replace(expression, arguments=(*expression.arguments, tool, frame))

    # ---- moves

    def to_joints(self, move: ir.Move) -> bool:
        """Does it go to joint values? They are seen from no frame."""
        scope = self.scope
        return scope is not None and isinstance(type_of(move.target, scope), ir.JointsType)

    def move(self, move: ir.Move, known: Environment) -> list[ir.Statement]:
        before: list[ir.Statement] = []
        own: dict[str, ir.Expression] = {}
        for place, value in move.settings:
            if isinstance(place, ir.System):
                own[place.name] = self.expression(value)
                if place.name not in _MODAL:
                    self.report_once(DROPPED, move, place.name, name=place.name.replace("_", " "))
        tool = move.tool or self.modal_data("tool")
        frame = move.frame or (None if self.to_joints(move) else self.modal_data("base"))
        later = replace(move.origin, comments=())
        said = {place.name: value for place, value in move.settings if isinstance(place, ir.System)}
        if "tool" in own and self.is_datum(said["tool"]):
            tool = said["tool"]
        elif "tool" in own:
            tool = self.name("with_tool")
            before.append(ir.Assign(ir.Field(tool, "frame"), own["tool"], origin=later))
        if "base" in own and self.is_datum(said["base"]):
            frame = said["base"]
        elif "base" in own:
            frame = self.name("with_frame")
            before.append(ir.Assign(ir.Field(frame, "user_frame"), own["base"], origin=later))
        done = rewrite_parts(move, self.expression)
        done = replace(
            done,
            tool=tool,
            frame=frame,
            speed=self.own_speed(done, known, own),
            blend=self.blend(done, known, own),
            settings=(),
        )
        if isinstance(done.blend, ir.BlendZone) and done.blend.distance is not None and done.blend is not move.blend:
            stops = ir.Binary("<=", done.blend.distance, _real(0.0))  # no corner is a stop, and no corner of 0 mm
            before.append(ir.Assign(ir.Field(done.blend.zone, "stop"), stops, origin=later))
        return [*before, done]

    def own_speed(self, move: ir.Move, known: Environment, own: dict[str, ir.Expression]) -> ir.Speed:
        """A move's speed as a value: one that says only numbers (percent, mm/s, deg/s) is made like the modal ones."""
        speed = move.speed
        if speed is not None and speed.profile is not None:
            return speed
        if speed is not None and speed.duration is not None:
            plain = replace(move, speed=replace(speed, duration=None))
            return replace(self.own_speed(plain, known, own), duration=speed.duration)
        if speed is not None:
            given = {"joint_speed": speed.joint, "path_speed": speed.path}
            own = {**own, **{name: value for name, value in given.items() if value is not None}}
            turning = None if speed.rotation is None or move.kind == "joint" else _number(speed.rotation)
            if turning is not None and speed.path is None:
                return ir.Speed(profile=_speed(_real(_FREE_PATH_MM_S), turning))
            if turning is not None:
                self.report_once(TURNING, move, "", limit=_USUAL_TURN_DEG_S)
        return self.speed(move, known, own)

    def speed(self, move: ir.Move, known: Environment, own: dict[str, ir.Expression]) -> ir.Speed:
        values = {**known, **own}
        if move.kind == "joint" and "path_speed" in own and "joint_speed" not in own:
            return ir.Speed(profile=_speed(own["path_speed"], _real(_USUAL_TURN_DEG_S)))
        if move.kind == "joint":
            percent = values.get("joint_speed")
            shown = percent.value if isinstance(percent, ir.RealLiteral | ir.IntLiteral) else "the modal"
            if shown not in (100, 100.0):
                self.report_once(JOINT_SPEED, move, str(shown), percent=shown, factor=MM_S_PER_PERCENT)
            if percent is not None:
                return ir.Speed(profile=_speed(_scaled(percent, MM_S_PER_PERCENT), _real(_USUAL_TURN_DEG_S)))
            return ir.Speed(profile=self.name("joint_speed"))
        path_speed = values.get("path_speed")
        if path_speed is not None and _number(path_speed) is not None:
            turning = self.turning(move, known)
            if turning is not None:
                return ir.Speed(profile=_speed(path_speed, turning))
        return ir.Speed(profile=self.name("speed"), path=own.get("path_speed"))

    def turning(self, move: ir.Move, known: Environment) -> ir.Expression | None:
        """How fast the tool turns at most, deg/s. The usual one of the target's speeds, unless the program has set a
        slow one for its own sake, or turns in place. None: it depends on the run."""
        if "swivel_speed" not in self.made:
            return _real(_USUAL_TURN_DEG_S)
        value = known.get("swivel_speed")
        if not isinstance(value, ir.RealLiteral | ir.IntLiteral):
            return value
        chosen = value.value < _CHOSEN_TURN_DEG_S and not self.same_share(value.value, known)
        if chosen or _turns_in_place(move):
            return value
        self.report_once(TURNING, move, "", limit=_USUAL_TURN_DEG_S)
        return _real(_USUAL_TURN_DEG_S)

    def same_share(self, turning: float, known: Environment) -> bool:
        """Does the turning speed come with the joint speed, as the same share of the full one?"""
        joint = known.get("joint_speed")
        full = self.default("swivel_speed", 0.0)
        if not isinstance(joint, ir.RealLiteral | ir.IntLiteral):
            return False
        return abs(turning * 100.0 - joint.value * full) < 1e-6 * full

    def blend(self, move: ir.Move, known: Environment, own: dict[str, ir.Expression]) -> ir.Blend:
        values = {**known, **own}
        match move.blend:
            case None | ir.BlendStop():
                return ir.BlendStop()
            case ir.BlendDistance(distance=distance) if move.kind != "joint" or distance is not None:
                modal = distance is None or (isinstance(distance, ir.Field) and distance.name == "path")
                if modal:
                    distance = values.get("blend_distance")
                if not modal and distance is not None and _number(distance) is None:
                    return ir.BlendZone(self.name("own_zone"), distance=distance)
                if distance is None or _number(distance) is None:
                    return ir.BlendZone(self.name("zone"))
                return ir.BlendZone(_zone(distance))
            case ir.BlendZone():
                return move.blend
        percent = values.get("blend_joint") if move.kind == "joint" else values.get("blend_distance")
        factor = ZONE_MM_PER_PERCENT if move.kind == "joint" else 1.0
        if percent is None or _number(percent) is None:
            name = "joint_zone" if move.kind == "joint" else "zone"
            self.report_once(JOINT_BLEND, move, name, size="the modal size")
            return ir.BlendZone(self.name(name))
        zone = _scaled(percent, factor)
        size = zone.value if isinstance(zone, ir.RealLiteral | ir.IntLiteral) else "a computed size"
        self.report_once(JOINT_BLEND, move, str(size), size=f"{size} mm")
        return ir.BlendZone(_zone(zone))


def _later(statement: ir.Assign) -> Origin:
    """The place of a second statement made of one: its comments stay at the first."""
    return replace(statement.origin, comments=())


def _turns_in_place(move: ir.Move) -> bool:
    """Is the goal another posture at a named place: a shift by no distance?"""
    match move.target:
        case ir.Builtin(function="offset" | "tool_offset", arguments=(_, x, y, z, *_)):
            return all(isinstance(one, ir.RealLiteral | ir.IntLiteral) and one.value == 0 for one in (x, y, z))
    return False


def _global_poses(program: ir.Program) -> frozenset[str]:
    """Poses that modules declare, by folded name."""
    return frozenset(
        one.name.lower()
        for module in program.modules
        for one in module.declarations
        if isinstance(one, ir.Variable) and isinstance(one.type, ir.PoseType)
    )


def _settings_made(program: ir.Program) -> set[str]:
    """System variables that something in the program sets."""
    return {
        node.target.name
        for module in program.modules
        for node in walk(module)
        if isinstance(node, ir.Assign) and isinstance(node.target, ir.System)
    }


def _set_in_parts(program: ir.Program) -> Iterator[str]:
    """Data of which a statement sets a component, once for each."""
    for node in walk_for({"Assign"}, *program.modules):
        match node:
            case ir.Assign(target=ir.Field(base=ir.Name(id=name))):
                yield name


def _number(value: ir.Expression) -> ir.Expression | None:
    """The expression when it is a plain number in base units, else None."""
    match value:
        case ir.RealLiteral() | ir.IntLiteral():
            return value
        case ir.Quantity(value=inner, unit=unit):
            return _scaled(inner, ir.UNITS[unit]) if _number(inner) is not None else None
    return None


def _scaled(value: ir.Expression, factor: float) -> ir.Expression:
    """value times factor; literals are computed, in decimal-clean form."""
    match value:
        case ir.Quantity(value=inner, unit=unit):
            return _scaled(inner, factor * ir.UNITS[unit])
        case ir.RealLiteral(value=number) | ir.IntLiteral(value=number):
            return ir.RealLiteral(float(f"{number * factor:.12g}"), origin=value.origin)
    return value if factor == 1.0 else ir.Binary("*", value, _real(factor), origin=value.origin)


# system variable -> (kind of generated data, component)
_MODAL: dict[str, tuple[str, str]] = {
    "tool": ("tool", "frame"),
    "base": ("frame", "user_frame"),
    "path_speed": ("speed", "path"),
    "swivel_speed": ("speed", "rotation"),
    "twist_speed": ("speed", "rotation"),
    "joint_speed": ("joint_speed", "path"),
    "blend_distance": ("zone", "path"),
    "blend_joint": ("joint_zone", "path"),
}
_FACTOR = {"joint_speed": MM_S_PER_PERCENT, "blend_joint": ZONE_MM_PER_PERCENT}


def _speed(path: ir.Expression, rotation: ir.Expression) -> ir.Expression:
    linear, rotary = _STANDARD_EXTERNAL
    return ir.Aggregate(
        (("path", path), ("rotation", rotation), ("linear_external", linear), ("rotary_external", rotary)),
        type_name="speed",
    )


def _zone(size: ir.Expression) -> ir.Expression:
    entries = [("stop", ir.BoolLiteral(False)), *((n, _scaled(size, factor)) for n, factor in ZONE_PROPORTIONS)]
    return ir.Aggregate(tuple(entries), type_name="zone")
