"""Why a statement was not reached: the nearest thing in front of it or around it that kept the runs away.

Reasons are words for people. They name the line of what decided, never more than is certain: that a condition cannot be
otherwise is said only where it is constant.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.fold import constant
from rpl.passes.scope import ProgramScope, Scope
from rpl.source import Origin

# File, begin and end of a statement's span, and whether it is the action of an interrupt or trigger in it.
Key = tuple[str, int, int, bool]

_LEAVES = (ir.Return, ir.Goto, ir.Halt, ir.Raise, ir.Retry, ir.TryNext, ir.ExitLoop, ir.NextPass, ir.ResumeLevel)
_OTHERWISE = "nothing led there"
# About a decision that no surroundings can change.
UNDRIVEN = "no input, kept value or answer is looked at before it"


def key_of(origin: Origin, action: bool = False) -> Key:
    """What tells a statement from all others of the program."""
    return (origin.file, origin.start, origin.end, action)


def reasons(
    program: ir.Program,
    every: Collection[Key],
    came: Collection[Key],
    entry: str | None,
    remarks: Mapping[Key, str],
) -> dict[Key, str]:
    """A reason for each statement of `every` that is not among those the runs `came` to."""
    scopes = ProgramScope(program)
    callers = _callers(program, entry)
    finder = _Finder(came, remarks)
    for module in program.modules:
        for routine in module.routines:
            finder.routine(routine, scopes.routine(module, routine), _uncalled(routine, callers))
    return {key: finder.found.get(key, _OTHERWISE) for key in every if key not in came}


@dataclass(frozen=True, slots=True)
class _Part:
    """A body to look at. `why`: what keeps runs away from its first statement, if anything does."""

    body: ir.Body
    why: str


class _Finder:
    """Goes through bodies in their order; what is nested waits on a stack."""

    def __init__(self, came: Collection[Key], remarks: Mapping[Key, str]) -> None:
        self.came, self.remarks = came, remarks
        self.found: dict[Key, str] = {}
        self.scope: Scope | None = None

    def routine(self, routine: ir.Routine, scope: Scope, uncalled: str) -> None:
        """All bodies of a routine."""
        self.scope = scope
        if any(self._came(statement) for statement in routine.body):
            uncalled = ""
        stack = [_Part(routine.body, uncalled)]
        for handler in routine.handlers:
            stack.append(_Part(handler.body, uncalled or "no error came that this handler takes"))
        stack.append(_Part(routine.undo, uncalled or "the routine was not left by an error"))
        while stack:
            stack.extend(self.body(stack.pop()))

    def body(self, part: _Part) -> list[_Part]:
        """Give each statement of a body its reason; gives the bodies inside."""
        why = part.why
        inside: list[_Part] = []
        for statement in part.body:
            own = self._came(statement)
            if own:
                why = ""
            elif own is False:
                self.found[key_of(statement.origin)] = why or _OTHERWISE
            inside += self._parts(statement, why)
            if isinstance(statement, ir.Label) and why:
                why = f"no jump to {statement.name} was taken"
            elif isinstance(statement, ir.Loop) or not why:
                why = self._behind(statement, why)
        return inside

    def _came(self, statement: ir.Statement) -> bool | None:
        """Was the statement reached? None: it is no instruction by itself; then what it holds decides."""
        if isinstance(statement, ir.Label | ir.Nothing):
            return None
        if isinstance(statement, ir.Loop):
            return True if any(self._came(one) for one in statement.body) else None
        return key_of(statement.origin) in self.came

    def _behind(self, statement: ir.Statement, why: str) -> str:
        """What keeps runs away from the place behind a statement that was reached, if they do not come there."""
        line = statement.origin.line
        match statement:
            case ir.Loop() if why:
                return why
            case ir.Loop():
                return f"behind the loop without end in line {line}"
            case ir.While() if self._constant(statement.condition) is True:
                return f"behind the loop without end in line {line}"
            case ir.While() | ir.Repeat() | ir.For():
                return f"the loop in line {line} was never left at its end"
            case ir.WaitUntil() | ir.Dialog() | ir.Meet():
                return f"behind the wait in line {line}, which did not end"
            case ir.CallRoutine(name=name):
                return f"the call of {name} in line {line} did not come back"
            case ir.If() | ir.Switch():
                return self._remark(statement, f"no way through line {line} came to its end")
            case _ if isinstance(statement, _LEAVES):
                return f"behind line {line}, which goes elsewhere"
        return f"the runs ended in line {line}"

    def _parts(self, statement: ir.Statement, why: str) -> Iterator[_Part]:
        """The bodies inside a statement, each with what keeps runs away."""
        line = statement.origin.line
        match statement:
            case ir.If(branches=branches, otherwise=otherwise):
                for number, (condition, body) in enumerate(branches):
                    first = body[0].origin.line if body else line
                    at = line if number == 0 else self._line(condition, first)
                    yield _Part(body, why or self._never(statement, condition, at, True))
                yield _Part(otherwise, why or self._never(statement, branches[-1][0], line, False))
            case ir.Switch(cases=cases, default=default):
                for case in cases:
                    yield _Part(case.body, why or self._remark(statement, f"no value of this case came in line {line}"))
                reason = f"only values of the cases came in line {line}"
                yield _Part(default or (), why or self._remark(statement, reason))
            case ir.While(condition=condition, body=body):
                yield _Part(body, why or self._never(statement, condition, line, True))
            case ir.For(body=body):
                yield _Part(body, why or self._remark(statement, f"the loop in line {line} had no pass"))
            case ir.Loop(body=body) | ir.Repeat(body=body):
                yield _Part(body, why)
            case ir.DeclareInterrupt(action=action):
                key = key_of(action.origin, True)
                if key not in self.came:
                    self.found[key] = why or self._remark(statement, f"the interrupt of line {line} never came")
            case ir.Trigger(action=action):
                if isinstance(action, ir.Assign | ir.CallRoutine) and key_of(action.origin, True) not in self.came:
                    self.found[key_of(action.origin, True)] = (
                        why or f"the place of the trigger in line {line} was not passed"
                    )

    def _line(self, condition: ir.Expression, otherwise: int) -> int:
        return condition.origin.line or otherwise

    def _never(self, statement: ir.Statement, condition: ir.Expression, line: int, wanted: bool) -> str:
        """Why a condition never had the wanted value."""
        value = self._constant(condition)
        if value is not None:
            return f"the condition in line {line} is always {'TRUE' if value else 'FALSE'}"
        told = f"the condition in line {line} was never {'TRUE' if wanted else 'FALSE'}"
        return self._remark(statement, told)

    def _remark(self, statement: ir.Statement, told: str) -> str:
        more = self.remarks.get(key_of(statement.origin))
        return f"{told}; {more}" if more else told

    def _constant(self, condition: ir.Expression) -> bool | None:
        """The value of a condition that never changes."""
        assert self.scope is not None  # set by routine
        value = constant(condition, self.scope)
        return value if isinstance(value, bool) else None


def _callers(program: ir.Program, entry: str | None) -> dict[str, set[str]]:
    """By folded name: which routines call it (the empty name: the start of a task)."""
    found: dict[str, set[str]] = {}
    for name in (entry or program.entry, *(task.entry for task in program.tasks)):
        if name:
            found.setdefault(name.lower(), set()).add("")
    for module in program.modules:
        for routine in module.routines:
            bodies = (routine.body, routine.undo, *(handler.body for handler in routine.handlers))
            for node in walk(*bodies):
                match node:
                    case (
                        ir.CallRoutine(name=name)
                        | ir.Call(name=name)
                        | ir.ConnectInterrupt(routine=name)
                        | ir.TaskControl(task=name)
                        | ir.OnError(routine=str() as name)
                    ):
                        found.setdefault(name.lower(), set()).add(routine.name.lower())
    return found


def _uncalled(routine: ir.Routine, callers: Mapping[str, set[str]]) -> str:
    """Why the routine was not entered; used only where it was not."""
    found = callers.get(routine.name.lower(), set()) - {routine.name.lower()}
    if not found:
        return f"no statement calls {routine.name}"
    return f"{routine.name} was not called"


__all__ = ["UNDRIVEN", "Key", "key_of", "reasons"]
