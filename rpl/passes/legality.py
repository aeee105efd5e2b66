"""What of a legalised program the target's tables do not have: one question for every target, behind all passes.

A pass takes a kind of node away; that it really did, nobody else checks. What is left over here is either what the
writer stops at (a guarded stop, reported at its place), or what it says in a form of its own
(`Capabilities.said_otherwise`). Anything else is a mistake of a pass or a gap in the target's tables.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import get_args

from rpl import ir
from rpl.diagnostics import Diagnostic, Diagnostics, Severity, code
from rpl.ir.walk import children, is_statement
from rpl.passes.capabilities import (
    Background,
    Capabilities,
    Composite,
    DataRule,
    MoveSetting,
    Parameters,
    Passing,
    PathRule,
    RoutineRule,
    SearchResult,
    TriggerRule,
)
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
_NUMBERED = re.compile("[A-Z]+[0-9]+")  # an element of a bank, by its name and number
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
    fine = EVERYWHERE.union(can.said_otherwise)
    yield from _shared(program, can)
    spelled = _spelled(program) if can.names.case_sensitive else {}
    stack: list[tuple[object, Origin]] = [(module, NOWHERE) for module in reversed(program.modules)]
    while stack:
        node, origin = stack.pop()
        if is_statement(node) or isinstance(node, _DECLARATIONS):
            origin = node.origin
        kind = kind_of(node, can)
        if isinstance(node, ir.Name) and node.id not in spelled.get(node.id.lower(), (node.id,)):
            kind = "name in another spelling"
        if kind and kind not in fine:
            yield Illegal(kind, origin)
        stack.extend((child, origin) for child in reversed(children(node)))


def _shared(program: ir.Program, can: Capabilities) -> Iterator[Illegal]:
    """Data that tasks declare for all of them by one name, where tasks have no data of their own."""
    if can.tasks.background is Background.SEPARATE:
        return
    tasks: dict[str, str] = {}
    for module in program.modules:
        for one in module.declarations:
            if not isinstance(one, ir.Variable) or (one.storage, one.scope) != ("persistent", "global"):
                continue
            if tasks.setdefault(one.name.lower(), module.task) != module.task:
                yield Illegal("data of several tasks", one.origin)


def _spelled(program: ir.Program) -> dict[str, set[str]]:
    """How what is declared is spelled, by its name in small letters."""
    spelled: dict[str, set[str]] = {}
    for module in program.modules:
        parts = (part for one in module.routines for part in (one, *one.parameters, *one.declarations))
        for part in (*module.declarations, *parts):
            if isinstance(part, ir.Variable | ir.Parameter | ir.Routine):
                spelled.setdefault(part.name.lower(), set()).add(part.name)
    return spelled


def kind_of(node: object, can: Capabilities) -> str:
    """The kind of a node that the tables do not have, empty where they have it."""
    match node:
        case ir.Rows():
            return ""  # its move is looked at
        case ir.System(name=name) if _of_record(name, can):
            return ""
        case ir.Trigger() if TriggerRule.OF_MOVES in can.motion.triggers or "DefineTrigger" in can.statements:
            return ""
        case ir.IntType() if "RealType" in can.types:
            return ""  # where whole numbers are no type of their own, they are numbers as all others
        case ir.ArrayType() if Composite.ARRAYS in can.data.composites:
            return ""
        case ir.NamedType() if can.data.composites & {Composite.RECORDS, Composite.ENUMS}:
            return ""
        case ir.Initialise() if DataRule.LISTS in can.data.rules:
            return ""
        case ir.Move(search=search) if search is not None and "Search" not in can.statements:
            return "search of a move"
        case ir.Handler() if not can.errors.handlers:
            return "handler of errors"
        case ir.Routine() | ir.Parameter() | ir.Variable():
            return _of_routine(node, can)
        case ir.TaskControl(op=op) if "TaskControl" in can.statements:
            return "" if op in can.tasks.operations else f"operation {op} of a task"
        case ir.CallRoutine(dynamic=name) if name is not None and RoutineRule.COMPUTED_NAMES not in can.routines.rules:
            return "call by a computed name"
        case ir.Search() if "Search" in can.statements:
            gives = (SearchResult.FOUND, node.found), (SearchResult.HIT, node.hit)
            lacks = any(one is not None and rule not in can.motion.search_results for rule, one in gives)
            return "result of a search" if lacks else ""
        case ir.Move() if kind := _of_move(node, can):
            return kind
        case ir.EnumDeclaration() if Composite.ENUMS not in can.data.composites:
            return "declaration EnumDeclaration"
        case ir.RecordDeclaration() if Composite.RECORDS not in can.data.composites:
            return "declaration RecordDeclaration"
        case ir.AliasDeclaration() if DataRule.ALIASES not in can.data.rules:
            return "declaration AliasDeclaration"
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


def _of_routine(node: ir.Routine | ir.Parameter | ir.Variable, can: Capabilities) -> str:
    """What the target's routines have not, or its data."""
    rules = can.routines
    match node:
        case ir.Parameter(optional=True) | ir.Parameter(switch=True) if Passing.OPTIONAL not in rules.passing:
            return "optional parameter"
        case ir.Parameter() if rules.parameters is Parameters.NONE:
            return "parameter"
        case ir.Routine(returns=ir.ArrayType()) if RoutineRule.LIST_RESULTS not in rules.rules:
            return "function that gives a list"
        case ir.Routine(returns=type) if type is not None and RoutineRule.FUNCTIONS not in rules.rules:
            return "function of the program"
        case ir.Routine(returns=ir.StringType()) if RoutineRule.TEXT_RESULTS not in rules.rules:
            return "function that gives a text"
        case ir.Variable(name=name, type=type) if type.__class__.__name__ in can.storage.banks:
            return "" if _NUMBERED.fullmatch(name) or name in can.storage.own else "datum without a number"
    return ""


def _of_move(move: ir.Move, can: Capabilities) -> str:
    """What the target's moves have not."""
    rules = can.motion
    if move.swept is not None and PathRule.ARCS_BY_ANGLE not in rules.paths:
        return "arc by its angle"
    if move.orientation == "wrist" and PathRule.EVEN_WRIST not in rules.paths:
        return "even turn of the wrist"
    if move.relative is not None and not rules.relative:
        return "relative move"
    return "concurrent move" if move.concurrent and not rules.concurrent else ""


def _of_record(name: str, can: Capabilities) -> bool:
    """Is the system variable a setting that moves say themselves, or data of a bank?"""
    banks = can.storage.banks.values()
    if name == "deceleration_percent":
        return MoveSetting.DECELERATION in can.settings.of_moves
    if name == "flag" and banks and can.io.last_flag == 0:
        return True
    return any(bank.holds == name for bank in banks)


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
