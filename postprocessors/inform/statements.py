"""IR statements as INFORM lines. What INFORM cannot say becomes a guarded stop: the original as remarks, then PAUSE."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.source import NOWHERE, Origin
from rpl.writing.anywhere import Anywhere
from rpl.writing.ledger import EmissionLedger
from rpl.writing.refusals import UNKNOWN_ROUTINE
from rpl.writing.statements import CannotSayError, StatementPrinter
from rpl.writing.target import LeftAlone

from . import tables
from .assignments import Assignments
from .conditions import alternatives, single, text
from .labels import Labels
from .motion import Motion
from .operands import constant, element, is_digital, operand, signal, variable
from .passes.cutmoves import LOST
from .texts import ascii_text, remarks

GUARDED = code(
    "inform-guarded-stop",
    Severity.LOSS,
    "INFORM cannot say this: {reason}",
    "the program stops there with PAUSE; write the line by hand",
)
INTERRUPT = code(
    "inform-interrupt-lost",
    Severity.LOSS,
    "INFORM has no word for interrupts and what they do with the motion: {reason}",
    "the program stops there with PAUSE; watch the signal in a job of its own, or end the move by UNTIL",
)
TASK = code(
    "inform-task-lost",
    Severity.LOSS,
    "jobs beside each other are started and waited for only: {reason}",
    "the program stops there with PAUSE; let the other job end itself by a variable",
)
SPLIT_MESSAGE = code(
    "inform-split-message", Severity.WARNING, "a message of more than {most} characters is written in several lines"
)
SEARCHED = code(
    "inform-search",
    Severity.WARNING,
    "whether and where the search found its signal is asked behind the move, from the signal and the robot's place",
)
_HALTS = {"stop": "PAUSE", "exit": "ABORT"}
_POLL_S = 0.01
_SLOW_MM_S = 100.0  # of a move by nothing


class Printer(StatementPrinter[str]):
    """Prints the body of one job. `jobs`: routine, folded -> job; `tasks`: job -> sub task, of the whole program;
    `moving`: routines, folded, that move the robot; `left_alone`: why moves have actions that cannot be said."""

    guarded, dialect = GUARDED, "inform"

    def __init__(
        self,
        assignments: Assignments,
        motion: Motion,
        labels: Labels,
        jobs: Mapping[str, str],
        tasks: dict[str, str],
        moving: frozenset[str],
        left_alone: LeftAlone,
        ledger: EmissionLedger,
        diagnostics: Diagnostics,
    ) -> None:
        super().__init__(ledger, diagnostics)
        self.assignments, self.motion, self.labels = assignments, motion, labels
        self.jobs, self.tasks, self.moving = jobs, tasks, moving
        self.left_alone = left_alone
        self.may_move = Anywhere(self.moves)

    # ---- lines and remarks

    def put(self, lines: list[str], origin: Origin | None = None) -> None:
        if origin is not None:
            self.comments_only(origin)
        for line in lines:
            if len(line) > tables.LONGEST_LINE:
                raise CannotSayError(f"a line of {len(line)} characters; a controller takes {tables.LONGEST_LINE}")
            self.lines.append(line)

    def line(self, line: str, origin: Origin | None = None) -> None:
        self.put([line], origin)

    def remark(self, about: str) -> None:
        self.lines.extend(remarks(about))

    # ---- bodies

    def body(self, body: ir.Body, last: bool = False) -> None:
        for at, statement in enumerate(body):
            if isinstance(statement, ir.WaitForMotion) and self.motion.stands:
                self.comments_only(statement.origin)
                self.ledger.merged(statement)
                continue
            if last and at == len(body) - 1 and isinstance(statement, ir.Return) and statement.value is None:
                self.comments_only(statement.origin)
                self.ledger.merged(statement)
                continue
            self.statement(statement)

    def statement(self, statement: ir.Statement) -> None:
        """One statement, or its guarded stop."""
        self.assignments.registers.begin()
        super().statement(statement)

    def stop(self) -> None:
        self.lines.append("PAUSE")

    def guarded_behind(self, statement: ir.Statement) -> None:
        self.motion.forget()

    # ---- statements

    def written(self, statement: ir.Statement) -> None:
        origin = statement.origin
        match statement:
            case ir.Nothing() | ir.LookAhead():
                self.comments_only(origin)
            case ir.If():
                self.choice(statement)
            case ir.While():
                self.repeating(statement)
            case ir.For():
                self.counting(statement)
            case ir.Label(name=name):
                self.motion.forget()
                self.line(f"*{self.labels.name(name)}", origin)
            case ir.Goto(label=name):
                self.line(f"JUMP *{self.labels.name(name)}", origin)
            case ir.Assign():
                lines = self.assignments.assign(statement)
                if any(line.startswith("IFTHENEXP") for line in lines):
                    self.motion.line_of_last = None  # the points of an arc stand in a row
                self.put(lines, origin)
            case ir.Move():
                self.move(statement)
            case ir.WaitForMotion() if self.motion.corners and not self.motion.running:
                self.move(_no_way(origin))
            case ir.WaitUntil():
                self.waiting(statement)
            case ir.Message():
                self.message(statement)
            case ir.Dialog(kind="number", text=ir.TextLiteral(value=""), timeout=None, timed_out=None, answer=answer):
                self.line(f"INPUT {variable(answer)}", origin)
            case ir.Opaque() | ir.Vendor():
                self.put([part.strip() for part in self.own_text(statement).splitlines()], origin)
            case _:
                self.line(self.simple(statement), origin)
                if isinstance(statement, ir.CallRoutine):
                    self.called(statement)
                elif isinstance(statement, ir.Halt):
                    self.motion.forget()

    def simple(self, statement: ir.Statement) -> str:
        match statement:
            case ir.CallRoutine():
                return self.call(statement)
            case ir.Return(value=None):
                return "RET"
            case ir.Halt(kind=kind) if kind in _HALTS:
                return _HALTS[kind]
            case ir.WaitForMotion() if self.motion.running:
                self.motion.arrive()
                return "CWAIT"
            case ir.WaitForMotion():
                # not a move: it waits for the moves before it
                return f"TIMER T={_POLL_S:.2f}"
            case ir.Wait(time=time):
                return f"TIMER {self.time(time, statement.origin)}"
            case ir.Pulse(signal=ir.Signal() as given, value=ir.BoolLiteral(value=True), duration=duration):
                return f"PULSE {signal(given)} {self.time(duration, statement.origin)}"
            case ir.TaskControl(op="start", task=name, arguments=()):
                return f"PSTART JOB:{self.job(name)} {self.sub(name)}"
            case ir.TaskControl(op="join", task=name):
                return f"PWAIT {self.sub(name)}"
            case ir.DeclareInterrupt() | ir.ConnectInterrupt() | ir.ControlInterrupt() | ir.OrderInterrupt():
                raise CannotSayError("nothing interrupts a job", INTERRUPT)
            case ir.StopMotion() | ir.StartMotion() | ir.ResumeLevel():
                raise CannotSayError("a job does not stop the robot in its move", INTERRUPT)
            case ir.ClearMotion() | ir.StoreMotion():
                raise CannotSayError("a move that has begun is not given up", INTERRUPT)
            case ir.TaskControl(op=op):
                raise CannotSayError(f"a job cannot {op} another one", TASK)
        raise CannotSayError(f"there is no {statement.__class__.__name__} of this kind")

    def time(self, value: ir.Expression, origin: Origin) -> str:
        """`T=0.50`; lines that compute it stand before."""
        self.assignments.positions.lines = []
        shown = self.motion.tag("T", value, origin)
        self.put(self.motion.lines)
        return shown

    def job(self, routine: str) -> str:
        return self.jobs.get(routine.lower(), routine.upper())

    def call(self, call: ir.CallRoutine) -> str:
        if call.arguments:
            raise CannotSayError(call.name, UNKNOWN_ROUTINE)
        if call.dynamic is not None:
            return f"CALL JOB:{variable(call.dynamic)}"
        return f"CALL JOB:{self.job(call.name)}"

    def called(self, call: ir.CallRoutine) -> None:
        """A job that does not move the robot leaves it where it is; variables may have changed."""
        if call.dynamic is not None or call.name.lower() in self.moving:
            self.motion.forget()
        else:
            self.motion.positions.changes += 1
            self.motion.positions.in_tools.clear()
            self.motion.line_of_last = None

    def sub(self, task: str) -> str:
        """The sub task of a job."""
        if task.lower() not in self.tasks:
            raise CannotSayError("there is no sub task for it", TASK)
        return self.tasks[task.lower()]

    # ---- blocks

    def inner(self, body: ir.Body) -> None:
        """A body that may be left out or repeated. One that does not move the robot leaves it where it is."""
        if not self.rests(body):
            self.motion.forget()
            self.body(body)
            self.motion.forget()
            return
        self.motion.line_of_last = None
        self.body(body)

    def rests(self, body: ir.Body) -> bool:
        """Does the robot certainly stay where it is?"""
        return not self.may_move(body)

    def moves(self, node: object) -> bool:
        match node:
            case ir.Move() | ir.MoveExternal() | ir.Spline() | ir.Label() | ir.Vendor() | ir.Opaque() | ir.Halt():
                return True
            case ir.CallRoutine(name=name, dynamic=dynamic):
                return dynamic is not None or name.lower() in self.moving
        return False

    def choice(self, statement: ir.If) -> None:
        branches = list(statement.branches)
        if len(branches) == 1:
            (condition, body), *_ = branches
            lines, condition = self.assignments.prepared(condition)
            self.comments_only(statement.origin)
            self.put(lines)
            statement = replace(statement, branches=((condition, body),), origin=NOWHERE)
            branches = [(condition, body)]
        shown = [alternatives(condition) for condition, _ in branches]
        if len(branches) == 1 and not statement.otherwise and self.short(statement):
            return
        for at, ((_, body), found) in enumerate(zip(branches, shown, strict=True)):
            word = "IFTHENEXP" if at == 0 else "ELSEIFEXP"
            self.line(f"{word} {text(found)}", statement.origin if at == 0 else None)
            self.inner(body)
        if statement.otherwise:
            self.line("ELSE")
            self.inner(statement.otherwise)
        self.line("ENDIF")

    def short(self, statement: ir.If) -> bool:
        """`JUMP *L IF IN#(1)=ON`, `CALL JOB:X IF B000=1`."""
        (condition, body), *_ = statement.branches
        shown = single(condition)
        if shown is None or len(body) != 1 or body[0].origin.comments:
            return False
        match body[0]:
            case ir.Goto(label=label):
                deed = f"JUMP *{self.labels.name(label)}"
            case ir.Return(value=None):
                deed = "RET"
            case ir.CallRoutine() as call:
                deed = self.call(call)
            case _:
                return False
        self.line(f"{deed} IF {shown}", statement.origin)
        self.ledger.written(body[0])
        if isinstance(body[0], ir.CallRoutine):
            self.called(body[0])
        return True

    def repeating(self, loop: ir.While) -> None:
        if loop.condition == ir.BoolLiteral(True):
            again = self.labels.fresh("LOOP")
            self.line(f"*{again}", loop.origin)
            self.inner(loop.body)
            self.line(f"JUMP *{again}")
            return
        self.line(f"WHILEEXP {text(alternatives(loop.condition))}", loop.origin)
        self.inner(loop.body)
        self.line("ENDWHILE")

    def counting(self, loop: ir.For) -> None:
        if loop.scoped or loop.automatic or loop.at_least_once or loop.keeps_last:
            raise CannotSayError("a loop whose counter or first pass follows another language's rule")
        counter = element(ir.Name(loop.counter))
        if counter is None:
            raise CannotSayError("a FOR counts in a numbered variable")
        step = "" if loop.step is None or constant(loop.step) == 1 else f" STEP {operand(loop.step)}"
        self.line(f"FOR {counter}={operand(loop.start)} TO {operand(loop.stop)}{step}", loop.origin)
        self.inner(loop.body)
        self.line(f"NEXT {counter}")

    # ---- motion

    def move(self, move: ir.Move) -> None:
        if move.triggers:
            raise CannotSayError(self.left_alone.why(move), LOST)
        self.put(self.motion.move(move, self.lines), move.origin)
        self.outcome(move)

    def outcome(self, move: ir.Move) -> None:
        """Whether and where a search found its signal."""
        search = move.search
        if search is None or (search.hit is None and search.found is None):
            return
        self.diagnostics.report(SEARCHED, move.origin)
        if search.hit is not None:
            flag = variable(search.hit)
            ((left, _, right),) = alternatives(search.condition)[0]
            self.line(f"DIN {flag} {left}")
            if right == "OFF":
                self.line(f"XOR {flag} 1")
        if search.found is not None:
            self.put(self.assignments.assign(ir.Assign(search.found, self.place_of(move))))

    def place_of(self, move: ir.Move) -> ir.Expression:
        """Where the robot is, seen as the move sees its target."""
        if move.frame is None or self.assignments.positions.constants.is_joints(move.target):
            return ir.System("actual_pose")
        return ir.Builtin("current_target", (move.tool or ir.System("tool"), move.frame))

    # ---- waits, messages

    def waiting(self, wait: ir.WaitUntil) -> None:
        if wait.error is not None:
            raise CannotSayError("a wait that raises an error")
        shown = single(wait.condition) if _plain(wait.condition) else None
        self.comments_only(wait.origin)
        if shown is None:
            self.polling(wait)
            return
        limit = "" if wait.timeout is None else f" {self.time(wait.timeout, wait.origin)}"
        self.line(f"WAIT {shown}{limit}")
        if wait.timed_out is not None:
            flag = variable(wait.timed_out)
            self.put([f"GETS {flag} $B014", f"XOR {flag} 1"])

    def polling(self, wait: ir.WaitUntil) -> None:
        """A condition that WAIT does not take is looked at again and again."""
        opposite = alternatives(wait.condition, wanted=False)
        pause = f"TIMER T={_POLL_S:.2f}"
        if wait.timeout is None:
            self.put([f"WHILEEXP {text(opposite)}", pause, "ENDWHILE"])
            return
        limit = constant(wait.timeout)
        left = self.assignments.registers.helper("D")
        limited = [[*group, (left, ">", "0")] for group in opposite]
        if sum(map(len, limited)) > tables.MOST_TERMS:
            raise CannotSayError(f"a condition has at most {tables.MOST_TERMS} comparisons")
        if limit is not None:
            self.line(f"SET {left} {max(0, round(limit / _POLL_S))}")
        else:
            self.assignments.positions.lines = []
            real = self.assignments.registers.helper("R")
            self.assignments.number(real, wait.timeout)
            counts = [f"MUL {real} {1 / _POLL_S:.1f}", f"ADD {real} 0.5", f"SET {left} {real}"]
            self.put([*self.assignments.lines, *counts])
        self.put([f"WHILEEXP {text(limited)}", pause, f"DEC {left}", "ENDWHILE"])
        if wait.timed_out is not None:
            flag = variable(wait.timed_out)
            self.put([f"IFTHENEXP {text(alternatives(wait.condition))}", f"SET {flag} 0"])
            self.put(["ELSE", f"SET {flag} 1", "ENDIF"])

    def message(self, message: ir.Message) -> None:
        if message.kind == "clear":
            self.line("CLS", message.origin)
            return
        if not isinstance(message.text, ir.TextLiteral):
            self.line(f"MSG {variable(message.text)}", message.origin)
            return
        given = ascii_text(message.text.value).replace('"', "'")
        most = tables.LONGEST_MESSAGE
        if len(given) > most:
            self.diagnostics.report(SPLIT_MESSAGE, message.origin, most=most)
        parts = [given[at : at + most] for at in range(0, len(given), most)] or [""]
        self.put([f'MSG "{part}"' for part in parts], message.origin)


def _no_way(origin: Origin) -> ir.Move:
    """A move by nothing that ends exactly: behind a corner that the robot still goes round it ends at the point."""
    nothing = ir.Aggregate(tuple((name, ir.RealLiteral(0.0)) for name in "xyzabc"))
    speed = ir.Speed(path=ir.RealLiteral(_SLOW_MM_S))
    return ir.Move("linear", nothing, speed=speed, relative="base", blend=ir.BlendStop(), origin=origin)


def _plain(condition: ir.Expression) -> bool:
    """One comparison that WAIT takes: a signal or a byte."""
    match condition:
        case ir.Signal() | ir.Unary(op="not", operand=ir.Signal()):
            return True
        case ir.Binary(op="=" | "<>" as op, left=left, right=right):
            place = None if isinstance(left, ir.Signal) else element(left)
            return (
                (is_digital(left) or op == "=")
                and (isinstance(left, ir.Signal) or (place is not None and place.startswith("B")))
                and not isinstance(right, ir.Signal)
            )
    return False
