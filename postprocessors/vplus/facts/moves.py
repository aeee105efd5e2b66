"""What a move says that V+ has no place for, and what becomes of the gripper's solenoids in front of one."""

from __future__ import annotations

from rpl import ir

from .. import tables


def lacking(move: ir.Move) -> str:
    """What V+ cannot say of the move; empty where it can, as far as its settings show."""
    for what, found in (
        ("a circle by its angle", move.swept),
        ("a tool of its own", move.tool),
        ("a load of its own", move.load),
        ("an orientation rule of its own", move.orientation not in (None, "variable")),
        ("actions on its path", move.triggers),
        ("a search", move.search),
        ("a motion group", move.group != 1),
        ("spline blocks", move.motion_class == "spline"),
    ):
        if found:
            return what
    return ""


def hand(body: ir.Body) -> str:
    """OPEN, CLOSE or RELAX at the head of a body: both solenoids of the hand switch when the next move begins."""
    states: dict[int, bool] = {}
    for statement in body[:2]:
        match statement:
            case ir.Trigger(
                reference="start",
                action=ir.Assign(
                    target=ir.Signal(kind="digital_out", index=ir.IntLiteral(value=number)),
                    value=ir.BoolLiteral(value=on),
                ),
                distance=None,
                delay=None,
            ):
                states[number] = on
    if set(states) != {tables.HAND_OPEN, tables.HAND_CLOSE}:
        return ""
    if states[tables.HAND_OPEN]:
        return "OPEN"
    return "CLOSE" if states[tables.HAND_CLOSE] else "RELAX"


__all__ = ["hand", "lacking"]
