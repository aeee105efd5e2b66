"""IR statements as the words of KRL's macros. What KRL cannot say is a guarded stop: the original as a remark, then
HALT."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from itertools import takewhile

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.passes.scope import Scope
from rpl.source import Origin
from rpl.writing.ledger import EmissionLedger
from rpl.writing.statements import CannotSayError, StatementPrinter
from rpl.writing.templates import Macros

from . import tables
from .declarations import constant, elements
from .expressions import Expressions
from .forms.written import MOST, form_words, is_initialising
from .motion import Motion
from .settings import assigned, assignment, coupled, percent_text, speed_of_axes, whole_structure

GUARDED = code(
    "krl-guarded-stop",
    Severity.LOSS,
    "KRL cannot say this: {reason}",
    "the program stops there with HALT; write the line by hand",
)
DIALOG = code(
    "krl-dialog-lost",
    Severity.LOSS,
    "{reason}",
    "the program stops there with HALT; ask by keys, or let the operator set a variable and read that instead",
)
LONG_LINE = code("krl-long-line", Severity.WARNING, "a line of {length} characters; controllers read at most {most}")

_BRAKES = {"BRAKE_SOFT": "BRAKE", "BRAKE_HARD": "BRAKE F"}  # routines of the reader's prelude
_LARGEST_STRUCTURE = 6


class Printer(StatementPrinter[str]):
    """Prints the bodies of one routine."""

    guarded, dialect = GUARDED, "krl"

    def __init__(
        self,
        scope: Scope,
        ledger: EmissionLedger,
        diagnostics: Diagnostics,
        macros: Macros,
        frames: Mapping[tuple[str, int], str] | None,
    ) -> None:
        """frames: names of tools and bases by table and number; None: forms have their folds already."""
        super().__init__(ledger, diagnostics)
        self.frames = frames
        self.say, self.step = macros, macros("step")
        self.scope = scope
        self.expressions = Expressions(scope)
        self.motion = Motion(self.expressions)

    # ---- lines and comments

    def line(self, text: str, origin: Origin | None = None) -> None:
        """The line or lines of a statement, with its comments before them and behind the first."""
        indent = self.step * self.depth
        behind = ""
        for comment in origin.comments if origin else ():
            if comment.behind:
                behind = self.say("behind", text=_one_line(comment.text))
            else:
                self.comment(comment)
        for part in text.splitlines() or [""]:
            whole = f"{indent}{part}{behind}"
            if len(whole) > tables.LONGEST_LINE and origin is not None:
                self.diagnostics.report(LONG_LINE, origin, length=len(whole), most=tables.LONGEST_LINE)
            self.lines.append(whole)
            behind = ""

    def word(self, text: str, origin: Origin | None = None) -> None:
        self.line(self.say("word", text=text), origin)

    def remark(self, text: str) -> None:
        indent = self.step * self.depth
        for part in text.splitlines() or [""]:
            self.lines.extend(f"{indent}{line}" for line in self.say.lines("remark", text=part))

    def stop(self) -> None:
        self.line(self.say("stop"))

    # ---- bodies

    def body(self, body: ir.Body) -> None:
        self.depth += 1
        at = 0
        while at < len(body):
            at += self.structure(body[at : at + _LARGEST_STRUCTURE]) or self.one(body[at])
        self.depth -= 1

    def one(self, statement: ir.Statement) -> int:
        self.statement(statement)
        return 1

    def structure(self, body: ir.Body) -> int:
        """`$VEL=f()` stands for an assignment to each component, `BAS(#VEL_PTP,n)` for one to each axis: written as the
        one it was. Counts the statements. body: as many as the largest structure has, or all that are left."""
        first = body[0]
        if self.frames is not None and (count := self.form(body[:MOST], self.frames)):
            return count
        if not (isinstance(first, ir.Assign) and isinstance(first.target, ir.System)):
            return 0
        together = takewhile(lambda one: isinstance(one, ir.Assign), body)
        pairs = [(one.target, one.value) for one in together if isinstance(one, ir.Assign)]
        whole = whole_structure(pairs)
        try:
            base = coupled(pairs, self.expressions)
            if base is not None:
                words, count = base
                shown = self.say("external_base", **words)
            elif whole is not None:
                name, value = whole
                shown = self.say("assign", target=name, value=self.expressions.text(value))
                count = len(tables.STRUCTURES[name])
            elif speed_of_axes(pairs):
                shown, count = (
                    self.say("speed_of_axes", percent=percent_text(pairs[0][1], self.expressions)),
                    len(pairs),
                )
            else:
                return 0
        except CannotSayError:
            return 0  # each assignment is then guarded on its own
        origins = [statement.origin for statement in body[:count]]
        comments = tuple(comment for origin in origins for comment in origin.comments)
        self.line(shown, replace(first.origin, comments=comments))
        for statement in body[:count]:
            self.ledger.written(statement)
        return count

    def form(self, body: ir.Body, frames: Mapping[tuple[str, int], str]) -> int:
        """An inline form, or the INI fold, that begins here. Counts the statements."""
        first = body[0]
        if any(comment.text.lstrip().startswith("FOLD") for comment in first.origin.comments):
            return 0  # it has its own
        if is_initialising(first):
            self.folded((first,), lambda line: self.say("ini", call=line))
            return 1
        found = form_words(body, self.scope, frames)
        if found is None:
            return 0
        words, count = found
        self.folded(body[:count], lambda *lines: self.say("form", lines=lines, speed=_given(lines[3]), **words))
        return count

    def folded(self, body: ir.Body, shown: Callable[..., str]) -> None:
        origin = body[0].origin
        remarks = tuple(replace(comment, behind=False) for comment in origin.comments)
        self.line(shown(*map(self.simple, body)), replace(origin, comments=remarks))
        for statement in body:
            self.ledger.written(statement)

    def written(self, statement: ir.Statement) -> None:
        match statement:
            case ir.Nothing(origin=origin) | ir.Message(kind="clear", origin=origin):  # the window scrolls by itself
                self.comments_only(origin)
            case ir.If() | ir.Switch() | ir.For() | ir.While() | ir.Repeat() | ir.Loop() | ir.Spline():
                self.block(statement)
            case ir.Assign(target=target, value=ir.Aggregate() as value) if self.is_array(target):
                self.whole_array(statement, target, value)
            case ir.Opaque() | ir.Vendor():
                self.line(self.own_text(statement), statement.origin)
            case _:
                self.line(self.simple(statement), statement.origin)

    def is_array(self, target: ir.Expression) -> bool:
        return isinstance(self.expressions.type(target), ir.ArrayType)

    def whole_array(self, statement: ir.Statement, target: ir.Expression, value: ir.Aggregate) -> None:
        """An array filled at once: element by element, when the order cannot matter."""
        type = self.expressions.type(target)
        assert isinstance(type, ir.ArrayType)
        if not constant(value):
            raise CannotSayError("an array filled at once with computed values")
        for number, one in enumerate(elements(target, (), value, len(type.dimensions))):
            shown = self.say("assign", **assigned(one, self.expressions))
            self.line(shown, statement.origin if number == 0 else None)

    # ---- blocks

    def block(self, statement: ir.Statement) -> None:
        text = self.expressions.text
        origin = statement.origin
        match statement:
            case ir.If(branches=branches, otherwise=otherwise):
                self.branches(branches, otherwise, origin)
            case ir.Switch():
                self.switch(statement)
            case ir.For():
                self.counting(statement)
            case ir.While(condition=condition, body=body):
                self.line(self.say("while_head", condition=text(condition)), origin)
                self.body(body)
                self.word("ENDWHILE")
            case ir.Repeat(until=until, body=body):
                ending = self.say("until", condition=text(until))
                self.word("REPEAT", origin)
                self.body(body)
                self.line(ending)
            case ir.Loop(body=body):
                self.word("LOOP", origin)
                self.body(body)
                self.word("ENDLOOP")
            case ir.Spline():
                head, tail = self.motion.spline(statement)
                self.line(self.say("spline_head", **head), origin)
                self.body(statement.body)
                self.line(self.say("spline_end", **tail))

    def branches(
        self, branches: tuple[tuple[ir.Expression, ir.Body], ...], otherwise: ir.Body, origin: Origin | None
    ) -> None:
        """IF ... ELSE ... ENDIF; further branches nest, because KRL has no ELSEIF."""
        (condition, body), *rest = branches
        self.line(self.say("if_head", condition=self.expressions.text(condition)), origin)
        self.body(body)
        if rest or otherwise:
            self.word("ELSE")
            if rest:
                self.depth += 1
                self.branches(tuple(rest), otherwise, None)
                self.depth -= 1
            else:
                self.body(otherwise)
        self.word("ENDIF")

    def switch(self, statement: ir.Switch) -> None:
        if not statement.cases:
            raise CannotSayError("a SWITCH without a CASE")
        self.line(self.say("switch_head", selector=self.expressions.text(statement.selector)), statement.origin)
        self.depth += 1
        for case in statement.cases:
            values = ",".join(self.expressions.text(value) for value in case.values)
            self.line(self.say("case", values=values))
            self.body(case.body)
        if statement.default is not None:
            self.word("DEFAULT")
            self.body(statement.default)
        self.depth -= 1
        self.word("ENDSWITCH")

    def counting(self, loop: ir.For) -> None:
        if loop.scoped or loop.automatic or loop.at_least_once:
            raise CannotSayError("a loop whose counter or first pass follows another language's rule")
        text = self.expressions.text
        step = text(loop.step) if loop.step is not None else ""
        start, stop = text(loop.start), text(loop.stop)
        self.line(self.say("for_head", counter=loop.counter, start=start, stop=stop, step=step), loop.origin)
        self.body(loop.body)
        self.word("ENDFOR")

    # ---- simple statements

    def simple(self, statement: ir.Statement) -> str:
        text, say = self.expressions.text, self.say
        match statement:
            case ir.Assign():
                return say("assign", **assigned(statement, self.expressions))
            case ir.CallRoutine():
                return say("call", **called(statement, self.expressions))
            case ir.ExitLoop():
                return say("word", text="EXIT")
            case ir.Label(name=name):
                return say("label", name=name)
            case ir.Goto(label=name):
                return say("goto", name=name)
            case ir.Return(value=value):
                return say("return_value", value=text(value)) if value is not None else say("word", text="RETURN")
            case ir.Halt():
                return say("word", text="HALT")
            case ir.Wait(time=time):
                return say("wait", time=self.expressions.measured(time, "s"))
            case ir.WaitUntil(condition=condition, timeout=None, error=None):
                return say("wait_until", condition=text(condition))
            case ir.WaitForMotion():
                return say("wait", time="0")
            case ir.LookAhead():
                return say("word", text="CONTINUE")
            case ir.Pulse(signal=signal, value=value, duration=duration):
                length = self.expressions.measured(duration, "s")
                return say("pulse", signal=text(signal), value=text(value), time=length)
            case ir.StopMotion(hard=hard):
                return say("word", text="BRAKE F" if hard else "BRAKE")
            case ir.ResumeLevel():
                return say("word", text="RESUME")
            case ir.Do(procedure=procedure, arguments=arguments) if procedure in tables.PROCEDURES:
                return say("do", **self.expressions.procedure(procedure, arguments))
            case ir.Message() | ir.Dialog():
                return self.told(statement)
            case ir.DeclareInterrupt() | ir.ControlInterrupt():
                return self.interrupt(statement)
            case ir.Move():
                return say("move", **self.motion.move(statement))
            case ir.Trigger():
                return self.trigger(statement)
            case ir.PathRule():
                return say("path_rule", **self.motion.path_rule(statement))
        raise CannotSayError(f"KRL has no {statement.__class__.__name__}")

    def interrupt(self, statement: ir.DeclareInterrupt | ir.ControlInterrupt) -> str:
        text = self.expressions.text
        if isinstance(statement, ir.ControlInterrupt):
            if statement.op in ("delete", "mask"):
                done = "deleted" if statement.op == "delete" else "masked by its urgency"
                raise CannotSayError(f"an interrupt cannot be {done}")
            priority = text(statement.handle) if statement.handle is not None else ""
            return self.say("control_interrupt", how=statement.op.upper(), priority=priority)
        return self.say(
            "interrupt",
            everywhere=statement.everywhere,
            action=self.action(statement.action),
            condition=text(statement.condition),
            priority=text(statement.priority),
        )

    def trigger(self, trigger: ir.Trigger) -> str:
        text = self.expressions
        action = trigger.action
        bare = trigger.distance is None and trigger.delay is None and trigger.priority is None
        output = isinstance(action, ir.Assign) and isinstance(action.target, ir.Signal)
        if bare and output and trigger.reference == "start":
            assert isinstance(action, ir.Assign)
            words = assigned(action, text)
            self.ledger.merged(action)
            if words["target"].startswith("$OUT["):
                words["target"] = words["target"].replace("$OUT[", "$OUT_C[", 1)
                return self.say("assign", **words)
        return self.at(trigger, action)

    def at(self, trigger: ir.Trigger, action: ir.Assign | ir.CallRoutine) -> str:
        text = self.expressions
        if trigger.distance is not None or trigger.reference == "end":
            distance = text.measured(trigger.distance, "") if trigger.distance is not None else "0"
            start = " ONSTART" if trigger.reference == "start" else ""
            where = f"PATH={distance}{start}"
        else:
            where = f"DISTANCE={0 if trigger.reference == 'start' else 1}"
        delay = text.measured(trigger.delay, "ms") if trigger.delay is not None else "0"
        priority = text.text(trigger.priority) if trigger.priority is not None else ""
        done = self.action(action)
        if not priority and isinstance(action, ir.CallRoutine) and not done.startswith("PULSE("):
            priority = "-1"  # a subroutine needs one: the controller's own choice
        return self.say("trigger", where=where, delay=delay, action=done, priority=priority)

    def action(self, action: ir.Assign | ir.CallRoutine) -> str:
        if isinstance(action, ir.Assign):
            return assignment(action, self.expressions)
        if action.name.upper() == "PULSE_OUT" and len(action.arguments) == 3:
            number, value, time = (argument.value for argument in action.arguments)
            if number is not None and value is not None and time is not None:
                text = self.expressions.text
                return f"PULSE($OUT[{text(number)}],{text(value)},{text(time)})"
        return _BRAKES.get(action.name.upper()) or "{name}({arguments})".format(**called(action, self.expressions))

    # ---- messages

    def told(self, statement: ir.Message | ir.Dialog) -> str:
        text = self.expressions.text
        wanted = statement.text
        parameters: tuple[ir.Expression, ...] = ()
        if isinstance(wanted, ir.Builtin) and wanted.function == "message_text":
            wanted, *rest = wanted.arguments
            parameters = tuple(rest)
        if isinstance(wanted, ir.Binary):
            raise CannotSayError("a message is one text with up to three parameters")
        if len(parameters) > 3:
            raise CannotSayError("a message has at most three parameters")
        shown = [text(wanted), text(statement.sender) if statement.sender is not None else '""']
        shown.extend(text(value) if value != ir.TextLiteral("") else "" for value in parameters)
        if isinstance(statement, ir.Message):
            if statement.kind not in tables.MESSAGES:
                raise CannotSayError(f"KRL has no message of kind {statement.kind}")
            if len(shown) == 2 and statement.sender is None:
                shown.pop()
            return self.say("message", function=tables.MESSAGES[statement.kind], arguments=shown)
        if statement.kind != "keys" or statement.timeout is not None:
            raise CannotSayError("KRL's dialogs are answered by a key, without a time limit", DIALOG)
        shown[0:0] = [text(statement.answer)]
        shown.extend([""] * (6 - len(shown)))
        shown.extend(text(key) if key is not None else "" for key in statement.keys)
        return self.say("message", function="MsgDialog", arguments=shown)


def _given(call: str) -> str:
    """The speed in `BAS(#PTP_PARAMS,50)`."""
    return call.partition(",")[2].rstrip(")")


def _one_line(text: str) -> str:
    return " ".join(text.splitlines())


def called(statement: ir.CallRoutine, expressions: Expressions) -> dict[str, str]:
    if statement.dynamic is not None:
        raise CannotSayError("KRL has no call by a computed name")
    return {"name": statement.name, "arguments": expressions.arguments(statement.arguments) or " "}
