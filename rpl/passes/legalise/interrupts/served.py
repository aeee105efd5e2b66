"""Interrupts that the program serves itself while it waits: for the robot, for a time, for a condition.

Moves that may be interrupted are driven by a task, so that the program can look, act, brake and go on. What brakes
without leaving begins the move again from where the robot stands; what leaves its level raises a flag that every
routine below the declaration asks for behind each statement that takes time.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.control.jumps import inside
from rpl.passes.legalise.facts.usage import called_below
from rpl.passes.legalise.interrupts.heldmotion import not_again, path_differs, with_kept_target
from rpl.passes.legalise.interrupts.reach import Armed, armed_statements
from rpl.passes.legalise.interrupts.searchtasks import SearchTasks
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, expansion, map_body, negation
from rpl.passes.legalise.rewriting.support import default_value
from rpl.passes.legalise.settings.movesettings import plain
from rpl.passes.legalise.tasks.beside import Beside, closure, tidy
from rpl.passes.legalise.tasks.movers import Movers

MOTION = (ir.Move, ir.MoveExternal, ir.Spline, ir.StopMotion, ir.StartMotion, ir.ClearMotion, ir.ResumeLevel)
_TRUE, _FALSE = ir.BoolLiteral(True), ir.BoolLiteral(False)


@dataclass(slots=True)
class Watch:
    """One interrupt. `armed`, `was`, `enabled`, `mask`: data that says whether it is on, whether its condition held
    when looked at last, whether it waits (disabled), and how urgent it has to be. `came`: whether it has come and waits
    to act, where it is served and may be held back. `of_source`: its condition and its action as the program declares
    them."""

    key: int
    priority: int
    declared: ir.DeclareInterrupt
    armed: str
    routine: ir.Routine
    served: bool
    was: str = ""
    enabled: str = ""
    mask: str = ""
    came: str = ""
    of_source: tuple[ir.Expression, ir.Assign | ir.CallRoutine] = field(init=False)

    def __post_init__(self) -> None:
        self.of_source = (self.declared.condition, self.declared.action)

    def may_come(self) -> ir.Expression | None:
        """Is it neither disabled nor masked? None: that never happens."""
        parts: list[ir.Expression] = []
        if self.enabled:
            parts.append(ir.Unary("not", ir.Name(self.enabled)))
        if self.mask:
            parts.append(ir.Binary("<", ir.IntLiteral(self.priority), ir.Name(self.mask)))
        if not parts:
            return None
        return parts[0] if len(parts) == 1 else ir.Binary("cand", parts[0], parts[1])


@dataclass(slots=True)
class Served:
    program: ir.Program
    context: Context
    beside: Beside
    movers: Movers
    watches: dict[int, Watch]
    marked: frozenset[int] = frozenset()
    made: list[ir.Routine] = field(default_factory=list)
    names: dict[str, str] = field(default_factory=dict)
    handlers: frozenset[str] = frozenset()
    declaring: frozenset[str] = frozenset()
    leaves: bool = False
    brakes: bool = False
    again: frozenset[int] = frozenset()  # statements that may be stopped, and begin again then
    here: ir.Routine | None = None
    searching: SearchTasks | None = None

    def __post_init__(self) -> None:
        actions = [one.declared.action for one in self.watches.values()]
        roots = {one.name.lower() for one in actions if isinstance(one, ir.CallRoutine)}
        self.handlers = called_below(self.program, roots)
        resuming = closure(self.program, (ir.ResumeLevel,))
        self.leaves = bool(roots & resuming)
        stopping = closure(self.program, (ir.StopMotion,))
        goes_on = {key for key, one in self.watches.items() if _may_go_on(self.program, one.declared.action, stopping)}
        for key in goes_on:
            self.again |= armed_statements(self.program, Armed(key))
        self.brakes = bool(roots & stopping) or any(one.declared.stops for one in self.watches.values())
        found = set()
        for module in self.program.modules:
            for routine in module.routines:
                for node in walk(*bodies(routine)):
                    match node:
                        case ir.DeclareInterrupt(action=ir.CallRoutine(name=name)) if name.lower() in resuming:
                            found.add(routine.name.lower())
        self.declaring = frozenset(found)

    def name(self, stem: str) -> str:
        if stem not in self.names:
            self.names[stem] = self.context.fresh(stem)
        return self.names[stem]

    def arms(self, statement: ir.ControlInterrupt) -> bool | None:
        """Does it arm one of these (TRUE), or leave none of them armed (FALSE)?"""
        if statement.op not in ("on", "off", "delete"):
            return None
        handle = statement.handle
        known = handle is None or (isinstance(handle, ir.IntLiteral) and handle.value in self.watches)
        if not known and isinstance(handle, ir.IntLiteral):
            return None
        if statement.op == "on":
            return True
        return False if handle is None or len(self.watches) == 1 else None

    # ---- routines

    def routine(self, editor: Editor, original: ir.Routine, routine: ir.Routine) -> ir.Routine:
        self.here = original
        self.searching = SearchTasks(editor, original, self.beside, self.movers)
        key = original.name.lower()
        if key in self.handlers:
            return edit_bodies(routine, lambda body: map_body(body, self.handler))
        return edit_bodies(routine, lambda body: self.body(editor, body))

    def body(self, editor: Editor, body: ir.Body) -> ir.Body:
        """Moves that go on into each other are driven together."""
        done: list[ir.Statement] = []
        group: list[ir.Move] = []
        for statement in body:
            if group and not isinstance(statement, ir.Move | ir.Nothing):
                done.extend(self.drive(editor, group))
                group = []
            if isinstance(statement, ir.Move) and statement.search is None and id(statement) in self.marked:
                group.append(statement)
                if isinstance(statement.blend, ir.BlendStop | None):
                    done.extend(self.drive(editor, group))
                    group = []
            elif isinstance(statement, ir.Move) and group:
                done.extend(self.drive(editor, group))
                group = []
                done.extend(self.statement(editor, statement))
            else:
                done.extend(self.statement(editor, statement))
        if group:
            done.extend(self.drive(editor, group))
        return tuple(done)

    def drive(self, editor: Editor, moves: list[ir.Move]) -> ir.Body:
        assert self.here is not None  # set with the routine
        first: ir.Body = ()
        again = any(id(move) in self.again for move in moves)
        if again:
            first, moves[0] = with_kept_target(editor, moves[0])
        other = next(filter(None, map(path_differs, moves)), "")
        if again and other:
            return (*not_again(moves[0], other, self.context), *moves[1:])
        begun = self.movers.begin(editor, self.here, moves)
        comments = tuple(comment for move in moves for comment in move.origin.comments)
        call = ir.CallRoutine(self.name("rpl_drive"), origin=tidy(moves[0].origin))
        head = replace(moves[0], origin=replace(moves[0].origin, comments=comments))
        return (*first, *self.leaving(head, (*begun, call), True))

    def handler(self, statement: ir.Statement) -> ir.Body:
        """In the routine of an interrupt."""
        later = tidy(statement.origin)
        match statement:
            case ir.StopMotion():
                return (ir.CallRoutine(self.name("rpl_brake"), origin=statement.origin),)
            case ir.ClearMotion():
                return (_flag(self.beside.moving_name(), False, statement),)
            case ir.ResumeLevel():
                return (
                    ir.If(((ir.Unary("not", ir.Name(self.name("rpl_braked"))), (self.brake(later),)),), origin=later),
                    _flag(self.name("rpl_left"), True, statement),
                    ir.Return(origin=later),
                )
        return (inside(statement, lambda body: map_body(body, self.handler)),)

    def brake(self, origin: object) -> ir.Statement:
        return ir.CallRoutine(self.name("rpl_brake"))

    def statement(self, editor: Editor, statement: ir.Statement) -> ir.Body:
        """Of the program: while an interrupt may come, what takes time looks for it."""
        if isinstance(statement, ir.Move) and statement.search is not None:
            return self.leaving(statement, self.search(statement, statement.search, id(statement) in self.marked))
        if id(statement) not in self.marked:
            return (inside(statement, lambda body: self.body(editor, body)),)
        match statement:
            case ir.Wait(time=time):
                given = ir.Argument(plain(time))
                return self.leaving(statement, (ir.CallRoutine(self.name("rpl_wait"), (given,)),))
            case ir.WaitUntil():
                return self.leaving(statement, self.until(editor, statement))
            case ir.CallRoutine():
                return self.leaving(statement, (statement,))
        return (inside(statement, lambda body: self.body(editor, body)),)

    def search(self, move: ir.Move, search: ir.Search, armed: bool) -> ir.Body:
        assert self.searching is not None  # set with the routine
        return self.searching.search(move, search, self.waiting if armed else None)

    def waiting(self, condition: ir.Expression) -> ir.Body:
        """Waits for a condition and serves."""
        if self.leaves:
            condition = ir.Binary("cor", condition, ir.Name(self.name("rpl_left")))
        look = ir.CallRoutine(self.name("rpl_interrupts"))
        return (ir.While(negation(condition), (look, _pause(self.context))),)

    def until(self, editor: Editor, wait: ir.WaitUntil) -> ir.Body:
        if wait.timeout is None:
            return self.waiting(wait.condition)
        waited = editor.temporary("waited", ir.RealType())
        late = ir.Binary(">=", waited, plain(wait.timeout))
        (loop,) = self.waiting(ir.Binary("cor", wait.condition, late))
        assert isinstance(loop, ir.While)  # as waiting makes it
        step = ir.Assign(waited, ir.Binary("+", waited, ir.RealLiteral(self.context.capabilities.io.poll_s)))
        told: ir.Body = ()
        if wait.timed_out is not None:
            told = (ir.Assign(wait.timed_out, ir.Unary("not", wait.condition)),)
        first = ir.Assign(waited, ir.RealLiteral(0.0))
        return (first, replace(loop, body=(*loop.body, step)), *told)

    def leaving(self, statement: ir.Statement, done: ir.Body, marked: bool = False) -> ir.Body:
        """What takes time, and the way out behind it where an interrupt may have left the level."""
        if not self.leaves or self.here is None or not (marked or id(statement) in self.marked):
            return expansion(statement.origin, done)
        left = ir.Name(self.name("rpl_left"))
        out: ir.Body = (ir.Assign(left, _FALSE),)
        if self.here.name.lower() not in self.declaring:
            value = default_value(self.here.returns) if self.here.returns is not None else None
            out = (ir.Return(value),)
            return expansion(statement.origin, (*done, ir.If(((left, out),))))
        return expansion(statement.origin, (*done, *out))

    # ---- what the program brings along

    def finish(self) -> None:
        """Adds the routines that look and act."""
        if not self.watches:
            return
        moving = ir.Name(self.beside.moving_name())
        look = ir.CallRoutine(self.name("rpl_interrupts"))
        pause = _pause(self.context)
        going: ir.Expression = moving
        self.made.append(_routine(self.name("rpl_interrupts"), self.looking()))
        if "rpl_drive" in self.names:
            self.made.append(_routine(self.name("rpl_drive"), (ir.While(going, (look, pause)),)))
        if "rpl_wait" in self.names:
            self.made.append(self.wait_routine(look, pause))
        if "rpl_brake" in self.names:
            kill = ir.If(((moving, (ir.TaskControl("stop", self.movers.task()),)),))
            parts: ir.Body = (kill,) if self.movers.home is not None else ()
            told = _assign(self.name("rpl_braked"), True)
            self.made.append(_routine(self.name("rpl_brake"), (*parts, ir.StopMotion(), told)))

    def wait_routine(self, look: ir.Statement, pause: ir.Statement) -> ir.Routine:
        waited, time = ir.Name("waited"), ir.Name("seconds")
        more = ir.Assign(waited, ir.Binary("+", waited, ir.RealLiteral(self.context.capabilities.io.poll_s)))
        going: ir.Expression = ir.Binary("<", waited, time)
        if self.leaves:
            going = ir.Binary("cand", going, ir.Unary("not", ir.Name(self.name("rpl_left"))))
        body: ir.Body = (ir.Assign(waited, ir.RealLiteral(0.0)), ir.While(going, (look, pause, more)))
        return ir.Routine(
            self.name("rpl_wait"),
            parameters=(ir.Parameter("seconds", ir.RealType()),),
            declarations=(ir.Variable("waited", ir.RealType(), scope="routine"),),
            body=body,
            scope="global",
        )

    def looking(self) -> ir.Body:
        """The interrupts by their urgency; one that comes while another one acts waits."""
        acting = ir.Name(self.name("rpl_acting"))
        body: list[ir.Statement] = [ir.If(((acting, (ir.Return(),)),))]
        for watch in sorted(self.watches.values(), key=lambda one: one.priority):
            body.extend(self.look(watch))
        return tuple(body)

    def look(self, watch: Watch) -> ir.Body:
        """Acts where the condition has come. What is held back is noted, also when the condition goes meanwhile."""
        was, condition = ir.Name(watch.was), watch.declared.condition
        moving = self.beside.moving_name()
        comes: ir.Expression = ir.Binary("cand", ir.Name(watch.armed), ir.Unary("not", was))
        held = watch.may_come()
        noted = _assign(watch.came, False) if watch.came else _assign(watch.was, True)
        acts: list[ir.Statement] = [noted, _assign(self.name("rpl_acting"), True)]
        if watch.declared.once:
            acts.insert(0, _assign(watch.armed, False))
        if watch.declared.stops:
            acts.append(ir.CallRoutine(self.name("rpl_brake")))
        acts.append(replace(watch.declared.action, origin=tidy(watch.declared.action.origin)))
        if watch.declared.stops:
            acts.append(self.next_move(moving))
        acts.append(_assign(self.name("rpl_acting"), False))
        if self.brakes or self.leaves:
            acts.append(self.going_on())
        came = ir.Binary("cand", condition, comes)
        gone = (ir.Unary("not", condition), (_assign(watch.was, False),))
        if held is None:
            return (ir.If(((came, tuple(acts)), gone)),)
        waits = ir.Binary("cand", ir.Binary("cand", ir.Name(watch.came), ir.Name(watch.armed)), held)
        seen = ir.If(((came, (_assign(watch.was, True), _assign(watch.came, True))), gone))
        return (seen, ir.If(((waits, tuple(acts)),)))

    def next_move(self, moving: str) -> ir.Statement:
        """The move that was stopped is dropped; one that follows it through a corner begins from there."""
        dropped = _assign(moving, False)
        if not self.movers.last:
            return dropped
        number, last = ir.Name(self.movers.number), ir.Name(self.movers.last)
        onward = ir.Assign(number, ir.Binary("+", number, ir.IntLiteral(1)))
        return ir.If(((ir.Binary("<", number, last), (onward,)),), (dropped,))

    def going_on(self) -> ir.Statement:
        """Behind an action that braked: the move goes on, unless its level was left."""
        braked, moving = self.name("rpl_braked"), self.beside.moving_name()
        again: ir.Body = (ir.TaskControl("start", self.movers.task()),) if self.movers.home is not None else ()
        inner: ir.Statement = ir.If(((ir.Name(moving), again),)) if again else ir.Nothing()
        if self.leaves:
            dropped: ir.Body = (_assign(moving, False),)
            inner = ir.If(((ir.Name(self.name("rpl_left")), dropped), (ir.Name(moving), again)))
        return ir.If(((ir.Name(braked), (_assign(braked, False), inner)),))

    def data(self) -> tuple[ir.Variable, ...]:
        words = ("rpl_acting", "rpl_braked", "rpl_left")
        named = [self.names[word] for word in words if word in self.names]
        return tuple(ir.Variable(name, ir.BoolType(), _FALSE, scope="global") for name in named)


def _may_go_on(program: ir.Program, action: ir.Assign | ir.CallRoutine, stopping: frozenset[str]) -> bool:
    """Does the interrupt stop the robot, and not surely leave its level behind that?"""
    if not isinstance(action, ir.CallRoutine) or action.name.lower() not in stopping:
        return False
    for module in program.modules:
        for routine in module.routines:
            if routine.name.lower() == action.name.lower():
                ways_out = any(isinstance(node, ir.Return | ir.Goto) for node in walk(*bodies(routine)))
                said = [one for one in routine.body if not isinstance(one, ir.Nothing)]
                return ways_out or not said or not isinstance(said[-1], ir.ResumeLevel)
    return True


def _routine(name: str, body: ir.Body) -> ir.Routine:
    return ir.Routine(name, body=body, scope="global")


def _assign(name: str, value: bool) -> ir.Statement:
    return ir.Assign(ir.Name(name), _TRUE if value else _FALSE)


def _flag(name: str, value: bool, statement: ir.Statement) -> ir.Statement:
    return ir.Assign(ir.Name(name), _TRUE if value else _FALSE, origin=statement.origin)


def _pause(context: Context) -> ir.Statement:
    return ir.Wait(ir.Quantity(ir.RealLiteral(context.capabilities.io.poll_s), "s"))


__all__ = ["MOTION", "Served", "Watch"]
