"""V+ instructions that set something, wait, react or switch: speeds, frames, signals, reactions, stops, parameters.

A setting without ALWAYS holds for the next move only.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes import rigid
from rpl.reading.shapes import StatementError, SyntaxTree
from rpl.source import Origin

from . import signals, tables
from .blocks import JOINT_SPEED
from .expressions import root_name, significant, subtree
from .functions import constant, literal, transformation
from .motion import Motion, negated
from .split import code_of
from .statements import ALWAYS_TRUE, Instruction, Lowered

INPUT_WRITTEN = code(
    "vplus-input-written",
    Severity.WARNING,
    "{text} writes an input; a controller does that only when its inputs are imitated",
)
RUN_SIGNAL = code(
    "vplus-run-signal",
    Severity.WARNING,
    "the signal is switched on here; the controller switches it off when the program ends, which is not imitated",
    "switch it off at the end of the program",
)
PROFILE = code("vplus-acceleration-profile", Severity.INFO, "acceleration profile {number} is not imitated")


class Settings(Motion):
    """Lowers everything that is no move and no control flow."""

    def instruction(self, given: Instruction) -> Lowered:
        found = self.motion(given) or self.modal(given) or self.control(given) or self.other(given)
        if found is None:
            raise StatementError(f"{given.word.upper()} cannot stand here", 0)
        return found

    def kept(self, given: Instruction) -> ir.Vendor:
        """An instruction that nothing here can feel."""
        return ir.Vendor("vplus", code_of(given.origin.text), "tuning", origin=given.origin)

    # ---- modal settings

    def modal(self, given: Instruction) -> Lowered | None:
        word, origin = given.word, given.origin
        if word in tables.SETTLING:
            return self.kept(given)
        if word in tables.POSTURES:
            name, value = tables.POSTURES[word]
            return ir.SetForNextMove(ir.System(name, origin=origin), ir.EnumLiteral(value), origin=origin)
        match word:
            case "speed":
                return self.speed(given)
            case "accel":
                return self.acceleration(given)
            case "duration":
                time = self.operand(given, 0) or ir.IntLiteral(0)
                return self.set_to([("move_duration", time)], given.always, origin)
            case "cpon" | "cpoff":
                return self.set_to([("blending", ir.BoolLiteral(word == "cpon"))], given.always, origin)
            case "fine" | "coarse":
                percent = self.operand(given, 0) or ir.IntLiteral(100)
                factor = tables.COARSE_FACTOR if word == "coarse" else 1.0
                return self.set_to([("end_tolerance", scaled(percent, factor, origin))], given.always, origin)
            case "tool":
                return self.framed("tool", self.operand(given, 0), origin)
            case "base":
                return self.framed("base", self.base(given), origin)
        return None

    def set_to(
        self, settings: Iterable[tuple[str, ir.Expression]], always: bool, origin: Origin
    ) -> tuple[ir.Statement, ...]:
        """Modal variables set for good or for the next move."""
        if always:
            return tuple(ir.Assign(ir.System(n, origin=origin), value, origin=origin) for n, value in settings)
        return tuple(ir.SetForNextMove(ir.System(n, origin=origin), value, origin=origin) for n, value in settings)

    def speed(self, given: Instruction) -> Lowered:
        """SPEED value, rotation {MMPS | IPS | MONITOR} {ALWAYS}. M: a percentage without the second one governs the
        turning of the tool too; a tool speed gives joint moves the same share of their full speed."""
        origin = given.origin
        value, turning = self.needed(given, 0, "a speed"), self.operand(given, 1)
        if given.unit == "monitor":
            return ir.Assign(ir.System("override", origin=origin), value, origin=origin)
        if not given.unit:
            turning = turning if turning is not None else value
            settings = [
                ("joint_speed", value),
                ("path_speed", share(value, tables.FULL_PATH_SPEED_MM_S, origin)),
                ("swivel_speed", share(turning, tables.FULL_ROTATION_SPEED_DEG_S, origin)),
            ]
            return self.set_to(settings, given.always, origin)
        factor = tables.MM_PER_INCH if given.unit == "ips" else 1.0
        path = scaled(value, factor, origin)
        percent = scaled(value, factor * 100.0 / tables.FULL_PATH_SPEED_MM_S, origin)
        settings = [("joint_speed", percent), ("path_speed", path)]
        if turning is not None:
            settings.append(("swivel_speed", share(turning, tables.FULL_ROTATION_SPEED_DEG_S, origin)))
        if given.always and isinstance(percent, ir.RealLiteral | ir.IntLiteral):  # of the next move: see `blocks`
            self.diagnostics.report(JOINT_SPEED, origin, percent=f"{percent.value:g}")
        return self.set_to(settings, given.always, origin)

    def acceleration(self, given: Instruction) -> Lowered:
        """ACCEL (profile) acceleration, deceleration: until changed."""
        origin = given.origin
        if given.brackets is not None:
            self.diagnostics.report(PROFILE, origin, number=self.written(given.brackets).strip("()"))
        settings = [
            (name, value)
            for name, value in (
                ("acceleration_percent", self.operand(given, 0)),
                ("deceleration_percent", self.operand(given, 1)),
            )
            if value is not None
        ]
        if not settings:
            return self.kept(given)
        return self.set_to(settings, True, origin)

    def framed(self, name: str, value: ir.Expression | None, origin: Origin) -> Lowered:
        """TOOL and BASE wait for the robot first."""
        frame = value if value is not None else ir.System("null_frame", origin=origin)
        setting = ir.Assign(ir.System(name, origin=origin), frame, origin=origin)
        return ir.WaitForMotion(origin=origin), setting

    def base(self, given: Instruction) -> ir.Expression | None:
        """BASE x, y, z, rotation, or BASE location."""
        values = [self.operand(given, position) for position in range(len(given.operands))]
        if len(values) == 1:
            tree = given.operands[0]
            if tree is not None and tree.data not in ("integer", "real", "unary"):
                null = isinstance(values[0], ir.System) and values[0].name == "null_frame"
                return values[0] if null or values[0] is None else inverted(values[0], given.origin)
        if not any(values):
            return None
        zero = ir.IntLiteral(0)
        return where_world_is([(values + [None] * 4)[n] or zero for n in range(4)], given.origin)

    # ---- waiting, reactions, stops, tasks

    def control(self, given: Instruction) -> Lowered | None:
        origin = given.origin
        match given.word:
            case "wait":
                return self.wait(given)
            case "wait.event":
                return self.wait_event(given)
            case "react" | "reacti":
                return self.react(given)
            case "reacte":
                tree = given.operands[0] if given.operands else None
                return ir.OnError(self.routine_named(tree) if tree is not None else None, origin=origin)
            case "ignore":
                signal = signals.known(self.needed(given, 0, "a signal"), self.facts)
                return ir.ControlInterrupt("delete", handle(signal), origin=origin)
            case "lock":
                level = self.operand(given, 0) or ir.IntLiteral(0)
                return ir.ControlInterrupt("mask", urgency(level, origin), origin=origin)
            case "return":
                return ir.Return(origin=origin)
            case "returne":
                return ir.TryNext(origin=origin)
            case "stop" | "halt":
                return ir.Halt("exit", origin=origin)
            case "pause":
                return ir.Halt(origin=origin)
            case "abort" | "kill" | "cycle.end":
                return self.task_of(given.operands, "stop", origin)
            case "proceed" | "retry":
                return self.task_of(given.operands, "resume", origin)
            case "runsig":
                return self.run_signal(given)
            case "set.event" | "clear.event":
                flag = self.event(self.operand(given, 0), given.word)
                if flag is not None:
                    return ir.Assign(flag, ir.BoolLiteral(given.word == "set.event"), origin=origin)
                return ir.Vendor("vplus", code_of(origin.text), "unknown", origin=origin)
            case "reset":
                return ir.Vendor("vplus", code_of(origin.text), "unknown", origin=origin)
            case "release":
                return ir.Vendor("vplus", code_of(origin.text), "none", origin=origin)
        return None

    def run_signal(self, given: Instruction) -> Lowered:
        """RUNSIG n: on while the program runs. M: without a number the signal goes off."""
        number = self.operand(given, 0)
        switched = signals.switching(number, self.facts, given.origin) if number is not None else None
        if switched is None:
            return ir.Vendor("vplus", code_of(given.origin.text), "unknown", origin=given.origin)
        self.diagnostics.report(RUN_SIGNAL, given.origin)
        return switched

    def wait(self, given: Instruction) -> Lowered:
        origin = given.origin
        condition = self.operand(given, 0)
        if condition is None:
            return ir.Wait(ir.RealLiteral(tables.CYCLE_S), origin=origin)
        if isinstance(condition, ir.IntLiteral | ir.RealLiteral) and condition.value != 0:
            self.diagnostics.report(ALWAYS_TRUE, origin, text=self.written(given.operands[0]))
        return ir.WaitUntil(condition, origin=origin)

    def wait_event(self, given: Instruction) -> Lowered:
        """WAIT.EVENT mask, seconds: without a mask a plain wait."""
        mask, time = self.operand(given, 0), self.operand(given, 1)
        if time is not None and mask in (None, ir.IntLiteral(0)):
            return ir.Wait(time, origin=given.origin)
        flag = self.event(None, given.word) if mask not in (None, ir.IntLiteral(0)) else None
        if flag is not None and (time is None or time == ir.IntLiteral(0)):
            return ir.WaitUntil(flag, origin=given.origin)
        if flag is not None and time is not None:
            return self.event_within(flag, time, given.origin)
        return ir.Vendor("vplus", code_of(given.origin.text), "unknown", origin=given.origin)

    def event_within(self, flag: ir.Name, time: ir.Expression, origin: Origin) -> Lowered:
        """The event is looked at every 16 ms until the time is over."""
        waited, cycle = self.temporary("waited"), ir.RealLiteral(tables.CYCLE_S)
        off = ir.Unary("not", flag, origin=origin)
        goes_on = ir.Binary("and", off, ir.Binary("<", waited, time, origin=origin), origin=origin)
        longer = ir.Assign(waited, ir.Binary("+", waited, cycle, origin=origin), origin=origin)
        start = ir.Assign(waited, ir.RealLiteral(0.0), origin=origin)
        return start, ir.While(goes_on, (ir.Wait(cycle, origin=origin), longer), origin=origin)

    def event(self, task: ir.Expression | None, word: str) -> ir.Name | None:
        """The variable for the event of a task, without a number of the program's own; None: nobody can tell which."""
        key = self.facts.task_of.get(self.program)
        if task is not None:
            number = signals.known(task, self.facts)
            key = str(number.value) if isinstance(number, ir.IntLiteral) else (root_name(number) or "").lower()
        elif word == "set.event":
            key = None
        if not key:
            return None
        name = self.name(f"event.{key}")
        self.events.add(significant(name))
        return ir.Name(name, origin=self.origin)

    def react(self, given: Instruction) -> Lowered:
        """REACT signal, program, priority: the edge of the signal calls the program. REACTI stops the robot as well.
        It belongs to the task: also when the program that switched it on has returned."""
        origin = given.origin
        number = signals.known(self.needed(given, 0, "a signal"), self.facts)
        tree = given.operands[1] if len(given.operands) > 1 else None
        if tree is None:
            raise StatementError(f"{given.word.upper()} needs a program", 0)
        priority = self.operand(given, 2) or ir.IntLiteral(tables.REACT_PRIORITY)
        declared = ir.DeclareInterrupt(
            urgency(priority, origin),
            signals.reading([number], self.facts, origin),
            ir.CallRoutine(self.routine_named(tree), origin=origin),
            identity=handle(number),
            everywhere=True,
            stops=given.word == "reacti",
            origin=origin,
        )
        return declared, ir.ControlInterrupt("on", handle(number), origin=origin)

    # ---- signals, switches, the rest

    def other(self, given: Instruction) -> Lowered | None:
        origin = given.origin
        match given.word:
            case "signal":
                return self.signal(given)
            case "here":
                return self.here(given)
            case "prompt":
                return self.prompt(given)
            case "enable" | "disable":
                return self.switches(given)
        return ir.Vendor("vplus", code_of(origin.text), "unknown", origin=origin)

    def signal(self, given: Instruction) -> Lowered:
        done: list[ir.Statement] = []
        for tree in given.operands:
            if tree is None:
                continue
            switched = signals.switching(self.expression(tree), self.facts, given.origin)
            if switched is None:
                text = f"SIGNAL {self.written(tree)}"
                self.diagnostics.report(INPUT_WRITTEN, given.origin, text=text)
                done.append(ir.Vendor("vplus", text, "unknown", origin=given.origin))
            else:
                done.extend(switched)
        if not done:
            raise StatementError("SIGNAL needs a signal number", 0)
        return tuple(done)

    def prompt(self, given: Instruction) -> Lowered:
        """PROMPT "text", variable, ...: one question per variable (M: several are typed in one line)."""
        origin = given.origin
        text: ir.Expression = ir.TextLiteral("")
        trees: list[SyntaxTree] = [tree for tree in given.operands if tree is not None]
        if given.operands and given.operands[0] is not None and self.is_prompt(given.operands[0], len(trees)):
            text = self.expression(trees.pop(0))
        if not trees:
            return ir.Message("write", text, origin=origin)
        done = []
        for tree in trees:
            place = self.place(tree)
            kind = "text" if (root_name(place) or "").startswith("$") else "number"
            done.append(ir.Dialog(place, text, kind=kind, origin=origin))
        return tuple(done)

    def is_prompt(self, tree: SyntaxTree, count: int) -> bool:
        """Is the first operand the question? A lone variable is what is asked for."""
        return count > 1 or tree.data not in ("reference",)

    def switches(self, given: Instruction) -> Lowered:
        """ENABLE and DISABLE of system switches."""
        on, origin = given.word == "enable", given.origin
        done: list[ir.Statement] = []
        for tree in given.operands:
            if tree is None:
                continue
            text = self.written(tree)
            name = text.partition("[")[0].lower()
            if name in tables.SETTING_SWITCHES:
                done.extend(self.set_to([(tables.SETTING_SWITCHES[name], ir.BoolLiteral(on))], True, origin))
                continue
            harmless = name in tables.SWITCHES_WITHOUT_EFFECT or (name == "upper" and self.facts.upper is not None)
            statement = f"{given.word.upper()} {text.upper()}"
            done.append(ir.Vendor("vplus", statement, "tuning" if harmless else "unknown", origin=origin))
        if not done:
            raise StatementError(f"{given.word.upper()} needs a switch", 0)
        return tuple(done)

    def on_setting(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        """`WORD operands = values`."""
        word = str(tree.children[0]).lower()
        left, right = (
            [subtree(part).children[0] if subtree(part).children else None for part in subtree(side).children]
            for side in tree.children[1:]
        )
        places = [subtree(part) for part in left if part is not None]
        values = [self.expression(subtree(part)) for part in right if part is not None]
        if len(places) == len(left) and len(values) == len(right) == 1:
            found = self.setting(word, places, values[0], origin)
            if found is not None:
                return found
        effect = "none" if word in ("defbelt", "setbelt") else "tuning" if word == "parameter" else "unknown"
        if word == "parameter" and re.search(r"\bhand\.time\b", origin.text, re.IGNORECASE):
            effect = "tuning"  # what waits for the hand has its time already
        return ir.Vendor("vplus", code_of(origin.text), effect, origin=origin)

    def setting(self, word: str, places: list[SyntaxTree], value: ir.Expression, origin: Origin) -> Lowered | None:
        match word, places:
            case "switch", [name]:
                return self.switched(self.written(name), value, origin)
            case "pack", [text, first, count] if root_name(self.place(text)) is not None:
                return self.pack(self.place(text), self.expression(first), self.expression(count), value, origin)
            case "timer", [number]:
                index = (signals.known(self.expression(number), self.facts),)  # a timer of V+ never stands still
                runs = ir.Assign(ir.System("timer_stopped", index, origin=origin), ir.BoolLiteral(False), origin=origin)
                return ir.Assign(ir.System("timer", index, origin=origin), value, origin=origin), runs
            case "bits", [first, *count] if len(count) <= 1:
                size = signals.known(self.expression(count[0]), self.facts) if count else None
                start = signals.known(self.expression(first), self.facts)
                found = signals.group(start, size, self.facts, origin)
                if found is not None and found.kind == "group_out":
                    return ir.Assign(found, value, origin=origin)
                return signals.soft_bits(start, size, value, self.facts, origin)
            case "aio.out", [number]:
                return ir.Assign(ir.Signal("analog_out", self.expression(number), origin=origin), value, origin=origin)
            case "decompose", [place]:
                return self.decompose(place, value, origin)
        return None

    def switched(self, name: str, value: ir.Expression, origin: Origin) -> Lowered:
        """SWITCH name = value: as ENABLE and DISABLE."""
        if name.lower() == "cp":
            return ir.Assign(ir.System("blending", origin=origin), value, origin=origin)
        harmless = name.partition("[")[0].lower() in tables.SWITCHES_WITHOUT_EFFECT
        return ir.Vendor("vplus", code_of(origin.text), "tuning" if harmless else "unknown", origin=origin)

    def pack(
        self, text: ir.Expression, first: ir.Expression, count: ir.Expression, value: ir.Expression, origin: Origin
    ) -> Lowered:
        """PACK text, first, count = value: so many characters of the text are replaced. M: inside of one element."""
        one = ir.IntLiteral(1)
        behind: ir.Expression = ir.Binary("+", first, count, origin=origin)
        rest: ir.Expression = ir.Binary("-", signals.less(self.built("text_length", text), -1), behind, origin=origin)
        if isinstance(first, ir.IntLiteral) and isinstance(count, ir.IntLiteral):
            behind_number = first.value + count.value
            behind = ir.IntLiteral(behind_number)
            rest = signals.less(self.built("text_length", text), behind_number - 1)
        new = value
        if not isinstance(value, ir.TextLiteral) or not isinstance(count, ir.IntLiteral):
            new = self.part(value, one, count)
        elif len(value.value) != count.value:
            new = ir.TextLiteral(value.value[: count.value])
        head = self.built("text_part", text, one, signals.less(first, 1))
        tail = self.built("text_part", text, behind, rest)
        whole = ir.Binary("&", ir.Binary("&", head, new, origin=origin), tail, origin=origin)
        return ir.Assign(text, whole, origin=origin)

    def decompose(self, tree: SyntaxTree, value: ir.Expression, origin: Origin) -> Lowered:
        """DECOMPOSE array[first] = location: its numbers one after the other."""
        place = self.place(tree)
        base: ir.Expression = place
        outer: tuple[ir.Expression, ...] = ()
        first: ir.Expression = ir.IntLiteral(0)
        if isinstance(place, ir.Index):
            base, outer, first = place.base, place.indices[:-1], place.indices[-1]
        joints = _are_joints(value)
        parts = [ir.Field(value, f"j{n}", origin=origin) for n in range(1, 7)] if joints else _numbers(value, origin)
        done = []
        for step, part in enumerate(parts):
            index = (*outer, signals.less(first, -step))
            done.append(ir.Assign(ir.Index(base, index, origin=origin), part, origin=origin))
        return tuple(done)


def _are_joints(value: ir.Expression) -> bool:
    name = root_name(value)
    if name is not None:
        return name.startswith("#")
    match value:
        case ir.Aggregate(type_name="joints"):
            return True
        case ir.Builtin(function="current_joints" | "target_to_joints"):
            return True
    return False


def _numbers(value: ir.Expression, origin: Origin) -> list[ir.Expression]:
    """x, y, z, yaw, pitch, roll of a transformation."""
    found: list[ir.Expression] = [ir.Field(value, axis, origin=origin) for axis in ("x", "y", "z")]
    found.extend(ir.Builtin(f"zyz_{name}", (value,), origin=origin) for name in ("yaw", "pitch", "roll"))
    return found


def scaled(value: ir.Expression, factor: float, origin: Origin) -> ir.Expression:
    """A value times a constant, calculated at once where it is a number."""
    if factor == 1.0:
        return value
    if isinstance(value, ir.IntLiteral | ir.RealLiteral):
        product = round(value.value * factor, 9)
        return ir.IntLiteral(int(product)) if product.is_integer() else ir.RealLiteral(product)
    return ir.Binary("*", value, ir.RealLiteral(factor), origin=origin)


def share(percent: ir.Expression, full: float, origin: Origin) -> ir.Expression:
    """A percentage of a full speed."""
    return scaled(percent, full / 100.0, origin)


def inverted(place: ir.Expression, origin: Origin) -> ir.Expression:
    return ir.Builtin("inverse", (place,), origin=origin)


def where_world_is(moved: list[ir.Expression], origin: Origin) -> ir.Expression:
    """The world's frame seen from the robot when that has been moved by x, y, z and turned about z (language
    reference, BASE, Details: it compensates for a robot that was moved). M: so the arguments act on places in reverse.
    """
    zero = ir.IntLiteral(0)
    known = [constant(value) for value in moved]
    x, y, z, turn = known
    if turn == 0:
        back = [negated(value, origin) if at is None else literal(-at) for value, at in zip(moved, known, strict=True)]
        return transformation([*back[:3], zero, zero, zero], origin)
    if x is None or y is None or z is None or turn is None:
        return inverted(transformation([*moved, zero, zero], origin), origin)
    there = rigid.Pose(rigid.Vector(x, y, z), rigid.rotation_of_turns((3, turn))).inverse.position
    return transformation([literal(there.x), literal(there.y), literal(there.z), literal(-turn), zero, zero], origin)


def handle(signal: ir.Expression) -> ir.Expression:
    """The signal that a reaction goes by; one with a minus (from on to off) is a known number too."""
    match signal:
        case ir.Unary(op="-", operand=ir.IntLiteral(value=number)):
            return ir.IntLiteral(-number, origin=signal.origin)
    return signal


def urgency(priority: ir.Expression, origin: Origin) -> ir.Expression:
    """V+ priorities grow with their urgency, the neutral ones the other way."""
    if isinstance(priority, ir.IntLiteral):
        return ir.IntLiteral(tables.PRIORITY_TOP - priority.value)
    return ir.Binary("-", ir.IntLiteral(tables.PRIORITY_TOP), priority, origin=origin)


__all__ = ["Settings"]
