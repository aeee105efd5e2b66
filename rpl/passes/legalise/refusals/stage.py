"""What has no form in the target and is not worth a rewriting: refused by name, at its place. It stands behind the
interrupts, the last that may find a form, and before signals and settings get theirs.
"""

from __future__ import annotations

from rpl.passes.legalise.refusals import refuse
from rpl.passes.legalise.stages import Clause, Stage

STAGE = Stage(
    "refusals",
    (refuse,),
    Clause(
        statements="ConnectInterrupt ControlInterrupt DeclareInterrupt OnError",
        further=frozenset(("concurrent move", "search of a move")),
    ),
)
