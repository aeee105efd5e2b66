"""IR statements as TP lines. What TP cannot say becomes a guarded stop: the original as remarks, then PAUSE."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import dropwhile

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.ir.walk import walk
from rpl.source import Origin
from rpl.writing.anywhere import Anywhere
from rpl.writing.ledger import EmissionLedger
from rpl.writing.statements import CannotSayError, StatementPrinter

from . import tables
from .assignments import Assignments, set_output
from .expressions import ACTIVE, Expressions, constant, measured
from .flow import If, Labels, choice
from .frames import Frames
from .instructions import Instructions
from .lines import Line, pulse_length
from .motion import Motion
from .moverows import write_rows
from .own import (
    from_listing,
    is_own_limit,
    leaves_frames,
    modal_condition,
    number_in_force,
    parts_apart,
    selects_frame,
)
from .positions import Points
from .texts import ascii_text, number, remarks

GUARDED = code(
    "tp-guarded-stop",
    Severity.LOSS,
    "TP cannot say this: {reason}",
    "the program stops there with PAUSE; write the line by hand",
)
DIALOG = code(
    "tp-dialog-lost",
    Severity.LOSS,
    "{reason}",
    "the program stops there with PAUSE; let the operator set an input or a register, and read that instead",
)
WAIT_ROUNDED = code("tp-wait-rounded", Severity.WARNING, "a time of {time:g} s is written in hundredths of a second")
SPLIT_MESSAGE = code(
    "tp-split-message", Severity.WARNING, "a message of more than {most} characters is written in several lines"
)

_CLOCKS = {"start": "START", "stop": "STOP", "reset": "RESET"}
_JUMPS = (ir.Label, ir.Goto)
_HALTS = {"stop": "PAUSE", "exit": "ABORT"}


class Printer(StatementPrinter[Line]):
    """Prints the body of one program."""

    guarded, dialect = GUARDED, "tp"

    def __init__(
        self,
        expressions: Expressions,
        points: Points,
        frames: Frames,
        labels: Labels,
        ledger: EmissionLedger,
        diagnostics: Diagnostics,
    ) -> None:
        super().__init__(ledger, diagnostics)
        self.expressions, self.points, self.frames, self.labels = expressions, points, frames, labels
        self.monitors: Mapping[int, tuple[str, int]] = {}
        self.quiet: frozenset[str] = frozenset()  # programs that neither move nor select a frame, folded
        self.steady: frozenset[str] = frozenset()  # programs that may move, but select none
        self.may_select = Anywhere(self.selects)
        self.at_jumps = True  # is a tool or frame selected among the labels of this program?
        self.motion = Motion(
            *(expressions, points, diagnostics, self.action, frames.keeper),
            scratch=frames.scratch,
            second=frames.second,
        )
        self.assignments = Assignments(expressions, points, frames.scratch, frames.moved_to)
        self.instructions = Instructions(self)

    # ---- lines and comments

    def line(self, text: str, origin: Origin | None = None) -> None:
        """One line, behind the remarks that belong to its statement."""
        self.put([Line(f"  {text}")], origin)

    def put(self, lines: list[Line], origin: Origin | None = None) -> None:
        if origin is not None:
            self.comments_only(origin)
        for line in lines:
            if line.length > tables.LONGEST_LINE:
                raise CannotSayError(f"a line of {line.length} characters; a controller takes {tables.LONGEST_LINE}")
            self.lines.append(line)

    def remark(self, text: str) -> None:
        self.lines.extend(Line(one) for one in remarks(text))

    def stop(self) -> None:
        self.lines.append(Line("  PAUSE"))

    # ---- bodies

    def body(self, body: ir.Body) -> None:
        for statement in body:
            if isinstance(statement, ir.Instruction):
                self.instructions.write(statement)
            else:
                self.statement(statement)

    def inner(self, body: ir.Body) -> None:
        """A body inside of a block."""
        if self.depth >= tables.DEEPEST_BLOCK:
            raise CannotSayError(f"blocks are at most {tables.DEEPEST_BLOCK} deep")
        self.depth += 1
        self.body(body)
        self.depth -= 1

    def in_force(self, word: str, number: str) -> None:
        self.frames.selected[word].add(number)
        self.motion.last, self.motion.place = None, ""
        if word == "UTOOL":
            self.motion.tool = number if number.isdigit() else ""
        else:
            self.motion.frame = number if number.isdigit() else ""

    def begin(self, body: ir.Body) -> None:
        """The body of the program itself."""
        jumping = dropwhile(lambda one: not any(isinstance(node, _JUMPS) for node in walk(one)), parts_apart(body))
        self.at_jumps = self.may_select(tuple(jumping))
        self.body(body)

    def selects(self, node: object) -> bool:
        """Is another tool or frame in force behind it?"""
        match node:
            case ir.CallRoutine(name=name, dynamic=dynamic):
                return dynamic is not None or name.lower() not in self.steady
            case ir.Vendor() | ir.Opaque():
                return True
        return selects_frame(node)

    def crossing(self, selects: bool) -> None:
        """A place with several ways to it; `selects`: a tool or frame may have been selected on one of them."""
        if selects:
            self.forget()
        else:
            self.motion.moved()
            self.motion.handed = frozenset()

    def guarded_behind(self, statement: ir.Statement) -> None:
        if not leaves_frames(statement):
            self.forget()

    def forget(self) -> None:
        """What tool and frame are in force is not known here."""
        self.motion.forget()

    # ---- statements

    def written(self, statement: ir.Statement) -> None:
        origin = statement.origin
        match statement:
            case ir.Nothing():
                condition = modal_condition(origin)
                self.put([Line(f"  {condition}")] if condition else [], origin)
            case ir.LookAhead():
                self.comments_only(origin)  # signals never stop the look-ahead behind CNT
            case ir.WaitForMotion():
                self.put([] if self.motion.stands else [self.motion.standstill()], origin)
            case ir.If():
                self.choice(statement)
            case ir.Switch():
                self.switch(statement)
            case ir.For():
                self.counting(statement)
            case ir.Label(name=name):
                self.crossing(self.at_jumps)
                self.line(f"LBL[{self.labels.text(name)}]", self.labels.origin(statement))
            case ir.Goto(label=name):
                self.line(f"JMP LBL[{self.labels.number(name)}]", origin)
            case ir.Assign(target=ir.System(name="load")):
                self.comments_only(origin)  # its PAYLOAD[n] stands in front of it
            case ir.Assign(target=ir.System(name="tool" | "base" as name), value=value):
                self.select(name, value, origin)
            case ir.Assign(target=target, value=ir.System(name="tool")):
                self.put(self.tool_in_force(target), origin)
            case ir.Assign(value=ir.Builtin(function="current_target", arguments=(tool, frame)), target=target):
                self.put(self.seen_with(tool, frame, target), origin)
                self.motion.place = ""
            case ir.Assign():
                lines = self.assignments.lines(statement)
                self.put(lines, origin)
                self.motion.stored(lines)
            case ir.Move():
                self.move(statement)
            case ir.Rows():
                write_rows(self, statement)
            case ir.WaitUntil(timeout=limit) if limit is not None:
                self.limited_alone(statement)
            case ir.Message():
                self.message(statement)
            case ir.Wait(time=time) if (measured(time, "s") or 0) * 100 > tables.MOST_HUNDREDTHS:
                self.put([Line(one) for one in self.long_wait(time, origin)], origin)
            case ir.Opaque() | ir.Vendor():
                self.put([Line(f"  {part.strip()}") for part in self.own_text(statement).splitlines()], origin)
            case _:
                self.line(self.simple(statement), origin)
                if isinstance(statement, ir.CallRoutine):
                    self.called(statement)

    def called(self, call: ir.CallRoutine) -> None:
        """What is known of the motion behind a call."""
        if call.dynamic is not None or call.name.lower() not in self.steady:
            self.forget()
        elif call.name.lower() not in self.quiet:
            self.motion.moved()
        elif self.motion.place.startswith("PR["):
            self.motion.place = ""
        self.motion.handed = frozenset()

    def simple(self, statement: ir.Statement) -> str:
        match statement:
            case ir.CallRoutine():
                return self.call(statement)
            case ir.Return(value=None):
                return "END"
            case ir.Halt(kind=kind) if kind in _HALTS:
                return _HALTS[kind]
            case ir.Wait(time=time):
                return f"WAIT {self.seconds(time, statement.origin)}"
            case ir.WaitUntil(condition=condition, error=None):
                return f"WAIT {self.expressions.condition(condition)}    "
            case ir.Pulse(signal=ir.Signal(kind=kind) as signal, value=ir.BoolLiteral(value=True)):
                if kind != "digital_out":
                    raise CannotSayError("only a digital output has pulses")
                width = measured(statement.duration, "s")
                if width is None:
                    raise CannotSayError("the length of a pulse is a constant")
                length = pulse_length(float(width), statement.origin, self.diagnostics)
                return f"{self.expressions.signal(signal)}=PULSE,{length}sec"
            case ir.Clock(op=op, clock=clock) if op in _CLOCKS:
                return f"{self.expressions.place(clock)}={_CLOCKS[op]}"
            case ir.TaskControl(op="start", arguments=(_, *_)):
                raise CannotSayError("a program that runs beside takes no arguments")
            case ir.TaskControl(op="start", task=name):
                return f"RUN {name.upper()}"
            case ir.Dialog():
                raise CannotSayError("TP programs show messages, but ask the operator nothing", DIALOG)
        raise CannotSayError(f"there is no {statement.__class__.__name__} of this kind")

    def seconds(self, time: ir.Expression, origin: Origin) -> str:
        found = measured(time, "s")
        if found is None:
            inner = time.value if isinstance(time, ir.Quantity) and ir.UNITS[time.unit] == 1 else time
            return self.expressions.index(inner)
        shown = max(round(float(found), 2), 0.01 if found > 0 else 0.0)
        if abs(shown - found) > 1e-9:
            self.diagnostics.report(WAIT_ROUNDED, origin, time=found)
        return f"{shown:6.2f}(sec)"

    def long_wait(self, time: ir.Expression, origin: Origin) -> list[str]:
        """A time that is longer than one wait, in several."""
        longest = tables.MOST_HUNDREDTHS / 100
        left = float(measured(time, "s") or 0.0)
        whole = int(left // longest)
        parts = [f"  WAIT {longest:6.2f}(sec)"] * whole
        left = round(left - whole * longest, 6)
        return [*parts, f"  WAIT {self.seconds(ir.Quantity(ir.RealLiteral(left), 's'), origin)}"] if left else parts

    def call(self, call: ir.CallRoutine) -> str:
        name = call.name.upper() if call.dynamic is None else self.expressions.place(call.dynamic)
        if any(name == known for known, _ in self.monitors.values()):
            return f"MONITOR {name}"
        return f"CALL {name}{self.arguments(call.arguments)}    "

    def arguments(self, arguments: tuple[ir.Argument, ...]) -> str:
        if not arguments:
            return ""
        if len(arguments) > tables.MOST_ARGUMENTS:
            raise CannotSayError(f"a call has at most {tables.MOST_ARGUMENTS} arguments")
        shown = []
        for argument in arguments:
            if argument.value is None or argument.name or argument.if_present:
                raise CannotSayError("arguments go by their place, and none is left out")
            shown.append(self.expressions.operand(argument.value))
        return f"({','.join(shown)})"

    def action(self, action: ir.Assign | ir.CallRoutine) -> str:
        """What a trigger does."""
        if isinstance(action, ir.CallRoutine):
            return self.call(action).rstrip()
        if isinstance(action.target, ir.Signal):
            return set_output(action.target, action.value, self.expressions)
        raise CannotSayError("an action on the path is a call or an output")

    # ---- blocks

    def choice(self, statement: ir.If) -> None:
        (condition, body), *more = statement.branches
        if more:
            raise CannotSayError("an IF has one condition")
        short = choice(If(condition, body, statement.otherwise), self.expressions, self.labels, self.call)
        if short is not None:
            self.comments_only(statement.origin)
            for inner in body:
                self.comments_only(inner.origin)
                self.ledger.merged(inner)
            self.line(short)
            return
        if self.depth >= tables.DEEPEST_BLOCK:
            self.flat_choice(statement, condition, body)
            return
        self.line(f"IF ({self.expressions.mixed(condition)}) THEN", statement.origin)
        before = self.motion.state
        self.inner(body)
        after = self.motion.state
        self.motion.state = before
        if statement.otherwise:
            self.line("ELSE")
            self.inner(statement.otherwise)
        self.motion.join(after)
        self.line("ENDIF")

    def flat_choice(self, statement: ir.If, condition: ir.Expression, body: ir.Body) -> None:
        """An IF where blocks are as deep as they can be: jumps over its bodies."""
        opposite = ir.Unary("not", condition)
        otherwise = self.labels.fresh("else")
        self.line(f"IF ({self.expressions.mixed(opposite)}),JMP LBL[{otherwise}]", statement.origin)
        before = self.motion.state
        self.body(body)
        after, self.motion.state = self.motion.state, before
        behind = self.labels.fresh("endif") if statement.otherwise else 0
        if behind:
            self.line(f"JMP LBL[{behind}]")
        self.line(f"LBL[{self.labels.shown(otherwise)}]")
        self.body(statement.otherwise)
        self.motion.join(after)
        if behind:
            self.line(f"LBL[{self.labels.shown(behind)}]")

    def counting(self, loop: ir.For) -> None:
        if loop.scoped or loop.automatic or loop.at_least_once:
            raise CannotSayError("a loop whose counter or first pass follows another language's rule")
        step = 1 if loop.step is None else constant(loop.step)
        if step not in (1, -1):
            raise CannotSayError("a FOR counts up or down by one")
        counter = self.expressions.element(ir.Name(loop.counter))
        if counter is None or not counter.startswith("R["):
            raise CannotSayError("a FOR counts in a register")
        first, last = self.expressions.operand(loop.start), self.expressions.operand(loop.stop)
        self.line(f"FOR {counter}={first} {'TO' if step == 1 else 'DOWNTO'} {last}", loop.origin)
        before = self.motion.state
        self.crossing(self.may_select(loop.body))
        self.inner(loop.body)
        if not _runs(loop, step):
            self.motion.join(before)
        self.line("ENDFOR")

    def switch(self, statement: ir.Switch) -> None:
        """SELECT with a jump or call in each case; longer cases stand behind it under labels of their own."""
        if not statement.cases:
            raise CannotSayError("a SELECT without a case")
        selector = self.expressions.operand(statement.selector)
        if not selector.startswith(("R[", "AR[")):
            raise CannotSayError("a SELECT looks at a register")
        behind = self.labels.fresh("end select")
        places: list[tuple[int, ir.Body]] = []
        rows: list[tuple[str, str]] = []
        for case in statement.cases:
            deed = self.deed(case.body, behind, places)
            rows.extend((f"={self.expressions.operand(value)}", deed) for value in case.values)
        otherwise = statement.default or ()
        if otherwise or places:
            rows.append(("ELSE", self.deed(otherwise, behind, places)))
        for index, (value, deed) in enumerate(rows):
            head = f"SELECT {selector}" if index == 0 else " " * 7
            self.line(f"{head}{value},{deed}", statement.origin if index == 0 else None)
        jumps_behind = f"JMP LBL[{behind}]"
        if places and any(deed.startswith("CALL") for _, deed in rows):
            self.line(jumps_behind)
        begin = self.motion.state
        selects = any(map(self.may_select, (*(case.body for case in statement.cases), otherwise)))
        for number_of, body in places:
            self.motion.state = begin
            self.line(f"LBL[{number_of}]")
            self.body(body)
            if not _leaves(body) and number_of != places[-1][0]:
                self.line(jumps_behind)
        if any(line.first.endswith(jumps_behind) for line in self.lines):
            self.line(f"LBL[{self.labels.shown(behind)}]")
        self.motion.state = begin
        self.crossing(selects)

    def deed(self, body: ir.Body, behind: int, places: list[tuple[int, ir.Body]]) -> str:
        """What a row of a SELECT does."""
        match body:
            case (ir.CallRoutine() as call,) if not call.origin.comments:
                shown = self.call(call).rstrip()
                self.ledger.written(call)
                return shown
            case (ir.Goto(label=label) as jump,) if not jump.origin.comments:
                self.ledger.written(jump)
                return f"JMP LBL[{self.labels.number(label)}]"
            case ():
                return f"JMP LBL[{behind}]"
        number_of = self.labels.fresh("")
        places.append((number_of, body))
        return f"JMP LBL[{number_of}]"

    # ---- motion, frames

    def select(self, name: str, value: ir.Expression, origin: Origin) -> None:
        kind = "UTOOL" if name == "tool" else "UFRAME"
        lines, chosen = self.frames.select(kind, value, self.expressions)
        self.put(lines, origin)
        self.in_force(kind, chosen)
        if len(lines) > 1:
            self.motion.handed |= {lines[0].first.partition("=")[2]}

    def seen_with(self, tool: ir.Expression, frame: ir.Expression, target: ir.Expression) -> list[Line]:
        """Where the robot stands, seen with a tool and in a frame: LPOS is what is in force, so these are selected for
        it, and what was in force again behind it."""
        before: list[Line] = []
        behind: list[Line] = []
        for kind, value, known in (("UFRAME", frame, self.motion.frame), ("UTOOL", tool, self.motion.tool)):
            if isinstance(value, ir.System) and value.name in ("tool", "base"):
                continue  # what is in force is asked for
            lines, chosen = self.frames.select(kind, value, self.expressions)
            register = lines[0].first.partition("=")[2] if len(lines) > 1 else ""
            same = not register or register in self.motion.handed or self.frames.is_kept(register)
            if chosen.isdigit() and chosen == known and same:
                continue
            if register:
                lines, _ = self.frames.apart(kind, register)
            if known:
                behind.append(Line(f"  {kind}_NUM={known}"))
            else:
                keeper = self.frames.keeper(f"{kind} in use")
                before.append(Line(f"  {keeper}={ACTIVE[f'{kind}_NUM']}"))
                behind.append(Line(f"  {kind}_NUM={keeper}"))
            before.extend(lines)
        return [*before, Line(f"  {self.expressions.place(target)}=LPOS"), *behind]

    def tool_in_force(self, target: ir.Expression) -> list[Line]:
        """The value of the tool in force in a position register: that of its number, which is asked where unknown."""
        place, number = self.expressions.place(target), self.motion.tool
        if number:
            return [Line(f"  {place}=UTOOL[{number}]")]
        keeper = self.frames.keeper("UTOOL in use")
        return [Line(f"  {keeper}={ACTIVE['UTOOL_NUM']}"), Line(f"  {place}=UTOOL[{keeper}]")]

    def move(self, move: ir.Move) -> None:
        if move.search is not None:
            self.searching_alone(move)
            return
        self.own_frames(move)
        line = self.motion.move(move)
        self.put([*self.motion.before, line], move.origin)
        self.triggers_done(move)

    def triggers_done(self, move: ir.Move) -> None:
        for trigger in move.triggers:
            if isinstance(trigger, ir.Trigger):
                self.ledger.merged(trigger)

    def own_frames(self, move: ir.Move) -> None:
        """Tool and frame that the move names itself, where they are not in force already; a number is."""
        for name, value in (("base", move.frame), ("tool", move.tool)):
            if value is None:
                continue
            kind = "UTOOL" if name == "tool" else "UFRAME"
            if known := number_in_force(value):
                self.frames.selected[kind].add(known)
                self.motion.tool = known if kind == "UTOOL" else self.motion.tool
                self.motion.frame = known if kind == "UFRAME" else self.motion.frame
                continue
            _, chosen = self.frames.select(kind, value, self.expressions)
            in_force = self.motion.tool if kind == "UTOOL" else self.motion.frame
            if not chosen.isdigit() or chosen != in_force:
                self.select(name, value, Origin())

    def searching(self, move: ir.Move, label: int, flag: str = "", word: str = "Skip", kept: str = "") -> None:
        """`kept`: what a search that found something keeps besides its place."""
        search = move.search
        if search is None:
            raise CannotSayError("a search without a condition")
        if search.stop == "none":
            raise CannotSayError("a search that does not stop the robot")
        found = f",{kept}" if kept else ""
        if search.found is not None:
            place = self.expressions.element(search.found)
            if place is None or not place.startswith("PR["):
                raise CannotSayError("a search keeps the place in a position register")
            found = f",{place}=LPOS"
        self.own_frames(move)
        line = self.motion.move(move, f" {word},LBL[{label}]{found}")
        if from_listing(move.origin):
            self.comments_only(move.origin)  # the condition stands where the listing had it
        else:
            self.line(f"SKIP CONDITION {self.expressions.watched(search.condition)}    ", move.origin)
        if flag:
            self.line(f"{flag}=(OFF)")
        self.put([*self.motion.before, line])
        self.triggers_done(move)

    def searching_alone(self, move: ir.Move) -> None:
        """A search whose outcome is kept in a flag: the line behind the move runs only when the condition came."""
        behind = self.labels.fresh("")
        hit = move.search.hit if move.search is not None else None
        flag = "" if hit is None else self.expressions.place(hit)
        self.searching(move, behind, flag)
        if flag:
            self.line(f"{flag}=(ON)")
        self.line(f"LBL[{behind}]")

    # ---- waits, messages

    def limited_alone(self, wait: ir.WaitUntil) -> None:
        """A wait with a limit: the flag is on unless the line behind the wait is reached without the jump."""
        if wait.error is not None:
            raise CannotSayError("a wait that raises an error")
        behind = self.labels.fresh("")
        flag = "" if wait.timed_out is None else self.expressions.place(wait.timed_out)
        self.limited(wait, behind, f"{flag}=(ON)" if flag else "")
        if flag:
            self.line(f"{flag}=(OFF)")
        self.line(f"LBL[{behind}]")

    def limited(self, wait: ir.WaitUntil, label: int, before: str = "") -> None:
        shown = self.expressions.condition(wait.condition)
        if wait.timeout is None:
            raise CannotSayError("a wait without a limit")
        if is_own_limit(wait.timeout):
            self.comments_only(wait.origin)
        else:
            self.line(f"$WAITTMOUT={self.hundredths(wait.timeout)}", wait.origin)
        if before:
            self.line(before)
        self.line(f"WAIT {shown} TIMEOUT,LBL[{label}]")

    def hundredths(self, time: ir.Expression) -> str:
        """The limit of a wait counts in hundredths of a second."""
        found = measured(time, "s")
        if found is not None:
            if found * 100 > tables.MOST_HUNDREDTHS:
                raise CannotSayError(f"a wait has a limit of {tables.MOST_HUNDREDTHS / 100:g} s at most")
            return str(max(1, round(found * 100)))
        inner = time.value if isinstance(time, ir.Quantity) else time
        factor = 100 * (ir.UNITS[time.unit] if isinstance(time, ir.Quantity) else 1.0)
        if factor == 1:
            return f"({self.expressions.operand(inner)})"
        return f"({self.expressions.operand(inner)}*{number(factor)})"

    def message(self, message: ir.Message) -> None:
        if message.kind == "clear":
            self.comments_only(message.origin)
            return
        text = ascii_text(self.shown(message.text)).replace("[", "(").replace("]", ")")
        most = tables.LONGEST_MESSAGE if self.expressions.limited else max(len(text), 1)
        if len(text) > most:
            self.diagnostics.report(SPLIT_MESSAGE, message.origin, most=most)
        parts = [text[at : at + most] for at in range(0, len(text), most)] or [""]
        self.put([Line(f"  MESSAGE[{part}]") for part in parts], message.origin)

    def shown(self, text: ir.Expression) -> str:
        """The text; a register in it by its name without brackets, which would end the instruction."""
        match text:
            case ir.TextLiteral(value=constant_text):
                return constant_text
            case ir.Binary(op="&", left=left, right=right):
                first, second = self.shown(left), self.shown(right)
                apart = first[-1:].isalnum() and second[:1].isalnum()
                return f"{first} {second}" if apart else first + second
            case ir.Builtin(function="value_text", arguments=(place,)):
                return self.shown(place)
        bank, _, inner = self.expressions.place(text).partition("[")
        if bank not in tables.SHOWN:
            raise CannotSayError("a message shows constant text, and this value has no register that it can name")
        return bank + inner.partition(":")[0].rstrip("]")


def _runs(loop: ir.For, step: float) -> bool:
    """Does a loop surely run once?"""
    first, last = constant(loop.start), constant(loop.stop)
    return first is not None and last is not None and (last - first) * step >= 0


def _leaves(body: ir.Body) -> bool:
    """Does the body never come to its end?"""
    match body:
        case (*_, ir.Goto() | ir.Return() | ir.Halt(kind="exit")):
            return True
    return False
