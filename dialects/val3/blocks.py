"""Closed VAL3 blocks to IR nodes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import cast, get_args

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.ir.walk import walk
from rpl.reading.pieces import Block, Item

from .expressions import TYPES
from .facts import Declared, Header

MISPLACED = code("val3-misplaced", Severity.ERROR, "{what} cannot stand here")
BEFORE_CASE = code(
    "val3-before-first-case", Severity.WARNING, "statements between switch and the first case are never executed"
)
UNKNOWN_TYPE = code("val3-unknown-type", Severity.LOSS, "{name}: data of the type {kind} cannot be read")

_STATEMENTS = get_args(ir.Statement)


class Builder:
    """Builds closed blocks. `facts` of signals that parameters stand for are those of their use in the body."""

    def __init__(self, diagnostics: Diagnostics) -> None:
        self.diagnostics = diagnostics

    def __call__(self, block: Block) -> Item:
        origin, data = block.open.origin, block.open.data
        if block.open.kind == "program":
            return self.program(block)
        bodies = [self.body(section.items) for section in block.sections]
        match block.open.kind:
            case "if":
                branches = [(_expression(data), bodies[0])]
                otherwise: ir.Body = ()
                for section, body in zip(block.sections[1:], bodies[1:], strict=True):
                    head = section.head.data if section.head is not None else None
                    if head is None:
                        otherwise = otherwise + body
                    else:
                        branches.append((_expression(head), body))
                return ir.If(tuple(branches), otherwise, origin=origin)
            case "while":
                return ir.While(_expression(data), bodies[0], origin=origin)
            case "for":
                counter, start, stop, step = cast(tuple[str, ir.Expression, ir.Expression, ir.Expression | None], data)
                return ir.For(counter, start, stop, step, bodies[0], origin=origin)
            case "switch":
                return self.switch(block, bodies)
        until = block.close.data if block.close else ir.BoolLiteral(True)
        return ir.Repeat(_expression(until), bodies[0], origin=origin)

    def switch(self, block: Block, bodies: list[ir.Body]) -> ir.Statement:
        """`break` ends each case; a case without one ends where the next begins (M)."""
        cases: list[ir.Case] = []
        default: ir.Body | None = None
        before = bodies[0]
        if any(not isinstance(statement, ir.Nothing) for statement in before):
            self.diagnostics.report(BEFORE_CASE, block.open.origin)
            before = ()
        for section, body in zip(block.sections[1:], bodies[1:], strict=True):
            head = section.head
            if body and isinstance(body[-1], ir.ExitLoop):
                body = body[:-1]
            if any(isinstance(one, ir.ExitLoop) for one in body) and head is not None:
                self.diagnostics.report(MISPLACED, head.origin, what="a break inside of a case")
            whole, before = before + body, ()
            if head is not None and isinstance(head.data, tuple):
                cases.append(ir.Case(head.data, whole, origin=head.origin))
            else:
                default = whole
        return ir.Switch(_expression(block.open.data), tuple(cases), default, origin=block.open.origin)

    def body(self, items: Iterable[Item]) -> ir.Body:
        done: list[ir.Statement] = []
        for item in items:
            if isinstance(item, _STATEMENTS):
                done.append(item)
            else:
                self.diagnostics.report(MISPLACED, item.origin, what="a program inside of a block")
        return tuple(done)

    def program(self, block: Block) -> Item:
        header, helpers = cast(tuple[Header, list[ir.Variable]], block.open.data)
        body = self.body([item for section in block.sections for item in section.items])
        declared = tuple(one for local in header.locals for one in self.local(local, block))
        return ir.Routine(
            header.name,
            parameters=tuple(_parameter(one, body) for one in header.parameters),
            declarations=(*declared, *helpers),
            body=body,
            scope="global",
            origin=block.open.origin,
        )

    def local(self, declared: Declared, block: Block) -> Iterable[ir.Variable]:
        type = TYPES.get(declared.kind)
        if type is None:
            if declared.kind not in ("dio", "aio", "config"):
                self.diagnostics.report(UNKNOWN_TYPE, block.open.origin, name=declared.name, kind=declared.kind)
            return
        initial = zero(declared.kind, declared.sizes)
        yield ir.Variable(declared.name, sized(type, declared.sizes), initial, scope="routine")


def _parameter(declared: Declared, body: ir.Body) -> ir.Parameter:
    if declared.kind in ("dio", "aio"):
        out = any(
            isinstance(node, ir.Assign) and isinstance(node.target, ir.Signal) and node.target.name == declared.name
            for node in walk(*body)
        )
        kind = f"{'digital' if declared.kind == 'dio' else 'analog'}_{'out' if out else 'in'}"
        return ir.Parameter(declared.name, ir.SignalType(kind))
    type = TYPES.get(declared.kind, ir.VendorType("val3", declared.kind))
    mode = "reference" if declared.reference or declared.sizes != (1,) else "value"
    return ir.Parameter(declared.name, sized(type, declared.sizes), mode)


def sized(type: ir.Type, sizes: tuple[int, ...]) -> ir.Type:
    """The type of a datum of so many elements in each dimension; 0: as many as are given."""
    if sizes == (1,):
        return type
    return ir.ArrayType(type, tuple(ir.IntLiteral(size - 1) if size else None for size in sizes), base=0)


def zero(kind: str, sizes: tuple[int, ...] = (1,)) -> ir.Expression | None:
    """What local data begins with."""
    if sizes != (1,):
        return None
    match kind:
        case "num":
            return ir.RealLiteral(0.0)
        case "bool":
            return ir.BoolLiteral(False)
    return ir.TextLiteral("") if kind == "string" else None


def _expression(data: object) -> ir.Expression:
    assert isinstance(data, get_args(ir.Expression))
    return cast(ir.Expression, data)
