"""An override that a program reads, for targets whose programs can set it but not read it: a variable holds what was
set last. What the operator sets by hand is not seen then.
"""

from __future__ import annotations

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.capabilities import SettingRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.shadows import Shadow, with_shadows
from rpl.passes.legalise.stages import legalising

KEPT = code(
    "override-kept",
    Severity.WARNING,
    "the target's programs cannot read the override; a variable keeps what this program sets, not what is set by hand",
)
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
    nodes = list(walk_for({"Assign", "system override"}, *program.modules))
    set_places = {id(node.target) for node in nodes if isinstance(node, ir.Assign) and _is_override(node.target)}
    read = [node for node in nodes if isinstance(node, ir.System) and _is_override(node) and id(node) not in set_places]
    if not read:
        return program
    context.diagnostics.report(KEPT, read[0].origin)
    kept = Shadow(ir.Name(context.fresh("rpl_override")), ir.RealLiteral(_FULL_PERCENT))
    return with_shadows(program, context, {"override": kept})


def _is_override(node: object) -> bool:
    return isinstance(node, ir.System) and node.name == "override"


__all__ = ["read_overrides"]
