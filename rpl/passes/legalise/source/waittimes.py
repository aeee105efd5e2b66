"""Time limits of waits that the source keeps in a setting (TP `$WAITTMOUT=150`, hundredths of a second): where every
way to the wait has set the same number, the wait says it, as people of the other languages write it.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.heldvalues import HeldValues, KnownData
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import Scope

__all__ = ["known_wait_times"]


@legalising(
    unless=lambda context: not (context.foreign and rules_of(context.source).settings_data), sees=("WaitUntil",)
)
def known_wait_times(program: ir.Program, context: Context) -> ir.Program:
    """Only for sources with such a setting. A limit that depends on the run stays in its variable."""
    settings = {name.lower() for name in rules_of(context.source).settings_data}
    waits = [one for one in walk(*program.modules) if isinstance(one, ir.WaitUntil) and _names(one.timeout) & settings]
    if not waits:
        return program
    known = KnownData.of(program)
    held = HeldValues.of(known, settings)
    seconds: dict[int, ir.Expression] = {}
    for module, routine in known.scopes.routines():
        scope = known.scopes.routine(module, routine)
        for one in walk(routine):
            if isinstance(one, ir.WaitUntil) and _names(one.timeout) & settings:
                value = _seconds(one, held, scope)
                if value is not None:
                    seconds[id(one)] = ir.RealLiteral(value)

    def said(node: object) -> object:
        return (
            replace(node, timeout=seconds[id(node)]) if isinstance(node, ir.WaitUntil) and id(node) in seconds else node
        )

    modules = tuple(
        replace(module, routines=tuple(rewrite(routine, said) for routine in module.routines))
        for module in program.modules
    )
    return replace(program, modules=modules) if seconds else program


def _names(expression: ir.Expression | None) -> set[str]:
    return set() if expression is None else {one.id.lower() for one in walk(expression) if isinstance(one, ir.Name)}


def _seconds(wait: ir.WaitUntil, held: HeldValues, scope: Scope) -> float | None:
    before = held.before(wait)
    given = {name: value for name, one in before.items() if (value := constant(one, scope)) is not None}
    found = None if wait.timeout is None else constant(wait.timeout, scope, known=given)
    return float(found) if isinstance(found, int | float) and not isinstance(found, bool) else None
