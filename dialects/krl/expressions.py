"""KRL expression trees to IR. Each shape is compiled once to a function of the statement's numbers, names and texts.

Precedence is the documented one (relational operators bind loosest). Where that reading cannot type, because an operand
of AND, OR or EXOR next to a comparison is certainly no BOOL, the C-like reading is taken and reported.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

from lark import Token, Tree

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.reading.shapes import Slot, StatementError, SyntaxTree, real_number
from rpl.source import Origin

from . import tables
from .calls import function_call
from .readings import ASKED, JOINTS_OF, counted, counts, joints_of

LOOSE_LOGIC = code(
    "krl-comparison-precedence",
    Severity.WARNING,
    "{operator} beside an unbracketed comparison: read as in C, because the documented order makes no sense here",
    "put brackets around each comparison",
)

Pieces = tuple[str, ...]
Make = Callable[[Pieces, Origin], ir.Expression]
Take = Callable[[Pieces], str]

OPERATORS = {
    "==": "=", "<>": "<>", "<": "<", ">": ">", "<=": "<=", ">=": ">=", "+": "+", "-": "-", "*": "*", "/": "quo",
    "and": "and", "or": "or", "exor": "xor", "b_and": "band", "b_or": "bor", "b_exor": "bxor",
    "not": "not", "b_not": "bnot",
}  # fmt: skip
_LARGEST_REAL = 3.5e38  # single precision, with room for rounding
_INT_DIGITS = 10
_LOGIC = ("and", "or", "xor")
_NUMBERS = (ir.IntLiteral, ir.RealLiteral)
_TRUE, _FALSE = ir.BoolLiteral(True), ir.BoolLiteral(False)


@dataclass(slots=True)
class Facts:
    """What a quick look over the whole project found before reading: its own routines, declared types by name, and
    machine data (names of tables.MEASURED) that its lists declare."""

    routines: frozenset[str] = frozenset()
    types: dict[str, str] = field(default_factory=dict)
    given: frozenset[str] = frozenset()
    reported: set[int] = field(default_factory=set)


class Expressions:
    """Compiles expression trees; base of the statement compiler."""

    def __init__(self, facts: Facts, diagnostics: Diagnostics) -> None:
        self.facts = facts
        self.diagnostics = diagnostics
        self.fixed_inputs = True  # $IN[1025] and $IN[1026] are TRUE and FALSE, but for a SIGNAL they are places

    def expression(self, tree: SyntaxTree) -> Make:
        """The function that builds the expression of this shape."""
        kind = tree.data
        if kind == "real":
            return _real(_slot(tree.children[0]))
        if kind == "integer":
            return _integer(_slot(tree.children[0]))
        if kind == "reference":
            return counted(self.reference(tree)) if counts(tree) else self.reference(tree)
        if kind == "aggregate":
            return self.aggregate(tree)
        if kind == "binary":
            return self.binary(tree)
        if kind == "chain":
            return self.chain(tree)
        if kind == "unary":
            return self.unary(tree)
        if kind == "group":
            return self.expression(_tree(tree.children[0]))
        if kind == "call":
            return self.call(tree)
        if kind == "compose":
            left, right = (self.expression(_tree(child)) for child in tree.children)
            return lambda pieces, origin: ir.Binary(":", left(pieces, origin), right(pieces, origin), origin=origin)
        return _literal(kind, tree)

    def binary(self, tree: SyntaxTree) -> Make:
        op = OPERATORS[str(tree.children[1]).lower()]
        left, right = self.expression(_tree(tree.children[0])), self.expression(_tree(tree.children[2]))
        return lambda pieces, origin: ir.Binary(op, left(pieces, origin), right(pieces, origin), origin=origin)

    def unary(self, tree: SyntaxTree) -> Make:
        op, operand = OPERATORS[str(tree.children[0]).lower()], self.expression(_tree(tree.children[1]))
        return lambda pieces, origin: ir.Unary(op, operand(pieces, origin), origin=origin)

    def chain(self, tree: SyntaxTree) -> Make:
        """Relations, documented reading: from left to right, each operand a whole logical expression."""
        operands = [_tree(child) for child in tree.children[::2]]
        relations = [OPERATORS[str(child)] for child in tree.children[1::2]]
        makes = [self.expression(operand) for operand in operands]
        loose = next((operand for operand in operands if _logic(operand)), None)
        if loose is None:
            if len(makes) == 2:
                (left, right), relation = makes, relations[0]
                return lambda pieces, origin: related(relation, left(pieces, origin), right(pieces, origin), origin)
            return _chained(makes, relations)
        documented, other = _chained(makes, relations), self.loose(operands, relations)
        operator = str(loose.children[1]).upper()

        def decide(pieces: Pieces, origin: Origin) -> ir.Expression:
            if not self.senseless(operands, relations, pieces, origin):
                return documented(pieces, origin)
            if origin.start not in self.facts.reported:
                self.facts.reported.add(origin.start)
                self.diagnostics.report(LOOSE_LOGIC, origin, operator=operator)
            return other(pieces, origin)

        return decide

    def loose(self, operands: list[SyntaxTree], relations: list[str]) -> Make:
        """The C-like reading: relations bind tighter than AND, EXOR, OR."""
        flat: list[object] = []
        for position, operand in enumerate(operands):
            if position:
                flat.append(relations[position - 1])
            flat.extend(_flatten(operand))
        parts: list[Make] = []
        logic: list[str] = []
        current: Make | None = None
        relation = ""
        for item in flat:
            if isinstance(item, str):
                if item in _LOGIC:
                    assert current is not None  # the grammar puts an operand in front of each operator
                    parts.append(current)
                    logic.append(item)
                    current = None
                else:
                    relation = item
                continue
            assert isinstance(item, Tree)  # what is no word of an operator is an operand
            make = self.expression(item)
            current = make if current is None else _related(relation, current, make)
        assert current is not None
        parts.append(current)
        for op in _LOGIC[:1] + _LOGIC[2:] + _LOGIC[1:2]:  # AND, EXOR, OR: from tight to loose
            while op in logic:
                at = logic.index(op)
                parts[at : at + 2] = [_joined(op, parts[at], parts[at + 1])]
                del logic[at]
        return parts[0]

    def senseless(self, operands: list[SyntaxTree], relations: list[str], pieces: Pieces, origin: Origin) -> bool:
        """Does the documented reading put something that is certainly no BOOL under AND, OR or EXOR?"""
        for operand in operands:
            if _logic(operand):
                for leaf in _flatten(operand):
                    if isinstance(leaf, Tree) and self.no_bool(leaf, pieces, origin):
                        return True
        return any(relation not in ("=", "<>") for relation in relations)  # a BOOL has no order

    def no_bool(self, leaf: SyntaxTree, pieces: Pieces, origin: Origin) -> bool:
        value = self.expression(leaf)(pieces, origin)
        match value:
            case ir.Name(id=name) | ir.Index(base=ir.Name(id=name)):
                found = self.facts.types.get(name.lower())
                return found is not None and found != "bool"
            case ir.Binary(op=op):
                return op in ("+", "-", "*", "quo", ":", "band", "bor", "bxor")
            case ir.IntLiteral() | ir.RealLiteral() | ir.TextLiteral() | ir.EnumLiteral():
                return True
            case ir.Magnitude() | ir.Convert():
                return True
            case ir.Signal(kind=kind):
                return kind.startswith("analog")
            case ir.Unary(op=op):
                return op != "not"
        return False

    def name(self, child: object) -> Take:
        """The function that gives a name's spelling."""
        if isinstance(child, Slot):
            index = child.index
            return lambda pieces: pieces[index]
        text = str(child)
        return lambda pieces: text

    def reference(self, tree: SyntaxTree) -> Make:
        first = tree.children[0]
        if isinstance(first, Token) and first.startswith("$"):
            return self.system(tree)
        suffixes = [_tree(child) for child in tree.children[1:]]
        if isinstance(first, Slot):
            index = first.index
            if not suffixes:
                return lambda pieces, origin: ir.Name(pieces[index], origin=origin)
            return self.suffixed(lambda pieces, origin: ir.Name(pieces[index], origin=origin), suffixes)
        text = str(first)
        return self.suffixed(lambda pieces, origin: ir.Name(text, origin=origin), suffixes)

    def suffixed(self, base: Make, suffixes: list[SyntaxTree]) -> Make:
        for suffix in suffixes:
            base = self.component(base, suffix) if suffix.data == "component" else self.indexed(base, suffix)
        return base

    def component(self, base: Make, suffix: SyntaxTree) -> Make:
        name = self.name(suffix.children[0])
        return lambda pieces, origin: ir.Field(base(pieces, origin), name(pieces), origin=origin)

    def indexed(self, base: Make, suffix: SyntaxTree) -> Make:
        """`A[i]`; `A[]` and `A[,]` are the whole array, `A[i,]` is a row."""
        indices = [index for index in self.optionals(suffix) if index is not None]
        if not indices:
            return base
        if len(indices) == 1:
            (only,) = indices
            return lambda pieces, origin: ir.Index(base(pieces, origin), (only(pieces, origin),), origin=origin)
        return lambda pieces, origin: ir.Index(
            base(pieces, origin), tuple(index(pieces, origin) for index in indices), origin=origin
        )

    def optionals(self, tree: SyntaxTree) -> list[Make | None]:
        """Makes of a bracketed list, None where nothing is written."""
        found: list[Make | None] = []
        for child in tree.children:
            inner = _tree(child).children
            found.append(self.expression(_tree(inner[0])) if inner else None)
        return found

    def system(self, tree: SyntaxTree) -> Make:
        """A `$` name: a neutral system variable, a signal, or an ordinary name that a data list declares."""
        text = str(tree.children[0])
        name = text.lower()
        suffixes = [_tree(child) for child in tree.children[1:]]
        if name in tables.SIGNALS and suffixes and suffixes[0].data == "brackets":
            return self.suffixed(self.signal(name, suffixes[0]), suffixes[1:])
        if name in tables.INDEXED and suffixes and suffixes[0].data == "brackets":
            neutral, unit = tables.INDEXED[name]
            indices = [index for index in self.optionals(suffixes[0]) if index is not None]
            if len(indices) == 1:
                index = indices[0]
                return self.suffixed(
                    _measured(lambda pieces, origin: ir.System(neutral, (index(pieces, origin),), origin=origin), unit),
                    suffixes[1:],
                )
        if name in ASKED and not suffixes:
            asked = ASKED[name]
            return lambda pieces, origin: asked(origin)
        if name in JOINTS_OF:
            place = JOINTS_OF[name]
            return self.suffixed(lambda pieces, origin: joints_of(place, origin), suffixes)
        if name in tables.STRUCTURES:
            return self.structure(name, suffixes)
        if name in tables.SCALARS:
            neutral, unit = tables.SCALARS[name]
            variable = neutral
            return self.suffixed(_measured(lambda pieces, origin: ir.System(variable, origin=origin), unit), suffixes)
        if name in tables.MEASURED and name not in self.facts.given:
            return self.measured(text, suffixes)
        return self.suffixed(lambda pieces, origin: ir.Name(text, origin=origin), suffixes)

    def measured(self, text: str, suffixes: list[SyntaxTree]) -> Make:
        """A value that only the controller has, by what is written (`$SOFTN_END[1]`): whole, or the part asked for."""
        kind = tables.MEASURED[text.lower()]
        part = self.suffixed(lambda pieces, origin: ir.Name(text, origin=origin), suffixes)

        def make(pieces: Pieces, origin: Origin) -> ir.Expression:
            written, type = text.upper(), kind
            given: ir.Expression = part(pieces, origin)
            steps: list[str] = []
            while not isinstance(given, ir.Name):
                match given:
                    case ir.Field(base=base, name=name):
                        steps.append(f".{name.upper()}")
                    case ir.Index(base=base, indices=(ir.IntLiteral(value=number),)):
                        steps.append(f"[{number}]")
                    case ir.Index(base=base):
                        steps.append("[]")
                    case _:
                        break
                given = base
            if isinstance(type, ir.JointsType | ir.TargetType) and steps:
                type = ir.RealType()
            return ir.VendorValue("krl", written + "".join(reversed(steps)), type, origin=origin)

        return make

    def signal(self, name: str, brackets: SyntaxTree) -> Make:
        kind = tables.SIGNALS[name]
        indices = [index for index in self.optionals(brackets) if index is not None]
        if len(indices) != 1:
            raise StatementError(f"{name.upper()} needs one number", 0)
        index = indices[0]
        if name != "$in" or not self.fixed_inputs:
            return lambda pieces, origin: ir.Signal(kind, index(pieces, origin), origin=origin)

        def make(pieces: Pieces, origin: Origin) -> ir.Expression:
            number = index(pieces, origin)
            if isinstance(number, ir.IntLiteral) and number.value in (
                tables.ALWAYS_TRUE_INPUT,
                tables.ALWAYS_FALSE_INPUT,
            ):
                return ir.BoolLiteral(number.value == tables.ALWAYS_TRUE_INPUT, origin=origin)
            return ir.Signal(kind, number, origin=origin)

        return make

    def structure(self, name: str, suffixes: list[SyntaxTree]) -> Make:
        """$VEL, $ACC, $APO: one component is a neutral variable, the whole is an aggregate of all of them."""
        parts = tables.STRUCTURES[name]
        if suffixes and suffixes[0].data == "component":
            component = self.name(suffixes[0].children[0])(())
            if component.lower() in parts:
                neutral, unit = parts[component.lower()]
                return self.suffixed(
                    _measured(lambda pieces, origin: ir.System(neutral, origin=origin), unit), suffixes[1:]
                )
        if suffixes:
            return self.suffixed(lambda pieces, origin: ir.Name(name.upper(), origin=origin), suffixes)

        def whole(pieces: Pieces, origin: Origin) -> ir.Expression:
            entries = tuple((key.upper(), read_system(neutral, unit, origin)) for key, (neutral, unit) in parts.items())
            return ir.Aggregate(entries, origin=origin)

        return whole

    def aggregate(self, tree: SyntaxTree) -> Make:
        children = list(tree.children)
        type_name: Take | None = None
        if children and not (isinstance(children[0], Tree)):
            type_name = self.name(children.pop(0))
        plain = [_plain_entry(_tree(child)) for child in children]
        if type_name is None and plain and all(plain):
            return _numbers_only([entry for entry in plain if entry])
        entries = [self.entry(_tree(child)) for child in children]

        def make(pieces: Pieces, origin: Origin) -> ir.Expression:
            return ir.Aggregate(
                tuple([(name(pieces), value(pieces, origin)) for name, value in entries]),
                type_name(pieces) if type_name else None,
                origin=origin,
            )

        return make

    def entry(self, tree: SyntaxTree) -> tuple[Take, Make]:
        """A component and its value. `TEXT[] "..."` fills a whole array; an index is refused: KRL has no such form."""
        name, value = self.name(tree.children[0]), self.expression(_tree(tree.children[-1]))
        if len(tree.children) == 3 and any(index is not None for index in self.optionals(_tree(tree.children[1]))):
            raise StatementError("an aggregate cannot fill single elements of an array", 0)
        return name, value

    def arguments(self, tree: SyntaxTree) -> Callable[[Pieces, Origin], tuple[ir.Argument, ...]]:
        makes = self.optionals(tree)
        if makes == [None]:
            return lambda pieces, origin: ()
        return lambda pieces, origin: tuple(
            [ir.Argument(make(pieces, origin) if make is not None else None) for make in makes]
        )

    def call(self, tree: SyntaxTree) -> Make:
        name = str(tree.children[0])
        arguments = self.arguments(_tree(tree.children[1]))
        if name.lower() in self.facts.routines:
            return lambda pieces, origin: ir.Call(name, arguments(pieces, origin), origin=origin)
        return lambda pieces, origin: function_call(name, arguments(pieces, origin), origin)


_Plain = tuple[str, int, bool, bool]  # component, slot, is it real, has it a minus


def _plain_entry(tree: SyntaxTree) -> _Plain | None:
    """An entry that is a component with a number, as nearly all entries of point data are."""
    if len(tree.children) != 2 or not isinstance(tree.children[0], Token):
        return None
    name, value, minus = str(tree.children[0]), _tree(tree.children[1]), False
    if value.data == "unary" and str(value.children[0]) == "-":
        minus, value = True, _tree(value.children[1])
    if value.data not in ("real", "integer"):
        return None
    return name, _slot(value.children[0]), value.data == "real", minus


def _numbers_only(entries: list[_Plain]) -> Make:
    """Builds an aggregate of numbers in one go: this is where reading point lists spends its time."""
    real_literal, int_literal, unary = ir.RealLiteral, ir.IntLiteral, ir.Unary

    def make(pieces: Pieces, origin: Origin) -> ir.Expression:
        done: list[tuple[str | None, ir.Expression]] = []
        for name, index, real, minus in entries:
            spelling = pieces[index]
            value: ir.Expression = (
                real_literal(real_value(spelling), spelling) if real else int_literal(whole_value(spelling), spelling)
            )
            done.append((name, unary("-", value, origin=origin) if minus else value))
        return ir.Aggregate(tuple(done), origin=origin)

    return make


def _tree(child: object) -> SyntaxTree:
    assert isinstance(child, Tree)  # the grammar says so
    return child


def _slot(child: object) -> int:
    assert isinstance(child, Slot)
    return child.index


def real_value(spelling: str) -> float:
    """A real number. Raises StatementError when it is beyond what a controller could hold."""
    return real_number(spelling, _LARGEST_REAL)


def whole_value(spelling: str) -> int:
    """A whole number. Raises StatementError when it has more than 32 bits."""
    if len(spelling) > _INT_DIGITS and (len(spelling.lstrip("0")) > _INT_DIGITS):
        raise StatementError(f"the number {spelling[:20]} has more than 32 bits", 0)
    return int(spelling)


def _real(index: int) -> Make:
    def make(pieces: Pieces, origin: Origin) -> ir.Expression:
        spelling = pieces[index]
        return ir.RealLiteral(real_value(spelling), spelling)

    return make


def _integer(index: int) -> Make:
    def make(pieces: Pieces, origin: Origin) -> ir.Expression:
        spelling = pieces[index]
        return ir.IntLiteral(whole_value(spelling), spelling)

    return make


def _literal(kind: str, tree: SyntaxTree) -> Make:
    child = tree.children[0]
    if kind == "text":
        index = _slot(child)
        return lambda pieces, origin: ir.TextLiteral(pieces[index][1:-1], origin=origin)
    text = str(child)
    if kind == "truth":
        value = _TRUE if text.upper() == "TRUE" else _FALSE
        return lambda pieces, origin: value
    if kind == "enum_literal":
        member = text[1:].lstrip()
        return lambda pieces, origin: ir.EnumLiteral(member, origin=origin)
    if kind == "bits":
        number = _bits(text)
        return lambda pieces, origin: number
    raise StatementError(f"did not expect {text!r} here", 0)


def _bits(text: str) -> ir.IntLiteral:
    """`'B1011'`, `'H5A'`: 32 bits, the highest one is the sign."""
    digits = text[2:-1].replace(" ", "")
    base = {"b": 2, "h": 16, "d": 10}[text[1].lower()]
    try:
        value = int(digits, base)
    except ValueError:
        raise StatementError(f"{text} is no number", 0) from None
    if value >= 1 << 32:
        raise StatementError(f"{text} has more than 32 bits", 0)
    return ir.IntLiteral(value - (1 << 32) if value >= 1 << 31 else value, text)


def _logic(tree: SyntaxTree) -> bool:
    return tree.data == "binary" and OPERATORS[str(tree.children[1]).lower()] in _LOGIC


def _flatten(tree: SyntaxTree) -> list[object]:
    """Operands and logical operators of an unbracketed logical expression, in order."""
    if not _logic(tree):
        return [tree]
    op = OPERATORS[str(tree.children[1]).lower()]
    return [*_flatten(_tree(tree.children[0])), op, *_flatten(_tree(tree.children[2]))]


def _chained(makes: list[Make], relations: list[str]) -> Make:
    def make(pieces: Pieces, origin: Origin) -> ir.Expression:
        value = makes[0](pieces, origin)
        for relation, operand in zip(relations, makes[1:], strict=True):
            value = related(relation, value, operand(pieces, origin), origin)
        return value

    return make


def _related(relation: str, left: Make, right: Make) -> Make:
    return lambda pieces, origin: related(relation, left(pieces, origin), right(pieces, origin), origin)


def _joined(op: str, left: Make, right: Make) -> Make:
    return lambda pieces, origin: ir.Binary(op, left(pieces, origin), right(pieces, origin), origin=origin)


def _measured(make: Make, unit: str) -> Make:
    if not unit:
        return make
    return lambda pieces, origin: ir.Magnitude(make(pieces, origin), unit, origin=origin)


def read_system(neutral: str, unit: str, origin: Origin) -> ir.Expression:
    """A neutral variable as the number that KRL shows."""
    variable = ir.System(neutral, origin=origin)
    return ir.Magnitude(variable, unit, origin=origin) if unit else variable


def related(relation: str, left: ir.Expression, right: ir.Expression, origin: Origin) -> ir.Expression:
    """A comparison; members that choose a mode get their neutral words, VARSTATE becomes the question it asks."""
    if isinstance(right, ir.EnumLiteral):
        if isinstance(left, ir.System) and left.name in tables.MODES:
            right = mode_member(left.name, right)
        elif isinstance(left, ir.Call) and left.name.lower() == "varstate":
            asked = _variable_state(relation, left, right.member.lower(), origin)
            if asked is not None:
                return asked
    elif isinstance(left, ir.EnumLiteral) and isinstance(right, ir.System | ir.Call):
        return related(relation, right, left, origin)
    elif isinstance(right, _NUMBERS):
        left = as_number(left)
    return ir.Binary(relation, left, right, origin=origin)


def as_number(value: ir.Expression) -> ir.Expression:
    """StrAdd's result where a number is wanted: the length that the text has then."""
    if isinstance(value, ir.Builtin) and value.function in tables.TEXT_LENGTHS:
        return replace(value, function=tables.TEXT_LENGTHS[value.function])
    return value


def mode_member(variable: str, literal: ir.EnumLiteral) -> ir.EnumLiteral:
    """`#VAR` of $ORI_TYPE and the like by their neutral word; members the neutral variable lacks stay as they are."""
    word = tables.MODES[variable].get(literal.member.lower())
    return ir.EnumLiteral(word, origin=literal.origin) if word else literal


def _variable_state(relation: str, call: ir.Call, state: str, origin: Origin) -> ir.Expression | None:
    """VARSTATE("X")==#INITIALIZED: has the variable, or the parameter that may be left out, a value?"""
    values = [argument.value for argument in call.arguments]
    if len(values) != 1 or not isinstance(values[0], ir.TextLiteral) or relation not in ("=", "<>"):
        return None
    name = values[0].value.strip().removesuffix("[]")
    if not name.replace("$", "_").isidentifier():
        return None
    empty: ir.Expression = ir.Builtin("is_uninitialised", (ir.Name(name, origin=origin),), origin=origin)
    if state == "initialized":
        return empty if relation == "<>" else ir.Unary("not", empty, origin=origin)
    if state == "declared":
        return empty if relation == "=" else ir.Unary("not", empty, origin=origin)
    return None
