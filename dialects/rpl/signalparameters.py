"""Parameters of a routine that are signals: the body means the signal that was passed, by the parameter's name.

Only for modules that run by RPL's own rules; what was read from another language says it as that language does.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.ir.words import NATIVE


def with_signal_parameters(module: ir.Module) -> ir.Module:
    """The module with its signal parameters said as signals wherever they are used."""
    if module.dialect != NATIVE:
        return module
    routines = tuple(map(_said, module.routines))
    return module if routines == module.routines else replace(module, routines=routines)


def _said(routine: ir.Routine) -> ir.Routine:
    kinds = {one.name.lower(): one.type.kind for one in routine.parameters if isinstance(one.type, ir.SignalType)}

    def signal(node: object) -> object:
        if isinstance(node, ir.Name) and node.id.lower() in kinds:
            return ir.Signal(kinds[node.id.lower()], name=node.id, origin=node.origin)
        return node

    return rewrite(routine, signal) if kinds else routine
