"""RESET switches all outputs off. The neutral step for it is one assignment for each output that the project names:
what it never switches on is off anyway. Outputs whose numbers are computed are not known here, and this is said.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.ir.walk import rewrite, walk

SOME_COMPUTED = code(
    "vplus-reset-computed",
    Severity.WARNING,
    "RESET switches off the outputs that the project names; those whose numbers it computes are not among them",
)
_OUTPUTS = frozenset(("digital_out", "group_out"))


def resets_as_outputs(modules: tuple[ir.Module, ...], diagnostics: Diagnostics) -> tuple[ir.Module, ...]:
    """The modules with RESET as assignments, in the order of the numbers."""
    found = [node for node in walk(*modules) if isinstance(node, ir.Vendor) and _is_reset(node)]
    if not found:
        return modules
    outputs = [node for node in walk(*modules) if isinstance(node, ir.Signal) and node.kind in _OUTPUTS]
    numbers: set[int] = set()
    computed = False
    for signal in outputs:
        match signal.index, signal.last:
            case ir.IntLiteral(value=first), None:
                numbers.add(first)
            case ir.IntLiteral(value=first), ir.IntLiteral(value=last):
                numbers |= set(range(first, last + 1))
            case _:
                computed = True
    if computed:
        diagnostics.report(SOME_COMPUTED, found[0].origin)

    def change(node: object) -> object:
        if not isinstance(node, ir.Vendor) or not _is_reset(node):
            return node
        later = replace(node.origin, comments=())
        return tuple(
            ir.Assign(
                ir.Signal("digital_out", ir.IntLiteral(number)),
                ir.BoolLiteral(False),
                origin=later if at else node.origin,
            )
            for at, number in enumerate(sorted(numbers))
        ) or ir.Nothing(origin=node.origin)

    return tuple(rewrite(module, change) for module in modules)


def _is_reset(node: ir.Vendor) -> bool:
    return node.dialect == "vplus" and node.text.strip().lower() == "reset"


__all__ = ["resets_as_outputs"]
