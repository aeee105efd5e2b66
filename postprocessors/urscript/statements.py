"""IR statements as URScript lines. What URScript cannot say becomes a guarded stop: the original, then `halt`."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from rpl import ir
from rpl.diagnostics import Code, Diagnostics, Severity, code
from rpl.ir.walk import walk
from rpl.passes.fold import constant_number
from rpl.passes.scope import Scope
from rpl.source import Origin
from rpl.writing.ledger import EmissionLedger
from rpl.writing.numbers import added
from rpl.writing.statements import CannotSayError, StatementPrinter
from rpl.writing.templates import Macros

from . import spelling
from .actions import Actions
from .expressions import Expressions, Notes
from .facts.standing import Standing
from .facts.uses import Uses
from .motion import Motion

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel

GUARDED = code(
    "urscript-guarded-stop",
    Severity.LOSS,
    "URScript cannot say this: {reason}",
    "the program stops there with halt; write the line by hand",
)
PATH_ACTION = code(
    "urscript-path-action",
    Severity.LOSS,
    "URScript switches and calls nothing at a place on a path",
    "the program stops there with halt; split the move, or watch the place in a thread",
)
TEXT_CHANGED = code(
    "urscript-text",
    Severity.WARNING,
    "a text is written in plain ASCII without double quotes: {text}",
)
INDENT = "  "
_BLOCKS = (ir.If, ir.Switch, ir.For, ir.While, ir.Repeat, ir.Loop)
_TIMED = (ir.Wait, ir.WaitUntil, ir.Move, ir.CallRoutine, ir.Call, ir.Dialog, ir.WaitForMotion, ir.Return, ir.Halt)


@dataclass(slots=True)
class Output:
    """What all routines of one file share."""

    ledger: EmissionLedger
    diagnostics: Diagnostics
    robot: RobotModel | None
    taken: set[str]
    standing: Standing
    say: Macros
    uses: Uses
    notes: Notes = field(default_factory=Notes)
    threads: list[tuple[str, ...]] = field(default_factory=list)
    watches: dict[str, str] = field(default_factory=dict)  # stop watch -> the variable that says whether it runs
    handles: dict[str, str] = field(default_factory=dict)  # thread -> the variable with the number of the running one
    counting: list[str] = field(default_factory=list)  # threads that run from the beginning

    def watch(self, name: str) -> tuple[str, str]:
        """The data of a stop watch: the seconds, which a thread counts, and whether it runs."""
        runs, thread = self.fresh(f"{name}_on"), self.fresh(f"{name}_count")
        self.watches[name] = runs
        self.counting.append(thread)
        count = (f"    if {runs}:", f"      {name} = {name} + get_steptime()", "    end")
        self.threads.append((f"thread {thread}():", "  while True:", "    sync()", *count, "  end", "end"))
        return f"{name} = 0.0", f"{runs} = False"

    def fresh(self, stem: str) -> str:
        """A name that nothing in the program has."""
        name, number = stem, 1
        while name in self.taken:
            number += 1
            name = f"{stem}_{number}"
        self.taken.add(name)
        return name


class Printer(StatementPrinter[str]):
    """Prints the bodies of one routine. `inside`: the routine has variables of its own (the program itself has not)."""

    guarded, dialect = GUARDED, "urscript"

    def __init__(self, scope: Scope, output: Output, inside: bool = True, depth: int = 0) -> None:
        super().__init__(output.ledger, output.diagnostics)
        self.scope, self.output, self.inside, self.depth = scope, output, inside, depth
        self.say = output.say
        self.stopped = False  # does the statement follow one that brakes the robot?
        self.rest: ir.Body = ()  # what follows in the same body
        self.before_next: list[tuple[str, ...]] = []
        self.expressions = Expressions(scope, output.notes)
        self.motion = Motion(self.expressions, output.diagnostics, output.robot)
        self.actions = Actions(self)

    # ---- lines and comments

    def line(self, text: str, origin: Origin | None = None) -> None:
        """The line or lines of a statement, with its comments before them and behind the first."""
        behind = ""
        for comment in origin.comments if origin else ():
            if comment.behind:
                behind = self.say("behind", text=_one_line(comment.text))
            else:
                self.comment(comment)
        for part in text.splitlines() or [""]:
            self.lines.append(f"{INDENT * self.depth}{part}{behind}")
            behind = ""

    def word(self, text: str) -> None:
        self.line(self.say("word", text=text))

    def more(self, *texts: str) -> None:
        """Lines of a statement that is written as several."""
        self.lines.extend(f"{INDENT * self.depth}{text}" for text in texts)

    def remark(self, text: str) -> None:
        for part in text.splitlines() or [""]:
            for line in self.say.lines("remark", text=spelling.ascii_text(part.strip())):
                self.lines.append(f"{INDENT * self.depth}{line}".rstrip())

    def stop(self) -> None:
        self.line(self.say("stop"))

    def temporary(self, stem: str, value: str) -> str:
        """A new variable with its first value."""
        name = self.output.fresh(stem)
        self.more(f"{'local ' if self.inside else ''}{name} = {value}")
        return name

    # ---- bodies

    def body(self, body: ir.Body) -> None:
        self.depth += 1
        for at, statement in enumerate(body):
            after = body[at - 1] if at else None
            self.stopped = isinstance(after, ir.StopMotion) or (self.stopped and isinstance(after, ir.ClearMotion))
            self.rest = body[at + 1 :]
            self.statement(statement)
        self.depth -= 1

    def statement(self, statement: ir.Statement) -> None:
        """One statement, or its guarded stop."""
        known = len(self.output.notes.changed_texts)
        super().statement(statement)
        for text in self.output.notes.changed_texts[known:]:
            self.diagnostics.report(TEXT_CHANGED, statement.origin, text=text)

    def guard(self, statement: ir.Statement, reason: str, code: Code | None = None) -> None:
        on_path = isinstance(statement, ir.Trigger | ir.DefineTrigger) or (
            isinstance(statement, ir.Move) and bool(statement.triggers)
        )
        super().guard(statement, reason, PATH_ACTION if on_path else code)

    def written(self, statement: ir.Statement) -> None:
        match statement:
            case ir.Nothing(origin=origin):
                self.comments_only(origin)
            case ir.Opaque() | ir.Vendor():
                first, *others = self.own_text(statement).splitlines() or [""]
                self.line(first, statement.origin)
                self.more(*others)
            case ir.ClearMotion() | ir.StartMotion() if self.stopped:
                self.comments_only(statement.origin)  # stopj forgets the rest of the path by itself
            case ir.Move(origin=origin):
                words = self.motion.move(statement, not self.output.standing.wanted(self.rest))
                self.line(self.say("move", **words), origin)
            case ir.If() | ir.Switch() | ir.For() | ir.While() | ir.Repeat() | ir.Loop():
                self.block(statement)
            case _:
                self.actions.write(statement)

    # ---- blocks

    def block(self, statement: ir.Statement) -> None:
        origin = statement.origin
        match statement:
            case ir.If(branches=branches, otherwise=otherwise):
                self.branches([(self.expressions.text(c), body) for c, body in branches], otherwise, origin)
            case ir.Switch():
                self.switch(statement)
            case ir.For():
                self.counting(statement)
            case ir.While(condition=condition, body=body):
                self.loop(self.expressions.text(condition), statement, body, ())
            case ir.Repeat(until=until, body=body):
                leave = (f"if {self.expressions.text(until)}:", f"{INDENT}break", "end")
                self.loop("True", statement, body, leave)
            case ir.Loop(body=body):
                self.loop("True", statement, body, ())

    def branches(self, branches: list[tuple[str, ir.Body]], otherwise: ir.Body, origin: Origin) -> None:
        for number, (condition, body) in enumerate(branches):
            head = self.say("branch_head", word="elif" if number else "if", condition=condition)
            self.line(head, None if number else origin)
            self.body(body)
        if otherwise:
            self.word("else:")
            self.body(otherwise)
        self.word("end")

    def loop(
        self, condition: str, statement: ir.While | ir.Repeat | ir.Loop, body: ir.Body, behind: tuple[str, ...]
    ) -> None:
        """`behind`: what is done after each pass, also one that was cut short."""
        self.line(self.say("while_head", condition=condition), statement.origin)
        self.before_next.append(behind)
        self.body(body)
        self.before_next.pop()
        self.depth += 1
        if _polls(statement):
            self.more("sync()")
        self.more(*behind)
        self.depth -= 1
        self.word("end")

    def switch(self, statement: ir.Switch) -> None:
        """The first branch whose value matches; the selector is looked at once."""
        selector = statement.selector
        if not statement.cases:
            raise CannotSayError("a choice without a case")
        if isinstance(selector, ir.Name | ir.IntLiteral) or len(statement.cases) == 1 == len(statement.cases[0].values):
            chosen: ir.Expression = selector
            self.comments_only(statement.origin)
        else:
            self.comments_only(statement.origin)
            chosen = ir.Name(self.temporary("selected", self.expressions.given(selector)))
        branches = []
        for case in statement.cases:
            tests = [self.expressions.text(ir.Binary("=", chosen, value)) for value in case.values]
            branches.append((" or ".join(tests), case.body))
        self.branches(branches, statement.default or (), replace(statement.origin, comments=()))

    def counting(self, loop: ir.For) -> None:
        """A counting loop as a while with its counter; the counter keeps the first value past the end."""
        if loop.scoped or loop.automatic or loop.at_least_once or loop.keeps_last:
            raise CannotSayError("a loop whose counter or first pass follows another language's rule")
        text, counter = self.expressions.text, ir.Name(loop.counter)
        step = 1.0 if loop.step is None else constant_number(loop.step, self.scope)
        self.comments_only(loop.origin)
        stop = self.fixed(loop.stop, f"{loop.counter}_last")
        stride: ir.Expression = ir.IntLiteral(1)
        if loop.step is not None:
            stride = self.fixed(loop.step, f"{loop.counter}_step")
        self.more(f"{loop.counter} = {self.expressions.given(loop.start)}")
        if step is None:
            up = ir.Binary("cand", ir.Binary(">", stride, ir.IntLiteral(0)), ir.Binary("<=", counter, stop))
            down = ir.Binary("cand", ir.Binary("<", stride, ir.IntLiteral(0)), ir.Binary(">=", counter, stop))
            condition = text(ir.Binary("cor", up, down))
        else:
            condition = text(ir.Binary("<=" if step > 0 else ">=", counter, stop))
        onward = f"{loop.counter} = {text(added(counter, stride))}"
        self.line(self.say("while_head", condition=condition))
        self.before_next.append((onward,))
        self.body(loop.body)
        self.before_next.pop()
        self.more(f"{INDENT}{onward}")
        self.word("end")

    def fixed(self, value: ir.Expression, stem: str) -> ir.Expression:
        """A bound that is looked at once: as it stands where it stays the same."""
        if constant_number(value, self.scope) is not None:
            return value
        if isinstance(value, ir.Name) and value.id.lower() not in self.output.uses.assigned:
            return value
        return ir.Name(self.temporary(stem, self.expressions.given(value)))

    def onward(self, last: str) -> None:
        """`continue`, after what its loop does between two passes."""
        if self.before_next:
            self.more(*self.before_next[-1])
        self.more(last)


def _polls(loop: ir.While | ir.Repeat | ir.Loop) -> bool:
    """Does the loop look at signals without ever taking time? The controller wants a pause in each pass then."""
    looks, written = False, set()
    for node in walk(loop):
        match node:
            case ir.Assign(target=ir.Signal() as target):
                written.add(id(target))
            case ir.Signal():
                looks = looks or id(node) not in written
        if isinstance(node, _TIMED):
            return False
    return looks


def _one_line(text: str) -> str:
    return spelling.ascii_text(" ".join(text.split()))
