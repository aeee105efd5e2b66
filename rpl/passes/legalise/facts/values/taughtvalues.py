"""What is written as the present value of taught data: places, joints, tools and frames are taught anew on the target's
pendant, and a value that was worked out of them in the translation stays behind. Passes that have no other way name it.
"""

from __future__ import annotations

from dataclasses import dataclass

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.fold import is_taught_type
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.settingsinforce import SettingsInForce
from rpl.passes.scope import Scope
from rpl.source import Origin

WRITTEN = code(
    "taught-value-written",
    Severity.WARNING,
    "{what}: worked out of {names} as taught now, and it stays where it is when that is taught anew on the target",
    "teach what is written here anew together with it",
)


def taught_names(scope: Scope, *expressions: ir.Expression | None) -> list[str]:
    """Taught data of the program that decides what the expressions give, in order of names: what they name, and what
    the numbers and records that they name begin with. What the language predefines is never taught."""
    found: set[str] = set()
    pending = [one for one in expressions if one is not None]
    seen: set[str] = set()
    while pending:
        for node in walk(pending.pop()):
            if not isinstance(node, ir.Name) or node.id in seen:
                continue
            seen.add(node.id)
            symbol = scope.value(node.id)
            if symbol is None or (symbol.module is None and symbol.routine is None):
                continue
            declaration = symbol.declaration
            if not isinstance(declaration, ir.Variable):
                continue
            if is_taught_type(declaration.type, scope):
                found.add(declaration.name)
            elif declaration.initial is not None:
                pending.append(declaration.initial)
    return sorted(found)


def tell_written(context: Context, scope: Scope, origin: Origin, what: str, *expressions: ir.Expression | None) -> None:
    """Report that the value of these expressions is written, where taught data decides it."""
    names = taught_names(scope, *expressions)
    if names:
        context.diagnostics.report(WRITTEN, origin, what=what, names=", ".join(names))


@dataclass(slots=True)
class JointsOfPlaces:
    """Names what decides the joints that are written for a place: the place, and the tool and the frame of the move.
    The program is followed only where there is something to tell."""

    program: ir.Program
    context: Context
    flow: SettingsInForce | None = None

    def tell(self, move: ir.Move, scope: Scope, place: ir.Expression) -> None:
        """Of a move of this program."""
        if self.flow is None:
            self.flow = SettingsInForce.begun_by(self.program, self.context.source)
        state = self.flow.at(move)
        seen = (move.tool or state["tool"], move.frame or state["base"])
        tell_written(self.context, scope, move.origin, "the joint values of this move", place, *seen)


__all__ = ["WRITTEN", "JointsOfPlaces", "taught_names", "tell_written"]
