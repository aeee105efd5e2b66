"""Lower RAPID expressions. AND and OR stop at the first operand that decides; NOT stands before a whole term of ANDs.

A digital signal reads as the number 0 or 1. `di1=1` says what the BOOL signal itself says, so it becomes just that.
"""

from __future__ import annotations

from collections.abc import Callable

from lark import Token, Tree

from rpl import ir
from rpl.reading.shapes import Slot, SyntaxTree, real_number

from .arguments import Arguments
from .functions import FUNCTIONS
from .project import Project
from .rules import SYSTEM_RECORDS

Values = tuple[str, ...]
Children = list[SyntaxTree | Token | Slot]
_ON, _OFF = ("high",), ("low",)
_SYSTEM = {"errno": "error_number", "intno": "interrupt_number"}
_BASES = {"0x": 16, "0b": 2, "0o": 8}


def leaf(child: SyntaxTree | Token | Slot, values: Values) -> str:
    """The spelling of a name, text or number."""
    if isinstance(child, Slot):
        return values[child.index]
    return str(child)


def word_of(child: SyntaxTree | Token | Slot) -> str:
    """The only keyword or sign of a rule such as `sign`."""
    assert isinstance(child, Tree)  # a promise of the grammar
    return str(child.children[0]).upper()


def unquoted(spelling: str) -> str:
    r"""The characters of a text: `""` is a quote, `\\` a backslash, `\0A` a character by its code."""
    inner = spelling[1:-1].replace('""', '"')
    if "\\" not in inner:
        return inner
    parts, at = [], 0
    while at < len(inner):
        if inner[at] != "\\":
            parts.append(inner[at])
            at += 1
        elif inner[at + 1 : at + 2] == "\\":
            parts.append("\\")
            at += 2
        else:
            code = inner[at + 1 : at + 3]
            try:
                parts.append(chr(int(code, 16)) if len(code) == 2 else "\\" + code)
                at += 3
            except ValueError:
                parts.append("\\")
                at += 1
    return "".join(parts)


class Expressions:
    """Lowers expression trees of one file."""

    def __init__(self, project: Project, path: str) -> None:
        self.project = project
        self.own = project.routines | project.local_routines.get(path, set())
        self.rules: dict[str, Callable[[Children, Values], ir.Expression]] = {
            "name": self.name,
            "field": self.component,
            "index": self.index,
            "function_field": self.component,
            "function_index": self.index,
            "function": self.function,
            "number": self.number,
            "text": lambda children, values: ir.TextLiteral(unquoted(leaf(children[0], values))),
            "true": lambda children, values: ir.BoolLiteral(True),
            "false": lambda children, values: ir.BoolLiteral(False),
            "parenthesis": lambda children, values: self.lower(children[0], values),
            "aggregate": lambda children, values: ir.Aggregate(
                tuple([(None, self.lower(child, values)) for child in children])
            ),
            "signed": self.signed,
            "sum": self.binary,
            "product": self.binary,
            "compare": self.compare,
            "negation": lambda children, values: ir.Unary("not", self.lower(children[0], values)),
            "both": lambda children, values: self.logic("cand", children, values),
            "either": lambda children, values: self.logic("cor", children, values),
            "exclusive": lambda children, values: self.logic("xor", children, values),
        }

    def lower(self, tree: SyntaxTree | Token | Slot, values: Values) -> ir.Expression:
        assert isinstance(tree, Tree)  # the grammar's expressions are rules
        return self.rules[tree.data](tree.children, values)

    # ---- names, components, numbers

    def name(self, children: Children, values: Values) -> ir.Expression:
        name = leaf(children[0], values)
        lower = name.lower()
        if lower in self.project.declared:
            return ir.Name(name)
        if lower in _SYSTEM:
            return ir.System(_SYSTEM[lower])
        kind = self.project.signal_kind(name)
        if kind is not None:
            return read_signal(ir.Signal(kind, name=name))
        return ir.Name(name)

    def component(self, children: Children, values: Values) -> ir.Expression:
        made = ir.Field(self.lower(children[0], values), leaf(children[1], values))
        return self.of_system_record(made) or made

    def of_system_record(self, component: ir.Field) -> ir.Expression | None:
        """A component of the controller's own records that is a modal setting."""
        match component:
            case ir.Field(ir.Field(ir.Name(id=record), inner), name):
                path = f"{inner}.{name}"
            case ir.Field(ir.Name(id=record), path):
                pass
            case _:
                return None
        neutral = SYSTEM_RECORDS.get((record.upper(), path.lower()))
        return None if neutral is None or record.lower() in self.project.declared else ir.System(neutral)

    def index(self, children: Children, values: Values) -> ir.Expression:
        indices = tuple([self.lower(child, values) for child in children[1:]])
        return ir.Index(self.lower(children[0], values), indices)

    def number(self, children: Children, values: Values) -> ir.Expression:
        slot = children[0]
        assert isinstance(slot, Slot)  # a promise of the parser
        spelling = values[slot.index]
        if slot.real:
            return ir.RealLiteral(real_number(spelling), spelling)
        if spelling.isdecimal():
            return ir.IntLiteral(int(spelling), spelling)
        base = _BASES.get(spelling[:2].lower(), 10)
        return ir.IntLiteral(int(spelling, base) if base == 10 else int(spelling[2:], base), spelling)

    # ---- operators

    def signed(self, children: Children, values: Values) -> ir.Expression:
        operand = self.lower(children[1], values)
        return ir.Unary(word_of(children[0]), operand)

    def binary(self, children: Children, values: Values) -> ir.Expression:
        left, right = self.lower(children[0], values), self.lower(children[2], values)
        return ir.Binary(word_of(children[1]).lower(), left, right)

    def logic(self, op: str, children: Children, values: Values) -> ir.Expression:
        return ir.Binary(op, self.lower(children[0], values), self.lower(children[1], values))

    def compare(self, children: Children, values: Values) -> ir.Expression:
        op = word_of(children[1])
        left, right = self.lower(children[0], values), self.lower(children[2], values)
        return compared(op, self.as_signal(left, right), self.as_signal(right, left))

    def as_signal(self, operand: ir.Expression, other: ir.Expression) -> ir.Expression:
        """A name that nobody declares, compared with 0 or 1, can only be a digital signal."""
        if not isinstance(operand, ir.Name) or operand.id.lower() in self.project.declared or operand.id[0] in "<{":
            return operand
        return operand if truth_of(other) is None else read_signal(ir.Signal("digital_in", name=operand.id))

    # ---- functions and their arguments

    def function(self, children: Children, values: Values) -> ir.Expression:
        name = leaf(children[0], values)
        lower = name.lower()
        trees = _argument_trees(children[1:])
        if lower in self.own:
            return ir.Call(name, self.call_arguments(lower, trees, values))
        installed = FUNCTIONS.get(lower)
        if installed is None:
            return ir.Call(name, self.call_arguments(lower, trees, values))
        arguments = self.collect(name, trees, values)
        if not arguments.conditional:
            made = installed(arguments, self)
            if made is not None:
                return made
        return ir.Call(name, self.call_arguments(lower, trees, values))

    def collect(self, name: str, trees: Children, values: Values) -> Arguments:
        """Arguments of an installed routine."""
        result = Arguments(name)
        for tree in trees:
            assert isinstance(tree, Tree)  # a promise of the grammar
            children = tree.children
            match tree.data:
                case "argument":
                    result.positional.append(self.lower(children[0], values))
                case "named_argument":
                    result.positional.append(self.lower(children[1], values))
                case "valued_option":
                    result.options[leaf(children[0], values).lower()] = self.lower(children[1], values)
                case "switch":
                    result.options[leaf(children[0], values).lower()] = None
                case _:
                    result.conditional = True
        return result

    def call_arguments(self, routine: str, trees: Children, values: Values) -> tuple[ir.Argument, ...]:
        """Arguments of a routine of the project. A signal is passed as such, not its value."""
        kinds = self.project.signal_arguments.get(routine, {})
        result: list[ir.Argument] = []
        for position, tree in enumerate(trees):
            assert isinstance(tree, Tree)  # a promise of the grammar
            children = tree.children
            match tree.data:
                case "argument":
                    kind = kinds.get(position)
                    result.append(ir.Argument(self.passed(self.lower(children[0], values), kind)))
                case "named_argument" | "valued_option":
                    name = leaf(children[0], values)
                    value = self.passed(self.lower(children[1], values), kinds.get(name.lower()))
                    result.append(ir.Argument(value, name))
                case "switch":
                    result.append(ir.Argument(None, leaf(children[0], values)))
                case _:
                    source = leaf(children[1], values)
                    result.append(ir.Argument(ir.Name(source), leaf(children[0], values), if_present=source))
        return tuple(result)

    def passed(self, value: ir.Expression, kind: str | None) -> ir.Expression:
        if isinstance(value, ir.Convert) and isinstance(value.operand, ir.Signal):
            return value.operand
        return self.signal(value, kind) if kind else value

    def signal(self, value: ir.Expression, kind: str) -> ir.Expression:
        """An argument in the place of a signal: a parameter, a declared name (an alias) or the physical signal."""
        match value:
            case ir.Name(id=name) if name.lower() in self.project.signal_parameters:
                return ir.Signal(kind, name=name)
            case ir.Convert(how="bit", operand=ir.Signal(name=name)) | ir.Signal(name=name) if name is not None:
                return ir.Signal(kind, name=name)
            case ir.Name(id=name) if name.lower() not in self.project.declared:
                return ir.Signal(kind, name=name)
        return value


def read_signal(signal: ir.Expression) -> ir.Expression:
    """The number a signal reads as."""
    if isinstance(signal, ir.Signal) and not signal.kind.startswith("digital"):
        return signal
    return ir.Convert("bit", signal)


def truth_of(value: ir.Expression) -> bool | None:
    """TRUE or FALSE for the literals 1, 0, high and low."""
    match value:
        case ir.IntLiteral(value=0 | 1 as number):
            return bool(number)
        case ir.Name(id=name) if name.lower() in ("high", "low"):
            return name.lower() == "high"
    return None


def as_bool(value: ir.Expression) -> ir.Expression:
    """A number written to a digital output as a BOOL."""
    truth = truth_of(value)
    if truth is not None:
        return ir.BoolLiteral(truth)
    if isinstance(value, ir.Convert) and value.how == "bit":
        return value.operand
    return ir.Convert("truth", value)


def compared(op: str, left: ir.Expression, right: ir.Expression) -> ir.Expression:
    """A comparison; of a digital signal with 0 or 1: the signal itself or its negation."""
    if op in ("=", "<>"):
        for signal, literal in ((left, right), (right, left)):
            truth = truth_of(literal)
            if isinstance(signal, ir.Convert) and signal.how == "bit" and truth is not None:
                return signal.operand if truth == (op == "=") else ir.Unary("not", signal.operand)
    return ir.Binary(op, left, right)


def _argument_trees(children: Children) -> Children:
    if not children:
        return []
    arguments = children[0]
    assert isinstance(arguments, Tree)  # a promise of the grammar
    return arguments.children
