"""Interrupts that come once and those that come again: what the source's controller does by itself is said.

A reaction of V+ is over when it has come; most other controllers' interrupts come at each edge. Where source and target
differ, the routine switches its interrupt off, or arms it again, as its first step. A routine that serves something
else as well gets one around it.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.passes.capabilities import InterruptRule, Watched
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import called_names, exposed
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.stages import legalising
from rpl.source import Origin


@legalising()
def reactions_once(program: ir.Program, context: Context) -> ir.Program:
    """For targets whose interrupts come again."""
    return (
        program
        if InterruptRule.ONE_SHOT in context.capabilities.interrupts.rules
        else _as_target_has_it(program, context)
    )


@legalising()
def rearmed_reactions(program: ir.Program, context: Context) -> ir.Program:
    """For targets whose interrupts come once, with all that other passes make interrupts of."""
    return (
        _as_target_has_it(program, context)
        if InterruptRule.ONE_SHOT in context.capabilities.interrupts.rules
        else program
    )


def _as_target_has_it(program: ir.Program, context: Context) -> ir.Program:
    """Interrupts with a number that is known."""
    can = context.capabilities
    if not (
        can.interrupts.watched is Watched.ALL
        or can.interrupts.watched is Watched.INTERRUPTS
        or {"DeclareInterrupt", "ConnectInterrupt"} & can.statements
    ):
        return program
    found = [one for one in walk_for({"DeclareInterrupt"}, *program.modules) if isinstance(one, ir.DeclareInterrupt)]
    wanted = {
        one
        for one in found
        if one.once != (InterruptRule.ONE_SHOT in can.interrupts.rules) and _number(one) is not None
    }
    if not wanted:
        return program
    worker = _Once(program, context, found)
    done = rewrite(program, lambda node: worker.declared(node) if isinstance(node, ir.DeclareInterrupt) else node)
    modules = tuple(
        replace(module, routines=tuple(worker.served(routine) for routine in module.routines))
        for module in done.modules
    )
    done = replace(done, modules=modules)
    if not worker.around:
        return done
    made = tuple(worker.around.values())
    return with_support(exposed(done, called_names(made)), context, (), made, modules[0].task)


def _handle(declared: ir.DeclareInterrupt) -> ir.Expression:
    return declared.priority if declared.identity is None else declared.identity


def _number(declared: ir.DeclareInterrupt) -> int | None:
    number = _handle(declared)
    return number.value if isinstance(number, ir.IntLiteral) else None


def _routine(declared: ir.DeclareInterrupt) -> str | None:
    """The routine that an interrupt calls, when it is one without arguments."""
    action = declared.action
    plain = isinstance(action, ir.CallRoutine) and not action.arguments and action.dynamic is None
    return action.name.lower() if plain and isinstance(action, ir.CallRoutine) else None


def _says_so(body: ir.Body, number: int) -> bool:
    """Does the routine switch its interrupt off by itself, before anything that takes time?"""
    for statement in body:
        match statement:
            case ir.ControlInterrupt(op="off" | "delete", handle=ir.IntLiteral(value=value)) if value == number:
                return True
            case ir.Assign() | ir.Nothing() | ir.ControlInterrupt():
                continue
        return False
    return False


@dataclass(slots=True)
class _Once:
    program: ir.Program
    context: Context
    found: list[ir.DeclareInterrupt]
    numbers: dict[str, int] = field(default_factory=dict)  # routine that serves one interrupt alone -> its number
    around: dict[tuple[int, ir.Statement], ir.Routine] = field(default_factory=dict)

    def __post_init__(self) -> None:
        serving: dict[str, set[int | None]] = {}
        for one in self.found:
            if (name := _routine(one)) is not None:
                same = one.once != (InterruptRule.ONE_SHOT in self.context.capabilities.interrupts.rules)
                serving.setdefault(name, set()).add(_number(one) if same else None)
        actions = [id(one.action) for one in self.found]
        elsewhere = set[str]()
        for node in walk_for(
            {"CallRoutine", "Call", "TaskControl", "OnError", "ConnectInterrupt"}, *self.program.modules
        ):
            match node:
                case ir.CallRoutine(name=name) | ir.Call(name=name) if id(node) not in actions:
                    elsewhere.add(name.lower())
                case ir.TaskControl(task=name) | ir.OnError(routine=str() as name) | ir.ConnectInterrupt(routine=name):
                    elsewhere.add(name.lower())
        for name, numbers in serving.items():
            number = next(iter(numbers))
            if len(numbers) == 1 and number is not None and name not in elsewhere:
                self.numbers[name] = number

    def first(self, number: int, origin: Origin) -> ir.ControlInterrupt:
        op = "on" if InterruptRule.ONE_SHOT in self.context.capabilities.interrupts.rules else "off"
        handle = next(_handle(one) for one in self.found if _number(one) == number)  # spelled as it is declared
        return ir.ControlInterrupt(op, handle, origin=origin)

    def declared(self, one: ir.DeclareInterrupt) -> ir.DeclareInterrupt:
        number, once = _number(one), InterruptRule.ONE_SHOT in self.context.capabilities.interrupts.rules
        if one.once == once or number is None:
            return one
        if _routine(one) in self.numbers:
            return replace(one, once=once)
        key = (number, one.action)
        if key not in self.around:
            name = self.context.fresh("rpl_reaction")
            steps = (self.first(number, one.origin), one.action)
            self.around[key] = ir.Routine(name, body=steps, scope="global")
        return replace(one, once=once, action=ir.CallRoutine(self.around[key].name, origin=one.action.origin))

    def served(self, routine: ir.Routine) -> ir.Routine:
        """The routine of an interrupt, with the step in front."""
        number = self.numbers.get(routine.name.lower())
        if number is None or _says_so(routine.body, number):
            return routine
        origin = routine.body[0].origin if routine.body else routine.origin
        step = self.first(number, replace(origin, comments=()))
        at = next((n for n, one in enumerate(routine.body) if not isinstance(one, ir.Nothing)), len(routine.body))
        return replace(routine, body=(*routine.body[:at], step, *routine.body[at:]))


__all__ = ["reactions_once", "rearmed_reactions"]
