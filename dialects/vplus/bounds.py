"""The largest value that a V+ number can have, as far as the project tells: what the sizes of arrays are taken from.

Every value that a variable, a parameter or the elements of an array are given anywhere is looked at, through calls as
well. What grows with each pass of a loop, or comes from outside, has no bound.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from rpl import ir
from rpl.ir.walk import walk

from .blocks import DataPart, ProgramPart
from .expressions import root_name, significant

Symbol = tuple[str, str]  # program ("" for all), significant name
Given = tuple[str, ir.Expression | None]  # the program where the value is; None: nobody can tell it
NOTHING = -1  # of what is given no value at all
_ROUNDS = 40  # a bound that still grows then has no end
_LARGEST = 1_000_000  # no index is larger; what is squared in a loop grows without measure


@dataclass(slots=True)
class Bounds:
    """`own`: program -> names that belong to it alone; `sources`: what each symbol is given."""

    own: Mapping[str, Mapping[str, str]]
    sources: dict[Symbol, list[Given]] = field(default_factory=dict)
    changed: set[Symbol] = field(default_factory=set)  # parameters that their own program stores into
    known: dict[Symbol, int | None] = field(default_factory=dict)

    def symbol(self, program: str, name: str) -> Symbol:
        key = significant(name)
        return (program, key) if key in self.own.get(program, ()) else ("", key)

    def collect(self, programs: Mapping[str, ProgramPart], nodes: Mapping[str, list[object]]) -> None:
        """What the steps of all programs give."""
        calls = [(key, node) for key, some in nodes.items() for node in some if isinstance(node, _CALLS)]
        for key, some in nodes.items():
            for node in some:
                for variable, value in _given(node):
                    symbol = self.symbol(key, variable)
                    self.sources.setdefault(symbol, []).append((key, value))
                    if self.own.get(key, {}).get(symbol[1]) == "parameter":
                        self.changed.add(symbol)
        grown = -1
        while grown != len(self.changed):  # what is handed on to a program that stores into it
            grown = len(self.changed)
            for key, call in calls:
                for into, given in self.handed(key, call, programs):
                    if into in self.changed and self.own.get(key, {}).get(given[1]) == "parameter":
                        self.changed.add(given)
        for key, call in calls:
            self.called(key, call, programs)
        found = {significant(_named(call)) for _, call in calls}
        dynamic = any(isinstance(call, ir.CallRoutine) and call.dynamic is not None for _, call in calls)
        for key, part in programs.items():
            for parameter, _ in part.header.parameters if dynamic or key not in found else ():
                self.sources.setdefault((key, significant(parameter)), []).append((key, None))
        for key, some in nodes.items():
            self.behind_loops(key, some)

    def behind_loops(self, key: str, nodes: list[object]) -> None:
        """A counter that is used behind its loop has passed the end there."""
        loops = [node for node in nodes if isinstance(node, ir.For)]
        for counter in {significant(loop.counter) for loop in loops}:
            own = [loop for loop in loops if significant(loop.counter) == counter]
            inside = {id(node) for loop in own for node in walk(loop.body) if isinstance(node, ir.Name)}
            if any(
                isinstance(one, ir.Name) and significant(one.id) == counter and id(one) not in inside for one in nodes
            ):
                for loop in own:
                    past = ir.Binary("+", loop.stop, loop.step if loop.step is not None else ir.IntLiteral(1))
                    self.sources.setdefault(self.symbol(key, counter), []).append((key, past))

    def handed(
        self, key: str, call: ir.CallRoutine | ir.TaskControl, programs: Mapping[str, ProgramPart]
    ) -> Iterable[tuple[Symbol, Symbol]]:
        """Parameter and symbol of each argument that is a variable or an element."""
        callee = significant(_named(call))
        part = programs.get(callee)
        for (parameter, _), argument in zip(part.header.parameters if part else (), call.arguments, strict=False):
            given = root_name(argument.value)
            if given is not None and isinstance(argument.value, ir.Name | ir.Index):
                yield (callee, significant(parameter)), self.symbol(key, given)

    def called(self, key: str, call: ir.CallRoutine | ir.TaskControl, programs: Mapping[str, ProgramPart]) -> None:
        """A parameter gets the argument; a variable gets what the program stores into its parameter."""
        callee = significant(_named(call))
        part = programs.get(callee)
        if part is None:
            for one in call.arguments:
                if (outside := root_name(one.value)) is not None:
                    self.sources.setdefault(self.symbol(key, outside), []).append((key, None))
            return
        for (parameter, _), argument in zip(part.header.parameters, call.arguments, strict=False):
            self.sources.setdefault((callee, significant(parameter)), []).append((key, argument.value))
        for symbol, variable in self.handed(key, call, programs):
            if symbol in self.changed:
                self.sources.setdefault(variable, []).append((callee, ir.Name(symbol[1])))

    def stored(self, data: Iterable[DataPart]) -> None:
        """First values that lie beside the programs."""
        for section in data:
            for datum, _ in section.values:
                if section.section in (".REALS", ".DOUBLES") and datum.values:
                    self.sources.setdefault(("", significant(datum.name)), []).append(("", datum.values[0]))

    def solve(self) -> None:
        """Bounds grow from nothing until they stay as they are; what does not stop growing has none."""
        self.known = dict.fromkeys(self.sources, NOTHING)
        for turn in range(_ROUNDS * 2):
            grown = False
            for symbol, given in self.sources.items():
                before = self.known[symbol]
                if before is None:
                    continue
                found = [self.largest(program, value) if value is not None else None for program, value in given]
                now = None if None in found else max((one for one in found if one is not None), default=NOTHING)
                if now != before:
                    grown = True
                    self.known[symbol] = None if turn >= _ROUNDS or (now or 0) > _LARGEST else now
            if not grown:
                return
        self.known = dict.fromkeys(self.known)

    def largest(self, program: str, value: ir.Expression) -> int | None:
        """The largest value of an expression; None when nobody can foresee it."""
        match value:
            case ir.IntLiteral(value=number) | ir.RealLiteral(value=number):
                return int(number)
            case ir.BoolLiteral() | ir.Unary(op="not"):
                return 0
            case ir.Unary(op="-", operand=ir.IntLiteral(value=number) | ir.RealLiteral(value=number)):
                return -int(number)
            case ir.Unary(op="+", operand=operand) | ir.Builtin(function="trunc", arguments=(operand,)):
                return self.largest(program, operand)
            case ir.Builtin(function="min" | "max" as function, arguments=arguments):
                found = [self.largest(program, one) for one in arguments]
                known = [one for one in found if one is not None]
                if function == "min":
                    return min(known, default=None)
                return max(known, default=None) if len(known) == len(found) else None
            case ir.Binary():
                return self.of_binary(program, value)
            case ir.Name(id=name) | ir.Index(base=ir.Name(id=name)):
                return self.known.get(self.symbol(program, name))
        return None

    def of_binary(self, program: str, value: ir.Binary) -> int | None:
        one, other = self.largest(program, value.left), self.largest(program, value.right)
        match value.op:
            case "mod":
                limit = abs(other) - 1 if isinstance(value.right, ir.IntLiteral) and other is not None else None
                return limit if one is None or limit is None else min(limit, max(one, 0))
            case "band":  # M: with a number that is not negative the result is not larger than that
                return min((number for number in (one, other) if number is not None and number >= 0), default=None)
            case "=" | "<>" | "<" | ">" | "<=" | ">=" | "and" | "or" | "xor":
                return 0
        if one is None or NOTHING in (one, other):
            return one if one is None or one == NOTHING else other
        match value.op:
            case "+" if other is not None:
                return one + other
            case "*" if other is not None and one >= 0 and other >= 0:
                return one * other
            case "-" if isinstance(value.right, ir.IntLiteral) and other is not None:
                return one - other
            case "/" if isinstance(value.right, ir.IntLiteral | ir.RealLiteral) and value.right.value >= 1:
                return max(int(one / value.right.value), 0)
        return None


_CALLS = (ir.CallRoutine, ir.TaskControl)


def _named(call: ir.CallRoutine | ir.TaskControl) -> str:
    return call.name if isinstance(call, ir.CallRoutine) else call.task


def _given(node: object) -> Iterable[Given]:
    """Everything that a step gives to a variable or to elements of an array: values, the last one of a loop."""
    match node:
        case ir.Assign(target=target, value=value) if (name := root_name(target)) is not None:
            yield name, value
        case ir.For(counter=name, start=start, stop=stop, step=step):
            down = isinstance(step, ir.Unary) and step.op == "-"
            known = step is None or down or isinstance(step, ir.IntLiteral | ir.RealLiteral)
            yield name, (start if down else stop) if known else None
        case ir.Dialog(answer=answer) if (name := root_name(answer)) is not None:
            yield name, None
        case ir.Vendor(text=text):
            words = "".join(sign if sign.isalnum() or sign in "._$#%" else " " for sign in text).split()
            yield from ((word, None) for word in words if word[0].isalpha())


__all__ = ["NOTHING", "Bounds"]
