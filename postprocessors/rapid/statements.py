"""Write statements: each IR node prepares the parts of one template macro. The unsayable becomes a guarded stop."""

from __future__ import annotations

from collections.abc import Sequence

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.source import Origin
from rpl.writing.ledger import EmissionLedger
from rpl.writing.refusals import refusal
from rpl.writing.rows import lines_of_rows
from rpl.writing.statements import CannotSayError
from rpl.writing.templates import Macros, TemplateError

from . import motion
from .expressions import Expressions, foreign_number, number
from .instructions import Instructions

NOT_SAID = code(
    "not-written",
    Severity.LOSS,
    "RAPID cannot say this: {reason}",
    "the original stands there as a comment, with a Stop behind it",
)
_SHOWN_LINES = 12


class Layout:
    """Blocks and remarks as lines."""

    def __init__(self, macros: Macros) -> None:
        self.macros = macros
        self.step = macros("step")

    def indented(self, lines: Sequence[str]) -> str:
        """Lines of a block, indented by one step, as one text."""
        step = self.step
        return "\n".join(f"{step}{line}" if line else line for line in lines)

    def remarks(self, origin: Origin) -> list[str]:
        """The comments before a statement."""
        lines: list[str] = []
        for comment in origin.comments:
            if not comment.behind:
                for line in comment.text.splitlines() or [""]:
                    lines.extend(self.macros.lines("remark", text=line.rstrip()))
        return lines

    def behind(self, origin: Origin) -> str:
        """The comment behind a statement on its line."""
        if not origin.comments:
            return ""
        words = " ".join(
            line.rstrip() for comment in origin.comments if comment.behind for line in comment.text.splitlines()
        )
        return self.macros("behind", text=words) if words else ""


def _inside(choice: ir.If) -> list[ir.Statement]:
    return [one for body in (*(body for _, body in choice.branches), choice.otherwise) for one in body]


class Statements:
    """Writes the statements of one routine."""

    def __init__(
        self, expressions: Expressions, diagnostics: Diagnostics, ledger: EmissionLedger, layout: Layout
    ) -> None:
        self.expressions = expressions
        self.text = expressions.text
        self.diagnostics = diagnostics
        self.ledger = ledger
        self.layout = layout
        self.say = layout.macros
        self.instructions = Instructions(expressions, layout.macros)

    def body(self, body: ir.Body) -> list[str]:
        """All lines of a body, not indented."""
        lines: list[str] = []
        at = 0
        while at < len(body):
            count, text = self.instructions.settings(body, at)
            if count:
                together = list(body[at : at + count])
                inner = [one for node in together if isinstance(node, ir.If) for one in _inside(node)]
                lines.extend(self.framed(body[at], [text], [*together, *inner]))
            else:
                lines.extend(self.statement(body[at]))
                count = 1
            at += count
        return lines

    def statement(self, statement: ir.Statement) -> list[str]:
        if isinstance(statement, ir.Rows):
            self.ledger.written(statement)
            quiet = Statements(self.expressions, self.diagnostics, EmissionLedger(), self.layout)
            spelled = foreign_number if self.expressions.foreign else number
            return lines_of_rows(statement, quiet.statement, spelled)
        try:
            lines = self.lines(statement)
        except CannotSayError as reason:
            return self.guarded(statement, str(reason))
        except TemplateError as error:
            raise error.at(statement.origin) from None
        return self.framed(statement, lines, (statement,))

    def framed(self, first: ir.Statement, lines: list[str], nodes: Sequence[ir.Statement]) -> list[str]:
        """The lines with the comments of the statement before and behind them."""
        for node in nodes:
            self.ledger.written(node)
        remark = self.layout.behind(first.origin)
        if remark and lines:
            lines = [lines[0] + remark, *lines[1:]]
        elif remark:
            lines = [remark.strip()]
        return [*self.layout.remarks(first.origin), *lines]

    def guarded(self, statement: ir.Statement, reason: str) -> list[str]:
        """The original as comment lines and the controller's own stop."""
        self.ledger.reported(statement)
        code, why = refusal(statement, "rapid") or (NOT_SAID, reason)
        told = self.diagnostics.stopping(statement.origin)
        self.diagnostics.report(code, statement.origin, reason=why)
        reason = told.message if told is not None else reason
        original = statement.text if isinstance(statement, ir.Opaque | ir.Vendor) else statement.origin.text
        shown = [line.strip() for line in (original or repr(statement)).splitlines()][:_SHOWN_LINES]
        return [*self.layout.remarks(statement.origin), *self.say.lines("guarded", reason=reason, original=shown)]

    def lines(self, statement: ir.Statement) -> list[str]:
        """The statement's own lines. Raises CannotSayError."""
        block = self.block(statement)
        if block is not None:
            return block.splitlines()
        if isinstance(statement, ir.Nothing):
            return []
        return self.simple(statement).splitlines()

    # ---- blocks

    def inner(self, body: ir.Body) -> str:
        return self.layout.indented(self.body(body))

    def block(self, statement: ir.Statement) -> str | None:
        match statement:
            case ir.If(branches=((condition, (ir.Goto() as jump,)),), otherwise=()) if not jump.origin.comments:
                self.ledger.merged(jump)
                return self.say("if_jump", condition=self.text(condition), name=jump.label)
            case ir.If(branches=((condition, (ir.Return(value=None) as end,)),), otherwise=()) if (
                not end.origin.comments
            ):
                self.ledger.merged(end)
                return self.say("if_return", condition=self.text(condition))
            case ir.If(branches=branches, otherwise=otherwise):
                conditions = [self.text(condition) for condition, _ in branches]
                done = [(text, self.inner(body)) for text, (_, body) in zip(conditions, branches, strict=True)]
                return self.say("if_block", branches=done, otherwise=self.inner(otherwise))
            case ir.Switch(selector=selector, cases=cases, default=default):
                values = [self.expressions.list(case.values) for case in cases]
                chosen = self.text(selector)
                listed = [(value, self.inner(case.body)) for value, case in zip(values, cases, strict=True)]
                rest = self.inner(default or ())
                has = default is not None
                return self.say("test_block", selector=chosen, cases=listed, default=rest, has_default=has)
            case ir.While(condition=condition, body=body):
                return self.say("while_block", condition=self.text(condition), body=self.inner(body))
            case ir.For():
                return self.counting(statement)
        return None

    def counting(self, loop: ir.For) -> str:
        if not (loop.at_least_once and loop.scoped) or loop.automatic != (loop.step is None):
            raise CannotSayError("FOR counts by its own rule")
        start, stop = self.text(loop.start), self.text(loop.stop)
        step = "" if loop.step is None else self.text(loop.step)
        scope = self.expressions.scope.with_value(ir.Variable(loop.counter, ir.RealType()))
        inner = Expressions(scope, self.expressions.long_texts, self.expressions.beside, self.expressions.foreign)
        inside = Statements(inner, self.diagnostics, self.ledger, self.layout)
        body = inside.inner(loop.body)
        return self.say("for_block", counter=loop.counter, start=start, stop=stop, step=step, body=body)

    # ---- one-line statements

    def simple(self, statement: ir.Statement) -> str:
        say = self.say
        match statement:
            case ir.Assign(target=target, value=value):
                return self.instructions.assign(target, value)
            case ir.CallRoutine(name=name, arguments=arguments, dynamic=None):
                return say("call", name=name, arguments=self.expressions.arguments(name, arguments))
            case ir.CallRoutine(arguments=arguments, dynamic=dynamic) if dynamic is not None:
                text = self.text(dynamic)
                return say("late_call", text=text, arguments=self.expressions.arguments("", arguments))
            case ir.Label(name=name):
                return say("label", name=name)
            case ir.Goto(label=name):
                return say("goto", name=name)
            case ir.Return(value=value):
                return say("leave", value="" if value is None else self.text(value))
            case ir.Raise(code=value):
                return say("raise_error", value="" if value is None else self.text(value))
            case ir.Vendor(dialect="rapid", text=text):
                return text
            case ir.ConnectInterrupt(handle=handle, routine=routine):
                return say("connect", handle=self.text(handle), routine=routine)
            case ir.Move():
                macro, words = motion.move(statement, self.expressions)
                text = say(macro, **words)
                for trigger in statement.triggers:
                    if isinstance(trigger, ir.Trigger):
                        self.ledger.merged(trigger)
                return text
            case ir.MoveExternal():
                return say("move_external", **motion.move_external(statement, self.expressions))
            case ir.DefineTrigger():
                macro, words = motion.define_trigger(statement, self.expressions)
                return say(macro, **words)
        return self.instructions.text(statement)


__all__ = ["Layout", "Statements"]
