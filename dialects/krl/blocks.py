"""Closed KRL blocks to IR nodes: loops, branches, splines, routines, data lists."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import cast, get_args

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.reading.pieces import Attribute, Block, Item, ModulePart

from .declarations import Header, array_type

LATE_DECLARATION = code(
    "krl-late-declaration",
    Severity.WARNING,
    "declared behind the first instruction; controllers refuse this",
    "move the declaration to the top of the routine",
)
MISPLACED = code("krl-misplaced", Severity.ERROR, "{what} cannot stand here")
NOT_IN_SWITCH = code(
    "krl-before-first-case", Severity.WARNING, "instructions between SWITCH and the first CASE are never executed"
)

_InSpline = ir.Move | ir.Trigger | ir.PathRule | ir.Assign | ir.CallRoutine | ir.Vendor | ir.Nothing | ir.Opaque
_DECLARATIONS = get_args(ir.Declaration)
_STATEMENTS = get_args(ir.Statement)


@dataclass(frozen=True, slots=True)
class DataList:
    """A built `.dat`: whether it is PUBLIC."""

    public: bool


class Builder:
    """Builds closed blocks; holds the collector and what a routine's block could not keep."""

    def __init__(self, diagnostics: Diagnostics) -> None:
        self.diagnostics = diagnostics

    def __call__(self, block: Block) -> Item | tuple[Item, ...]:
        kind = block.open.kind
        if kind == "routine":
            return self.routine(block)
        if kind == "data":
            return self.data(block)
        lifted = [item for section in block.sections for item in section.items if _is_outer(item)]
        built = self.statement(block)
        return (built, *lifted) if lifted else built

    def statement(self, block: Block) -> ir.Statement:
        origin, data = block.open.origin, block.open.data
        bodies = [self.body(section.items) for section in block.sections]
        match block.open.kind:
            case "if":
                return ir.If(((_expression(data), bodies[0]),), sum(bodies[1:], ()), origin=origin)
            case "switch":
                return self.switch(block, bodies)
            case "for":
                assert isinstance(data, tuple)
                counter, start, stop, step = data
                return ir.For(counter, start, stop, step, bodies[0], origin=origin)
            case "while":
                return ir.While(_expression(data), bodies[0], origin=origin)
            case "repeat":
                until = block.close.data if block.close else ir.BoolLiteral(True)
                return ir.Repeat(_expression(until), bodies[0], origin=origin)
            case "loop":
                return ir.Loop(bodies[0], origin=origin)
        return self.spline(block, bodies[0])

    def switch(self, block: Block, bodies: list[ir.Body]) -> ir.Statement:
        cases: list[ir.Case] = []
        default: ir.Body | None = None
        before = bodies[0]
        if any(not isinstance(statement, ir.Nothing) for statement in before):
            self.diagnostics.report(NOT_IN_SWITCH, block.open.origin)
        for section, body in zip(block.sections[1:], bodies[1:], strict=True):
            head = section.head
            whole, before = before + body, ()
            if head is not None and isinstance(head.data, tuple):
                cases.append(ir.Case(head.data, whole, origin=head.origin))
            else:
                default = whole
        return ir.Switch(_expression(block.open.data), tuple(cases), default, origin=block.open.origin)

    def spline(self, block: Block, body: ir.Body) -> ir.Statement:
        from .motion import blend_of

        assert isinstance(block.open.data, tuple)
        kind, words, settings = block.open.data
        origin = block.open.origin
        if block.close and isinstance(block.close.data, tuple):
            words = words + block.close.data
        kept: list[_InSpline] = []
        for statement in body:
            self.check_in_spline(kind, statement)
            if isinstance(statement, _InSpline):
                kept.append(statement)
            else:
                self.diagnostics.report(MISPLACED, statement.origin, what="this statement in a spline block")
                kept.append(ir.Opaque(statement.origin.text, origin=statement.origin))
        return ir.Spline(kind, tuple(kept), blend_of(words, origin), settings, origin=origin)

    def check_in_spline(self, kind: str, statement: ir.Statement) -> None:
        """KSS, spline chapters: a CP block has SPL, SLIN and SCIRC, and constant speeds; a PTP block has SPTP."""
        match statement:
            case ir.Move(kind="joint", motion_class="spline") if kind == "path":
                self.diagnostics.report(MISPLACED, statement.origin, what="SPTP in a SPLINE block")
            case ir.Move(kind=other, motion_class="spline") if kind == "joint" and other != "joint":
                self.diagnostics.report(MISPLACED, statement.origin, what="a path motion in a PTP_SPLINE block")
            case ir.Move(motion_class="classic"):
                self.diagnostics.report(MISPLACED, statement.origin, what="PTP, LIN or CIRC in a spline block")
            case ir.PathRule(rule="constant_start" | "constant_end") if kind == "joint":
                self.diagnostics.report(MISPLACED, statement.origin, what="CONST_VEL in a PTP_SPLINE block")

    def body(self, items: Iterable[Item]) -> ir.Body:
        """The statements of a section. Declarations inside of a block are executed by no controller: reported."""
        done: list[ir.Statement] = []
        for item in items:
            if isinstance(item, _STATEMENTS):
                done.append(item)
            elif isinstance(item, _DECLARATIONS):
                self.diagnostics.report(MISPLACED, item.origin, what="a declaration inside of a block")
                done.append(ir.Opaque(item.origin.text, origin=item.origin))
            elif not _is_outer(item):
                self.diagnostics.report(MISPLACED, item.origin, what="this line")
        return tuple(done)

    def routine(self, block: Block) -> Item | tuple[Item, ...]:
        header, origin = block.open.data, block.open.origin
        assert isinstance(header, Header)
        items = [item for section in block.sections for item in section.items]
        outer = [item for item in items if _is_outer(item)]
        declared: list[ir.Declaration] = []
        statements: list[Item] = []
        for item in items:
            if isinstance(item, _DECLARATIONS):
                if any(not isinstance(statement, ir.Nothing) for statement in statements):
                    self.diagnostics.report(LATE_DECLARATION, item.origin)
                declared.append(_local(item))
            elif isinstance(item, ir.Nothing) and not statements:
                declared.append(ir.Unread("", origin=item.origin))
            elif not _is_outer(item):
                statements.append(item)
        while declared and isinstance(declared[-1], ir.Unread):
            statements.insert(0, ir.Nothing(origin=declared.pop().origin))
        types = {d.name.lower(): d for d in declared if isinstance(d, ir.Variable)}
        names = {name.lower() for name, _, _ in header.parameters}
        routine = ir.Routine(
            header.name,
            "procedure" if header.returns is None else "function",
            tuple(_parameter(parameter, types) for parameter in header.parameters),
            header.returns,
            tuple(_without_parameters(declared, names)),
            self.body(statements),
            scope="global" if header.everywhere else "module",
            origin=origin,
        )
        return (routine, *outer) if outer else routine

    def data(self, block: Block) -> Item | tuple[Item, ...]:
        assert isinstance(block.open.data, tuple)
        name, public = block.open.data
        items = [item for section in block.sections for item in section.items]
        outer = [item for item in items if _is_outer(item)]
        declarations = tuple(found for item in items if not _is_outer(item) for found in self.datum(item))
        part = ModulePart(name, declarations, (), DataList(public), block.open.origin)
        return (part, *outer) if outer else part

    def datum(self, item: Item) -> tuple[ir.Declaration, ...]:
        """A line of a data list: variables live on between runs."""
        match item:
            case ir.Variable():
                return (item if item.storage == "constant" else replace(item, storage="persistent"),)
            case ir.Assign():
                return (ir.Initialise(item, origin=item.origin),)
            case ir.Nothing():
                return (ir.Unread("", origin=item.origin),)
            case ir.Opaque():
                return (ir.Unread(item.text, origin=item.origin),)
        if isinstance(item, _DECLARATIONS):
            return (item,)
        self.diagnostics.report(MISPLACED, item.origin, what="an instruction in a data list")
        return (ir.Unread(item.origin.text, origin=item.origin),)


def _is_outer(item: Item) -> bool:
    return isinstance(item, ir.Routine | Attribute | ModulePart)


def _expression(data: object) -> ir.Expression:
    assert isinstance(data, get_args(ir.Expression))
    return cast(ir.Expression, data)


def _local(declaration: ir.Declaration) -> ir.Declaration:
    """A routine's declaration: its own unless it says GLOBAL."""
    match declaration:
        case ir.Variable(scope="module") | ir.RecordDeclaration(scope="module") | ir.EnumDeclaration(scope="module"):
            return replace(declaration, scope="routine")
    return declaration


def _parameter(given: tuple[str, int, str], types: dict[str, ir.Variable]) -> ir.Parameter:
    """A parameter with the type declared behind DEF; without one it is a POS, as KRL takes any undeclared name."""
    name, dimensions, mode = given
    declared = types.get(name.lower())
    type: ir.Type = declared.type if declared else ir.TargetType("krl", external=False)
    if dimensions and not isinstance(type, ir.ArrayType | ir.StringType):
        type = array_type(type, (None,) * dimensions)
    return ir.Parameter(name, type, mode)


def _without_parameters(declared: list[ir.Declaration], names: set[str]) -> Iterable[ir.Declaration]:
    """The declarations that are no parameters; comments of those that are stay."""
    for declaration in declared:
        if isinstance(declaration, ir.Variable) and declaration.name.lower() in names:
            if declaration.origin.comments:
                yield ir.Unread("", origin=declaration.origin)
        else:
            yield declaration
