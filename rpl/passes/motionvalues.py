"""Values with which no controller moves, or moves otherwise than is written, where they are constant: told when read.

Speeds of zero and below, orientations that are no rotation, circles through points in a line, corners larger than the
moves that they join, loads without a mass, a tool that nothing sets. What a controller does then is data of its
language (`InputRules`); a value that is worked out in the run is a fault of the run.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.ir.rules import QUANTITIES, SLOWEST, Range, refusal
from rpl.ir.walk import bodies, children, statements, walk
from rpl.passes import rigid
from rpl.passes.fold import constant, constant_number
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.values import Record, Value, pose_of
from rpl.source import Origin

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

SPEED = code(
    "speed-not-positive",
    Severity.WARNING,
    "the {what} is {value:g}: it must be more than {least}, the controller stops at this move",
)
ROTATION = code(
    "orientation-unusable",
    Severity.WARNING,
    "the squares of this orientation add up to {sum:.6g}, not to 1: the controller cannot use it",
    "write a unit quaternion (NOrient makes one of a quaternion that is off by less)",
)
ROTATIONS = code(
    "orientation-not-normalised",
    Severity.INFO,
    "{count} orientations of this module are not quite unit quaternions, here {sum:.6g}; they are normalised",
)
CIRCLE = code(
    "circle-of-points-in-line",
    Severity.WARNING,
    "start, auxiliary and end point lie on a line or coincide: they fix no circle, the controller stops at this move",
)
CORNER = code(
    "corner-larger-than-move",
    Severity.WARNING,
    "a corner of {size:g} mm where the shorter move beside it is {way:g} mm: the controller {does}",
)
MASS = code(
    "load-without-mass",
    Severity.WARNING,
    "{name} has a mass of {mass:g} kg: {does}",
)
NO_TOOL = code(
    "tool-not-set",
    Severity.INFO,
    "nothing that was read sets the tool before this move; {does}",
)
VALUE = code("motion-value-out-of-range", Severity.WARNING, "{why}; the controller stops here")
LEAST = code("motion-value-least", Severity.INFO, "the {what} is {value:g} {unit}: {does}")
HELD = code("motion-value-held", Severity.INFO, "the {what} is {value:g} {unit}; the controller takes {taken:g} {unit}")
UNIT = code("unit-does-not-fit", Severity.ERROR, "{unit} is no unit of the {what}", "write one of {wanted}")

FLAT = 1e-6  # sine of the angle between two sides below which three points lie on a line (as in rpl.emulator.paths)
_SPEEDS = {"path_speed": "path speed", "joint_speed": "axis speed"}
_LEAST_WAY = 1e-3
# Percentages of which the controller takes the nearest that it can.
_HELD = ("acceleration_percent", "deceleration_percent", "acceleration_ramp", "stop_ramp")
# Parts of a move's speed: the quantity of `InputRules`, and the units that fit ("%" is `percent`).
_PARTS: tuple[tuple[str, str, tuple[str, ...]], ...] = (
    ("path", "path speed", ("mm/s", "m/s", "cm/min", "inch/min")),
    ("joint", "joint_speed", ("percent",)),
    ("duration", "move_duration", ("s", "ms", "min")),
    ("path_acceleration", "path_acceleration", ("mm/s2", "m/s2")),
    ("axis_acceleration", "axis_acceleration", ("deg/s2", "rad/s2")),
)
_NO_ROTATION = 1e-6  # all parts of a quaternion together
_WITHOUT_PARTS = frozenset((ir.Name, ir.IntLiteral, ir.RealLiteral, ir.BoolLiteral, ir.TextLiteral, ir.System))
_LENGTHS, _ANGLES, _PERCENT = ("mm", "cm", "m", "inch"), ("deg", "rad"), ("percent",)


def motion_values(program: ir.Program, diagnostics: Diagnostics) -> None:
    """Reports what stands in constants, each with its place."""
    scopes = ProgramScope(program)
    for module in program.modules:
        scope = scopes.module(module)
        checked = _Module(module, scope, diagnostics)
        for declaration in module.declarations:
            checked.declaration(declaration, scope)
        for routine in module.routines:
            inner = scopes.routine(module, routine)
            checked.names = {}
            for declaration in routine.declarations:
                checked.declaration(declaration, inner)
            for body in bodies(routine):
                checked.body(body, inner)
        checked.ended()
    _tool_set(program, scopes, diagnostics)


class _Where:
    """A place that is worked out when somebody asks: most moves are beside no corner and no circle."""

    __slots__ = ("expression", "found", "scope")

    def __init__(self, expression: ir.Expression | None, scope: Scope, found: rigid.Vector | None = None) -> None:
        self.expression, self.scope, self.found = expression, scope, found

    def place(self) -> rigid.Vector | None:
        if self.expression is not None:
            self.found, self.expression = _place(self.expression, self.scope), None
        return self.found


@dataclass(slots=True)
class _Last:
    """The move before, as far as it is constant."""

    where: _Where | None = None
    before: _Where | None = None
    frames: tuple[object, object] = (None, None)
    corner: float = 0.0
    origin: Origin | None = None
    kind: str = ""


class _Module:
    def __init__(self, module: ir.Module, scope: Scope, diagnostics: Diagnostics) -> None:
        self.module, self.diagnostics, self.rules = module, diagnostics, scope.rules.inputs
        self.off: list[tuple[float, Origin]] = []
        self.names: dict[str, Value | None] = {}  # what names are worth in the routine that is looked at

    def constant(self, expression: ir.Expression, scope: Scope) -> Value | None:
        """The value of an expression; of a name (speeds, zones: the same ones in move after move) it is kept."""
        if not isinstance(expression, ir.Name):
            return constant(expression, scope)
        if expression.id not in self.names:
            self.names[expression.id] = constant(expression, scope)
        return self.names[expression.id]

    # ---- data

    def declaration(self, declaration: ir.Declaration, scope: Scope) -> None:
        if not isinstance(declaration, ir.Variable) or declaration.initial is None:
            return
        self.rotations(declaration.initial, declaration.origin, scope)
        if self.rules.least_mass is not None and isinstance(declaration.type, ir.ToolType | ir.LoadType):
            self.mass(declaration, declaration.initial, scope)

    def rotations(self, root: ir.Expression, origin: Origin, scope: Scope) -> None:
        """Quaternions that are no rotation. Without a documented limit there is nothing to say."""
        if self.rules.rotation_limits is None:
            return
        good, usable = self.rules.rotation_limits
        for node in _rotations(root):
            parts = [number_of(entry, scope) for _, entry in node.entries]
            squares = sum(part * part for part in parts if part is not None)
            if None in parts or abs(squares - 1.0) <= good:
                continue
            if abs(squares - 1.0) > usable:
                self.diagnostics.report(ROTATION, origin, sum=squares)
            else:
                self.off.append((squares, origin))

    def mass(self, declaration: ir.Variable, initial: ir.Expression, scope: Scope) -> None:
        if not isinstance(initial, ir.Aggregate):
            return
        load: ir.Expression = initial
        if isinstance(declaration.type, ir.ToolType):
            load = next((value for name, value in initial.entries[2:3]), initial)
        entries = load.entries if isinstance(load, ir.Aggregate) else ()
        mass = constant_number(entries[0][1], scope) if entries else None
        if mass is not None and self.rules.least_mass is not None and mass < self.rules.least_mass:
            self.diagnostics.report(
                MASS, declaration.origin, name=declaration.name, mass=mass, does=self.rules.without_mass
            )

    def ended(self) -> None:
        if self.off:
            worst, origin = max(self.off, key=lambda item: abs(item[0] - 1.0))
            self.diagnostics.report(ROTATIONS, origin, count=len(self.off), sum=worst)

    # ---- statements

    def body(self, body: ir.Body, scope: Scope) -> None:
        last = _Last()
        for statement in body:
            match statement:
                case ir.Move():
                    last = self.move(statement, scope, last)
                case ir.Run():
                    last = self.run(statement, scope, last)
                case ir.Assign(target=ir.System(name=name), value=value) if name in _SPEEDS:
                    self.speed(_SPEEDS[name], value, statement.origin, scope)
                    self.quantity(name, value, statement.origin, scope)
                case ir.SetForNextMove(setting=ir.System(name="path_speed"), value=value):
                    self.speed("path speed", value, statement.origin, scope)
                case ir.SetForNextMove(setting=ir.System(name=name), value=value):
                    self.quantity(name, value, statement.origin, scope)
                case ir.Assign(target=target, value=value):
                    self.rotations(value, statement.origin, scope)
                    if isinstance(target, ir.System):
                        self.quantity(target.name, value, statement.origin, scope)
                    elif isinstance(target, ir.Name) and (held := self.rules.range_of_variable(target.id)) is not None:
                        self.within(target.id, held, value, statement.origin, scope)
                case ir.Nothing() | ir.Trigger() | ir.LookAhead():
                    continue
                case _:
                    last = _Last()
                    for inner in _bodies(statement):
                        self.body(inner, scope)

    def speed(self, what: str, value: ir.Expression | None, origin: Origin, scope: Scope) -> None:
        number = None if value is None else constant_number(value, scope)
        if number is not None:
            self.speed_of(what, number, origin)

    def speed_of(self, what: str, number: float, origin: Origin) -> None:
        if number < SLOWEST:
            self.diagnostics.report(SPEED, origin, what=what, value=number, least="zero" if number <= 0.0 else SLOWEST)

    def quantity(
        self, name: str, value: ir.Expression | None, origin: Origin, scope: Scope, units: tuple[str, ...] = ()
    ) -> None:
        """A value of a system variable, or of what stands for it in a move; `units`: the ones that fit."""
        if value is None:
            return
        what, unit = QUANTITIES.get(name, (name, ""))
        if isinstance(value, ir.Quantity) and units and value.unit not in units:
            self.diagnostics.report(UNIT, origin, unit=value.unit, what=what, wanted=", ".join(units))
            return
        allowed = self.rules.range_of(name)
        if allowed is not None:
            self.within(name, allowed, value, origin, scope)
        number = constant_number(value, scope) if name in _HELD else None
        if number is not None:
            least, most = scope.rules.percents_of(name)
            taken = min(max(number, least), most)
            if taken != number:
                self.diagnostics.report(HELD, origin, what=what, value=number, unit=unit, taken=taken)

    def within(self, name: str, allowed: Range, value: ir.Expression, origin: Origin, scope: Scope) -> None:
        number = constant_number(value, scope)
        if number is None:
            return
        why = refusal(name, number, allowed)
        if why:
            self.diagnostics.report(VALUE, origin, why=why)
        elif allowed.at_least and number == allowed.least:
            what, unit = QUANTITIES.get(name, (name, ""))
            self.diagnostics.report(LEAST, origin, what=what, value=number, unit=unit, does=allowed.at_least)

    def parts(self, move: ir.Move, scope: Scope) -> None:
        """What one move says for itself: parts of the speed, settings, the corner."""
        if move.speed is not None and move.motion_class != "velocity":
            for part, name, units in _PARTS:
                self.quantity(name, getattr(move.speed, part), move.origin, scope, units)
        self.quantity("acceleration_percent", move.acceleration, move.origin, scope, _PERCENT)
        for setting, value in move.settings:
            if isinstance(setting, ir.System):
                self.quantity(setting.name, value, move.origin, scope)
        match move.blend:
            case ir.BlendDistance(distance=distance, rotation=rotation):
                self.quantity("blend_distance", distance, move.origin, scope, _LENGTHS)
                self.quantity("blend_rotation", rotation, move.origin, scope, _ANGLES)
            case ir.BlendPercent(percent=percent):
                self.quantity("blend_joint", percent, move.origin, scope, _PERCENT)
            case ir.BlendSpeed(percent=percent):
                self.quantity("blend_speed", percent, move.origin, scope, _PERCENT)
            case ir.BlendZone(zone=zone, distance=distance):
                self.quantity("blend_distance", distance, move.origin, scope, _LENGTHS)
                self.zone(zone, move.origin, scope)

    def zone(self, zone: ir.Expression, origin: Origin, scope: Scope) -> None:
        """A corner given by several sizes, of which none may be below nothing."""
        value, allowed = self.constant(zone, scope), self.rules.range_of("blend_distance")
        if not isinstance(value, Record) or value.part("stop") or allowed is None:
            return
        sizes = [value.part(name) for name in ("path", "rotation_path", "external_path")]
        for size in [one for one in sizes if isinstance(one, int | float)]:
            if why := refusal("blend_distance", float(size), allowed):
                self.diagnostics.report(VALUE, origin, why=why)
                return

    def move(self, move: ir.Move, scope: Scope, last: _Last) -> _Last:
        self.parts(move, scope)
        speed = move.speed
        if speed is not None and move.motion_class != "velocity":
            self.speed("path speed", speed.path, move.origin, scope)
            self.speed("axis speed", speed.joint if speed.joint is not None else speed.axis, move.origin, scope)
            profile = self.constant(speed.profile, scope) if speed.profile is not None and speed.path is None else None
            path = profile.part("path") if isinstance(profile, Record) else None
            if isinstance(path, int | float) and speed.duration is None:
                self.speed_of("path speed", float(path), move.origin)
        for expression in (move.target, move.via, move.tool, move.frame):
            if expression is not None:
                self.rotations(expression, move.origin, scope)
        where = _Where(move.target, scope) if move.relative is None and not move.settings else None
        frames = (move.tool, move.frame)
        known = last if last.frames == frames else _Last()
        if move.kind == "circular" and move.swept is None and move.via is not None:
            self.circle(known.where, _Where(move.via, scope), where, move.origin)
        if move.kind != "joint" and known.origin is not None:
            self.corner(known, where)
        corner = self.size(move.blend, scope) if move.kind == "linear" else 0.0
        before = known.where if move.kind == "linear" else None
        return _Last(where, before, frames, corner, move.origin, move.kind)

    def run(self, run: ir.Run, scope: Scope, last: _Last) -> _Last:
        """A run: what its moves say alike by its first one, orientations and corners by columns."""
        reported = len(self.diagnostics)
        last = self.move(run.sample, scope, last)
        columns = _RunColumns(run, scope)
        rotations = columns.rotations() if self.rules.rotation_limits is not None else []
        good, usable = self.rules.rotation_limits or (0.0, 0.0)
        if (
            len(self.diagnostics) > reported
            or not columns.only_targets()
            or rotations is None
            or any((abs(squares - 1.0) > usable).any() for squares in rotations)
        ):
            for move in run.moves(1):
                last = self.move(move, scope, last)
            return last
        for squares in rotations:
            off = (abs(squares[1:] - 1.0) > good).nonzero()[0] + 1
            self.off += [(float(squares[at]), run.columns.origin(at)) for at in off.tolist()]
        return self.corners(run, columns.places() if last.where is not None else None, scope, last)

    def corners(self, run: ir.Run, places: NDArray[np.float64] | None, scope: Scope, last: _Last) -> _Last:
        """Corners within a run that are larger than the moves beside them. `last`: its first move."""
        end = run.columns.origin(len(run) - 1)
        if places is None:
            nowhere = _Where(None, scope) if last.where is not None else None
            return _Last(nowhere, nowhere, last.frames, last.corner, end, last.kind)
        known = _Points(places, scope)
        if last.corner > 0.0 and self.rules.large_corner:
            import numpy as np

            ways = np.linalg.norm(np.diff(places, axis=0), axis=1)
            narrow = (ways > _LEAST_WAY) & (ways < 2.0 * last.corner + 1e-9)
            suspects = np.flatnonzero(narrow | np.insert(narrow[:-1], 0, True))
            for at in suspects.tolist():  # the corner at the end of move `at`, known with the one behind it
                back = known.where(at - 1) if at else last.before
                here = _Last(known.where(at), back, last.frames, last.corner, run.columns.origin(at), last.kind)
                self.corner(here, known.where(at + 1))
        before = known.where(len(run) - 2) if last.kind == "linear" else None
        return _Last(known.where(len(run) - 1), before, last.frames, last.corner, end, last.kind)

    def circle(self, start: _Where | None, middle: _Where, target: _Where | None, origin: Origin) -> None:
        first, via, end = (None if one is None else one.place() for one in (start, middle, target))
        if via is None or end is None or first is None:
            return
        one, other = via.plus(first, -1.0), end.plus(first, -1.0)
        turn = (
            one.y * other.z - one.z * other.y,
            one.z * other.x - one.x * other.z,
            one.x * other.y - one.y * other.x,
        )
        area = sum(part * part for part in turn) ** 0.5
        if area <= FLAT * one.length * other.length or area < 1e-9:
            self.diagnostics.report(CIRCLE, origin)

    def corner(self, last: _Last, ahead: _Where | None) -> None:
        """The corner at the end of the move before, now that the next one is known."""
        if last.corner <= 0.0 or not self.rules.large_corner or last.where is None:
            return
        here = last.where.place()
        others = [one.place() for one in (last.before, ahead) if one is not None]
        ways = [other.plus(here, -1.0).length for other in others if other is not None and here is not None]
        ways = [way for way in ways if way > _LEAST_WAY]
        if not ways or last.corner <= 0.5 * min(ways) or last.origin is None:
            return
        does = self.rules.large_corner.format(half=0.5 * min(ways))
        self.diagnostics.report(CORNER, last.origin, size=last.corner, way=round(min(ways), 3), does=does)

    def size(self, blend: ir.Blend | None, scope: Scope) -> float:
        """Millimetres before the point at which the corner begins; 0 where that is not known."""
        match blend:
            case ir.BlendDistance(distance=distance) if distance is not None:
                return constant_number(distance, scope) or 0.0
            case ir.BlendZone(distance=distance) if distance is not None:
                return constant_number(distance, scope) or 0.0
            case ir.BlendZone(zone=zone):
                value = self.constant(zone, scope)
                path = value.part("path") if isinstance(value, Record) and not value.part("stop") else None
                return float(path) if isinstance(path, int | float) else 0.0
        return 0.0


class _Points:
    """Rows of positions, as places."""

    def __init__(self, places: NDArray[np.float64], scope: Scope) -> None:
        self.places, self.scope = places, scope

    def where(self, at: int) -> _Where:
        return _Where(None, self.scope, rigid.Vector(*self.places[at].tolist()))


class _RunColumns:
    """Which columns of a run are what in its moves."""

    def __init__(self, run: ir.Run, scope: Scope) -> None:
        self.run, self.scope = run, scope
        self.cells = {id(cell): at for at, cell in enumerate(run.columns.cells)}

    def only_targets(self) -> bool:
        """Do the numbers stand in the target alone, of a move to a place?"""
        return self.run.sample.via is None and self.cells.keys() <= {id(node) for node in walk(self.run.sample.target)}

    def rotations(self) -> list[NDArray[np.float64]] | None:
        """The sum of squares of each quaternion, in all moves; None where a part is not a plain number."""
        found = []
        for node in walk(self.run.sample.target):
            if isinstance(node, ir.Aggregate) and node.type_name == "rotation" and len(node.entries) == 4:
                parts = [self.values(value) for _, value in node.entries]
                if any(part is None for part in parts):
                    return None
                w, x, y, z = (part for part in parts if part is not None)
                found.append(w * w + x * x + y * y + z * z)
        return found

    def values(self, value: ir.Expression) -> NDArray[np.float64] | None:
        import numpy as np

        column = self.cells.get(id(value))
        if column is not None:
            return self.run.columns.values[:, column]
        number = constant_number(value, self.scope)
        return None if number is None else np.full(len(self.run), number)

    def places(self) -> NDArray[np.float64] | None:
        """The positions of the targets (n, 3), found by asking for that of numbers which occur nowhere else."""
        import numpy as np

        columns = self.run.columns
        marks = [10_001.125 + at for at in range(len(columns.cells))]
        marked = self.run.with_cells(tuple(ir.RealLiteral(mark) for mark in marks))
        position = _place(marked.target, self.scope)
        if position is None:
            return None
        parts = (position.x, position.y, position.z)
        found = [
            columns.values[:, marks.index(part)] if part in marks else np.full(len(columns), part) for part in parts
        ]
        return np.stack(found, axis=1)


def _place(expression: ir.Expression, scope: Scope) -> rigid.Vector | None:
    written = _written_out(expression, scope)
    found = None if written is None else _written_position(written)
    if found is not None:
        return found
    pose = pose_of(constant(expression, scope))
    if pose is not None:
        return pose.position
    if not isinstance(expression, ir.Aggregate):
        return None
    # A point on the way is often written without an orientation, which the target then keeps.
    numbers = {str(name).lower(): constant_number(value, scope) for name, value in expression.entries}
    x, y, z = (numbers.get(name) for name in "xyz")
    return None if x is None or y is None or z is None else rigid.Vector(x, y, z)


def _written_out(expression: ir.Expression, scope: Scope) -> ir.Aggregate | None:
    """The list that is written here, or of the constant of that name."""
    if isinstance(expression, ir.Name):
        symbol = scope.value(expression.id)
        if symbol is None or (symbol.module is None and symbol.routine is None):
            return None
        declared = symbol.declaration
        if not isinstance(declared, ir.Variable) or declared.storage != "constant" or declared.initial is None:
            return None
        expression = declared.initial
    return expression if isinstance(expression, ir.Aggregate) else None


def _written_position(target: ir.Aggregate) -> rigid.Vector | None:
    """The position of a target that is written out in numbers, as most are: for it nobody has to know what the whole is
    worth. None where it takes more to tell."""
    if not (target.type_name or "").startswith("target"):
        return None
    groups = [value for _, value in target.entries if isinstance(value, ir.Aggregate)]
    if not groups:
        found = dict(target.entries)
        x, y, z = (written_number(found.get(name)) for name in "xyz")
        return None if x is None or y is None or z is None else rigid.Vector(x, y, z)
    parts = [(name, written_number(value)) for group in groups for name, value in group.entries]
    numbers = [number for name, number in parts if number is not None and name is None]
    if (
        [(one.type_name, len(one.entries)) for one in groups[:2]] != [("vector", 3), ("rotation", 4)]
        or not len(groups) == len(target.entries) == len(ir.POSITIONAL[ir.TargetType])
        or len(numbers) != len(parts)
        or not sum(map(abs, numbers[3:7])) > _NO_ROTATION
        or any(name is not None for name, _ in target.entries)
    ):
        return None
    return rigid.Vector(*numbers[:3])


def _rotations(root: ir.Expression) -> Iterator[ir.Aggregate]:
    """The quaternions that are written out in an expression, outer ones first."""
    work: list[object] = [root]
    while work:
        node = work.pop()
        if node.__class__ in _WITHOUT_PARTS:
            continue
        if not isinstance(node, ir.Aggregate):
            work += reversed(children(node))
            continue
        if node.type_name == "rotation" and len(node.entries) == 4:
            yield node
        work += [value for _, value in reversed(node.entries) if value.__class__ not in _WITHOUT_PARTS]


def written_number(value: ir.Expression | None) -> float | None:
    """The number that an expression is, with its sign. None for anything else."""
    match value:
        case ir.RealLiteral() | ir.IntLiteral():
            return float(value.value)
        case ir.Unary("-", ir.RealLiteral() | ir.IntLiteral() as operand):
            return -float(operand.value)
    return None


def number_of(value: ir.Expression, scope: Scope) -> float | None:
    """As `constant_number`, which takes its time for what mostly is a number."""
    written = written_number(value)
    return constant_number(value, scope) if written is None else written


def _bodies(statement: ir.Statement) -> Iterator[ir.Body]:
    match statement:
        case ir.If(branches=branches, otherwise=otherwise):
            yield from (body for _, body in branches)
            yield otherwise
        case ir.Switch(cases=cases, default=default):
            yield from (case.body for case in cases)
            yield default or ()
        case ir.For(body=body) | ir.While(body=body) | ir.Repeat(body=body) | ir.Loop(body=body):
            yield body


def _tool_set(program: ir.Program, scopes: ProgramScope, diagnostics: Diagnostics) -> None:
    """The first move to a pose, where the controller has no tool after power-on and nothing read sets one."""
    modules = [module for module in program.modules if scopes.module(module).rules.inputs.without_tool]
    routines = [routine for module in modules for routine in module.routines]
    first: ir.Move | None = None
    for routine in routines:
        for node in statements(*bodies(routine)):
            match node:
                case ir.Assign(target=ir.System(name="tool")) | ir.CallRoutine() | ir.Vendor():
                    return  # set here, or perhaps in what is called
                case ir.Move(kind="linear" | "circular") if first is None:
                    first = node
    if first is not None:
        does = scopes.module(modules[0]).rules.inputs.without_tool
        diagnostics.report(NO_TOOL, first.origin, does=does)
