"""Write the instructions that are not motion: signals, waiting, interrupts, operator, clocks, modal settings."""

from __future__ import annotations

from rpl import ir
from rpl.passes.typing import type_of
from rpl.writing.statements import CannotSayError

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
_KEYS = 5
NO_HEADLINE = '"Program"'  # of an error message whose source gives none
_SETTINGS = {"joint_configuration_check": "ConfJ", "path_configuration_check": "ConfL"}
_MODES = {
    "singularity_mode": ("SingArea", {"wrist": "Wrist", "off": "Off", "lock_axis_4": "LockAxis4"}),
    "circle_orientation": ("CirPathMode", {"path": "PathFrame", "base": "ObjectFrame"}),
}
# Neighbouring settings that one instruction makes together.
_TOGETHER = (
    (("speed_percent", "speed_limit"), "VelSet {0},{1};"),
    (("acceleration_percent", "acceleration_ramp", "stop_ramp"), "AccSet {0},{1}\\FinePointRamp:={2};"),
    (("acceleration_percent", "acceleration_ramp"), "AccSet {0},{1};"),
)
_FULL_STOPS = "AccSet {0},{1};"
_FULL = (ir.IntLiteral(100), ir.RealLiteral(100.0))
_ALONE = {
    "speed_percent": "VelSet {0},5000;",
    "speed_limit": "VelSet 100,{0};",
    "acceleration_percent": "AccSet {0},100;",
    "acceleration_ramp": "AccSet 100,{0};",
    "stop_ramp": "AccSet 100,100\\FinePointRamp:={0};",
    "load": "GripLoad {0};",
    "override": "SpeedRefresh {0};",
}


class Instructions:
    """The instructions of one scope. Every method raises CannotSayError for what RAPID has not."""

    def __init__(self, expressions: Expressions) -> None:
        self.expressions = expressions
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
        return f"{self.print(target)}:={self.print(value)};"

    def output(self, target: ir.Expression, kind: str, value: ir.Expression) -> str:
        if kind not in _SETTERS:
            raise CannotSayError("only outputs can be written")
        name = self.signal(target)
        if kind == "digital_out":
            if value == ir.Unary("not", target):
                return f"InvertDO {name};"
            try:
                return f"SetDO {name},{output_value(kind, value, self.expressions)};"
            except CannotSayError:
                condition = self.print(value)
                return f"IF {condition} THEN\n  SetDO {name},1;\nELSE\n  SetDO {name},0;\nENDIF"
        return f"{_SETTERS[kind]} {name},{self.print(value)};"

    def setting(self, name: str, value: ir.Expression) -> str:
        if name in _SETTINGS:
            match value:
                case ir.BoolLiteral(value=truth):
                    return f"{_SETTINGS[name]}\\{'On' if truth else 'Off'};"
            raise CannotSayError("this setting is on or off, not computed")
        if name in _MODES:
            word, modes = _MODES[name]
            match value:
                case ir.EnumLiteral(member=mode) | ir.TextLiteral(value=mode) if mode.lower() in modes:
                    return f"{word}\\{modes[mode.lower()]};"
        if name == "displacement":
            return self.displacement(value)
        if name in _ALONE:
            return _ALONE[name].format(self.print(value))
        raise CannotSayError(f"there is no setting for {name.replace('_', ' ')}")

    def displacement(self, value: ir.Expression) -> str:
        """PDispOff, PDispOn in the form in which it is read, else PDispSet."""
        there: ir.Expression
        match value:
            case ir.System(name="null_frame"):
                return "PDispOff;"
            case ir.Builtin("compose", (ir.System(name="displacement"), ir.Aggregate() as moved)):
                match moved.entries:
                    case ((_, ir.Binary("-", ir.Field(there, "trans"), ir.Field(point, "trans"))), (_, turn)):
                        if turn == ir.Builtin("rotation_zyx", (ir.IntLiteral(0),) * 3):
                            return self.displacement_on("", there, point)
            case ir.Builtin("compose", (ir.System(name="displacement"), ir.Builtin("compose", (one, two)))):
                match one, two:
                    case ir.Builtin("pose_of", (there,)), ir.Builtin("inverse", (ir.Builtin("pose_of", (point,)),)):
                        return self.displacement_on("\\Rot", there, point)
        return f"PDispSet {self.print(value)};"

    def displacement_on(self, turned: str, there: ir.Expression, point: ir.Expression) -> str:
        match there:
            case ir.Builtin("current_target", (tool, frame)):
                first = f"PDispOn{turned}," if turned else "PDispOn "
                last = "" if frame == ir.Name("wobj0") else f"\\WObj:={self.print(frame)}"
                return f"{first}{self.print(point)},{self.print(tool)}{last};"
        return f"PDispOn{turned}\\ExeP:={self.print(there)},{self.print(point)},tool0;"  # the tool is not asked then

    def settings(self, body: ir.Body, at: int) -> tuple[int, str]:
        """How many statements from here one instruction says together, and its text; 0 when none."""
        first = body[at]
        if isinstance(first, ir.Dialog) and at + 1 < len(body):
            return self.box(first, body[at + 1])
        if not isinstance(first, ir.Assign) or not isinstance(first.target, ir.System):
            return 0, ""
        for names, pattern in _TOGETHER:
            values = []
            for name, statement in zip(names, body[at : at + len(names)], strict=False):
                match statement:
                    case ir.Assign(target=ir.System(name=found), value=value) if found == name:
                        values.append(value)
            if len(values) == len(names):
                if names[-1] == "stop_ramp" and values[-1] in _FULL:
                    pattern = _FULL_STOPS
                try:
                    return len(values), pattern.format(*map(self.print, values))
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
                return "WaitRob\\InPos;"
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
                return f"{_CONTROL[op]}{'' if handle is None else ' ' + self.print(handle)};"
            case ir.Meet():
                return self.meet(statement)
            case ir.Message():
                return self.message(statement)
            case ir.Dialog():
                return self.dialog(statement)
            case ir.Clock(op=op, clock=clock):
                return f"Clk{op.capitalize()} {self.print(clock)};"
            case ir.Do():
                return self.do(statement)
            case ir.Halt(kind=kind):
                return f"{_HALT[kind]};"
            case ir.StopMotion(hard=hard):
                return "StopMove\\Quick;" if hard else "StopMove;"
            case ir.StoreMotion(restore=restore):
                return "RestoPath;" if restore else "StorePath;"
        words: dict[type, str] = {
            ir.StartMotion: "StartMove;",
            ir.ClearMotion: "ClearPath;",
            ir.Retry: "RETRY;",
            ir.TryNext: "TRYNEXT;",
        }
        if statement.__class__ in words:
            return words[statement.__class__]
        if isinstance(statement, ir.Opaque):
            raise CannotSayError("it could not be read")
        raise CannotSayError(f"there is no {statement.__class__.__name__} statement")

    def wait(self, time: ir.Expression, stand: bool) -> str:
        return f"WaitTime\\InPos,{self.print(time)};" if stand else f"WaitTime {self.print(time)};"

    def wait_until(self, wait: ir.WaitUntil) -> str:
        options = ""
        if wait.timeout is not None:
            if wait.timed_out is None and wait.error is None:
                raise CannotSayError("a wait that ends by time needs a flag or an error")
            options = f"\\MaxTime:={self.print(wait.timeout)}"
            if wait.timed_out is not None:
                options += f"\\TimeFlag:={self.print(wait.timed_out)}"
        if not wait.in_position:
            match wait.condition:
                case ir.Signal(kind="digital_in" | "digital_out" as kind):
                    return f"Wait{_short(kind)} {self.signal(wait.condition)},1{options};"
                case ir.Unary(op="not", operand=ir.Signal(kind="digital_in" | "digital_out" as kind) as signal):
                    return f"Wait{_short(kind)} {self.signal(signal)},0{options};"
        stand = "\\InPos," if wait.in_position else " "
        return f"WaitUntil{stand}{self.print(wait.condition)}{options};"

    def meet(self, meet: ir.Meet) -> str:
        """Points are variables; what a time-out raises is the instruction's own error."""
        word, error = _MEETINGS[meet.mode]
        if not isinstance(meet.identity, ir.Name | ir.Index):
            raise CannotSayError("tasks meet at a point that a variable names")
        if (meet.timeout is None) != (meet.error is None) or (meet.error or error).upper() != error:
            raise CannotSayError(f"a time-out raises {error}")
        if (meet.tasks is None) != (meet.mode == "apart"):
            raise CannotSayError("SyncMoveOff takes no list of tasks, the others need one")
        given = "\\InPos," if meet.in_position and meet.mode == "wait" else " "
        given += self.print(meet.identity) + ("" if meet.tasks is None else f",{self.print(meet.tasks)}")
        limit = "" if meet.timeout is None else f"\\TimeOut:={self.print(meet.timeout)}"
        return f"{word}{given}{limit};"

    def pulse(self, pulse: ir.Pulse) -> str:
        name, length = self.signal(pulse.signal), self.print(pulse.duration)
        if pulse.value == ir.BoolLiteral(True):
            return f"PulseDO\\High\\PLength:={length},{name};"
        if pulse.value == ir.Unary("not", pulse.signal):
            return f"PulseDO\\PLength:={length},{name};"
        raise CannotSayError("a pulse goes high or to the opposite")

    def delayed(self, signal: ir.Expression, value: ir.Expression, delay: ir.Expression) -> str:
        kind = self.kind_of(signal)
        if kind not in _SETTERS:
            raise CannotSayError("only outputs can be written")
        written = output_value(kind, value, self.expressions)
        return f"{_SETTERS[kind]}\\SDelay:={self.print(delay)},{self.signal(signal)},{written};"

    def kind_of(self, signal: ir.Expression) -> str:
        """The kind of a signal or of a parameter that stands for one; empty when it is neither."""
        match signal:
            case ir.Signal(kind=kind):
                return kind
        found = type_of(signal, self.expressions.scope)
        return found.kind if isinstance(found, ir.SignalType) else ""

    def order(self, order: ir.OrderInterrupt) -> str:
        handle = self.print(order.handle)
        single = "\\Single," if order.once else " "
        match order.event:
            case "timer" if order.time is not None:
                return f"ITimer{single}{self.print(order.time)},{handle};"
            case "error":
                return f"IError COMMON_ERR,TYPE_ALL,{handle};"
        condition = order.condition
        if condition is None:
            raise CannotSayError("an interrupt needs its event")
        level = "1"
        if isinstance(condition, ir.Unary) and condition.op == "not":
            condition, level = condition.operand, "0"
        kind = self.kind_of(condition)
        if order.event == "edge" and kind.startswith("digital"):
            return f"ISignal{_short(kind)}{single}{self.signal(condition)},{level},{handle};"
        if order.event == "change":
            if kind.startswith("digital"):
                return f"ISignal{_short(kind)}{single}{self.signal(condition)},edge,{handle};"
            if kind.startswith("group"):
                return f"ISignal{_short(kind)}{single}{self.signal(condition)},{handle};"
            if not kind:
                return f"IPers{single}{self.print(condition)},{handle};"
        raise CannotSayError("an interrupt watches one signal")

    # ---- operator and numbers

    def message(self, message: ir.Message) -> str:
        sender = None if message.sender is None else self.print(message.sender)
        match message.kind:
            case "clear":
                return "TPErase;"
            case "quit":
                head = " " if sender is None else f"\\Header:={sender},"
                return f"UIMsgBox{head}{self.print(message.text)};"
            case "error":
                return f"ErrWrite {sender or NO_HEADLINE},{self.print(message.text)};"
            case "notify" if sender is not None:
                return f"ErrWrite\\I,{sender},{self.print(message.text)};"
        return self.written(message)

    def written(self, message: ir.Message) -> str:
        if message.sender is None:
            return f"TPWrite {self.print(message.text)};"
        whole = ir.Binary("&", ir.Binary("&", message.sender, ir.TextLiteral(": ")), message.text)
        return f"TPWrite {self.print(whole)};"

    def dialog(self, dialog: ir.Dialog) -> str:
        if dialog.timed_out is not None:
            raise CannotSayError("a dialog that ends by time raises an error")
        whole = dialog.text
        if dialog.kind == "text":
            return self.asked("UIAlphaEntry", dialog, "")
        if dialog.sender is not None:
            whole = ir.Binary("&", ir.Binary("&", dialog.sender, ir.TextLiteral(": ")), whole)
        answer, text = self.print(dialog.answer), self.print(whole)
        time = "" if dialog.timeout is None else f"\\MaxTime:={self.print(dialog.timeout)}"
        if dialog.kind == "number":
            return f"TPReadNum {answer},{text}{time};"
        if len(dialog.keys) > _KEYS:
            raise CannotSayError("a dialog has five keys")
        keys = ["stEmpty" if key is None else self.print(key) for key in dialog.keys]
        keys += ["stEmpty"] * (_KEYS - len(keys))
        return f"TPReadFK {answer},{text},{','.join(keys)}{time};"

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
                    return 2, self.asked("UIMessageBox", dialog, f"\\Buttons:={name}")
                except CannotSayError:
                    return 0, ""
        return 0, ""

    def asked(self, function: str, dialog: ir.Dialog, options: str) -> str:
        """One of the functions that show a message and give the operator's answer."""
        header = "" if dialog.sender is None else f"\\Header:={self.print(dialog.sender)}"
        time = "" if dialog.timeout is None else f"\\MaxTime:={self.print(dialog.timeout)}"
        shown = f"{function}({header}\\Message:={self.print(dialog.text)}{options}{time})"
        return f"{self.print(dialog.answer)}:={shown};"

    def do(self, do: ir.Do) -> str:
        arguments = [argument for argument in do.arguments if argument is not None]
        printed = [self.print(argument) for argument in arguments]
        match do.procedure, len(printed):
            case "increment", 1:
                return f"Incr {printed[0]};"
            case "increment", 2:
                return f"Add {printed[0]},{printed[1]};"
            case "decrement", 1:
                return f"Decr {printed[0]};"
            case "decrement", 2:
                return f"Add {printed[0]},{self.print(ir.Unary('-', arguments[1]))};"
            case "clear", 1:
                return f"Clear {printed[0]};"
            case "text_append", 2:
                return f"{printed[0]}:={printed[0]}+{printed[1]};"
            case "text_copy", 2:
                return f"{printed[0]}:={printed[1]};"
            case "text_clear", 1:
                return f'{printed[0]}:="";'
            case "parse_value" | "parse_number", 2:
                return f"IF StrToVal({printed[0]},{printed[1]}) THEN\nENDIF"
        raise CannotSayError(f"there is no instruction for {do.procedure.replace('_', ' ')}")


def _short(kind: str) -> str:
    """DI, DO, GI, GO, AI, AO."""
    what, _, way = kind.partition("_")
    return f"{what[0].upper()}{way[0].upper()}"
