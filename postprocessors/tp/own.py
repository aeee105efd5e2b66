"""What only programs read from listings hold: the controller's tables of frames, its wait limit, its alarms.

One TP instruction means several neutral statements there (a number is stored and the frame behind it comes into force);
here it is told what these are (`passes/instructions.py` puts them together).
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from rpl import ir
from rpl.source import Origin

from . import tables

WAIT_LIMIT = "$WAITTMOUT"
_TABLES = {"base": "UFRAME", "tool": "UTOOL"}
_NUMBERED = re.compile(r"\s*\d*\s*:\s*(.*?)\s*;?\s*\Z", re.DOTALL)
_CONDITION = re.compile(r"(?:SKIP|OFFSET|TOOL_OFFSET)\s+CONDITION\b", re.IGNORECASE)
# What the reader calls the numbers of a program's conditions, where more than one can be in force at a move.
MODAL = ("SKIP_CONDITION", "OFFSET_CONDITION", "TOOL_OFFSET_CONDITION")
_NOTED = re.compile(r"([A-Z]+)\[(\d+)\] (.+)")
_ALARM = re.compile(r"UALM\[(\d+)\]")


def table_select(statement: ir.Statement, following: ir.Statement | None) -> tuple[str, ir.Expression] | None:
    """`UFRAME_NUM=2`: the number is stored, then the element of the table is selected."""
    match statement, following:
        case (
            ir.Assign(target=ir.Name(id=number)),
            ir.Assign(target=ir.System(name=system), value=ir.Index(base=ir.Name(id=bank), indices=(index,))),
        ) if system in _TABLES and bank.upper() == _TABLES[system] and number.upper() == f"{bank.upper()}_NUM":
            return bank.upper(), index
    return None


def table_change(statement: ir.Statement, following: ir.Statement | None) -> tuple[ir.Index, ir.Expression] | None:
    """`UFRAME[2]=PR[5]`: an element of the table changes, and at once when it is in force."""
    match statement, following:
        case (
            ir.Assign(target=ir.Index(base=ir.Name(id=bank)) as place, value=value),
            ir.If(branches=((_, (ir.Assign(target=ir.System(name=system), value=again),)),), otherwise=()),
        ) if again == place and _TABLES.get(system) == bank.upper():
            if isinstance(value, ir.Builtin) and value.function == "pose_of":
                (value,) = value.arguments
            return place, value
    return None


class Counted(NamedTuple):
    """A FOR: does it count down, how far, and what stands in it."""

    down: bool
    stop: ir.Expression
    body: ir.Body


def counted_loop(statement: ir.Statement, following: ir.Statement | None) -> Counted | None:
    """A FOR whose counter is an element of the register array: the first value, and a loop that compares and counts."""
    match statement, following:
        case (
            ir.Assign(target=ir.Index() as counter),
            ir.While(
                condition=ir.Binary(op="<=" | ">=" as within, left=left, right=stop),
                body=(*inner, ir.If() as leave, ir.Assign(target=target) as step),
            ),
        ):
            down = within == ">="
            wanted = ir.If(((ir.Binary("<=" if down else ">=", counter, stop), (ir.ExitLoop(),)),))
            next_one = ir.Binary("-" if down else "+", counter, ir.IntLiteral(1))
            if left == counter == target and leave == wanted and _same(step.value, next_one):
                return Counted(down, stop, tuple(inner))
    return None


def _same(value: ir.Expression, wanted: ir.Binary) -> bool:
    """The step; normalising may have widened its one."""
    match value:
        case ir.Binary(op=op, left=left, right=right):
            one = without_trunc(right) in (ir.IntLiteral(1), ir.RealLiteral(1.0))
            return op == wanted.op and left == wanted.left and one
    return False


def parts_apart(body: ir.Body) -> Iterator[ir.Statement]:
    """The statements of a body; those that are put together as one instruction one by one."""
    for statement in body:
        if isinstance(statement, ir.Instruction):
            yield from statement.parts
        else:
            yield statement


def alarm_number(statement: ir.Statement) -> str | None:
    """`UALM[3]`."""
    match statement:
        case ir.Message(kind="error", text=ir.TextLiteral(value=text)):
            found = _ALARM.fullmatch(text)
            return found[1] if found else None
    return None


def is_own_limit(time: ir.Expression) -> bool:
    """Is the limit of a wait the one that the controller has anyway?"""
    match time:
        case ir.Binary(op="/", left=left, right=ir.RealLiteral(value=100.0) | ir.IntLiteral(value=100)):
            return without_trunc(left) == ir.Name(WAIT_LIMIT)
    return False


def raw_text(origin: Origin) -> str | None:
    """The instruction as it stands in the listing, without number and closing sign; None when it was read elsewhere."""
    found = _NUMBERED.match(origin.text)
    return found[1] if found else None


def noted_names(origin: Origin) -> dict[tuple[str, int], str]:
    """The names of registers and signals in the remarks that the reader of listings makes: by bank or kind of signal,
    and number."""
    found: dict[tuple[str, int], str] = {}
    if origin.source is None:
        for remark in origin.comments:
            if parts := _NOTED.fullmatch(remark.text):
                kinds = [kind for kind, word in tables.SIGNALS.items() if word == parts[1]]
                found.update({(kind, int(parts[2])): parts[3] for kind in (kinds or [parts[1]])})
    return found


def from_listing(origin: Origin) -> bool:
    return raw_text(origin) is not None


def modal_condition(origin: Origin) -> str:
    """`SKIP CONDITION DI[5]=ON`: the reader has put it into the moves, and keeps its line as a layout line."""
    text = " ".join((raw_text(origin) or "").split())
    return text if _CONDITION.match(text) else ""


def is_modal_choice(statement: ir.Statement) -> bool:
    """Is it what a listing's move became, one for each condition that can be in force there?"""
    match statement:
        case ir.If(branches=((ir.Binary("=", ir.Name(id=word), ir.IntLiteral()), (_,)), *_), otherwise=(_,)):
            return word.upper() in MODAL and from_listing(statement.origin)
    return False


def is_modal_mark(statement: ir.Statement) -> bool:
    """Does it keep the number of the condition that a line of the listing puts in force?"""
    match statement:
        case ir.Assign(target=ir.Name(id=word), value=ir.IntLiteral()):
            return word.upper() in MODAL and modal_condition(statement.origin) != ""
    return False


def without_trunc(value: ir.Expression) -> ir.Expression:
    while isinstance(value, ir.Convert) and value.how in ("trunc", "real"):
        value = value.operand
    return value


def selects_frame(node: object) -> bool:
    """Does this one statement select a tool or a frame?"""
    match node:
        case ir.Assign(target=ir.System(name=name)):
            return name in _TABLES
        case ir.Move(tool=tool, frame=frame):
            return any(one is not None and not number_in_force(one) for one in (tool, frame))
    return False


def number_in_force(place: ir.Expression) -> str:
    """The number that a move says is in force (`frame_numbers`), as an element of the controller's table."""
    match place:
        case ir.Index(base=ir.Name(id="UTOOL" | "UFRAME"), indices=(ir.IntLiteral(value=number),)):
            return str(number)
    return ""


def leaves_frames(statement: ir.Statement) -> bool:
    """Does it surely neither move nor select a tool or frame, whatever is written for it by hand?"""
    match statement:
        case ir.Assign(target=ir.Name() | ir.Index() | ir.Field() | ir.Signal()):
            return True
    return isinstance(statement, ir.ControlInterrupt | ir.OrderInterrupt | ir.DeclareInterrupt | ir.Pulse | ir.Message)
