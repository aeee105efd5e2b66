"""Groups of signals taken apart: into their signals, or into smaller groups of the sizes that the target knows.

Written: each part gets its share of the number. Read: the parts are added up in front of the statement, or where they
are read when the target takes signals as numbers. Groups with computed numbers become signals with computed numbers
where they have a constant width.
"""

from __future__ import annotations

from collections.abc import Set
from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.legalise.rewriting.bodies import Hoister, Lowered
from rpl.passes.legalise.rewriting.editing import Editor, expansion
from rpl.passes.legalise.rewriting.polling import polled

_WIDEST = 32
ONE_BY_ONE = code(
    "group-bit-by-bit",
    Severity.WARNING,
    "the outputs {which} are written one after another: who reads them as one number sees others on the way",
    "declare a group of signals in the target's controller, or let an output of its own say when the number stands",
)


Group = tuple[str, int, int]  # kind of its bits, first and last number


def group_of(signal: ir.Signal) -> Group | None:
    """A group with constant numbers; a single signal is a group of one."""
    match signal:
        case ir.Signal(kind=kind, index=ir.IntLiteral(value=first), last=last, name=None):
            if last is None and kind.startswith("digital"):
                return kind, first, first
            if isinstance(last, ir.IntLiteral):
                return kind.replace("group", "digital"), first, last.value
    return None


def is_computed(signal: ir.Signal) -> bool:
    """A group with computed numbers."""
    return signal.last is not None and signal.name is None and group_of(signal) is None


Line = tuple[ir.Expression | None, int, int]  # factor and what is added


def _line(number: ir.Expression) -> Line:
    """A number as something times a constant, plus a constant."""
    match number:
        case ir.IntLiteral(value=value):
            return None, 0, value
        case ir.Binary(op="+" | "-" as op, left=left, right=ir.IntLiteral(value=value)):
            what, factor, added = _line(left)
            return what, factor, added + (value if op == "+" else -value)
        case ir.Binary(op="*", left=left, right=ir.IntLiteral(value=value)):
            what, factor, added = _line(left)
            return what, factor * value, added * value
    return number, 1, 0


def _computed_bits(signal: ir.Signal) -> list[ir.Signal]:
    """The signals of a group with computed numbers and a constant width."""
    if signal.index is None or signal.last is None:
        return []
    (what, factor, first), (same, again, last) = _line(signal.index), _line(signal.last)
    if what is None or what != same or factor != again or not 0 <= last - first < _WIDEST:
        return []
    scaled = ir.Binary("*", what, ir.IntLiteral(factor)) if factor != 1 else what
    single = signal.kind.replace("group", "digital")
    numbers = (
        ir.Binary("+" if n > 0 else "-", scaled, ir.IntLiteral(abs(n))) if n else scaled for n in range(first, last + 1)
    )
    return [ir.Signal(single, number, origin=signal.origin) for number in numbers]


def _bits(signal: ir.Expression) -> list[ir.Signal]:
    """The signals of a group, lowest bit first; empty for everything else."""
    if isinstance(signal, ir.Signal) and is_computed(signal):
        return _computed_bits(signal)
    match signal:
        case ir.Signal(kind=kind, index=ir.IntLiteral(value=first), last=ir.IntLiteral(value=last), name=None):
            if 0 <= last - first < _WIDEST:
                single = kind.replace("group", "digital")
                return [ir.Signal(single, ir.IntLiteral(n), origin=signal.origin) for n in range(first, last + 1)]
    return []


def _in_sizes(bits: list[ir.Signal], sizes: tuple[int, ...]) -> list[ir.Signal]:
    """Signals in a row as groups of the sizes, each behind a multiple of its size, and single ones between them."""
    done: list[ir.Signal] = []
    at = 0
    while at < len(bits):
        width, first = 1, bits[at].index
        if isinstance(first, ir.IntLiteral):
            fitting = (one for one in sizes if one <= len(bits) - at and (first.value - 1) % one == 0)
            width = max(fitting, default=1)
        last = bits[at + width - 1].index
        done.append(bits[at] if width == 1 else replace(bits[at], last=last))
        at += width
    return done


def _width(part: ir.Signal) -> int:
    """How many signals there are in a part of a group."""
    match part:
        case ir.Signal(index=ir.IntLiteral(value=first), last=ir.IntLiteral(value=last)):
            return last - first + 1
    return 1


def _placed(parts: list[ir.Signal]) -> list[tuple[int, ir.Signal]]:
    """Each part with the place of its lowest bit in the whole number."""
    places, at = [], 0
    for part in parts:
        places.append((at, part))
        at += _width(part)
    return places


def _numbers(bits: list[ir.Signal]) -> str:
    """The first and last number of the signals, as far as they are known."""
    first, last = bits[0].index, bits[-1].last or bits[-1].index
    if isinstance(first, ir.IntLiteral) and isinstance(last, ir.IntLiteral):
        return f"{first.value} to {last.value}"
    return "of a group with computed numbers"


class GroupsAsBits(Hoister):
    """Every group is taken apart into its signals."""

    def __init__(self, editor: Editor, acts_on: Set[str] = frozenset()) -> None:
        super().__init__(editor, self.ruled, acts_on)
        self.told: set[str] = set()  # groups of this routine that are written bit by bit

    def bits(self, expression: ir.Expression) -> list[ir.Signal]:
        """The signals of a group that is taken apart."""
        return _bits(self.signal(expression))

    def signal(self, expression: ir.Expression) -> ir.Expression:
        """The signal that a declared name stands for."""
        if isinstance(expression, ir.Name):
            symbol = self.editor.scope.value(expression.id)
            if symbol is not None and isinstance(symbol.declaration, ir.SignalDeclaration):
                return replace(symbol.declaration.signal, origin=expression.origin)
        return expression

    def ruled(self, expression: ir.Expression) -> Lowered | None:
        """The group's number, added up beforehand; one that is compared with a number that stands there is compared
        bit by bit, which needs nothing before it."""
        if isinstance(expression, ir.Binary):
            compared = self.compared(expression)
            return None if compared is None else ((), compared)
        bits = self.bits(expression)
        if not bits:
            return None
        number = self.editor.temporary("bits", ir.IntType())
        done: list[ir.Statement] = [ir.Assign(number, ir.IntLiteral(0))]
        for place, bit in enumerate(bits):
            more = ir.Assign(number, ir.Binary("+", number, ir.IntLiteral(2**place)))
            done.append(ir.If(((bit, (more,)),)))
        return tuple(done), number

    def compared(self, expression: ir.Binary) -> ir.Expression | None:
        """`group = 5`, `group <> 0` and the like by the signals themselves."""
        match expression:
            case ir.Binary(op=op, left=group, right=ir.IntLiteral(value=number)):
                op = {">": "<>", "<=": "="}.get(op, op) if number == 0 else op
            case ir.Binary(op=op, left=ir.IntLiteral(value=number), right=group):
                op = {"<": "<>", ">=": "="}.get(op, op) if number == 0 else op
            case _:
                return None
        bits = self.bits(group)
        if op not in ("=", "<>") or not bits:
            return None
        if not 0 <= number < 2 ** sum(map(_width, bits)):
            return ir.BoolLiteral(op == "<>", origin=expression.origin)
        differs = op == "<>"
        done: ir.Expression | None = None
        for place, bit in _placed(bits):
            part: ir.Expression = bit
            if (width := _width(bit)) > 1:
                part = ir.Binary(op, bit, ir.IntLiteral(number >> place & (1 << width) - 1), origin=expression.origin)
            elif bool(number >> place & 1) == differs:
                part = ir.Unary("not", bit, origin=expression.origin)
            done = part if done is None else ir.Binary("or" if differs else "and", done, part, origin=expression.origin)
        return done

    def placed(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.WaitUntil() if self.looks(statement.condition):
                return self.waited(statement)
            case ir.Assign(target=target, value=value) if bits := self.bits(target):
                return self.written(statement, bits, value)
        return super().placed(statement)

    def looks(self, condition: ir.Expression) -> bool:
        """Does the condition read a group that is taken apart?"""
        return any(isinstance(one, ir.Signal | ir.Name) and self.bits(one) for one in walk(condition))

    def waited(self, statement: ir.WaitUntil) -> ir.Body:
        """A wait for a group: for its signals, or where these say it only by a number, a loop that looks again."""
        watched = replace(statement, condition=self.flat(statement.condition))
        if not self.looks(watched.condition) or (statement.timeout is not None and statement.timed_out is None):
            return (watched,)
        return self.body(polled(statement, self.editor))

    def written(self, statement: ir.Assign, bits: list[ir.Signal], value: ir.Expression) -> ir.Body:
        before, given = self.lower(value)
        first: list[ir.Statement] = list(before)
        whole = isinstance(self.editor.type_of(given), ir.IntType)
        if not whole or not isinstance(given, ir.IntLiteral | ir.Name):
            kept = self.editor.temporary("bits", ir.IntType())
            first.append(ir.Assign(kept, given if whole else ir.Convert("round_half_away", given)))
            given = kept
        self.tell(statement, bits)
        shares = [ir.Assign(bit, self.share(given, place, _width(bit))) for place, bit in _placed(bits)]
        done = expansion(statement.origin, (*first, *shares))
        return tuple(replace(one, origin=statement.origin) if at == 0 else one for at, one in enumerate(done))

    def tell(self, statement: ir.Assign, bits: list[ir.Signal]) -> None:
        """That the signals do not turn at the same moment; once for each group of a routine."""
        which = _numbers(bits)
        if len(bits) > 1 and which not in self.told:
            self.told.add(which)
            self.editor.context.diagnostics.report(ONE_BY_ONE, statement.origin, which=which)

    def share(self, number: ir.Expression, place: int, width: int) -> ir.Expression:
        """Is the bit set in the number? Of several bits: the number that they show."""
        if isinstance(number, ir.IntLiteral):
            shown = number.value >> place & (1 << width) - 1
            return ir.IntLiteral(shown) if width > 1 else ir.BoolLiteral(bool(shown))
        cut = ir.Binary("div", number, ir.IntLiteral(2**place)) if place else number
        part = ir.Binary("mod", cut, ir.IntLiteral(2**width))
        return part if width > 1 else ir.Binary("=", part, ir.IntLiteral(1))


class GroupsInParts(GroupsAsBits):
    """The groups `apart`, names that are declared for such, and groups with computed numbers if these are asked for.
    sizes: of the groups that the target has, each behind a multiple of its size; the parts are such groups and signals
    between them."""

    def __init__(
        self, editor: Editor, apart: frozenset[Group], computed: bool = False, sizes: tuple[int, ...] = ()
    ) -> None:
        super().__init__(editor)
        self.apart, self.computed, self.sizes = apart, computed, sizes

    def bits(self, expression: ir.Expression) -> list[ir.Signal]:
        signal = self.signal(expression)
        if not isinstance(signal, ir.Signal):
            return []
        apart = group_of(signal) in self.apart or (self.computed and is_computed(signal))
        return _in_sizes(_bits(signal), self.sizes) if apart else []

    def lower(self, expression: ir.Expression, lvalue: bool = False) -> Lowered:
        compared = self.by_parts(expression)
        return super().lower(expression, lvalue) if compared is None else ((), compared)

    def flat(self, expression: ir.Expression) -> ir.Expression:
        compared = self.by_parts(expression)
        return super().flat(expression) if compared is None else compared

    def by_parts(self, expression: ir.Expression) -> ir.Expression | None:
        """Parts that are groups again are compared one by one."""
        return self.compared(expression) if self.sizes and isinstance(expression, ir.Binary) else None

    def ruled(self, expression: ir.Expression) -> Lowered | None:
        """The sum of the bits by their weights; of those with computed numbers added up beforehand."""
        if isinstance(expression, ir.Signal) and is_computed(expression):
            return super().ruled(expression)
        parts: list[ir.Expression] = []
        for place, bit in _placed(self.bits(expression)):
            value: ir.Expression = bit if _width(bit) > 1 else ir.Convert("bit", bit)
            parts.append(ir.Binary("*", ir.IntLiteral(2**place), value) if place else value)
        if not parts:
            return None
        total = parts[0]
        for part in parts[1:]:
            total = ir.Binary("+", total, part, origin=expression.origin)
        return (), total


__all__ = ["ONE_BY_ONE", "Group", "GroupsAsBits", "GroupsInParts", "group_of", "is_computed"]
