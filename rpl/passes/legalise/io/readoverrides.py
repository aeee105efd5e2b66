"""An override that a program reads, for targets whose programs can set it but not read it: a variable holds what was
set last. What the operator sets by hand is not seen then.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.capabilities import SettingRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import edit_bodies, expansion, map_body
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts

KEPT = code(
    "override-kept",
    Severity.WARNING,
    "the target's programs cannot read the override; a variable keeps what this program sets, not what is set by hand",
)
_OVERRIDE = ir.System("override")
_FULL_PERCENT = 100.0


@legalising(
    unless=lambda context: (
        SettingRule.READ_OVERRIDE in context.capabilities.settings.rules
        or "override" not in context.capabilities.system_variables
    ),
    sees=("system override",),
)
def read_overrides(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that set the override and cannot read it, and programs that read it."""
    nodes = list(walk(*program.modules))
    set_places = {id(node.target) for node in nodes if isinstance(node, ir.Assign) and _is_override(node.target)}
    read = [node for node in nodes if isinstance(node, ir.System) and _is_override(node) and id(node) not in set_places]
    if not read:
        return program
    context.diagnostics.report(KEPT, read[0].origin)
    kept = ir.Name(context.fresh("rpl_override"))

    def value(expression: ir.Expression) -> ir.Expression:
        return replace(kept, origin=expression.origin) if _is_override(expression) else rewrite_parts(expression, value)

    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Assign) and _is_override(statement.target):
            given = ir.Assign(kept, value(statement.value))
            return expansion(statement.origin, (given, replace(statement, value=kept)))
        return (rewrite_parts(statement, value, lambda body: map_body(body, change)),)

    modules = tuple(
        replace(
            module, routines=tuple(edit_bodies(one, lambda body: map_body(body, change)) for one in module.routines)
        )
        for module in program.modules
    )
    first = modules[0]
    data = ir.Variable(kept.id, ir.RealType(), ir.RealLiteral(_FULL_PERCENT), scope="global")
    home = ir.Module(context.fresh("rpl_overrides"), first.dialect, (data,), task=first.task, public=True)
    return replace(program, modules=(*modules, home))


def _is_override(node: object) -> bool:
    return isinstance(node, ir.System) and node.name == "override"


__all__ = ["read_overrides"]
