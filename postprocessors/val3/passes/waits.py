"""A VAL3 program runs ahead of the robot over all movements: what looks at the outside, or acts on it, waits first.

`waitEndMove()` is put in front of a statement that reads or switches a signal, asks where the robot is or what time it
is, waits, shows something, or stops, wherever a movement may be under way; so too in front of a movement whose own
places are seen from where the robot is, since `here` is worked out when the statement is executed.
Programs of languages that run ahead over all movements themselves say where they wait, and stay as they are.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.ir.walk import children, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies

CORNER = code(
    "val3-corner-given-up",
    Severity.WARNING,
    "the robot stops at this corner: the program has to wait there for what comes next",
)
_MOVES = (ir.Move, ir.MoveExternal, ir.Spline)
_ACTS = (
    *(ir.Wait, ir.WaitUntil, ir.Message, ir.Dialog, ir.Pulse, ir.SetAfter, ir.Clock, ir.Halt, ir.TaskControl),
    *(ir.Opaque, ir.Vendor, ir.StopMotion, ir.ClearMotion),
)
_LOOKS = frozenset(("current_target", "current_joints", "current_position", "clock_seconds", "task_runs"))


@legalising(sees=("Move", "MoveExternal", "Spline"))
def waits_put_in(program: ir.Program, context: Context) -> ir.Program:
    """A wait wherever the robot has to stand before a statement."""
    routines = {routine.name: routine for module in program.modules for routine in module.routines}
    worker = _Waits(_moving(routines), _watched(program), context.diagnostics)
    modules = []
    for module in program.modules:
        done = []
        for routine in module.routines:
            worker.pending = routine.name in worker.movers or bool(worker.movers)
            done.append(edit_bodies(routine, worker.body))
        modules.append(replace(module, routines=tuple(done)))
    return replace(program, modules=tuple(modules))


def _moving(routines: dict[str, ir.Routine]) -> frozenset[str]:
    """Routines that command movements, themselves or by calls."""
    movers = {name for name, one in routines.items() if any(isinstance(node, _MOVES) for node in walk(one))}
    known = -1
    while known != len(movers):
        known = len(movers)
        for name, one in routines.items():
            if any(isinstance(node, ir.CallRoutine) and node.name in movers for node in walk(one)):
                movers.add(name)
    return frozenset(movers)


def _watched(program: ir.Program) -> frozenset[str]:
    """Variables that more than one task knows: to set one is seen outside."""
    started = {
        node.task
        for node in walk_for({"TaskControl"}, *program.modules)
        if isinstance(node, ir.TaskControl) and node.op == "start"
    }
    started |= {task.entry for task in program.tasks if task.kind == "background"}
    names: set[str] = set()
    for module in program.modules:
        for routine in module.routines:
            if routine.name in started:
                names.update(node.id for node in walk(routine) if isinstance(node, ir.Name))
    shared = {d.name for module in program.modules for d in module.declarations if isinstance(d, ir.Variable)}
    return frozenset(names & shared)


class _Waits:
    def __init__(self, movers: frozenset[str], watched: frozenset[str], diagnostics: Diagnostics) -> None:
        self.movers, self.watched, self.diagnostics = movers, watched, diagnostics
        self.pending = False
        self.last: ir.Move | None = None  # the movement just commanded, where it goes over into the next one

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        for statement in body:
            if self.pending and self.needs_rest(statement):
                if self.last is not None:
                    self.diagnostics.report(CORNER, self.last.origin)
                done.append(ir.WaitForMotion(origin=replace(statement.origin, comments=())))
                self.pending = False
            if not isinstance(statement, ir.Nothing):
                self.last = None
            done.append(self.inside(statement))
            if isinstance(statement, ir.Move) and statement.blend not in (None, ir.BlendStop()):
                self.last = statement
        return tuple(done)

    def inside(self, statement: ir.Statement) -> ir.Statement:
        """The statement with waits in its bodies; what may be under way behind it."""
        match statement:
            case ir.WaitForMotion():
                self.pending = False
            case ir.Move() | ir.MoveExternal() | ir.Spline():
                self.pending = True
            case ir.CallRoutine(name=name) if name in self.movers:
                self.pending = True
            case ir.If() | ir.Switch():
                return self.branched(statement)
            case ir.While() | ir.Repeat() | ir.For() | ir.Loop():
                return self.repeated(statement)
        return statement

    def repeated(self, statement: ir.While | ir.Repeat | ir.For | ir.Loop) -> ir.Statement:
        """A loop begins again as its body ends; a condition that looks at the outside is looked at behind the body."""
        begun = self.pending
        again = statement.condition if isinstance(statement, ir.While) else None
        again = statement.until if isinstance(statement, ir.Repeat) else again
        self.pending = begun or self.moves(statement)

        def whole(body: ir.Body) -> ir.Body:
            done = self.body(body)
            if self.pending and again is not None and self.looks(again):
                self.pending = False
                return (*done, ir.WaitForMotion(origin=replace(statement.origin, comments=())))
            return done

        done = rewrite_bodies(statement, whole)
        self.pending = self.pending or (begun and not isinstance(statement, ir.Repeat))
        return done

    def branched(self, statement: ir.If | ir.Switch) -> ir.Statement:
        begun, ends = self.pending, [self.pending]

        def branch(body: ir.Body) -> ir.Body:
            self.pending = begun
            done = self.body(body)
            ends.append(self.pending)
            return done

        done = rewrite_bodies(statement, branch)
        self.pending = any(ends)
        return done

    def moves(self, statement: ir.Statement) -> bool:
        return any(
            isinstance(node, _MOVES) or (isinstance(node, ir.CallRoutine) and node.name in self.movers)
            for node in walk(statement)
        )

    def needs_rest(self, statement: ir.Statement) -> bool:
        if isinstance(statement, _ACTS):
            return not (isinstance(statement, ir.Vendor) and statement.effect in ("none", "tuning"))
        if isinstance(statement, ir.Move) and statement.search is not None:
            return True  # the program looks while this movement alone is driven
        if isinstance(statement, ir.Assign) and _base(statement.target) in self.watched:
            return True
        return any(self.looks(part) for part in _own_parts(statement))

    def looks(self, part: object) -> bool:
        """Does an expression look at the outside?"""
        for node in walk(part):
            match node:
                case ir.Signal() | ir.System(name="time" | "moving" | "timer" | "actual_pose" | "actual_joints"):
                    return True
                case ir.Builtin(function=function) if function in _LOOKS:
                    return True
                case ir.Name(id=name) if name in self.watched:
                    return True
        return False


def _base(place: ir.Expression) -> str:
    match place:
        case ir.Name(id=name):
            return name
        case ir.Index(base=base) | ir.Field(base=base):
            return _base(base)
    return ""


def _own_parts(statement: ir.Statement) -> list[object]:
    """What the statement itself evaluates: not its bodies."""
    match statement:
        case ir.If(branches=branches):
            return [condition for condition, _ in branches]
        case ir.Switch(selector=selector):
            return [selector]
        case ir.While(condition=condition):
            return [condition]
        case ir.For(start=start, stop=stop, step=step):
            return [start, stop, *([step] if step is not None else [])]
        case ir.Repeat() | ir.Loop():
            return []
    return list(children(statement))
