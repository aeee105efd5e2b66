"""Expressions to the IR. The language counts in metres and radians, the IR in millimetres and degrees; parts of lists
become elements of arrays from 0, parts of poses components with a unit, six angles joints of the arm.

A list in arithmetic is written out element by element; what has to be evaluated once for that goes in front of its
statement (`held`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.ir.walk import walk
from rpl.source import Origin

from . import nodes
from .functions import BUILTINS, Builtin
from .infer import Inference
from .kinds import BOOL, INT, REAL, TEXT, Kind, is_joints, joined, type_of
from .nodes import Expr, shown
from .scopes import Function, Project, Symbol

NOT_SAID = code(
    "urscript-kept-as-text",
    Severity.WARNING,
    "{text} is kept as text: {reason}",
    "a run stops there unless the cell file gives its value",
)

JOINT_NAMES = ("j1", "j2", "j3", "j4", "j5", "j6")
_POSITION = ("x", "y", "z")
_ROTATION = ("rotation_vector_x", "rotation_vector_y", "rotation_vector_z")
_OPERATORS = {"==": "=", "!=": "<>", "%": "mod", "^": "**", "and": "cand", "or": "cor"}  # M: and, or stop early
_MOST_WRITTEN_OUT = 36


@dataclass(slots=True)
class Names:
    """Names of one file's module that reading makes: structs, and per function its helper variables."""

    records: dict[tuple[str, ...], str] = field(default_factory=dict)
    record_kinds: dict[tuple[str, ...], Kind] = field(default_factory=dict)
    taken: set[str] = field(default_factory=set)

    def fresh(self, wanted: str) -> str:
        name, number = wanted, 1
        while name in self.taken:
            number += 1
            name = f"{wanted}_{number}"
        self.taken.add(name)
        return name

    def record(self, kind: Kind, wanted: str) -> str:
        key = tuple(name for name, _ in kind.fields)
        if key not in self.records:
            self.records[key] = self.fresh(wanted)
            self.record_kinds[key] = kind
        else:
            wider, _ = joined(self.record_kinds[key], kind)
            self.record_kinds[key] = wider or kind
        return self.records[key]


class Expressions:
    """Lowers the expressions of one function."""

    def __init__(
        self, project: Project, inference: Inference, here: Function, names: Names, diagnostics: Diagnostics
    ) -> None:
        self.project = project
        self.inference = inference
        self.here = here
        self.names = names
        self.diagnostics = diagnostics
        self.origin = Origin()
        self.before: list[ir.Statement] = []
        self.helpers: list[ir.Variable] = []
        self.kept: dict[int, ir.Expression] = {}
        self.apply: Callable[[nodes.Apply, Kind | None], ir.Expression] = self.text_of

    # ---- kinds

    def kind(self, expression: Expr) -> Kind | None:
        return self.inference.kind(expression, self.here)

    def type(self, kind: Kind | None) -> ir.Type:
        for part in _structs(kind):
            self.names.record(part, "struct_" + "_".join(name for name, _ in part.fields[:2]))
        return type_of(kind, self.names.records)

    def symbol(self, expression: Expr) -> Symbol | None:
        return self.project.symbol(expression.name, self.here) if isinstance(expression, nodes.Var) else None

    def as_joints_kept(self, expression: Expr) -> bool:
        """Is the value joints in the IR (not an array)?"""
        match expression:
            case nodes.Var():
                symbol = self.symbol(expression)
                return symbol is not None and symbol.is_joints
            case nodes.Apply(base=None, name=name):
                function = self.project.function(name, self.here)
                if function is not None:
                    return returns_joints(function)
                builtin = BUILTINS.get(name)
                return builtin is not None and builtin.result == "q"
        return False

    # ---- any value

    def value(self, expression: Expr, wanted: Kind | None = None) -> ir.Expression:
        """The expression in the IR; `wanted` types what only the controller knows."""
        match expression:
            case nodes.Number(value=int() as whole, spelling=spelling):
                return ir.IntLiteral(whole, spelling)
            case nodes.Number(value=number, spelling=spelling):
                return ir.RealLiteral(number, spelling)
            case nodes.Text(value=text):
                return ir.TextLiteral(text)
            case nodes.Truth(value=truth):
                return ir.BoolLiteral(truth)
            case nodes.Var():
                return self.name(expression)
            case nodes.PoseOf(items=items):
                return pose_literal([_written(item) or signed_literal(self.value(item, REAL)) for item in items])
            case nodes.ListOf(items=items):
                element = wanted.element if wanted is not None and wanted.word == "list" else None
                values = [signed_literal(self.element_value(item, element)) for item in items]
                return ir.Aggregate(tuple([(None, value) for value in values]))
            case nodes.At():
                return self.at(expression, wanted)
            case nodes.Member():
                return self.member(expression, wanted)
            case nodes.Sign(op="not", operand=operand):
                return ir.Unary("not", self.value(operand, BOOL))
            case nodes.Sign(op=op, operand=operand):
                return self.signed(expression, op, operand)
            case nodes.Operation():
                return self.operation(expression)
            case nodes.Apply():
                return self.apply(expression, wanted)
        return self.text_of(expression, wanted)

    def name(self, variable: nodes.Var) -> ir.Name:
        """The variable by its name in the IR."""
        symbol = self.symbol(variable)
        return ir.Name(variable.name if symbol is None else symbol.spelled)

    def element_value(self, item: Expr, element: Kind | None) -> ir.Expression:
        """A list inside of a list is an array, whatever it is kept as."""
        return self.array(item) if self.as_joints_kept(item) else self.value(item, element)

    def text_of(self, expression: Expr, wanted: Kind | None) -> ir.Expression:
        """A value that only the controller has."""
        kind = self.kind(expression) or wanted
        return ir.VendorValue("urscript", shown(expression), self.type(kind))

    def refused(self, expression: Expr, reason: str, wanted: Kind | None = None) -> ir.Expression:
        self.diagnostics.report(NOT_SAID, self.origin, text=shown(expression), reason=reason)
        return self.text_of(expression, wanted)

    def held(self, expression: Expr) -> ir.Expression:
        """The value, evaluated once before the statement when evaluating it again would matter."""
        if not any(isinstance(part, nodes.Apply) for part in _inside(expression)):
            return self.value(expression)
        found = self.kept.get(id(expression))
        if found is None:
            type = ir.JointsType() if self.as_joints_kept(expression) else self.type(self.kind(expression))
            found = self.kept[id(expression)] = self._kept(self.value(expression), type)
        return found

    def kept_apart(self, value: ir.Expression, kind: Kind) -> ir.Expression:
        """A part of a value, evaluated before the statement."""
        return self._kept(value, self.type(kind))

    def _kept(self, value: ir.Expression, type: ir.Type) -> ir.Name:
        name = self.names.fresh("part")
        self.helpers.append(ir.Variable(name, type, scope="routine"))
        self.before.append(ir.Assign(ir.Name(name), value, origin=self.origin))
        return ir.Name(name)

    # ---- parts

    def at(self, expression: nodes.At, wanted: Kind | None) -> ir.Expression:
        base, kind = expression.base, self.kind(expression.base)
        index = expression.indices[0]
        number = index.value if isinstance(index, nodes.Number) and isinstance(index.value, int) else None
        if kind is None or kind.word == "handle":
            return self.text_of(expression, wanted)
        if kind.word == "struct":
            if number is not None and number < len(kind.fields):
                return ir.Field(self.value(base), kind.fields[number][0])
            return self.refused(expression, "the member of a struct is computed", wanted)
        if kind.word == "pose" or self.as_joints_kept(base):
            if number is not None and number < 6:
                return self.component(base, number)
            whole = ir.Aggregate(tuple([(None, self.component(base, place)) for place in range(6)]))
            return ir.Index(whole, (self.value(index, INT),))
        if kind.word == "text":
            return ir.Builtin("text_part", (self.value(base), _plus(self.value(index), 1), ir.IntLiteral(1)))
        found: ir.Expression = self.value(base)
        for each in expression.indices:
            found = ir.Index(found, (self.value(each, INT),))
        return found

    def component(self, base: Expr, place: int) -> ir.Expression:
        """Number `place` of a pose or of joints, in metres or radians."""
        if isinstance(base, nodes.PoseOf | nodes.ListOf):
            return self.value(base.items[place], REAL)
        if self.as_joints_kept(base):
            return ir.Magnitude(ir.Field(self.held(base), JOINT_NAMES[place]), "rad")
        return pose_part(self.value(base), place)

    def member(self, expression: nodes.Member, wanted: Kind | None) -> ir.Expression:
        kind, base = self.kind(expression.base), expression.base
        if isinstance(base, nodes.Apply) and base.name == "time" and base.arguments in ((), _CONTROLLER_TIME):
            return time_part(expression.name)
        if kind is not None and kind.word == "struct":
            return ir.Field(self.value(expression.base), expression.name)
        return self.text_of(expression, wanted)

    # ---- operators

    def signed(self, expression: Expr, op: str, operand: Expr) -> ir.Expression:
        kind = None if isinstance(operand, nodes.Number) else self.kind(operand)
        if kind is not None and kind.word == "list":
            return self.written_out(expression, kind)
        return ir.Unary(op, self.value(operand, REAL))

    def operation(self, expression: nodes.Operation) -> ir.Expression:
        left, right = self.kind(expression.left), self.kind(expression.right)
        op = expression.op
        if op in ("==", "!=") and "list" in (left.word if left else "", right.word if right else ""):
            arrays = [self.array(side) for side in (expression.left, expression.right)]
            return ir.Binary(_OPERATORS[op], arrays[0], arrays[1])
        kind = self.kind(expression)
        if kind is not None and kind.word == "list":
            return self.written_out(expression, kind)
        if kind is not None and kind.word == "pose":
            return self.refused(expression, "arithmetic of poses")
        guess = BOOL if op in ("and", "or", "xor") else REAL
        if op in ("==", "!="):
            guess = left or right or REAL
        one, other = self.value(expression.left, left or guess), self.value(expression.right, right or guess)
        if op == "%" and REAL in (left, right) and _calls_in(one):
            one = self.held(expression.left)
        if op == "+" and TEXT in (left, right):
            return ir.Binary("&", one, other)
        if op == "%" and REAL in (left, right):
            return _rest(one, self.held(expression.right) if _calls_in(other) else other)
        return ir.Binary(_OPERATORS.get(op, op), one, other)

    def written_out(self, expression: Expr, kind: Kind) -> ir.Expression:
        """List arithmetic element by element, where the lengths are known."""
        inner = kind.element
        if kind.length is None or kind.length > _MOST_WRITTEN_OUT or (inner is not None and inner.word == "list"):
            return self.refused(expression, "arithmetic of lists whose length is not known, or of matrices", kind)
        parts = [self.element(expression, place) for place in range(kind.length)]
        found = [part for part in parts if part is not None]
        if len(found) < len(parts):
            return self.refused(expression, "arithmetic of matrices", kind)
        return ir.Aggregate(tuple([(None, part) for part in found]))

    def element(self, expression: Expr, place: int) -> ir.Expression | None:
        """Element number `place` of a list; a number counts for each element."""
        kind = self.kind(expression)
        if kind is None:
            return None
        if kind.word in ("int", "real"):
            return self.held(expression)
        match expression:
            case nodes.ListOf(items=items) | nodes.PoseOf(items=items):
                return self.value(items[place], REAL) if place < len(items) else None
            case nodes.Sign(op=op, operand=operand):
                inner = self.element(operand, place)
                return ir.Unary(op, inner) if inner is not None else None
            case nodes.Operation(op=op, left=left, right=right):
                if any(_is_matrix(self.kind(side)) for side in (left, right)):
                    return None
                one, other = self.element(left, place), self.element(right, place)
                return ir.Binary(_OPERATORS.get(op, op), one, other) if one is not None and other is not None else None
        if kind.word == "pose" or self.as_joints_kept(expression):
            return self.component(expression, place)
        if kind.word != "list":
            return None
        return ir.Index(self.held(expression), (ir.IntLiteral(place),))

    # ---- lists, joints

    def array(self, expression: Expr) -> ir.Expression:
        """A list as an array, also where it is kept as joints."""
        if not self.as_joints_kept(expression):
            return self.value(expression)
        return ir.Aggregate(tuple([(None, self.component(expression, place)) for place in range(6)]))

    def joints(self, expression: Expr) -> ir.Expression:
        """Six angles in radians as joints."""
        if self.as_joints_kept(expression):
            return self.value(expression)
        parts: list[ir.Expression] = []
        for place in range(6):
            part = self.element(expression, place)
            if part is None:
                return self.refused(expression, "it is no list of six angles")
            parts.append(ir.Quantity(signed_literal(part), "rad"))
        return ir.Aggregate(tuple(zip(JOINT_NAMES, parts, strict=True)), "joints")

    def stored(self, expression: Expr, kind: Kind | None, joints: bool) -> ir.Expression:
        """A value for a place that keeps joints, an array, or anything else."""
        if joints:
            return self.joints(expression)
        return self.array(expression) if is_joints(kind) else self.value(expression, kind)


def returns_joints(function: Function) -> bool:
    """Does the function give joints of the arm?"""
    return is_joints(function.returns) and function.returns is not None and function.returns.joints


def _written(expression: Expr) -> ir.IntLiteral | ir.RealLiteral | None:
    """The literal of a number that is written out, with its sign: most components of poses."""
    inner, sign = expression, ""
    if isinstance(expression, nodes.Sign) and expression.op == "-":
        inner, sign = expression.operand, "-"
    if not isinstance(inner, nodes.Number):
        return None
    value, spelling = -inner.value if sign else inner.value, sign + inner.spelling
    return ir.IntLiteral(value, spelling) if isinstance(value, int) else ir.RealLiteral(value, spelling)


def signed_literal(value: ir.Expression) -> ir.Expression:
    """A negative number as one literal."""
    match value:
        case ir.Unary(op="-", operand=ir.RealLiteral(value=number, spelling=spelling)):
            return ir.RealLiteral(-number, f"-{spelling}")
        case ir.Unary(op="-", operand=ir.IntLiteral(value=whole, spelling=spelling)):
            return ir.IntLiteral(-whole, f"-{spelling}")
    return value


def pose_literal(parts: list[ir.Expression]) -> ir.Expression:
    """`p[x, y, z, rx, ry, rz]` from metres and radians."""
    lengths = [ir.Quantity(part, "m") for part in parts[:3]]
    turns = [ir.Quantity(part, "rad") for part in parts[3:]]
    return ir.Builtin("pose_from_rotation_vector", (*lengths, *turns))


def pose_part(pose: ir.Expression, place: int) -> ir.Expression:
    """Number `place` of a pose: metres, then the rotation vector in radians."""
    if place < 3:
        return ir.Magnitude(ir.Field(pose, _POSITION[place]), "m")
    return ir.Magnitude(ir.Builtin(_ROTATION[place - 3], (ir.Field(pose, "rot"),)), "rad")


def _rest(one: ir.Expression, other: ir.Expression) -> ir.Expression:
    """What is left of a division of numbers with fractions, with the sign of the first one."""
    times = ir.Convert("trunc", ir.Binary("/", one, other))
    return ir.Binary("-", one, ir.Binary("*", other, times))


def _calls_in(value: ir.Expression) -> bool:
    return any(isinstance(node, ir.Call) for node in walk((value,)))


def time_part(name: str) -> ir.Expression:
    """A member of what time() gives: whole seconds, or the billionths of a second behind them."""
    seconds = ir.System("time")
    if name == "sec":
        return ir.Convert("floor", seconds)
    behind = ir.Binary("-", seconds, ir.Convert("floor", seconds))
    return ir.Convert("floor", ir.Binary("*", behind, ir.RealLiteral(1e9)))


_CONTROLLER_TIME = ((None, nodes.Number(0, "0")),)


def _plus(expression: ir.Expression, number: int) -> ir.Expression:
    if isinstance(expression, ir.IntLiteral):
        return ir.IntLiteral(expression.value + number)
    return ir.Binary("+", expression, ir.IntLiteral(number))


def _is_matrix(kind: Kind | None) -> bool:
    return kind is not None and kind.element is not None and kind.element.word == "list"


def _structs(kind: Kind | None) -> list[Kind]:
    """The structs in a kind, inner ones first."""
    if kind is None:
        return []
    found = _structs(kind.element)
    for _, inner in kind.fields:
        found.extend(_structs(inner))
    return [*found, kind] if kind.word == "struct" else found


def _inside(expression: Expr) -> list[Expr]:
    found = [expression]
    for part in nodes.parts(expression):
        found.extend(_inside(part))
    return found


__all__ = ["BUILTINS", "Builtin", "Expressions", "Names", "pose_literal", "pose_part", "returns_joints"]
