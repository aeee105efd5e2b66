"""Functions that a translated program brings along: geometry in terms of a target's own components and composition.

Each is made once, when first asked for, and lives in a module of its own, so that translated statements stay as short
as the original ones. Poses have components x, y, z, a, b, c here, vectors and rotations are poses without the rest.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from rpl import ir
from rpl.passes.capabilities import Aggregate
from rpl.passes.legalise.context import Context

_REAL, _POSE, _JOINTS = ir.RealType(), ir.PoseType(), ir.JointsType()
COMPONENTS = ir.POSE
Made = tuple[tuple[ir.Parameter, ...], ir.Type, tuple[ir.Variable, ...], ir.Body]


def number(value: float) -> ir.Expression:
    return ir.RealLiteral(float(value))


def call(name: str, *arguments: ir.Expression) -> ir.Call:
    """A call with positional arguments."""
    return ir.Call(name, tuple(ir.Argument(value) for value in arguments))


def plus(*terms: ir.Expression) -> ir.Expression:
    return _chain("+", terms)


def minus(left: ir.Expression, right: ir.Expression) -> ir.Expression:
    return ir.Binary("-", left, right)


def times(*factors: ir.Expression) -> ir.Expression:
    return _chain("*", factors)


def composed(*poses: ir.Expression) -> ir.Expression:
    """The product of poses from left to right."""
    return _chain(":", poses)


def function(name: str, *arguments: ir.Expression) -> ir.Builtin:
    return ir.Builtin(name, arguments)


def part(base: str, name: str) -> ir.Field:
    return ir.Field(ir.Name(base), name)


def _chain(op: str, parts: tuple[ir.Expression, ...]) -> ir.Expression:
    done = parts[0]
    for one in parts[1:]:
        done = ir.Binary(op, done, one)
    return done


@dataclass(slots=True)
class Library:
    """The functions asked for so far. `target` is the type of targets in the program's notation."""

    context: Context
    target: ir.Type
    names: dict[str, str] = field(default_factory=dict)
    routines: list[ir.Routine] = field(default_factory=list)

    def name(self, key: str) -> str:
        """The name of a function of this library; it is made when it is not there yet."""
        if key not in self.names:
            name = self.names[key] = self.context.fresh(f"rpl_{key}")
            parameters, returns, declarations, body = _MAKERS[key](self)
            self.routines.append(ir.Routine(name, "function", parameters, returns, declarations, body, scope="global"))
        return self.names[key]

    def asked(self, type: ir.Type, *parts: str) -> ir.Expression:
        """The controller's own function for the joints of a target, or for the target of joints; `error` is written."""
        inverse, forward = self.context.capabilities.places.kinematics or ("", "")
        name = inverse if type == _JOINTS else forward
        return ir.VendorValue(self.context.target, f"{name}({','.join((*parts, 'error'))})", type)

    def call(self, key: str, *arguments: ir.Expression) -> ir.Call:
        return call(self.name(key), *arguments)

    def module(self, dialect: str, task: str) -> ir.Module | None:
        """The module that holds them; None when nothing was asked for."""
        if not self.routines:
            return None
        return ir.Module(self.context.fresh("rpl_geometry"), dialect, routines=tuple(self.routines), task=task)


def _reals(names: str) -> tuple[ir.Parameter, ...]:
    return tuple(ir.Parameter(name, _REAL) for name in names.split())


def _local(names: str, type: ir.Type) -> tuple[ir.Variable, ...]:
    return tuple(ir.Variable(name, type, scope="routine") for name in names.split())


def _set(place: str, value: ir.Expression) -> ir.Assign:
    base, _, name = place.partition(".")
    return ir.Assign(part(base, name) if name else ir.Name(base), value)


def _copy(target: str, source: str, names: tuple[str, ...]) -> tuple[ir.Statement, ...]:
    return tuple(_set(f"{target}.{name}", part(source, name)) for name in names)


def _names(words: str) -> list[ir.Expression]:
    return [ir.Name(word) for word in words.split()]


def _frame(library: Library) -> Made:
    """The six numbers at once where the target can say so: set one by one, angles beyond 90 degrees come out otherwise
    where a place does not keep its angles."""
    if Aggregate.CONSTANT not in library.context.capabilities.data.aggregates:
        whole = ir.Aggregate(tuple((name, ir.Name(name)) for name in COMPONENTS), "pose")
        return _reals("x y z a b c"), _POSE, (), (ir.Return(whole),)
    body: ir.Body = (*(_set(f"f.{name}", ir.Name(name)) for name in COMPONENTS), ir.Return(ir.Name("f")))
    return _reals("x y z a b c"), _POSE, _local("f", _POSE), body


def _offset(library: Library) -> Made:
    moved = tuple(_set(f"p.{n}", plus(part("p", n), ir.Name(f"d{n}"))) for n in ("x", "y", "z"))
    parameters = (ir.Parameter("p", library.target), *_reals("dx dy dz"))
    return parameters, library.target, (), (*moved, ir.Return(ir.Name("p")))


def _tool_offset(library: Library) -> Made:
    frame = library.name("frame")
    zero = number(0)
    shift, about = _names("dx dy dz"), _names("rx ry rz")
    product = composed(
        ir.Name("p"),
        call(frame, *shift, zero, zero, about[0]),
        call(frame, zero, zero, zero, zero, about[1], zero),
        call(frame, zero, zero, zero, about[2], zero, zero),
    )
    body: ir.Body = (_set("f", product), *_copy("p", "f", COMPONENTS), ir.Return(ir.Name("p")))
    parameters = (ir.Parameter("p", library.target), *_reals("dx dy dz rx ry rz"))
    return parameters, library.target, _local("f", _POSE), body


def _transform(library: Library) -> Made:
    zero = number(0)
    placed = composed(ir.Name("f"), call(library.name("frame"), *_names("x y z"), zero, zero, zero))
    body: ir.Body = (_set("f", placed), *(_set(f"f.{n}", zero) for n in ir.ANGLES), ir.Return(ir.Name("f")))
    return (ir.Parameter("f", _POSE), *_reals("x y z")), _POSE, (), body


def _length(library: Library) -> Made:
    squares = [times(one, one) for one in _names("x y z")]
    return _reals("x y z"), _REAL, (), (ir.Return(function("sqrt", plus(*squares))),)


def _pose(library: Library) -> Made:
    """The pose of a target."""
    body: ir.Body = (*_copy("f", "p", COMPONENTS), ir.Return(ir.Name("f")))
    return (ir.Parameter("p", library.target),), _POSE, _local("f", _POSE), body


def _current(library: Library) -> Made:
    """The target that the robot stands at, seen with another tool and in another frame than the modal ones."""
    return _otherwise(library, ir.System("actual_pose"))


def _beside(library: Library) -> Made:
    """The same in a task beside the one that moves the robot, whose tool and frame these are."""
    return _otherwise(library, ir.System("actual_pose"), modal=("tool_of_moves", "frame_of_moves"))


def _otherwise(
    library: Library,
    place: ir.Expression,
    *parameters: ir.Parameter,
    modal: tuple[str, str] = ("tool", "base"),
) -> Made:
    """A place that is known with the modal tool and frame, as it is with others."""
    product = composed(
        function("inverse", ir.Name("reference")),
        ir.System(modal[1]),
        ir.Name("p"),
        function("inverse", ir.System(modal[0])),
        ir.Name("tcp"),
    )
    body: ir.Body = (
        _set("p", place),
        _set("f", product),
        *_copy("p", "f", COMPONENTS),
        ir.Return(ir.Name("p")),
    )
    every = (*parameters, ir.Parameter("tcp", _POSE), ir.Parameter("reference", _POSE))
    return every, library.target, (*_local("p", library.target), *_local("f", _POSE)), body


def _joints(library: Library) -> Made:
    """The joints of a target, near given ones; out of reach the program stops, as the source's does."""
    return _solved(library, "q", ir.JointsType(), ir.Parameter("p", library.target), ir.Parameter("start", _JOINTS))


def _as_target(library: Library) -> Made:
    """A pose as a target that leaves the arm's posture open."""
    body: ir.Body = (*_copy("p", "f", COMPONENTS), ir.Return(ir.Name("p")))
    return (ir.Parameter("f", _POSE),), library.target, _local("p", library.target), body


def _target_of_joints(library: Library) -> Made:
    """Where the tool is at given joints."""
    return _solved(library, "p", library.target, ir.Parameter("q", _JOINTS))


def _reached(library: Library) -> Made:
    """Whether a target has joints near given ones."""
    ask = ir.Assign(ir.Name("q"), library.asked(ir.JointsType(), "p", "start"))
    parameters = (ir.Parameter("p", library.target), ir.Parameter("start", _JOINTS))
    local = (*_local("q", _JOINTS), *_local("error", ir.IntType()))
    return parameters, ir.BoolType(), local, (ask, ir.Return(ir.Binary("=", ir.Name("error"), ir.IntLiteral(0))))


def _solved(library: Library, result: str, type: ir.Type, *parameters: ir.Parameter) -> Made:
    """The controller's own function, with a stop where it says that there is no answer."""
    failed = ir.If(((ir.Binary("<>", ir.Name("error"), ir.IntLiteral(0)), (ir.Halt(),)),))
    ask = ir.Assign(ir.Name(result), library.asked(type, *(one.name for one in parameters)))
    local = (*_local(result, type), *_local("error", ir.IntType()))
    return parameters, type, local, (ask, failed, ir.Return(ir.Name(result)))


def _into(library: Library) -> Made:
    """A target that is seen with another tool and in another frame than the modal ones, seen with these."""
    product = composed(
        function("inverse", ir.System("base")),
        ir.Name("reference"),
        ir.Name("p"),
        function("inverse", ir.Name("tcp")),
        ir.System("tool"),
    )
    body: ir.Body = (_set("f", product), *_copy("p", "f", COMPONENTS), ir.Return(ir.Name("p")))
    parameters = (ir.Parameter("p", library.target), ir.Parameter("tcp", _POSE), ir.Parameter("reference", _POSE))
    return parameters, library.target, _local("f", _POSE), body


def _seen(library: Library) -> Made:
    """Where another tool is in another frame at given joints."""
    place = call(library.name("target_of_joints"), ir.Name("q"))
    return _otherwise(library, place, ir.Parameter("q", _JOINTS))


def _quaternion(library: Library) -> Made:
    """Component 1..4 (w, x, y, z) of the quaternion of ZYX angles."""
    two = number(2)
    halves = tuple(
        _set(f"{kind}{angle}", function(name, ir.Binary("/", ir.Name(angle), two)))
        for angle in "abc"
        for kind, name in (("s", "sin"), ("c", "cos"))
    )
    sa, ca, sb, cb, sc, cc = _names("sa ca sb cb sc cc")
    components = (
        plus(times(ca, cb, cc), times(sa, sb, sc)),
        minus(times(ca, cb, sc), times(sa, sb, cc)),
        plus(times(ca, sb, cc), times(sa, cb, sc)),
        minus(times(sa, cb, cc), times(ca, sb, sc)),
    )
    w, which = components[0], ir.Name("n")
    sign = ir.If(((ir.Binary("<", w, number(0)), (_set("q", ir.Unary("-", ir.Name("q"))),)),))
    choices = tuple(
        (ir.Binary("=", which, ir.IntLiteral(at)), (_set("q", one),)) for at, one in enumerate(components[1:], 2)
    )
    body: ir.Body = (*halves, ir.If(choices, (_set("q", w),)), sign, ir.Return(ir.Name("q")))
    parameters = (ir.Parameter("n", ir.IntType()), *_reals("a b c"))
    return parameters, _REAL, _local("q sa ca sb cb sc cc", _REAL), body


def _rotation(library: Library) -> Made:
    """The rotation of a quaternion of any length, as ZYX angles; at b = ±90: c = 0."""
    one, two = number(1), number(2)
    unit = tuple(_set(f"q{at}", ir.Binary("/", ir.Name(f"q{at}"), ir.Name("l"))) for at in range(1, 5))
    w, x, y, z = _names("q1 q2 q3 q4")
    squares = [times(value, value) for value in (w, x, y, z)]
    xx, yx = minus(one, times(two, plus(squares[2], squares[3]))), times(two, plus(times(x, y), times(z, w)))
    zx, zy = times(two, minus(times(x, z), times(y, w))), times(two, plus(times(y, z), times(x, w)))
    zz = minus(one, times(two, plus(squares[1], squares[2])))
    xy, yy = times(two, minus(times(x, y), times(z, w))), minus(one, times(two, plus(squares[1], squares[3])))
    cosine = function("sqrt", plus(times(ir.Name("m"), ir.Name("m")), times(ir.Name("n"), ir.Name("n"))))
    regular = (
        _set("a", function("atan2", ir.Name("n"), ir.Name("m"))),
        _set("c", function("atan2", zy, zz)),
    )
    gimbal = (_set("a", function("atan2", ir.Unary("-", xy), yy)), _set("c", number(0)))
    body: ir.Body = (
        _set("l", function("sqrt", plus(*squares))),
        *unit,
        _set("m", xx),
        _set("n", yx),
        _set("l", cosine),
        ir.If(((ir.Binary(">", ir.Name("l"), number(1e-6)), regular),), gimbal),
        _set("b", function("atan2", ir.Unary("-", zx), ir.Name("l"))),
        ir.Return(call(library.name("frame"), number(0), number(0), number(0), *_names("a b c"))),
    )
    return _reals("q1 q2 q3 q4"), _POSE, _local("a b c l m n", _REAL), body


def _from_points(library: Library) -> Made:
    """The frame through three points: x from the first to the second, y towards the third; origin 1 first, 2 second
    point, 3 the point of the line nearest to the third."""

    def axis(word: str, n: str) -> ir.Name:
        """Of a direction, in numbers: positions may be kept to a thousandth only."""
        return ir.Name(word + n)

    def square(word: str) -> ir.Expression:
        return plus(*(times(axis(word, n), axis(word, n)) for n in ("x", "y", "z")))

    def cross(left: str, right: str) -> tuple[ir.Expression, ...]:
        pairs = (("y", "z"), ("z", "x"), ("x", "y"))
        return tuple(
            minus(times(axis(left, m), axis(right, n)), times(axis(left, n), axis(right, m))) for m, n in pairs
        )

    def scaled(word: str) -> list[ir.Statement]:
        """Make it of length one."""
        unit = [_set(f"{word}{n}", ir.Binary("/", axis(word, n), ir.Name("l"))) for n in ("x", "y", "z")]
        return [_set("l", function("sqrt", square(word))), *unit]

    ends = [_set(f"u{n}", minus(part("p2", n), part("p1", n))) for n in ("x", "y", "z")]
    side = [_set(f"v{n}", minus(part("p3", n), part("p1", n))) for n in ("x", "y", "z")]
    along = _set("k", plus(*(times(axis("u", n), axis("v", n)) for n in ("x", "y", "z"))))
    normal = [_set(f"w{n}", one) for n, one in zip(("x", "y", "z"), cross("u", "v"), strict=True)]
    third = [_set(f"v{n}", one) for n, one in zip(("x", "y", "z"), cross("w", "u"), strict=True)]
    first = tuple(_set(f"f.{n}", part("p1", n)) for n in ("x", "y", "z"))
    second = tuple(_set(f"f.{n}", part("p2", n)) for n in ("x", "y", "z"))
    foot = tuple(_set(f"f.{n}", plus(part("p1", n), times(ir.Name("k"), axis("u", n)))) for n in ("x", "y", "z"))
    which = ir.Name("origin")
    place = ir.If(
        ((ir.Binary("=", which, ir.IntLiteral(2)), second), (ir.Binary("=", which, ir.IntLiteral(3)), foot)), first
    )
    level = function("sqrt", plus(times(axis("u", "x"), axis("u", "x")), times(axis("u", "y"), axis("u", "y"))))
    regular = (
        _set("f.a", function("atan2", axis("u", "y"), axis("u", "x"))),
        _set("f.c", function("atan2", axis("v", "z"), axis("w", "z"))),
    )
    gimbal = (_set("f.a", function("atan2", ir.Unary("-", axis("v", "x")), axis("v", "y"))), _set("f.c", number(0)))
    body: ir.Body = (
        *ends,
        *side,
        *scaled("u"),
        along,
        *normal,
        *scaled("w"),
        *third,
        place,
        _set("l", level),
        ir.If(((ir.Binary(">", ir.Name("l"), number(1e-6)), regular),), gimbal),
        _set("f.b", function("atan2", ir.Unary("-", axis("u", "z")), ir.Name("l"))),
        ir.Return(ir.Name("f")),
    )
    points = tuple(ir.Parameter(name, _POSE) for name in ("p1", "p2", "p3"))
    local = (*_local("f", _POSE), *_local("ux uy uz vx vy vz wx wy wz k l", _REAL))
    return (*points, ir.Parameter("origin", ir.IntType())), _POSE, local, body


_MAKERS: dict[str, Callable[[Library], Made]] = {
    "frame": _frame,
    "offset": _offset,
    "tool_offset": _tool_offset,
    "transform": _transform,
    "length": _length,
    "pose": _pose,
    "current": _current,
    "beside": _beside,
    "joints": _joints,
    "as_target": _as_target,
    "target_of_joints": _target_of_joints,
    "reached": _reached,
    "into": _into,
    "seen": _seen,
    "quaternion": _quaternion,
    "rotation": _rotation,
    "from_points": _from_points,
}
