"""Motion statements to instructions: everything a move says is evaluated when the program pointer reaches it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from rpl import ir
from rpl.linking.flatten import has_call
from rpl.linking.meetings import identity_of
from rpl.linking.places import writer
from rpl.linking.stops import looks_outside
from rpl.runtime.code import Instruction, Read, Values
from rpl.runtime.faults import ProgramError
from rpl.runtime.functions.system import modal_key
from rpl.runtime.limits import MOST_WAITING
from rpl.runtime.moves.orders import BlendOrder, Order, PathRuleOrder, SearchOrder, SpeedOrder, TriggerOrder
from rpl.runtime.tasks import take_robot
from rpl.runtime.values import JointsValue, PoseValue, Record, TargetValue, Value, whole

if TYPE_CHECKING:
    from rpl.linking.assembler import Make
    from rpl.linking.linker import Linker

MakeTrigger = Callable[[Values], TriggerOrder]
Overlay = Callable[[Values], dict[str, Value]]
Submit = Callable[[Any, Order, int, int], int]
PathRules = Callable[[Values], tuple[PathRuleOrder, ...]]
SplineItem = ir.Move | ir.Trigger | ir.PathRule | ir.Assign | ir.CallRoutine | ir.Vendor | ir.Nothing | ir.Opaque


class MotionStatements:
    """Compiles moves, spline blocks and path triggers of one routine."""

    def __init__(self, linker: Linker) -> None:
        self.linker = linker

    def value(self, expression: ir.Expression) -> Read:
        return self.linker.compiler.value(expression)

    def optional(self, expression: ir.Expression | None) -> Read | None:
        return self.value(expression) if expression is not None else None

    def target(self, expression: ir.Expression) -> Read:
        """A motion target: components without a value are no fault here, they stay as they are, if the language's rules
        do not demand whole positions."""
        compiler = self.linker.compiler
        read = compiler.raw(expression)
        if compiler.unset:
            read = compiler.assumed(expression, read, goal=True) or read
        return _whole(read, expression) if compiler.scope.rules.whole_targets else read

    def statement(self, statement: ir.Statement) -> None:
        emit = self.linker.assembler.emit
        match statement:
            case ir.Move():
                emit(self.move(statement))
            case ir.MoveExternal():
                emit(self.external(statement))
            case ir.Spline():
                self.spline(statement)
            case ir.Trigger():
                emit(self.path_trigger(statement))
            case ir.PathRule():
                emit(lambda here, next: _alone)
            case ir.DefineTrigger():
                emit(self.define(statement))

    # ---- moves

    def move(
        self,
        move: ir.Move,
        more: tuple[tuple[ir.Expression, ir.Expression], ...] = (),
        submit: Submit | None = None,
        path_rules: PathRules | None = None,
    ) -> Make:
        """One move; `submit` hands it over (in a spline block, not one by one), the last one with its `path_rules`."""
        target, via = self.target(move.target), self.target(move.via) if move.via is not None else None
        options: dict[str, Read | None] = {
            "swept": self.optional(move.swept),
            "tool": self.optional(move.tool),
            "frame": self.optional(move.frame),
            "acceleration": self.optional(move.acceleration),
            "identity": identity_of(move.identity, self.linker) if move.identity is not None else None,
        }
        speed, blend = self.speed(move.speed), self.blend(move.blend)
        triggers = [self.trigger_of(trigger) for trigger in move.triggers]
        search = self.search(move.search, move) if move.search is not None else None
        overlay = self.overlay((*more, *move.settings))
        fixed: dict[str, Any] = {
            "relative": move.relative,
            "orientation": move.orientation,
            "circle_orientation": move.circle_orientation,
            "configuration": move.configuration,
            "concurrent": move.concurrent,
            **{name: move.motion_class == name for name in ("velocity", "servo")},
        }
        kind, rules = move.kind, self.linker.compiler.scope.rules
        load, hand_over = self.optional(move.load), submit or _submit

        def make(here: int, next: int) -> Instruction:
            def drive(f: Values) -> int:
                task = f[0]
                order = Order(kind, target(f), task.frame.code, here, rules)
                order.once = task.take_settings()
                over = order.modal = {**order.once, **overlay(f)}
                with_overlay = _Overlaid(task, over) if over else None
                if via is not None:
                    order.via = via(f)
                for name, read in options.items():
                    if read is not None:
                        setattr(order, name, read(f))
                for name, value in fixed.items():
                    setattr(order, name, value)
                order.speed, order.blend = speed(f), blend(f)
                if with_overlay is not None:
                    with_overlay.restore()
                order.triggers = [trigger(f) for trigger in triggers] + task.take_triggers()
                order.search = search(f) if search is not None else None
                order.path_rules = path_rules(f) if path_rules is not None else ()
                if load is not None:
                    order.load = load(f)
                    if not rules.loads_of_tools:
                        task.modal["load"] = order.load
                return hand_over(task, order, here, next)

            return drive

        return make

    def overlay(self, settings: tuple[tuple[ir.Expression, ir.Expression], ...]) -> Overlay:
        """System variables that have another value for this move only."""
        made: list[tuple[str, Read | None, Read]] = []
        for place, value in settings:
            target, given = place, value
            if isinstance(target, ir.Magnitude):
                target, given = (
                    target.value,
                    ir.Quantity(given, place.unit) if isinstance(place, ir.Magnitude) else given,
                )
            if isinstance(target, ir.System):
                index = self.value(target.indices[0]) if target.indices else None
                made.append((target.name, index, self.value(given)))
        if not made:
            return lambda f: {}
        return lambda f: {
            modal_key(name, index(f) if index is not None else None): read(f) for name, index, read in made
        }

    def speed(self, speed: ir.Speed | None) -> Callable[[Values], SpeedOrder]:
        if speed is None:
            return lambda f: SpeedOrder()
        profile = self.optional(speed.profile)
        parts = {
            "path": self.optional(speed.path),
            "rotation": self.optional(speed.rotation),
            "joint": self.optional(speed.joint),
            "duration": self.optional(speed.duration),
            "axis": self.optional(speed.axis),
            "path_acceleration": self.optional(speed.path_acceleration),
            "axis_acceleration": self.optional(speed.axis_acceleration),
        }

        def make(f: Values) -> SpeedOrder:
            given = profile(f) if profile is not None else None
            if given is not None and not isinstance(given, Record):
                raise ProgramError("wrong_kind", "a speed is needed")
            order = SpeedOrder(given)
            for name, read in parts.items():
                if read is not None:
                    setattr(order, name, float(read(f)))
            return order

        return make

    def blend(self, blend: ir.Blend | None) -> Callable[[Values], BlendOrder]:
        match blend:
            case ir.BlendDistance(distance=distance, rotation=rotation):
                way, turn = self.optional(distance), self.optional(rotation)
                return lambda f: BlendOrder(
                    "distance",
                    float(way(f)) if way is not None else None,
                    float(turn(f)) if turn is not None else None,
                )
            case ir.BlendPercent(percent=percent, path=path):
                share, inner = self.value(percent), self.blend(path) if path is not None else _modal_distance
                return lambda f: BlendOrder("percent", percent=float(share(f)), path=inner(f))
            case ir.BlendSpeed(percent=percent):
                part = self.value(percent)
                return lambda f: BlendOrder("speed", percent=float(part(f)))
            case ir.BlendLevel(level=level):
                number, distances = self.value(level), self.linker.compiler.scope.rules.blend_levels
                return lambda f: _level(distances, whole(number(f)))
            case ir.BlendZone(zone=zone, distance=distance):
                value, radius = self.value(zone), self.optional(distance)
                return lambda f: _zone(value(f), float(radius(f)) if radius is not None else None)
        if blend is None:
            return lambda f: BlendOrder("speed", percent=100.0) if f[0].modal.get("blending") else BlendOrder("stop")
        return lambda f: BlendOrder("stop")

    def search(self, search: ir.Search, move: ir.Move) -> Callable[[Values], SearchOrder]:
        compiler, condition = self.linker.compiler, self.value(search.condition)
        write = writer(compiler, search.found, move.origin) if search.found is not None else None
        hit = writer(compiler, search.hit, move.origin) if search.hit is not None else None
        stop, edge = search.stop, search.edge
        return lambda f: SearchOrder(condition, write, f, stop, edge, hit)

    def external(self, move: ir.MoveExternal) -> Make:
        target, speed, blend = self.target(move.target), self.speed(move.speed), self.blend(move.blend)
        rules = self.linker.compiler.scope.rules

        def make(here: int, next: int) -> Instruction:
            def drive(f: Values) -> int:
                task = f[0]
                order = Order("joint", target(f), task.frame.code, here, rules)
                order.speed, order.blend, order.external_only = speed(f), blend(f), True
                return _submit(task, order, here, next)

            return drive

        return make

    def spline(self, spline: ir.Spline) -> None:
        """The moves of a block are gathered and handed over with the last one: the robot drives them as one path. An
        output between two of them is switched when it passes there; what else would have to wait for the robot ends the
        path (M: the makers allow little or nothing of it)."""
        ends = next((item for item in reversed(spline.body) if isinstance(item, ir.Move)), None)
        for part in self._paths(spline.body):
            moves = [at for at, item in enumerate(part) if isinstance(item, ir.Move)]
            rules = self.path_rules(part)
            for at, item in enumerate(part):
                if isinstance(item, ir.PathRule):
                    if not moves:
                        self.statement(item)
                elif isinstance(item, ir.Move):
                    last = at == moves[-1]
                    self._segment(item, spline, at == moves[0], last, item is ends, rules if last else None)
                elif isinstance(item, ir.Assign) and moves and moves[0] < at < moves[-1] and self._switches(item):
                    self.statement(ir.Trigger("start", item, origin=item.origin))
                else:
                    self.linker.statements.statement(item)

    def _paths(self, body: tuple[SplineItem, ...]) -> list[tuple[SplineItem, ...]]:
        """The statements of a block, cut where one of them cannot be done on the way."""
        parts: list[tuple[SplineItem, ...]] = []
        begin = 0
        for at, item in enumerate(body):
            if not self._on_the_way(item):
                parts += [body[begin:at], (item,)]
                begin = at + 1
        return [part for part in (*parts, body[begin:]) if part]

    def _on_the_way(self, item: SplineItem) -> bool:
        match item:
            case ir.Move() | ir.Trigger() | ir.PathRule() | ir.Nothing():
                return True
            case ir.Vendor(effect=effect):
                return effect in ("none", "tuning")
            case ir.Assign(value=value):
                return self._switches(item) if looks_outside(item, self.linker) else not has_call(value)
        return False

    def _switches(self, item: ir.Assign) -> bool:
        """Does it give an output a value that is known without looking outside?"""
        inside = looks_outside(item.value, self.linker) or has_call(item.value)
        return not inside and looks_outside(item.target, self.linker)

    def path_rules(self, part: tuple[SplineItem, ...]) -> PathRules:
        """The rules about speeds in a block, each with the number of segments before it."""
        made: list[tuple[int, ir.PathRule, Read | None]] = []
        before = 0
        for item in part:
            before += isinstance(item, ir.Move)
            if isinstance(item, ir.PathRule):
                made.append((before, item, self.optional(item.value)))
        return lambda f: tuple(
            PathRuleOrder(at, rule.rule, float(read(f)) if read is not None else 0.0, rule.reference)
            for at, rule, read in made
        )

    def _segment(
        self, move: ir.Move, spline: ir.Spline, first: bool, last: bool, ends: bool, rules: PathRules | None
    ) -> None:
        kind = "joint" if spline.kind == "joint" else move.kind
        blend = spline.blend if ends else ir.BlendStop()
        segment = replace(move, kind=kind, blend=blend, motion_class="spline")
        outer = self.linker.assembler.begin(move.origin)
        self.linker.assembler.emit(self.move(segment, spline.settings, _gathering(first, last), rules))
        self.linker.assembler.end(outer)

    # ---- triggers

    def trigger(self, trigger: ir.Trigger, frozen: bool) -> MakeTrigger:
        """A trigger; with `frozen` its action is evaluated when it is stored."""
        distance, delay = self.optional(trigger.distance), self.optional(trigger.delay)
        reference, action = trigger.reference, trigger.action
        rules, timed = self.linker.compiler.scope.rules.triggers, distance is None and delay is not None
        braking = rules.early_while_braking and reference == "end" and timed
        behind = rules.start_behind_corner and reference == "start" and timed
        act: Instruction | None = None
        routine = None
        freeze = None
        if isinstance(action, ir.Assign):
            value = self.linker.compiler.copy_of(action.value)
            write = writer(self.linker.compiler, action.target, trigger.origin)
            if frozen:
                freeze = (value, write)
            else:

                def act_now(f: Values) -> int:
                    write(f, value(f))
                    return 0

                act = act_now
        elif action.name or action.dynamic is not None:
            routine = self.linker.action(action, "trigger")

        def make(f: Values) -> TriggerOrder:
            act_here = act if freeze is None else _frozen(freeze[0](f), freeze[1])
            way = float(distance(f)) if distance is not None else None
            order = TriggerOrder(reference, way, float(delay(f)) if delay is not None else 0.0, f, act_here, routine)
            order.early_while_braking, order.behind_corner = braking, behind
            return order

        return make

    def trigger_of(self, given: ir.Expression | ir.Trigger) -> MakeTrigger:
        """A move's own trigger, or a stored one."""
        if isinstance(given, ir.Trigger):
            return self.trigger(given, True)
        read = self.linker.compiler.raw(given)

        def make(f: Values) -> TriggerOrder:
            stored = read(f)
            if not isinstance(stored, TriggerOrder):
                raise ProgramError("no_value", "the path event was not defined")
            return stored.copy()

        return make

    def path_trigger(self, trigger: ir.Trigger) -> Make:
        """A trigger as a statement belongs to the next move."""
        made = self.trigger(trigger, False)

        def make(here: int, next: int) -> Instruction:
            def set_trigger(f: Values) -> int:
                waiting = f[0].next_triggers
                if len(waiting) >= MOST_WAITING:
                    raise ProgramError("internal_limit", f"more than {MOST_WAITING} path events wait for the next move")
                waiting.append(made(f))
                return next

            return set_trigger

        return make

    def define(self, statement: ir.DefineTrigger) -> Make:
        made = self.trigger(statement.trigger, True)
        write = writer(self.linker.compiler, statement.target, statement.origin)
        interrupt = self.optional(statement.interrupt)

        def make(here: int, next: int) -> Instruction:
            def define(f: Values) -> int:
                order = made(f)
                if interrupt is not None:  # it is ordered here: nothing else arms it (RAPID TriggInt)
                    order.interrupt = whole(interrupt(f))
                    known = f[0].interrupts.known.get(order.interrupt)
                    if known is None:
                        raise ProgramError("unknown_interrupt", "the interrupt is not connected")
                    known.on = True
                write(f, order)
                return next

            return define

        return make


def _modal_distance(f: Values) -> BlendOrder:
    """Between a joint and a path move a blend in percent is measured by the modal distance, where there is one."""
    return BlendOrder("distance", float(f[0].modal.get("blend_distance") or 0.0))


def _level(distances: tuple[float, ...], level: int) -> BlendOrder:
    """A numbered blend level; level 0 and one without a distance is a stop."""
    if not 0 <= level < len(distances):
        raise ProgramError("out_of_range", f"there is no positioning level {level}")
    return BlendOrder("distance", distances[level]) if distances[level] > 0.0 else BlendOrder("stop")


def _frozen(value: Value, write: Callable[[Values, Value], None]) -> Instruction:
    def act(f: Values) -> int:
        write(f, value)
        return 0

    return act


def _whole(read: Read, expression: ir.Expression) -> Read:
    """Demands a position in which every component has a value."""
    named = f"the position {expression.id}" if isinstance(expression, ir.Name) else "the position"

    def checked(f: Values) -> Value:
        value = read(f)
        match value:
            case TargetValue(pose=pose) | (PoseValue() as pose):
                parts: tuple[Value, ...] = (*pose.trans, *pose.rot.parts)
            case JointsValue(axes=axes):
                parts = axes.values
            case _:
                parts = (value,)
        if None in parts:
            raise ProgramError("no_value", f"{named} has no value: it was never taught or set")
        return value

    return checked


def _zone(zone: Value, distance: float | None) -> BlendOrder:
    if not isinstance(zone, Record):
        raise ProgramError("wrong_kind", "a zone is needed")
    return BlendOrder("zone", distance, zone=zone)


def _alone(f: Values) -> int:
    raise ProgramError("motion", "a rule about a spline block stands where no block with motions is")


def _gathering(first: bool, last: bool) -> Submit:
    """A move of a spline block is kept; the last one is handed over with those before it."""

    def gather(task: Any, order: Order, here: int, next: int) -> int:
        if first:
            task.gathered = {}
        if not last:
            task.gathered[here] = order
            return next
        order.block = tuple(task.gathered.values())
        return _submit(task, order, here, next)

    return gather


def _submit(task: Any, order: Order, here: int, next: int) -> int:
    """Hand the move over; wait first when the program pointer is too far ahead."""
    if task.robot is None and not take_robot(task):
        raise ProgramError("motion", f"task {task.name} has no robot to move")
    robot = task.robot
    if not robot.has_room() and order.rules.advance.runs_ahead_of != "fly_by":
        task.next_triggers = [t for t in order.triggers if not t.fired]
        task.next_settings = order.once
        waiting: int = task.wait_for("room", here, here)
        return waiting
    done: int = robot.submit(order, next)
    return done


class _Overlaid:
    """A move's own settings stand in the task's table while the move's speed and blend are evaluated."""

    __slots__ = ("before", "task")

    def __init__(self, task: Any, over: dict[str, Value]) -> None:
        self.task = task
        self.before = dict(task.modal)
        task.modal.update(over)

    def restore(self) -> None:
        self.task.modal.clear()
        self.task.modal.update(self.before)
