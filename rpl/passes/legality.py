"""What of a legalised program the target's tables do not have: one question for every target, behind all passes.

A pass takes a kind of node away; that it really did, nobody else checks. What is left over here is either what the
writer stops at (a guarded stop, reported at its place), or what it says in a form of its own
(`Capabilities.said_otherwise`). Anything else is a mistake of a pass or a gap in the target's tables.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import get_args

from rpl import ir
from rpl.diagnostics import Diagnostic, Diagnostics, Severity, code
from rpl.ir.walk import children, is_statement
from rpl.passes.capabilities import Capabilities
from rpl.source import NOWHERE, Origin

LEFT_OVER = code(
    "not-in-the-target",
    Severity.WARNING,
    "the target's tables do not have this {kind}, and the line was written nevertheless",
    "look at the written line before it runs",
)

# Types that no table lists: nothing is written for them, or what is wrong with them is reported where they stand.
EVERYWHERE = frozenset(("type TargetType", "type UnknownType", "type SignalType"))
_TYPES = frozenset(get_args(ir.Type))
_DECLARATIONS = (
    *(ir.Variable, ir.RecordDeclaration, ir.EnumDeclaration, ir.AliasDeclaration, ir.SignalDeclaration),
    *(ir.ExternalDeclaration, ir.Routine),
)


@dataclass(frozen=True, slots=True)
class Illegal:
    """A node that the target's tables do not have. kind: `statement Trigger`, `procedure P`, `function text_equal`,
    `operator cand`, `system variable S`, `type IntType`; origin: of the statement or declaration it stands in."""

    kind: str
    origin: Origin


def illegal(program: ir.Program, can: Capabilities) -> Iterator[Illegal]:
    """Every node of the program that the tables do not have, in the program's order. One walk."""
    fine = can.said_otherwise | EVERYWHERE
    stack: list[tuple[object, Origin]] = [(module, NOWHERE) for module in reversed(program.modules)]
    while stack:
        node, origin = stack.pop()
        if is_statement(node) or isinstance(node, _DECLARATIONS):
            origin = node.origin
        kind = kind_of(node, can)
        if kind and kind not in fine:
            yield Illegal(kind, origin)
        stack.extend((child, origin) for child in reversed(children(node)))


def kind_of(node: object, can: Capabilities) -> str:
    """The kind of a node that the tables do not have, empty where they have it."""
    match node:
        case ir.Do(procedure=name):
            return "" if name in can.procedures else f"procedure {name}"
        case ir.Builtin(function=name):
            return "" if name in can.functions or name in can.places.move_functions else f"function {name}"
        case ir.System(name=name):
            return "" if name in can.system_variables else f"system variable {name}"
        case ir.Binary(op=op) | ir.Unary(op=op):
            return "" if op in can.operators or op in can.places.move_functions else f"operator {op}"
    name = node.__class__.__name__
    if is_statement(node):
        return "" if name in can.statements else f"statement {name}"
    return f"type {name}" if node.__class__ in _TYPES and name not in can.types else ""


def unguarded(program: ir.Program, can: Capabilities, reported: Collection[Diagnostic]) -> list[Illegal]:
    """What is illegal at a place where nothing was reported, each kind once a line. reported: of the legalisation and
    of the writing; what the writer stops at is a loss at the statement's place."""
    places = {(item.origin.file, item.origin.line) for item in reported if item.severity == Severity.LOSS}
    found = {(one.kind, one.origin.file, one.origin.line): one for one in illegal(program, can)}
    return [one for (_, *place), one in found.items() if tuple(place) not in places]


def report(found: Collection[Illegal], diagnostics: Diagnostics) -> None:
    """Say what is left over, at its place."""
    for one in found:
        diagnostics.report(LEFT_OVER, one.origin, kind=one.kind)
