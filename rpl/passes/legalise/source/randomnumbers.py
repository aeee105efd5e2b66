"""Random numbers for targets that have none: a routine calculates them, one from the one before (a linear congruential
generator), from a fixed beginning. They are spread as evenly, but are other numbers and the same ones in each run.

The factor and modulus are those of the first of the three generators of Wichmann and Hill (1982): its products stay
below 2^23, so they are exact in single precision too; it repeats after 30268 numbers.
"""

from __future__ import annotations

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.library import call, number, times
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising

CALCULATED = code(
    "random-numbers-calculated",
    Severity.WARNING,
    "the target has no random numbers; they are calculated here: other numbers, and the same ones in each run",
    "give the variable {name} another whole number from 1 to 30268 for another row of numbers",
)
_FACTOR, _MODULUS, _SEED = 171, 30269, 12345


@legalising(unless=lambda context: "random" in context.capabilities.functions, sees=("function random",))
def random_numbers(program: ir.Program, context: Context) -> ir.Program:
    """The program with a routine in place of `random`."""
    first = next((node for node in walk(program) if _random(node)), None)
    if not isinstance(first, ir.Builtin):
        return program
    state, name = context.fresh("rpl_random_state"), context.fresh("rpl_random")
    context.diagnostics.report(CALCULATED, first.origin, name=state)
    last = ir.Name(state)
    stepped = ir.Binary("mod", times(last, ir.IntLiteral(_FACTOR)), ir.IntLiteral(_MODULUS))
    given = ir.Binary("/", ir.Convert("real", last), number(_MODULUS))
    routine = ir.Routine(
        name, "function", (), ir.RealType(), (), (ir.Assign(last, stepped), ir.Return(given)), scope="global"
    )
    beginning = ir.Variable(state, ir.IntType(), initial=ir.IntLiteral(_SEED), scope="global")
    return with_support(_Calls(program, context, name).program(), context, (beginning,), (routine,))


def _random(node: object) -> bool:
    return isinstance(node, ir.Builtin) and node.function == "random"


class _Calls(Rewriter):
    def __init__(self, program: ir.Program, context: Context, name: str) -> None:
        super().__init__(program, context)
        self.name = name

    def expression(self, expression: ir.Expression) -> ir.Expression:
        return call(self.name) if _random(expression) else super().expression(expression)
