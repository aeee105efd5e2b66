"""Paths that a program puts aside where the robot stands and nothing of a path is left (RAPID StorePath and RestoPath
in the error handler of a search), for targets without.

There is nothing to keep there: the statements go, and with them what lets the robot go on behind them (StartMove, and a
ClearPath between the two), as in the example that the manual gives for a search that has found nothing. In what an
interrupt does, and in a program that stops its own motion, a path may be under way; there they stay for the writer, and
so does a start where an interrupt stops the motion and does not start it again itself.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.activations import Activations
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising

# What an interrupt that stops the motion does to it: it goes on, or is given up.
_GOING_ON = (ir.StartMotion, ir.ClearMotion, ir.ResumeLevel)


@legalising(
    unless=lambda context: "StoreMotion" in context.capabilities.statements,
    sees=(
        "StoreMotion",
        "StartMotion",
    ),
)
def stored_paths(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without such statements."""
    facts = Activations.of(program)
    beside: set[int] = set().union(*facts.threads[1:])
    plain = {key for key, routine in facts.routines.items() if key not in beside and routine.kind != "trap"}
    if any(isinstance(one, ir.StopMotion) for key in plain for one in walk(facts.routines[key])):
        return program
    others = [routine for key, routine in facts.routines.items() if key not in plain]
    starts = all(_has(one, _GOING_ON) for one in others if _has(one, ir.StopMotion))
    gone = (ir.StoreMotion, ir.StartMotion) if starts else (ir.StoreMotion,)
    modules = tuple(
        replace(
            module,
            routines=tuple(_without(one, gone) if id(one) in plain else one for one in module.routines),
        )
        for module in program.modules
    )
    return replace(program, modules=modules)


def _has(routine: ir.Routine, kinds: type[ir.Statement] | tuple[type[ir.Statement], ...]) -> bool:
    return any(isinstance(one, kinds) for one in walk(routine))


def _without(routine: ir.Routine, gone: tuple[type[ir.Statement], ...]) -> ir.Routine:
    def body(statements: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        before: ir.Statement | None = None
        for one in statements:
            restored = isinstance(before, ir.StoreMotion) and before.restore and ir.StartMotion in gone
            if isinstance(one, gone) or (isinstance(one, ir.ClearMotion) and restored):
                done.append(ir.Nothing(origin=one.origin))
            else:
                done.append(inside(one, body))
            before = one
        same = all(new is old for new, old in zip(done, statements, strict=True))
        return statements if same else tuple(done)

    return edit_bodies(routine, body)


__all__ = ["stored_paths"]
