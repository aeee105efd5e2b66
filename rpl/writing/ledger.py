"""The emission ledger: proof that every node of a program was written, merged into another's text, or reported.

A writer marks each node as it deals with it. `check` compares the marks with the program and names what was missed, so
that a statement can never vanish in a template. Nodes are told apart by identity, and counted: a node that stands at
two places has to be dealt with twice.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator

from rpl import ir
from rpl.errors import InternalError
from rpl.ir.walk import bodies

Node = ir.Module | ir.Routine | ir.Declaration | ir.Statement
_SHOWN = 10


def blocks(node: ir.Statement | ir.Handler) -> tuple[ir.Body, ...]:
    """The statement lists directly inside a statement."""
    match node:
        case ir.If(branches=branches, otherwise=otherwise):
            return (*(body for _, body in branches), otherwise)
        case ir.Switch(cases=cases, default=default):
            return (*(case.body for case in cases), default or ())
        case ir.For(body=body) | ir.While(body=body) | ir.Repeat(body=body) | ir.Loop(body=body):
            return (body,)
        case ir.Handler(body=body):
            return (body,)
        case ir.Spline(body=body):
            return (body,)
        case ir.Instruction(parts=parts):
            return (parts,)
        case ir.Move(triggers=triggers):
            return (tuple(trigger for trigger in triggers if isinstance(trigger, ir.Trigger)),)
        case _:
            return ()


def inside(node: Node) -> Iterator[Node]:
    """The node and every node below it that has to be accounted for, in the order of the text."""
    yield node
    match node:
        case ir.Module(declarations=declarations, routines=routines):
            yield from declarations
            for routine in routines:
                yield from inside(routine)
        case ir.Routine():
            yield from node.declarations
            for body in bodies(node):
                yield from _inside_body(body)
        case (
            ir.Variable()
            | ir.VariableRows()
            | ir.RecordDeclaration()
            | ir.EnumDeclaration()
            | ir.AliasDeclaration()
            | ir.SignalDeclaration()
            | ir.ExternalDeclaration()
            | ir.Initialise()
            | ir.Unread()
        ):
            return
        case _:
            for body in blocks(node):
                yield from _inside_body(body)


def _inside_body(body: Iterable[ir.Statement]) -> Iterator[Node]:
    for statement in body:
        yield from inside(statement)


class EmissionLedger:
    """The marks of one writing. The three ways are exclusive in meaning, not in effect: any one accounts for the node.

    written: its own text stands in the output (its blocks are marked on their own). merged: it and all below it are
    part of another node's text. reported: it and all below it are not written; a diagnostic says so.
    """

    __slots__ = ("_kept", "_marks", "ways")

    def __init__(self) -> None:
        self._marks: Counter[int] = Counter()
        self._kept: list[Node] = []  # keeps the identities alive
        self.ways: Counter[str] = Counter()

    def written(self, node: Node) -> None:
        self._mark(node, "written")

    def merged(self, node: Node) -> None:
        for part in inside(node):
            self._mark(part, "merged")

    def reported(self, node: Node) -> None:
        for part in inside(node):
            self._mark(part, "reported")

    def handlers_reported(self, routine: ir.Routine) -> bool:
        """Mark what handles errors, undoes and steps back, for a target whose routines have no place for it, which its
        writer reports; is there any?"""
        lost = [statement for handler in routine.handlers for statement in handler.body]
        lost.extend((*routine.undo, *routine.backward))
        for statement in lost:
            self.reported(statement)
        return bool(routine.handlers or lost)

    def _mark(self, node: Node, way: str) -> None:
        self._marks[id(node)] += 1
        self._kept.append(node)
        self.ways[way] += 1

    def missed(self, program: ir.Program) -> list[Node]:
        """The nodes of the program that nobody accounted for, in order."""
        left = Counter(self._marks)
        missing = []
        for module in program.modules:
            for node in inside(module):
                if left[id(node)] > 0:
                    left[id(node)] -= 1
                else:
                    missing.append(node)
        return missing

    def check(self, program: ir.Program) -> None:
        """Raises InternalError that names the nodes missed."""
        missing = self.missed(program)
        if missing:
            shown = "; ".join(_place(node) for node in missing[:_SHOWN])
            more = f" and {len(missing) - _SHOWN} more" if len(missing) > _SHOWN else ""
            raise InternalError(f"{len(missing)} parts of the program were not written: {shown}{more}")


def _place(node: Node) -> str:
    name = getattr(node, "name", "")
    where = f" at {node.origin.file}:{node.origin.line}" if node.origin.source else ""
    return f"{node.__class__.__name__}{f' {name}' if isinstance(name, str) and name else ''}{where}"
