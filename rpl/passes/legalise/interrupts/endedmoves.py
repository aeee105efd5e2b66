"""Interrupts that stop the robot, or that come while the program waits, for targets whose tasks cannot stop it, but
whose moves end at a condition.

While such an interrupt may come, each move is a search for its condition. Where that came, the program acts behind the
move, and goes on there or leaves the level of the declaration; while the program only waits it looks for the condition
in each cycle. A move that would have to go on from its middle is refused: it would be another one.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes.conditions import negation
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import called_below
from rpl.passes.legalise.facts.watches import Watch
from rpl.passes.legalise.rewriting.beside import closure, tidy
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, expansion, map_body
from rpl.passes.legalise.rewriting.formulas import plain
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.support import default_value

__all__ = ["CORNER", "EndedMoves", "goes_on", "unending"]

CORNER = code(
    "interrupt-stops-corner",
    Severity.WARNING,
    "a move that an interrupt may stop ends at its point: its corner is not rounded while the interrupt may come",
)
_TRUE, _FALSE = ir.BoolLiteral(True), ir.BoolLiteral(False)


def goes_on(program: ir.Program, one: ir.DeclareInterrupt) -> bool:
    """Does the interrupt stop the robot in the middle of a move that may go on behind the action? Not where the action
    surely leaves its level behind that."""
    stopping = closure(program, (ir.StopMotion,))
    if one.stops or not isinstance(one.action, ir.CallRoutine) or one.action.name.lower() not in stopping:
        return False
    for routine in (routine for module in program.modules for routine in module.routines):
        if routine.name.lower() == one.action.name.lower():
            ways_out = any(isinstance(node, ir.Return | ir.Goto) for node in walk(*bodies(routine)))
            said = [each for each in routine.body if not isinstance(each, ir.Nothing)]
            return ways_out or not said or not isinstance(said[-1], ir.ResumeLevel)
    return True


def unending(one: ir.DeclareInterrupt, brakes: bool, any_condition: bool, data: bool, program: ir.Program) -> str:
    """Why no move can end for it; empty when one can. `any_condition`: a move may end at any; `data`: at a truth value
    too."""
    if not brakes and not one.stops:
        return "it takes time while the robot moves on"
    if not any_condition and not _looks_at_input(one.condition, data, _signals(program)):
        return "a move ends at one input only"
    return ""


def _signals(program: ir.Program) -> dict[str, ir.Signal]:
    """The physical signals by their names, folded."""
    found = (node for module in program.modules for node in module.declarations)
    return {one.name.lower(): one.signal for one in found if isinstance(one, ir.SignalDeclaration)}


def _looks_at_input(condition: ir.Expression, data: bool, signals: Mapping[str, ir.Signal]) -> bool:
    match condition:
        case ir.Name(id=name) if name.lower() in signals:
            return _looks_at_input(signals[name.lower()], data, {})
        case ir.Name():
            return data
        case ir.Signal(kind="digital_in", last=None):
            return True
        case ir.Unary(op="not", operand=operand) | ir.Binary(op="=" | "<>", left=operand, right=ir.BoolLiteral()):
            return _looks_at_input(operand, data, signals)
    return False


@dataclass(slots=True)
class EndedMoves:
    """Rewrites a program for one interrupt. `marked`: statements (by identity) that may run while it is on; `handlers`:
    what its action calls, `declaring`: the routines that declare it (both folded); `leaves`: its action leaves its
    level."""

    program: ir.Program
    context: Context
    watch: Watch
    marked: frozenset[int] = frozenset()
    made: list[ir.Routine] = field(default_factory=list)
    names: dict[str, str] = field(default_factory=dict)
    handlers: frozenset[str] = frozenset()
    declaring: frozenset[str] = frozenset()
    leaves: bool = False
    here: ir.Routine | None = None

    def __post_init__(self) -> None:
        action = self.watch.declared.action
        roots = {action.name.lower()} if isinstance(action, ir.CallRoutine) else set[str]()
        self.handlers = called_below(self.program, roots)
        resuming = closure(self.program, (ir.ResumeLevel,))
        self.leaves = bool(roots & resuming)
        self.declaring = frozenset(
            routine.name.lower()
            for module in self.program.modules
            for routine in module.routines
            for node in walk(*bodies(routine))
            if isinstance(node, ir.DeclareInterrupt) and _resumes(node, resuming)
        )

    def name(self, stem: str) -> str:
        if stem not in self.names:
            self.names[stem] = self.context.fresh(stem)
        return self.names[stem]

    def arms(self, statement: ir.ControlInterrupt) -> bool | None:
        """Does it arm the interrupt (TRUE), or leave it off (FALSE)?"""
        if statement.op not in ("on", "off", "delete"):
            return None
        other = isinstance(statement.handle, ir.IntLiteral) and statement.handle.value != self.watch.key
        return None if other else statement.op == "on"

    # ---- routines

    def routine(self, editor: Editor, original: ir.Routine, routine: ir.Routine) -> ir.Routine:
        self.here = original
        if original.name.lower() in self.handlers:
            return edit_bodies(routine, lambda body: map_body(body, self.handler))
        return edit_bodies(routine, lambda body: map_body(body, lambda one: self.statement(editor, one)))

    def statement(self, editor: Editor, statement: ir.Statement) -> ir.Body:
        """Of the program: while the interrupt may come, what takes time looks for it."""
        if id(statement) not in self.marked:
            return (inside(statement, lambda body: map_body(body, lambda one: self.statement(editor, one))),)
        match statement:
            case ir.Move(search=None):
                return self.drive(editor, statement)
            case ir.Move():
                return (statement,)
            case ir.WaitForMotion():
                return self.leaving(statement, (statement, self.look(statement)))
            case ir.Wait(time=time):
                given = ir.Argument(plain(time))
                return self.leaving(statement, (ir.CallRoutine(self.name("rpl_wait"), (given,)),))
            case ir.WaitUntil():
                return self.leaving(statement, self.until(editor, statement))
            case ir.CallRoutine():
                return self.leaving(statement, (statement,))
        return (inside(statement, lambda body: map_body(body, lambda one: self.statement(editor, one))),)

    def drive(self, editor: Editor, move: ir.Move) -> ir.Body:
        """The move, which ends where the condition comes, and the action behind it: the signal may be gone when the
        robot stands. Where the condition holds from the start the interrupt has come before and the move is one as any
        other."""
        if not isinstance(move.blend, ir.BlendStop | None):
            self.context.diagnostics.report(CORNER, move.origin)
        hit = editor.temporary("hit", ir.BoolType())
        bare = replace(move, origin=tidy(move.origin))
        search = ir.Search(self.watch.declared.condition, stop="stop", hit=hit)
        ended = replace(bare, search=search, blend=ir.BlendStop())
        tried: ir.Body = (ended, ir.If(((hit, self.acts()),)))
        told = self.leaving(move, (self.look(move),))
        return (*told, *self.leaving(bare, (ir.If(((self.comes(), tried),), (bare,)),), True))

    def look(self, statement: ir.Statement) -> ir.Statement:
        return ir.CallRoutine(self.name("rpl_interrupts"), origin=tidy(statement.origin))

    def comes(self) -> ir.Expression:
        """May it come, if its condition does?"""
        comes: ir.Expression = ir.Binary("cand", ir.Name(self.watch.armed), negation(ir.Name(self.watch.was)))
        held = self.watch.may_come()
        return comes if held is None else ir.Binary("cand", comes, held)

    def handler(self, statement: ir.Statement) -> ir.Body:
        """In the routine of the interrupt: the robot stands when it acts."""
        match statement:
            case ir.StopMotion() | ir.ClearMotion() | ir.StartMotion():
                return (ir.Nothing(origin=statement.origin),) if statement.origin.comments else ()
            case ir.ResumeLevel():
                left = ir.Assign(ir.Name(self.name("rpl_left")), _TRUE, origin=statement.origin)
                return (left, ir.Return(origin=tidy(statement.origin)))
        return (inside(statement, lambda body: map_body(body, self.handler)),)

    # ---- waits

    def waiting(self, condition: ir.Expression) -> ir.While:
        """Waits for a condition and looks meanwhile."""
        if self.leaves:
            condition = ir.Binary("cor", condition, ir.Name(self.name("rpl_left")))
        look = ir.CallRoutine(self.name("rpl_interrupts"))
        return ir.While(negation(condition), (look, _pause(self.context)))

    def until(self, editor: Editor, wait: ir.WaitUntil) -> ir.Body:
        if wait.timeout is None:
            return (self.waiting(wait.condition),)
        waited = editor.temporary("waited", ir.RealType())
        late = ir.Binary(">=", waited, plain(wait.timeout))
        loop = self.waiting(ir.Binary("cor", wait.condition, late))
        step = ir.Assign(waited, ir.Binary("+", waited, ir.RealLiteral(self.context.capabilities.io.poll_s)))
        told: ir.Body = ()
        if wait.timed_out is not None:
            told = (ir.Assign(wait.timed_out, ir.Unary("not", wait.condition)),)
        return (ir.Assign(waited, ir.RealLiteral(0.0)), replace(loop, body=(*loop.body, step)), *told)

    def leaving(self, statement: ir.Statement, done: ir.Body, marked: bool = False) -> ir.Body:
        """What takes time, and the way out behind it where the interrupt may have left the level."""
        if not self.leaves or self.here is None or not (marked or id(statement) in self.marked):
            return expansion(statement.origin, done)
        left = ir.Name(self.name("rpl_left"))
        lower = ir.Assign(left, _FALSE)
        if self.here.name.lower() in self.declaring:
            return expansion(statement.origin, (*done, lower))
        value = default_value(self.here.returns) if self.here.returns is not None else None
        return expansion(statement.origin, (*done, ir.If(((left, (ir.Return(value),)),))))

    # ---- what the program brings along

    def finish(self) -> None:
        """Adds the routines that look and act."""
        look = ir.CallRoutine(self.name("rpl_interrupts"))
        self.made.append(ir.Routine(self.name("rpl_interrupts"), body=(self.looking(),), scope="global"))
        if "rpl_wait" in self.names:
            self.made.append(self.wait_routine(look))

    def wait_routine(self, look: ir.Statement) -> ir.Routine:
        waited, time = ir.Name("waited"), ir.Name("seconds")
        more = ir.Assign(waited, ir.Binary("+", waited, ir.RealLiteral(self.context.capabilities.io.poll_s)))
        going: ir.Expression = ir.Binary("<", waited, time)
        if self.leaves:
            going = ir.Binary("cand", going, ir.Unary("not", ir.Name(self.name("rpl_left"))))
        loop = ir.While(going, (look, _pause(self.context), more))
        return ir.Routine(
            self.name("rpl_wait"),
            parameters=(ir.Parameter("seconds", ir.RealType()),),
            declarations=(ir.Variable("waited", ir.RealType(), scope="routine"),),
            body=(ir.Assign(waited, ir.RealLiteral(0.0)), loop),
            scope="global",
        )

    def looking(self) -> ir.Statement:
        """The interrupt, unless it is acting."""
        condition = self.watch.declared.condition
        gone = (negation(condition), (ir.Assign(ir.Name(self.watch.was), _FALSE),))
        return ir.If(((ir.Binary("cand", condition, self.comes()), self.acts()), gone))

    def acts(self) -> ir.Body:
        """The interrupt has come."""
        action = self.watch.declared.action
        done = (ir.Assign(ir.Name(self.watch.was), _TRUE), replace(action, origin=tidy(action.origin)))
        return (ir.Assign(ir.Name(self.watch.armed), _FALSE), *done) if self.watch.declared.once else done

    def data(self) -> tuple[ir.Variable, ...]:
        if "rpl_left" not in self.names:
            return ()
        return (ir.Variable(self.names["rpl_left"], ir.BoolType(), _FALSE, scope="global"),)


def _resumes(one: ir.DeclareInterrupt, resuming: frozenset[str]) -> bool:
    return isinstance(one.action, ir.CallRoutine) and one.action.name.lower() in resuming


def _pause(context: Context) -> ir.Statement:
    return ir.Wait(ir.Quantity(ir.RealLiteral(context.capabilities.io.poll_s), "s"))
