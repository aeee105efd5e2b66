"""Path events as statements before a move (KRL) to stored events that the move names (RAPID), and back; or both to
events that a move says itself (FANUC).
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes import rigid
from rpl.passes.capabilities import TriggerRule
from rpl.passes.fold import Unchanged, constant, constant_number
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.settingsinforce import SettingsInForce
from rpl.passes.legalise.facts.usage import usage_of
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.paths.storedevents import events_before_moves
from rpl.passes.legalise.rewriting.earlyways import by_way
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.rewriting.formulas import plain
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.values import Target

_AXES = frozenset(("tool", "base", "displacement"))
_ARM_STANDS = (
    ir.DeclareInterrupt
    | ir.ConnectInterrupt
    | ir.ControlInterrupt
    | ir.OrderInterrupt
    | ir.Wait
    | ir.Clock
    | ir.Message
)


@legalising()
def triggers(program: ir.Program, context: Context) -> ir.Program:
    """Rewrites towards whichever form the target has."""
    statements = context.capabilities.statements
    if TriggerRule.OF_MOVES in context.capabilities.motion.triggers:
        return _at_moves(events_before_moves(program, context))
    if "Trigger" not in statements and "DefineTrigger" in statements:
        return _Stored(context).program(program)
    if "DefineTrigger" not in statements and "Trigger" in statements:
        return events_before_moves(program, context)
    return program


class _Stored:
    """Trigger statements become variables of trigger type; calls become interrupts with trap routines. A call some time
    behind its place is that of a second interrupt, by a timer that the first one starts."""

    def __init__(self, context: Context) -> None:
        self.context = context
        self.scope: Scope | None = None
        self.flow: SettingsInForce | None = None  # of the settings, where the target's rule needs the speed of moves
        self.declarations: list[ir.Declaration] = []
        self.routines: list[ir.Routine] = []
        self.pending = False  # may the program come here again before the event at hand has come?
        self.everywhere: frozenset[str] = frozenset()  # variables that a trap of the module at hand sees, folded

    def program(self, program: ir.Program) -> ir.Program:
        scopes = ProgramScope(program)
        if rules_of(self.context.target).triggers.early_while_braking:
            self.flow = SettingsInForce.begun_by(program, self.context.source)
        seen = [one for module in program.modules for one in module.declarations if isinstance(one, ir.Variable)]
        everywhere = frozenset(one.name.lower() for one in seen if one.scope == "global")
        return replace(program, modules=tuple(self.module(module, scopes, everywhere) for module in program.modules))

    def module(self, module: ir.Module, scopes: ProgramScope, everywhere: frozenset[str]) -> ir.Module:
        """The module with the events of its moves, and the interrupts and traps that these need."""
        own = (one.name.lower() for one in module.declarations if isinstance(one, ir.Variable))
        self.everywhere = everywhere.union(own)
        self.declarations, self.routines = [], []
        routines = tuple(self.routine(one, scopes.routine(module, one)) for one in module.routines)
        if not self.declarations:
            return module
        declarations = (*module.declarations, *self.declarations)
        return replace(module, declarations=declarations, routines=(*routines, *self.routines))

    def routine(self, routine: ir.Routine, scope: Scope) -> ir.Routine:
        self.scope = scope
        return edit_bodies(routine, self.body)

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        waiting: list[ir.Trigger] = []
        for given in body:
            statement = given
            if isinstance(statement, ir.Trigger):
                waiting.append(statement)
                continue
            if isinstance(statement, ir.Move) and not _at_the_move(statement.triggers):
                waiting += [one for one in statement.triggers if isinstance(one, ir.Trigger)]
                own = tuple(one for one in statement.triggers if not isinstance(one, ir.Trigger))
                statement = replace(statement, triggers=own)
            if waiting and isinstance(statement, ir.Move):
                speed = self.speed(given)
                names: list[ir.Expression] = []
                for trigger in waiting:
                    name = self.context.fresh("rpl_trigger")
                    self.declarations.append(ir.Variable(name, ir.TriggerType(), scope="module"))
                    names.append(ir.Name(name))
                    self.pending = not isinstance(statement.blend, ir.BlendStop | None)
                    done.extend(self.stored(self.placed(trigger, statement, speed), ir.Name(name)))
                waiting = []
                done.append(replace(statement, triggers=(*statement.triggers, *names)))
                continue
            if isinstance(statement, ir.DefineTrigger) and statement.interrupt is None:
                self.pending = False
                done.extend(self.stored(statement.trigger, statement.target))
                continue
            if waiting and not isinstance(statement, ir.Assign | ir.Nothing | ir.LookAhead):
                done.extend(waiting)  # no move follows here: left for the writer to report
                waiting = []
            done.append(rewrite_bodies(statement, self.body))
        done.extend(waiting)
        return tuple(done)

    def speed(self, move: ir.Statement) -> ir.Expression | None:
        """What the move says of its speed on the path, or what holds for all moves there; None: it has a time."""
        own = move.speed if isinstance(move, ir.Move) else None
        if self.flow is None or (own is not None and own.duration is not None):
            return None
        if own is not None and own.path is not None:
            return own.path
        return self.flow.at(move).get("path_speed") or ir.System("path_speed")

    def placed(self, trigger: ir.Trigger, move: ir.Move, speed: ir.Expression | None) -> ir.Trigger:
        """A routine that begins a constant time before the end of a straight move begins at the place where the tool is
        then, where the target counts such a time only while the robot brakes."""
        if speed is None or move.kind != "linear" or self.scope is None:
            return trigger
        delay = None if trigger.delay is None else constant_number(plain(trigger.delay), self.scope)
        switches = isinstance(trigger.action, ir.Assign) and not self.by_a_trap(trigger.action)
        if trigger.reference == "middle" and isinstance(move.blend, ir.BlendStop | None):
            trigger = replace(trigger, reference="end")  # no corner is there
        if switches or trigger.reference != "end" or delay is None or delay >= 0.0:
            return trigger
        return by_way(trigger, move, plain(speed), self.context)

    def stored(self, trigger: ir.Trigger, variable: ir.Expression) -> list[ir.Statement]:
        """The statements that put the event into the variable."""
        later = replace(trigger.origin, comments=())
        delay = None if trigger.delay is None or self.scope is None else constant_number(trigger.delay, self.scope)
        if delay == 0:
            trigger = replace(trigger, delay=None)
        if isinstance(trigger.action, ir.Assign) and not self.by_a_trap(trigger.action):
            if trigger.distance is None and trigger.delay is not None and trigger.reference != "start":
                # A time before the end alone may count only while the robot brakes; from a place it counts as it is.
                trigger = replace(trigger, distance=ir.RealLiteral(0.0, origin=later))
            return [ir.DefineTrigger(variable, replace(trigger, origin=later), origin=trigger.origin)]
        steps: list[ir.Statement] = []
        action: ir.Statement = trigger.action
        if delay is not None and delay > 0 and trigger.delay is not None:
            self.pending = True
            timer = self.interrupt(action, steps, trigger)
            action = ir.OrderInterrupt(timer, "timer", time=trigger.delay, once=True, origin=later)
            trigger = replace(trigger, delay=None)
        handle = self.interrupt(action, steps, trigger)
        steps[0] = replace(steps[0], origin=trigger.origin)
        return [*steps, ir.DefineTrigger(variable, replace(trigger, origin=later), handle, origin=later)]

    def by_a_trap(self, action: ir.Assign) -> bool:
        """Does only a routine do this: a variable that gets a value, or a signal that gets what is worked out then?"""
        output = isinstance(action.target, ir.Signal) and action.target.kind != "flag"
        switched = output and not isinstance(action.value, ir.Binary | ir.Unary)
        names = {node.id.lower() for node in walk(action) if isinstance(node, ir.Name)}
        called = any(isinstance(node, ir.Call) for node in walk(action))
        return not switched and not called and names <= self.everywhere

    def interrupt(self, action: ir.Statement, steps: list[ir.Statement], trigger: ir.Trigger) -> ir.Name:
        """An interrupt whose trap does the action; `steps` connect it."""
        handle, trap = self.context.fresh("rpl_trigger_interrupt"), self.context.fresh("rpl_trigger_trap")
        self.declarations.append(ir.Variable(handle, ir.InterruptType(), scope="module"))
        self.routines.append(ir.Routine(trap, "trap", body=(action,)))
        later = replace(trigger.origin, comments=())
        connect = ir.ConnectInterrupt(ir.Name(handle), trap, origin=later)
        if self.pending:  # a new connection would forget the event that is still to come
            done = self.context.fresh("rpl_trigger_connected")
            self.declarations.append(ir.Variable(done, ir.BoolType(), ir.BoolLiteral(False), scope="module"))
            noted = ir.Assign(ir.Name(done), ir.BoolLiteral(True), origin=later)
            steps.append(ir.If(((ir.Unary("not", ir.Name(done)), (connect, noted)),), origin=later))
        else:
            steps.extend((ir.ControlInterrupt("delete", ir.Name(handle), origin=later), connect))
        return ir.Name(handle)


_Begin = tuple[ir.Move, rigid.Vector | None]  # the move before, at whose end the next one begins, and its place
_Starts = dict[str, list[_Begin | None]]  # routine, folded -> where its calls begin


class _AtMoves:
    """Trigger statements become part of the move behind them. What comes a time behind the start of a move comes that
    time behind the end of the one before, where the two follow each other. `starts`: where routines begin; `noted`:
    where this one's calls do."""

    def __init__(self, scope: Scope, unchanged: Unchanged, starts: _Starts, noted: _Starts) -> None:
        self.scope, self.unchanged, self.starts, self.noted = scope, unchanged, starts, noted

    def routine(self, routine: ir.Routine) -> ir.Routine:
        begins = routine.name.lower()
        return edit_bodies(routine, lambda body: self.body(body, begins if body is routine.body else ""))

    def known(self, begins: _Begin | ir.Move | None) -> _Begin | None:
        """With its place, which is asked for few moves only."""
        return (begins, self.place(begins)) if isinstance(begins, ir.Move) else begins

    def called(self, statement: ir.Statement, begins: _Begin | ir.Move | None) -> None:
        """Notes where the robot is at the calls of a statement; a call within another statement may be anywhere."""
        for node in walk_for({"CallRoutine", "Call"}, statement):
            if isinstance(node, ir.CallRoutine | ir.Call):
                begin = self.known(begins) if node is statement else None
                own = begin is not None and isinstance(begin[0].blend, ir.BlendStop | None)
                self.noted.setdefault(node.name.lower(), []).append(begin if own else None)

    def body(self, body: ir.Body, routine: str = "", inner: bool = False) -> ir.Body:
        """A body. `inner`: of a statement, whose calls are noted as what they are: anywhere."""
        done: list[ir.Statement] = []
        waiting: list[ir.Trigger] = []
        calls = self.starts.get(routine, [])
        begins: _Begin | ir.Move | None = calls[0] if calls and all(one == calls[0] for one in calls) else None
        last: int | None = None  # the place in `done` of the move before, while nothing stands between that takes time
        for statement in body:
            if not inner:
                self.called(statement, begins)
            match statement:
                case ir.Trigger():
                    waiting.append(statement)
                    continue
                case ir.Move():
                    own = [replace(one, origin=replace(one.origin, comments=())) for one in waiting]
                    comments = [ir.Nothing(origin=one.origin) for one in waiting if one.origin.comments]
                    done.extend(comments)
                    if last is not None:
                        before = done[last]
                        assert isinstance(before, ir.Move)  # noted below
                        early = [
                            one for one in own if self.behind_the_start(one) or self.in_corner(one, before, statement)
                        ]
                        moved = [replace(one, reference="end") for one in early]
                        done[last] = replace(before, triggers=(*before.triggers, *moved)) if moved else before
                        own = [one for one in own if one not in early]
                    own = [self.from_end(one, self.known(begins), statement) for one in own]
                    last, waiting, begins = len(done), [], statement
                    done.append(replace(statement, triggers=(*own, *statement.triggers)) if own else statement)
                    continue
                case ir.Assign() | ir.Nothing() | ir.LookAhead():
                    done.append(statement)
                    begins = None if _moves_the_axes(statement) else begins
                    continue
            done.extend(waiting)  # no move follows here: left for the writer to report
            last, waiting = None, []
            begins = begins if isinstance(statement, _ARM_STANDS) else None
            done.append(rewrite_bodies(statement, self.inner))
        return (*done, *waiting)

    def inner(self, body: ir.Body) -> ir.Body:
        return self.body(body, inner=True)

    def from_end(self, trigger: ir.Trigger, begins: _Begin | None, move: ir.Move) -> ir.Trigger:
        """What comes some way behind the start of a straight move, counted from its end where both are constants."""
        if trigger.reference != "start" or trigger.delay is not None or trigger.distance is None or begins is None:
            return trigger
        behind, length = constant_number(trigger.distance, self.scope), self.length(begins, move)
        if not behind or length is None or begins[0].search is not None:
            return trigger
        left = behind - length
        if left > 0:
            return trigger
        return replace(trigger, reference="end", distance=ir.RealLiteral(float(f"{left:.9g}")))

    def length(self, begins: _Begin, move: ir.Move) -> float | None:
        """The length of a straight move between two constant places, mm."""
        before, first = begins
        same = before.frame == move.frame and before.tool == move.tool
        second = self.place(move)
        if not same or move.kind != "linear" or first is None or second is None:
            return None
        return second.plus(first, -1.0).length

    def place(self, move: ir.Move) -> rigid.Vector | None:
        """Where a move ends, in mm, if that is a constant."""
        found = None if move.relative else constant(move.target, self.scope, self.unchanged)
        pose = found.pose if isinstance(found, Target) else found
        return pose.position if isinstance(pose, rigid.Pose) else None

    def in_corner(self, trigger: ir.Trigger, before: ir.Move, move: ir.Move) -> bool:
        """Does it come at the start of a way of unknown length, which begins in the corner of the move before?"""
        if trigger.reference != "start" or isinstance(before.blend, ir.BlendStop | None) or before.search is not None:
            return False
        distance = 0.0 if trigger.distance is None else constant_number(trigger.distance, self.scope)
        return distance == 0 and move.kind != "circular" and self.length((before, self.place(before)), move) is None

    def behind_the_start(self, trigger: ir.Trigger) -> bool:
        """Does it come a time behind the start itself?"""
        if trigger.reference != "start" or trigger.delay is None:
            return False
        distance = 0.0 if trigger.distance is None else constant_number(trigger.distance, self.scope)
        return distance == 0 and (constant_number(trigger.delay, self.scope) or 0) > 0


def _at_moves(program: ir.Program) -> ir.Program:
    scopes = ProgramScope(program)
    unchanged = Unchanged(usage_of(program).assigned)
    starts = _starts(program, scopes, unchanged)
    modules = []
    for module in program.modules:
        routines = [
            _AtMoves(scopes.routine(module, one), unchanged, starts, {}).routine(one) for one in module.routines
        ]
        modules.append(replace(module, routines=tuple(routines)))
    return replace(program, modules=tuple(modules))


def _starts(program: ir.Program, scopes: ProgramScope, unchanged: Unchanged) -> _Starts:
    """Where the routines begin that are called in the run of the program only."""
    found: _Starts = {}
    for module in program.modules:
        for routine in module.routines:
            _AtMoves(scopes.routine(module, routine), unchanged, {}, found).routine(routine)
    beside = [program.entry or "", *(task.entry for task in program.tasks)]
    for node in walk_for({"CallRoutine", "ConnectInterrupt", "TaskControl"}, *program.modules):
        match node:
            case ir.CallRoutine(dynamic=dynamic) if dynamic is not None:
                begin = _first_text(dynamic)
                beside += [name for name in found if name.startswith(begin)]
            case ir.ConnectInterrupt(routine=name) | ir.TaskControl(task=name):
                beside.append(name)
    for name in beside:
        found.setdefault(name.lower(), []).append(None)
    return found


def _first_text(name: ir.Expression) -> str:
    """What a composed name surely begins with, folded."""
    while isinstance(name, ir.Binary) and name.op == "&":
        name = name.left
    return name.value.lower() if isinstance(name, ir.TextLiteral) else ""


def _moves_the_axes(statement: ir.Statement) -> bool:
    """Does it change what places are told in?"""
    system = statement.target if isinstance(statement, ir.Assign) else None
    return isinstance(system, ir.System) and system.name in _AXES


def _at_the_move(triggers: tuple[ir.Expression | ir.Trigger, ...]) -> bool:
    """Can the events stand at the move itself: stored ones, or one in the middle of its corner?"""
    own = [one for one in triggers if isinstance(one, ir.Trigger)]
    if not own:
        return True
    alone = len(triggers) == 1
    return alone and own[0].reference == "middle" and own[0].distance is None and own[0].delay is None
