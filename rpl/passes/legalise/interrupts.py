"""Interrupts by priority (KRL) to interrupts by identity with trap routines (RAPID), and back.

What a target's interrupts cannot watch (a computed condition, a timer) is left as it is for the writer to report.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from types import UnionType

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.legalise.changes import watched_changes
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.interruptnumbers import known_interrupts
from rpl.passes.legalise.orderways import one_way_each
from rpl.passes.legalise.reconnected import one_trap_each
from rpl.passes.legalise.usage import base_name, called_names, each_statement, exposed
from rpl.passes.rewrite import rewrite_parts

ANY_CHANGE = code(
    "interrupt-at-any-change",
    Severity.WARNING,
    "the target looks at this condition each time that its data change, and acts when it has become true",
)
_COMPARISONS = frozenset(("=", "<>", "<", "<=", ">", ">="))
_FIRST_PRIORITY = 10  # KRL allows 1..39 and 81..128; the lower ones are left to the user


def interrupts(program: ir.Program, context: Context) -> ir.Program:
    """Rewrites towards whichever kind the target has; leaves programs without interrupts alone."""
    statements = context.capabilities.statements
    if "DeclareInterrupt" not in statements and "ConnectInterrupt" in statements:
        return _Traps(program, context).program()
    if "ConnectInterrupt" not in statements and "DeclareInterrupt" in statements:
        program = known_interrupts(watched_changes(program, context), context)
        program = one_trap_each(program, context)
        if "timer_positive" not in context.capabilities.system_variables:  # else a number may be declared anew
            program = one_way_each(program, context)
        return _Priorities(program, context).program()
    return program


def _map_bodies(program: ir.Program, on_body: object) -> ir.Program:
    assert callable(on_body)
    modules = tuple(
        replace(
            module,
            routines=tuple(
                replace(
                    routine,
                    body=on_body(routine.body),
                    handlers=tuple(replace(handler, body=on_body(handler.body)) for handler in routine.handlers),
                )
                for routine in module.routines
            ),
        )
        for module in program.modules
    )
    return replace(program, modules=modules)


def _priority(handle: ir.Expression | None) -> int | None:
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


# ---- priority -> trap


@dataclass(slots=True)
class _Trap:
    handle: str
    routine: str
    condition: ir.Expression
    held: str = ""  # remembers that the condition was true, where the data also changes without making it true


@dataclass(slots=True)
class _Traps:
    source: ir.Program
    context: Context
    traps: dict[int, _Trap] = field(default_factory=dict)
    made: list[ir.Routine] = field(default_factory=list)
    homes: dict[str, str] = field(default_factory=dict)  # of each trap: the module that declares its interrupt

    def program(self) -> ir.Program:
        declared: list[ir.DeclareInterrupt] = []

        def find(statement: ir.Statement) -> None:
            if isinstance(statement, ir.DeclareInterrupt):
                declared.append(statement)

        homes: dict[int, str] = {}
        for module in self.source.modules:
            for routine in module.routines:
                each_statement(routine.body, find)
            homes.update((at, module.name) for at in range(len(homes), len(declared)))
        if not declared:
            return self.source
        for at, one in enumerate(declared):
            priority = _priority(one.priority)
            if (
                priority is not None
                and priority not in self.traps
                and (_watchable(one.condition) or self.is_signal(one.condition) or self.looked_at(one.condition))
            ):
                self.add(priority, one)
                self.homes[self.made[-1].name] = homes[at]
        program = self.lasting(_map_bodies(self.source, self.body))
        traps = self.traps.values()
        declarations = (
            *(ir.Variable(trap.handle, ir.InterruptType(), scope="global") for trap in traps),
            *(ir.Variable(one.held, ir.BoolType(), ir.BoolLiteral(False), scope="global") for one in traps if one.held),
        )
        first = program.modules[0]
        if not self.traps:
            return program
        beside = {one.name: self.homes[one.name] for one in self.made if self.names_own_data(one)}
        others = tuple(one for one in self.made if one.name not in beside)
        home = ir.Module(self.context.fresh("rpl_traps"), first.dialect, declarations, others, task=first.task)
        program = exposed(program, called_names(self.made))
        modules = (
            _with_traps(one, [t for t in self.made if beside.get(t.name) == one.name]) for one in program.modules
        )
        return replace(program, modules=(*modules, home))

    def names_own_data(self, trap: ir.Routine) -> bool:
        """Does it name data that only the module sees in which the interrupt is declared?"""
        named = {node.id.lower() for node in walk(trap) if isinstance(node, ir.Name)}
        return any(
            isinstance(one, ir.Variable) and one.scope == "module" and one.name.lower() in named
            for module in self.source.modules
            if module.name == self.homes[trap.name]
            for one in module.declarations
        )

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
        watched = {
            base_name(one) for trap in self.traps.values() if (one := self.looked_at(trap.condition)) is not None
        }

        def changed(one: ir.Declaration) -> ir.Declaration:
            if isinstance(one, ir.Variable) and one.name.lower() in watched and one.storage == "variable":
                return replace(one, storage="persistent")
            return one

        modules = tuple(
            replace(module, declarations=tuple(map(changed, module.declarations))) for module in program.modules
        )
        return replace(program, modules=modules)

    def add(self, priority: int, declared: ir.DeclareInterrupt) -> None:
        trap = _Trap(
            self.context.fresh(f"rpl_interrupt_{priority}"),
            self.context.fresh(f"rpl_trap_{priority}"),
            declared.condition,
        )
        watched = self.looked_at(declared.condition)
        if watched is not None and not self.is_truth(declared.condition):
            trap.held = self.context.fresh(f"rpl_held_{priority}")
            self.context.diagnostics.report(ANY_CHANGE, declared.origin)
        self.traps[priority] = trap
        # The motion that the action braked goes on when the interrupt routine has ended.
        body: ir.Body = (declared.action, ir.StartMotion()) if self.brakes(declared.action) else (declared.action,)
        if trap.held:
            held = ir.Name(trap.held)
            first = ir.If(((ir.Unary("not", held), (ir.Assign(held, ir.BoolLiteral(True)), *body)),))
            body = (ir.If(((declared.condition, (first,)),), (ir.Assign(held, ir.BoolLiteral(False)),)),)
        elif watched is not None:
            body = (ir.If(((declared.condition, body),)),)
        self.made.append(ir.Routine(trap.routine, "trap", body=body, scope="task"))

    def is_truth(self, condition: ir.Expression) -> bool:
        """Is it the value of a flag or a truth value itself, which changes only when the condition does?"""
        match condition:
            case ir.Unary(op="not", operand=operand) | ir.Binary(op="=" | "<>", left=operand, right=ir.BoolLiteral()):
                return self.is_truth(operand)
            case ir.Name(id=name):
                return name.lower() in self.watched_data(ir.BoolType)
        return _flag(condition) is not None

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
                    each_statement(routine.body, look)
        return found

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        for statement in body:
            done.extend(self.statement(statement))
        return tuple(done)

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        match statement:
            case ir.DeclareInterrupt(priority=priority):
                trap = self.traps.get(_priority(priority) or 0)
                if trap is None or trap.condition != statement.condition:
                    return [statement]
                return self.connect(trap, statement)
            case ir.ControlInterrupt(op=op, handle=handle) if handle is not None:
                trap = self.traps.get(_priority(handle) or 0)
                if trap is None:
                    return [statement]
                name = ir.Name(trap.handle)
                if op == "on":
                    flag = self.looked_at(trap.condition)
                    event, watched = ("edge", trap.condition) if flag is None else ("change", flag)
                    return [
                        *self.remembered(trap, statement),
                        ir.OrderInterrupt(name, event, watched, origin=statement.origin),
                    ]
                if op == "off":
                    return self.connect(trap, statement)
                before = self.remembered(trap, statement) if op == "enable" else []
                return [*before, replace(statement, handle=name)]
        return [rewrite_parts(statement, lambda expression: expression, self.body)]

    def remembered(self, trap: _Trap, statement: ir.Statement) -> list[ir.Statement]:
        """A condition that is true already when the interrupt begins to look does not become true then."""
        if not trap.held:
            return []
        return [ir.Assign(ir.Name(trap.held), trap.condition, origin=replace(statement.origin, comments=()))]

    def connect(self, trap: _Trap, statement: ir.Statement) -> list[ir.Statement]:
        """An identity is connected once; deleting it first makes that true on every pass."""
        later = replace(statement.origin, comments=())
        return [
            ir.ControlInterrupt("delete", ir.Name(trap.handle), origin=statement.origin),
            ir.ConnectInterrupt(ir.Name(trap.handle), trap.routine, origin=later),
        ]


# ---- trap -> priority


@dataclass(slots=True)
class _Priorities:
    source: ir.Program
    context: Context
    routine_of: dict[str, str] = field(default_factory=dict)
    priority_of: dict[str, int] = field(default_factory=dict)
    once: dict[str, str] = field(default_factory=dict)
    timer_of: dict[str, int] = field(default_factory=dict)
    made: list[ir.Routine] = field(default_factory=list)

    def program(self) -> ir.Program:
        def find(statement: ir.Statement) -> None:
            if isinstance(statement, ir.ConnectInterrupt):
                name = base_name(statement.handle)
                if name is not None:
                    self.routine_of.setdefault(name, statement.routine)
                    self.priority_of.setdefault(name, _FIRST_PRIORITY + len(self.priority_of))

        for module in self.source.modules:
            for routine in module.routines:
                each_statement(routine.body, find)
        if not self.routine_of:
            return self.source
        program = _map_bodies(self.source, self.body)
        modules = []
        for module in program.modules:
            declarations = tuple(
                d
                for d in module.declarations
                if not (isinstance(d, ir.Variable) and isinstance(d.type, ir.InterruptType))
            )
            routines = tuple(
                replace(routine, kind="procedure", scope="global") if routine.kind == "trap" else routine
                for routine in module.routines
            )
            modules.append(replace(module, declarations=declarations, routines=routines))
        program = replace(program, modules=tuple(modules))
        if not self.made:
            return program
        first = modules[0]
        home = ir.Module(self.context.fresh("rpl_traps"), first.dialect, (), tuple(self.made), task=first.task)
        program = exposed(program, called_names(self.made))
        return replace(program, modules=(*program.modules, home))

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        for statement in body:
            done.extend(self.statement(statement))
        return tuple(done)

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        match statement:
            case ir.ConnectInterrupt(handle=handle) if base_name(handle) in self.priority_of:
                return [ir.Nothing(origin=statement.origin)] if statement.origin.comments else []
            case ir.OrderInterrupt(handle=handle, event="edge", condition=condition) if condition is not None:
                name = base_name(handle)
                if name is None or name not in self.priority_of:
                    return [statement]
                single = statement.once and self.context.capabilities.one_shot_reactions
                action = self.action(name, statement.once and not single)
                priority = ir.IntLiteral(self.priority_of[name])
                later = replace(statement.origin, comments=())
                return [
                    ir.DeclareInterrupt(priority, condition, action, True, once=single, origin=statement.origin),
                    ir.ControlInterrupt("on", priority, origin=later),
                ]
            case ir.OrderInterrupt(handle=handle, event="timer", time=time) if time is not None:
                name = base_name(handle)
                if name is not None and name in self.priority_of and self.watching:
                    return self.watched(statement, name)
                if name is None or name not in self.priority_of or not self.context.capabilities.timers:
                    return [statement]
                return self.every(statement, name, time)
            case ir.ControlInterrupt(op=op, handle=handle) if handle is not None:
                name = base_name(handle)
                if name not in self.priority_of:
                    return [statement]
                op = "off" if op == "delete" else op
                done = replace(statement, op=op, handle=ir.IntLiteral(self.priority_of[name]))
                if op == "off" and name in self.timer_of:
                    stop = ir.Assign(self.timer(name, "timer_stopped"), ir.BoolLiteral(True))
                    return [done, replace(stop, origin=replace(statement.origin, comments=()))]
                return [done]
        return [rewrite_parts(statement, lambda expression: expression, self.body)]

    def every(self, statement: ir.OrderInterrupt, name: str, time: ir.Expression) -> list[ir.Statement]:
        """A timer that counts up to zero; its interrupt sets it back by the period, so that no time is lost. Periods
        that pass while it has to wait come once, and the next one at its own time."""
        if name not in self.timer_of:
            self.timer_of[name] = self.context.capabilities.timers - len(self.timer_of)
        timer, stopped = self.timer(name, "timer"), self.timer(name, "timer_stopped")
        priority, later = ir.IntLiteral(self.priority_of[name]), replace(statement.origin, comments=())
        off = ir.ControlInterrupt("off", priority)
        back = ir.Assign(timer, ir.Binary("-", timer, time))
        passed = ir.Binary("<=", timer, ir.IntLiteral(0))
        again = off if statement.once else ir.Repeat(passed, (back,))
        routine = self.context.fresh(f"{self.routine_of[name]}_timer")
        call = ir.CallRoutine(self.routine_of[name])
        self.made.append(ir.Routine(routine, body=(again, call), scope="global"))
        return [
            ir.Assign(timer, ir.Unary("-", time), origin=statement.origin),
            ir.Assign(stopped, ir.BoolLiteral(False), origin=later),
            ir.DeclareInterrupt(
                priority, self.timer(name, "timer_positive"), ir.CallRoutine(routine), True, origin=later
            ),
            ir.ControlInterrupt("on", priority, origin=later),
        ]

    @property
    def watching(self) -> bool:
        return self.context.capabilities.watching_tasks or self.context.capabilities.watched_interrupts

    def watched(self, statement: ir.OrderInterrupt, name: str) -> list[ir.Statement]:
        """A timer for a target whose interrupts are tasks: these know how to wait for a time by themselves."""
        priority, later = ir.IntLiteral(self.priority_of[name]), replace(statement.origin, comments=())
        call = ir.CallRoutine(self.routine_of[name])
        never = ir.BoolLiteral(False)
        return [
            ir.DeclareInterrupt(priority, never, call, True, once=statement.once, origin=statement.origin),
            replace(statement, handle=priority, origin=later),
        ]

    def timer(self, name: str, what: str) -> ir.System:
        return ir.System(what, (ir.IntLiteral(self.timer_of[name]),))

    def action(self, name: str, once: bool) -> ir.CallRoutine:
        trap = self.routine_of[name]
        if not once:
            return ir.CallRoutine(trap)
        if name not in self.once:
            wrapper = self.context.fresh(f"{trap}_once")
            self.once[name] = wrapper
            off = ir.ControlInterrupt("off", ir.IntLiteral(self.priority_of[name]))
            self.made.append(ir.Routine(wrapper, body=(off, ir.CallRoutine(trap)), scope="global"))
        return ir.CallRoutine(self.once[name])
