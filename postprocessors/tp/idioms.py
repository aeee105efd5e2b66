"""Several neutral statements that are one TP instruction: found again and written as the one they were.

Most of these stand only in programs that were read from listings: storing a frame number and selecting the frame behind
it, a FOR that counts in an element of the register array, a move to `P[R[1]]` as a branch for each point.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Protocol

from rpl import ir
from rpl.source import Origin
from rpl.writing.ledger import EmissionLedger
from rpl.writing.statements import CannotSayError

from .assignments import Assignments
from .expressions import Expressions
from .flow import Labels, single_jump
from .lines import Line
from .own import (
    alarm_number,
    is_modal_mark,
    modal_choice,
    modal_condition,
    raw_text,
    table_change,
    table_select,
    without_trunc,
)

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

    def line(self, text: str, origin: Origin | None = None) -> None: ...

    def put(self, lines: list[Line], origin: Origin | None = None) -> None: ...

    def comments_only(self, origin: Origin) -> None: ...

    def inner(self, body: ir.Body) -> None: ...

    def in_force(self, word: str, number: str) -> None: ...

    def selects(self, body: ir.Body) -> bool: ...

    def crossing(self, selects: bool) -> None: ...

    def move(self, move: ir.Move) -> None: ...

    def searching(self, move: ir.Move, label: int, flag: str = "", word: str = "Skip", kept: str = "") -> None: ...

    def limited(self, wait: ir.WaitUntil, label: int, before: str = "") -> None: ...

    def call(self, call: ir.CallRoutine) -> str: ...


@dataclass(slots=True)
class Idioms:
    """Finds idioms at the beginning of a list of statements."""

    printer: Printing

    def take(self, body: ir.Body) -> int:
        """How many statements were written together; 0: there is no idiom here."""
        finders: tuple[Callable[[ir.Body], int], ...] = (
            *(self.frame_number, self.frame_value, self.alarm, self.limited_wait, self.search),
            *(self.condition, self.under_conditions),
            *(self.counting, self.chosen_place, self.rare_options, self.end_of_monitor, self.watched),
        )
        lines = self.printer.lines
        for find in finders:
            kept, depth = len(lines), self.printer.depth
            try:
                count = find(body)
            except CannotSayError:
                count = 0
            if count:
                return count
            del lines[kept:]
            self.printer.depth = depth
        return 0

    def done(self, body: ir.Body, count: int) -> int:
        self.printer.ledger.written(body[0])
        for statement in body[1:count]:
            self.printer.ledger.merged(statement)
        return count

    # ---- frames, alarms

    def frame_number(self, body: ir.Body) -> int:
        """`UFRAME_NUM=2`."""
        match body:
            case (ir.Assign(value=value) as first, second, *_):
                found = table_select(first, second)
                if found is None:
                    return 0
                shown = self.printer.expressions.operand(without_trunc(value))
                self.printer.line(f"{found[0]}_NUM={shown}", first.origin)
                self.printer.in_force(found[0], shown)
                return self.done(body, 2)
        return 0

    def frame_value(self, body: ir.Body) -> int:
        """`UFRAME[2]=PR[5]`."""
        found = table_change(body[0], body[1]) if len(body) > 1 else None
        if found is None:
            return 0
        place, value = found
        word = place.base.id.upper() if isinstance(place.base, ir.Name) else ""
        number = self.printer.expressions.operand(without_trunc(place.indices[0]))
        register = self.printer.assignments.register(value)
        self.printer.line(f"{word}[{number}]={register}", body[0].origin)
        return self.done(body, 2)

    def alarm(self, body: ir.Body) -> int:
        """`UALM[3]` pauses by itself."""
        number = alarm_number(body[0])
        if number is None or len(body) < 2 or body[1] != ir.Halt("stop"):
            return 0
        self.printer.line(f"UALM[{number}]", body[0].origin)
        return self.done(body, 2)

    # ---- outcomes that are a jump

    def private(self, flag: ir.Expression | None) -> bool:
        """Is it a variable that only stands for the outcome, so that no register has to keep it?"""
        return isinstance(flag, ir.Name) and self.printer.expressions.element(flag) is None

    def limited_wait(self, body: ir.Body) -> int:
        """`WAIT DI[1]=ON TIMEOUT,LBL[9]`."""
        jump = single_jump(body[1]) if len(body) > 1 else None
        match body[0]:
            case ir.WaitUntil(timed_out=flag, timeout=limit) as wait if limit is not None and jump is not None:
                if flag != jump[0] or not self.private(flag):
                    return 0
                self.printer.comments_only(body[1].origin)
                self.printer.limited(wait, self.printer.labels.number(jump[1]))
                return self.done(body, 2)
        return 0

    def search(self, body: ir.Body) -> int:
        """`... Skip,LBL[9]`, also with the joints that it stopped at: `Skip,LBL[9],PR[3]=JPOS`."""
        match body[0]:
            case ir.Move(search=ir.Search(hit=hit, found=found)) as move if hit is not None and self.private(hit):
                kept = self.kept_joints(body[1], hit) if len(body) > 2 and found is None else ""
                count = 3 if kept else 2
                jump = single_jump(body[count - 1]) if len(body) >= count else None
                if jump is None or jump[0] not in (hit, ir.Unary("not", hit)):
                    return 0
                word = "SkipJump" if jump[0] == hit else "Skip"
                for statement in body[1:count]:
                    self.printer.comments_only(statement.origin)
                self.printer.searching(move, self.printer.labels.number(jump[1]), word=word, kept=kept)
                return self.done(body, count)
        return 0

    def condition(self, body: ir.Body) -> int:
        """`SKIP CONDITION DI[1]=ON`, one of several that can be in force at a move."""
        if not is_modal_mark(body[0]):
            return 0
        self.printer.line(modal_condition(body[0].origin), body[0].origin)
        return self.done(body, 1)

    def under_conditions(self, body: ir.Body) -> int:
        """A move that several conditions can be in force at: the controller itself knows which one it is."""
        move, text = modal_choice(body[0]), raw_text(body[0].origin)
        if move is None or text is None:
            return 0
        count = self.search((replace(move, origin=body[0].origin), *body[1:])) if isinstance(move, ir.Move) else 0
        if count:
            self.printer.ledger.merged(body[0])
            return count
        count = 1
        while count < len(body) and body[count].origin.start == body[0].origin.start:
            count += 1  # the jump of a Skip
        self.raw(text, *body[:count])
        return count

    def kept_joints(self, statement: ir.Statement, hit: ir.Expression) -> str:
        """`PR[3]=JPOS` where the statement keeps the joints of a search that found something."""
        match statement:
            case ir.If(branches=((condition, (ir.Assign(target=target, value=value),)),), otherwise=()) if (
                condition == hit
            ):
                place = self.printer.expressions.element(target)
                if place is not None and place.startswith("PR[") and _is_joints_now(value):
                    return f"{place}=JPOS"
        return ""

    # ---- loops over the register array

    def counting(self, body: ir.Body) -> int:
        """A FOR whose counter is an element of the register array."""
        match body:
            case (
                ir.Assign(target=ir.Name(id=kept), value=stop) as bound,
                ir.Assign(target=ir.Index() as counter, value=start),
                ir.While() as loop,
                *_,
            ) if kept.startswith("for_bound_"):
                inner = _counted(loop, counter, ir.Name(kept))
                if inner is None:
                    return 0
                self.loop(counter, start, stop, inner, bound)
                self.printer.ledger.merged(body[1])
                self.finish_loop(loop)
                return 3
            case (ir.Assign(target=ir.Index() as counter, value=start) as first, ir.While() as loop, *_):
                match loop.condition:
                    case ir.Binary(right=stop):
                        inner = _counted(loop, counter, stop)
                        if inner is None:
                            return 0
                        self.loop(counter, start, stop, inner, first)
                        self.finish_loop(loop)
                        return 2
        return 0

    def loop(
        self,
        counter: ir.Expression,
        start: ir.Expression,
        stop: ir.Expression,
        inner: tuple[bool, ir.Body],
        first: ir.Assign,
    ) -> None:
        operand = self.printer.expressions.operand
        down, body = inner
        word = "DOWNTO" if down else "TO"
        self.printer.line(f"FOR {operand(counter)}={operand(start)} {word} {operand(stop)}", first.origin)
        self.printer.ledger.written(first)
        selects = self.printer.selects(body)
        self.printer.crossing(selects)
        self.printer.inner(body)
        self.printer.crossing(selects)
        self.printer.line("ENDFOR")

    def finish_loop(self, loop: ir.While) -> None:
        self.printer.ledger.written(loop)
        for statement in loop.body[-2:]:
            self.printer.ledger.merged(statement)

    # ---- instructions that are written as they were read

    def chosen_place(self, body: ir.Body) -> int:
        """`J P[R[1]] 50% FINE`: a branch for each point it can mean, all made of one line that is no SELECT."""
        text = raw_text(body[0].origin)
        if not isinstance(body[0], ir.Switch) or text is None or text.upper().startswith("SELECT"):
            return 0
        self.raw(text, body[0])
        return 1

    def rare_options(self, body: ir.Body) -> int:
        """A move with options that only the controller knows: each stands before it as an instruction of its own."""
        count = 0
        while count < len(body) - 1 and isinstance(body[count], ir.Vendor):
            count += 1
        move = body[count]
        text = raw_text(move.origin)
        if not count or not isinstance(move, ir.Move) or text is None:
            return 0
        if any(body[at].origin.start != move.origin.start for at in range(count)):
            return 0
        count += 1
        while count < len(body) and body[count].origin.start == move.origin.start:
            count += 1  # the jump of a Skip
        self.raw(text, *body[:count])
        return count

    def raw(self, text: str, *statements: ir.Statement) -> None:
        first, *more = [" ".join(part.split()) for part in text.splitlines()]
        shown = first if first.startswith(_MOTION) else f"  {first}"
        further = tuple(f"  {part.lstrip(':').strip()}" for part in more)
        self.printer.put([Line(shown, further)], statements[0].origin)
        for statement in statements:
            self.printer.ledger.merged(statement)

    def watched(self, body: ir.Body) -> int:
        """`WHEN DI[1]=ON,CALL X` of a condition program."""
        match body:
            case (ir.DeclareInterrupt() as watch, ir.ControlInterrupt(op="on", handle=handle), *_):
                if handle != watch.priority or not isinstance(watch.action, ir.CallRoutine):
                    return 0
                disarmed = ir.ControlInterrupt("off", handle)
                at_once = ir.If(((watch.condition, (disarmed, watch.action)),))
                level = len(body) > 2 and body[2] == at_once
                condition = self.printer.expressions.watched(watch.condition)
                if not level:
                    if not condition.endswith("=ON") or " " in condition:
                        return 0
                    condition += "+"
                self.printer.line(f"WHEN {condition},{self.printer.call(watch.action).rstrip()}", watch.origin)
                return self.done(body, 3 if level else 2)
        return 0

    def end_of_monitor(self, body: ir.Body) -> int:
        """`MONITOR END X` switches off all conditions of X."""
        match body[0]:
            case ir.ControlInterrupt(op="off", handle=ir.IntLiteral(value=first)):
                pass
            case _:
                return 0
        known = self.printer.monitors.get(first)
        if known is None:
            return 0
        name, count = known
        wanted = [ir.ControlInterrupt("off", ir.IntLiteral(first + at)) for at in range(count)]
        if list(body[:count]) != wanted:
            return 0
        self.printer.line(f"MONITOR END {name}", body[0].origin)
        return self.done(body, count)


def _counted(loop: ir.While, counter: ir.Expression, stop: ir.Expression) -> tuple[bool, ir.Body] | None:
    """Does it count down, and the body of the FOR; None when the loop is another one."""
    match loop:
        case ir.While(
            condition=ir.Binary(op="<=" | ">=" as within, left=left, right=right),
            body=(*inner, ir.If() as leave, ir.Assign(target=target) as step),
        ):
            down = within == ">="
            wanted = ir.If(((ir.Binary("<=" if down else ">=", counter, stop), (ir.ExitLoop(),)),))
            next_one = ir.Binary("-" if down else "+", counter, ir.IntLiteral(1))
            if left == counter == target and right == stop and leave == wanted and _same(step.value, next_one):
                return down, tuple(inner)
    return None


def _same(value: ir.Expression, wanted: ir.Binary) -> bool:
    """The step; normalising may have widened its one."""
    match value:
        case ir.Binary(op=op, left=left, right=right):
            return (
                op == wanted.op
                and left == wanted.left
                and without_trunc(right) in (ir.IntLiteral(1), ir.RealLiteral(1.0))
            )
    return False


def _is_joints_now(value: ir.Expression) -> bool:
    match value:
        case ir.System(name="actual_joints") | ir.Builtin(function="current_joints", arguments=()):
            return True
    return False
