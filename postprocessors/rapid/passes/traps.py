"""Interrupts by priority (KRL) as interrupts by identity with trap routines (RAPID).

A signal, or data that the whole program sees, is watched by one identity. A condition of several of them has an
identity for each, all with one trap routine, which looks at the whole condition and remembers whether it was true. Any
other condition is looked at by an interrupt that comes again and again with time.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from types import UnionType

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import base_name, called_names, doing, each_statement, exposed
from rpl.passes.legalise.rewriting.beside import local_names
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies
from rpl.source import Origin

from .. import tables

ANY_CHANGE = code(
    "interrupt-at-any-change",
    Severity.WARNING,
    "the target looks at this condition each time that its data change, and acts when it has become true",
)
POLLED = code(
    "interrupt-polled",
    Severity.WARNING,
    "no interrupt of the target watches this condition; it is looked at every {seconds} s, and acts that much later",
)
EVERY = code(
    "interrupts-armed-undeclared",
    Severity.WARNING,
    "the target switches on its interrupts one by one: {names} too, which may not have been declared yet",
)
_COMPARISONS = frozenset(("=", "<>", "<", "<=", ">", ">="))
_LOGIC = frozenset(("and", "or", "xor", "cand", "cor", "=", "<>"))


@legalising(sees=("DeclareInterrupt", "ControlInterrupt"))
def priorities_to_traps(program: ir.Program, context: Context) -> ir.Program:
    """Interrupts by priority (KRL) as interrupts by identity with trap routines; conditions that nothing can watch stay
    as they are, for the writer to report."""
    return _Traps(program, context).program()


@dataclass(frozen=True, slots=True)
class _Order:
    """One identity of an interrupt: what makes it come, and for times the seconds."""

    handle: str
    event: str
    watched: ir.Expression | None

    def statement(self, origin: Origin) -> ir.OrderInterrupt:
        if self.event == "timer":
            return ir.OrderInterrupt(ir.Name(self.handle), "timer", time=self.watched, origin=origin)
        return ir.OrderInterrupt(ir.Name(self.handle), self.event, self.watched, origin=origin)


@dataclass(slots=True)
class _Trap:
    routine: str
    condition: ir.Expression
    orders: tuple[_Order, ...]
    held: str = ""  # remembers that the condition was true, where the interrupt also comes without it becoming true


@dataclass(slots=True)
class _Traps:
    source: ir.Program
    context: Context
    traps: dict[int, _Trap] = field(default_factory=dict)
    made: list[ir.Routine] = field(default_factory=list)
    homes: dict[str, str] = field(default_factory=dict)  # of each trap: the module that declares its interrupt
    controlling: frozenset[str] = frozenset()  # routines that switch interrupts

    def program(self) -> ir.Program:
        declared: list[tuple[ir.DeclareInterrupt, str, frozenset[str]]] = []
        for module in self.source.modules:
            for routine in module.routines:
                own = local_names(routine)

                def find(statement: ir.Statement, home: str = module.name, own: frozenset[str] = own) -> None:
                    if isinstance(statement, ir.DeclareInterrupt):
                        declared.append((statement, home, own))

                for body in bodies(routine):
                    each_statement(body, find)
        for one, module_name, names in declared:
            priority = priority_of(one.priority)
            if priority is not None and priority not in self.traps and self.add(priority, one, names):
                self.homes[self.made[-1].name] = module_name
        if not self.traps:
            return self.source
        self.controlling = doing(self.source, lambda node: isinstance(node, ir.ControlInterrupt))
        modules = [
            replace(module, routines=tuple(edit_bodies(routine, self.body) for routine in module.routines))
            for module in self.source.modules
        ]
        program = self.lasting(replace(self.source, modules=tuple(modules)))
        traps = self.traps.values()
        declarations = (
            *(ir.Variable(one.handle, ir.InterruptType(), scope="global") for trap in traps for one in trap.orders),
            *(ir.Variable(one.held, ir.BoolType(), ir.BoolLiteral(False), scope="global") for one in traps if one.held),
        )
        beside = {one.name: self.homes[one.name] for one in self.made if self.names_own_data(one)}
        others = tuple(one for one in self.made if one.name not in beside)
        first = program.modules[0]
        home = ir.Module(self.context.fresh("rpl_traps"), first.dialect, declarations, others, task=first.task)
        program = exposed(program, called_names(self.made))
        with_traps = (
            _with_traps(one, [t for t in self.made if beside.get(t.name) == one.name]) for one in program.modules
        )
        return replace(program, modules=(*with_traps, home))

    def names_own_data(self, trap: ir.Routine) -> bool:
        """Does it name data that only the module sees in which the interrupt is declared?"""
        named = {node.id.lower() for node in walk(trap) if isinstance(node, ir.Name)}
        return any(
            isinstance(one, ir.Variable) and one.scope == "module" and one.name.lower() in named
            for module in self.source.modules
            if module.name == self.homes[trap.name]
            for one in module.declarations
        )

    # ---- what is watched

    def orders(self, priority: int, condition: ir.Expression, own: frozenset[str]) -> tuple[list[_Order], bool]:
        """The identities of an interrupt, and whether each coming of one means that the condition became true."""

        def order(event: str, watched: ir.Expression, number: int = 0) -> _Order:
            stem = f"rpl_interrupt_{priority}" + (f"_{number}" if number else "")
            return _Order(self.context.fresh(stem), event, watched)

        if _watchable(condition) or self.is_signal(condition):
            flag = _flag(condition)
            return [order("edge", condition) if flag is None else order("change", flag)], True
        if (data := self.looked_at(condition)) is not None:
            return [order("change", data)], self.is_truth(condition)
        parts = self.parts(condition)
        if parts:
            every = list(dict.fromkeys(parts))
            return [order("change", part, number) for number, part in enumerate(every, 1)], False
        if any(isinstance(node, ir.Name) and node.id.lower() in own for node in walk(condition)):
            return [], False
        return [order("timer", ir.RealLiteral(tables.SHORTEST_PERIOD_S))], False

    def parts(self, condition: ir.Expression) -> list[ir.Expression] | None:
        """The signals and data of a condition when a change of each can be watched, else None."""
        match condition:
            case ir.Unary(op="not", operand=operand):
                return self.parts(operand)
            case ir.BoolLiteral():
                return []
            case _ if (data := self.looked_at(condition)) is not None:
                return [data]
            case ir.Binary(op=op, left=left, right=right) if op in _LOGIC:
                one, other = self.parts(left), self.parts(right)
                return None if one is None or other is None else [*one, *other]
            case _ if _watchable(condition) or self.is_signal(condition):
                return [condition]
        return None

    def is_signal(self, condition: ir.Expression) -> bool:
        """A declared name of an input or output, or its negation."""
        match condition:
            case ir.Unary(op="not", operand=operand) | ir.Binary(op="=" | "<>", left=operand, right=ir.BoolLiteral()):
                return self.is_signal(operand)
            case ir.Name(id=name):
                found = [
                    one
                    for module in self.source.modules
                    for one in module.declarations
                    if isinstance(one, ir.SignalDeclaration) and one.name.lower() == name.lower()
                ]
                return bool(found) and all(one.signal.kind.startswith("digital") for one in found)
        return False

    def looked_at(self, condition: ir.Expression) -> ir.Expression | None:
        """The flag or the truth value of the whole program that a condition looks at: an interrupt comes with each
        change of it, and its routine looks whether this was the wanted one."""
        match condition:
            case ir.Unary(op="not", operand=operand) | ir.Binary(op="=" | "<>", left=operand, right=ir.BoolLiteral()):
                return self.looked_at(operand)
            case ir.Name(id=name) if name.lower() in self.watched_data(ir.BoolType):
                return condition
            case ir.Binary(op=op, left=left, right=right) if op in _COMPARISONS and _literal(right):
                return self.compared(left)
            case ir.Binary(op=op, left=left, right=right) if op in _COMPARISONS and _literal(left):
                return self.compared(right)
        return _flag(condition)

    def compared(self, value: ir.Expression) -> ir.Expression | None:
        """A number of the whole program, or an element of such an array with constant numbers."""
        match value:
            case ir.Name(id=name):
                return value if name.lower() in self.watched_data(ir.IntType | ir.RealType) else None
            case ir.Index(base=ir.Name(id=name), indices=indices) if all(map(_literal, indices)):
                return value if name.lower() in self.watched_data(ir.IntType | ir.RealType, array=True) else None
        return None

    def watched_data(self, kind: type | UnionType, array: bool = False) -> set[str]:
        """Data (or arrays) of this kind under a name that nothing else in the program has, folded."""

        def fits(type: ir.Type) -> bool:
            return isinstance(type.element if isinstance(type, ir.ArrayType) else type, kind) and (
                isinstance(type, ir.ArrayType) == array
            )

        routines = [routine for module in self.source.modules for routine in module.routines]
        declared = [one.declarations for one in self.source.modules] + [one.declarations for one in routines]
        every = [one for declarations in declared for one in declarations if isinstance(one, ir.Variable)]
        names = [one.name.lower() for one in every]
        given = {one.name.lower() for routine in routines for one in routine.parameters}
        return {
            one.name.lower()
            for one in every
            if fits(one.type) and one.scope == "global" and names.count(one.name.lower()) == 1
        } - given

    def lasting(self, program: ir.Program) -> ir.Program:
        """What such interrupts look at is persistent data."""
        orders = [one for trap in self.traps.values() for one in trap.orders if one.event == "change"]
        watched = {base_name(one.watched) for one in orders if one.watched is not None}

        def changed(one: ir.Declaration) -> ir.Declaration:
            if isinstance(one, ir.Variable) and one.name.lower() in watched and one.storage == "variable":
                return replace(one, storage="persistent")
            return one

        modules = tuple(
            replace(module, declarations=tuple(map(changed, module.declarations))) for module in program.modules
        )
        return replace(program, modules=modules)

    def is_truth(self, condition: ir.Expression) -> bool:
        """Is it the value of a flag or a truth value itself, which changes only when the condition does?"""
        match condition:
            case ir.Unary(op="not", operand=operand) | ir.Binary(op="=" | "<>", left=operand, right=ir.BoolLiteral()):
                return self.is_truth(operand)
            case ir.Name(id=name):
                return name.lower() in self.watched_data(ir.BoolType)
        return _flag(condition) is not None

    # ---- traps

    def add(self, priority: int, declared: ir.DeclareInterrupt, own: frozenset[str]) -> bool:
        """Make the trap of an interrupt; FALSE when nothing can watch its condition. `own`: names of the routine."""
        orders, exact = self.orders(priority, declared.condition, own)
        if not orders:
            return False
        trap = _Trap(self.context.fresh(f"rpl_trap_{priority}"), declared.condition, tuple(orders))
        if not exact:
            trap.held = self.context.fresh(f"rpl_held_{priority}")
            told = POLLED if orders[0].event == "timer" else ANY_CHANGE
            values = {"seconds": str(tables.SHORTEST_PERIOD_S)} if told is POLLED else {}
            self.context.diagnostics.report(told, declared.origin, **values)
        self.traps[priority] = trap
        # The motion that the action braked goes on when the interrupt routine has ended.
        body: ir.Body = (declared.action, ir.StartMotion()) if self.brakes(declared.action) else (declared.action,)
        if trap.held:
            held = ir.Name(trap.held)
            first = ir.If(((ir.Unary("not", held), (ir.Assign(held, ir.BoolLiteral(True)), *body)),))
            body = (ir.If(((declared.condition, (first,)),), (ir.Assign(held, ir.BoolLiteral(False)),)),)
        elif orders[0].event == "change":
            body = (ir.If(((declared.condition, body),)),)
        self.made.append(ir.Routine(trap.routine, "trap", body=body, scope="task"))
        return True

    def brakes(self, action: ir.Statement) -> bool:
        if not isinstance(action, ir.CallRoutine):
            return False
        found = False

        def look(statement: ir.Statement) -> None:
            nonlocal found
            found = found or isinstance(statement, ir.StopMotion)

        for module in self.source.modules:
            for routine in module.routines:
                if routine.name.lower() == action.name.lower():
                    for body in bodies(routine):
                        each_statement(body, look)
        return found

    # ---- statements

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        ready: set[int] = set()  # declared here and certainly not switched on since
        for statement in body:
            match statement:
                case ir.DeclareInterrupt(priority=priority) if (number := priority_of(priority)) is not None:
                    ready.add(number)
                case ir.ControlInterrupt(op="on" | "off", handle=None):
                    done.extend(self.all_of_them(statement, ready, body))
                    ready.clear()
                    continue
                case ir.ControlInterrupt(handle=handle):
                    ready.discard(priority_of(handle) or 0)
                case ir.Label():
                    ready.clear()
                case _ if self.switches(statement):
                    ready.clear()
            done.extend(self.statement(statement))
        return tuple(done)

    def switches(self, statement: ir.Statement) -> bool:
        """Does it, or what it calls, switch interrupts?"""
        for node in walk(statement):
            match node:
                case ir.ControlInterrupt():
                    return True
                case ir.CallRoutine(name=name) | ir.Call(name=name) if name.lower() in self.controlling:
                    return True
        return False

    def all_of_them(self, control: ir.ControlInterrupt, ready: set[int], body: ir.Body) -> list[ir.Statement]:
        """`INTERRUPT ON` and `INTERRUPT OFF` without a number, one by one."""
        here = {priority_of(one.priority) for one in walk(*body) if isinstance(one, ir.DeclareInterrupt)}
        others = [trap.routine for number, trap in self.traps.items() if number not in here]
        if control.op == "on" and others:
            self.context.diagnostics.report(EVERY, control.origin, names=", ".join(others))
        done: list[ir.Statement] = [ir.Nothing(origin=control.origin)] if control.origin.comments else []
        one = replace(control, origin=replace(control.origin, comments=()))
        for number, trap in self.traps.items():
            if control.op == "off" or number not in ready:
                done += self.connect(trap, one)
            if control.op == "on":
                done += self.ordered(trap, one)
        return done

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        match statement:
            case ir.DeclareInterrupt(priority=priority):
                trap = self.traps.get(priority_of(priority) or 0)
                if trap is None or trap.condition != statement.condition:
                    return [statement]
                return self.connect(trap, statement)
            case ir.ControlInterrupt(op=op, handle=handle) if handle is not None:
                trap = self.traps.get(priority_of(handle) or 0)
                if trap is None:
                    return [statement]
                if op == "on":
                    return self.ordered(trap, statement)
                if op == "off":
                    return self.connect(trap, statement)
                before = self.remembered(trap, statement) if op == "enable" else []
                later = replace(statement.origin, comments=())
                each = [replace(statement, handle=ir.Name(one.handle), origin=later) for one in trap.orders]
                return [*before, replace(each[0], origin=statement.origin), *each[1:]]
        return [rewrite_bodies(statement, self.body)]

    def ordered(self, trap: _Trap, statement: ir.Statement) -> list[ir.Statement]:
        later = replace(statement.origin, comments=())
        first, *others = trap.orders
        return [
            *self.remembered(trap, statement),
            first.statement(statement.origin),
            *(one.statement(later) for one in others),
        ]

    def remembered(self, trap: _Trap, statement: ir.Statement) -> list[ir.Statement]:
        """A condition that is true already when the interrupt begins to look does not become true then."""
        if not trap.held:
            return []
        return [ir.Assign(ir.Name(trap.held), trap.condition, origin=replace(statement.origin, comments=()))]

    def connect(self, trap: _Trap, statement: ir.Statement) -> list[ir.Statement]:
        """An identity is connected once; deleting it first makes that true on every pass."""
        done: list[ir.Statement] = []
        for one in trap.orders:
            origin = replace(statement.origin, comments=()) if done else statement.origin
            later = replace(statement.origin, comments=())
            done += [
                ir.ControlInterrupt("delete", ir.Name(one.handle), origin=origin),
                ir.ConnectInterrupt(ir.Name(one.handle), trap.routine, origin=later),
            ]
        return done


def priority_of(handle: ir.Expression | None) -> int | None:
    return handle.value if isinstance(handle, ir.IntLiteral) else None


def _watchable(condition: ir.Expression) -> bool:
    """A signal or a flag, or one compared with TRUE or FALSE, or its negation."""
    match condition:
        case ir.Signal():
            return condition.kind.startswith("digital") or _flag(condition) is not None
        case ir.System():
            return _flag(condition) is not None
        case ir.Unary(op="not", operand=operand):
            return _watchable(operand)
        case ir.Binary(op="=" | "<>", left=left, right=ir.BoolLiteral()):
            return _watchable(left)
    return False


def _flag(condition: ir.Expression) -> ir.Expression | None:
    """The flag with a constant number that a condition looks at, whatever it is compared with. Flags become data: an
    interrupt comes with each change of it, and its routine looks whether this was the wanted one."""
    match condition:
        case (
            ir.Signal(kind="flag", index=ir.IntLiteral(), last=None)
            | ir.System(name="flag", indices=(ir.IntLiteral(),))
        ):
            return condition
        case ir.Unary(op="not", operand=operand):
            return _flag(operand)
        case ir.Binary(op="=" | "<>", left=left, right=ir.BoolLiteral()):
            return _flag(left)
    return None


def _with_traps(module: ir.Module, traps: list[ir.Routine]) -> ir.Module:
    return replace(module, routines=(*module.routines, *traps)) if traps else module


def _literal(value: ir.Expression) -> bool:
    if isinstance(value, ir.Unary) and value.op == "-":
        value = value.operand
    return isinstance(value, ir.IntLiteral | ir.RealLiteral | ir.BoolLiteral)


__all__ = ["priorities_to_traps", "priority_of"]
