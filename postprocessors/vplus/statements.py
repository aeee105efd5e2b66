"""IR statements as V+ steps. What V+ cannot say becomes a guarded stop: the original as a comment, then PAUSE."""

from __future__ import annotations

import re
from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.scope import Scope
from rpl.source import Origin
from rpl.writing.anywhere import Anywhere
from rpl.writing.statements import CannotSayError, StatementPrinter
from rpl.writing.text import wrapped

from . import settings, spelling, tables
from .actions import Actions
from .decoding import decoded
from .expressions import Expressions, Notes
from .facts.moves import hand
from .motion import Motion
from .output import Output

GUARDED = code(
    "vplus-guarded-stop",
    Severity.LOSS,
    "V+ cannot say this: {reason}",
    "the program stops there with PAUSE; write the step by hand",
)
TEXT_CHANGED = code("vplus-text", Severity.WARNING, "a text is written in plain ASCII: {text}")
_ASSIGNED_NUMBER = re.compile(r"[a-z][\w.]*(\[[^\]=]*\])? = ", re.IGNORECASE)
_ROOM = tables.LONGEST_LINE - 12  # of a condition between its words


class Printer(StatementPrinter[str]):
    """Prints the body of one program."""

    guarded, dialect = GUARDED, "vplus"

    def __init__(self, scope: Scope, output: Output, labels: dict[str, str] | None = None) -> None:
        super().__init__(output.ledger, output.diagnostics)
        self.scope, self.output = scope, output
        self.say = output.say
        self.first, self.step = output.say("first"), output.say("step_in")
        self.labels = labels or {}
        self.notes = Notes(taken=output.taken, helpers=output.helpers, tasks=output.tasks)
        self.expressions = Expressions(scope, self.notes)
        self.motion = Motion(self.expressions, output.facts)
        self.may_move = Anywhere(lambda node: isinstance(node, ir.Move | ir.CallRoutine))
        self.actions = Actions(self)

    # ---- lines and comments

    def line(self, text: str, origin: Origin | None = None, shown: str = "") -> None:
        """One step, behind those that its values need, with the comments that belong to its statement. `shown`: as a
        macro of its own says it."""
        behind = ""
        for comment in origin.comments if origin else ():
            if comment.behind:
                behind = self.say("behind", text=_one_line(comment.text))
            else:
                self.comment(comment)
        before, self.notes.before = self.notes.before, []
        for one in before:
            self.lines.extend(map(self.fitted, self.say.lines("step", text=one)))
        for part in shown.splitlines() if shown else self.say.lines("step", text=text):
            whole = self.fitted(part)
            if behind and len(whole) + len(behind) > tables.LONGEST_LINE:
                self.remark(behind.removeprefix(" ;"))
            else:
                whole += behind
            self.lines.append(whole)
            behind = ""
        if not _ASSIGNED_NUMBER.match(text):
            self.notes.parts.clear()

    def fitted(self, text: str) -> str:
        """The step, indented as far as the line is long enough."""
        if len(text) > tables.LONGEST_LINE:
            raise CannotSayError(f"a line of {len(text)} characters; at most {tables.LONGEST_LINE} are read")
        indent = self.first + self.step * self.depth
        return indent[: tables.LONGEST_LINE - len(text)] + text

    def more(self, *texts: str) -> None:
        for text in texts:
            self.line(text)

    def remark(self, text: str) -> None:
        indent = (self.first + self.step * self.depth)[: tables.LONGEST_LINE // 2]
        for part in text.splitlines() or [""]:
            plain = spelling.ascii_text(part.rstrip())
            room = tables.LONGEST_LINE - len(indent) - 1
            for one in wrapped(plain, room):
                self.lines.extend(f"{indent}{line}".rstrip() for line in self.say.lines("remark", text=one))

    def stop(self) -> None:
        self.line("PAUSE")

    # ---- bodies

    def body(self, body: ir.Body, inner: bool = True) -> None:
        self.depth += inner
        at = 0
        while at < len(body):
            joined = self.joined(body[at:])
            if not joined:
                self.statement(body[at])
            at += joined or 1
        self.depth -= inner

    def joined(self, body: ir.Body) -> int:
        """Statements that are one step of V+. Counts them."""
        known = len(self.notes.autos)
        try:
            found = self.together(body)
        except CannotSayError:
            found = None  # each is then guarded on its own
        if found is None or len(found[0]) > tables.LONGEST_LINE:
            self.notes.back_to(0, known)
            return 0
        text, count = found
        for statement in body[:count]:
            self.comments_only(statement.origin)
            self.ledger.merged(statement)
        self.line(text)
        return count

    def together(self, body: ir.Body) -> tuple[str, int] | None:
        match body[0]:
            case ir.Assign(target=ir.System()) | ir.SetForNextMove():
                return settings.speed(body, self.expressions) or settings.acceleration(body, self.expressions)
            case ir.StopMotion() if len(body) > 1 and isinstance(body[1], ir.ClearMotion):
                again = len(body) > 2 and isinstance(body[2], ir.StartMotion)  # nothing is held back behind a BRAKE
                return "BRAKE", 3 if again else 2
            case ir.WaitForMotion() as wait if len(body) > 1:  # TOOL and BASE wait for the robot by themselves
                known = settings.parts(body[1])
                if known is not None and known[0] in ("tool", "base") and body[1].origin == wait.origin:
                    return settings.setting(known[0], known[1], known[2], self.expressions)[0], 2
            case ir.Trigger():
                word = hand(body)
                return (word, 2) if word else None
            case ir.Assign(target=ir.Field()):
                return self.actions.components(body)
            case ir.Assign():
                return decoded(body, self.expressions)
            case ir.Critical(enter=True):
                return self.test_and_set(body[1:4])
        return None

    def test_and_set(self, body: ir.Body) -> tuple[str, int] | None:
        """A variable is kept and set while no other task runs: `kept = TAS(variable, value)`."""
        match body:
            case (
                ir.Assign(target=kept, value=ir.Name() | ir.Index() as place),
                ir.Assign(target=again, value=value),
                ir.Critical(enter=False),
            ) if place == again:
                text = self.expressions.text
                return f"{text(kept)} = TAS({text(place)}, {text(value)})", 4
        return None

    def statement(self, statement: ir.Statement) -> None:
        """One statement, or its guarded stop."""
        known = len(self.notes.changed_texts)
        super().statement(statement)
        for text in self.notes.changed_texts[known:]:
            self.diagnostics.report(TEXT_CHANGED, statement.origin, text=text)

    def taken_back(self) -> None:
        self.notes.forget()
        self.notes.steps = True

    def written(self, statement: ir.Statement) -> None:
        match statement:
            case ir.Nothing(origin=origin):
                self.comments_only(origin)
            case ir.Opaque() | ir.Vendor():
                self.line(self.own_text(statement), statement.origin)
            case ir.LookAhead(origin=origin):
                self.comments_only(origin)  # programs of V+ always run ahead
            case ir.Label(name=name):
                self.motion.forget()
                self.notes.parts.clear()
                self.comments_only(statement.origin)
                self.lines.extend(self.say.lines("label", name=self.labels.get(name.lower(), name)))
            case ir.Goto(label=label):
                self.put("goto", statement.origin, name=self.labels.get(label.lower(), label))
            case ir.Move():
                self.move(statement)
            case ir.If() | ir.Switch() | ir.For() | ir.While() | ir.Repeat() | ir.Loop():
                self.motion_unknown(statement)
                self.block(statement)
                self.motion_unknown(statement)
            case _:
                self.actions.write(statement)

    def put(self, macro: str, origin: Origin | None = None, **words: str) -> None:
        """A step that has a macro of its own."""
        text = self.say(macro, **words)
        self.line(text, origin, text)

    def motion_unknown(self, block: ir.Statement) -> None:
        """A block that moves leaves the arm in a posture that depends on the run."""
        if self.may_move.within(block):
            self.motion.forget()

    def move(self, move: ir.Move) -> None:
        before, step, behind = self.motion.move(move)
        inner, self.notes.before = self.notes.before, []
        self.comments_only_before(move.origin)
        self.more(*inner, *before)
        word, _, places = step.partition(" ")
        self.line(step, _behind_only(move.origin), self.say("move", word=word, places=places))
        self.more(*behind)

    def comments_only_before(self, origin: Origin) -> None:
        for comment in origin.comments:
            if not comment.behind:
                self.comment(comment)

    def stands(self) -> bool:
        """Does the robot stand for certain when the last line has been executed?"""
        return bool(self.lines) and self.lines[-1].strip().upper() == "BREAK"

    # ---- blocks

    def condition(self, expression: ir.Expression, again: bool = False) -> str:
        """`again`: it is looked at more than once, so no step can stand in front."""
        if isinstance(expression, ir.Convert) and expression.how in ("truth", "minus_bit"):
            expression = expression.operand
        self.notes.steps = not again
        text = self.expressions.shortened(expression, _ROOM)
        self.notes.steps = True
        return text

    def block(self, statement: ir.Statement) -> None:
        origin = statement.origin
        match statement:
            case ir.If(branches=branches, otherwise=otherwise):
                self.branches(branches, otherwise, origin)
            case ir.Switch():
                self.switch(statement)
            case ir.For():
                self.counting(statement)
            case ir.While(condition=condition, body=body):
                self.put("while_head", origin, condition=self.condition(condition, True))
                self.body(body)
                self.line("END")
            case ir.Repeat(until=until, body=body):
                ending = self.condition(until, True)
                self.line("DO", origin)
                self.body(body)
                self.put("until", condition=ending)
            case ir.Loop(body=body):
                self.put("while_head", origin, condition="TRUE")
                self.body(body)
                self.line("END")

    def branches(
        self, branches: tuple[tuple[ir.Expression, ir.Body], ...], otherwise: ir.Body, origin: Origin | None
    ) -> None:
        """IF ... THEN ... ELSE ... END; a lone jump stands behind its condition."""
        (condition, body), *rest = branches
        shown = self.condition(condition)
        match body:
            case (ir.Goto(label=label, origin=at) as jump,) if not rest and not otherwise and not at.comments:
                self.put("if_goto", origin, condition=shown, name=self.labels.get(label.lower(), label))
                self.ledger.written(jump)
                return
        self.put("if_head", origin, condition=shown)
        self.body(body)
        if rest or otherwise:
            self.line("ELSE")
            if rest:
                self.depth += 1
                self.branches(tuple(rest), otherwise, None)
                self.depth -= 1
            else:
                self.body(otherwise)
        self.line("END")

    def switch(self, statement: ir.Switch) -> None:
        if not statement.cases:
            raise CannotSayError("a choice without a case")
        self.put("case_head", statement.origin, selector=self.expressions.shortened(statement.selector, _ROOM))
        self.depth += 1
        for case in statement.cases:
            values = ", ".join(self.expressions.text(value) for value in case.values)
            self.put("value", case.origin, values=values)
            self.body(case.body)
        if statement.default is not None:
            self.line("ANY")
            self.body(statement.default)
        self.depth -= 1
        self.line("END")

    def counting(self, loop: ir.For) -> None:
        if loop.scoped or loop.automatic or loop.at_least_once or loop.keeps_last:
            raise CannotSayError("a loop whose counter or first pass follows another language's rule")
        text = self.expressions.text
        step = text(loop.step) if loop.step is not None else ""
        counter, start, stop = text(ir.Name(loop.counter)), text(loop.start), text(loop.stop)
        self.put("for_head", loop.origin, counter=counter, start=start, stop=stop, step=step)
        self.body(loop.body)
        self.line("END")


def _one_line(text: str) -> str:
    return spelling.ascii_text(" ".join(text.split()))


def _behind_only(origin: Origin) -> Origin:
    return replace(origin, comments=tuple(comment for comment in origin.comments if comment.behind))
