"""Lower one RAPID statement: structural statements to Open, Middle and Close, everything else to IR."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

from lark import Token, Tree

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.reading.pieces import Attribute, Close, Element, Middle, Open
from rpl.reading.shapes import Slot, SyntaxTree
from rpl.source import Origin

from .arguments import Arguments
from .expressions import Children, Expressions, Values, leaf, word_of
from .instructions import INSTRUCTIONS, SHOWN_WAITING
from .project import Project
from .vendor import EFFECTS

PLACEHOLDER = code(
    "placeholder",
    Severity.WARNING,
    "{text} is a placeholder that the editor left behind",
    "the controller stops there with an error; so does a run",
)
IGNORED = code("option-without-effect", Severity.INFO, "{option} changes nothing in a run and is left out")

_STATEMENT = re.compile(r'(?:"(?:[^"\r\n]|"")*"|![^\r\n]*|[^;"!])*;?')
_IGNORED_OPTIONS = {
    "sync": "\\Sync",
    "pollrate": "\\PollRate",
    "sup": "\\Sup",
    **{name: f"\\{name.capitalize()}" for name in SHOWN_WAITING},
}
_STORAGE = {"CONST": "constant", "VAR": "variable", "PERS": "persistent"}
_ENDS = {"endif": "if", "endfor": "for", "endwhile": "while", "endtest": "test"}


@dataclass(frozen=True, slots=True)
class RoutineHead:
    """What a routine header says."""

    kind: str
    name: str
    parameters: tuple[ir.Parameter, ...]
    returns: ir.Type | None
    scope: str


@dataclass(frozen=True, slots=True)
class ModuleHead:
    name: str
    attributes: tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class RecordHead:
    name: str
    scope: str


@dataclass(frozen=True, slots=True)
class HandlerHead:
    """A section behind a routine's body: error (with its codes), undo, backward."""

    kind: str
    codes: tuple[ir.Expression, ...] = ()


@dataclass(frozen=True, slots=True)
class ForHead:
    counter: str
    start: ir.Expression
    stop: ir.Expression
    step: ir.Expression | None


class Statements:
    """Lowers the statements of one file."""

    def __init__(self, project: Project, path: str, diagnostics: Diagnostics) -> None:
        self.expressions = Expressions(project, path)
        self.value = self.expressions.lower
        self.type_named = project.type_named
        self.diagnostics = diagnostics
        self.simple: dict[str, Callable[[Children, Values, Origin], ir.Statement | tuple[ir.Statement, ...]]] = {
            "assign": self.assign,
            "call": self.call,
            "late_call": self.late_call,
            "compact_if": self.compact_if,
            "goto": lambda children, values, origin: ir.Goto(leaf(children[0], values), origin=origin),
            "return": lambda children, values, origin: ir.Return(self.optional(children, values), origin=origin),
            "raise": lambda children, values, origin: ir.Raise(self.optional(children, values), origin=origin),
            "retry": lambda children, values, origin: ir.Retry(origin=origin),
            "trynext": lambda children, values, origin: ir.TryNext(origin=origin),
            "exit": lambda children, values, origin: ir.Halt("exit", origin=origin),
            "connect": self.connect,
        }
        self.rules: dict[str, Callable[[Children, Values, Origin], Element | tuple[Element, ...]]] = {
            **self.simple,
            "label": lambda children, values, origin: ir.Label(leaf(children[0], values), origin=origin),
            "empty": lambda children, values, origin: ir.Nothing(origin=origin),
            "data": self.data,
            "alias": self.alias,
            "module_head": self.module_head,
            "load_header": self.load_header,
            "record_head": lambda children, values, origin: Open("record", self.named(children, values), origin),
            "proc_head": lambda children, values, origin: self.routine("procedure", children, values, origin),
            "func_head": lambda children, values, origin: self.routine("function", children, values, origin),
            "trap_head": lambda children, values, origin: self.routine("trap", children, values, origin),
            "endroutine": lambda children, values, origin: Close("routine", None, origin),
            "endrecord": lambda children, values, origin: Close("record", None, origin),
            "endmodule": lambda children, values, origin: Close("module", None, origin),
            "error": lambda children, values, origin: Middle(
                "routine", HandlerHead("error", tuple(self.value(child, values) for child in children)), origin
            ),
            "undo": lambda children, values, origin: Middle("routine", HandlerHead("undo"), origin),
            "backward": lambda children, values, origin: Middle("routine", HandlerHead("backward"), origin),
            "if_head": lambda children, values, origin: Open("if", self.value(children[0], values), origin),
            "elseif": lambda children, values, origin: Middle("if", self.value(children[0], values), origin),
            "else": lambda children, values, origin: Middle("if", None, origin),
            "while_head": lambda children, values, origin: Open("while", self.value(children[0], values), origin),
            "for_head": self.for_head,
            "test_head": lambda children, values, origin: Open("test", self.value(children[0], values), origin),
            "case": lambda children, values, origin: Middle(
                "test", tuple(self.value(child, values) for child in children), origin
            ),
            "default": lambda children, values, origin: Middle("test", None, origin),
        }

    def lower(self, tree: SyntaxTree, values: Values, origin: Origin) -> Element | tuple[Element, ...]:
        """What the assembler asks: the element (or elements) of one statement. May raise StatementError."""
        kind = _ENDS.get(tree.data)
        if kind is not None:
            return Close(kind, None, origin)
        return self.rules[tree.data](tree.children, values, origin)

    def optional(self, children: Children, values: Values) -> ir.Expression | None:
        return self.value(children[0], values) if children else None

    # ---- declarations

    def named(self, children: Children, values: Values) -> RecordHead:
        """Name and scope of a record header: [local] name."""
        scope = "module" if isinstance(children[0], Tree) else "task"
        return RecordHead(leaf(children[-1], values), scope)

    def data(self, children: Children, values: Values, origin: Origin) -> ir.Variable:
        at, scope = 0, ""
        first = children[0]
        assert isinstance(first, Tree)  # a promise of the grammar
        if first.data != "storage":
            at, scope = 1, "module" if first.data == "local" else "task"
        storage = _STORAGE[word_of(children[at])]
        if not scope:
            scope = "global" if storage == "persistent" else "task"
        type = self.type_named(leaf(children[at + 1], values))
        name = leaf(children[at + 2], values)
        initial: ir.Expression | None = None
        for child in children[at + 3 :]:
            if isinstance(child, Tree) and child.data == "sizes":
                type = self.array(type, child, values)
            else:
                initial = self.value(child, values)
        return ir.Variable(name, type, initial, storage, scope, origin=origin)

    def array(self, element: ir.Type, sizes: SyntaxTree, values: Values) -> ir.ArrayType:
        dimensions = tuple(
            None if isinstance(size, Tree) and size.data == "any_size" else self.value(size, values)
            for size in sizes.children
        )
        return ir.ArrayType(element, dimensions)

    def alias(self, children: Children, values: Values, origin: Origin) -> ir.AliasDeclaration:
        scope = "module" if isinstance(children[0], Tree) else "task"
        old, new = (leaf(child, values) for child in children[-2:])
        return ir.AliasDeclaration(new, self.type_named(old), scope, origin=origin)

    def module_head(self, children: Children, values: Values, origin: Origin) -> Open:
        attributes: tuple[tuple[str, str], ...] = ()
        if len(children) > 1:
            listed = children[1]
            assert isinstance(listed, Tree)  # a promise of the grammar
            attributes = tuple((leaf(child, values).upper(), "") for child in listed.children)
        return Open("module", ModuleHead(leaf(children[0], values), attributes), origin)

    def load_header(self, children: Children, values: Values, origin: Origin) -> tuple[Element, ...]:
        words = [leaf(child, values) for child in children]
        return tuple(
            Attribute(f"%{name.upper()}", value, origin) for name, value in zip(words[::2], words[1::2], strict=False)
        ) or (ir.Nothing(origin=origin),)

    def routine(self, kind: str, children: Children, values: Values, origin: Origin) -> Open:
        rest = list(children)
        scope = "task"
        if isinstance(rest[0], Tree) and rest[0].data == "local":
            scope = "module"
            rest.pop(0)
        returns = self.type_named(leaf(rest.pop(0), values)) if kind == "function" else None
        name = leaf(rest.pop(0), values)
        parameters = self.parameters(rest[0], values) if rest else ()
        return Open("routine", RoutineHead(kind, name, parameters, returns, scope), origin)

    def parameters(self, tree: SyntaxTree | Token | Slot, values: Values) -> tuple[ir.Parameter, ...]:
        assert isinstance(tree, Tree)  # a promise of the grammar
        result: list[ir.Parameter] = []
        choices = 0
        for child in tree.children:
            assert isinstance(child, Tree)  # a promise of the grammar
            if child.data == "alternative":
                before = result[-1] if result else None
                choice = before.choice if before else None
                if before is not None and choice is None:
                    choices += 1
                    choice = choices
                    result[-1] = _with_choice(before, choice)
                inner = child.children[0]
                assert isinstance(inner, Tree)  # a promise of the grammar
                result.append(_with_choice(self.parameter(inner, values, True), choice))
            else:
                result.append(self.parameter(child, values, child.data == "optional_parameter"))
        return tuple(result)

    def parameter(self, tree: SyntaxTree, values: Values, optional: bool) -> ir.Parameter:
        children = list(tree.children)
        mode = "value"
        if isinstance(children[0], Tree):
            children.pop(0)
            mode = "reference"
        word = leaf(children[0], values)
        type: ir.Type = self.type_named(word)
        if len(children) > 2 and isinstance(children[2], Tree):
            type = self.array(type, children[2], values)
        switch = word.lower() == "switch"
        return ir.Parameter(leaf(children[1], values), type, mode, optional, switch)

    # ---- control flow and calls

    def for_head(self, children: Children, values: Values, origin: Origin) -> Open:
        start, stop, *step = (self.value(child, values) for child in children[1:])
        return Open("for", ForHead(leaf(children[0], values), start, stop, step[0] if step else None), origin)

    def compact_if(self, children: Children, values: Values, origin: Origin) -> ir.If:
        condition = self.value(children[0], values)
        body = children[1]
        assert isinstance(body, Tree)  # a promise of the grammar
        done = self.simple[body.data](body.children, values, origin)
        return ir.If(((condition, done if isinstance(done, tuple) else (done,)),), origin=origin)

    def assign(self, children: Children, values: Values, origin: Origin) -> ir.Statement:
        target, value = self.value(children[0], values), self.value(children[1], values)
        if isinstance(target, ir.Convert) and isinstance(target.operand, ir.Signal):
            target = ir.Name(target.operand.name or "")
        return ir.Assign(target, value, origin=origin)

    def connect(self, children: Children, values: Values, origin: Origin) -> ir.ConnectInterrupt:
        return ir.ConnectInterrupt(self.value(children[0], values), leaf(children[1], values), origin=origin)

    def late_call(self, children: Children, values: Values, origin: Origin) -> ir.CallRoutine:
        trees = children[1].children if len(children) > 1 and isinstance(children[1], Tree) else []
        arguments = self.expressions.call_arguments("", trees, values)
        return ir.CallRoutine("", arguments, self.value(children[0], values), origin=origin)

    def call(self, children: Children, values: Values, origin: Origin) -> ir.Statement | tuple[ir.Statement, ...]:
        name = leaf(children[0], values)
        lower = name.lower()
        trees = children[1].children if len(children) > 1 and isinstance(children[1], Tree) else []
        if lower in self.expressions.own:
            return ir.CallRoutine(name, self.expressions.call_arguments(lower, trees, values), origin=origin)
        if name[0] == "<":
            self.diagnostics.report(PLACEHOLDER, origin, text=name)
            return ir.Opaque(name, origin=origin)
        maker = INSTRUCTIONS.get(lower)
        if maker is not None:
            arguments = self.expressions.collect(name, trees, values)
            if not arguments.conditional:
                made = maker(arguments, self.expressions, origin)
                if made is not None:
                    self.left_out(arguments, origin)
                    return made
        effect = EFFECTS.get(lower)
        if effect is not None:
            return ir.Vendor("rapid", vendor_text(origin.text, name), effect, origin=origin)
        return ir.CallRoutine(name, self.expressions.call_arguments(lower, trees, values), origin=origin)

    def left_out(self, arguments: Arguments, origin: Origin) -> None:
        for option in arguments.options:
            if option in _IGNORED_OPTIONS:
                self.diagnostics.report(IGNORED, origin, option=_IGNORED_OPTIONS[option])


def vendor_text(text: str, name: str) -> str:
    """The instruction alone, out of a statement that may be a compact IF and have a comment behind it."""
    found = re.search(rf"(?<![\w\\.\"]){re.escape(name)}\b", text)
    at = found.start() if found else 0
    whole = _STATEMENT.match(text, at)
    return re.sub(r"\s*[\r\n]\s*", " ", whole.group() if whole else text[at:]).strip()


def _with_choice(parameter: ir.Parameter, choice: int | None) -> ir.Parameter:
    return ir.Parameter(parameter.name, parameter.type, parameter.mode, parameter.optional, parameter.switch, choice)
