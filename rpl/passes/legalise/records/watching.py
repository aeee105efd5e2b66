"""Searches and interrupts, for targets that have tasks, but none of these.

An interrupt whose action takes no time and leaves the robot alone is a task of its own that waits for the condition and
acts in a critical section, where the target has these. For one that stops the robot for good, and for one that takes
time while the program only waits, moves are searches that end at the condition, and the program looks at it in each
cycle of its waiting (`endedmoves`). One that stops the robot in the middle of a move which then goes on is refused:
what would brake and begin again is a task or a program that looks now and then, and nobody can prove its delay.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes.capabilities import PathRule, Watched
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.reach import Armed, armed_statements, key_of, number_of, with_calls
from rpl.passes.legalise.facts.usage import called_names, exposed
from rpl.passes.legalise.facts.watches import MOTION, Watch
from rpl.passes.legalise.interrupts.endedmoves import EndedMoves, goes_on, unending
from rpl.passes.legalise.interrupts.searchtasks import SearchTasks
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.beside import Beside, closure, local_names, tidy
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion, map_body
from rpl.passes.legalise.rewriting.jumps import inside, left_with
from rpl.passes.legalise.rewriting.movers import Movers
from rpl.passes.legalise.rewriting.refusedactions import REFUSED, without_actions
from rpl.passes.legalise.rewriting.stopping import left_out
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import ProgramScope

BESIDE = code(
    "interrupt-watched",
    Severity.WARNING,
    "a task looks for the condition of {action} in each cycle of the controller and acts there; the program may still"
    " do what it does in that cycle",
)
SERVED = code(
    "interrupt-served",
    Severity.WARNING,
    "moves end at the condition of {action}, and the program looks for it in each cycle while it waits, not while it"
    " calculates",
)
MISSED = code(
    "interrupt-not-noted",
    Severity.WARNING,
    "what comes for {action} and goes again while interrupts are disabled or locked is lost: moves of the target end at"
    " what is there",
    "keep the signal until it is answered",
)
LOST = code(
    "interrupt-not-watched",
    Severity.LOSS,
    "{action} cannot be done by a program that watches the condition: {reason}",
    "let a search move end at the condition, or use the controller's own monitoring function",
    stops=True,
)
_DRIVEN = (ir.Move, ir.MoveExternal, ir.Spline)
_ALONE = (ir.Wait, ir.WaitUntil, ir.WaitForMotion, ir.Dialog, ir.Raise, ir.Halt, ir.ResumeLevel)


@legalising(
    unless=lambda context: (
        context.capabilities.interrupts.watched is not Watched.ALL
        and (context.capabilities.interrupts.watched is not Watched.INTERRUPTS)
    ),
    sees=("Search", "DeclareInterrupt"),
)
def watching(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that are asked for this."""
    can = context.capabilities
    nodes = list(walk_for({"Search", "DeclareInterrupt"}, *program.modules))
    searches = can.interrupts.watched is Watched.ALL and any(isinstance(node, ir.Search) for node in nodes)
    interrupts = any(isinstance(node, ir.DeclareInterrupt) for node in nodes)
    if not searches and not interrupts:
        return program
    beside = Beside(program, context)
    movers = Movers(beside, ProgramScope(program))
    watches = _Watches(program, beside)
    watches.collect()
    serving: list[EndedMoves] = []
    for watch in (each for each in watches.watches.values() if each.served):
        served = EndedMoves(program, context, watch)
        served.marked = armed_statements(program, served)
        if served.leaves:
            served.marked = with_calls(program, served.marked, served.declaring)
        serving.append(served)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        done = routine
        for one in serving:
            done = one.routine(editor, routine, done)
        if can.interrupts.watched is Watched.ALL and (searches or serving):
            done = edit_bodies(done, SearchTasks(editor, routine, beside, movers).body)
        return edit_bodies(done, watches.body) if interrupts else done

    done = edit_routines(program, context, work)
    for each in serving:
        each.finish()
    movers.finish()
    done = without_actions(done, [one for some in watches.lost.values() for one in some])
    done = watches.levels(beside.placed(done))
    done = replace(done, tasks=(*done.tasks, *watches.by_urgency()))
    made = (*(routine for one in serving for routine in one.made), *watches.made)
    done = exposed(done, called_names(made))
    data = (*movers.data(), *(datum for one in serving for datum in one.data()), *watches.data)
    return with_support(done, context, data, made, done.modules[0].task)


def _name(action: ir.Assign | ir.CallRoutine) -> str:
    return action.name if isinstance(action, ir.CallRoutine) else "an assignment"


@dataclass(slots=True)
class _Watches:
    """All interrupts of the program, and those that are tasks."""

    program: ir.Program
    beside: Beside
    watches: dict[int, Watch] = field(default_factory=dict)
    lost: dict[int, list[ir.DeclareInterrupt]] = field(default_factory=dict)
    declaring: dict[str, set[int]] = field(default_factory=dict)
    data: list[ir.Variable] = field(default_factory=list)
    made: list[ir.Routine] = field(default_factory=list)
    tasks: list[tuple[int, ir.Task]] = field(default_factory=list)  # with their priority: lower is more urgent
    mask: str = ""
    periods: dict[int, list[ir.Expression]] = field(default_factory=dict)  # of interrupts that come by time

    def overlap(self, key: int, other: int) -> bool:
        """Is there a statement that runs while both may come?"""
        both = [armed_statements(self.program, Armed(one)) for one in (key, other)]
        named = {
            id(node)
            for node in walk_for({"ControlInterrupt"}, *self.program.modules)
            if isinstance(node, ir.ControlInterrupt)
        }
        return bool(both[0] & both[1] - named)

    def flag(self, stem: str) -> str:
        name = self.beside.context.fresh(stem)
        self.data.append(ir.Variable(name, ir.BoolType(), ir.BoolLiteral(False), scope="global"))
        return name

    # ---- what there is

    def collect(self) -> None:
        ops = {
            node.op
            for node in walk_for({"ControlInterrupt"}, *self.program.modules)
            if isinstance(node, ir.ControlInterrupt)
        }
        for node in walk_for({"OrderInterrupt"}, *self.program.modules):
            if isinstance(node, ir.OrderInterrupt) and node.time is not None and number_of(node.handle) is not None:
                self.periods.setdefault(number_of(node.handle) or 0, []).append(node.time)
        for module in self.program.modules:
            for routine in module.routines:
                for node in walk(*bodies(routine)):
                    if isinstance(node, ir.DeclareInterrupt):
                        self.add(node, routine, module, ops)

    def add(self, one: ir.DeclareInterrupt, routine: ir.Routine, module: ir.Module, ops: set[str]) -> None:
        key = key_of(one)
        reason = self.refused(one, key, routine)
        if reason or key is None:
            self.beside.context.diagnostics.report(LOST, one.origin, action=_name(one.action), reason=reason)
            self.lost.setdefault(key if key is not None else -1, []).append(one)
            return
        if not one.everywhere:
            self.declaring.setdefault(routine.name.lower(), set()).add(key)
        known = self.watches.get(key)
        if known is not None:
            return
        if isinstance(one.action, ir.CallRoutine):
            home = next((m for m in self.program.modules for r in m.routines if r.name == one.action.name), module)
            module = home if home is not module else module
        timed = self.takes_time(one)
        armed = self.flag(f"rpl_interrupt_{key}_on")
        watch = Watch(key, number_of(one.priority) or 0, one, armed, routine, served=timed)
        self.watches[key] = watch
        report = self.beside.context.diagnostics.report
        report(SERVED if timed else BESIDE, one.origin, action=_name(one.action))
        watch.enabled = self.flag(f"rpl_interrupt_{key}_waits") if ops & {"enable", "disable"} else ""
        if "mask" in ops and not self.mask:
            self.mask = self.beside.context.fresh("rpl_mask")
            first = ir.IntLiteral(_NO_MASK)
            self.data.append(ir.Variable(self.mask, ir.IntType(), first, scope="global"))
        watch.mask = self.mask
        if timed or key not in self.periods:
            watch.was = self.flag(f"rpl_interrupt_{key}_was")
        if timed and watch.may_come() is not None:
            report(MISSED, one.origin, action=_name(one.action))
        if not timed:
            self.task(watch)
        elif key in self.periods:
            self.timed(watch)

    def by_urgency(self) -> tuple[ir.Task, ...]:
        """The tasks, the most urgent first: of two that wait for the same moment it acts first."""
        return tuple(task for _, task in sorted(self.tasks, key=lambda entry: entry[0]))

    def refused(self, one: ir.DeclareInterrupt, key: int | None, routine: ir.Routine) -> str:
        """Why it cannot be watched; empty when it can."""
        if key is None:
            return "its number is computed"
        own = local_names(routine)
        for node in walk(one.condition, one.action):
            if isinstance(node, ir.Name) and node.id.lower() in own:
                return f"{node.id} is a variable of the routine that declares it"
        known = self.watches.get(key)
        if known is not None and known.of_source != (one.condition, one.action):
            return "the same number is declared for several conditions or actions"
        drives = closure(self.program, (ir.Move, ir.Spline, ir.MoveExternal))
        brakes = closure(self.program, (ir.StopMotion,))
        stores = closure(self.program, (ir.StoreMotion,))
        name = one.action.name.lower() if isinstance(one.action, ir.CallRoutine) else ""
        times, can = self.periods.get(key, []), self.beside.context.capabilities
        if times and any(time != times[0] for time in times):
            return "it comes by time, and at different ones"
        if (
            times
            and self.takes_time(one)
            and not (one.once and (can.interrupts.watched is Watched.ALL or PathRule.SEARCHED_DATA in can.motion.paths))
        ):
            return "it comes by time, takes time itself, and comes again or cannot be looked for in a move"
        if any(isinstance(node, ir.Name) and node.id.lower() in own for node in walk(*times)):
            return "its time is a variable of the routine that orders it"
        if name in stores:
            return "it puts the motion aside"
        if name in drives and name not in brakes and not one.stops:
            return "it moves the robot without braking first"
        return self.not_served(one, key, name in brakes) if self.takes_time(one) else ""

    def not_served(self, one: ir.DeclareInterrupt, key: int, brakes: bool) -> str:
        """Why no move can end for it, where one is driven while it is on."""
        others = [other.key for other in self.watches.values() if other.served and other.key != key]
        if any(self.overlap(key, other) for other in others):
            return "another one stops the robot already, and a move looks at one condition"
        on = armed_statements(self.program, Armed(key))
        driven = [
            node
            for node in walk_for({"Move", "MoveExternal", "Spline"}, *self.program.modules)
            if id(node) in on and isinstance(node, _DRIVEN)
        ]
        if any(not isinstance(node, ir.Move) for node in driven):
            return "what is driven while it is on is no single move"
        if driven and goes_on(self.program, one):
            return "it stops the robot in the middle of a move, which would have to go on from there"
        can = self.beside.context.capabilities
        looked = replace(one, condition=ir.Name(_DUE)) if key in self.periods else one
        every, data = can.interrupts.watched is Watched.ALL, PathRule.SEARCHED_DATA in can.motion.paths
        return unending(looked, brakes, every, data, self.program) if driven else ""

    def takes_time(self, one: ir.DeclareInterrupt) -> bool:
        if one.stops:
            return True
        if not isinstance(one.action, ir.CallRoutine):
            return False
        return one.action.name.lower() in closure(self.program, (*MOTION, *_ALONE))

    # ---- tasks

    def task(self, watch: Watch) -> None:
        """Waits for the condition to come and acts, again and again. What it was is noted where the program turns the
        interrupt on, so that a condition that comes before the task has looked is one that came."""
        name = self.beside.context.fresh(f"rpl_interrupt_{watch.key}")
        armed = ir.Name(watch.armed)
        off, cond = ir.Unary("not", armed), watch.declared.condition
        acts: list[ir.Statement] = [tidied(watch.declared.action)]
        if "Critical" in self.beside.context.capabilities.statements:
            acts = [ir.Critical(True), *acts, ir.Critical(False)]
        if watch.declared.once:
            acts.insert(0, ir.Assign(armed, ir.BoolLiteral(False)))
        came: ir.Expression = armed
        if watch.key in self.periods:
            body: list[ir.Statement] = [ir.WaitUntil(armed), ir.Wait(self.periods[watch.key][0])]
        else:
            was = ir.Name(watch.was)
            new = ir.Unary("not", was)
            came = ir.Binary("cand", armed, new)
            acts.insert(0, ir.Assign(was, ir.BoolLiteral(True)))
            body = [
                ir.WaitUntil(ir.Binary("cand", armed, ir.Binary("cor", new, ir.Unary("not", cond)))),
                ir.Assign(was, ir.BoolLiteral(False)),
                ir.WaitUntil(ir.Binary("cor", cond, off)),
            ]
        held = watch.may_come()
        if held is not None:
            body.append(ir.WaitUntil(ir.Binary("cor", held, off)))
        body.append(ir.If(((came, tuple(acts)),)))
        self.made.append(ir.Routine(name, body=tuple(body), scope="global"))
        self.tasks.append((watch.priority, ir.Task(name, name, kind="background", cyclic=True)))

    def timed(self, watch: Watch) -> None:
        """Once after a time, and served: a task waits for the time, and says when it has come."""
        name = self.beside.context.fresh(f"rpl_interrupt_{watch.key}")
        due = ir.Name(self.flag(f"rpl_interrupt_{watch.key}_due"))
        armed = ir.Name(watch.armed)
        came: ir.Body = (ir.Assign(due, ir.BoolLiteral(True)),)
        body: ir.Body = (
            ir.WaitUntil(armed),
            ir.Wait(self.periods[watch.key][0]),
            ir.If(((armed, came),)),
            ir.WaitUntil(ir.Unary("not", armed)),
            ir.Assign(due, ir.BoolLiteral(False)),
        )
        watch.declared = replace(watch.declared, condition=due)
        self.made.append(ir.Routine(name, body=body, scope="global"))
        self.tasks.append((watch.priority, ir.Task(name, name, kind="background", cyclic=True)))

    # ---- statements

    def body(self, body: ir.Body) -> ir.Body:
        done = map_body(body, self.statement)
        return done if done is body else self.armed_anew(done)

    def armed_anew(self, body: ir.Body) -> ir.Body:
        """Without disarming what is armed again at once: the task that watches would take the moment between for an
        end of its waiting, and look no more at what it has waited for."""
        began = {
            watch.armed: {watch.armed, watch.was} - {""}
            for watch in self.watches.values()
            if watch.key not in self.periods
        }
        done: list[ir.Statement] = []
        for statement in body:
            if (armed := _switched(statement, True)) in began:
                place = len(done)
                while place and _target(done[place - 1]) in began[armed]:
                    place -= 1
                    if _switched(done[place], False) == armed and not done[place].origin.comments:
                        del done[place]
            done.append(statement)
        return tuple(done)

    def statement(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.DeclareInterrupt():
                watch = self.watches.get(key_of(statement) or 0)
                if watch is None or key_of(statement) in self.lost:
                    return (statement,)
                return (_set(watch.armed, False, statement),)
            case ir.ControlInterrupt(op=op, handle=handle):
                return self.control(statement, op, handle)
            case ir.OrderInterrupt(event="timer", handle=handle):
                timed = self.watches.get(number_of(handle) or 0)
                if timed is None:
                    return (statement,)
                anew = (ir.Assign(ir.Name(timed.was), ir.BoolLiteral(False)),) if timed.was else ()
                return expansion(statement.origin, (*anew, _set(timed.armed, True, statement)))
        return (inside(statement, self.body),)

    def control(self, statement: ir.ControlInterrupt, op: str, handle: ir.Expression | None) -> ir.Body:
        if op == "mask":
            if not self.mask:
                return ()
            value = handle if handle is not None else ir.IntLiteral(_NO_MASK)
            return (ir.Assign(ir.Name(self.mask), value, origin=statement.origin),)
        key = number_of(handle)
        if key in self.lost:
            return (left_out(statement, REFUSED),)
        chosen = [*self.watches.values()] if handle is None else [self.watches[key]] if key in self.watches else []
        if not chosen:
            return (statement,) if handle is not None else ()
        done: list[ir.Statement] = []
        for watch in chosen:
            if op == "on" and watch.was:
                done.append(ir.Assign(ir.Name(watch.was), watch.declared.condition, origin=tidy(statement.origin)))
            if op in ("on", "off", "delete"):
                done.append(_set(watch.armed, op == "on", statement))
            elif op in ("enable", "disable") and watch.enabled:
                done.append(_set(watch.enabled, op == "disable", statement))
        if op == "enable" and any(watch.enabled for watch in chosen):  # what has waited for that comes first
            done.append(ir.Wait(ir.Quantity(ir.RealLiteral(self.beside.context.capabilities.io.poll_s), "s")))
        return expansion(statement.origin, done)

    # ---- levels

    def levels(self, program: ir.Program) -> ir.Program:
        """A declaration ends with its routine: the interrupt is off when that returns to a caller."""
        called = called_names(r for m in program.modules for r in m.routines)
        modules = tuple(
            replace(
                module,
                routines=tuple(
                    self.level(r) if r.name.lower() in self.declaring and r.name.lower() in called else r
                    for r in module.routines
                ),
            )
            for module in program.modules
        )
        return replace(program, modules=modules)

    def level(self, routine: ir.Routine) -> ir.Routine:
        keys = sorted(self.declaring[routine.name.lower()] & set(self.watches))
        off: ir.Body = tuple(ir.Assign(ir.Name(self.watches[key].armed), ir.BoolLiteral(False)) for key in keys)

        return left_with(routine, off)


_NO_MASK = 1000
_DUE = "due"  # stands for the truth value that says that the time of an interrupt has come


def tidied(action: ir.Assign | ir.CallRoutine) -> ir.Assign | ir.CallRoutine:
    return replace(action, origin=tidy(action.origin))


def _set(name: str, value: bool, statement: ir.Statement) -> ir.Statement:
    return ir.Assign(ir.Name(name), ir.BoolLiteral(value), origin=statement.origin)


__all__ = ["watching"]


def _target(statement: ir.Statement) -> str:
    """The variable that a statement assigns to."""
    match statement:
        case ir.Assign(target=ir.Name(id=name)):
            return name
    return ""


def _switched(statement: ir.Statement, value: bool) -> str:
    """The variable that a statement sets to this truth value."""
    match statement:
        case ir.Assign(value=ir.BoolLiteral(value=written)) if written == value:
            return _target(statement)
    return ""
