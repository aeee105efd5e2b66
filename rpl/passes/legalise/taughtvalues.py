"""What is written as the present value of taught data: places, joints, tools and frames are taught anew on the target's
pendant, and a value that was worked out of them in the translation stays behind. Passes that have no other way name it.
"""

from __future__ import annotations

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.fold import is_taught_type
from rpl.passes.legalise.context import Context
from rpl.passes.scope import Scope
from rpl.source import Origin

WRITTEN = code(
    "taught-value-written",
    Severity.WARNING,
    "{what} is worked out of {names} as taught now, and does not follow when that is taught anew on the target",
    "teach what is written here anew together with it",
)


def taught_names(scope: Scope, *expressions: ir.Expression | None) -> list[str]:
    """Taught data of the program that the expressions name, in order of names."""
    given = tuple(one for one in expressions if one is not None)
    found: set[str] = set()
    for node in walk(*given):
        if isinstance(node, ir.Name):
            symbol = scope.value(node.id)
            declaration = None if symbol is None else symbol.declaration
            if isinstance(declaration, ir.Variable) and is_taught_type(declaration.type, scope):
                found.add(declaration.name)
    return sorted(found)


def tell_written(context: Context, scope: Scope, origin: Origin, what: str, *expressions: ir.Expression | None) -> None:
    """Report that the value of these expressions is written, where taught data decides it."""
    names = taught_names(scope, *expressions)
    if names:
        context.diagnostics.report(WRITTEN, origin, what=what, names=", ".join(names))


__all__ = ["WRITTEN", "taught_names", "tell_written"]
