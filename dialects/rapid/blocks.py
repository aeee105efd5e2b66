"""Build IR from closed blocks: routines with their handlers, control structures, records, modules."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import TypeGuard

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.reading.pieces import Attribute, Block, Item, ModulePart, Section
from rpl.source import Origin

from .project import Project
from .signalparameters import with_signal_parameters
from .statements import ForHead, HandlerHead, ModuleHead, RecordHead, RoutineHead

MISPLACED = code("misplaced-declaration", Severity.WARNING, "a declaration stands where the controller takes none")
MISPLACED_STATEMENT = code(
    "misplaced-statement", Severity.ERROR, "a statement stands where the controller takes none", "it is kept as text"
)
SECOND_ELSE = code("second-default", Severity.ERROR, "a second ELSE or DEFAULT is never reached")

_DECLARATIONS = (ir.Variable, ir.RecordDeclaration, ir.AliasDeclaration, ir.Unread)


def is_statement(item: Item) -> TypeGuard[ir.Statement]:
    """What this dialect gives besides statements is declarations, routines, modules and their attributes."""
    return not isinstance(item, (*_DECLARATIONS, ir.Routine, Attribute, ModulePart))


def _value(data: object) -> ir.Expression:
    """The condition or selector that a structural statement brings; a promise of our own lowering."""
    assert isinstance(data, ir.Expression)
    return data


def _values(data: object) -> tuple[ir.Expression, ...]:
    """The values of a CASE; a promise of our own lowering."""
    assert isinstance(data, tuple)
    return tuple(map(_value, data))


@dataclass(frozen=True, slots=True)
class Handlers:
    """The sections of a routine behind its body."""

    errors: tuple[ir.Handler, ...]
    undo: ir.Body
    backward: ir.Body


class Blocks:
    """The `build` function of the assembler for one file."""

    def __init__(self, project: Project, diagnostics: Diagnostics) -> None:
        self.type_named = project.type_named
        self.diagnostics = diagnostics

    def build(self, block: Block) -> Item | tuple[Item, ...]:
        match block.open.kind:
            case "module":
                return self.module(block)
            case "routine":
                return self.routine(block)
            case "record":
                return self.record(block)
        bodies, others = [], []
        for section in block.sections:
            body, strange = self.divided(section)
            bodies.append(body)
            others.extend(strange)
        before: list[Item] = others
        made: ir.Statement
        match block.open.kind:
            case "if":
                made = self.if_block(block, bodies)
            case "for":
                made = self.for_block(block, bodies)
            case "while":
                made = self.while_block(block, bodies)
            case _:
                before = [*others, *self.before_cases(bodies[0])]
                made = self.test_block(block, bodies)
        return (*before, made) if before else made

    def divided(self, section: Section) -> tuple[ir.Body, list[Item]]:
        """Statements, and what does not belong into a block (declarations, routines after a missing end)."""
        kept = tuple(item for item in section.items if is_statement(item))
        if len(kept) == len(section.items):
            return kept, []
        others: list[Item] = [item for item in section.items if not is_statement(item)]
        for item in others:
            if isinstance(item, ir.Variable):
                self.diagnostics.report(MISPLACED, item.origin)
        return kept, others

    # ---- control structures

    def if_block(self, block: Block, bodies: list[ir.Body]) -> ir.If:
        branches: list[tuple[ir.Expression, ir.Body]] = [(_value(block.open.data), bodies[0])]
        otherwise: ir.Body = ()
        seen_else = False
        for section, body in zip(block.sections[1:], bodies[1:], strict=True):
            assert section.head is not None  # only the first section has no head
            if seen_else:
                self.diagnostics.report(SECOND_ELSE, section.head.origin)
                otherwise = (*otherwise, ir.Opaque(section.head.origin.text, origin=section.head.origin), *body)
            elif section.head.data is None:
                otherwise, seen_else = body, True
            else:
                branches.append((_value(section.head.data), body))
        return ir.If(tuple(branches), otherwise, origin=block.open.origin)

    def for_block(self, block: Block, bodies: list[ir.Body]) -> ir.For:
        head = block.open.data
        assert isinstance(head, ForHead)  # a promise of our own lowering
        return ir.For(
            head.counter,
            head.start,
            head.stop,
            head.step,
            bodies[0],
            automatic=head.step is None,
            at_least_once=True,
            scoped=True,
            origin=block.open.origin,
        )

    def while_block(self, block: Block, bodies: list[ir.Body]) -> ir.While:
        return ir.While(_value(block.open.data), bodies[0], origin=block.open.origin)

    def test_block(self, block: Block, bodies: list[ir.Body]) -> ir.Switch:
        cases: list[ir.Case] = []
        default: ir.Body | None = None
        for section, body in zip(block.sections, bodies, strict=True):
            if section.head is None:
                continue
            if section.head.data is None:
                if default is not None:
                    self.diagnostics.report(SECOND_ELSE, section.head.origin)
                    body = (ir.Opaque(section.head.origin.text, origin=section.head.origin), *body)
                default = body if default is None else (*default, *body)
            else:
                cases.append(ir.Case(_values(section.head.data), body, origin=section.head.origin))
        return ir.Switch(_value(block.open.data), tuple(cases), default, origin=block.open.origin)

    def before_cases(self, body: ir.Body) -> list[ir.Statement]:
        """What stands between TEST and the first CASE goes before the block: remarks as such, statements as text."""
        kept: list[ir.Statement] = []
        for statement in body:
            if isinstance(statement, ir.Nothing):
                kept.append(statement)
            else:
                self.diagnostics.report(MISPLACED_STATEMENT, statement.origin)
                kept.append(ir.Opaque(statement.origin.text, origin=statement.origin))
        return kept

    # ---- declarations

    def record(self, block: Block) -> Item | tuple[Item, ...]:
        """The components `num x;` were read as calls: the form is the same."""
        head = block.open.data
        assert isinstance(head, RecordHead)  # a promise of our own lowering
        fields: list[tuple[str, ir.Type]] = []
        strange: list[Item] = []
        for section in block.sections:
            for item in section.items:
                match item:
                    case ir.CallRoutine(name=type_name, arguments=(ir.Argument(value=ir.Name(id=field), name=None),)):
                        fields.append((field, self.type_named(type_name)))
                    case ir.CallRoutine(
                        name=type_name,
                        arguments=(ir.Argument(value=ir.Index(base=ir.Name(id=field), indices=sizes), name=None),),
                    ):
                        fields.append((field, ir.ArrayType(self.type_named(type_name), sizes)))
                    case ir.Nothing():
                        continue
                    case _:
                        strange.append(item)
        made = ir.RecordDeclaration(head.name, tuple(fields), head.scope, origin=block.open.origin)
        return (made, *strange) if strange else made

    def routine(self, block: Block) -> Item | tuple[Item, ...]:
        head = block.open.data
        assert isinstance(head, RoutineHead)  # a promise of our own lowering
        declarations: list[ir.Declaration] = []
        outside: list[Item] = []
        bodies: list[ir.Body] = []
        for section in block.sections:
            kept: list[ir.Statement] = []
            for item in section.items:
                if isinstance(item, ir.Variable | ir.AliasDeclaration | ir.RecordDeclaration):
                    declarations.append(replace(item, scope="routine"))
                elif isinstance(item, ir.Unread):
                    declarations.append(item)
                elif is_statement(item):
                    kept.append(item)
                elif isinstance(item, ir.Routine | ModulePart | Attribute):
                    outside.append(item)
            bodies.append(tuple(kept))
        handlers = self.handlers(block.sections[1:], bodies[1:])
        made = ir.Routine(
            head.name,
            head.kind,
            head.parameters,
            head.returns,
            tuple(declarations),
            bodies[0],
            handlers.errors,
            handlers.undo,
            handlers.backward,
            head.scope,
            origin=block.open.origin,
        )
        made = with_signal_parameters(made)
        return (made, *outside) if outside else made

    def handlers(self, sections: tuple[Section, ...], bodies: list[ir.Body]) -> Handlers:
        errors: list[ir.Handler] = []
        undo: ir.Body = ()
        backward: ir.Body = ()
        for section, body in zip(sections, bodies, strict=True):
            head = section.head.data if section.head else None
            assert section.head is not None and isinstance(head, HandlerHead)  # only the first section has none
            if head.kind == "error":
                errors.append(ir.Handler(head.codes, body, origin=section.head.origin))
            elif head.kind == "undo":
                undo = (*undo, *body)
            else:
                backward = (*backward, *body)
        return Handlers(tuple(errors), undo, backward)

    def module(self, block: Block) -> Item | tuple[Item, ...]:
        head = block.open.data
        assert isinstance(head, ModuleHead)  # a promise of our own lowering
        items = [item for section in block.sections for item in section.items]
        return part(head.name, head.attributes, items, block.open.origin, self.diagnostics)


def part(
    name: str, attributes: tuple[tuple[str, str], ...], items: Iterable[Item], origin: Origin, diagnostics: Diagnostics
) -> ModulePart | tuple[Item, ...]:
    """A module of what stands in it. Statements outside of routines are reported and kept as text."""
    declarations: list[ir.Declaration] = []
    routines: list[ir.Routine] = []
    inner: list[Item] = []
    for item in items:
        match item:
            case ir.Routine():
                routines.append(item)
            case ModulePart() | Attribute():
                inner.append(item)
            case ir.Nothing(origin=at) | ir.Opaque(origin=at):
                declarations.append(ir.Unread(item.text if isinstance(item, ir.Opaque) else "", origin=at))
            case ir.Variable() | ir.RecordDeclaration() | ir.AliasDeclaration() | ir.Unread():
                declarations.append(item)
            case _:
                diagnostics.report(MISPLACED_STATEMENT, item.origin)
                declarations.append(ir.Unread(item.origin.text, origin=item.origin))
    made = ModulePart(name, tuple(declarations), tuple(routines), attributes, origin)
    return (made, *inner) if inner else made
