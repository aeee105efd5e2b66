"""Products and inverses of poses by components, for targets that have rotations as angles and no operator for them.

A product becomes a call of a function that is made once for the types it is used with: rotation matrices of ZYX Euler
angles, multiplied as far as the angles of the result need it (R = Rz(a) Ry(b) Rx(c), so b = atan2(-r31, |r11, r21|)).
What a move of the target can say itself (a place seen from another) stays there.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.formulas import call, function, minus, number, part, plus, times
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising

# Below this cosine of b the first and the third angle turn about the same axis; the third one is zero then.
_SMALL = 1e-7
_POSITION, _ANGLES = ("x", "y", "z"), ir.ANGLES
_LEFT, _RIGHT, _DONE = "one", "other", "done"
_POSES = (ir.PoseType, ir.TargetType)


@legalising(
    unless=lambda context: (
        not (":" not in context.capabilities.operators and "compose" not in context.capabilities.functions)
        and "inverse" in context.capabilities.functions
    )
)
def compositions(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that lack the product of poses or the inverse."""
    can = context.capabilities
    product = ":" not in can.operators and "compose" not in can.functions
    worker = _Composed(program, context, product)
    done = worker.program()
    return with_support(done, context, (), worker.routines, done.modules[0].task if done.modules else "")


class _Composed(Rewriter):
    def __init__(self, program: ir.Program, context: Context, product: bool) -> None:
        super().__init__(program, context)
        self.product = product
        self.names: dict[tuple[str, ir.Type, ir.Type], str] = {}
        self.routines: list[ir.Routine] = []

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        if isinstance(statement, ir.Move) and self.context.capabilities.places.move_functions:
            target = self.at_move(statement.target)
            both = isinstance(target, ir.Binary | ir.Builtin)  # a move says from where one of its places is seen
            seen = self.expression if both and self.product else self.at_move
            via = None if statement.via is None else seen(statement.via)
            (done,) = super().statement(replace(statement, target=ir.IntLiteral(0), via=None))
            return [replace(done, target=target, via=via)] if isinstance(done, ir.Move) else [done]
        return super().statement(statement)

    def at_move(self, target: ir.Expression) -> ir.Expression:
        """A target of a move: the move itself may say that it is seen from another place."""
        says = self.context.capabilities.places.move_functions
        match target:
            case ir.Binary(op=":", left=left, right=right) if ":" in says:
                return replace(target, left=self.at_move(left), right=self.expression(right))
            case ir.Builtin(function=name, arguments=(base, *rest)) if name in says:
                return replace(target, arguments=(self.at_move(base), *map(self.expression, rest)))
        return self.expression(target)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Binary(op=":", left=left, right=right) | ir.Builtin(function="compose", arguments=(left, right)):
                if self.product:
                    return self.composed(expression, left, right)
            case ir.Builtin(function="inverse", arguments=(one,)):
                if "inverse" not in self.context.capabilities.functions:
                    return self.called("inverse", ir.PoseType(), ir.PoseType(), one)
        return super().expression(expression)

    def composed(self, expression: ir.Expression, left: ir.Expression, right: ir.Expression) -> ir.Expression:
        one, other = self.type_of(left), self.type_of(right)
        if not isinstance(one, _POSES) or not isinstance(other, _POSES):
            return super().expression(expression)
        return self.called("compose", one, other, left, right)

    def called(self, what: str, one: ir.Type, other: ir.Type, *given: ir.Expression) -> ir.Expression:
        key = (what, one, other)
        if key not in self.names:
            self.names[key] = self.context.fresh(f"rpl_{what}")
            maker = _composition if what == "compose" else _inverse
            self.routines.append(maker(self.names[key], one, other))
        return call(self.names[key], *map(self.expression, given))


# ---- the functions


def _set(name: str, value: ir.Expression) -> ir.Statement:
    return ir.Assign(ir.Name(name), value)


def _matrix(base: str, letter: str) -> tuple[list[str], list[ir.Statement]]:
    """Names and statements of a pose's rotation matrix: `p11` ... `p33`."""
    names = [f"{letter}{way}{angle}" for angle in _ANGLES for way in ("s", "c")]
    body = [
        _set(f"{letter}{way}{angle}", function({"s": "sin", "c": "cos"}[way], part(base, angle)))
        for angle in _ANGLES
        for way in ("s", "c")
    ]
    sa, ca, sb, cb, sc, cc = (ir.Name(name) for name in names)
    entries = {
        "11": times(ca, cb),
        "12": minus(times(ca, sb, sc), times(sa, cc)),
        "13": plus(times(ca, sb, cc), times(sa, sc)),
        "21": times(sa, cb),
        "22": plus(times(sa, sb, sc), times(ca, cc)),
        "23": minus(times(sa, sb, cc), times(ca, sc)),
        "31": times(number(-1), sb),
        "32": times(cb, sc),
        "33": times(cb, cc),
    }
    body.extend(_set(f"{letter}{place}", value) for place, value in entries.items())
    return [*names, *(f"{letter}{place}" for place in entries)], body


def _angles(entry: dict[str, ir.Expression]) -> list[ir.Statement]:
    """done.a, done.b, done.c from the entries 11 12 21 22 31 32 33 of its rotation matrix."""
    level = function("sqrt", plus(times(ir.Name("m11"), ir.Name("m11")), times(ir.Name("m21"), ir.Name("m21"))))
    body = [_set(f"m{place}", value) for place, value in entry.items()]
    usual: ir.Body = (
        ir.Assign(part(_DONE, "a"), function("atan2", ir.Name("m21"), ir.Name("m11"))),
        ir.Assign(part(_DONE, "c"), function("atan2", ir.Name("m32"), ir.Name("m33"))),
    )
    upright: ir.Body = (
        ir.Assign(part(_DONE, "a"), function("atan2", times(number(-1), ir.Name("m12")), ir.Name("m22"))),
        ir.Assign(part(_DONE, "c"), number(0)),
    )
    body.append(_set("level", level))
    body.append(ir.Assign(part(_DONE, "b"), function("atan2", times(number(-1), ir.Name("m31")), ir.Name("level"))))
    body.append(ir.If(((ir.Binary(">", ir.Name("level"), number(_SMALL)), usual),), upright))
    return body


_NEEDED = ("11", "12", "21", "22", "31", "32", "33")


def _routine(
    name: str, parameters: tuple[ir.Parameter, ...], returns: ir.Type, names: list[str], body: list[ir.Statement]
) -> ir.Routine:
    reals = [*names, *(f"m{place}" for place in _NEEDED), "level"]
    variables = (
        ir.Variable(_DONE, returns, scope="routine"),
        *(ir.Variable(one, ir.RealType(), scope="routine") for one in reals),
    )
    return ir.Routine(
        name, "function", parameters, returns, variables, (*body, ir.Return(ir.Name(_DONE))), scope="global"
    )


def _composition(name: str, one: ir.Type, other: ir.Type) -> ir.Routine:
    """The product; flags and external axes are those of the operand that is a target."""
    target = _RIGHT if isinstance(other, ir.TargetType) and not isinstance(one, ir.TargetType) else _LEFT
    returns = other if target == _RIGHT else one
    p_names, p_body = _matrix(_LEFT, "p")
    q_names, q_body = _matrix(_RIGHT, "q")
    body: list[ir.Statement] = [*p_body, *q_body, ir.Assign(ir.Name(_DONE), ir.Name(target))]
    for row, axis in enumerate(_POSITION, 1):
        terms = [times(ir.Name(f"p{row}{column}"), part(_RIGHT, along)) for column, along in enumerate(_POSITION, 1)]
        body.append(ir.Assign(part(_DONE, axis), plus(part(_LEFT, axis), *terms)))
    product = {
        place: plus(*(times(ir.Name(f"p{place[0]}{k}"), ir.Name(f"q{k}{place[1]}")) for k in (1, 2, 3)))
        for place in _NEEDED
    }
    body.extend(_angles(product))
    parameters = (ir.Parameter(_LEFT, one), ir.Parameter(_RIGHT, other))
    return _routine(name, parameters, returns, [*p_names, *q_names], body)


def _inverse(name: str, one: ir.Type, other: ir.Type) -> ir.Routine:
    """The transposed rotation; the position turned back."""
    names, matrix = _matrix(_LEFT, "p")
    body: list[ir.Statement] = [*matrix, ir.Assign(ir.Name(_DONE), ir.Name(_LEFT))]
    for row, axis in enumerate(_POSITION, 1):
        terms = [times(ir.Name(f"p{column}{row}"), part(_LEFT, along)) for column, along in enumerate(_POSITION, 1)]
        body.append(ir.Assign(part(_DONE, axis), times(number(-1), plus(*terms))))
    body.extend(_angles({place: ir.Name(f"p{place[1]}{place[0]}") for place in _NEEDED}))
    return _routine(name, (ir.Parameter(_LEFT, one),), one, names, body)
