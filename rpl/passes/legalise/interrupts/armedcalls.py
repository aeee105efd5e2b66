"""Which calls of a routine may be left by an interrupt that it declares: those made while the interrupt may be on.

Where something else than the routine itself may switch it on, or jumps run through the routine, these are all calls.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.facts.usage import each_expression
from rpl.passes.rewrite import visit_bodies


def armed_calls(routine: ir.Routine, resuming: set[str], elsewhere: ArmedElsewhere) -> set[str] | None:
    """Folded names of what is called while an interrupt of the `resuming` routines may be on; None: any call."""
    numbers: set[int] = set()
    for node in walk(*bodies(routine)):
        match node:
            case ir.Label() | ir.Goto():
                return None
            case ir.DeclareInterrupt(action=ir.CallRoutine(name=name)) if name.lower() in resuming:
                number = _number(node.identity if node.identity is not None else node.priority)
                if number is None or number in elsewhere.numbers or node.once:
                    return None
                numbers.add(number)
    if elsewhere.anything_but(routine):
        return None
    flow = _Flow(frozenset(numbers))
    flow.body(routine.body)
    for other in bodies(routine)[1:]:  # an error comes anywhere in the body
        flow.armed = True
        flow.body(other)
    return flow.found


@dataclass(frozen=True, slots=True)
class ArmedElsewhere:
    """What routines switch on: the numbers that several do or that is `computed`, and who does so."""

    numbers: frozenset[int]
    computed: frozenset[str]

    @classmethod
    def of(cls, routines: list[ir.Routine], declaring: set[str]) -> ArmedElsewhere:
        """Of all routines of a program. A routine's own are left out when it is one of those that declare."""
        numbers: set[int] = set()
        computed: set[str] = set()
        for routine in routines:
            key = routine.name.lower()
            for node in walk(*bodies(routine)):
                if not isinstance(node, ir.ControlInterrupt) or node.op in ("off", "disable", "mask", "delete"):
                    continue
                number = _number(node.handle) if node.handle is not None else None
                if key in declaring:
                    continue
                if number is None:
                    computed.add(key)
                else:
                    numbers.add(number)
        return cls(frozenset(numbers), frozenset(computed))

    def anything_but(self, routine: ir.Routine) -> bool:
        """Does another routine switch on what cannot be told?"""
        return bool(self.computed - {routine.name.lower()})


@dataclass(slots=True)
class _Flow:
    numbers: frozenset[int]
    armed: bool = False
    found: set[str] = field(default_factory=set)
    left: list[bool] = field(default_factory=list)  # of each loop around: may one be on where it is left or begun anew?

    def body(self, body: ir.Body) -> ir.Body:
        for statement in body:
            self.statement(statement)
        return body

    def statement(self, statement: ir.Statement) -> None:
        """May one be on behind it, and what does it call while one may?"""
        if isinstance(statement, ir.ControlInterrupt):
            self.controlled(statement)
            return
        if isinstance(statement, ir.DeclareInterrupt):
            return
        if isinstance(statement, ir.ExitLoop | ir.NextPass) and self.left:
            self.left[-1] = self.left[-1] or self.armed
            return
        before = self.armed
        self.calls(statement)
        if isinstance(statement, ir.For | ir.While | ir.Repeat | ir.Loop):
            self.left.append(False)
            self.branches(statement, before)
            self.branches(statement, self.armed or self.left[-1])  # a second time round
            self.armed = self.armed or self.left.pop()
        else:
            self.branches(statement, before)
        self.calls(statement)

    def branches(self, statement: ir.Statement, before: bool) -> None:
        """Each body inside begins as the statement does; one may be left on by any of them."""
        after = [before]

        def inner(body: ir.Body) -> ir.Body:
            self.armed = before
            self.body(body)
            after.append(self.armed)
            return body

        visit_bodies(statement, inner)
        self.armed = any(after)

    def calls(self, statement: ir.Statement) -> None:
        if not self.armed:
            return
        if isinstance(statement, ir.CallRoutine):
            self.found.add(statement.name.lower())

        def look(expression: ir.Expression) -> None:
            if isinstance(expression, ir.Call):
                self.found.add(expression.name.lower())

        each_expression(statement, look)

    def controlled(self, statement: ir.ControlInterrupt) -> None:
        number = _number(statement.handle)
        if statement.op in ("on", "enable"):
            self.armed = self.armed or number is None or number in self.numbers
        elif statement.op == "off" and (statement.handle is None or self.numbers == {number}):
            self.armed = False


def _number(value: ir.Expression | None) -> int | None:
    return value.value if isinstance(value, ir.IntLiteral) else None
