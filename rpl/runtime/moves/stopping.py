"""Stopping the robot on its path, and going on: a brake, what it drops, the way back, and what is left of the path.

The robot brakes along its path, through a corner and into the next move where that is how far it takes. What is left is
taken up from where it stands: the rest of the move with its corner, or the rest of the corner.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from rpl.runtime.moves import blocks, pieces, resting, searching
from rpl.runtime.moves.orders import Drive
from rpl.runtime.moves.pieces import Corner, Halting, Piece
from rpl.runtime.moves.robotstate import external_of

if TYPE_CHECKING:
    from rpl.emulator.cornerlaws import Stretch
    from rpl.runtime.ports import Robot

# Braking with the emergency ramp is this much stronger than the programmed acceleration.
HARD = 2.0
STANDS = 1e-12


def halt(queue: Robot, hard: bool, ends_move: bool) -> None:
    """Brake on the path; `ends_move`: what is left of the move is dropped when the robot stands."""
    queue.stopped = not ends_move
    resting.ended(queue)
    piece, now = queue.piece, queue.machine.now
    if piece is None:
        if queue.joints is not None:
            queue.left = (queue.joints, queue.external)
        return
    place, speed = pieces.place_of(piece, now)
    how = Halting(hard, ends_move)
    if piece.corner is not None:
        queue.drive(_braking_in_corner(piece.drive, piece.corner, place, speed, how, now))
        return
    if piece.ahead is not None:  # not yet in its corner: when the robot goes on, that is made anew
        piece.drive.blending = True
    queue.drive(_braking(piece, place, speed, how, now))


def arrived(queue: Robot, piece: Piece) -> None:
    """The end of a piece on which the robot brakes: it stands, or brakes on in what follows."""
    assert piece.halting is not None
    how, now = piece.halting, queue.machine.now
    if how.onward <= 0.0:
        _stands(queue, piece, how)
    elif piece.ahead is not None:
        speed = how.onward / piece.ahead.rates[0]
        piece.drive.blending = False
        queue.piece = None
        queue.drive(_braking_in_corner(piece.drive, piece.ahead, 0.0, speed, how, now))
    elif piece.corner is not None:
        corner = piece.corner
        queue.left_corner(piece)
        rest = Piece(corner.following, corner.rest, now)
        speed = how.onward * corner.rates[1]
        queue.drive(_braking(rest, corner.rest.span[0], speed, how, now))


def _braking(piece: Piece, place: float, speed: float, how: Halting, now: float) -> Piece:
    """Brake from a place of a move at a speed (1/s of it), at most to where its corner begins."""
    profile = piece.plan.profile
    strength = profile.down * (HARD if how.hard else 1.0)
    needed = place + speed * speed / (2.0 * strength) if speed > 0.0 else place
    furthest = piece.plan.span[1] if piece.drive.rate is None and not piece.open_end else 1.0
    end, left = min(needed, furthest), 0.0
    if piece.ahead is not None and needed > furthest:
        left = max(speed * speed - 2.0 * strength * (furthest - place), 0.0) ** 0.5
    ramp = replace(profile, deceleration=strength, braking=None, smoothing_s=0.0, stopping_s=0.0)
    driven = piece.plan.part((place, end), ramp.law(place, end, speed, left))
    return Piece(piece.drive, driven, now, ahead=piece.ahead, halting=replace(how, onward=left))


def _braking_in_corner(drive: Drive, corner: Corner, place: float, speed: float, how: Halting, now: float) -> Piece:
    """Brake from a place of a corner at a speed, 1/s of the corner."""
    from rpl.emulator import cornerlaws

    assert drive.plan is not None
    strength = HARD if how.hard else 1.0
    stretch = cornerlaws.braked(corner.plan, place, speed, corner.rates[0], drive.plan, strength)
    return _in_corner(drive, corner, stretch, replace(how, onward=stretch.speed), now)


def _in_corner(drive: Drive, corner: Corner, stretch: Stretch, how: Halting | None, now: float) -> Piece:
    driven = corner.plan.part((stretch.begin, stretch.end), stretch.law)
    return Piece(drive, driven, now, corner=corner, halting=how)


# ---- what happens when it stands


def _stands(queue: Robot, piece: Piece, how: Halting) -> None:
    queue.joints, queue.external = piece.plan.end_joints, external_of(piece, queue.machine.now, queue.external)
    queue.piece = None
    queue.left = (queue.joints, queue.external)
    if how.ends_move:
        _drop(queue, piece)
    else:
        queue.halted, queue.regained = queue.regained or piece, None
    queue.look()


def _drop(queue: Robot, piece: Piece) -> None:
    """What is left of a move is forgotten, in a corner that of both moves. Moves commanded behind it begin anew
    from here, when the interrupt that stopped the robot has ended."""
    queue.show(piece.drive, True, True)
    gone = [piece.drive] if piece.corner is None else [piece.drive, piece.corner.following]
    queue.behind += [drive for drive in queue.queue if drive not in gone]
    queue.queue.clear()
    queue.planned_joints, queue.planned_external = queue.joints, queue.external
    queue.task.busy = False
    for drive in gone:
        if drive.order.search is not None and drive.order.search.early:
            searching.refuse(queue, drive)
            return
    if not queue.task.aside:
        again(queue)


def again(queue: Robot) -> None:
    """Plan the moves anew that were commanded behind a dropped one."""
    behind, queue.behind = queue.behind, []
    for old in behind:
        drives = blocks.planned(queue, blocks.order_of(old), old)
        if isinstance(drives, blocks.Refused):
            queue.fault(drives.fault, drives.order)
            return
        queue.queue += drives
        queue.task.busy = True
        queue.ask()


# ---- going on


def start(queue: Robot) -> None:
    """Go on with a stopped motion; who was moved away meanwhile drives back first."""
    queue.stopped = False
    piece, queue.halted = queue.halted, None
    if piece is not None and queue.model is not None:
        assert queue.joints is not None
        back = pieces.way_back(queue.model, queue.joints, piece, queue.machine.now)
        if back is not None:
            queue.regained = piece
            queue.drive(back)
            return
        take_up(queue, piece)
    queue.ask()


def take_up(queue: Robot, piece: Piece) -> None:
    """Drive what is left of the piece on which the robot was stopped."""
    now, place = queue.machine.now, piece.plan.span[1]
    if piece.corner is not None:
        queue.drive(_rest_of_corner(piece, piece.corner, place, now))
        return
    law = piece.plan.profile.law(place, 1.0, 0.0, 0.0)
    queue.drive(Piece(piece.drive, piece.plan.part((place, 1.0), law), now))
    queue.after_corner(piece.drive)


def _rest_of_corner(piece: Piece, corner: Corner, place: float, now: float) -> Piece:
    """Speed up in the corner; the move behind it begins with the speed that is reached."""
    from rpl.emulator import cornerlaws

    assert piece.drive.plan is not None
    stretch = cornerlaws.taken_up(corner.plan, place, corner.rates[0], piece.drive.plan)
    meet = corner.rest.span[0]
    speed = stretch.speed * corner.rates[1]
    rest = corner.rest.part((meet, 1.0), corner.rest.profile.law(meet, 1.0, speed, 0.0))
    return _in_corner(piece.drive, replace(corner, rest=rest), stretch, None, now)
