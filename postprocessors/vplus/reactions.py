"""Interrupts as REACT, REACTI, IGNORE, LOCK. V+ arms a reaction where it names its program, so a declaration elsewhere
leaves no step: it is looked up where the interrupt is switched on. It is over when it has come: a program that is to
come again arms it in its first step (rpl.passes.legalise.interrupts.onceonly)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from rpl import ir
from rpl.ir.walk import walk
from rpl.writing.statements import CannotSayError

from . import tables
from .expressions import Expressions
from .facts.interrupts import Interrupts

# M: the software signals that REACT takes on all versions come first.
_FLAGS = (*range(8, 0, -1), *range(9, 513))


@dataclass(frozen=True, slots=True)
class Watch:
    """A program that switches a software signal as a condition comes and goes, and its task."""

    name: str
    task: int
    signal: int
    condition: str

    def steps(self) -> tuple[str, ...]:
        return (
            "; Switches a signal as a condition comes and goes.",
            *("WHILE TRUE DO", f"    IF SIG({self.signal}) THEN"),
            *(f"        WAIT NOT ({self.condition})", f"        SIGNAL -{self.signal}", "    END"),
            *(f"    WAIT {self.condition}", f"    SIGNAL {self.signal}", "END"),
        )

    def begun(self) -> tuple[str, ...]:
        """The signal is as the condition is when the reaction is armed, so what comes right behind is not missed."""
        on = (f"IF {self.condition} THEN", f"    SIGNAL {self.signal}", "END")
        return (f"SIGNAL -{self.signal}", *on, f"EXECUTE /C {self.task} {self.name}()")


def _no_task(signal: ir.Signal) -> int:
    raise CannotSayError("a reaction to a condition, without a task to watch it")


class Reactions:
    """All interrupts of a program, by identity. `task_of` gives the task of a program that comes along."""

    def __init__(self, interrupts: Interrupts) -> None:
        self.task_of: Callable[[ir.Signal], int] = _no_task
        self.inside = ""  # the program that is written, folded
        self.declared = interrupts.declared
        self.watches: dict[str, Watch] = {}
        self.flags = set(interrupts.flags)

    def lines(self, statement: ir.DeclareInterrupt | ir.ControlInterrupt, expressions: Expressions) -> list[str]:
        if isinstance(statement, ir.DeclareInterrupt):
            self.step(statement, expressions)  # says here what cannot be watched
            return []
        handle = statement.handle
        match statement.op:
            case "mask":
                return [f"LOCK {expressions.text(_lifted(handle, 0)) if handle is not None else '0'}"]
            case "disable" | "enable" if handle is None:
                return ["LOCK 0" if statement.op == "enable" else f"LOCK {tables.PRIORITY_TOP - 1}"]
            case "on":
                return [line for one in self.meant(handle) for line in self.armed(one, expressions)]
            case "off" | "delete":
                return [f"IGNORE {self.signal(one.condition, expressions)}" for one in self.meant(handle)]
        raise CannotSayError(f"a single interrupt cannot be {statement.op}d")

    def armed(self, declared: ir.DeclareInterrupt, expressions: Expressions) -> list[str]:
        """REACT, behind the start of the program that watches the condition, if one does. What a reaction's own program
        arms again is watched already."""
        step = self.step(declared, expressions)
        watch = self.watches.get(repr(declared.condition))
        again = isinstance(declared.action, ir.CallRoutine) and declared.action.name.lower() == self.inside
        return [step] if watch is None or again else [*watch.begun(), step]

    def watched(self, condition: ir.Expression, expressions: Expressions) -> str:
        """A software signal that a program in a task of its own switches as the condition comes and goes."""
        key = repr(condition)
        if key not in self.watches:
            names = [one.id for one in walk((condition,)) if isinstance(one, ir.Name)]
            if any((symbol := expressions.scope.value(name)) is None or symbol.routine for name in names):
                raise CannotSayError("a reaction to a condition with variables of its program")
            steps, expressions.notes.steps = expressions.notes.steps, False
            text = expressions.condition(condition)
            expressions.notes.steps = steps
            if len(text) > tables.LONGEST_LINE - 24:
                raise CannotSayError("a reaction to a condition that is too long for one step")
            number = next(one for one in _FLAGS if one not in self.flags)
            self.flags.add(number)
            task = self.task_of(ir.Signal("flag", ir.IntLiteral(number)))
            signal = tables.SIGNALS["flag"] + number
            self.watches[key] = Watch(f"rpl.watch.{len(self.watches) + 1}", task, signal, text)
        return str(self.watches[key].signal)

    def meant(self, handle: ir.Expression | None) -> list[ir.DeclareInterrupt]:
        if handle is None:
            return [one for group in self.declared.values() for one in group[:1]]
        found = self.declared.get(repr(handle), [])
        if not found:
            raise CannotSayError("an interrupt that is not declared")
        if any(one != found[0] for one in found):
            raise CannotSayError("an interrupt that is declared in different ways")
        return found[:1]

    def step(self, declared: ir.DeclareInterrupt, expressions: Expressions) -> str:
        action = declared.action
        if not isinstance(action, ir.CallRoutine) or action.arguments or action.dynamic is not None:
            raise CannotSayError("a reaction calls a program without arguments")
        word = "REACTI" if declared.stops else "REACT"
        urgency = expressions.text(_lifted(declared.priority))
        return f"{word} {self.signal(declared.condition, expressions)}, {action.name.lower()}, {urgency}"

    def signal(self, condition: ir.Expression, expressions: Expressions, on: bool = True) -> str:
        """The number of the signal that is watched, negative for its off state."""
        match condition:
            case ir.Unary(op="not", operand=operand):
                return self.signal(operand, expressions, not on)
            case ir.Binary(op="=" | "<>" as op, left=left, right=ir.BoolLiteral(value=value)):
                return self.signal(left, expressions, on == (value == (op == "=")))
            case ir.Name(id=name):
                declared = expressions.places.declared(name)
                if declared is not None:
                    return self.signal(declared, expressions, on)
            case ir.System(name="flag", indices=(index,)):
                return self.signal(ir.Signal("flag", index), expressions, on)
            case ir.Signal() if not expressions.places.is_group(condition):
                return expressions.places.number(expressions.places.numbered(condition), not on)
        if not on:
            condition = ir.Unary("not", condition)
        return self.watched(condition, expressions)


def _lifted(priority: ir.Expression, least: int = 1) -> ir.Expression:
    """V+ priorities grow with their urgency; reactions have one from 1, LOCK 0 locks none of them."""
    match priority:
        case ir.IntLiteral(value=value) | ir.RealLiteral(value=value):
            return ir.IntLiteral(max(least, min(tables.PRIORITY_TOP - 1, tables.PRIORITY_TOP - int(value))))
        case ir.Binary(op="-", left=ir.IntLiteral(value=tables.PRIORITY_TOP), right=right):
            return right
    return ir.Binary("-", ir.IntLiteral(tables.PRIORITY_TOP), priority)


__all__ = ["Reactions"]
