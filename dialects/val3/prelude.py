"""What every VAL3 application knows: the parts of a movement descriptor."""

from __future__ import annotations

from rpl import ir

from .rules import MDESC

PRELUDE = ir.Module(
    "val3_prelude",
    "val3",
    (ir.RecordDeclaration("mdesc", tuple((name, ir.RealType()) for name in MDESC), "global"),),
)


def prelude() -> ir.Module:
    return PRELUDE
