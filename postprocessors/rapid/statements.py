"""Write statements: each IR node prepares the parts of one template macro. The unsayable becomes a guarded stop."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Protocol, cast

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.source import Origin
from rpl.writing.ledger import EmissionLedger
from rpl.writing.refusals import refusal
from rpl.writing.statements import CannotSayError

from . import motion
from .expressions import Expressions, text_literal
from .frames import macros
from .instructions import Instructions

NOT_SAID = code(
    "not-written",
    Severity.LOSS,
    "RAPID cannot say this: {reason}",
    "the original stands there as a comment, with a Stop behind it",
)
INDENT = "  "
_SHOWN_LINES = 12


class Macros(Protocol):
    """The macros of templates/statements.j2 give text."""

    def __getattr__(self, name: str) -> Macro: ...


class Macro(Protocol):
    def __call__(self, *arguments: object) -> str: ...


@cache
def _macros() -> Macros:
    return cast(Macros, macros("statements.j2"))


def indented(lines: Sequence[str]) -> str:
    """Lines of a block, indented by one step, as one text."""
    return "\n".join(f"{INDENT}{line}" if line else line for line in lines)


def remark_lines(origin: Origin) -> list[str]:
    """The comments before a statement."""
    lines: list[str] = []
    for comment in origin.comments:
        if not comment.behind:
            lines.extend(f"!{line}".rstrip() for line in comment.text.splitlines() or [""])
    return lines


def behind(origin: Origin) -> str:
    """The comment behind a statement on its line."""
    words = " ".join(
        line.rstrip() for comment in origin.comments if comment.behind for line in comment.text.splitlines()
    )
    return f" !{words}" if words else ""


def _inside(choice: ir.If) -> list[ir.Statement]:
    return [one for body in (*(body for _, body in choice.branches), choice.otherwise) for one in body]


class Statements:
    """Writes the statements of one routine."""

    def __init__(self, expressions: Expressions, diagnostics: Diagnostics, ledger: EmissionLedger) -> None:
        self.expressions = expressions
        self.text = expressions.text
        self.diagnostics = diagnostics
        self.ledger = ledger
        self.instructions = Instructions(expressions)

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
        try:
            lines = self.lines(statement)
        except CannotSayError as reason:
            return self.guarded(statement, str(reason))
        return self.framed(statement, lines, (statement,))

    def framed(self, first: ir.Statement, lines: list[str], nodes: Sequence[ir.Statement]) -> list[str]:
        """The lines with the comments of the statement before and behind them."""
        for node in nodes:
            self.ledger.written(node)
        remark = behind(first.origin)
        if remark and lines:
            lines = [lines[0] + remark, *lines[1:]]
        elif remark:
            lines = [remark.strip()]
        return [*remark_lines(first.origin), *lines]

    def guarded(self, statement: ir.Statement, reason: str) -> list[str]:
        """The original as comment lines and the controller's own stop."""
        self.ledger.reported(statement)
        code, why = refusal(statement, "rapid") or (NOT_SAID, reason)
        self.diagnostics.report(code, statement.origin, reason=why)
        original = statement.text if isinstance(statement, ir.Opaque | ir.Vendor) else statement.origin.text
        shown = [line.strip() for line in (original or repr(statement)).splitlines()][:_SHOWN_LINES]
        text = _macros().guarded([f"not carried over: {reason}", *shown])
        return [*remark_lines(statement.origin), *text.splitlines()]

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
        return indented(self.body(body))

    def block(self, statement: ir.Statement) -> str | None:
        match statement:
            case ir.If(branches=branches, otherwise=otherwise):
                conditions = [self.text(condition) for condition, _ in branches]
                done = [(text, self.inner(body)) for text, (_, body) in zip(conditions, branches, strict=True)]
                return _macros().if_block(done, self.inner(otherwise))
            case ir.Switch(selector=selector, cases=cases, default=default):
                values = [self.expressions.list(case.values) for case in cases]
                chosen = self.text(selector)
                listed = [(value, self.inner(case.body)) for value, case in zip(values, cases, strict=True)]
                return _macros().test_block(chosen, listed, self.inner(default or ()), default is not None)
            case ir.While(condition=condition, body=body):
                return _macros().while_block(self.text(condition), self.inner(body))
            case ir.For():
                return self.counting(statement)
        return None

    def counting(self, loop: ir.For) -> str:
        if not (loop.at_least_once and loop.scoped) or loop.automatic != (loop.step is None):
            raise CannotSayError("FOR counts by its own rule")
        head = [self.text(loop.start), self.text(loop.stop), "" if loop.step is None else self.text(loop.step)]
        scope = self.expressions.scope.with_value(ir.Variable(loop.counter, ir.RealType()))
        inner = Expressions(scope, self.expressions.long_texts, self.expressions.beside)
        inside = Statements(
            inner,
            self.diagnostics,
            self.ledger,
        )
        return _macros().for_block(loop.counter, *head, indented(inside.body(loop.body)))

    # ---- one-line statements

    def simple(self, statement: ir.Statement) -> str:
        made = _macros()
        match statement:
            case ir.Assign(target=target, value=value):
                return self.instructions.assign(target, value)
            case ir.CallRoutine(name=name, arguments=arguments, dynamic=None):
                return made.call(name, self.expressions.arguments(name, arguments))
            case ir.CallRoutine(arguments=arguments, dynamic=dynamic) if dynamic is not None:
                return made.late_call(self.text(dynamic), self.expressions.arguments("", arguments))
            case ir.Label(name=name):
                return made.label(name)
            case ir.Goto(label=name):
                return made.goto(name)
            case ir.Return(value=value):
                return made.leave("" if value is None else self.text(value))
            case ir.Raise(code=value):
                return made.raise_error("" if value is None else self.text(value))
            case ir.Vendor(dialect="rapid", text=text):
                return text
            case ir.ConnectInterrupt(handle=handle, routine=routine):
                return made.connect(self.text(handle), routine)
            case ir.Move():
                text = self.motion(motion.move(statement, self.expressions))
                for trigger in statement.triggers:
                    if isinstance(trigger, ir.Trigger):
                        self.ledger.merged(trigger)
                return text
            case ir.MoveExternal():
                return self.motion(motion.move_external(statement, self.expressions))
            case ir.DefineTrigger():
                return made.word(motion.define_trigger(statement, self.expressions))
        return self.instructions.text(statement)

    def motion(self, parts: motion.MoveText) -> str:
        return _macros().move(parts.name, parts.before, list(parts.points), parts.settings)


__all__ = ["Statements", "behind", "indented", "remark_lines", "text_literal"]
