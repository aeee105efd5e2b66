"""Which variables a routine reads before it has set them: what it keeps from one run to the next.

Backwards over the structured body, again until the values at labels and loops stand still. Conservative: what cannot be
followed (handlers, errors) wants everything.
"""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.facts.effects import blocks, children, everything

Names = frozenset[str]
_NONE: Names = frozenset()


def wanted_at_start(routine: ir.Routine, names: Names) -> Names:
    """Those of `names` (folded) that the routine may read before it assigns them."""
    return Liveness(routine, names).start


class Liveness:
    """`start`: those of `names` (folded) that are wanted where the routine begins; `after`: where it has ended."""

    def __init__(self, routine: ir.Routine, names: Names, after: Names = _NONE) -> None:
        self.names = names
        self.after = after
        self.labels: dict[str, Names] = {}
        self.loops: list[tuple[Names, Names]] = []  # what is wanted where ExitLoop and NextPass go
        self.raised = _NONE  # what is wanted where an error goes
        if routine.handlers or routine.undo or routine.backward:
            self.raised = names
        changed = True
        while changed:
            before = dict(self.labels)
            self.start = self.body(routine.body, after)
            for handler in routine.handlers:
                self.body(handler.body, names)
            changed = before != self.labels

    def body(self, body: ir.Body, wanted: Names) -> Names:
        for statement in reversed(body):
            wanted = self.statement(statement, wanted) | self.raised
        return wanted

    def read(self, *parts: ir.Expression | None) -> Names:
        found = {
            one.id.lower() for part in parts if part is not None for one in everything(part) if isinstance(one, ir.Name)
        }
        return self.names & found

    def statement(self, statement: ir.Statement, wanted: Names) -> Names:
        match statement:
            case ir.Assign(target=ir.Name(id=name), value=value):
                return (wanted - {name.lower()}) | self.read(value)
            case ir.Label(name=name):
                self.labels[name.lower()] = self.labels.get(name.lower(), _NONE) | wanted
                return wanted
            case ir.Goto(label=name):
                return self.labels.get(name.lower(), _NONE)
            case ir.Return():
                return self.after | self.read(*children(statement))
            case ir.Halt(kind="exit" | "cycle"):
                return self.read(*children(statement))
            case ir.Raise() | ir.Retry() | ir.TryNext():
                return self.names
            case ir.ExitLoop() if self.loops:
                return self.loops[-1][0]
            case ir.NextPass() if self.loops:
                return self.loops[-1][1]
            case ir.If(branches=branches, otherwise=otherwise):
                found = self.body(otherwise, wanted)
                return found.union(*(self.branch(condition, body, wanted) for condition, body in branches))
            case ir.Switch(cases=cases, default=default):
                found = wanted if default is None else self.body(default, wanted)
                return found.union(self.read(*children(statement)), *(self.body(one.body, wanted) for one in cases))
            case ir.For() | ir.While() | ir.Repeat() | ir.Loop():
                return self.loop(statement, wanted)
        return self.other(statement, wanted)

    def branch(self, condition: ir.Expression, body: ir.Body, wanted: Names) -> Names:
        """A body that runs where the condition holds."""
        return self.body(body, wanted) | self.read(condition)

    def other(self, statement: ir.Statement, wanted: Names) -> Names:
        """A statement that sets nothing for certain."""
        found = wanted | self.read(*children(statement))
        for inner in blocks(statement):
            found |= self.body(inner, wanted)
        return found

    def loop(self, loop: ir.For | ir.While | ir.Repeat | ir.Loop, behind: Names) -> Names:
        looked = self.read(*children(loop))
        if isinstance(loop, ir.For):
            looked |= self.names & {loop.counter.lower()}
        again = looked if isinstance(loop, ir.Loop) else behind | looked
        while True:
            self.loops.append((behind, again))
            first = self.body(loop.body, again)
            self.loops.pop()
            if first <= again:
                break
            again |= first
        if isinstance(loop, ir.Repeat | ir.Loop):
            return first
        if isinstance(loop, ir.For):
            return (again - {loop.counter.lower()}) | self.read(*children(loop))
        return again
