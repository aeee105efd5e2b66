"""What every RPL program knows."""

from __future__ import annotations

from rpl import ir
from rpl.ir.words import NATIVE

from .rules import RULES


def prelude() -> ir.Module:
    """What every RPL program knows: the numbers of the errors by their names."""
    return ir.Module(
        "prelude",
        NATIVE,
        tuple(
            ir.Variable(name, ir.IntType(), ir.IntLiteral(number), "constant", "global")
            for name, number in RULES.errors.items()
        ),
    )
