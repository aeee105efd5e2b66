"""The speed that most joint moves of a program have: it is set once for all."""

from __future__ import annotations

from collections import Counter

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.fold import constant_number
from rpl.passes.scope import ProgramScope


def usual_speed(program: ir.Program) -> float | None:
    """The speed of joint moves that the program sets once for all."""
    scopes = ProgramScope(program)
    counts: Counter[float] = Counter()
    for module in program.modules:
        for routine in module.routines:
            scope = scopes.routine(module, routine)
            for node in walk(routine.body):
                if isinstance(node, ir.Move) and node.kind == "joint" and node.speed is not None:
                    percent = node.speed.joint
                    bare = percent.value if isinstance(percent, ir.Quantity) else percent
                    known = constant_number(bare, scope) if bare is not None else None
                    if known is not None and known > 0:
                        counts[known] += 1
    return counts.most_common(1)[0][0] if counts else None
