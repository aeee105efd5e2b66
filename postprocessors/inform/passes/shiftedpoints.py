"""Places that are counted from a taught point, as a point and a shift: what programmers write as SFTON .. SFTOF.

A variable that always holds a taught point moved along the axes of its frame becomes the way that it is moved by; the
moves then go to the point, shifted; so do moves to a constant way from a point. What is shifted by both is a point of
its own, a constant way from the taught one, that is told.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes import rigid
from rpl.passes.fold import Unchanged, constant, constant_number
from rpl.passes.legalise.context import Context, ProgramScope
from rpl.passes.legalise.facts.usage import usage_of
from rpl.passes.legalise.facts.values.taughtvalues import tell_written
from rpl.passes.legalise.rewriting.editing import edit_bodies, map_body
from rpl.passes.legalise.rewriting.headdata import ShiftFrames
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import Scope
from rpl.passes.typing import type_of
from rpl.passes.values import Target, Value

_AXES = ("x", "y", "z")
_ZERO = ir.RealLiteral(0.0)
_NO_WAY = ir.Aggregate(tuple((name, _ZERO) for name in ir.POSE), type_name="pose")
# Functions whose first argument is a place that constant others move in its own axes: a shift in front goes with it.
_IN_TOOL = ("tool_offset", "displaced_in_tool")


@legalising(sees=("Move",))
def shifted_points(program: ir.Program, context: Context) -> ir.Program:
    """Places that are counted from taught points are points with a shift."""
    scopes, unchanged = ProgramScope(program), unchanged_in(program)
    straight = _turn_nothing(program, scopes, unchanged)
    mentions = _mentions(program)
    ways = ShiftFrames(context)
    modules = []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            about = _About(scopes.routine(module, routine), unchanged, straight, context)
            own = {name for name, homes in mentions.items() if homes == {(module.name, routine.name)}}
            routines.append(_shifted(routine, about, ways, own))
        modules.append(replace(module, routines=tuple(routines)))
    if ways.names:
        modules[0] = replace(modules[0], declarations=(*modules[0].declarations, *ways.declared()))
    return replace(program, modules=tuple(modules))


class _NoShiftError(Exception):
    """This variable is not always a taught point moved by a way."""


@dataclass(frozen=True, slots=True)
class _Place:
    """A constant place, as what it is calculated of, and the variable whose way it is moved by."""

    point: ir.Expression
    shift: ir.Expression | None = None


@dataclass(slots=True)
class _About:
    """What is known where a routine stands. `straight`: variables (folded) that never turn a place."""

    scope: Scope
    unchanged: Unchanged
    straight: frozenset[str]
    context: Context

    def number(self, value: ir.Expression) -> float | None:
        return constant_number(value, self.scope, self.unchanged)

    def value(self, place: ir.Expression) -> Value | None:
        return constant(place, self.scope, self.unchanged)

    def is_place(self, expression: ir.Expression) -> bool:
        """A taught point: data with a constant pose that nothing assigns."""
        return (
            isinstance(expression, ir.Name | ir.Index | ir.Field)
            and isinstance(self.type(expression), ir.PoseType | ir.TargetType)
            and isinstance(self.value(expression), rigid.Pose | Target)
        )

    def is_shift(self, expression: ir.Expression) -> bool:
        """A variable that holds a way and never turns."""
        return isinstance(expression, ir.Name) and expression.id.lower() in self.straight

    def type(self, expression: ir.Expression) -> ir.Type | None:
        return type_of(expression, self.scope)

    def base(self, target: ir.Expression) -> str:
        """The folded name of the variable that a target is, or is a component of."""
        return self.scope.fold(_base(target))

    def names(self, node: object) -> set[str]:
        return {self.scope.fold(one.id) for one in walk(node) if isinstance(one, ir.Name)}

    def way(self, value: ir.Expression) -> list[float] | None:
        """A constant pose that does not turn, as x, y, z."""
        found = self.value(value)
        pose = found.pose if isinstance(found, Target) else found
        if not isinstance(pose, rigid.Pose) or any(abs(one) > 1e-9 for one in pose.rotation.zyx):
            return None
        return [pose.position.x, pose.position.y, pose.position.z]


def moved(point: ir.Expression, way: Iterable[float]) -> ir.Expression:
    """The point moved by this much more along the axes of its frame."""
    given = list(way)
    if not any(given):
        return point
    if isinstance(point, ir.Builtin) and point.function == "offset":
        before = [one.value for one in point.arguments[1:] if isinstance(one, ir.RealLiteral)]
        return moved(point.arguments[0], [one + other for one, other in zip(before, given, strict=True)])
    return ir.Builtin("offset", (point, *(ir.RealLiteral(float(one)) for one in given)))


# ---- one routine


def _shifted(routine: ir.Routine, about: _About, ways: ShiftFrames, own: set[str]) -> ir.Routine:
    found = {
        about.scope.fold(name)
        for statement in routine.body
        if isinstance(statement, ir.Assign)
        and (name := _base(statement.target)).lower() in own
        and isinstance(about.type(ir.Name(name)), ir.PoseType | ir.TargetType)
    }
    while True:
        worker = _Routine(about, ways, found)
        try:
            return worker.routine(routine)
        except _NoShiftError as error:
            found.remove(str(error))


@dataclass(slots=True)
class _Routine:
    """The routine with its variables `followed`. Raises _NoShiftError with the name of one that has another use."""

    about: _About
    ways: ShiftFrames
    followed: set[str]
    held: dict[str, _Place] = field(default_factory=dict)
    shifts: dict[str, ir.Name] = field(default_factory=dict)
    turns: dict[str, int] = field(default_factory=dict)  # of the shifts: how often they have been set
    seen: dict[str, int] = field(default_factory=dict)  # of variables that share a shift: its count
    made: list[ir.Variable] = field(default_factory=list)
    told: list[tuple[ir.Statement, ir.Expression]] = field(default_factory=list)  # moves to points that are worked out

    def routine(self, routine: ir.Routine) -> ir.Routine:
        jumps = any(isinstance(node, ir.Label) for node in walk(*bodies(routine)))
        last = max((at for at, one in enumerate(routine.body) if self.assigns(one)), default=-1)
        if jumps and any(isinstance(node, ir.Label) for node in walk(*routine.body[: last + 1])):
            for name in self.followed:
                raise _NoShiftError(name)
        body: list[ir.Statement] = []
        for statement in routine.body:
            body.extend(self.assigned(statement) if self.assigns(statement) else self.statement(statement))
        self.held = {}  # what they hold in handlers is not known
        done = edit_bodies(replace(routine, body=()), lambda other: map_body(other, self.statement))
        for statement, place in self.told:
            tell_written(self.about.context, self.about.scope, statement.origin, "this point", place)
        fold = self.about.scope.fold
        kept = tuple(one for one in routine.declarations if fold(getattr(one, "name", "")) not in self.followed)
        return replace(done, body=tuple(body), declarations=(*kept, *self.made))

    def assigns(self, statement: ir.Statement) -> bool:
        return isinstance(statement, ir.Assign) and self.about.base(statement.target) in self.followed

    # ---- what the variables hold

    def assigned(self, statement: ir.Statement) -> Iterator[ir.Statement]:
        assert isinstance(statement, ir.Assign)
        name = self.about.base(statement.target)
        given: list[ir.Statement] = []
        match statement.target:
            case ir.Name():
                self.whole(name, statement.value, given)
            case ir.Field(base=ir.Name(), name=part) if part.lower() in _AXES and name in self.held:
                self.part(name, part.lower(), statement.value, given)
            case _:
                raise _NoShiftError(name)
        first = True
        for one in given:
            yield replace(one, origin=statement.origin if first else replace(statement.origin, comments=()))
            first = False
        if first:
            yield ir.Nothing(origin=statement.origin)

    def whole(self, name: str, value: ir.Expression, given: list[ir.Statement]) -> None:
        """name := a point, another variable, or either moved by a way."""
        way: list[ir.Expression] = []
        match value:
            case ir.Builtin(function="offset", arguments=(base, *way)) if len(way) == 3:
                place = self.place(base)
            case _:
                place = self.place(value)
        if place is None or name in self.about.names(value):
            raise _NoShiftError(name)
        numbers = [self.about.number(one) for one in way]
        point = moved(place.point, (one or 0.0 for one in numbers)) if way else place.point
        parts = {axis: one for axis, one, known in zip(_AXES[: len(way)], way, numbers, strict=True) if known is None}
        if not parts:
            self.held[name] = _Place(point, place.shift)
            self.share(name)
            return
        if place.shift is not None:
            raise _NoShiftError(name)
        shift = self.shift(name)
        given.append(ir.Assign(shift, _NO_WAY))
        given.extend(ir.Assign(ir.Field(shift, axis), one) for axis, one in parts.items())
        self.held[name] = _Place(point, shift)
        self.share(name)

    def part(self, name: str, axis: str, value: ir.Expression, given: list[ir.Statement]) -> None:
        """name.z := another one's z + way."""
        place, base = self.held[name], ""
        rest: list[ir.Expression] = []
        way = 0.0
        origin: _Place | None = None
        for sign, term in _terms(value):
            number = self.about.number(term) if not isinstance(term, ir.Field) else None
            if isinstance(term, ir.Field) and term.name.lower() == axis and sign > 0 and origin is None:
                origin, base = self.place(term.base), self.about.base(term.base)
                if origin is None:
                    raise _NoShiftError(name)
            elif number is not None:
                way += sign * number
            elif self.about.names(term) & self.followed:
                raise _NoShiftError(name)
            else:
                rest.append(term if sign > 0 else ir.Unary("-", term))
        if origin is None or _root(origin.point) != _root(place.point):
            raise _NoShiftError(name)
        at = _AXES.index(axis)
        more = [0.0, 0.0, 0.0]
        more[at] = _way_of(origin.point)[at] + way - _way_of(place.point)[at]
        point = moved(place.point, more)
        if not rest:
            if origin.shift is None and place.shift is not None:
                given.append(ir.Assign(ir.Field(place.shift, axis), _ZERO))
                self.set(name)
            elif origin.shift != place.shift:
                raise _NoShiftError(name)
            self.held[name] = _Place(point, place.shift)
            return
        total = rest[0]
        for one in rest[1:]:
            total = ir.Binary("+", total, one)
        own = self.shift(name)
        if place.shift is None:
            given.append(ir.Assign(own, _NO_WAY))
        elif place.shift != own:
            raise _NoShiftError(name)
        if origin.shift is not None:
            total = ir.Binary("+", ir.Field(origin.shift, axis), total)
        given.append(ir.Assign(ir.Field(own, axis), total))
        self.held[name] = _Place(point, own)
        self.set(name)
        if base in self.followed:
            self.fresh(base)

    def shift(self, name: str) -> ir.Name:
        if name not in self.shifts:
            symbol = self.about.scope.value(name)
            stem = (
                name if symbol is None or not isinstance(symbol.declaration, ir.Variable) else symbol.declaration.name
            )
            made = self.about.context.fresh(f"{stem}_shift")
            self.shifts[name] = ir.Name(made)
            self.made.append(ir.Variable(made, ir.PoseType()))
        return self.shifts[name]

    def set(self, name: str) -> None:
        """The shift of this variable has another value: those that share it do not hold it any more."""
        shift = self.shifts[name].id
        self.turns[shift] = self.turns.get(shift, 0) + 1
        self.seen[name] = self.turns[shift]

    def share(self, name: str) -> None:
        shift = self.held[name].shift
        if shift is not None and shift == self.shifts.get(name):
            self.set(name)
        elif isinstance(shift, ir.Name):
            self.seen[name] = self.turns.get(shift.id, 0)

    def fresh(self, name: str) -> _Place:
        """What a variable holds, as long as nobody has changed the shift that it shares."""
        if name not in self.held:
            raise _NoShiftError(name)
        place = self.held[name]
        if isinstance(place.shift, ir.Name) and self.turns.get(place.shift.id, 0) != self.seen.get(name, 0):
            raise _NoShiftError(name)
        return place

    # ---- places

    def place(self, expression: ir.Expression) -> _Place | None:
        """The point and the shift of a place; None: it is no such one."""
        about = self.about
        match expression:
            case ir.Name(id=name) if self.about.scope.fold(name) in self.followed:
                return self.fresh(self.about.scope.fold(name))
            case ir.Builtin(function="offset", arguments=(base, *way)) if len(way) == 3:
                place, numbers = self.place(base), [about.number(one) for one in way]
                if place is None or None in numbers:
                    return None
                return replace(place, point=moved(place.point, (one or 0.0 for one in numbers)))
            case ir.Builtin(function=name, arguments=(base, *rest)) if name in _IN_TOOL:
                place = self.place(base)
                if place is None or not all(self.known(one) for one in rest):
                    return None
                return replace(place, point=ir.Builtin(name, (place.point, *rest)))
            case ir.Builtin(function="element_sum", arguments=(base, other)):
                place = self.place(base)
                if place is None:
                    return None
                way_of = about.way(other)
                if way_of is not None:
                    return replace(place, point=moved(place.point, way_of))
                return replace(place, shift=other) if place.shift is None and about.is_shift(other) else None
        return _Place(expression) if about.is_place(expression) else None

    def known(self, expression: ir.Expression) -> bool:
        return self.about.number(expression) is not None or self.about.value(expression) is not None

    def said(self, statement: ir.Statement, expression: ir.Expression) -> ir.Expression:
        """How a move says the place."""
        place = self.place(expression)
        if place is None:
            return self.unfollowed(expression)
        point = place.point
        if place.shift is None and not self.about.is_place(point):
            said = self.displaced(point)
            return self.unfollowed(expression) if said is None else replace(said, origin=expression.origin)
        if not self.about.is_place(point):
            value = self.about.value(point)
            made = None if value is None else _written(value)
            if made is None:
                return self.unfollowed(expression)
            self.told.append((statement, point))
            point = replace(made, origin=expression.origin)
        if place.shift is None:
            return point
        return ir.Builtin("displaced", (point, place.shift), origin=expression.origin)

    def displaced(self, point: ir.Expression) -> ir.Builtin | None:
        """A taught point moved by a constant way, along the axes of its frame or of the tool; None: moved by more."""
        match point:
            case ir.Builtin(function="offset", arguments=(root, *way)) if self.about.is_place(root):
                said = "displaced"
            case ir.Builtin(function="tool_offset", arguments=(root, *way)) if self.about.is_place(root):
                said = "displaced_in_tool"
            case _:
                return None
        numbers = [self.about.number(one) for one in way]
        if (len(numbers) > 3 and any(numbers[3:])) or None in numbers:
            return None
        return ir.Builtin(said, (root, self.ways.frame([one or 0.0 for one in numbers[:3]])))

    def unfollowed(self, expression: ir.Expression) -> ir.Expression:
        for name in self.about.names(expression) & self.followed:
            raise _NoShiftError(name)
        return expression

    # ---- statements

    def statement(self, statement: ir.Statement) -> ir.Body:
        if not isinstance(statement, ir.Move):
            done = inside(statement, lambda inner: map_body(inner, self.statement))
            if not any(isinstance(node, ir.Move) for node in walk(statement)):
                self.plain(statement)
            else:
                self.heads(statement)
            return (_nothing_left(done),)
        for other in (statement.search, statement.frame, statement.tool, *statement.triggers):
            if other is not None:
                self.plain(other)
        if statement.relative is not None:
            self.plain(statement)
            return (statement,)
        via = None if statement.via is None else self.said(statement, statement.via)
        return (replace(statement, target=self.said(statement, statement.target), via=via),)

    def plain(self, node: object) -> None:
        for name in self.about.names(node) & self.followed:
            raise _NoShiftError(name)

    def heads(self, statement: ir.Statement) -> None:
        """The conditions of a block name none of the variables."""
        within = {id(node) for one in walk(statement) if isinstance(one, ir.Move) for node in walk(one)}
        for node in walk(statement):
            if isinstance(node, ir.Name) and id(node) not in within and self.about.scope.fold(node.id) in self.followed:
                raise _NoShiftError(self.about.scope.fold(node.id))


def _nothing_left(statement: ir.Statement) -> ir.Statement:
    """A place less itself is no way, wherever the robot is."""
    match statement:
        case ir.Assign(value=ir.Builtin(function="element_difference", arguments=(one, other))) if one == other:
            return replace(statement, value=replace(_NO_WAY, origin=statement.value.origin))
    return statement


def _written(value: Value) -> ir.Aggregate | None:
    """A constant place with its posture."""
    pose = value.pose if isinstance(value, Target) else value
    if not isinstance(pose, rigid.Pose):
        return None
    place = pose.position
    numbers = (place.x, place.y, place.z, *pose.rotation.zyx)
    entries: list[tuple[str | None, ir.Expression]] = [
        (name, ir.RealLiteral(rigid.clean(one) + 0.0)) for name, one in zip(ir.POSE, numbers, strict=True)
    ]
    if not isinstance(value, Target):
        return ir.Aggregate(tuple(entries), type_name="pose")
    entries.extend((name, ir.IntLiteral(one)) for name, one in value.flags)
    entries.extend((name, ir.RealLiteral(one)) for name, one in value.external)
    return ir.Aggregate(tuple(entries), type_name=f"target {value.type.notation}")


def _root(point: ir.Expression) -> ir.Expression:
    moved_once = isinstance(point, ir.Builtin) and point.function == "offset"
    return point.arguments[0] if moved_once and isinstance(point, ir.Builtin) else point


def _way_of(point: ir.Expression) -> list[float]:
    """What the place is moved from its root."""
    if isinstance(point, ir.Builtin) and point.function == "offset":
        return [one.value for one in point.arguments[1:] if isinstance(one, ir.RealLiteral)]
    return [0.0, 0.0, 0.0]


def _terms(value: ir.Expression, sign: int = 1) -> Iterator[tuple[int, ir.Expression]]:
    """What a sum adds and takes away."""
    match value:
        case ir.Binary(op="+" | "-" as op, left=left, right=right):
            yield from _terms(left, sign)
            yield from _terms(right, sign if op == "+" else -sign)
        case ir.Unary(op="-", operand=operand):
            yield from _terms(operand, -sign)
        case ir.Convert(how="real", operand=ir.Field() | ir.Binary() as operand):
            yield from _terms(operand, sign)
        case _:
            yield sign, value


def _base(target: ir.Expression) -> str:
    """The name of the variable that a target is, or is a component of."""
    inner = target.base if isinstance(target, ir.Field) else target
    return inner.id if isinstance(inner, ir.Name) else ""


# ---- the whole program


def _mentions(program: ir.Program) -> Mapping[str, set[tuple[str, str]]]:
    """Folded name -> the routines that name it; what data begins with stands in none."""
    found: dict[str, set[tuple[str, str]]] = {}
    for module in program.modules:
        for node in walk(*module.declarations):
            if isinstance(node, ir.Name):
                found.setdefault(node.id.lower(), set()).add((module.name, ""))
        for routine in module.routines:
            for node in walk(routine):
                if isinstance(node, ir.Name):
                    found.setdefault(node.id.lower(), set()).add((module.name, routine.name))
            for parameter in routine.parameters:
                found.setdefault(parameter.name.lower(), set()).add((module.name, ""))
    return found


def _turn_nothing(program: ir.Program, scopes: ProgramScope, unchanged: Unchanged) -> frozenset[str]:
    """Data of the program that holds places without a turn: it begins with one, only its x, y and z are set, or the
    whole to one. Folded names."""
    begins: dict[str, bool] = {}
    for module in program.modules:
        scope = scopes.module(module)
        for one in module.declarations:
            if isinstance(one, ir.Variable) and isinstance(scope.resolve(one.type), ir.PoseType | ir.TargetType):
                given = one.initial is not None and _is_straight(one.initial, scope, unchanged)
                begins[one.name.lower()] = given and one.name.lower() not in begins
    for module in program.modules:
        for routine in module.routines:
            scope = scopes.routine(module, routine)
            for one in routine.declarations:
                begins.pop(getattr(one, "name", "").lower(), None)
            for node in walk(*bodies(routine)):
                if not isinstance(node, ir.Assign):
                    continue
                name = _base(node.target).lower()
                match node.target:
                    case ir.Name() if not _is_straight(node.value, scope, unchanged):
                        begins.pop(name, None)
                    case ir.Field(base=ir.Name(), name=part) if part.lower() not in _AXES:
                        begins.pop(name, None)
    changed = usage_of(program).otherwise
    return frozenset(name for name, known in begins.items() if known and name not in changed)


def _is_straight(value: ir.Expression, scope: Scope, unchanged: Unchanged) -> bool:
    """A pose that turns nothing: a constant one, or the difference of a place and itself."""
    match value:
        case ir.Builtin(function="element_difference", arguments=(one, other)) if one == other:
            return True
        case ir.Aggregate(entries=entries):
            turned = [part for name, part in entries if name in ir.ANGLES]
            return len(turned) == 3 and all(constant_number(one, scope, unchanged) == 0 for one in turned)
    found = constant(value, scope, unchanged)
    pose = found.pose if isinstance(found, Target) else found
    return isinstance(pose, rigid.Pose) and not any(abs(one) > 1e-9 for one in pose.rotation.zyx)
