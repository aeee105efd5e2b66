"""Functions, conversions and operators of numbers that a weak target lacks, by functions in terms of what it has.

Runs behind everything that makes formulas (geometry, products of poses) and before functions become procedures. Targets
with variables by names have had their functions from the pass of numbers, which rests on an angle of two numbers.
"""

from __future__ import annotations

from collections.abc import Callable

from rpl import ir
from rpl.passes.capabilities import Limit
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.library import call, function, minus, number, plus, times
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising

_REAL, _INT, _BOOL = ir.RealType(), ir.IntType(), ir.BoolType()
_V, _W, _N = ir.Name("v"), ir.Name("w"), ir.Name("n")
# name -> parameters, result, local variables, body
Parts = tuple[tuple[tuple[str, ir.Type], ...], ir.Type, tuple[tuple[str, ir.Type], ...], ir.Body]


@legalising(
    unless=lambda context: (
        not context.capabilities.storage.banks
        and Limit.STEPS not in context.capabilities.control.limits
        and (Limit.FUNCTIONS_ALONE not in context.capabilities.control.limits)
        and "atan2" in context.capabilities.functions
    )
)
def arithmetic(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets with numbered data or simple expressions, or without the angle of two numbers."""
    worker = _Arithmetic(program, context)
    done = worker.program()
    return with_support(done, context, (), tuple(worker.routines), done.modules[0].task if done.modules else "")


class _Arithmetic(Rewriter):
    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        self.names: dict[str, str] = {}
        self.routines: list[ir.Routine] = []

    def has(self, function_name: str) -> bool:
        return function_name in self.context.capabilities.functions

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Builtin(function=name, arguments=arguments) if not self.has(name):
                whole = all(isinstance(self.type_of(one), ir.IntType) for one in arguments)
                key = f"{name}_whole" if whole and f"{name}_whole" in _MADE else name
                if key in _MADE and len(arguments) == len(_MADE[key](self)[0]):
                    return self.made(key, *map(self.expression, arguments))
            case ir.Convert(how="real", operand=operand) if "IntType" not in self.context.capabilities.types:
                return self.expression(operand)
            case ir.Convert(how=how, operand=operand) if how not in self.context.capabilities.conversions:
                done = self.converted(expression, how, operand)
                if done is not None:
                    return done
            case ir.Binary(op="xor", left=left, right=right) if "xor" not in self.context.capabilities.operators:
                left, right = self.expression(left), self.expression(right)
                return ir.Binary("<>", left, right, origin=expression.origin)
        return super().expression(expression)

    def converted(self, expression: ir.Convert, how: str, operand: ir.Expression) -> ir.Expression | None:
        new = self.expression(operand)
        whole = isinstance(self.type_of(operand), ir.IntType)
        match how:
            case "round_half_away" | "floor" | "trunc" if whole:
                return new
            case "round_half_away" if self.has("round"):
                return function("round", new)
            case "round_half_away":
                return self.made("round", new)
            case "floor":
                return function("floor", new) if self.has("floor") else self.made("floor", new)
            case "truth":
                zero = ir.IntLiteral(0) if whole else number(0)
                return ir.Binary("<>", new, zero, origin=expression.origin)
            case "bit" | "minus_bit":
                return self.made(how, new)
        return None

    def made(self, key: str, *arguments: ir.Expression) -> ir.Expression:
        """A call of the function, which is made when first asked for."""
        if key not in self.names:
            self.names[key] = self.context.fresh(f"rpl_{key}")
            parameters, returns, local, body = _MADE[key](self)
            self.routines.append(
                ir.Routine(
                    self.names[key],
                    "function",
                    tuple(ir.Parameter(name, type) for name, type in parameters),
                    returns,
                    tuple(ir.Variable(name, type, scope="routine") for name, type in local),
                    body,
                    scope="global",
                )
            )
        return call(self.names[key], *arguments)

    def use(self, name: str, *arguments: ir.Expression) -> ir.Expression:
        """A function that another one rests on: the target's own or a made one."""
        return self.made(name, *arguments) if not self.has(name) and name in _MADE else function(name, *arguments)

    def cut(self, value: ir.Expression) -> ir.Expression:
        if "trunc" in self.context.capabilities.conversions:
            return ir.Convert("trunc", value)
        return ir.Convert("trunc", value) if not self.has("trunc") else function("trunc", value)


def _if(condition: ir.Expression, value: ir.Expression) -> ir.If:
    return ir.If(((condition, (ir.Return(value),)),))


def _test(left: ir.Expression, op: str, right: ir.Expression) -> ir.Expression:
    return ir.Binary(op, left, right)


def _opposite(value: ir.Expression) -> ir.Expression:
    return ir.Unary("-", value)


def _absolute(type: ir.Type, zero: ir.Expression) -> Callable[[_Arithmetic], Parts]:
    body: ir.Body = (_if(_test(_V, "<", zero), _opposite(_V)), ir.Return(_V))
    return lambda made: ((("v", type),), type, (), body)


def _extreme(op: str, type: ir.Type) -> Callable[[_Arithmetic], Parts]:
    body: ir.Body = (_if(_test(_V, op, _W), _V), ir.Return(_W))
    return lambda made: ((("v", type), ("w", type)), type, (), body)


def _sign(made: _Arithmetic) -> Parts:
    zero = number(0)
    body = (_if(_test(_V, "<", zero), number(-1)), _if(_test(_V, ">", zero), number(1)), ir.Return(zero))
    return (("v", _REAL),), _REAL, (), body


def _bounded(op: str, step: str) -> Callable[[_Arithmetic], Parts]:
    def make(made: _Arithmetic) -> Parts:
        moved = ir.If(((_test(_N, op, _V), (ir.Assign(_N, ir.Binary(step, _N, ir.IntLiteral(1))),)),))
        return (("v", _REAL),), _INT, (("n", _INT),), (ir.Assign(_N, made.cut(_V)), moved, ir.Return(_N))

    return make


def _round(made: _Arithmetic) -> Parts:
    half = number(0.5)
    negative: ir.Body = (ir.Assign(_N, made.cut(minus(_V, half))),)
    body = (ir.If(((_test(_V, "<", number(0)), negative),), (ir.Assign(_N, made.cut(plus(_V, half))),)), ir.Return(_N))
    return (("v", _REAL),), _INT, (("n", _INT),), body


def _atan2(made: _Arithmetic) -> Parts:
    """The angle of the vector (w, v): v is the first argument, y."""
    zero, angle = number(0), function("atan", ir.Binary("/", _V, _W))
    behind = (_if(_test(_V, "<", zero), minus(angle, number(180))), ir.Return(plus(angle, number(180))))
    body = (
        _if(_test(_W, ">", zero), angle),
        ir.If(((_test(_W, "<", zero), behind),)),
        _if(_test(_V, ">", zero), number(90)),
        _if(_test(_V, "<", zero), number(-90)),
        ir.Return(zero),
    )
    return (("v", _REAL), ("w", _REAL)), _REAL, (), body


def _other_side(made: _Arithmetic) -> ir.Expression:
    return made.use("sqrt", minus(number(1), times(_V, _V)))


def _asin(made: _Arithmetic) -> Parts:
    return (("v", _REAL),), _REAL, (), (ir.Return(made.use("atan2", _V, _other_side(made))),)


def _acos(made: _Arithmetic) -> Parts:
    return (("v", _REAL),), _REAL, (), (ir.Return(made.use("atan2", _other_side(made), _V)),)


def _atan(made: _Arithmetic) -> Parts:
    if made.has("atan2"):
        return (("v", _REAL),), _REAL, (), (ir.Return(function("atan2", _V, number(1))),)
    return (("v", _REAL),), _REAL, (), (ir.Return(function("atan", _V)),)


def _tan(made: _Arithmetic) -> Parts:
    return (("v", _REAL),), _REAL, (), (ir.Return(ir.Binary("/", function("sin", _V), function("cos", _V))),)


def _bit(yes: int) -> Callable[[_Arithmetic], Parts]:
    body: ir.Body = (_if(_V, ir.IntLiteral(yes)), ir.Return(ir.IntLiteral(0)))
    return lambda made: ((("v", _BOOL),), _INT, (), body)


_MADE: dict[str, Callable[[_Arithmetic], Parts]] = {
    "abs": _absolute(_REAL, number(0)),
    "abs_whole": _absolute(_INT, ir.IntLiteral(0)),
    "min": _extreme("<", _REAL),
    "max": _extreme(">", _REAL),
    "min_whole": _extreme("<", _INT),
    "max_whole": _extreme(">", _INT),
    "sign": _sign,
    "floor": _bounded(">", "-"),
    "ceil": _bounded("<", "+"),
    "round": _round,
    "atan2": _atan2,
    "atan": _atan,
    "asin": _asin,
    "acos": _acos,
    "tan": _tan,
    "bit": _bit(1),
    "minus_bit": _bit(-1),
}
