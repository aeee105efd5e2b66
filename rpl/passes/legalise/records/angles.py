"""Vectors, quaternions and nested targets as poses with x, y, z, a, b, c, for targets that have only those (KRL).

A vector is a pose without rotation, a rotation a pose without position. Expressions are taken apart into numbers
(`numbers`) and written as assignments of components; only where a whole value is needed in an expression, a function of
the library puts it together. Tools, work objects, loads, speeds and zones become records with the same components.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes import rigid
from rpl.passes.capabilities import Aggregate
from rpl.passes.fold import constant, lasting, real
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import repeatable
from rpl.passes.legalise.facts.entries import routines_beside
from rpl.passes.legalise.facts.motion.externalaxes import has_external_axes, is_unused
from rpl.passes.legalise.records.records import RECORDS, Records
from rpl.passes.legalise.rewriting.formulas import composed, minus, number, plus, times
from rpl.passes.legalise.rewriting.library import Library
from rpl.passes.legalise.rewriting.stopping import stopped
from rpl.passes.legalise.rewriting.wanted import Kind, WantedRewriter
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.signatures import KINEMATICS
from rpl.passes.typewords import component_names, type_word
from rpl.passes.values import Value, pose_of

QUATERNION_PART = code(
    "quaternion-component",
    Severity.LOSS,
    "the target has no quaternions; assigning one component of a quaternion is not carried over",
    stops=True,
)
REFERENCE_PART = code(
    "component-by-reference",
    Severity.LOSS,
    "the position or rotation of a value is passed by reference; the target passes a copy",
)

_POSITION, _ANGLES = ("x", "y", "z"), ir.ANGLES
_FLAT = (*_POSITION, *_ANGLES)
_QUATERNION = ("q1", "q2", "q3", "q4")
# Places in positional aggregates of vectors, rotations, poses and targets.
_ORDER = {"x": 0, "y": 1, "z": 2, "q1": 0, "q2": 1, "q3": 2, "q4": 3, "trans": 0, "rot": 1, "conf": 2, "ext": 3}
_COMPARED: tuple[Kind, ...] = (ir.VectorType, ir.RotationType, ir.PoseType)


def to_angles(program: ir.Program, context: Context) -> ir.Program:
    """The program in poses with ZYX angles."""
    return _ToAngles(program, context).program()


class _ToAngles(WantedRewriter):
    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        parts = Aggregate.CONSTANT in context.capabilities.data.aggregates
        files = ("geometry", "geometryparts") if parts else ("geometry",)
        self.library = Library(context, files, target=_target_type(program, context))
        self.records = Records(context)
        self.external = has_external_axes(program)
        known = "tool_of_moves" in context.capabilities.system_variables
        self.beside = routines_beside(program) if known else set()

    def program(self) -> ir.Program:
        done = super().program()
        if not done.modules:
            return done
        first = done.modules[0]
        modules = list(done.modules)
        if self.library.names:
            name = self.context.fresh("rpl_geometry")
            modules.append(ir.Module(name, first.dialect, routines=tuple(self.library.routines()), task=first.task))
        made = self.records.declarations()
        if made:
            modules[0] = replace(first, declarations=(*made, *first.declarations))
        return replace(done, modules=tuple(modules))

    def made(self, key: str, *arguments: ir.Expression) -> ir.Call:
        """A call of the function brought along."""
        return self.library.call(f"rpl_{key}", *arguments)

    # ---- types and declarations

    def type(self, type: ir.Type) -> ir.Type:
        match type:
            case ir.VectorType() | ir.RotationType():
                return ir.PoseType()
            case ir.AxesType():
                return ir.JointsType(external=False)
        if type.__class__ in RECORDS and type.__class__.__name__ not in self.context.capabilities.types:
            return self.records.type(type)
        return super().type(type)

    def declaration(self, declaration: ir.Declaration) -> list[ir.Declaration]:
        match declaration:
            case ir.Variable(type=ir.VectorType() | ir.RotationType(), initial=None):
                zero = self.flat(rigid.IDENTITY)
                return [replace(declaration, type=ir.PoseType(), initial=zero)]
            case ir.Initialise(assign=assign):
                done = self.assignment(assign)
                self.before = []
                return [replace(declaration, assign=one) for one in done if isinstance(one, ir.Assign)]
        return super().declaration(declaration)

    # ---- statements

    def assignment(self, statement: ir.Assign) -> list[ir.Statement]:
        target, value = statement.target, statement.value
        match target:
            case ir.Field(base=base, name=name) if name in _QUATERNION and self.is_a(base, ir.RotationType):
                return [stopped(statement, QUATERNION_PART, self.context)]
        type = self.type_of(target)
        match type:
            case ir.VectorType():
                numbers = list(self.numbers(value))
                if isinstance(target, ir.Name) or (isinstance(target, ir.Field) and target.name == "trans"):
                    return self.parts(statement, _POSITION, numbers, "trans")
                return self.parts(statement, _FLAT, [*numbers, *[ir.RealLiteral(0.0)] * 3], "")  # it may have no value
            case ir.RotationType():
                return self.parts(statement, _ANGLES, list(self.angles(value)), "rot")
            case ir.PoseType() if isinstance(value, ir.Aggregate) and constant(value, self.scope) is None:
                return self.parts(statement, _FLAT, self.six(value), "")
            case ir.AxesType() | ir.ExternalType() if self.nested(target):
                names = tuple(ir.COMPONENTS[type.__class__])
                if isinstance(type, ir.ExternalType) and (self.is_unused(value) or not self.external):
                    return [ir.Nothing(origin=statement.origin)]
                return self.parts(statement, names, [self.member(value, name) for name in names], "*")
        return [replace(statement, target=self.expression(target), value=self.valued(value, type))]

    def is_unused(self, value: ir.Expression) -> bool:
        """Are these external axes that no target uses?"""
        entries = value.entries if isinstance(value, ir.Aggregate) else ()
        return bool(entries) and all(is_unused(one, self.scope) for _, one in entries)

    def nested(self, target: ir.Expression) -> bool:
        """Is it the axes or external axes inside a target or joints value?"""
        return isinstance(target, ir.Field) and isinstance(self.type_of(target.base), ir.TargetType | ir.JointsType)

    def member(self, value: ir.Expression, name: str) -> ir.Expression:
        if isinstance(value, ir.Aggregate):
            type = self.type_of(value)
            names = component_names(type, self.scope) if type is not None else ()
            for at, (written, entry) in enumerate(value.entries):
                if (written or (names[at] if at < len(names) else "")) == name:
                    return self.expression(entry)
        return self.expression(ir.Field(value, name))

    def parts(
        self, statement: ir.Assign, names: tuple[str, ...], values: list[ir.Expression], inside: str
    ) -> list[ir.Statement]:
        """Component assignments; whole constants stay whole, and what reads an overwritten component goes by a copy."""
        target = statement.target
        part = isinstance(target, ir.Field) and (inside == "*" or target.name == inside)
        base = self.expression(target.base) if part and isinstance(target, ir.Field) else self.place(target)
        if not part and all(map(_is_literal, values)):
            return [ir.Assign(base, self.aggregate(_filled(names, values)), origin=statement.origin)]
        places = [ir.Field(base, name) for name in names]
        if any(_mentions(value, places[:at]) for at, value in enumerate(values)):
            copies = [self.temporary(ir.RealType()) for _ in values]
            kept: list[ir.Statement] = [ir.Assign(one, value) for one, value in zip(copies, values, strict=True)]
            kept.extend(ir.Assign(place, one) for place, one in zip(places, copies, strict=True))
            return kept
        pairs = zip(places, values, strict=True)
        return [ir.Assign(place, value) for place, value in pairs if place != value] or [ir.Nothing()]

    def place(self, target: ir.Expression) -> ir.Expression:
        """An lvalue of vector, rotation or pose type that is no part of a pose."""
        return self.expression(target)

    # ---- values

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Field():
                return self.field(expression)
            case ir.Aggregate():
                return self.aggregated(expression)
            case ir.Builtin():
                return self.builtin(expression)
            case ir.Call(name=name, arguments=arguments):
                return replace(expression, arguments=self.arguments(name, arguments))
            case ir.Binary(op="=" | "<>" as op, left=left, right=right) if self.is_a(left, *_COMPARED):
                equal = self.equal(left, right)
                return equal if op == "=" else ir.Unary("not", equal, origin=expression.origin)
            case ir.Binary(op="+" | "-" | "*" | "/" | "@") if self.is_a(expression, ir.VectorType):
                return self.whole(self.numbers(expression), (number(0),) * 3)
            case ir.Unary(op="-") if self.is_a(expression, ir.VectorType):
                return self.whole(self.numbers(expression), (number(0),) * 3)
        return super().expression(expression)

    def arguments(self, name: str, given: tuple[ir.Argument, ...]) -> tuple[ir.Argument, ...]:
        routine = self.scope.routine(name)
        required = [one for one in routine.parameters if not one.optional] if routine else []
        done = []
        for at, argument in enumerate(given):
            value = argument.value
            parameter = required[at] if at < len(required) and argument.name is None else None
            if value is not None and parameter is not None and parameter.mode == "reference" and _is_part(value):
                self.context.diagnostics.report(REFERENCE_PART, value.origin)
            wanted = self.scope.resolve(parameter.type) if parameter else None
            done.append(argument if value is None else replace(argument, value=self.valued(value, wanted)))
        return tuple(done)

    def field(self, expression: ir.Field) -> ir.Expression:
        base, name = expression.base, expression.name
        type = self.type_of(base)
        match type:
            case ir.PoseType() | ir.TargetType() if name == "trans":
                return self.whole(self.numbers(expression), (number(0),) * 3)
            case ir.PoseType() | ir.TargetType() if name == "rot":
                return self.whole((number(0),) * 3, self.angles(expression))
            case ir.VectorType():
                return self.numbers(base)[_POSITION.index(name)]
            case ir.RotationType() if name in _QUATERNION:
                return self.quaternion_part(base, name)
            case ir.RotationType():
                return self.angles(base)[_ANGLES.index(name)]
            case ir.AxesType() | ir.ExternalType() if self.nested(base) and isinstance(base, ir.Field):
                return replace(expression, base=self.lvalue(base.base))
            case None:
                return super().expression(expression)
        return replace(expression, base=self.lvalue(base))

    def quaternion_part(self, rotation: ir.Expression, name: str) -> ir.Expression:
        known = lasting(rotation, self.scope)
        if isinstance(known, rigid.Rotation):
            return real(known.quaternion[_QUATERNION.index(name)])
        which = ir.IntLiteral(_QUATERNION.index(name) + 1)
        return self.made("quaternion", which, *self.angles(rotation))

    def lvalue(self, base: ir.Expression) -> ir.Expression:
        """A base whose components can be named; a computed value gets a variable first."""
        done = self.expression(base)
        if isinstance(done, ir.Name | ir.Index | ir.Field | ir.System):
            return done
        type = self.type_of(base)
        return self.kept(done, self.type(type) if type is not None else ir.PoseType())

    def whole(self, position: Numbers, angles: Numbers) -> ir.Expression:
        """A pose of six numbers."""
        six = [*position, *angles]
        if all(map(_is_literal, six)):
            return self.aggregate(tuple(zip(_FLAT, six, strict=True)))
        lead = six[0]
        if isinstance(lead, ir.Field) and tuple(six) == tuple(ir.Field(lead.base, name) for name in _FLAT):
            return lead.base
        return self.made("frame", *six)

    def aggregate(self, entries: tuple[tuple[str, ir.Expression], ...]) -> ir.Aggregate:
        return ir.Aggregate(entries, type_name="pose")

    def flat(self, value: Value) -> ir.Expression | None:
        """A constant vector, rotation or pose with six named components."""
        pose = pose_of(value)
        if pose is None:
            return None
        p = pose.position
        numbers = [real(one) for one in (p.x, p.y, p.z, *pose.rotation.zyx)]
        return self.aggregate(tuple(zip(_FLAT, numbers, strict=True)))

    # ---- vectors and rotations taken apart

    def numbers(self, vector: ir.Expression) -> Numbers:
        """The three numbers of a vector."""
        known = lasting(vector, self.scope)
        match vector:
            case ir.Aggregate(entries=entries) if len(entries) == 3:
                x, y, z = (self.scalar(self.named(vector, name)) for name in _POSITION)
                return x, y, z
            case ir.Field(base=base, name="trans") if self.is_a(base, ir.PoseType, ir.TargetType):
                return _fields(self.lvalue(base), _POSITION)
            case _ if isinstance(known, rigid.Vector) and not isinstance(vector, ir.Name | ir.Index | ir.Field):
                return real(known.x), real(known.y), real(known.z)
            case ir.Unary(op="-", operand=operand):
                x, y, z = (ir.Unary("-", one) for one in self.numbers(operand))
                return x, y, z
            case ir.Binary(op="+" | "-" as op, left=left, right=right):
                pairs = zip(self.numbers(left), self.numbers(right), strict=True)
                x, y, z = (ir.Binary(op, one, other) for one, other in pairs)
                return x, y, z
            case ir.Binary(op="*" | "/" as op, left=left, right=right) if self.is_a(left, ir.VectorType):
                factor = self.simple(self.expression(right))
                x, y, z = (ir.Binary(op, one, factor) for one in self.numbers(left))
                return x, y, z
            case ir.Binary(op="*", left=left, right=right):
                factor = self.simple(self.expression(left))
                x, y, z = (ir.Binary("*", factor, one) for one in self.numbers(right))
                return x, y, z
            case ir.Binary(op="@", left=left, right=right):
                return self.cross(left, right)
            case ir.Builtin(function="current_position", arguments=arguments):
                return _fields(self.lvalue(ir.Builtin("current_target", arguments)), _POSITION)
        return _fields(self.lvalue(vector), _POSITION)

    def scalar(self, value: ir.Expression) -> ir.Expression:
        """A number; a named constant becomes a literal, because aggregates take nothing else."""
        done = self.expression(value)
        known = None if _is_literal(done) else lasting(value, self.scope)
        return real(float(known)) if isinstance(known, int | float) else done

    def cross(self, left: ir.Expression, right: ir.Expression) -> Numbers:
        ax, ay, az = map(self.simple, self.numbers(left))
        bx, by, bz = map(self.simple, self.numbers(right))
        return (
            minus(times(ay, bz), times(az, by)),
            minus(times(az, bx), times(ax, bz)),
            minus(times(ax, by), times(ay, bx)),
        )

    def simple(self, value: ir.Expression) -> ir.Expression:
        """Something that can be written several times."""
        return value if repeatable(value) else self.kept(value, ir.RealType())

    def named(self, aggregate: ir.Aggregate, name: str) -> ir.Expression:
        """A component of a vector, rotation, pose or target that is written out, 0 when it is left out."""
        for at, (written, value) in enumerate(aggregate.entries):
            if written == name or (written is None and name in _ORDER and _ORDER[name] == at):
                return value
        return number(0)

    def angles(self, rotation: ir.Expression) -> Numbers:
        """The three ZYX angles of a rotation."""
        known = lasting(rotation, self.scope)
        if isinstance(known, rigid.Rotation) and not isinstance(rotation, ir.Name | ir.Index | ir.Field):
            first, second, third = known.zyx
            return real(first), real(second), real(third)
        match rotation:
            case ir.Field(base=base, name="rot") if self.is_a(base, ir.PoseType, ir.TargetType):
                return _fields(self.lvalue(base), _ANGLES)
            case ir.Builtin(function="rotation_zyx", arguments=(a, b, c)):
                return self.expression(a), self.expression(b), self.expression(c)
            case ir.Builtin(function="normalise", arguments=(inner,)):
                return self.angles(inner)
            case ir.Aggregate():
                four = [self.expression(self.named(rotation, name)) for name in _QUATERNION]
                return _fields(self.kept(self.made("rotation", *four), ir.PoseType()), _ANGLES)
        return _fields(self.lvalue(rotation), _ANGLES)

    def six(self, pose: ir.Aggregate) -> list[ir.Expression]:
        """The six numbers of a pose or target that is written out."""
        given = {written for written, _ in pose.entries}
        if given & set(_FLAT):
            return [self.scalar(self.named(pose, name)) for name in _FLAT]
        return [*self.numbers(self.named(pose, "trans")), *self.angles(self.named(pose, "rot"))]

    def aggregated(self, expression: ir.Aggregate) -> ir.Expression:
        type = self.type_of(expression)
        match type:
            case ir.VectorType():
                return self.whole(self.numbers(expression), (number(0),) * 3)
            case ir.RotationType():
                return self.whole((number(0),) * 3, self.angles(expression))
            case ir.PoseType():
                six = self.six(expression)
                return self.whole((six[0], six[1], six[2]), (six[3], six[4], six[5]))
            case ir.TargetType():
                return self.target(expression, type)
            case ir.JointsType():
                return self.joints(expression, type)
            case ir.AxesType():
                axes = self.flattened(expression, "", tuple(ir.COMPONENTS[ir.AxesType]))
                return ir.Aggregate(axes, type_name="joints", origin=expression.origin)
        word = self.records.word(type) if type is not None else None
        names = component_names(type, self.scope) if type is not None and word else ()
        entries = tuple(
            (written or (names[at] if at < len(names) else None), self.expression(value))
            for at, (written, value) in enumerate(expression.entries)
        )
        return replace(expression, entries=entries, type_name=word or expression.type_name)

    def target(self, expression: ir.Aggregate, type: ir.TargetType) -> ir.Expression:
        given = dict(expression.entries)
        entries: list[tuple[str | None, ir.Expression]] = []
        if set(given) & {*_FLAT} or not given.keys() & {None, "trans", "rot"}:
            entries.extend((n, self.expression(v)) for n, v in expression.entries if n not in ("conf", "ext"))
        else:
            entries.extend(zip(_FLAT, self.six(expression), strict=True))
            entries.extend(
                (n, self.expression(v))
                for n, v in expression.entries
                if n is not None and n not in ("trans", "rot", "conf", "ext")
            )
        ext = self.named(expression, "ext")
        if isinstance(ext, ir.Aggregate):
            entries.extend(self.flattened(ext, "e", tuple(ir.COMPONENTS[ir.ExternalType])))
        return ir.Aggregate(tuple(entries), type_name=type_word(type), origin=expression.origin)

    def joints(self, expression: ir.Aggregate, type: ir.JointsType) -> ir.Expression:
        entries: list[tuple[str | None, ir.Expression]] = []
        names = component_names(type, self.scope)
        for at, (written, value) in enumerate(expression.entries):
            name = written or names[at]
            if name == "robax" and isinstance(value, ir.Aggregate):
                entries.extend(self.flattened(value, "", tuple(ir.COMPONENTS[ir.AxesType])))
            elif name == "ext" and isinstance(value, ir.Aggregate):
                entries.extend(self.flattened(value, "e", tuple(ir.COMPONENTS[ir.ExternalType])))
            elif name in ("robax", "ext"):
                base = self.lvalue(value)
                members = ir.COMPONENTS[ir.AxesType if name == "robax" else ir.ExternalType]
                entries.extend((member, ir.Field(base, member)) for member in members)
            else:
                entries.append((name, self.expression(value)))
        return ir.Aggregate(tuple(entries), type_name=type_word(type), origin=expression.origin)

    def flattened(
        self, value: ir.Aggregate, kind: str, names: tuple[str, ...]
    ) -> tuple[tuple[str | None, ir.Expression], ...]:
        """The numbers of a nested part; external axes that are not used are left out."""
        found: list[tuple[str | None, ir.Expression]] = []
        for at, (written, entry) in enumerate(value.entries):
            if kind == "e" and is_unused(entry, self.scope):
                continue
            found.append((written or names[at], self.expression(entry)))
        return tuple(found)

    # ---- functions and comparisons

    def equal(self, left: ir.Expression, right: ir.Expression) -> ir.Expression:
        if self.is_a(left, ir.VectorType):
            ones, others = list(self.numbers(left)), list(self.numbers(right))
        elif self.is_a(left, ir.RotationType):
            ones, others = list(self.angles(left)), list(self.angles(right))
        else:
            one, other = self.lvalue(left), self.lvalue(right)
            ones = [*_fields(one, _POSITION), *_fields(one, _ANGLES)]
            others = [*_fields(other, _POSITION), *_fields(other, _ANGLES)]
        tests = [ir.Binary("=", one, other) for one, other in zip(ones, others, strict=True)]
        done: ir.Expression = tests[0]
        for test in tests[1:]:
            done = ir.Binary("and", done, test)
        return done

    def builtin(self, expression: ir.Builtin) -> ir.Expression:
        name, arguments = expression.function, expression.arguments
        can = name in self.context.capabilities.functions
        match name, arguments:
            case "offset", (place, *rest) if not can:
                return self.made("offset", *map(self.expression, (place, *rest)))
            case "tool_offset", (place, *rest) if not can:
                six = [*map(self.expression, rest), *(number(0) for _ in range(6 - len(rest)))]
                return self.made("tool_offset", self.expression(place), *six)
            case "compose", (one, other) if not can:
                return composed(self.expression(one), self.expression(other))
            case "pose_of", (one,) if not can:
                return self.made("pose", self.expression(one))
            case "transform", (pose, vector):
                return self.made("transform", self.expression(pose), *self.numbers(vector))
            case "distance", (ir.Name(), ir.Name()) if can:
                return expression
            case "distance", (ir.Field(base=one, name="trans"), ir.Field(base=other, name="trans")) if can:
                return replace(expression, arguments=(self.expression(one), self.expression(other)))
            case "distance", (one, other):
                pairs = zip(self.numbers(one), self.numbers(other), strict=True)
                return self.made("length", *(minus(a, b) for a, b in pairs))
            case "magnitude", (vector,):
                return self.made("length", *self.numbers(vector))
            case "dot", (one, other):
                pairs = zip(self.numbers(one), self.numbers(other), strict=True)
                return plus(*(times(a, b) for a, b in pairs))
            case (("euler_x" | "euler_y" | "euler_z"), (rotation,)):
                return self.angles(rotation)["zyx".index(name[-1])]
            case "rotation_zyx", _:
                return self.whole((number(0),) * 3, self.angles(expression))
            case "normalise", (rotation,):
                return self.expression(rotation)
            case "frame_from_points", (one, two, three, *rest) if not (can and _at_a_point(rest)):
                points = [self.expression(point) for point in (one, two, three)]
                return self.made("from_points", *points, *(map(self.expression, rest or [ir.IntLiteral(1)])))
            case "current_position", _:
                return self.whole(self.numbers(expression), (number(0),) * 3)
            case "current_target", _ if not can:
                return self.here(arguments)
            case "current_joints", () if not can:
                return ir.System("actual_joints", origin=expression.origin)
            case name, _ if name in KINEMATICS and not can and self.context.capabilities.places.kinematics is not None:
                return self.kinematic(name, arguments)
        return rewrite_parts(expression, self.expression)

    def kinematic(self, name: str, arguments: tuple[ir.Expression, ...]) -> ir.Expression:
        """A kinematic function by the target's own two, which know the modal tool and frame."""
        count = 2 if name in ("target_to_joints_near", "is_reachable") else 1
        frames = self.tool_and_frame(arguments[count:])
        first = self.expression(arguments[0])
        if name == "joints_to_target":
            return self.made("seen", first, *frames) if frames else self.made("target_of_joints", first)
        start: ir.Expression = ir.System("actual_joints")
        if count > 1:
            start = self.expression(arguments[1])
            if isinstance(start, ir.Builtin) and start.function == "current_joints":
                start = ir.System("actual_joints")
        if self.is_a(arguments[0], ir.PoseType):
            first = self.made("as_target", first)
        if frames:
            first = self.made("into", first, *frames)
        return self.made("reached" if name == "is_reachable" else "joints", first, start)

    def here(self, arguments: tuple[ir.Expression, ...]) -> ir.Expression:
        """Where the robot stands, seen with the given tool and work object."""
        frames = self.tool_and_frame(arguments)
        here = self.scope.routine_here
        beside = here is not None and here.name.lower() in self.beside
        return self.made("beside" if beside else "current", *frames) if frames else ir.System("actual_pose")

    def tool_and_frame(self, arguments: tuple[ir.Expression, ...]) -> tuple[ir.Expression, ...]:
        """The poses of the given tool and work object; none where both are the modal ones."""
        if all(isinstance(one, ir.Builtin) for one in arguments):
            return ()
        tool: ir.Expression = ir.System("tool")
        frame: ir.Expression = ir.System("base")
        for at, one in enumerate(arguments):
            if isinstance(one, ir.Builtin):
                continue
            base = self.lvalue(one)
            if at == 0:
                tool = ir.Field(base, "frame") if self.is_a(one, ir.ToolType) else base
            else:
                parts = (ir.Field(base, "user_frame"), ir.Field(base, "object_frame"))
                frame = composed(*parts) if self.is_a(one, ir.WorkObjectType) else base
        return tool, frame


Numbers = tuple[ir.Expression, ir.Expression, ir.Expression]


def _fields(base: ir.Expression, names: tuple[str, ...]) -> Numbers:
    x, y, z = (ir.Field(base, name) for name in names)
    return x, y, z


def _filled(names: tuple[str, ...], values: list[ir.Expression]) -> tuple[tuple[str, ir.Expression], ...]:
    given = dict(zip(names, values, strict=True))
    return tuple((name, given.get(name, number(0))) for name in _FLAT)


def _is_literal(value: ir.Expression) -> bool:
    if isinstance(value, ir.Unary) and value.op == "-":
        return _is_literal(value.operand)
    return isinstance(value, ir.RealLiteral | ir.IntLiteral)


def _mentions(value: ir.Expression, places: list[ir.Field]) -> bool:
    found = False

    def look(one: ir.Expression) -> ir.Expression:
        nonlocal found
        found = found or one in places or any(one == place.base for place in places)
        return one if isinstance(one, ir.Field) and one not in places else rewrite_parts(one, look)

    look(value)
    return found


def _is_part(value: ir.Expression) -> bool:
    return isinstance(value, ir.Field) and value.name in ("trans", "rot", "robax", "ext", "conf")


def _at_a_point(origin: list[ir.Expression]) -> bool:
    """Does a frame begin at its first or second point, as the functions of every target that has one can say?"""
    return not origin or origin in ([ir.IntLiteral(1)], [ir.IntLiteral(2)])


def _target_type(program: ir.Program, context: Context) -> ir.Type:
    """The notation that targets have now: the target's where they are converted already."""
    return ir.TargetType(context.capabilities.places.notation)
