"""Several neutral statements that are one TP instruction are put together as that one, for the writer to print.

Storing a frame number and selecting the frame behind it is `UFRAME_NUM=2`, a wait with a limit and the jump when it has
passed `WAIT ... TIMEOUT,LBL[9]`. Most of these stand only in programs that were read from listings: a FOR that counts
in an element of the register array, a move to `P[R[1]]` as a branch for each point, a move at which one of several
SKIP CONDITIONs can be in force. An instruction keeps its statements as `parts`; its text stands in it where the
listing or the form alone says it, and is empty where numbers of labels and registers belong to it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.rewriting.editing import edit_all
from rpl.passes.rewrite import rewrite_bodies, same
from rpl.writing.target import WriteContext

from ..facts.programs import monitors_of
from ..flow import single_jump
from ..own import (
    alarm_number,
    counted_loop,
    is_modal_choice,
    is_modal_mark,
    modal_condition,
    raw_text,
    table_change,
    table_select,
)

Monitors = Mapping[int, tuple[str, int]]


def single_instructions(program: ir.Program, context: WriteContext) -> ir.Program:
    """What one instruction of TP says is one statement."""
    monitors = monitors_of(program)

    def written(body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        at = 0
        while at < len(body):
            found = _instruction(body, at, monitors)
            if found is None:
                done.append(rewrite_bodies(body[at], written))
                at += 1
                continue
            at += len(found.parts)
            inner = tuple([rewrite_bodies(one, written) for one in found.parts])
            done.append(found if found.text or same(inner, found.parts) else replace(found, parts=inner))
        return body if same(done, body) else tuple(done)

    return edit_all(program, written)


def _instruction(body: ir.Body, at: int, monitors: Monitors) -> ir.Instruction | None:
    """The instruction that begins here."""
    match body[at]:
        case ir.Message() | ir.Assign() | ir.WaitUntil() | ir.Move() | ir.DeclareInterrupt() as first:
            text, count = _short(first, body[at + 1 : at + 3])
        case ir.If() | ir.Vendor() | ir.Switch():
            text, count = _as_read(body, at)
        case ir.ControlInterrupt():
            text, count = _end_of_monitor(body, at, monitors)
        case _:
            return None
    if not count:
        return None
    return ir.Instruction(text, body[at : at + count], origin=body[at].origin)


def _short(first: ir.Statement, behind: ir.Body) -> tuple[str, int]:
    """The text of an instruction of up to three statements, and how many they are; 0: it is none."""
    second = behind[0] if behind else None
    if is_modal_mark(first):
        return modal_condition(first.origin), 1
    if second is None:
        return "", 0
    number = alarm_number(first)
    if number is not None:  # UALM pauses by itself
        return f"UALM[{number}]", 2 if second == ir.Halt("stop") else 0
    two = table_select(first, second) or table_change(first, second) or counted_loop(first, second)
    if two or _limited_wait(first, second):
        return "", 2
    return "", _search(first, behind) or _watch(first, behind)


def _limited_wait(first: ir.Statement, second: ir.Statement) -> bool:
    """`WAIT DI[1]=ON TIMEOUT,LBL[9]`: does the flag of a wait with a limit decide about the jump behind it?"""
    jump = single_jump(second)
    match first:
        case ir.WaitUntil(timed_out=flag, timeout=limit) if limit is not None and flag is not None:
            return jump is not None and jump[0] == flag
    return False


def _search(first: ir.Statement, behind: ir.Body) -> int:
    """`... Skip,LBL[9]`, also with the joints that it stopped at: `Skip,LBL[9],PR[3]=JPOS`."""
    match first:
        case ir.Move(search=ir.Search(hit=hit, found=found)) if hit is not None:
            kept = len(behind) > 1 and found is None and _keeps_joints(behind[0], hit)
            jump = single_jump(behind[1 if kept else 0])
            return (3 if kept else 2) if jump is not None and jump[0] in (hit, ir.Unary("not", hit)) else 0
    return 0


def _keeps_joints(statement: ir.Statement, hit: ir.Expression) -> bool:
    """Does the statement keep the joints of a search that found something?"""
    match statement:
        case (
            ir.If(branches=((condition, (ir.Assign(value=ir.System(name="actual_joints")),)),), otherwise=())
            | ir.If(
                branches=((condition, (ir.Assign(value=ir.Builtin(function="current_joints", arguments=())),)),),
                otherwise=(),
            )
        ):
            return condition == hit
    return False


def _watch(first: ir.Statement, behind: ir.Body) -> int:
    """`WHEN DI[1]=ON,CALL X` of a condition program: a condition that is armed; one that holds already acts at once."""
    match first, behind:
        case ir.DeclareInterrupt() as watch, (ir.ControlInterrupt(op="on", handle=handle), *more):
            if handle != watch.priority or not isinstance(watch.action, ir.CallRoutine):
                return 0
            at_once = ir.If(((watch.condition, (ir.ControlInterrupt("off", handle), watch.action)),))
            return 3 if more[:1] == [at_once] else 2
    return 0


def _end_of_monitor(body: ir.Body, at: int, monitors: Monitors) -> tuple[str, int]:
    """`MONITOR END X` switches off all conditions of X."""
    match body[at]:
        case ir.ControlInterrupt(op="off", handle=ir.IntLiteral(value=first)) if first in monitors:
            name, count = monitors[first]
            wanted = tuple(ir.ControlInterrupt("off", ir.IntLiteral(first + one)) for one in range(count))
            return f"MONITOR END {name}", count if body[at : at + count] == wanted else 0
    return "", 0


def _as_read(body: ir.Body, at: int) -> tuple[str, int]:
    """A line of a listing that the controller itself makes the choice of, or whose options only it knows:
    `J P[R[1]] 50% FINE`, a branch for each point it can mean, all made of one line that is no SELECT; a move that
    several conditions can be in force at; a move with options that stand in front of it as instructions."""
    text = raw_text(body[at].origin)
    if text is None:
        return "", 0
    end = at
    match body[at]:
        case ir.Switch():
            return text, 0 if text.upper().startswith("SELECT") else 1
        case ir.If() as choice if not is_modal_choice(choice):
            return "", 0
        case ir.Vendor():
            while end < len(body) and isinstance(body[end], ir.Vendor) and _one_line(body[at], body[end]):
                end += 1
            if end == len(body) or not isinstance(body[end], ir.Move) or not _one_line(body[at], body[end]):
                return "", 0
    end += 1
    while end < len(body) and _one_line(body[at], body[end]):
        end += 1  # the jump of a Skip
    return text, end - at


def _one_line(one: ir.Statement, other: ir.Statement) -> bool:
    """Were both read from one line?"""
    return one.origin.source is other.origin.source and one.origin.start == other.origin.start


__all__ = ["single_instructions"]
