"""VAL3 expression trees to IR, each value with its kind and what it hangs on (see `places`)."""

from __future__ import annotations

import re
from collections.abc import Callable

from lark import Token, Tree

from rpl import ir
from rpl.reading.shapes import Slot, StatementError, SyntaxTree, real_number
from rpl.registry import words
from rpl.source import Origin

from .data import FLAGS, JOINTS, POSE
from .facts import Declared, Facts
from .places import WORLD, Value, angle, composed, number_of, pose

TYPES: dict[str, ir.Type] = {
    "num": ir.RealType(),
    "bool": ir.BoolType(),
    "string": ir.StringType(),
    "trsf": ir.PoseType(),
    "frame": ir.PoseType(),
    "tool": ir.PoseType(),
    "point": ir.TargetType("val3", external=False),
    "joint": ir.JointsType(external=False),
    "mdesc": ir.NamedType("mdesc"),
}
RELATIONS = words("val3").pairs("relations")
# Words of a configuration and the flag that they mean (None: as at the start).
CONFIGURATIONS: dict[str, int | None] = {
    **{
        word: flag
        for text in words("val3").pairs("configuration").values()
        for word, flag in zip(text.split(), (0, 1, 2, None), strict=True)
    },
    "free": 2,
    "same": None,
}
BLENDS = {"off": 0, "joint": 1, "cartesian": 2, "Cartesian": 2}
_ESCAPE = re.compile(r"\\(.)", re.DOTALL)
_NUMBERED_OUTPUT = re.compile(r"[da]o\d+", re.IGNORECASE)
_OUTPUT = re.compile(r"%Q|\bb?Out|\bout|valve|\bDO|\bAO", re.IGNORECASE)


class Expressions:
    """Lowers the expressions of one statement after the other; `numbers` and `origin` are those of the statement."""

    def __init__(self, facts: Facts) -> None:
        self.facts = facts
        self.numbers: tuple[str, ...] = ()
        self.origin = Origin()
        self.own: dict[str, Declared] = {}
        self.fathers: dict[str, ir.Expression] = {}  # of local points: the frame they were given first
        self.functions: dict[str, Callable[[list[SyntaxTree]], Value]] = {}

    # ---- entry

    def value(self, tree: SyntaxTree, wanted: str = "") -> Value:
        """The value of a tree. `wanted`: the kind that the place needs, for lists in braces."""
        children = tree.children
        match tree.data:
            case "int":
                spelling = self.spelling(children[0])
                number = int(spelling)
                small = ir.IntLiteral(number, spelling)
                return Value(small if number < 1 << 31 else ir.RealLiteral(float(number), spelling), "num")
            case "real":
                spelling = self.spelling(children[0])
                return Value(ir.RealLiteral(real_number(spelling), spelling), "num")
            case "text":
                return Value(ir.TextLiteral(_ESCAPE.sub(r"\1", str(children[0])[1:-1])), "string")
            case "true" | "false":
                return Value(ir.BoolLiteral(tree.data == "true"), "bool")
            case "parenthesis":
                return self.value(subtree(children[0]), wanted)
            case "name":
                return self.element(self.named(str(children[0])))
            case "foreign":
                return self.foreign(str(children[0]), str(children[1]))
            case "index":
                return self.index(tree)
            case "member":
                return self.member(tree)
            case "aggregate":
                return self.listed(parts_of(children[0]), wanted)
            case "function":
                return self.function(tree)
        return self.operation(tree, wanted)

    def number(self, tree: SyntaxTree) -> ir.Expression:
        return self.value(tree, "num").node

    def spelling(self, child: object) -> str:
        return self.numbers[child.index] if isinstance(child, Slot) else str(child)

    # ---- names

    def named(self, name: str) -> tuple[Value, int]:
        """What a name means, and how many dimensions it has (0: it is a single datum)."""
        if name in self.own:
            declared = self.own[name]
            if declared.kind in ("dio", "aio"):
                return Value(ir.Signal(self.direction(name, declared.kind), name=name), declared.kind), 0
            place = self.fathers.get(name, WORLD)
            node = ir.Name(name, origin=self.origin)
            if declared.kind in ("frame", "tool"):
                place = node
            return Value(node, declared.kind, place), len(declared.sizes) if declared.sizes != (1,) else 0
        if name in CONFIGURATIONS:
            flag = CONFIGURATIONS[name]
            return Value(ir.IntLiteral(9 if flag is None else flag), "config"), 0
        if name in ("world", "flange"):
            return Value(WORLD, "frame" if name == "world" else "tool"), 0
        datum = self.facts.data.get(name)
        if datum is None:
            if name in BLENDS:
                return Value(ir.IntLiteral(BLENDS[name]), "num"), 0
            return Value(ir.Name(name, origin=self.origin)), 0
        dimensions = len(datum.sizes) if datum.sizes != (1,) else 0
        if datum.kind in ("dio", "aio"):
            return Value(ir.Signal(self.direction(name, datum.kind), name=name), datum.kind), dimensions
        node = ir.Name(name, origin=self.origin)
        return Value(node, datum.kind, self.place_of(name)), dimensions

    def place_of(self, name: str) -> ir.Expression:
        """Where a global point, frame or tool hangs: for frames and tools without themselves."""
        datum = self.facts.data[name]
        place: ir.Expression = WORLD
        seen = {name}
        father, number = datum.father
        chain: list[ir.Expression] = []
        while father and father not in seen:
            seen.add(father)
            other = self.facts.data.get(father)
            if other is None:
                raise StatementError(f"the frame {father} is not known", 0)
            node: ir.Expression = ir.Name(father)
            chain.append(ir.Index(node, (ir.IntLiteral(number),)) if other.size > 1 else node)
            father, number = other.father
        for node in reversed(chain):
            place = composed(place, node)
        return place

    def element(self, found: tuple[Value, int]) -> Value:
        """The value of a name; an array without an index is its first element."""
        value, dimensions = found
        if dimensions:
            return self.at(value, *[ir.IntLiteral(0)] * dimensions)
        return self.hung(value)

    def hung(self, value: Value) -> Value:
        """Frames and tools: `place` is the whole chain with themselves."""
        own = isinstance(value.node, ir.Name | ir.Index) and value.kind in ("frame", "tool")
        if own and value.place != value.node:
            return Value(value.node, value.kind, composed(value.place, value.node))
        return value

    def at(self, value: Value, *indices: ir.Expression) -> Value:
        if isinstance(value.node, ir.Signal):
            index = indices[0]
            if len(indices) > 1 or not isinstance(index, ir.IntLiteral):
                raise StatementError("which signal of a list is meant has to be known when the program is read", 0)
            name = f"{value.node.name}{index.value}"
            return Value(ir.Signal(value.node.kind, name=name), value.kind)
        return self.hung(Value(ir.Index(value.node, indices, origin=self.origin), value.kind, value.place))

    def index(self, tree: SyntaxTree) -> Value:
        base, items = subtree(tree.children[0]), parts_of(tree.children[1])
        if base.data != "name":
            raise StatementError("a list has a name here", 0)
        value, dimensions = self.named(str(base.children[0]))
        given = [self.value(item) for item in items]
        if any(one.kind == "string" for one in given):
            raise StatementError("collections cannot be read", 0)
        if len(given) != max(dimensions, 1):
            raise StatementError(f"this list has {max(dimensions, 1)} dimensions", 0)
        return self.at(value, *(one.node for one in given))

    def foreign(self, library: str, name: str) -> Value:
        """Data of a library: the signals of `io:` are those of the cell."""
        if name in self.facts.data:
            return self.element(self.named(name))
        kind = "digital_out" if _OUTPUT.search(name) else "digital_in"
        return Value(ir.Signal(kind, name=name), "dio")

    def direction(self, name: str, kind: str) -> str:
        """Is a signal an output? It is where something sets it, or where its wiring or a name such as do5 says so."""
        datum = self.facts.data.get(name)
        link = " ".join(value.get("link", "") for value in datum.values.values()) if datum is not None else ""
        said = "%Q" in link or bool(_OUTPUT.search(link)) or bool(_NUMBERED_OUTPUT.fullmatch(name))
        out = said or name in self.facts.assigned
        return f"{'digital' if kind == 'dio' else 'analog'}_{'out' if out else 'in'}"

    # ---- components and lists

    def member(self, tree: SyntaxTree) -> Value:
        base, name = self.value(subtree(tree.children[0])), str(tree.children[1])
        node = base.node
        match base.kind, name:
            case "point" | "frame" | "tool", "trsf":
                return Value(ir.Builtin("pose_of", (node,)) if base.kind == "point" else node, "trsf")
            case "point", "config":
                return Value(node, "config")
            case "config", "shoulder" | "elbow" | "wrist":
                return Value(ir.Field(node, name), "num")
            case "trsf", "x" | "y" | "z":
                return Value(ir.Field(_bare(node), name), "num")
            case "trsf", "rx" | "ry" | "rz":
                return Value(angle(node, name), "num")
            case "joint", _ if name in JOINTS:
                return Value(ir.Field(node, name), "num")
            case "mdesc", _:
                return Value(ir.Field(node, name), "num")
        raise StatementError(f"{name} is no component that can be read here", 0)

    def listed(self, items: list[SyntaxTree], wanted: str) -> Value:
        """A list in braces, by the kind that its place needs; six numbers are a trsf else."""
        if wanted in ("point", "frame", "tool") and items and items[0].data == "aggregate":
            inner = self.listed(parts_of(items[0].children[0]), "trsf").node
            if wanted != "point":
                return Value(inner, wanted)
            if not isinstance(inner, ir.Aggregate):
                raise StatementError("a point in braces needs constant angles", 0)
            flags = parts_of(items[1].children[0]) if len(items) > 1 and items[1].data == "aggregate" else []
            return Value(target(inner, [self.flag(flag) for flag in flags]), "point")
        if wanted == "joint":
            nodes = [self.number(item) for item in items]
            return Value(ir.Aggregate(tuple(zip(JOINTS, nodes, strict=False)), "joints"), "joint")
        if len(items) != len(POSE):
            raise StatementError("six numbers make a trsf", 0)
        return Value(pose(tuple(self.number(item) for item in items)), "trsf")

    def flag(self, tree: SyntaxTree) -> int | None:
        word = str(tree.children[0]) if tree.data == "name" else ""
        if word not in CONFIGURATIONS:
            raise StatementError("a configuration is made of righty, lefty, ssame and the like", 0)
        return CONFIGURATIONS[word]

    # ---- operators and functions

    def operation(self, tree: SyntaxTree, wanted: str) -> Value:
        children = tree.children
        match tree.data:
            case "negation":
                inner = self.value(subtree(children[0]))
                if inner.kind == "trsf":
                    return Value(ir.Builtin("inverse", (inner.node,)), "trsf")
                return Value(ir.Unary("not", inner.node, origin=self.origin), "bool")
            case "signed":
                inner = self.value(subtree(children[1]))
                return inner if children[0] == "+" else Value(ir.Unary("-", inner.node, origin=self.origin), "num")
            case "both":
                return self.logic("cand", children[0], children[1])
            case "either":
                return self.logic("cor" if children[1] == "or" else "xor", children[0], children[2])
        left, right = self.value(subtree(children[0])), self.value(subtree(children[2]))
        sign = str(children[1])
        if tree.data == "compare":
            op = RELATIONS.get(sign, sign)
            return Value(ir.Binary(op, left.node, right.node, origin=self.origin), "bool")
        if sign == "*" and left.kind in ("trsf", "frame", "tool"):
            return Value(ir.Binary(":", left.node, right.node, origin=self.origin), "trsf")
        if sign == "+" and "string" in (left.kind, right.kind):
            return Value(ir.Binary("&", as_text(left), as_text(right), origin=self.origin), "string")
        op = "mod" if sign == "%" else sign
        return Value(ir.Binary(op, left.node, right.node, origin=self.origin), "num")

    def logic(self, op: str, left: object, right: object) -> Value:
        one, other = self.value(subtree(left)).node, self.value(subtree(right)).node
        return Value(ir.Binary(op, one, other, origin=self.origin), "bool")

    def function(self, tree: SyntaxTree) -> Value:
        head = subtree(tree.children[0])
        items = parts_of(tree.children[1]) if len(tree.children) > 1 else []
        if head.data != "name":
            raise StatementError("only functions of the language can be used here", 0)
        name = str(head.children[0])
        made = self.functions.get(name)
        if made is None:
            raise StatementError(f"the function {name} is not known", 0)
        try:
            return made(items)
        except (IndexError, ValueError):
            raise StatementError(f"{name} has other arguments", 0) from None


def as_text(value: Value) -> ir.Expression:
    return value.node if value.kind == "string" else ir.Builtin("value_text", (value.node,))


def target(place: ir.Aggregate, flags: list[int | None]) -> ir.Aggregate:
    """A point of its trsf and its flags; `same` is a flag left out."""
    given = tuple((name, ir.IntLiteral(flag)) for name, flag in zip(FLAGS, flags, strict=False) if flag is not None)
    return ir.Aggregate((*place.entries, *given), "target val3")


def _bare(node: ir.Expression) -> ir.Expression:
    """The point itself: its x, y, z are those of its pose."""
    match node:
        case ir.Builtin(function="pose_of", arguments=(inner,)):
            return inner
    return node


def subtree(child: object) -> SyntaxTree:
    assert isinstance(child, Tree)  # a promise of the grammar
    return child


def parts_of(child: object) -> list[SyntaxTree]:
    return [subtree(one) for one in subtree(child).children]


__all__ = ["BLENDS", "TYPES", "Expressions", "Token", "as_text", "number_of", "parts_of", "subtree", "target"]
