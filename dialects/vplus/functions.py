"""V+ built-in functions in neutral terms. What only the controller can tell becomes a `VendorValue`."""

from __future__ import annotations

import re
from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

from lark import Token, Tree

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes import rigid
from rpl.reading.shapes import StatementError, SyntaxTree
from rpl.source import NOWHERE, Origin

from . import asked, decode, formats, signals, tables
from .expressions import Expressions, based, root_name, significant, subtree
from .formats import Item

UNKNOWN_FUNCTION = code(
    "vplus-unknown-function",
    Severity.WARNING,
    "there is no function {name} that is known here; its value is left to the cell file",
)
Values = list[ir.Expression | None]
_BASED = re.compile(r"\^(?:[Bb][01]+|[Hh][0-9A-Fa-f]+|[0-7]+)")


class Functions(Expressions):
    """Lowers calls of built-in functions."""

    def call(self, tree: SyntaxTree) -> ir.Expression:
        name = str(tree.children[0]).lower()
        arguments = subtree(tree.children[1])
        if name == "$encode":
            return formats.text_of(self.items(arguments), self.origin, line_end="\r\n")
        if name in ("switch", "parameter"):
            told = asked.switch if name == "switch" else asked.parameter
            return told(self.written(arguments).strip("()").lower(), self.facts, self.origin) or self.vendor(tree)
        if name == "$decode":
            return self.cut_off(arguments)
        if name == "get.event":
            flag = self.event(next(iter(self.values(arguments)), None), name)
            return flag if flag is not None else self.vendor(tree)
        if name == "tas":
            return self.test_and_set(arguments, tree)
        if name == "last":
            return self.last_index(arguments, tree)
        values = self.values(arguments)
        found = self.special(name, values) or self.neutral(name, values)
        if found is not None:
            return found
        if not any(values):
            constant = self.constant(name)
            if constant is not None:
                return constant
        return self.asked(name, [value for value in values if value is not None]) or self.vendor(tree)

    def asked(self, name: str, given: Sequence[ir.Expression] = ()) -> ir.Expression | None:
        return asked.value(name, given, self.facts, self.origin)

    def temporary(self, stem: str) -> ir.Name:
        """A variable for what is done in front of the statement at hand."""
        self.cuts += 1
        while significant(f"{stem}.{self.cuts}") in self.names.spellings:
            self.cuts += 1
        return ir.Name(self.name(f"{stem}.{self.cuts}"), origin=self.origin)

    @abstractmethod
    def event(self, task: ir.Expression | None, word: str) -> ir.Name | None:
        """The variable for the event of a task; without a number of the program's own."""

    def test_and_set(self, arguments: SyntaxTree, tree: SyntaxTree) -> ir.Expression:
        """TAS(variable, value): the value it had before; nothing else runs between the two."""
        place, value, *more = [*self.values(arguments), None, None]
        if root_name(place) is None or place is None or value is None or any(more):
            return self.vendor(tree)
        before = self.temporary("tas")
        shared = bool(self.facts.executed)
        steps: list[ir.Statement] = [ir.Assign(before, place), ir.Assign(place, value)]
        if shared:
            steps = [ir.Critical(True), *steps, ir.Critical(False)]
        self.steps.extend(replace(step, origin=self.origin) for step in steps)
        return before

    def last_index(self, arguments: SyntaxTree, tree: SyntaxTree) -> ir.Expression:
        """LAST(array[]): the highest index with a value, -1 without one; looked for from the end of the array."""
        (array, *more) = [*self.values(arguments), None]
        if not isinstance(array, ir.Name) or any(more):
            return self.vendor(tree)
        last, one = self.temporary("last"), ir.IntLiteral(1)
        size = self.built("length", array)
        empty = self.built("is_uninitialised", ir.Index(array, (last,), origin=self.origin))
        further = ir.Binary(">=", last, ir.IntLiteral(0), origin=self.origin)
        down = ir.Assign(last, ir.Binary("-", last, one, origin=self.origin), origin=self.origin)
        self.steps.append(ir.Assign(last, ir.Binary("-", size, one, origin=self.origin), origin=self.origin))
        self.steps.append(ir.While(ir.Binary("cand", further, empty), (down,), origin=self.origin))
        return last

    def cut_off(self, arguments: SyntaxTree) -> ir.Expression:
        """`$DECODE` inside of an expression also changes its text: done in front of the statement, in order, into a
        text of its own."""
        met = tuple(self.met)
        values = self.values(arguments)
        self.met = list(met)
        text = (root_name(values[0]) if values else None) or ""
        if significant(text) in met:
            raise StatementError(f"$DECODE changes {text}, which the same step reads in front of it", 0)
        head = self.temporary("$decoded")
        self.steps.extend(decode.decoded(head, values, self.origin))
        return head

    def values(self, arguments: SyntaxTree) -> Values:
        """The arguments in order; those left out are None. `t BY x` counts as two, `t BY ,, x` as four."""
        values: Values = []
        for child in arguments.children:
            parts = subtree(child).children
            if not parts:
                values.append(None)
            for part in parts:
                if isinstance(part, Token):
                    raise StatementError("a format control stands only in $ENCODE, TYPE and WRITE", 0)
                tree = subtree(part)
                values.append(self.optional(tree) if tree.data == "optional" else self.expression(tree))
        while values and values[-1] is None:
            values.pop()
        return values

    def items(self, tree: SyntaxTree) -> list[Item]:
        """The items of TYPE, WRITE or $ENCODE."""
        items = []
        for child in tree.children:
            parts = subtree(child).children
            controls = tuple(str(part) for part in parts if isinstance(part, Token))
            value = next((self.expression(part) for part in parts if isinstance(part, Tree)), None)
            items.append(Item(controls, value))
        return items

    def built(self, function: str, *arguments: ir.Expression) -> ir.Builtin:
        return ir.Builtin(function, arguments, origin=self.origin)

    def vendor(self, tree: SyntaxTree) -> ir.Expression:
        """A value that only the controller has."""
        name = str(tree.children[0]).lower()
        type = tables.CONTROLLER_VALUES.get(name)
        if type is None:
            self.diagnostics.report(UNKNOWN_FUNCTION, self.origin, name=str(tree.children[0]))
            type = tables.OF_SIGIL.get(name[0], tables.REAL)
        return ir.VendorValue("vplus", self.written(tree), type, origin=self.origin)

    def neutral(self, name: str, values: Values) -> ir.Expression | None:
        """Functions that only have another name."""
        row = tables.FUNCTIONS.get(name)
        given = [value for value in values if value is not None]
        if row is None or len(given) != row[1] or len(values) != row[1]:
            return None
        return self.built(row[0], *given)

    def special(self, name: str, values: Values) -> ir.Expression | None:
        """Functions that are made of several neutral ones."""
        return self.location(name, values) or self.signal_value(name, values) or self.text(name, values) or (
            self.arithmetic(name, [value for value in values if value is not None])
        )  # fmt: skip

    # ---- locations

    def location(self, name: str, values: Values) -> ir.Expression | None:
        zero = ir.IntLiteral(0)
        match name, values:
            case "trans", _ if len(values) <= 6:
                return transformation([values[n] or zero if n < len(values) else zero for n in range(6)], self.origin)
            case "#ppoint", _ if len(values) <= 6:
                return joints_of([values[n] or zero if n < len(values) else zero for n in range(6)])
            case (("rx" | "ry" | "rz"), [ir_value]) if ir_value is not None:
                angles = {"rx": "c", "ry": "b", "rz": "a"}
                entries = tuple((key, ir_value if key == angles[name] else zero) for key in ("x", "y", "z", *"abc"))
                return ir.Aggregate(entries, "pose", origin=self.origin)
            case (("dx" | "dy" | "dz"), [place]) if place is not None:
                return ir.Field(place, name[1], origin=self.origin)
            case "shift", [place, *shift] if place is not None and len(shift) <= 3:
                moved = [shift[n] or zero if n < len(shift) else zero for n in range(3)]
                return self.built("offset", place, *moved)
            case "scale", [place, factor] if place is not None and factor is not None:
                return self.scaled(place, factor)
            case "distance", [one, two] if one is not None and two is not None:
                return self.built("distance", self.position(one), self.position(two))
            case "frame", [one, two, three, origin] if one and two and three and origin:
                return self.frame(one, two, three, origin)
            case "identical", [ir.Name() | ir.Index() as one, ir.Name() | ir.Index() as two]:
                if "#" not in (root_name(one) or "#")[:1] + (root_name(two) or "#")[:1]:
                    return self.identical(one, two)
            case "normal", [place] if place is not None:
                return self.built("pose_of", place)
            case "inrange", [place] if place is not None:  # M: 0 in reach; which bits say why not is not imitated
                reached = self.built("is_reachable", place, self.built("current_joints"))
                return ir.Convert("minus_bit", ir.Unary("not", reached, origin=self.origin), origin=self.origin)
        return None

    def identical(self, one: ir.Expression, two: ir.Expression) -> ir.Expression:
        """Are all numbers of two transformations the same?"""
        parts = [
            ir.Binary("=", ir.Field(one, part), ir.Field(two, part), origin=self.origin)
            for part in ("x", "y", "z", *"abc")
        ]
        done: ir.Expression = parts[0]
        for part in parts[1:]:
            done = ir.Binary("and", done, part, origin=self.origin)
        return done

    def position(self, place: ir.Expression) -> ir.Expression:
        return ir.Field(place, "trans", origin=self.origin)

    def frame(
        self, one: ir.Expression, two: ir.Expression, three: ir.Expression, origin: ir.Expression
    ) -> ir.Expression:
        """FRAME(a, b, c, d): x from a to b, c on the side of positive y, the origin at d."""
        turned = self.built("frame_from_points", *[self.position(place) for place in (one, two, three)])
        if origin == one:
            return turned
        steps = [
            ir.Binary("-", ir.Field(origin, axis), ir.Field(one, axis), origin=self.origin) for axis in ("x", "y", "z")
        ]
        return self.built("offset", turned, *steps)

    # ---- signals, timers, errors, what is defined

    def signal_value(self, name: str, values: Values) -> ir.Expression | None:
        given = [value for value in values if value is not None]
        origin = self.origin
        match name, given:
            case "sig", _:
                return signals.reading(given, self.facts, origin)
            case "bits", [first, *count] if len(count) <= 1:
                size = signals.known(count[0], self.facts) if count else None
                start = signals.known(first, self.facts)
                found = signals.group(start, size, self.facts, origin)
                return found or signals.soft_number(start, size, self.facts, origin)
            case "timer", [ir.Unary(op="-")]:
                return ir.System("time", origin=origin)  # M: the negative timers count the time since the start
            case "timer", [number]:
                return ir.System("timer", (signals.known(number, self.facts),), origin=origin)
            case "aio.in", [number]:
                return ir.Signal("analog_in", number, origin=origin)
            case "error", [ir.Unary(op="-", operand=ir.IntLiteral(value=1))]:
                return ir.System("error_number", origin=origin)
            case "$error", [number]:
                return self.built("error_text", number)
            case "defined", [variable]:
                return ir.Unary("not", self.built("is_uninitialised", variable), origin=origin)
            case "random", []:
                return self.built("random")
            case "task", [ir.IntLiteral(value=tables.TASK_STATE), number]:
                return self.task_state(number)
        return None

    def scaled(self, place: ir.Expression, factor: ir.Expression) -> ir.Expression:
        """SCALE(place BY factor): its position so many times as far from the origin, its orientation as it is."""
        one = ir.IntLiteral(1)
        more: ir.Expression = ir.Binary("-", factor, one, origin=self.origin)
        if isinstance(factor, ir.IntLiteral | ir.RealLiteral):
            more = ir.RealLiteral(factor.value - 1.0)
        shift = [ir.Binary("*", ir.Field(place, part, origin=self.origin), more, origin=self.origin) for part in "xyz"]
        return self.built("offset", place, *shift)

    def task_state(self, number: ir.Expression) -> ir.Expression | None:
        """TASK(1, n): whether the programs that are executed in task n run; None when the project does not tell."""
        key = str(number.value) if isinstance(number, ir.IntLiteral) else (root_name(number) or "").lower()
        programs = sorted(self.facts.executed.get(key, frozenset()))
        elsewhere = {name.lower() for task, names in self.facts.executed.items() if task != key for name in names}
        if not programs or elsewhere & {name.lower() for name in programs}:
            return None
        runs = [self.built("task_runs", ir.TextLiteral(self.name(name))) for name in programs]
        one: ir.Expression = runs[0]
        for other in runs[1:]:
            one = ir.Binary("or", one, other, origin=self.origin)
        executing = ir.IntLiteral(tables.TASK_EXECUTING)
        return ir.Binary("*", executing, ir.Convert("bit", one, origin=self.origin), origin=self.origin)

    # ---- texts

    def text(self, name: str, values: Values) -> ir.Expression | None:
        one = ir.IntLiteral(1)
        match name, values:
            case "asc", [text, *at] if text is not None and len(at) <= 1:
                place = (at[0] if at else None) or None
                return self.built("character_code", self.part(text, place, one) if place is not None else text)
            case (("$intb" | "$lngb"), [value]) if value is not None:
                return self.built("number_bytes", value, ir.IntLiteral(tables.BYTES[name]))
            case (("intb" | "lngb"), [text, *at]) if text is not None and len(at) <= 1:
                first = (at[0] if at else None) or one
                first = one if first == ir.IntLiteral(0) else first
                return self.built("bytes_number", text, first, ir.IntLiteral(tables.BYTES[name]))
            case "val", [ir.TextLiteral(value=digits)] if _BASED.fullmatch(digits):
                return based(digits)
            case "$mid", [text, first, count] if text is not None and count is not None:
                return self.part(text, first or one, count)
            case "$mid", [text, first] if text is not None and first is not None:  # M: all that is left
                rest = signals.less(self.built("text_length", text), -1)
                return self.built("text_part", text, first, ir.Binary("-", rest, first, origin=self.origin))
            case "$unpack", [text, first, count] if text is not None and count is not None:  # M: inside of one element
                return self.part(text, first or one, count)
            case "$truncate", [text] if text is not None:
                end = self.built("text_find_any", text, one, self.built("from_code", ir.IntLiteral(0)))
                return self.built("text_part", text, one, signals.less(end, 1))
            case "strdif", [first, second] if first is not None and second is not None:
                after, before = (ir.Binary(sign, first, second, origin=self.origin) for sign in (">", "<"))
                return ir.Binary("-", ir.Convert("bit", after), ir.Convert("bit", before), origin=self.origin)
            case "pos", [text, wanted, *start] if text is not None and wanted is not None and len(start) <= 1:
                return self.built("text_find", text, (start[0] if start else None) or one, wanted)
        return None

    def part(self, text: ir.Expression, first: ir.Expression, count: ir.Expression) -> ir.Expression:
        """M: $MID gives what is there when fewer characters are left; one character is taken as it is."""
        if isinstance(count, ir.IntLiteral) and count.value == 1:
            return self.built("text_part", text, first, count)
        length = self.built("text_length", text)
        rest: ir.Expression = length
        if first != ir.IntLiteral(1):
            rest = ir.Binary("-", length, signals.less(first, 1), origin=self.origin)
        return self.built("text_part", text, first, self.built("min", count, rest))

    # ---- numbers

    def arithmetic(self, name: str, given: list[ir.Expression]) -> ir.Expression | None:
        origin = self.origin
        match name, given:
            case "sqr", [ir.Name() | ir.IntLiteral() | ir.RealLiteral() as value]:
                return ir.Binary("*", value, value, origin=origin)
            case "sqr", [value]:
                return self.built("power", value, ir.IntLiteral(2))
            case (("min" | "max"), [first, *rest]):
                done = first
                for value in rest:
                    done = self.built(name, done, value)
                return done
            case "sign", [value]:  # 1 at zero, unlike the neutral one
                negative = ir.Binary("<", value, ir.IntLiteral(0), origin=origin)
                twice = ir.Binary("*", ir.IntLiteral(2), ir.Convert("bit", negative, origin=origin), origin=origin)
                return ir.Binary("-", ir.IntLiteral(1), twice, origin=origin)
            case "outside", [low, test, high]:
                below, above = ir.Binary("<", test, low, origin=origin), ir.Binary(">", test, high, origin=origin)
                return ir.Binary("or", below, above, origin=origin)
            case "bcd", [value]:  # four decimal digits, each in four bits
                return self.with_digits(value, 10, 6)
            case "dcb", [value]:
                return self.with_digits(value, 16, -6)
            case "bmask", [_, *_]:
                bits = [self.built("bit_shift_left", ir.IntLiteral(1), signals.less(bit, 1)) for bit in given]
                mask: ir.Expression = bits[0]
                for bit in bits[1:]:
                    mask = ir.Binary("bor", mask, bit, origin=origin)
                return mask
        return None

    def with_digits(self, value: ir.Expression, base: int, step: int) -> ir.Expression:
        """The number whose digits (in `base`) stand in the other base, up to four: 6 more (or less) for each carry."""
        origin, done, weight = self.origin, value, step
        for power in (1, 2, 3):
            higher = self.built("trunc", ir.Binary("/", value, ir.IntLiteral(base**power), origin=origin))
            sign, weight = ("+", weight) if step > 0 else ("-", weight)
            done = ir.Binary(
                sign, done, ir.Binary("*", ir.IntLiteral(abs(weight)), higher, origin=origin), origin=origin
            )
            weight *= 26 - base
        return done

    # ---- text of a tree

    def written(self, node: object) -> str:
        """A call as it is written, for values that only the controller has."""
        if isinstance(node, Tree):
            parts = [self.written(child) for child in node.children]
            match str(node.data):
                case "call":
                    return f"{parts[0]}{parts[1]}"
                case "arguments":
                    return f"({', '.join(parts)})"
                case "argument":
                    return " BY ".join(parts)
                case "brackets":
                    return f"[{', '.join(parts)}]"
                case "group":
                    return f"({parts[0]})"
                case "compose":
                    return ":".join(parts)
                case "reference" | "optional" | "integer" | "real" | "based" | "character" | "text":
                    return "".join(parts)
            if len(parts) == 2 and not parts[0][:1].isalpha():
                return "".join(parts)
            return " ".join(parts)
        return self.spelling(node)


def transformation(values: Sequence[ir.Expression], origin: Origin = NOWHERE) -> ir.Expression:
    """x, y, z, yaw, pitch, roll. Written out angles become the neutral ones (about z, y, x) at once."""
    angles = [constant(value) for value in values[3:]]
    if None in angles:
        return ir.Builtin("pose_zyz", tuple(values), origin=origin)
    yaw, pitch, roll = (angle or 0.0 for angle in angles)
    turns: list[ir.Expression]
    if pitch == 0.0 and 0.0 in (yaw, roll):
        turns = [values[3] if roll == 0.0 else values[5], ir.IntLiteral(0), ir.IntLiteral(0)]
    else:
        turns = list(_neutral_angles(yaw, pitch, roll))
    entries = zip(("x", "y", "z", "a", "b", "c"), (*values[:3], *turns), strict=True)
    return ir.Aggregate(tuple(entries), "pose", origin=origin)


@lru_cache(maxsize=10_000)
def _neutral_angles(yaw: float, pitch: float, roll: float) -> tuple[ir.Expression, ...]:
    """The angles about z, y, x of the same rotation; programs write few different ones."""
    return tuple([literal(angle) for angle in rigid.rotation_of_turns((3, yaw), (2, pitch), (3, roll)).zyx])


def constant(value: ir.Expression) -> float | None:
    """The number that is written out, with its sign."""
    match value:
        case ir.IntLiteral(value=number) | ir.RealLiteral(value=number):
            return float(number)
        case ir.Unary(op="-", operand=ir.IntLiteral(value=number) | ir.RealLiteral(value=number)):
            return -float(number)
    return None


def literal(number: float) -> ir.Expression:
    """A calculated angle, freed from the rounding of its calculation."""
    rounded = round(number, 9) + 0.0
    size = abs(rounded)
    value = ir.IntLiteral(int(size)) if size.is_integer() else ir.RealLiteral(size)
    return ir.Unary("-", value) if rounded < 0.0 else value


def joints_of(values: list[ir.Expression]) -> ir.Aggregate:
    return ir.Aggregate(tuple((f"j{number}", value) for number, value in enumerate(values, 1)), "joints")


__all__ = ["Functions", "joints_of"]
