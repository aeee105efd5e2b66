"""SKIP CONDITION, OFFSET CONDITION and TOOL_OFFSET CONDITION: what a later move takes is what was executed last.

The reader leaves a mark where such a line stands (the word gets the number of the line's value) and the word itself in
the moves that take it. Here each move gets the value that can reach it; where several can, the program keeps the
number of the one that it executed last, and the move is written once for each.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import expressions, is_statement, map_children, rewrite
from rpl.source import Origin

SKIP, OFFSET, TOOL_OFFSET = "skip_condition", "offset_condition", "tool_offset_condition"
WORDS = (SKIP, OFFSET, TOOL_OFFSET)
Values = Mapping[str, Sequence[ir.Expression]]
Numbers = frozenset[int]
_NONE: Numbers = frozenset()
_LOOPS = (ir.For, ir.While, ir.Repeat, ir.Loop)


def mark(word: str, number: int, origin: Origin) -> ir.Assign:
    """Stands where the condition is set; its values are numbered from 1."""
    return ir.Assign(ir.Name(word, origin=origin), ir.IntLiteral(number), origin=origin)


def is_mark(statement: object, word: str) -> bool:
    return isinstance(statement, ir.Assign) and statement.target == ir.Name(word)


def settled(body: ir.Body, values: Values) -> ir.Body:
    """The body with the values in its moves. `values`: word -> what its lines set, in their order."""
    for word, given in values.items():
        body = _settled(body, word, tuple(given) or (_controllers_own(word),))
    return body


def chosen(inside: Iterable[ir.Statement]) -> tuple[ir.Variable, ...]:
    """Variables for the words whose number the program has to keep."""
    nodes = list(inside)
    used = [word for word in WORDS if any(is_mark(node, word) for node in nodes)]
    return tuple(ir.Variable(word, ir.IntType(), ir.IntLiteral(0), scope="routine") for word in used)


def _controllers_own(word: str) -> ir.Expression:
    """The program sets nothing: what holds came from elsewhere."""
    return ir.VendorValue("tp", word.replace("_", " ").upper(), ir.BoolType())


def _settled(body: ir.Body, word: str, given: tuple[ir.Expression, ...]) -> ir.Body:
    reaching = _Reaching(word)
    while reaching.grows:
        reaching.grows = False
        reaching.body(body, _NONE)
    everything = frozenset(range(1, len(given) + 1))
    asked = {place: numbers or everything for place, numbers in reaching.found.items()}
    kept = frozenset().union(*(numbers for numbers in asked.values() if len(numbers) > 1))

    def change(node: object) -> object:
        if isinstance(node, ir.Assign) and is_mark(node, word):
            assert isinstance(node.value, ir.IntLiteral)
            return node if node.value.value in kept else ir.Nothing(origin=node.origin)
        numbers = asked.get(id(node))
        if numbers is None:
            return map_children(node, change)
        assert isinstance(node, ir.Move | ir.Spline)
        return _chosen(node, word, {number: given[number - 1] for number in sorted(numbers)})

    return tuple(statement for statement in map(change, body) if is_statement(statement))


def _chosen(node: ir.Move | ir.Spline, word: str, values: dict[int, ir.Expression]) -> ir.Statement:
    """The move with its value, or once for each in the order of the lines."""

    def with_value(value: ir.Expression, origin: bool) -> ir.Statement:
        made = rewrite(node, lambda part: value if part == ir.Name(word) else part)
        return made if origin else replace(made, origin=replace(made.origin, comments=()))

    made = [(number, with_value(value, len(values) == 1)) for number, value in values.items()]
    if len(made) == 1:
        return made[0][1]
    *first, (_, last) = made
    branches = tuple(
        (ir.Binary("=", ir.Name(word, origin=node.origin), ir.IntLiteral(number), origin=node.origin), (move,))
        for number, move in first
    )
    return ir.If(branches, (last,), origin=node.origin)


@dataclass(slots=True)
class _Reaching:
    """Which of the word's lines can be the last one executed at each statement. `found`: for the statements that take
    the word, by identity. `labels`: what the jumps to a label bring along."""

    word: str
    found: dict[int, Numbers] = field(default_factory=dict)
    labels: dict[str, Numbers] = field(default_factory=dict)
    exits: list[Numbers] = field(default_factory=list)
    grows: bool = True

    def body(self, body: ir.Body, here: Numbers | None) -> Numbers | None:
        """What holds behind the body; None where nothing comes there."""
        for statement in body:
            here = self.statement(statement, here)
        return here

    def statement(self, statement: ir.Statement, here: Numbers | None) -> Numbers | None:
        match statement:
            case ir.Label(name=name):
                return _joined(here, self.labels.get(name.lower()))
            case ir.Goto(label=name):
                self.note_jump(name.lower(), here)
                return None
            case ir.Return():
                return None
            case ir.ExitLoop():
                if self.exits and here is not None:
                    self.exits[-1] |= here
                return None
            case ir.Assign(value=ir.IntLiteral(value=number)) if is_mark(statement, self.word):
                return frozenset((number,))
            case ir.If(branches=branches, otherwise=otherwise):
                return self.either([*(body for _, body in branches), otherwise], here)
            case ir.Switch(cases=cases, default=default):
                return self.either([*(case.body for case in cases), default or ()], here)
            case ir.For(body=body) | ir.While(body=body) | ir.Repeat(body=body) | ir.Loop(body=body):
                return self.loop(body, here)
        if isinstance(statement, ir.Move | ir.Spline) and ir.Name(self.word) in expressions(statement):
            self.found[id(statement)] = self.found.get(id(statement), _NONE) | (here or _NONE)
        return here

    def note_jump(self, name: str, here: Numbers | None) -> None:
        if here is not None and (name not in self.labels or not here <= self.labels[name]):
            self.labels[name] = self.labels.get(name, _NONE) | here
            self.grows = True

    def either(self, bodies: list[ir.Body], here: Numbers | None) -> Numbers | None:
        behind: Numbers | None = None
        for body in bodies:
            behind = _joined(behind, self.body(body, here))
        return behind

    def loop(self, body: ir.Body, here: Numbers | None) -> Numbers | None:
        """The body may be done again with what it set, or not at all."""
        self.exits.append(_NONE)
        again = self.body(body, here)
        last = self.body(body, _joined(here, again))
        left = self.exits.pop()
        behind = _joined(here, last)
        return _joined(behind, left) if left else behind


def _joined(one: Numbers | None, other: Numbers | None) -> Numbers | None:
    if one is None or other is None:
        return one if other is None else other
    return one | other
