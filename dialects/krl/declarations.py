"""KRL declarations to IR: variables, structures, enumerations, signals, routine headers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from lark import Token, Tree

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.reading.pieces import Element, Open
from rpl.reading.shapes import StatementError, SyntaxTree
from rpl.source import Origin

from . import tables
from .expressions import Expressions, Facts, Make, Pieces, Take

Lowered = Element | tuple[Element, ...]
Build = Callable[[Pieces, Origin], Lowered]
Bounds = Callable[[Pieces, Origin], tuple[ir.Expression | None, ...]]
MakeType = Callable[[Pieces, Origin], ir.Type]


@dataclass(frozen=True, slots=True)
class Header:
    """A routine's first line. Parameter types are declared in the lines that follow it."""

    name: str
    returns: ir.Type | None
    parameters: tuple[tuple[str, int, str], ...]  # name, dimensions written, mode
    everywhere: bool


class Declarations(Expressions):
    """Compiles what declares a name."""

    def __init__(self, facts: Facts, diagnostics: Diagnostics) -> None:
        super().__init__(facts, diagnostics)
        self.compiled: dict[int, tuple[SyntaxTree, Build]] = {}

    def definition(self, modifiers: SyntaxTree | None, tree: SyntaxTree) -> Build:
        words = {str(child).upper() for child in modifiers.children} if modifiers else set()
        everywhere = "GLOBAL" in words
        scope = "global" if everywhere else "module"
        kind = str(tree.data)
        if kind == "variables":
            return self.variables(tree, scope, "constant" if "CONST" in words else "variable")
        if kind == "procedure":
            return self.header(tree, None, everywhere)
        if kind == "function":
            return self.function(tree, everywhere)
        if kind == "record":
            return self.record(tree, scope)
        if kind == "enumeration":
            return self.enumeration(tree, scope)
        if kind == "signal":
            return self.signal_name(tree, scope)
        raise StatementError("this cannot be declared", 0)

    def on_raw_declaration(self, tree: SyntaxTree) -> Build:
        text = str(tree.children[0]).rstrip()
        head, _, rest = text.partition(" ")
        word = head.upper()
        words = rest.replace("(", " (").split()
        position = 1 if word.startswith(("EXTFCT", "EXTERNALFCT")) or word == "IMPORT" else 0
        name = words[position] if len(words) > position else (words[0] if words else word)
        return lambda pieces, origin: ir.ExternalDeclaration(name, text, origin=origin)

    def variables(self, tree: SyntaxTree, scope: str, storage: str) -> Build:
        type_name = self.name(tree.children[0])
        makes = [self.declarator(type_name, _tree(child), scope, storage) for child in tree.children[1:]]
        if len(makes) == 1:
            return makes[0]
        return lambda pieces, origin: tuple([make(pieces, origin) for make in makes])

    def declarator(
        self, type_name: Take, tree: SyntaxTree, scope: str, storage: str
    ) -> Callable[[Pieces, Origin], ir.Variable]:
        name = self.name(tree.children[0])
        type = self.declared_type(type_name, _brackets(tree))
        last = tree.children[-1]
        initial = self.expression(last) if isinstance(last, Tree) and last.data != "brackets" else None
        return lambda pieces, origin: ir.Variable(
            name(pieces),
            type(pieces, origin),
            initial(pieces, origin) if initial else None,
            storage,
            scope,
            origin=origin,
        )

    def declared_type(self, type_name: Take, brackets: SyntaxTree | None) -> MakeType:
        if brackets is None:
            return lambda pieces, origin: basic_type(type_name(pieces))
        bounds = self.optionals(brackets)

        def make(pieces: Pieces, origin: Origin) -> ir.Type:
            dimensions = tuple(bound(pieces, origin) if bound is not None else None for bound in bounds)
            return array_type(basic_type(type_name(pieces)), dimensions)

        return make

    def header(self, tree: SyntaxTree, returns: MakeType | None, everywhere: bool) -> Build:
        name_child = tree.children[-2] if _is(tree.children[-1], "parameters") else tree.children[-1]
        name = self.name(name_child)
        listed = _tree(tree.children[-1]).children if _is(tree.children[-1], "parameters") else []
        parameters = [self.parameter(_tree(child)) for child in listed]

        def make(pieces: Pieces, origin: Origin) -> Lowered:
            given = tuple((take(pieces), count, mode) for take, count, mode in parameters)
            kind = returns(pieces, origin) if returns else None
            return Open("routine", Header(name(pieces), kind, given, everywhere), origin)

        return make

    def function(self, tree: SyntaxTree, everywhere: bool) -> Build:
        return self.header(tree, self.declared_type(self.name(tree.children[0]), _brackets(tree)), everywhere)

    def parameter(self, tree: SyntaxTree) -> tuple[Take, int, str]:
        brackets = _brackets(tree)
        direction = next(
            (str(child).upper() for child in tree.children if isinstance(child, Token) and child.type == "DIRECTION"),
            "OUT",
        )
        count = len(brackets.children) if brackets else 0
        return self.name(tree.children[0]), count, "value" if direction == "IN" else "reference"

    def record(self, tree: SyntaxTree, scope: str) -> Build:
        name = self.name(tree.children[0])
        fields: list[tuple[Take, MakeType]] = []
        type_name: Take | None = None
        for child in tree.children[1:]:
            field = _tree(child)
            if field.data == "typed_field":
                type_name = self.name(field.children[0])
            if type_name is None:
                raise StatementError("the first component needs a type", 0)
            place = field.children[1] if field.data == "typed_field" else field.children[0]
            fields.append((self.name(place), self.declared_type(type_name, _brackets(field))))
        return lambda pieces, origin: ir.RecordDeclaration(
            name(pieces), tuple((take(pieces), type(pieces, origin)) for take, type in fields), scope, origin=origin
        )

    def enumeration(self, tree: SyntaxTree, scope: str) -> Build:
        name, *members = [self.name(child) for child in tree.children]
        return lambda pieces, origin: ir.EnumDeclaration(
            name(pieces), tuple(member(pieces) for member in members), scope, origin=origin
        )

    def signal_name(self, tree: SyntaxTree, scope: str) -> Build:
        name = self.name(tree.children[0])
        self.fixed_inputs = False
        makes: list[Make] = [self.expression(_tree(child)) for child in tree.children[1:]]
        self.fixed_inputs = True

        def make(pieces: Pieces, origin: Origin) -> Lowered:
            first, *rest = [value(pieces, origin) for value in makes]
            return ir.SignalDeclaration(name(pieces), _signal(first, rest, origin), scope, origin=origin)

        return make


def _signal(first: ir.Expression, rest: list[ir.Expression], origin: Origin) -> ir.Signal:
    """`$OUT[1]`, `$OUT[1] TO $OUT[8]`; anything else (FALSE, another system variable) is a signal by that name."""
    if isinstance(first, ir.Signal):
        if not rest:
            return first
        last = rest[0]
        if isinstance(last, ir.Signal) and last.kind == first.kind and first.kind in tables.GROUP_KINDS:
            return ir.Signal(tables.GROUP_KINDS[first.kind], first.index, last.index, origin=origin)
        raise StatementError("the range of a signal must be of one kind", 0)
    match first:
        case ir.BoolLiteral(value=value) if not rest:
            return ir.Signal("flag", name="TRUE" if value else "FALSE", origin=origin)
        case ir.Name(id=text) if not rest:
            return ir.Signal("flag", name=text, origin=origin)
        case ir.System(name="flag", indices=(index,)) if not rest:
            return ir.Signal("flag", index, origin=origin)
        case ir.Index(base=ir.Name(id=text), indices=(ir.IntLiteral(value=number),)) if not rest:
            return ir.Signal("flag", name=f"{text}[{number}]", origin=origin)
    raise StatementError("this is no signal", 0)


def basic_type(name: str) -> ir.Type:
    """The type that a type name means: KRL's own or a declared one."""
    return tables.BASIC_TYPES.get(name.lower()) or ir.NamedType(name)


def array_type(element: ir.Type, dimensions: tuple[ir.Expression | None, ...]) -> ir.Type:
    """The last dimension of a CHAR array is the capacity of a text."""
    if isinstance(element, ir.CharType):
        text = ir.StringType(dimensions[-1])
        return ir.ArrayType(text, dimensions[:-1]) if len(dimensions) > 1 else text
    return ir.ArrayType(element, dimensions)


def _brackets(tree: SyntaxTree) -> SyntaxTree | None:
    return next((child for child in tree.children if isinstance(child, Tree) and child.data == "brackets"), None)


def _is(child: object, kind: str) -> bool:
    return isinstance(child, Tree) and child.data == kind


def _tree(child: object) -> SyntaxTree:
    assert isinstance(child, Tree)  # the grammar says so
    return child
