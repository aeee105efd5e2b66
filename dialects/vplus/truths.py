"""Which V+ variables only ever hold truths.

V+ has numbers only: a comparison gives -1 or 0. A variable that gets nothing but comparisons, signals, TRUE and FALSE,
and that is only asked whether it is true, can be a BOOL; that reads better in every other language and changes nothing.
One use as a number, or a value from elsewhere, and it stays a number. Parameters go with their arguments.
"""

from __future__ import annotations

from collections.abc import Iterable

from rpl import ir
from rpl.ir.walk import children

from .blocks import DataPart, ProgramPart
from .expressions import root_name, significant
from .inference import Symbol, Symbols, is_settled

_LOGIC = frozenset(("and", "or", "xor", "cand", "cor"))
_COMPARISONS = frozenset(("=", "<>", "<", ">", "<=", ">="))
_SIGNALS = frozenset(("digital_in", "digital_out", "flag"))


def mark(programs: dict[str, ProgramPart], data: list[DataPart], symbols: Symbols) -> None:
    """Find the variables that only hold truths and mark them in `symbols.truths`."""
    finder = _Finder(programs, symbols)
    for section in data:
        for datum, _ in section.values:
            finder.candidates.discard(("", significant(datum.name)))
    finder.find()
    symbols.truths = frozenset(finder.candidates)


class _Finder:
    """Begins with every variable that gets a truth somewhere, and drops those that are used otherwise."""

    def __init__(self, programs: dict[str, ProgramPart], symbols: Symbols) -> None:
        self.programs, self.symbols = programs, symbols
        self.program = ""
        self.candidates: set[Symbol] = {
            symbol
            for symbol, entry in symbols.entries.items()
            if symbol[1][0] not in "$#%" and entry.pose is None and not entry.double
        }
        self.given: set[Symbol] = set()  # gets a truth somewhere

    def find(self) -> None:
        open_ones = {
            key: [statement for statement in part.body if not is_settled(statement)]
            for key, part in self.programs.items()
        }
        before = -1
        while len(self.candidates) != before:
            before = len(self.candidates)
            self.given = set()
            for key, body in open_ones.items():
                self.program = key
                for statement in body:
                    self.statement(statement)
            self.connect()
        self.candidates &= self.reached()
        while self.connect():
            pass

    def reached(self) -> set[Symbol]:
        """Variables that get a truth, by themselves or through what they are passed to."""
        found = set(self.given)
        grown = True
        while grown:
            grown = False
            for one, other in self.symbols.links:
                if (one in found) != (other in found):
                    found |= {one, other}
                    grown = True
        return found

    def connect(self) -> bool:
        """Argument and parameter are truths together or not at all."""
        changed = False
        for one, other in self.symbols.links:
            if (one in self.candidates) != (other in self.candidates):
                self.candidates -= {one, other}
                changed = True
        return changed

    def symbol(self, expression: ir.Expression) -> Symbol | None:
        name = root_name(expression)
        return self.symbols.symbol(self.program, name) if name is not None else None

    def drop(self, name: str) -> None:
        self.candidates.discard(self.symbols.symbol(self.program, name))

    def is_truth(self, expression: ir.Expression | None) -> bool:
        match expression:
            case ir.BoolLiteral():
                return True
            case ir.Name() | ir.Index():
                return self.symbol(expression) in self.candidates
            case ir.Signal(kind=kind):
                return kind in _SIGNALS
            case ir.Unary(op="not"):
                return True
            case ir.Unary(op="+", operand=operand):
                return self.is_truth(operand)
            case ir.Binary(op=op):
                return op in _LOGIC or op in _COMPARISONS
        return False

    # ---- uses

    def asked(self, expression: ir.Expression) -> None:
        """The expression stands where only its truth counts."""
        match expression:
            case ir.Name():
                return
            case ir.Index(indices=indices):
                self.numbers(indices)
            case ir.Unary(op="not" | "+", operand=operand):
                self.asked(operand)
            case ir.Binary(op=op, left=left, right=right) if op in _LOGIC:
                self.asked(left)
                self.asked(right)
            case ir.Binary(op="=" | "<>", left=left, right=right) if self.is_truth(left) and self.is_truth(right):
                self.asked(left)
                self.asked(right)
            case _:
                self.numbers(children(expression))

    def number(self, expression: object) -> None:
        """The expression stands where a number counts: no variable in it is a truth, but for parts of its own."""
        match expression:
            case ir.Name(id=name):
                self.drop(name)
            case ir.Index(base=ir.Name(id=name), indices=indices):
                self.drop(name)
                self.numbers(indices)
            case ir.Builtin(function="is_uninitialised"):
                return
            case ir.Unary(op="not") | ir.Binary():
                if isinstance(expression, ir.Unary) or expression.op in _LOGIC or expression.op in _COMPARISONS:
                    self.asked(expression)
                else:
                    self.numbers(children(expression))
            case _:
                self.numbers(children(expression))

    def numbers(self, expressions: Iterable[object]) -> None:
        for expression in expressions:
            self.number(expression)

    def assigned(self, target: ir.Expression, value: ir.Expression) -> None:
        """A variable that gets a truth stays one; one that gets a number does not."""
        if isinstance(target, ir.Index):
            self.numbers(target.indices)
        symbol = self.symbol(target)
        if symbol is None:
            self.asked(value) if _is_switch(target) else self.number(value)
            return
        if self.is_truth(value) and symbol in self.candidates:
            self.given.add(symbol)
            self.asked(value)
            return
        self.candidates.discard(symbol)
        self.number(value)

    # ---- statements

    def statement(self, statement: ir.Statement) -> None:
        match statement:
            case ir.Assign(target=target, value=value):
                self.assigned(target, value)
            case ir.If(branches=branches, otherwise=otherwise):
                for condition, body in branches:
                    self.asked(condition)
                    self.body(body)
                self.body(otherwise)
            case ir.While(condition=condition, body=body) | ir.Repeat(until=condition, body=body):
                self.asked(condition)
                self.body(body)
            case ir.WaitUntil(condition=condition) | ir.DeclareInterrupt(condition=condition):
                self.asked(condition)
            case ir.For(counter=counter, start=start, stop=stop, step=step, body=body):
                self.drop(counter)
                self.numbers([start, stop] if step is None else [start, stop, step])
                self.body(body)
            case ir.Switch():
                self.switch(statement)
            case ir.CallRoutine(name=name, arguments=arguments) | ir.TaskControl(task=name, arguments=arguments):
                self.called(name, arguments)
            case ir.Vendor(text=text):
                self.mentioned(text)
            case _:
                self.numbers(children(statement))

    def body(self, body: ir.Body) -> None:
        for statement in body:
            self.statement(statement)

    def switch(self, statement: ir.Switch) -> None:
        values = [statement.selector, *(value for case in statement.cases for value in case.values)]
        if all(self.is_truth(value) for value in values):
            for value in values:
                self.asked(value)
        else:
            self.numbers(values)
        for case in statement.cases:
            self.body(case.body)
        self.body(statement.default or ())

    def called(self, name: str, arguments: tuple[ir.Argument, ...]) -> None:
        """Variables are linked with their parameters; a value passed to a parameter is like an assignment."""
        key = significant(name)
        part = self.programs.get(key)
        for position, argument in enumerate(arguments):
            value = argument.value
            if value is None:
                continue
            parameters = part.header.parameters if part is not None else ()
            if position >= len(parameters):
                self.number(value)
                continue
            parameter: Symbol = (key, significant(parameters[position][0]))
            if isinstance(value, ir.Name | ir.Index):
                if isinstance(value, ir.Index):
                    self.numbers(value.indices)
                if self.symbol(value) not in self.candidates or parameter not in self.candidates:
                    self.candidates -= {parameter}
                    self.drop(root_name(value) or "")
            elif self.is_truth(value) and parameter in self.candidates:
                self.given.add(parameter)
                self.asked(value)
            else:
                self.candidates.discard(parameter)
                self.number(value)

    def mentioned(self, text: str) -> None:
        """An instruction that only the controller carries out may do anything with its variables."""
        words = {significant(word) for word in text.replace("(", " ").replace(")", " ").replace(",", " ").split()}
        self.candidates = {symbol for symbol in self.candidates if symbol[1] not in words}


def _is_switch(target: ir.Expression) -> bool:
    """Does the place hold a truth by itself?"""
    if isinstance(target, ir.Signal):
        return target.kind in _SIGNALS
    row = ir.SYSTEM_VARIABLES.get(target.name) if isinstance(target, ir.System) else None
    return row is not None and row.type == "b"


__all__ = ["mark"]
