"""Searches: a condition that is watched while a move is driven, and what happens when it comes, or does not."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpl.runtime.faults import ProgramError
from rpl.runtime.moves.orders import Drive, SearchOrder

if TYPE_CHECKING:
    from rpl.runtime.ports import Robot


def watch(robot: Robot, drive: Drive) -> None:
    """A move begins: look at what it searches."""
    search = drive.order.search
    if search is None:
        return
    search.last = bool(search.condition(search.values))
    if search.hit is not None:
        search.hit(search.values, False)
        if search.last == (search.edge == "rising"):  # true already: the move ends before it begins
            search.found = True
            search.hit(search.values, True)
        return
    if search.edge != "either" and search.last == (search.edge == "rising") and search.stop != "none":
        if robot.piece is not None:  # the robot drives already, through a corner: it brakes first
            search.early = True
            robot.halt(False, True)
            return
        robot.queue.remove(drive)
        robot.task.busy = bool(robot.queue)
        robot.planned_joints, robot.planned_external = robot.joints, robot.external
        refuse(robot, drive)


def refuse(robot: Robot, drive: Drive) -> None:
    """What is searched was there before the search; the robot stands."""
    robot.task.fail(ProgramError("search_already", "the searched signal is there before the search"), drive.order.at)
    robot.machine.ready(robot.task)


def end_if_found(robot: Robot, drive: Drive) -> None:
    """What is searched was there when the move began: it ends at once."""
    if drive.order.search is not None and drive.order.search.found:
        _reached(robot, drive, drive.order.search)


def look(robot: Robot) -> None:
    """Something changed: is it what the present move searches?"""
    piece = robot.piece
    if piece is None or piece.halting is not None:
        return
    drive = piece.drive
    if piece.corner is not None and drive not in robot.queue:  # behind the corner's middle the next move counts
        drive = piece.corner.following
    search = drive.order.search
    if search is None or search.found:
        return
    now = bool(search.condition(search.values))
    before, search.last = search.last, now
    if now == before or (search.edge == "rising" and not now) or (search.edge == "falling" and now):
        return
    search.found = True
    if search.hit is not None:
        search.hit(search.values, True)
    _reached(robot, drive, search)


def missed(robot: Robot, drive: Drive) -> None:
    """The move has ended without it."""
    robot.task.fail(ProgramError("search_missed", "the search has found nothing"), drive.order.at)
    robot.machine.ready(robot.task)


def _reached(robot: Robot, drive: Drive, search: SearchOrder) -> None:
    """What was searched has come: keep the place and stop as the program asks."""
    order = drive.order
    if search.write is not None:
        search.write(search.values, robot.target_now(order.tool, order.frame, order.rules))
    if search.stop != "none" and robot.piece is not None:
        robot.halt(search.stop == "stop", True)
