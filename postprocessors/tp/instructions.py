"""Instructions of TP that are several neutral statements, put together by the pass of that name: their lines."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

from rpl import ir
from rpl.source import Origin
from rpl.writing.anywhere import Anywhere
from rpl.writing.ledger import EmissionLedger
from rpl.writing.statements import CannotSayError

from .assignments import Assignments
from .expressions import Expressions
from .flow import Labels, single_jump
from .lines import Line
from .own import counted_loop, table_change, table_select, without_trunc

_MOTION = ("J ", "L ", "C ", "A ", "S ")


class Printing(Protocol):
    """What writes the lines of a program (see statements.Printer)."""

    lines: list[Line]
    depth: int
    ledger: EmissionLedger
    expressions: Expressions
    assignments: Assignments
    labels: Labels
    monitors: Mapping[int, tuple[str, int]]
    may_select: Anywhere

    def line(self, text: str, origin: Origin | None = None) -> None: ...

    def put(self, lines: list[Line], origin: Origin | None = None) -> None: ...

    def comments_only(self, origin: Origin) -> None: ...

    def body(self, body: ir.Body) -> None: ...

    def inner(self, body: ir.Body) -> None: ...

    def in_force(self, word: str, number: str) -> None: ...

    def crossing(self, selects: bool) -> None: ...

    def searching(self, move: ir.Move, label: int, flag: str = "", word: str = "Skip", kept: str = "") -> None: ...

    def limited(self, wait: ir.WaitUntil, label: int, before: str = "") -> None: ...

    def call(self, call: ir.CallRoutine) -> str: ...


@dataclass(slots=True)
class Instructions:
    """Writes them through the printer of a program."""

    printer: Printing

    def write(self, instruction: ir.Instruction) -> None:
        """The instruction; its statements one behind the other where it cannot be said after all."""
        printer = self.printer
        kept, depth = len(printer.lines), printer.depth
        try:
            self.together(instruction)
        except CannotSayError:
            del printer.lines[kept:]
            printer.depth = depth
            printer.body(instruction.parts)
            printer.ledger.written(instruction)

    def together(self, instruction: ir.Instruction) -> None:
        match instruction.parts:
            case parts if instruction.text:
                self.given(instruction.text, parts[0].origin)
            case (ir.Assign() as first, ir.While() as loop):
                self.counting(first, loop)
                self.printer.ledger.written(instruction)
                return  # what stands in the loop accounts for itself
            case (ir.Assign() as first, ir.Assign() as second):
                self.frame_number(first, second)
            case (ir.Assign() as first, ir.If() as second):
                self.frame_value(first, second)
            case (ir.WaitUntil() as wait, ir.If() as jump):
                self.limited_wait(wait, jump)
            case (ir.Move() as move, *keeping, ir.If() as jump):
                self.search(move, keeping, jump)
            case (ir.DeclareInterrupt() as watch, _, *at_once):
                self.watched(watch, bool(at_once))
            case _:
                raise CannotSayError("they are no instruction")
        self.printer.ledger.merged(instruction)

    def given(self, text: str, origin: Origin) -> None:
        """An instruction that is written as it was read."""
        first, *more = [" ".join(part.split()) for part in text.splitlines()]
        shown = first if first.startswith(_MOTION) else f"  {first}"
        further = tuple(f"  {part.lstrip(':').strip()}" for part in more)
        self.printer.put([Line(shown, further)], origin)

    def frame_number(self, first: ir.Assign, second: ir.Assign) -> None:
        """`UFRAME_NUM=2`."""
        found = table_select(first, second)
        if found is None:
            raise CannotSayError("they select no frame")
        shown = self.printer.expressions.operand(without_trunc(first.value))
        self.printer.line(f"{found[0]}_NUM={shown}", first.origin)
        self.printer.in_force(found[0], shown)

    def frame_value(self, first: ir.Assign, second: ir.If) -> None:
        """`UFRAME[2]=PR[5]`."""
        found = table_change(first, second)
        if found is None:
            raise CannotSayError("they change no frame")
        place, value = found
        word = place.base.id.upper() if isinstance(place.base, ir.Name) else ""
        number = self.printer.expressions.operand(without_trunc(place.indices[0]))
        register = self.printer.assignments.register(value)
        self.printer.line(f"{word}[{number}]={register}", first.origin)

    def flag(self, flag: ir.Expression | None) -> ir.Expression:
        """A variable that only stands for an outcome which is a jump. A register would have to keep it."""
        if not isinstance(flag, ir.Name) or self.printer.expressions.element(flag) is not None:
            raise CannotSayError("a register keeps the outcome")
        return flag

    def limited_wait(self, wait: ir.WaitUntil, behind: ir.If) -> None:
        """`WAIT DI[1]=ON TIMEOUT,LBL[9]`."""
        self.flag(wait.timed_out)
        label = self.label(behind)[1]
        self.printer.comments_only(behind.origin)
        self.printer.limited(wait, label)

    def search(self, move: ir.Move, keeping: list[ir.Statement], behind: ir.If) -> None:
        """`... Skip,LBL[9]`, also with the joints that it stopped at: `Skip,LBL[9],PR[3]=JPOS`."""
        hit = self.flag(None if move.search is None else move.search.hit)
        kept = "".join(map(self.kept_joints, keeping))
        condition, label = self.label(behind)
        for statement in (*keeping, behind):
            self.printer.comments_only(statement.origin)
        self.printer.searching(move, label, word="SkipJump" if condition == hit else "Skip", kept=kept)

    def label(self, behind: ir.If) -> tuple[ir.Expression, int]:
        """When the program jumps, and where to."""
        jump = single_jump(behind)
        if jump is None:
            raise CannotSayError("no jump follows")
        return jump[0], self.printer.labels.number(jump[1])

    def kept_joints(self, statement: ir.Statement) -> str:
        """`PR[3]=JPOS`."""
        match statement:
            case ir.If(branches=((_, (ir.Assign(target=target),)),)):
                place = self.printer.expressions.element(target)
                if place is not None and place.startswith("PR["):
                    return f"{place}=JPOS"
        raise CannotSayError("joints are kept in a position register")

    def counting(self, first: ir.Assign, loop: ir.While) -> None:
        """A FOR whose counter is an element of the register array."""
        found = counted_loop(first, loop)
        if found is None:
            raise CannotSayError("the loop does not count")
        printer, operand = self.printer, self.printer.expressions.operand
        word = "DOWNTO" if found.down else "TO"
        bounds = f"{operand(first.value)} {word} {operand(found.stop)}"
        printer.line(f"FOR {operand(first.target)}={bounds}", first.origin)
        selects = printer.may_select(found.body)
        printer.crossing(selects)
        printer.inner(found.body)
        printer.crossing(selects)
        printer.line("ENDFOR")
        printer.ledger.written(first)
        printer.ledger.written(loop)
        for statement in loop.body[-2:]:
            printer.ledger.merged(statement)

    def watched(self, watch: ir.DeclareInterrupt, at_once: bool) -> None:
        """`WHEN DI[1]=ON,CALL X` of a condition program."""
        condition = self.printer.expressions.watched(watch.condition)
        if not at_once:
            if not condition.endswith("=ON") or " " in condition:
                raise CannotSayError("only one signal has an edge")
            condition += "+"
        if not isinstance(watch.action, ir.CallRoutine):
            raise CannotSayError("a condition calls a program")
        self.printer.line(f"WHEN {condition},{self.printer.call(watch.action).rstrip()}", watch.origin)
