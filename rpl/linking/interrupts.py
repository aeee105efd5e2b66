"""Instructions that declare, connect, order and control interrupts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpl import ir
from rpl.linking.conditions import depends_on_time
from rpl.linking.places import writer
from rpl.runtime.code import Instruction, Values
from rpl.runtime.faults import ProgramError
from rpl.runtime.interrupts import UNRANKED, Interrupt
from rpl.runtime.values import whole

if TYPE_CHECKING:
    from rpl.linking.assembler import Make
    from rpl.linking.linker import Linker


def action(statement: ir.Statement, linker: Linker) -> Make | None:
    """The instruction of an interrupt statement; None for any other."""
    match statement:
        case ir.DeclareInterrupt():
            return _declare(statement, linker)
        case ir.ConnectInterrupt():
            return _connect(statement, linker)
        case ir.OrderInterrupt():
            return _order(statement, linker)
        case ir.ControlInterrupt():
            return _control(statement, linker)
    return None


def _declare(statement: ir.DeclareInterrupt, linker: Linker) -> Make:
    """Condition and action live in the declaring routine; the priority identifies it where nothing else does."""
    priority = linker.compiler.value(statement.priority)
    identity = linker.compiler.value(statement.identity if statement.identity is not None else statement.priority)
    once, stops = statement.once, statement.stops
    condition, polls = linker.compiler.value(statement.condition), depends_on_time(statement.condition, linker.linked)
    code = linker.action(statement.action, "interrupt")
    everywhere = statement.everywhere

    def make(here: int, next: int) -> Instruction:
        def declare(f: Values) -> int:
            task = f[0]
            level = None if everywhere else task.frame
            declared = Interrupt(
                whole(identity(f)), whole(priority(f)), code, f, level, everywhere, "edge", condition, f, polls
            )
            declared.once, declared.stops = once, stops
            task.interrupts.declare(declared)
            return next

        return declare

    return make


def _connect(statement: ir.ConnectInterrupt, linker: Linker) -> Make:
    """RAPID's way: a variable gets an identity, a trap routine acts."""
    read, write = linker.compiler.raw(statement.handle), writer(linker.compiler, statement.handle, statement.origin)
    routine = linker.linked.routine(linker.compiler.scope, statement.routine)
    linked, name = linker.linked, statement.routine

    def make(here: int, next: int) -> Instruction:
        def connect(f: Values) -> int:
            task = f[0]
            if routine is None:
                raise ProgramError("unknown_trap", f"there is no trap routine {name}")
            if read(f) in task.interrupts.known:
                raise ProgramError("already_connected", "the interrupt variable is connected already")
            key = task.interrupts.new_key()
            task.interrupts.declare(Interrupt(key, UNRANKED, linked.code_of(routine), None, everywhere=True))
            write(f, key)
            return next

        return connect

    return make


def _order(statement: ir.OrderInterrupt, linker: Linker) -> Make:
    compiler = linker.compiler
    handle = compiler.value(statement.handle)
    condition = compiler.value(statement.condition) if statement.condition is not None else None
    polls = statement.condition is not None and depends_on_time(statement.condition, linker.linked)
    time = compiler.value(statement.time) if statement.time is not None else None
    event, once = statement.event, statement.once

    def make(here: int, next: int) -> Instruction:
        def order(f: Values) -> int:
            task = f[0]
            interrupt = task.interrupts.known.get(handle(f))
            if interrupt is None:
                raise ProgramError("unknown_interrupt", "the interrupt is not connected")
            interrupt.event, interrupt.once, interrupt.polls = event, once, polls
            interrupt.condition, interrupt.condition_values = condition, f
            interrupt.period = float(time(f)) if time is not None else 0.0
            task.interrupts.arm(interrupt)
            task.watch_time(interrupt)
            return next

        return order

    return make


def _control(statement: ir.ControlInterrupt, linker: Linker) -> Make:
    op = statement.op
    handle = linker.compiler.value(statement.handle) if statement.handle is not None else None

    def make(here: int, next: int) -> Instruction:
        def control(f: Values) -> int:
            task = f[0]
            task.interrupts.control(op, whole(handle(f)) if handle is not None else None, task.watch_time)
            done: int = task.attention(next) if task.interrupts.pending else next
            return done

        return control

    return make
