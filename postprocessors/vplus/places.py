"""Variables, elements, signals and system variables as V+ values, and numbers of signals."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.typewords import word_type
from rpl.writing.precedence import ATOM, Printed
from rpl.writing.statements import CannotSayError

from . import spelling, tables
from .locations import Locations

if TYPE_CHECKING:
    from .expressions import Expressions


class Places:
    """Names and what belongs to them, in one routine."""

    def __init__(self, expressions: Expressions) -> None:
        self.expressions = expressions
        self.locations = Locations(expressions)

    def refuse(self, reason: str) -> Exception:

        return CannotSayError(reason)

    def value(self, expression: ir.Expression) -> str | Printed:
        match expression:
            case ir.Name(id=name):
                signal = self.declared(name)
                return self.name(expression) if signal is None else self.signal(signal)
            case ir.Index():
                return self.index(expression)
            case ir.Field(base=base, name=name):
                return self.locations.component(base, name)
            case ir.Aggregate():
                return self.aggregate(expression)
            case ir.Signal():
                return self.signal(expression)
            case ir.System(name=name, indices=indices):
                return self.system(name, indices)
        raise self.refuse("there is no such value")

    def name(self, name: ir.Name) -> str:
        """A variable with its sign."""
        return spelling.spelled(name.id, self.expressions.type(name))

    def whole_array(self, value: ir.Expression) -> str:
        """An array as an argument: `a[]`, `a[,]`."""
        type = self.expressions.type(value)
        rank = len(type.dimensions) if isinstance(type, ir.ArrayType) else 1
        return f"{self.expressions.text(value)}[{',' * (rank - 1)}]"

    def index(self, expression: ir.Index) -> str:
        """An element; arrays of V+ begin at 0."""
        base, indices = expression.base, expression.indices
        if isinstance(base, ir.Index):
            return self.index(ir.Index(base.base, (*base.indices, *indices)))
        type = self.expressions.type(base)
        if isinstance(type, ir.StringType):
            if len(indices) != 1:
                raise self.refuse("more than one index into a text")
            return f"$MID({self.expressions.text(base)}, {self.expressions.text(indices[0])}, 1)"
        return f"{self.expressions.text(base)}[{', '.join(self.expressions.text(one) for one in indices)}]"

    def aggregate(self, aggregate: ir.Aggregate) -> str | Printed:
        type = word_type(aggregate.type_name, self.expressions.scope) if aggregate.type_name else None
        named = {name: value for name, value in aggregate.entries if name is not None}
        match type:
            case ir.PoseType() | ir.TargetType() | ir.VectorType() | ir.RotationType():
                self.no_external(named)
                return self.locations.pose(aggregate, named)
            case ir.JointsType() | ir.AxesType():
                self.no_external(named)
                return self.locations.joints(named)
        raise self.refuse("a list can be written only where it is stored")

    def no_external(self, named: dict[str, ir.Expression]) -> None:
        """External axes may be given where they stand still at zero or do not exist."""
        for name in tables.EXTERNAL:
            value = named.get(name)
            if value is not None:
                number = self.expressions.known(value)
                if number is None or (number != 0 and abs(number) < tables.UNUSED):
                    raise self.refuse("there are no external axes")

    # ---- signals

    def declared(self, name: str) -> ir.Signal | None:
        """The signal that a name is declared for."""
        symbol = self.expressions.scope.value(name)
        if symbol is None or not isinstance(symbol.declaration, ir.SignalDeclaration):
            return None
        return symbol.declaration.signal

    def numbered(self, signal: ir.Signal) -> ir.Signal:
        found = self.declared(signal.name) if signal.name is not None and signal.index is None else None
        return signal if found is None else found

    def is_group(self, signal: ir.Signal) -> bool:
        return signal.kind in tables.GROUPS or signal.last is not None

    def number(self, signal: ir.Signal, negative: bool = False) -> str:
        """The controller's number of a digital signal, with a sign in front for its off state."""
        kind = tables.GROUPS.get(signal.kind, signal.kind)
        if kind not in tables.SIGNALS:
            raise self.refuse(f"there is no signal of kind {signal.kind.replace('_', ' ')}")
        if signal.index is None:
            raise self.refuse(f"signals have numbers; {signal.name or 'this one'} has none")
        offset = tables.SIGNALS[kind]
        known = self.expressions.known(signal.index)
        named = any(isinstance(one, ir.Name) for one in walk(signal.index))
        if known is not None and not named:
            if not tables.is_signal(kind, known):
                raise self.refuse(f"there is no signal {known:g} of this kind, only 1 to {tables.MOST_SIGNALS}")
            return spelling.number(-(known + offset) if negative else known + offset)
        index = plus(signal.index, offset)
        return self.expressions.text(ir.Unary("-", index) if negative else index)

    def signal(self, signal: ir.Signal) -> str:
        """The value of a signal."""
        signal = self.numbered(signal)
        if signal.kind == "analog_in" and signal.index is not None:
            return f"AIO.IN({self.expressions.text(signal.index)})"
        if self.is_group(signal):
            return f"BITS({self.group(signal)})"
        return f"SIG({self.number(signal)})"

    def group(self, signal: ir.Signal) -> str:
        """First signal and how many."""
        first, last = signal.index, signal.last
        if first is None or last is None:
            raise self.refuse("a group of signals without its first and last number")
        number = self.number(signal)
        low, high = self.expressions.known(first), self.expressions.known(last)
        if low is not None and high is not None:
            count = high - low + 1
            if count > tables.MOST_BITS:
                raise self.refuse(f"a group has at most {tables.MOST_BITS} signals")
            return f"{number}, {spelling.number(count)}"
        match last:
            case ir.Binary(op="+", left=left, right=right) if left == first:
                return f"{number}, {self.expressions.text(plus(right, 1))}"
        return f"{number}, {self.expressions.text(plus(ir.Binary('-', last, first), 1))}"

    # ---- system variables

    def system(self, name: str, indices: tuple[ir.Expression, ...]) -> str | Printed:
        if name == "timer" and len(indices) == 1:
            return f"TIMER({self.expressions.text(indices[0])})"
        if name == "timer_positive" and len(indices) == 1:
            return Printed(f"TIMER({self.expressions.text(indices[0])}) > 0", tables.RELATION)
        if name == "flag" and len(indices) == 1:
            return self.signal(ir.Signal("flag", indices[0]))
        if name in tables.SYSTEM and not indices:
            return tables.SYSTEM[name]
        if name == "actual_joint" and len(indices) == 1:
            number = self.expressions.known(indices[0])
            if number is not None and 1 <= number <= len(tables.AXES):
                return self.locations.decomposed(ir.Builtin("current_joints", ()), int(number) - 1)
        if name == "remaining_distance" and not indices:
            return Printed("DISTANCE(HERE, DEST)", ATOM)
        if name == "moving" and not indices:
            return Printed(f"DISTANCE(HERE, DEST) > {tables.STANDS_MM:g}", tables.RELATION)
        raise self.refuse(f"there is no system variable for {name.replace('_', ' ')}")


def plus(value: ir.Expression, offset: int) -> ir.Expression:
    """The value and a whole number, worked out where it can be."""
    match value:
        case ir.IntLiteral(value=number):
            return ir.IntLiteral(number + offset)
        case ir.RealLiteral(value=real):
            return ir.RealLiteral(real + offset)
        case ir.Binary(op="-", left=left, right=ir.IntLiteral(value=number)) if number == offset:
            return left
        case ir.Binary(op="+", left=left, right=ir.IntLiteral(value=number)):
            return plus(left, number + offset)
        case ir.Binary(op="-", left=left, right=ir.RealLiteral(value=real)) if real == offset:
            return left
    return ir.Binary("+", value, ir.IntLiteral(offset)) if offset else value
