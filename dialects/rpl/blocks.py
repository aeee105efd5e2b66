"""Blocks of RPL: which statements open, divide and close them, and the IR that a closed block becomes."""

from __future__ import annotations

from dataclasses import dataclass, replace

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.ir.walk import is_expression, is_statement
from rpl.reading.pieces import Attribute, Block, Close, Element, Item, Middle, ModulePart, Open, Section
from rpl.reading.shapes import StatementError, SyntaxTree

from .declarations import DECLARATIONS, module_head, routine_head
from .expressions import Reading, expression, first, names, tokens, trees, wording
from .motion import ALL_STATEMENTS, spline_head

MISPLACED = code("misplaced-part", Severity.ERROR, "{what} cannot stand here")

DECLARED = (
    ir.Variable,
    ir.RecordDeclaration,
    ir.EnumDeclaration,
    ir.AliasDeclaration,
    ir.SignalDeclaration,
    ir.ExternalDeclaration,
    ir.Initialise,
    ir.Unread,
)
_ENDS = {
    "end_if": "if",
    "end_switch": "switch",
    "end_for": "for",
    "end_while": "while",
    "end_loop": "loop",
    "end_spline": "spline",
    "end_routine": "routine",
    "end_module": "module",
}
_SECTIONS = {"else_": "if", "default": "switch", "begin": "routine", "undo": "routine", "backward": "routine"}


def lower(tree: SyntaxTree, at: Reading) -> Element | tuple[Element, ...]:
    """One statement: a plain one, a declaration, or a part of a block's frame."""
    kind = str(tree.data)
    plain = ALL_STATEMENTS.get(kind)
    if plain is not None:
        return plain(tree, at)
    declaration = DECLARATIONS.get(kind)
    if declaration is not None:
        return declaration(tree, at)
    if kind in _ENDS:
        return Close(_ENDS[kind], None, at.origin)
    if kind in _SECTIONS:
        return Middle(_SECTIONS[kind], kind, at.origin)
    return _frame(kind, tree, at)


def _frame(kind: str, tree: SyntaxTree, at: Reading) -> Element:
    match kind:
        case "if_short":
            condition, inner = trees(tree)
            body = ALL_STATEMENTS[inner.data](inner, at)
            return ir.If(((expression(condition, at), (body,)),), origin=at.origin)
        case "if_open":
            return Open("if", first(tree, at), at.origin)
        case "elseif":
            return Middle("if", first(tree, at), at.origin)
        case "switch_open":
            return Open("switch", first(tree, at), at.origin)
        case "case":
            return Middle("switch", tuple(expression(value, at) for value in trees(tree)), at.origin)
        case "for_open":
            return Open("for", _for_head(tree, at), at.origin)
        case "while_open":
            return Open("while", first(tree, at), at.origin)
        case "repeat_open":
            return Open("repeat", None, at.origin)
        case "until":
            return Close("repeat", first(tree, at), at.origin)
        case "loop_open":
            return Open("loop", None, at.origin)
        case "spline_open":
            return Open("spline", spline_head(tree, at), at.origin)
        case "routine_open":
            return Open("routine", routine_head(tree, at), at.origin)
        case "handler":
            return Middle("routine", tuple(expression(value, at) for value in trees(tree)), at.origin)
        case "module_open":
            return Open("module", module_head(tree, at), at.origin)
    raise StatementError(f"no meaning is known for {kind}", 0)


def _for_head(tree: SyntaxTree, at: Reading) -> ir.For:
    start, stop, *rest = trees(tree)
    rules = {wording(token) for token in tokens(tree, "FOR_RULE")}
    return ir.For(
        names(tree)[0],
        expression(start, at),
        expression(stop, at),
        first(rest[0], at) if rest else None,
        (),
        "either way" in rules,
        "at least once" in rules,
        "scoped" in rules,
        "keeps last" in rules,
        origin=at.origin,
    )


def _value(data: object) -> ir.Expression:
    """The condition or selector that a statement brings to its block; a promise of our own lowering."""
    assert is_expression(data)
    return data


def _values(data: object) -> tuple[ir.Expression, ...]:
    """The values of a CASE, the errors of a handler; a promise of our own lowering."""
    assert isinstance(data, tuple)
    return tuple(map(_value, data))


@dataclass(frozen=True, slots=True)
class Builder:
    """Builds closed blocks. What stands at the wrong place is reported and kept as text; a routine or module inside
    another one (whose end is missing) is handed outwards."""

    diagnostics: Diagnostics

    def build(self, block: Block) -> Item | tuple[Item, ...]:
        match block.open.kind:
            case "module":
                return self._module(block)
            case "routine":
                return self._routine(block)
        outward: list[Item] = []
        done = self._statement(block, outward)
        return (done, *outward) if outward else done

    def _statement(self, block: Block, outward: list[Item]) -> ir.Statement:
        origin, data = block.open.origin, block.open.data
        if block.open.kind == "if":
            return self._if(block, outward)
        if block.open.kind == "switch":
            return self._switch(block, outward)
        body = self.body(block.sections[0], outward)
        match block.open.kind, data:
            case "for", ir.For():
                return replace(data, body=body, origin=origin)
            case "spline", ir.Spline():
                return replace(data, body=self._spline_body(body), origin=origin)
            case "loop", _:
                return ir.Loop(body, origin=origin)
            case "repeat", _:
                until = _value(block.close.data) if block.close else ir.BoolLiteral(True)
                return ir.Repeat(until, body, origin=origin)
        return ir.While(_value(data), body, origin=origin)

    def body(self, section: Section, outward: list[Item]) -> ir.Body:
        """The statements of a section."""
        body: list[ir.Statement] = []
        for item in section.items:
            if is_statement(item):
                body.append(item)
            elif isinstance(item, ir.Routine | ModulePart):
                outward.append(item)
            else:
                body.append(self._misplaced(item))
        return tuple(body)

    def _misplaced(self, item: Item | Middle) -> ir.Opaque:
        text = item.origin.text
        self.diagnostics.report(MISPLACED, item.origin, what=text.split("\n")[0].strip()[:60] or "this")
        return ir.Opaque(text, origin=item.origin)

    def _if(self, block: Block, outward: list[Item]) -> ir.Statement:
        branches: list[tuple[ir.Expression, ir.Body]] = []
        otherwise: ir.Body = ()
        condition = block.open.data
        ended = False
        for section in block.sections:
            body = self.body(section, outward)
            if section.head is not None and ended:
                body = (self._misplaced(section.head), *body)
            if ended or (section.head is not None and section.head.data == "else_"):
                ended, otherwise = True, (*otherwise, *body)
                continue
            if section.head is not None:
                condition = section.head.data
            branches.append((_value(condition), body))
        return ir.If(tuple(branches), otherwise, origin=block.open.origin)

    def _switch(self, block: Block, outward: list[Item]) -> ir.Statement:
        cases: list[ir.Case] = []
        default: ir.Body | None = None
        for section in block.sections:
            body = self.body(section, outward)
            if section.head is None:
                for item in body:
                    if not isinstance(item, ir.Nothing):
                        self._misplaced(item)
                lead = body
            elif section.head.data == "default":
                default = body if default is None else (*default, self._misplaced(section.head), *body)
            else:
                cases.append(ir.Case(_values(section.head.data), body, origin=section.head.origin))
        comments = tuple(comment for item in lead for comment in item.origin.comments)
        origin = block.open.origin
        if comments:
            origin = replace(origin, comments=(*origin.comments, *comments))
        return ir.Switch(_value(block.open.data), tuple(cases), default, origin=origin)

    def _spline_body(
        self, body: ir.Body
    ) -> tuple[
        ir.Move | ir.Trigger | ir.PathRule | ir.Assign | ir.CallRoutine | ir.Vendor | ir.Nothing | ir.Opaque, ...
    ]:
        allowed = (ir.Move, ir.Trigger, ir.PathRule, ir.Assign, ir.CallRoutine, ir.Vendor, ir.Nothing, ir.Opaque)
        return tuple(item if isinstance(item, allowed) else self._misplaced(item) for item in body)

    def _routine(self, block: Block) -> Item | tuple[Item, ...]:
        head = block.open.data
        outward: list[Item] = []
        declarations: list[ir.Declaration] = []
        body: ir.Body = ()
        handlers: list[ir.Handler] = []
        undo: ir.Body = ()
        backward: ir.Body = ()
        begun = any(section.head is not None and section.head.data == "begin" for section in block.sections)
        for section in block.sections:
            match section.head.data if section.head is not None else None:
                case None:
                    rest = self._declared(section, declarations, begun)
                    body = self.body(rest, outward)
                case "begin":
                    body = (*body, *self.body(section, outward))
                case "undo":
                    undo = (*undo, *self.body(section, outward))
                case "backward":
                    backward = (*backward, *self.body(section, outward))
                case codes:
                    origin = section.head.origin if section.head else block.open.origin
                    handlers.append(ir.Handler(_values(codes), self.body(section, outward), origin=origin))
        if not isinstance(head, ir.Routine):
            return tuple(outward)
        done = replace(
            head,
            declarations=tuple(declarations),
            body=body,
            handlers=tuple(handlers),
            undo=undo,
            backward=backward,
            origin=block.open.origin,
        )
        return (done, *outward) if outward else done

    def _declared(self, section: Section, declarations: list[ir.Declaration], begun: bool) -> Section:
        """Take the declarations from the front of a routine; what is left is its body. Comments that stand for
        themselves between declarations are declarations too."""
        items = section.items
        last = max((at for at, item in enumerate(items) if isinstance(item, DECLARED)), default=-1)
        last = len(items) - 1 if begun else last
        for at, item in enumerate(items[: last + 1]):
            if isinstance(item, ir.Nothing):
                declarations.append(ir.Unread("", origin=item.origin))
            elif isinstance(item, DECLARED):
                declarations.append(scoped(item, "routine"))
            else:
                # The first statement begins the body; a declaration behind it is refused there.
                return Section(None, items[at:])
        return Section(None, items[last + 1 :])

    def _module(self, block: Block) -> Item | tuple[Item, ...]:
        head = block.open.data
        if not isinstance(head, ir.Module):
            return ()
        outward: list[Item] = []
        declarations: list[ir.Declaration] = []
        routines: list[ir.Routine] = []
        attributes: list[tuple[str, str]] = []
        for item in block.sections[0].items:
            if isinstance(item, ir.Routine):
                routines.append(item)
            elif isinstance(item, Attribute):
                attributes.append((item.name, item.value))
            elif isinstance(item, ModulePart):
                outward.append(item)
            elif isinstance(item, ir.Nothing):
                declarations.append(ir.Unread("", origin=item.origin))
            elif isinstance(item, DECLARED):
                declarations.append(scoped(item, "module"))
            elif isinstance(item, ir.Opaque):
                declarations.append(ir.Unread(item.text, origin=item.origin))
            else:
                declarations.append(ir.Unread(self._misplaced(item).text, origin=item.origin))
        module = replace(
            head,
            declarations=tuple(declarations),
            routines=tuple(routines),
            attributes=tuple(attributes),
            origin=block.open.origin,
        )
        part: Item = ModulePart(module.name, (), (), module, block.open.origin)
        return (part, *outward) if outward else part


def scoped(declaration: ir.Declaration, default: str) -> ir.Declaration:
    """The declaration with the scope of its place when none was written."""
    match declaration:
        case (
            ir.Variable(scope="")
            | ir.RecordDeclaration(scope="")
            | ir.EnumDeclaration(scope="")
            | ir.AliasDeclaration(scope="")
            | ir.SignalDeclaration(scope="")
        ):
            return replace(declaration, scope=default)
    return declaration
