"""TP expressions to IR. Registers have no declared types, so every expression is lowered together with its kind:
n number, b truth value, t text, p position (Cartesian), j joint position, u unknown.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from lark import Token, Tree

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.reading.shapes import Slot, StatementError, SyntaxTree, real_number
from rpl.source import Origin

from . import tables
from .positions import Position
from .registers import Facts

Pieces = tuple[str, ...]
ZERO = ir.IntLiteral(0)


@dataclass(frozen=True, slots=True)
class Typed:
    """An expression and its kind."""

    node: ir.Expression
    kind: str


class Choice(Exception):  # noqa: N818 (a control signal inside of one statement, not an error)
    """A place that only a number known at run time decides: the statement becomes a branch for each option."""

    def __init__(self, key: str, selector: ir.Expression, options: tuple[int, ...]) -> None:
        super().__init__(key)
        self.key, self.selector, self.options = key, selector, options


@dataclass(slots=True)
class Place:
    """Where in the project the lowering is."""

    program: str = ""
    points: dict[int, str] = field(default_factory=dict)
    labels: tuple[int, ...] = ()
    taught: dict[int, Position] = field(default_factory=dict)  # positions by where they stand in the listing
    german: bool = False  # are the key words of the listing German?


class Expressions:
    """Lowers expression trees of one statement after the other."""

    def __init__(self, facts: Facts, diagnostics: Diagnostics) -> None:
        self.facts = facts
        self.diagnostics = diagnostics
        self.place = Place()
        self.pieces: Pieces = ()
        self.origin = Origin()
        self.chosen: dict[str, int] = {}

    # ---- the pieces of a shape

    def spelling(self, child: object) -> str:
        return self.pieces[child.index] if isinstance(child, Slot) else str(child)

    def whole(self, child: object) -> int:
        return int(self.spelling(child))

    # ---- values of a wanted kind

    def number(self, tree: SyntaxTree) -> ir.Expression:
        return self.as_number(self.typed(tree))

    def as_number(self, value: Typed) -> ir.Expression:
        match value.kind:
            case "b":
                return ir.Convert("bit", value.node, origin=self.origin)
            case "t":
                return ir.Builtin("text_value", (value.node,), origin=self.origin)
            case "p" | "j":
                raise StatementError("a position stands where a number is needed", 0)
        return value.node

    def truth(self, tree: SyntaxTree) -> ir.Expression:
        return self.as_truth(self.typed(tree))

    def as_truth(self, value: Typed) -> ir.Expression:
        match value.kind:
            case "n":
                return ir.Convert("truth", value.node, origin=self.origin)
            case "b" | "u":
                return value.node
        raise StatementError("a condition is needed here", 0)

    def text(self, value: Typed) -> ir.Expression:
        if value.kind in ("n", "b"):
            return ir.Builtin("value_text", (self.as_number(value),), origin=self.origin)
        if value.kind in ("p", "j"):
            raise StatementError("a position stands where a text is needed", 0)
        return value.node

    def index(self, tree: SyntaxTree) -> ir.Expression:
        """A number in brackets: whole, or a register that is cut to a whole number."""
        node = self.number(tree)
        if isinstance(node, ir.IntLiteral):
            return node
        return ir.Convert("trunc", node, origin=self.origin)

    # ---- expressions

    def typed(self, tree: SyntaxTree) -> Typed:
        """The value of an expression tree."""
        match str(tree.data):
            case "integer":
                spelling = self.spelling(tree.children[0])
                return Typed(ir.IntLiteral(int(spelling), spelling, origin=self.origin), "n")
            case "real":
                spelling = self.spelling(tree.children[0])
                return Typed(ir.RealLiteral(real_number(spelling), spelling, origin=self.origin), "n")
            case "group":
                return self.typed(_tree(tree.children[0]))
            case "text":
                return Typed(ir.TextLiteral(str(tree.children[0])[1:-1], origin=self.origin), "t")
            case "truth":
                on = str(tree.children[0]).upper() in ("ON", "TRUE")
                return Typed(ir.BoolLiteral(on, origin=self.origin), "b")
            case "edge":
                raise StatementError("an edge can stand only in WAIT and SKIP CONDITION", 0)
            case "current":
                return self.current(str(tree.children[0]).upper())
            case "unary":
                return self.unary(tree)
            case "binary":
                return self.binary(tree)
            case "equality":
                return self.equality(tree)
            case "function":
                return self.function(tree)
            case "system_variable":
                return self.system_variable(str(tree.children[0]))
            case "hole":
                return Typed(ir.VendorValue("tp", str(tree.children[0]), ir.RealType(), origin=self.origin), "n")
            case "pallet":
                text = " ".join(self.origin.text.split()).partition("=")[2].rstrip(" ;")
                return Typed(ir.VendorValue("tp", text, ir.RealType(), origin=self.origin), "u")
            case "reference":
                return self.reference(tree)
        raise StatementError(f"{tree.data} is no value", 0)

    def current(self, word: str) -> Typed:
        if word == "LPOS":
            tool, frame = self.fixed_frame("UTOOL"), self.fixed_frame("UFRAME")
            frames: tuple[ir.Expression, ...] = () if tool is None else (tool,)
            if frame is not None:
                frames = (tool or ir.System("tool", origin=self.origin), frame)
            return Typed(ir.Builtin("current_target", frames, origin=self.origin), "p")
        return Typed(ir.Builtin("current_joints", (), origin=self.origin), "j")

    def fixed_frame(self, bank: str) -> ir.Expression | None:
        """The frame or tool that the dump shows as selected, where no program ever selects one."""
        number = self.facts.fixed.get(bank)
        if number is None:
            return None
        return ir.Index(ir.Name(bank, origin=self.origin), (ir.IntLiteral(number),), origin=self.origin)

    def unary(self, tree: SyntaxTree) -> Typed:
        sign, operand = str(tree.children[0]), _tree(tree.children[1])
        if sign == "!":
            return Typed(ir.Unary("not", self.truth(operand), origin=self.origin), "b")
        value = self.number(operand)
        if sign == "+":
            return Typed(value, "n")
        match value:
            case ir.IntLiteral(value=number):
                return Typed(ir.IntLiteral(-number, origin=self.origin), "n")
            case ir.RealLiteral(value=given):
                return Typed(ir.RealLiteral(-given, origin=self.origin), "n")
        return Typed(ir.Unary("-", value, origin=self.origin), "n")

    def binary(self, tree: SyntaxTree) -> Typed:
        left, sign, right = _tree(tree.children[0]), str(tree.children[1]).upper(), _tree(tree.children[2])
        if sign in ("AND", "OR"):
            return Typed(ir.Binary(sign.lower(), self.truth(left), self.truth(right), origin=self.origin), "b")
        one, other = self.typed(left), self.typed(right)
        if sign in ("<", ">", "<=", ">="):
            return Typed(ir.Binary(sign, self.as_number(one), self.as_number(other), origin=self.origin), "b")
        if one.kind in ("p", "j") or other.kind in ("p", "j"):
            return self.sum_of_positions(one, sign, other)
        if "t" in (one.kind, other.kind) and sign == "+":
            return Typed(ir.Binary("&", self.text(one), self.text(other), origin=self.origin), "t")
        op = {"DIV": "div", "MOD": "mod"}.get(sign, sign)
        return Typed(ir.Binary(op, self.as_number(one), self.as_number(other), origin=self.origin), "n")

    def sum_of_positions(self, one: Typed, sign: str, other: Typed) -> Typed:
        """PR[1]+PR[2] adds X, Y, Z, W, P, R (or the joints) one by one."""
        if sign not in ("+", "-") or one.kind not in ("p", "j") or other.kind not in ("p", "j"):
            raise StatementError("positions can only be added and subtracted", 0)
        kind = one.kind if one.kind == other.kind else "p"
        function = "element_sum" if sign == "+" else "element_difference"
        parts = (self.position(one, kind), self.position(other, kind))
        return Typed(ir.Builtin(function, parts, origin=self.origin), kind)

    def position(self, value: Typed, kind: str) -> ir.Expression:
        """A position in the wanted representation."""
        if value.kind == kind:
            return value.node
        if value.kind not in ("p", "j"):
            raise StatementError("a position is needed here", 0)
        function = "joints_to_target" if kind == "p" else "target_to_joints"
        return ir.Builtin(function, (value.node,), origin=self.origin)

    def equality(self, tree: SyntaxTree) -> Typed:
        children = [child for child in tree.children if isinstance(child, Tree)]
        signs = [str(child) for child in tree.children if isinstance(child, Token)]
        sign = signs[0] if signs else "="
        one, other = self.typed(children[0]), self.typed(children[1])
        if one.kind == "b" and other.kind == "b":
            return Typed(self.same_truth(one.node, sign, other.node), "b")
        if "t" in (one.kind, other.kind):
            return Typed(self.same_text(self.text(one), sign, self.text(other)), "b")
        return Typed(ir.Binary(sign, self.as_number(one), self.as_number(other), origin=self.origin), "b")

    def same_truth(self, left: ir.Expression, sign: str, right: ir.Expression) -> ir.Expression:
        """`DI[1]=ON` is the signal itself: that is what other languages watch and print."""
        if isinstance(right, ir.BoolLiteral):
            wanted = right.value == (sign == "=")
            return left if wanted else ir.Unary("not", left, origin=self.origin)
        return ir.Binary(sign, left, right, origin=self.origin)

    def same_text(self, left: ir.Expression, sign: str, right: ir.Expression) -> ir.Expression:
        """Texts that differ only in upper and lower case are equal (measured on a virtual controller, CrossArm)."""
        equal = ir.Builtin("text_equal", (left, right, ir.BoolLiteral(True)), origin=self.origin)
        return equal if sign == "=" else ir.Unary("not", equal, origin=self.origin)

    def function(self, tree: SyntaxTree) -> Typed:
        name = str(tree.children[0]).upper()
        return self.called(name, [self.typed(_tree(child)) for child in tree.children[1:]])

    def called(self, name: str, values: list[Typed]) -> Typed:
        """A function by its TP name."""
        if name == "FINDSTR" and len(values) == 2:
            where, what = (ir.Builtin("text_upper", (self.text(v),), origin=self.origin) for v in values)
            parts = (where, ir.IntLiteral(1), what)  # case does not count here either
            return Typed(ir.Builtin("text_find", parts, origin=self.origin), "n")
        if name == "SUBSTR" and len(values) == 3:
            cut = (self.text(values[0]), self.as_number(values[1]), self.as_number(values[2]))
            return Typed(ir.Builtin("text_part", cut, origin=self.origin), "t")
        if name == "STRLEN" and len(values) == 1:
            return Typed(ir.Builtin("text_length", (self.text(values[0]),), origin=self.origin), "n")
        wanted = 2 if name == "ATAN2" else 1
        if name not in tables.FUNCTIONS or len(values) != wanted:
            raise StatementError(f"{name} takes {wanted} value{'s' if wanted > 1 else ''}", 0)
        numbers = tuple(self.as_number(value) for value in values)
        return Typed(ir.Builtin(tables.FUNCTIONS[name], numbers, origin=self.origin), "n")

    def system_variable(self, spelling: str) -> Typed:
        name = "".join(spelling.upper().split())
        if name in tables.SYSTEM_VARIABLES:
            return Typed(ir.System(tables.SYSTEM_VARIABLES[name], origin=self.origin), "n")
        frame = tables.FRAME_VARIABLE.fullmatch(name)
        if frame is not None:
            base = ir.Name(frame[1], origin=self.origin)
            return Typed(ir.Index(base, (ir.IntLiteral(int(frame[2])),), origin=self.origin), "p")
        if name in tables.ACTIVE_NUMBERS:
            return Typed(ir.Name(tables.ACTIVE_NUMBERS[name], origin=self.origin), "n")
        if name == tables.WAIT_TIMEOUT:
            return Typed(ir.Name(tables.WAIT_TIMEOUT, origin=self.origin), "n")
        if name in tables.ACTUAL_POSITION:
            actual = ir.System("actual_pose", origin=self.origin)
            return Typed(ir.Field(actual, tables.ACTUAL_POSITION[name], origin=self.origin), "n")
        return Typed(ir.VendorValue("tp", spelling, ir.RealType(), origin=self.origin), "n")

    # ---- registers, signals, positions

    def reference(self, tree: SyntaxTree) -> Typed:
        bank = str(tree.children[0]).upper()
        group = [str(child).upper() for child in tree.children[1:] if isinstance(child, Token)]
        indices = [_tree(child) for child in tree.children[1:] if isinstance(child, Tree)]
        if group and group[0] != "GP1":
            return self.other_group(tree, bank)
        if bank in tables.NUMBERED_SIGNALS or bank in tables.NAMED_SIGNALS:
            return self.signal(bank, indices)
        match bank:
            case "R" | "SR":
                return Typed(self.register(bank, self.index(indices[0])), "n" if bank == "R" else "t")
            case "PR":
                return self.position_register(indices)
            case "P":
                return self.point(indices)
            case "AR":
                return self.argument(self.index(indices[0]))
            case "TIMER":
                return Typed(ir.System("timer", (self.index(indices[0]),), origin=self.origin), "n")
            case "UFRAME" | "UTOOL":
                name = ir.Name(bank, origin=self.origin)
                return Typed(ir.Index(name, (self.index(indices[0]),), origin=self.origin), "p")
            case "TIMER_OVERFLOW":
                self.index(indices[0])
                return Typed(ir.IntLiteral(0, origin=self.origin), "n")  # a stop watch here never runs over
            case "SEMAPHORE":
                return Typed(self.named_signal("flag", bank, indices), "b")
        return self.only_controller(bank, indices)

    def only_controller(self, bank: str, indices: list[SyntaxTree]) -> Typed:
        for index in indices:
            self.number(index)  # damage inside is still found
        text = self.origin_part(bank)
        return Typed(ir.VendorValue("tp", text, ir.RealType(), origin=self.origin), "u")

    def other_group(self, tree: SyntaxTree, bank: str) -> Typed:
        """Positions of another motion group: only the controller has them."""
        kind: ir.Type = ir.RealType() if len(tree.children) > 3 else ir.TargetType("tp")
        return Typed(ir.VendorValue("tp", self.origin_part(bank), kind, origin=self.origin), "p")

    def origin_part(self, start: str) -> str:
        text = self.origin.text
        at = text.upper().find(start + "[")
        end = text.find("]", at)
        return text[at : end + 1] if at >= 0 and end > at else start

    def register(self, bank: str, index: ir.Expression) -> ir.Expression:
        local = bank == "R" and isinstance(index, ir.IntLiteral) and index.value > tables.LOCAL_REGISTERS
        if (bank in self.facts.arrays and not local) or not isinstance(index, ir.IntLiteral):
            return ir.Index(ir.Name(bank, origin=self.origin), (index,), origin=self.origin)
        return ir.Name(f"{bank}{index.value}", origin=self.origin)

    def position_register(self, indices: list[SyntaxTree]) -> Typed:
        index = self.index(indices[0])
        kind = self.facts.register_kind(index.value if isinstance(index, ir.IntLiteral) else None)
        if kind == "j" and isinstance(index, ir.IntLiteral):
            whole: ir.Expression = ir.Name(f"PR{index.value}", origin=self.origin)
        else:
            whole = self.register("PR", index)
        if len(indices) == 1:
            return Typed(whole, kind)
        return Typed(self.element(whole, kind, indices[1]), "n")

    def element(self, whole: ir.Expression, kind: str, number: SyntaxTree) -> ir.Expression:
        """PR[i,j]: X, Y, Z, W, P, R or the joints, then the extended axes."""
        names = tables.JOINT_ELEMENTS if kind == "j" else tables.CARTESIAN_ELEMENTS
        place = self.index(number)
        if isinstance(place, ir.IntLiteral):
            at = place.value
        else:
            at = self.choice(place, tuple(range(1, 7)))
        if not 1 <= at <= len(names):
            raise StatementError(f"a position has no element {at}", 0)
        return ir.Field(whole, names[at - 1], origin=self.origin)

    def point(self, indices: list[SyntaxTree]) -> Typed:
        index = self.index(indices[0])
        if isinstance(index, ir.IntLiteral):
            number = index.value
        else:
            number = self.choice(index, tuple(sorted(self.place.points)))
        kind = self.place.points.get(number, "p")
        whole = ir.Name(f"P{number}", origin=self.origin)
        if len(indices) > 1:
            return Typed(self.element(whole, kind, indices[1]), "n")
        return Typed(whole, kind)

    def choice(self, selector: ir.Expression, options: tuple[int, ...]) -> int:
        """The option that is being lowered; asks for a branch for each when none is chosen yet."""
        key = repr(selector)
        if key not in self.chosen:
            if not options:
                raise StatementError("there is no position that this number could choose", 0)
            raise Choice(key, selector, options)
        return self.chosen[key]

    def argument(self, index: ir.Expression) -> Typed:
        if not isinstance(index, ir.IntLiteral):
            count = self.facts.parameter_count(self.place.program)
            number = self.choice(index, tuple(range(1, count + 1)))
        else:
            number = index.value
        kind = self.facts.parameter_kind(self.place.program, number)
        return Typed(ir.Name(f"AR{number}", origin=self.origin), kind)

    def signal(self, bank: str, indices: list[SyntaxTree]) -> Typed:
        if bank in tables.NAMED_SIGNALS:
            return Typed(self.named_signal(tables.NAMED_SIGNALS[bank], bank, indices), "b")
        kind = tables.NUMBERED_SIGNALS[bank]
        node = ir.Signal(kind, self.index(indices[0]), origin=self.origin)
        return Typed(node, "n" if kind[:5] in ("analo", "group") else "b")

    def named_signal(self, kind: str, bank: str, indices: list[SyntaxTree]) -> ir.Expression:
        index = self.index(indices[0])
        if isinstance(index, ir.IntLiteral):
            return ir.Signal(kind, name=f"{bank}{index.value}", origin=self.origin)
        if bank in tables.NAMED_COUNTS:  # a branch for each that it can be
            number = self.choice(index, tuple(range(1, tables.NAMED_COUNTS[bank] + 1)))
            return ir.Signal(kind, name=f"{bank}{number}", origin=self.origin)
        return ir.VendorValue("tp", self.origin_part(bank), ir.BoolType(), origin=self.origin)


def _tree(child: object) -> SyntaxTree:
    assert isinstance(child, Tree)  # the grammar says so
    return child
