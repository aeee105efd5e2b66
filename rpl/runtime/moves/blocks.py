"""Spline blocks in the motion queue: all points of a block are known before the robot begins it, and each smooth run of
it is one move. In the trace every segment is a move of its own, which begins and ends on the way.

A block that the emulator has no curve for (a search in it, joints in a carried frame, points of several
tools or carried frames) is refused with the line of its point.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from rpl.passes import rigid
from rpl.runtime.moves import leftout
from rpl.runtime.moves.chain import Planning, request_of
from rpl.runtime.moves.orders import BlendOrder, Drive, Order, PathRuleOrder, TriggerOrder
from rpl.runtime.moves.pathevents import SMALL
from rpl.runtime.moves.pieces import Piece
from rpl.runtime.moves.programmed import programmed_of
from rpl.runtime.moves.ranges import outside

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel
    from rpl.emulator.planner import MotionFault, MoveRequest, PlannedMove
    from rpl.emulator.rotations import FloatArray
    from rpl.emulator.splinerules import BlockRule
    from rpl.emulator.splines import Kind, Run
    from rpl.runtime.ports import Robot

_STOP = BlendOrder("stop")
_KINDS: dict[str, Kind] = {"joint": "joint", "linear": "linear", "circular": "circular"}
# A tool that is moved by less than this (mm, and as elements of its rotation) is the same.
_SAME_TOOL = 1e-9


@dataclass(frozen=True, slots=True)
class Refused:
    """Why a move or a segment of a block cannot be driven."""

    fault: MotionFault
    order: Order


@dataclass(frozen=True, slots=True)
class _Asked:
    """A segment as it is asked for: the request, the moving point in the flange, the goal in the segment's frame and
    the external axes behind it."""

    order: Order
    request: MoveRequest
    moving: rigid.Pose
    goal: rigid.Pose
    external: tuple[float | None, ...]


def planned(queue: Robot, order: Order, old: Drive | None = None) -> list[Drive] | Refused:
    """What is driven for a move, or for the block that ends with it, from where everything commanded before ends.
    `old`: a drive that is planned anew and keeps its number. Nothing for a move that the controller leaves out."""
    for one in (*order.block, order):
        fault = outside(one)
        if fault is not None:
            return Refused(fault, one)
    if order.block or order.path_rules:
        for one in order.block:
            one.payloads = order.payloads
        asked = [*_asked(queue, (*order.block, order))]
        refused = _no_curve(asked)
        return refused if refused is not None else _runs(queue, asked)
    stood = queue.planned_joints, queue.planned_external
    drive = queue.plan_order(order, old.number if old is not None else _number(queue))
    if old is None and isinstance(drive, Drive) and leftout.is_left_out(queue, drive):
        queue.planned_joints, queue.planned_external = stood
        return []
    return [drive] if isinstance(drive, Drive) else Refused(drive, order)


def order_of(drive: Drive) -> Order:
    """What the program asked for to get this drive."""
    if not drive.orders:
        return drive.order
    return replace(drive.orders[-1], block=drive.orders[:-1], blend=drive.order.blend)


def _number(queue: Robot) -> int:
    queue.numbers += 1
    return queue.numbers


def _asked(queue: Robot, orders: Sequence[Order]) -> list[_Asked]:
    """The requests of a block, each from about where the one before ends."""
    assert queue.model is not None and queue.planned_joints is not None  # with a model there are joints
    done = []
    joints, external = queue.planned_joints, queue.planned_external
    for order in orders:
        notation = queue.machine.linked.notation(order.rules.name)
        controller = queue.controller_of(order.rules)
        plan = Planning(queue.model, joints, external, queue.task.modal, notation, controller)
        request, moving, goal, external = request_of(order, plan)
        order.programmed = programmed_of(order, request, plan, None)
        done.append(_Asked(order, request, moving, goal, external))
        joints = _behind(queue.model, request, joints)
    return done


def _behind(model: RobotModel, request: MoveRequest, joints: FloatArray) -> FloatArray:
    """About the joints behind a segment; where it cannot be reached, planning will say so."""
    from rpl.emulator.paths import arc_through
    from rpl.emulator.rotations import invert_pose

    if request.target_joints is not None:
        return request.target_joints
    pose = request.target_pose
    assert pose is not None  # a request has one of them
    if request.swept_deg is not None and request.via_pose is not None:
        start = model.forward(joints) @ request.tool
        arc = arc_through(start, request.via_pose, pose, swept_deg=request.swept_deg)
        if arc is not None:
            pose = arc.poses(1.0)
    flange = pose @ invert_pose(request.tool)
    chosen = request.select(flange, joints).joints if request.select is not None else model.nearest(flange, joints)
    return chosen if chosen is not None else joints


def _no_curve(asked: Sequence[_Asked]) -> Refused | None:
    """What of a block no curve is known for: it is refused, with the point where it begins to be so."""
    from rpl.emulator.planner import MotionFault

    first = asked[0].request
    for one in asked:
        why = ""
        carrier = one.request.carrier
        if one.order.search is not None:
            why = "a search"
        elif carrier is not None and one.order.kind == "joint":
            why = "joint motions in a frame that moves or with a tool fixed in the room"
        elif abs(one.request.tool - first.tool).max() > _SAME_TOOL:
            why = "another tool than its first point"
        elif (carrier is None) != (first.carrier is None) or (
            carrier is not None and first.carrier is not None and not carrier.same_work(first.carrier)
        ):
            why = "another carried frame than its first point"
        if why:
            return Refused(MotionFault("no_curve", f"a spline block has no curve for {why}"), one.order)
    return None


def _runs(queue: Robot, asked: Sequence[_Asked]) -> list[Drive] | Refused:
    from rpl.emulator.splines import BlockFault, plan_block

    kinds = [_KINDS.get(one.order.kind, "spline") for one in asked]
    mean = asked[0].order.rules.mean_parabolas
    assert queue.model is not None and queue.planned_joints is not None  # with a model there are joints
    found = plan_block(queue.model, queue.planned_joints, [one.request for one in asked], kinds, _rules(asked), mean)
    if isinstance(found, BlockFault):
        return Refused(found.fault, asked[found.segment].order)
    done: list[Drive] = []
    before = 0
    for run in found:
        part = asked[before : before + len(run.marks)]
        before += len(run.marks)
        rules = _within(asked[-1].order.path_rules, before - len(part), before)
        done.append(_drive(queue, run, part, before == len(asked), rules))
    queue.planned_joints, queue.planned_external = found[-1].move.end_joints, asked[-1].external
    return done


def _rules(asked: Sequence[_Asked]) -> list[BlockRule]:
    """What the program says of the speeds in a block, as the emulator takes it."""
    from rpl.emulator.splinerules import BlockRule

    return [BlockRule(one.at, one.rule, one.value, one.reference) for one in asked[-1].order.path_rules]


def _within(rules: Sequence[PathRuleOrder], first: int, last: int) -> tuple[PathRuleOrder, ...]:
    """Those of a block that stand in one of its runs, counted from there."""
    return tuple(replace(one, at=one.at - first) for one in rules if first <= one.at <= last)


def _drive(queue: Robot, run: Run, asked: Sequence[_Asked], last: bool, rules: tuple[PathRuleOrder, ...]) -> Drive:
    """One run of a block: a single move with the triggers of all its segments, and the rules about its speeds."""
    orders, end = tuple(replace(one.order, block=(), path_rules=()) for one in asked), asked[-1]
    orders = (*orders[:-1], replace(orders[-1], path_rules=rules))
    blend = end.order.blend if last else _STOP
    order = replace(orders[-1], blend=blend, triggers=_triggers(run.move, run.marks, orders))
    drive = Drive(_number(queue), order, run.move, end.moving, end.goal, end.external)
    drive.orders, drive.marks = orders, run.marks[:-1]
    drive.blending = not blend.stops
    return drive


def _triggers(move: PlannedMove, marks: Sequence[float], orders: Sequence[Order]) -> list[TriggerOrder]:
    """The triggers of the segments, measured along the whole run; beyond its ends they come at these (M)."""
    import numpy as np

    ways = move.geometry.distance(np.array([0.0, *marks]))
    whole = float(ways[-1])
    done = []
    for number, order in enumerate(orders):
        for trigger in order.triggers:
            begins = trigger.reference == "start"
            place = float(ways[number] if begins else ways[number + 1]) + (trigger.distance or 0.0)
            moved = trigger.copy()
            moved.reference, moved.distance = "start", place
            if place <= SMALL:
                moved.distance = None
            elif place >= whole - SMALL:
                moved.reference, moved.distance = trigger.reference if not begins else "end", None
            done.append(moved)
    return done


# ---- on the way


def look_ahead(queue: Robot, piece: Piece) -> None:
    """Schedule the next point of the block on the piece that is driven."""
    drive = piece.drive
    if drive.passed >= len(drive.marks) or piece.corner is not None:
        return
    begin, end = piece.plan.span
    mark = drive.marks[drive.passed]
    if mark > end - SMALL or end <= begin:  # a point at the very end is passed with it
        return
    share = max((mark - begin) / (end - begin), 0.0)
    due = piece.start_s + float(piece.plan.law.time_of(share))
    queue.schedule(max(due, queue.machine.now), "point")


def passed(queue: Robot) -> None:
    """The robot is at a point of the block and goes on."""
    piece = queue.piece
    if piece is None or piece.drive.passed >= len(piece.drive.marks):
        return
    queue.close_leg(piece, queue.machine.now)
    _pass(queue, piece.drive)
    look_ahead(queue, piece)


def pass_rest(queue: Robot, drive: Drive) -> None:
    """Points at the end of a run that are no way from each other are passed with it."""
    legs = drive.legs
    drive.legs = []
    while drive.passed < len(drive.marks):
        _pass(queue, drive)
    drive.legs = legs


def _pass(queue: Robot, drive: Drive) -> None:
    import numpy as np

    assert drive.plan is not None
    joints = drive.plan.geometry.joints(np.array([drive.marks[drive.passed]]))[0]
    queue.show(drive, False, joints=joints)
    drive.legs = []
    drive.started_s = queue.machine.now
    drive.passed += 1


__all__ = ["Refused", "look_ahead", "order_of", "passed", "pass_rest", "planned"]
