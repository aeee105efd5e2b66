"""Setting the operator's override to full, for controllers whose programs cannot set it.

Where a program only ever sets it to 100 percent, nothing but the operator's own choice differs: the statement is left
out with a warning. What slows the robot down is no such thing: `scaledspeeds` makes it a factor of the moves' speeds.
"""

from __future__ import annotations

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.scope import ProgramScope, Scope

FULL = code(
    "override-by-operator",
    Severity.WARNING,
    "the target's programs cannot set the override; this one sets it to 100 percent only, so that is left out",
    "set the override to 100 percent by hand",
)
_FULL_PERCENT = 100.0


@legalising(
    unless=lambda context: "override" in context.capabilities.system_variables or context.capabilities.carries_rules,
    sees=("system override",),
)
def full_override(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without the override among their system variables."""
    scopes = ProgramScope(program)
    set_to = [
        (node, scopes.routine(module, routine))
        for module in program.modules
        for routine in module.routines
        for node in walk(routine)
        if isinstance(node, ir.Assign) and _sets(node)
    ]
    if not set_to or not all(_is_full(node, scope) for node, scope in set_to):
        return program
    for node, _ in set_to:
        context.diagnostics.report(FULL, node.origin)

    def body(statements: ir.Body) -> ir.Body:
        return tuple(
            ir.Nothing(origin=one.origin) if _sets(one) else rewrite_parts(one, lambda value: value, body)
            for one in statements
        )

    return rewrite_parts(program, lambda value: value, body)


def _sets(node: object) -> bool:
    return isinstance(node, ir.Assign) and isinstance(node.target, ir.System) and node.target.name == "override"


def _is_full(node: ir.Assign, scope: Scope) -> bool:
    value = constant(node.value, scope, None)
    return isinstance(value, int | float) and float(value) == _FULL_PERCENT
