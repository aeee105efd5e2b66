"""How the tool turns on an arc where the program does not say it: controllers start with different rules."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.entries import moving_entries
from rpl.passes.legalise.kinds import has_arcs
from rpl.passes.legalise.stages import legalising

_SETTING = "circle_orientation"
_USUAL = "base"


@legalising(
    unless=lambda context: (
        _at_start(context.source) == _at_start(context.target) or _SETTING not in context.capabilities.system_variables
    )
)
def circle_rules(program: ir.Program, context: Context) -> ir.Program:
    """Where the rules at the start differ, a routine that a program may start with sets the source's."""
    ours = _at_start(context.source)
    if not has_arcs(program):
        return program
    entries = moving_entries(program)
    rule = ir.Assign(ir.System(_SETTING), ir.EnumLiteral(ours))
    modules = tuple(
        replace(
            module,
            routines=tuple(
                replace(one, body=(rule, *one.body)) if one.body and one.name.lower() in entries else one
                for one in module.routines
            ),
        )
        for module in program.modules
    )
    return replace(program, modules=modules)


def _at_start(dialect: str) -> str:
    return str(rules_of(dialect).system_defaults.get(_SETTING, _USUAL))


__all__ = ["circle_rules"]
