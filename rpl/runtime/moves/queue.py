"""The motion queue of one robot: the second process, behind which the program pointer runs ahead.

Moves are planned when they are commanded, from where the move before them ends, and driven one after the other; a move
that blends is joined with the next one as soon as that is known, from wherever the robot then is. A move that blends
into a move not yet known is driven as if it would go on, until the program had its last chance to say how.
Without a robot every move is made at once.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpl.runtime.faults import ProgramError
from rpl.runtime.moves import (
    blocks,
    latecorners,
    pathevents,
    pieces,
    resting,
    searching,
    servoing,
    stopping,
    together,
    velocities,
)
from rpl.runtime.moves.chain import Planning, pose_of_array, request_of
from rpl.runtime.moves.orders import Drive, Order, TriggerOrder
from rpl.runtime.moves.payloads import payloads_of
from rpl.runtime.moves.pieces import Piece, Stored
from rpl.runtime.moves.programmed import programmed_of
from rpl.runtime.moves.robotstate import RobotState
from rpl.runtime.moves.scene import External
from rpl.runtime.trace import Leg
from rpl.runtime.values import Value

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel
    from rpl.emulator.planner import MotionFault
    from rpl.emulator.rotations import FloatArray
    from rpl.runtime.ports import Machine

ARRIVALS, MOTION = 1, 4  # phases of a moment, see machine
MOST_CONCURRENT = 5


class MotionQueue(RobotState):
    """Queue, robot state and what is driven now. `joints` (n,) and `external` are where it stands; `planned_...` where
    it will stand when everything commanded is done."""

    def __init__(self, machine: Machine, task_index: int, model: RobotModel | None) -> None:
        super().__init__(machine, task_index, model)
        self.planned_joints = self.joints
        self.planned_external = self.external
        self.queue: list[Drive] = []
        self.halted: Piece | None = None
        self.stopped = False
        self.stored: list[Stored] = []
        self.behind: list[Drive] = []
        self.set_aside = False
        self.regained: Piece | None = None
        self.failed: tuple[MotionFault, Order] | None = None
        self.generation = 0
        self.numbers = 0
        self.asked = False
        self.late: dict[int, TriggerOrder] = {}
        self.stood_s = -1.0  # when a move ended at rest last
        self.left: tuple[FloatArray, External] | None = None  # where it stopped on a path

    # ---- what the program asks

    def submit(self, order: Order, next: int) -> int:
        """Plan a move, queue it, and say how the program goes on."""
        task = self.task
        together.check(task, order)
        if order.kind == "joint" and order.rules.triggers.on_paths_only and any(t.distance for t in order.triggers):
            raise ProgramError("motion", "an action at a distance along the path needs a path: this is a joint move")
        if order.velocity:
            return velocities.go(self, order, next)
        if order.servo and self.model is not None:
            return servoing.go(self, order, next)
        if velocities.is_endless(self):
            velocities.let_rest(self)
            return task.wait_for("idle", order.at, order.at)
        if self.resting:
            return task.wait_for("idle", order.at, order.at)
        if order.tool is not None:
            task.modal["tool_in_use"], task.modal["frame_in_use"] = order.tool, order.frame
        if self.model is None:
            return self.imagined.make(self, order, next)
        order.payloads = payloads_of(order, task.modal, self.machine)
        if self.failed is not None:
            return task.wait_for("idle", order.at, next)
        if self.stopped and task.aside and order.rules.advance.runs_ahead_of == "all":
            self.store()
            self.set_aside = True
        drives = blocks.planned(self, order)
        if isinstance(drives, blocks.Refused):
            return self.refuse(drives.fault, drives.order, next)
        if not drives:
            return next
        self.queue += drives
        task.busy = True
        self.ask()
        return self._go_on(drives[-1], next)

    def plan_order(self, order: Order, number: int) -> Drive | MotionFault:
        """The move as it is driven from where everything commanded before it ends."""
        assert self.model is not None and self.planned_joints is not None  # with a model there are joints
        notation = self.machine.linked.notation(order.rules.name)
        plan = Planning(
            self.model,
            self.planned_joints,
            self.planned_external,
            self.task.modal,
            notation,
            self.controller_of(order.rules),
            self.machine.scene,
        )
        request, moving, goal, external = request_of(order, plan)
        planned = pieces.plan(self.model, self.planned_joints, request)
        if pieces.is_fault(planned):
            return planned
        assert pieces.is_planned(planned)  # it is either
        order.programmed = programmed_of(order, request, plan, planned)
        self.planned_joints, self.planned_external = planned.end_joints, external
        drive = Drive(number, order, planned, moving, goal, external)
        drive.blending = order.search is None and pieces.may_blend(order.blend, planned)
        drive.sliding = self.machine.scene.sliding()
        return drive

    def refuse(self, fault: MotionFault, order: Order, next: int) -> int:
        """The controller drives what it has and then stops with the error, unless a routine of the task takes it."""
        if self.task.error_routine is not None:
            raise ProgramError(fault.kind, fault.message)
        if not self.task.busy:
            self.fault(fault, order)
            return self.task.wait_for("released", order.at, next, -1)
        self.failed = (fault, order)
        return self.task.wait_for("idle", order.at, next)

    def fault(self, fault: MotionFault, order: Order) -> None:
        self.machine.fault(fault.kind.replace("_", "-"), fault.message, self.task, order.code.origin(order.at))

    def _go_on(self, drive: Drive, next: int) -> int:
        task, order = self.task, drive.order
        advance = order.rules.advance
        if order.search is not None:
            return task.wait_for("idle", order.at, next)
        if order.concurrent:
            return next if len(self.queue) <= MOST_CONCURRENT else task.wait_for("room", order.at, next)
        if advance.runs_ahead_of == "fly_by":
            if order.blend.stops:
                return task.wait_for("idle", order.at, next)
            return task.wait_for("released", order.at, next, drive.number)
        if self.most_ahead() == 0 or task.aside:
            return task.wait_for("idle", order.at, next)
        if advance.runs_ahead_of == "begun":
            return task.wait_for("released", order.at, next, drive.number)
        return next

    def most_ahead(self) -> int:
        """How many moves the program pointer may be ahead."""
        rules = self.task.frame.code.rules.advance
        set_by_program = self.task.modal.get("advance")
        if set_by_program is None:
            return rules.moves
        return min(int(set_by_program), rules.most) if rules.most else int(set_by_program)

    def pending(self) -> int:
        """Moves commanded and not yet done."""
        return len(self.queue) + len(self.behind)

    def has_room(self) -> bool:
        """May another move be commanded?"""
        return self.pending() <= max(self.most_ahead(), 0) or not self.task.busy

    def has_released(self, number: int) -> bool:
        """Does the move let the program go on?"""
        if number < 0:
            return False
        for drive in (*self.queue, *self.behind):
            if drive.number == number:
                return drive.released
        return True

    def is_standing(self) -> bool:
        return self.piece is None

    def is_stopped(self) -> bool:
        """Was the motion stopped, and does the robot stand?"""
        return self.stopped and self.piece is None

    # ---- driving

    def ask(self) -> None:
        """Look at the queue when all tasks have done what they do at this moment."""
        if not self.asked:
            self.ask_at(self.machine.now)

    def happen(self, what: str, *data: int) -> None:
        """An event of the agenda."""
        match what:
            case "consider":
                self.asked = False
                self._consider()
            case "late":
                self.machine.timed_outputs -= 1
                self.fire(self.late.pop(data[0]))
            case _ if data[0] != self.generation:
                return  # of a plan that has been replaced
            case "arrive":
                self._arrived()
            case "release":
                self._release()
            case "rested":
                resting.ended(self)
            case "middle":
                self._passed()
            case "point":
                blocks.passed(self)
            case "fire":
                self._fire_number(data[1], data[2])

    def _consider(self) -> None:
        """Start what can start; join the present move with the next one, or let it come to rest."""
        if self.stopped:
            return
        if self.piece is None:
            if self.queue and together.begins(self, self.queue[0]):
                self._begin(self.queue[0])
            return
        piece = self.piece
        if piece.corner is not None or piece.ahead is not None or piece.halting or not piece.drive.blending:
            return
        following = self._after(piece.drive)
        if following is not None:
            self._join(piece, following)
        elif piece.open_end and piece.drive.released:
            latecorners.tell(self, piece.drive)
            self._settle(piece)

    def ask_at(self, time_s: float) -> None:
        """Look at the queue then."""
        self.asked = True
        self.machine.schedule(time_s, MOTION, "motion", self.task_index, "consider", 0)

    def _after(self, drive: Drive) -> Drive | None:
        place = self.queue.index(drive) + 1
        return self.queue[place] if place < len(self.queue) else None

    def _begin(self, drive: Drive) -> None:
        """Start a move from rest."""
        assert drive.plan is not None
        drive.started_s = self.machine.now
        searching.watch(self, drive)
        self.drive(Piece(drive, drive.plan, self.machine.now))
        searching.end_if_found(self, drive)
        piece = self.piece
        if piece is None or not drive.blending:
            return
        following = self._after(drive)
        if following is not None:
            self._join(piece, following)
        elif drive.order.rules.advance.runs_ahead_of == "fly_by":
            self.drive(pieces.open_ended(piece, self.machine.now))

    def _join(self, piece: Piece, following: Drive) -> None:
        """Make a corner out of the rest of this move and the next one, if they allow it."""
        assert self.model is not None
        joined = pieces.joined(self.model, piece, following, self.machine.now)
        piece.drive.blending = False
        if joined is None:
            self._settle(piece)
        else:
            self.drive(joined)

    def _settle(self, piece: Piece) -> None:
        """Come to rest at the end of the move after all."""
        piece.drive.blending = False
        if piece.open_end:
            self.drive(pieces.to_the_end(piece, self.machine.now))

    def drive(self, piece: Piece) -> None:
        """From now on this piece is driven; schedule all that happens on it."""
        now = self.machine.now
        if self.piece is not None and self.piece.drive is piece.drive:
            self.close_leg(self.piece, now)
        self.piece = piece
        self.generation += 1
        self.schedule(piece.end_s, "arrive")
        if self.machine.bodies is not None:
            self.machine.bodies.begins(now, piece.end_s)
        drive = piece.drive
        if self.regained is not None:
            return  # on the way back to the path nothing of the move happens
        self._begun(drive if piece.corner is None else piece.corner.following)
        if piece.halting is None and not drive.released:
            self._schedule_release(piece)
        if piece.corner is not None:
            middle = pathevents.middle_of(piece)
            if middle is not None:
                self.schedule(middle, "middle")
            piece.corner.following.entered = piece.corner.entered
            self._schedule_triggers(piece, piece.corner.following)
        blocks.look_ahead(self, piece)
        self._schedule_triggers(piece, drive)

    def _schedule_triggers(self, piece: Piece, drive: Drive) -> None:
        """The actions of a move that happen on this piece, as far as can be told now."""
        for place, trigger in enumerate(drive.order.triggers):
            if not trigger.fired:
                trigger.due = pathevents.due_of(piece, drive, trigger)
                if trigger.due is not None:
                    self.schedule(max(self.machine.now, trigger.due), "fire", drive.number, place)

    def _schedule_release(self, piece: Piece) -> None:
        """When the program may go on behind a move that blends."""
        now, drive = self.machine.now, piece.drive
        advance = drive.order.rules.advance
        if drive.blending or piece.ahead is not None:
            if advance.runs_ahead_of == "fly_by":
                # Past the place where its corner would begin already: the next move is asked for at once.
                leaves_s = pieces.leaves_s(piece) if piece.open_end or piece.ahead is not None else now
                self.schedule(max(now, leaves_s - advance.lead_s), "release")
        elif not drive.order.blend.stops:
            self.schedule(max(now, piece.end_s - advance.lead_s), "release")

    def _begun(self, drive: Drive) -> None:
        """A move is driven, or the corner into it: its program may go on where the language waits for that."""
        if drive.order.rules.advance.runs_ahead_of == "begun" and not drive.released:
            drive.released = True
            self.look()

    def schedule(self, time: float, what: str, *data: int) -> None:
        self.machine.schedule(time, ARRIVALS, "motion", self.task_index, what, self.generation, *data)

    def close_leg(self, piece: Piece, now: float) -> None:
        """What has been driven of the piece until now is a leg of its move in the trace."""
        begin, done = piece.start_s + piece.shown_s, piece.shown_s
        if now > begin or piece.plan.duration_s == 0.0:
            piece.drive.legs.append(Leg(piece.plan, begin, min(now, piece.end_s) - begin, done))
            piece.shown_s = max(min(now, piece.end_s) - piece.start_s, done)

    def _arrived(self) -> None:
        """The end of the piece that is driven."""
        piece = self.piece
        assert piece is not None
        now = self.machine.now
        if piece.open_end and not piece.drive.released:
            self._release()  # the program's last chance, at this moment, to say how to go on
            return
        if velocities.is_endless(self):
            velocities.go_on(self, piece)
            return
        self.close_leg(piece, now)
        if piece.halting is not None:
            stopping.arrived(self, piece)
            return
        if self.regained is not None:
            taken, self.regained = self.regained, None
            self.joints, self.piece = piece.plan.end_joints, None
            stopping.take_up(self, taken)
            return
        if piece.ahead is not None:
            self.piece = None
            self.drive(pieces.corner_piece(piece, now))
            return
        if piece.corner is not None:
            following, rest = piece.corner.following, piece.corner.rest
            self.left_corner(piece)
            self.drive(Piece(following, rest, now))
            self.after_corner(following)
            return
        if piece.open_end:
            latecorners.tell(self, piece.drive)
            piece.drive.blending = False
            self.piece = None
            self.drive(pieces.to_the_end(piece, now))
            return
        self.joints, self.external = piece.plan.end_joints, piece.drive.external
        self.piece, self.stood_s = None, now
        self.done(piece.drive, True)
        if self.queue and not self.stopped:
            self.ask()

    def left_corner(self, piece: Piece) -> None:
        """The end of a corner: the move before it has been made, the next one is driven."""
        assert piece.corner is not None
        corner, following = piece.corner, piece.corner.following
        rules = piece.drive.order.rules.triggers
        for trigger in piece.drive.order.triggers if rules.passes_points else ():
            behind = None if trigger.fired else pathevents.carried(piece.drive, trigger, corner)
            if behind is not None:
                trigger.fired = True
                following.order.triggers.append(behind)
        self.done(piece.drive, False)
        following.started_s = self.machine.now
        self.piece = None

    def after_corner(self, drive: Drive) -> None:
        """The rest of a move after a corner: it may blend again."""
        piece = self.piece
        if piece is None or not drive.blending:
            return
        following = self._after(drive)
        if following is not None:
            self._join(piece, following)
        elif drive.order.rules.advance.runs_ahead_of == "fly_by":
            self.drive(pieces.open_ended(piece, self.machine.now))

    def _release(self) -> None:
        if self.piece is not None:
            self.piece.drive.released = True
            self.look()
            self.ask()

    def _passed(self) -> None:
        """The middle of a corner: the move before it counts as made."""
        piece = self.piece
        if piece is not None and piece.drive in self.queue:
            piece.drive.released = True
            self.queue.remove(piece.drive)
            if piece.corner is not None and piece.halting is None:
                searching.watch(self, piece.corner.following)
                searching.end_if_found(self, piece.corner.following)
            self.look()

    def done(self, drive: Drive, stops: bool) -> None:
        """A move is over: show it, fire what is left of its triggers, tell who waits."""
        drive.released = True
        if drive in self.queue:
            self.queue.remove(drive)
        blocks.pass_rest(self, drive)
        self.show(drive, stops)
        for trigger in drive.order.triggers:
            if not trigger.fired:
                due = trigger.due if trigger.due is not None else self.machine.now
                if stops and drive.order.rules.triggers.delays_within_move:
                    due = self.machine.now
                self._fire_later(trigger, max(due, self.machine.now))
        task = self.task
        task.busy = bool(self.queue) or self.piece is not None
        search = drive.order.search
        if search is not None and stops and not search.found and search.hit is None:
            searching.missed(self, drive)
            return
        if not task.busy and self.failed is not None:
            self.fault(*self.failed)
            return
        self.look()

    def look(self) -> None:
        self.machine.look_at(self.task)

    def show(self, drive: Drive, stops: bool, interrupted: bool = False, joints: FloatArray | None = None) -> None:
        """A move in the trace, or that segment of a spline block which ends in `joints`."""
        assert drive.plan is not None
        legs, order = tuple(leg for leg in drive.legs if isinstance(leg, Leg)), drive.present
        if joints is None:
            joints = self.joints if interrupted and self.joints is not None else drive.plan.end_joints
        pose = pose_of_array(self.model.forward(joints)).then(drive.tool) if self.model is not None else None
        started = drive.started_s if drive.started_s is not None else self.machine.now
        data: dict[str, Value] = {
            "motion": order.kind,
            "joints": [round(float(joint), 6) for joint in joints],
            **pieces.pose_data(pose),
            "duration": round(self.machine.now - started, 6),
        }
        if interrupted:
            data["interrupted"] = True
        self.machine.moves += 1
        asked = {"blend": order.blend.kind, "payloads": order.payloads, "programmed": order.programmed}
        self.machine.event("move", data, self.task, order.code.origin(order.at), legs=legs, stops=stops, **asked)

    # ---- triggers

    def _fire_number(self, number: int, place: int) -> None:
        drives = list(self.queue)
        if self.piece is not None and self.piece.drive not in drives:
            drives.append(self.piece.drive)
        for drive in drives:
            if drive.number == number:
                self.fire(drive.order.triggers[place])

    def _fire_later(self, trigger: TriggerOrder, due: float) -> None:
        if due <= self.machine.now:
            self.fire(trigger)
            return
        self.numbers += 1
        self.late[self.numbers] = trigger
        self.machine.timed_outputs += 1
        self.machine.schedule(due, ARRIVALS, "motion", self.task_index, "late", self.numbers)

    def fire(self, trigger: TriggerOrder) -> None:
        if trigger.fired:
            return
        trigger.fired = True
        task = self.task
        if trigger.act is not None:
            try:
                trigger.act(trigger.values)
            except ProgramError as error:
                self.machine.fault(error.name.replace("_", "-"), f"trigger: {error.message}", task, task.where())
        elif trigger.routine is not None:
            task.trigger(trigger.routine, trigger.values)
            self.look()
        elif trigger.interrupt is not None:
            known = task.interrupts.known.get(trigger.interrupt)
            if known is not None and known.on:
                task.interrupts.came(known)
                self.look()

    # ---- stopping and going on

    def halt(self, hard: bool, ends_move: bool = False) -> None:
        """Brake on the path; `ends_move`: what is left of the move is dropped when the robot stands."""
        stopping.halt(self, hard, ends_move)

    def start(self) -> None:
        """Go on with a stopped motion."""
        stopping.start(self)

    def interrupt_ended(self, goes_on: bool) -> None:
        """`goes_on`: a motion braked in an interrupt goes on when that ends without leaving its level. What was
        commanded behind a dropped move is driven now in any case."""
        if goes_on and self.set_aside:
            self.set_aside = False
            self.restore()
        if goes_on and self.stopped:
            self.start()
        if self.piece is None or self.piece.halting is None:
            stopping.again(self)

    def clear(self) -> None:
        """Forget everything commanded; the robot stays where it is."""
        if self.piece is not None:
            self.close_leg(self.piece, self.machine.now)
            self.joints, self.external = self.joints_array(), self.external_now()
        resting.ended(self)
        begun = self.piece or self.halted
        self.piece = self.halted = None
        self.generation += 1
        if begun is not None:
            self.show(begun.drive, True, True)
        self.queue.clear()
        self.behind.clear()
        self.regained = None
        if self.set_aside:
            self.set_aside = False
            self.stored.pop()
        self.planned_joints, self.planned_external = self.joints, self.external
        self.stopped = False
        self.failed = None
        self.task.busy = False
        self.look()

    def store(self) -> None:
        """Put the stopped path aside."""
        if self.piece is not None:
            raise ProgramError("path_not_stored", "the robot must stand before the path is stored")
        if self.model is not None:
            assert self.joints is not None
            self.stored.append(Stored(self.joints, self.halted, self.queue[:], self.stopped))
        self.halted = None
        self.queue.clear()
        self.planned_joints, self.planned_external = self.joints, self.external
        self.stopped = False
        self.task.busy = False

    def restore(self) -> None:
        """Take the stored path up again: the robot goes back to where it left it, then waits for the start. Where
        nothing was stopped or left over, as after a search without success, there is nothing to start."""
        if self.model is None:
            return
        if not self.stored:
            raise ProgramError("path_not_stored", "no path is stored")
        stored = self.stored.pop()
        self.halted, self.queue = stored.piece, stored.queue
        last = self.queue[-1] if self.queue else None
        self.planned_joints = last.plan.end_joints if last is not None and last.plan is not None else stored.joints
        self.task.busy = bool(self.queue) or self.halted is not None
        self.stopped = stored.stopped or self.task.busy
        if not self.stopped:
            self.planned_joints = self.joints

    def finish(self) -> None:
        """The run ends: show the moves that were cut off, first those that were put aside or stand on their way."""
        for piece in (*(one.piece for one in self.stored), self.halted):
            if piece is not None and piece.drive.legs and self.model is not None:
                self.show(piece.drive, True, True)
        self.halted = None
        if self.piece is not None and self.model is not None:
            piece = self.piece
            self.close_leg(piece, self.machine.now)
            self.joints, self.external = self.joints_array(), self.external_now()
            self.piece = None
            if piece.drive.legs:
                self.show(piece.drive, False, True)
