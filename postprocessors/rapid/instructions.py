"""The words of the instructions that are not motion: signals, waiting, interrupts, operator, clocks, modal settings."""

from __future__ import annotations

from rpl import ir
from rpl.passes.typing import type_of
from rpl.writing.statements import CannotSayError
from rpl.writing.templates import Macros

from .expressions import Expressions
from .motion import output_value
from .tables import BUTTONS

_CONTROL = {"on": "IWatch", "off": "ISleep", "enable": "IEnable", "disable": "IDisable", "delete": "IDelete"}
_HALT = {"stop": "Stop", "exit": "EXIT", "cycle": "ExitCycle"}
_SETTERS = {"digital_out": "SetDO", "analog_out": "SetAO", "group_out": "SetGO"}
_MEETINGS = {
    "wait": ("WaitSyncTask", "ERR_WAITSYNCTASK"),
    "together": ("SyncMoveOn", "ERR_SYNCMOVEON"),
    "apart": ("SyncMoveOff", "ERR_SYNCMOVEOFF"),
}
_WORDS: dict[type, str] = {
    ir.StartMotion: "StartMove",
    ir.ClearMotion: "ClearPath",
    ir.Retry: "RETRY",
    ir.TryNext: "TRYNEXT",
}
_COUNTING = {"increment": "Incr", "decrement": "Decr", "clear": "Clear"}
_KEYS = 5
_PULSE_S = 0.2  # the length of a pulse that says none
NO_HEADLINE = '"Program"'  # of an error message whose source gives none
_SETTINGS = {"joint_configuration_check": "ConfJ", "path_configuration_check": "ConfL"}
_MODES = {
    "singularity_mode": ("SingArea", {"wrist": "Wrist", "off": "Off", "lock_axis_4": "LockAxis4"}),
    "circle_orientation": ("CirPathMode", {"path": "PathFrame", "base": "ObjectFrame"}),
}
# Settings with the macro of their instruction and its word for them, and what it says of those that stay.
_ALONE = {
    "speed_percent": ("speeds", "percent"),
    "speed_limit": ("speeds", "limit"),
    "acceleration_percent": ("accelerations", "percent"),
    "acceleration_ramp": ("accelerations", "ramp"),
    "stop_ramp": ("accelerations", "stop_ramp"),
    "load": ("grip_load", "load"),
    "override": ("override", "percent"),
}
_STAYING = {
    "speeds": {"percent": "100", "limit": "5000"},
    "accelerations": {"percent": "100", "ramp": "100", "stop_ramp": ""},
}
# Neighbouring settings that one instruction makes together.
_TOGETHER = (
    ("speed_percent", "speed_limit"),
    ("acceleration_percent", "acceleration_ramp", "stop_ramp"),
    ("acceleration_percent", "acceleration_ramp"),
)
_FULL = (ir.IntLiteral(100), ir.RealLiteral(100.0))


class Instructions:
    """The instructions of one scope. Every method raises CannotSayError for what RAPID has not."""

    def __init__(self, expressions: Expressions, macros: Macros) -> None:
        self.expressions = expressions
        self.say = macros
        self.print = expressions.text
        self.signal = expressions.signal

    # ---- assignments

    def assign(self, target: ir.Expression, value: ir.Expression) -> str:
        match target:
            case ir.System(name=name):
                return self.setting(name, value)
            case ir.Signal(kind=kind):
                return self.output(target, kind, value)
            case ir.Name(id=name):
                symbol = self.expressions.scope.value(name)
                if symbol is not None and isinstance(symbol.type, ir.SignalType):
                    return self.output(target, symbol.type.kind, value)
        return self.say("assign", target=self.print(target), value=self.print(value))

    def output(self, target: ir.Expression, kind: str, value: ir.Expression) -> str:
        if kind not in _SETTERS:
            raise CannotSayError("only outputs can be written")
        name = self.signal(target)
        if kind == "digital_out":
            if value == ir.Unary("not", target):
                return self.say("invert", signal=name)
            try:
                number = output_value(kind, value, self.expressions)
            except CannotSayError:
                return self.say("set_by_condition", condition=self.print(value), signal=name)
            return self.say("set_output", word="SetDO", signal=name, value=number)
        return self.say("set_output", word=_SETTERS[kind], signal=name, value=self.print(value))

    def setting(self, name: str, value: ir.Expression) -> str:
        if name in _SETTINGS:
            match value:
                case ir.BoolLiteral(value=truth):
                    return self.say("setting", word=_SETTINGS[name], state="On" if truth else "Off")
            raise CannotSayError("this setting is on or off, not computed")
        if name in _MODES:
            word, modes = _MODES[name]
            match value:
                case ir.EnumLiteral(member=mode) | ir.TextLiteral(value=mode) if mode.lower() in modes:
                    return self.say("setting", word=word, state=modes[mode.lower()])
        if name == "displacement":
            return self.displacement(value)
        if name in _ALONE:
            return self.together({name: value})
        raise CannotSayError(f"there is no setting for {name.replace('_', ' ')}")

    def together(self, values: dict[str, ir.Expression]) -> str:
        """Settings that one instruction makes."""
        macro = _ALONE[next(iter(values))][0]
        words = dict(_STAYING.get(macro, {})) | {_ALONE[name][1]: self.print(one) for name, one in values.items()}
        return self.say(macro, **words)

    def displacement(self, value: ir.Expression) -> str:
        """PDispOff, PDispOn in the form in which it is read, else PDispSet."""
        there: ir.Expression
        match value:
            case ir.System(name="null_frame"):
                return self.say("displacement", frame="")
            case ir.Builtin("compose", (ir.System(name="displacement"), ir.Aggregate() as moved)):
                match moved.entries:
                    case ((_, ir.Binary("-", ir.Field(there, "trans"), ir.Field(point, "trans"))), (_, turn)):
                        if turn == ir.Builtin("rotation_zyx", (ir.IntLiteral(0),) * 3):
                            return self.displacement_on(False, there, point)
            case ir.Builtin("compose", (ir.System(name="displacement"), ir.Builtin("compose", (one, two)))):
                match one, two:
                    case ir.Builtin("pose_of", (there,)), ir.Builtin("inverse", (ir.Builtin("pose_of", (point,)),)):
                        return self.displacement_on(True, there, point)
        return self.say("displacement", frame=self.print(value))

    def displacement_on(self, turned: bool, there: ir.Expression, point: ir.Expression) -> str:
        words = {"there": "", "tool": "tool0", "frame": ""}  # the tool is not asked where both places are given
        match there:
            case ir.Builtin("current_target", (tool, frame)):
                words["frame"] = "" if frame == ir.Name("wobj0") else self.print(frame)
                words["point"], words["tool"] = self.print(point), self.print(tool)
            case _:
                words["there"], words["point"] = self.print(there), self.print(point)
        return self.say("displacement_on", turned=turned, **words)

    def settings(self, body: ir.Body, at: int) -> tuple[int, str]:
        """How many statements from here one instruction says together, and its text; 0 when none."""
        first = body[at]
        if isinstance(first, ir.Dialog) and at + 1 < len(body):
            return self.box(first, body[at + 1])
        if not isinstance(first, ir.Assign) or not isinstance(first.target, ir.System):
            return 0, ""
        for names in _TOGETHER:
            values = {}
            for name, statement in zip(names, body[at : at + len(names)], strict=False):
                match statement:
                    case ir.Assign(target=ir.System(name=found), value=value) if found == name:
                        values[name] = value
            if len(values) == len(names):
                if values.get("stop_ramp") in _FULL:
                    del values["stop_ramp"]
                try:
                    return len(names), self.together(values)
                except CannotSayError:
                    return 0, ""
        return 0, ""

    # ---- everything else

    def text(self, statement: ir.Statement) -> str:
        match statement:
            case ir.Wait(time=time, in_position=stand):
                return self.wait(time, stand)
            case ir.WaitUntil():
                return self.wait_until(statement)
            case ir.WaitForMotion():
                return self.say("word", text="WaitRob\\InPos")
            case ir.Pulse():
                return self.pulse(statement)
            case ir.SetAfter(signal=signal, value=value, delay=delay):
                return self.delayed(signal, value, delay)
            case ir.OrderInterrupt():
                return self.order(statement)
            case ir.ControlInterrupt(op=op, handle=handle):
                if op not in _CONTROL:
                    raise CannotSayError("no urgency of interrupts can be masked")
                if (handle is None) != (op in ("enable", "disable")):
                    raise CannotSayError("IEnable and IDisable work on all interrupts, the others on one")
                on = "" if handle is None else self.print(handle)
                return self.say("control_interrupt", word=_CONTROL[op], handle=on)
            case ir.Meet():
                return self.meet(statement)
            case ir.Message():
                return self.message(statement)
            case ir.Dialog():
                return self.dialog(statement)
            case ir.Clock(op=op, clock=clock):
                return self.say("clock", word=f"Clk{op.capitalize()}", clock=self.print(clock))
            case ir.Do():
                return self.do(statement)
            case ir.Halt(kind=kind):
                return self.say("word", text=_HALT[kind])
            case ir.StopMotion(hard=hard):
                return self.say("word", text="StopMove\\Quick" if hard else "StopMove")
            case ir.StoreMotion(restore=restore):
                return self.say("word", text="RestoPath" if restore else "StorePath")
        if statement.__class__ in _WORDS:
            return self.say("word", text=_WORDS[statement.__class__])
        if isinstance(statement, ir.Opaque):
            raise CannotSayError("it could not be read")
        raise CannotSayError(f"there is no {statement.__class__.__name__} statement")

    def wait(self, time: ir.Expression, stand: bool) -> str:
        return self.say("wait", time=self.print(time), stand=stand)

    def wait_until(self, wait: ir.WaitUntil) -> str:
        limits = {"limit": "", "flag": ""}
        if wait.timeout is not None:
            if wait.timed_out is None and wait.error is None:
                raise CannotSayError("a wait that ends by time needs a flag or an error")
            limits["limit"] = self.print(wait.timeout)
            if wait.timed_out is not None:
                limits["flag"] = self.print(wait.timed_out)
        if not wait.in_position:
            watched, level = wait.condition, "1"
            if isinstance(watched, ir.Unary) and watched.op == "not":
                watched, level = watched.operand, "0"
            match watched:
                case ir.Signal(kind="digital_in" | "digital_out" as kind):
                    word, signal = f"Wait{_short(kind)}", self.signal(watched)
                    return self.say("wait_signal", word=word, signal=signal, level=level, **limits)
        return self.say("wait_until", condition=self.print(wait.condition), stand=wait.in_position, **limits)

    def meet(self, meet: ir.Meet) -> str:
        """Points are variables; what a time-out raises is the instruction's own error."""
        word, error = _MEETINGS[meet.mode]
        if not isinstance(meet.identity, ir.Name | ir.Index):
            raise CannotSayError("tasks meet at a point that a variable names")
        if (meet.timeout is None) != (meet.error is None) or (meet.error or error).upper() != error:
            raise CannotSayError(f"a time-out raises {error}")
        if (meet.tasks is None) != (meet.mode == "apart"):
            raise CannotSayError("SyncMoveOff takes no list of tasks, the others need one")
        return self.say(
            "meet",
            word=word,
            stand=meet.in_position and meet.mode == "wait",
            point=self.print(meet.identity),
            tasks="" if meet.tasks is None else self.print(meet.tasks),
            limit="" if meet.timeout is None else self.print(meet.timeout),
        )

    def pulse(self, pulse: ir.Pulse) -> str:
        name, length = self.signal(pulse.signal), self.print(pulse.duration)
        high = pulse.value == ir.BoolLiteral(True)
        if not high and pulse.value != ir.Unary("not", pulse.signal):
            raise CannotSayError("a pulse goes high or to the opposite")
        if isinstance(pulse.duration, ir.RealLiteral) and pulse.duration.value == _PULSE_S:
            length = ""
        return self.say("pulse", high=high, length=length, signal=name)

    def delayed(self, signal: ir.Expression, value: ir.Expression, delay: ir.Expression) -> str:
        kind = self.kind_of(signal)
        if kind not in _SETTERS:
            raise CannotSayError("only outputs can be written")
        written = output_value(kind, value, self.expressions)
        later, name = self.print(delay), self.signal(signal)
        return self.say("set_after", word=_SETTERS[kind], delay=later, signal=name, value=written)

    def kind_of(self, signal: ir.Expression) -> str:
        """The kind of a signal or of a parameter that stands for one; empty when it is neither."""
        match signal:
            case ir.Signal(kind=kind):
                return kind
        found = type_of(signal, self.expressions.scope)
        return found.kind if isinstance(found, ir.SignalType) else ""

    def order(self, order: ir.OrderInterrupt) -> str:
        handle = self.print(order.handle)
        words = {"once": order.once, "handle": handle, "level": ""}
        match order.event:
            case "timer" if order.time is not None:
                return self.say("order_interrupt", word="ITimer", what=self.print(order.time), **words)
            case "error":
                return self.say("order_error", handle=handle)
        condition = order.condition
        if condition is None:
            raise CannotSayError("an interrupt needs its event")
        level = "1"
        if isinstance(condition, ir.Unary) and condition.op == "not":
            condition, level = condition.operand, "0"
        kind = self.kind_of(condition)
        if order.event == "edge" and kind.startswith("digital"):
            words["level"] = level
            return self.say("order_interrupt", word=f"ISignal{_short(kind)}", what=self.signal(condition), **words)
        if order.event == "change":
            if kind.startswith("digital"):
                words["level"] = "edge"
            if kind.startswith(("digital", "group")):
                return self.say("order_interrupt", word=f"ISignal{_short(kind)}", what=self.signal(condition), **words)
            if not kind:
                return self.say("order_interrupt", word="IPers", what=self.print(condition), **words)
        raise CannotSayError("an interrupt watches one signal")

    # ---- operator and numbers

    def message(self, message: ir.Message) -> str:
        sender = "" if message.sender is None else self.print(message.sender)
        match message.kind:
            case "clear":
                return self.say("word", text="TPErase")
            case "quit":
                return self.say("message_box", header=sender, text=self.print(message.text))
            case "error":
                return self.say("log", information=False, header=sender or NO_HEADLINE, text=self.print(message.text))
            case "notify" if sender:
                return self.say("log", information=True, header=sender, text=self.print(message.text))
        return self.written(message)

    def written(self, message: ir.Message) -> str:
        if message.sender is None:
            return self.say("write", text=self.print(message.text))
        whole = ir.Binary("&", ir.Binary("&", message.sender, ir.TextLiteral(": ")), message.text)
        return self.say("write", text=self.print(whole))

    def dialog(self, dialog: ir.Dialog) -> str:
        if dialog.timed_out is not None:
            raise CannotSayError("a dialog that ends by time raises an error")
        whole = dialog.text
        if dialog.kind == "text":
            return self.asked("UIAlphaEntry", dialog, "")
        if dialog.sender is not None:
            whole = ir.Binary("&", ir.Binary("&", dialog.sender, ir.TextLiteral(": ")), whole)
        answer, text = self.print(dialog.answer), self.print(whole)
        limit = "" if dialog.timeout is None else self.print(dialog.timeout)
        if dialog.kind == "number":
            return self.say("ask_number", answer=answer, text=text, limit=limit)
        if len(dialog.keys) > _KEYS:
            raise CannotSayError("a dialog has five keys")
        keys = ["stEmpty" if key is None else self.print(key) for key in dialog.keys]
        keys += ["stEmpty"] * (_KEYS - len(keys))
        return self.say("ask_key", answer=answer, text=text, keys=keys, limit=limit)

    def box(self, dialog: ir.Dialog, behind: ir.Statement) -> tuple[int, str]:
        """A choice of predefined buttons and the statement that makes the controller's numbers of the keys."""
        keys = [key.value if isinstance(key, ir.TextLiteral) else None for key in dialog.keys]
        for name, buttons in BUTTONS.items():
            if keys != [word for word, _ in buttons] or dialog.kind != "keys" or dialog.timed_out is not None:
                continue
            becomes = [(ir.Assign(dialog.answer, ir.IntLiteral(number)),) for _, number in buttons]
            is_key = [ir.Binary("=", dialog.answer, ir.IntLiteral(1 + place)) for place in range(len(buttons) - 1)]
            if behind == ir.If(tuple(zip(is_key, becomes, strict=False)), becomes[-1]):
                try:
                    return 2, self.asked("UIMessageBox", dialog, name)
                except CannotSayError:
                    return 0, ""
        return 0, ""

    def asked(self, function: str, dialog: ir.Dialog, buttons: str) -> str:
        """One of the functions that show a message and give the operator's answer."""
        return self.say(
            "ask",
            function=function,
            header="" if dialog.sender is None else self.print(dialog.sender),
            limit="" if dialog.timeout is None else self.print(dialog.timeout),
            text=self.print(dialog.text),
            buttons=buttons,
            answer=self.print(dialog.answer),
        )

    def do(self, do: ir.Do) -> str:
        arguments = [argument for argument in do.arguments if argument is not None]
        printed = [self.print(argument) for argument in arguments]
        match do.procedure, printed:
            case "increment" | "decrement" | "clear", [one]:
                return self.say("count", word=_COUNTING[do.procedure], target=one)
            case "increment", [one, by]:
                return self.say("add", target=one, value=by)
            case "decrement", [one, _]:
                return self.say("add", target=one, value=self.print(ir.Unary("-", arguments[1])))
            case "text_append", [one, text]:
                return self.say("assign", target=one, value=f"{one}+{text}")
            case "text_copy", [one, text]:
                return self.say("assign", target=one, value=text)
            case "text_clear", [one]:
                return self.say("assign", target=one, value='""')
            case "parse_value" | "parse_number", [text, one]:
                return self.say("parse", text=text, target=one)
        raise CannotSayError(f"there is no instruction for {do.procedure.replace('_', ' ')}")


def _short(kind: str) -> str:
    """DI, DO, GI, GO, AI, AO."""
    what, _, way = kind.partition("_")
    return f"{what[0].upper()}{way[0].upper()}"
