"""The functions and instructions of VAL3 by their names: what each becomes in the IR."""

from __future__ import annotations

from collections.abc import Callable

from rpl import ir
from rpl.reading.shapes import StatementError, SyntaxTree
from rpl.registry import words

from .expressions import Expressions, as_text
from .facts import Facts
from .places import WORLD, Value, composed, inverted, moved_to, number_of
from .rules import CYCLE_S

# Functions of numbers that have one name in each language.
_PLAIN = words("val3").pairs("functions") | {"round": "round", "trunc": "trunc", "sgn": "sign"}
# Instructions that concern only the controller itself or its screen.
_TUNING = frozenset(("enablePower", "autoConnectMove", "dioLink", "aioLink", "setVersion", "taskSetPriority"))
_SCREEN = frozenset(("userPage", "gotoxy", "title", "setTextMode"))
_RUNS, _GONE = 1, -1


class Calls(Expressions):
    """Functions and instructions; `before`: what has to be done in front of the statement at hand."""

    def __init__(self, facts: Facts) -> None:
        super().__init__(facts)
        self.before: list[ir.Statement] = []
        self.helpers: list[ir.Variable] = []  # variables of the routine at hand that the reading puts in
        self.functions.update({name: self.plain(neutral) for name, neutral in _PLAIN.items()})
        self.functions.update(
            {
                "appro": self.appro, "compose": self.compose, "here": self.here, "herej": self.here_joints,
                "distance": self.distance, "position": self.position, "jointToPoint": self.joint_to_point,
                "pointToJoint": self.point_to_joint, "interpolateL": self.interpolated, "limit": self.limit,
                "sel": self.chosen, "size": self.size, "clock": self.clock, "watch": self.watch,
                "len": self.length, "mid": self.middle, "left": self.left, "right": self.right, "find": self.find,
                "chr": self.character, "asc": self.code, "toString": self.to_string, "aioGet": self.signal_value,
                "isEmpty": self.at_rest, "isSettled": self.at_rest, "isPowered": self.powered,
                "getKey": self.key,
                "taskStatus": self.task_status, "getMonitorSpeed": self.override, "setFrame": self.set_frame,
            }
        )  # fmt: skip
        self.instructions: dict[str, Callable[[list[SyntaxTree]], tuple[ir.Statement, ...]]] = {
            "waitEndMove": lambda items: (ir.WaitForMotion(origin=self.origin),),
            "stopMove": lambda items: (ir.StopMotion(origin=self.origin),),
            "restartMove": lambda items: (ir.StartMotion(origin=self.origin),),
            "resetMotion": lambda items: (ir.StopMotion(origin=self.origin), ir.ClearMotion(origin=self.origin)),
            "open": lambda items: self.hand(items, True),
            "close": lambda items: self.hand(items, False),
            "delay": self.delay,
            "wait": self.wait,
            "setMonitorSpeed": self.monitor_speed,
            "aioSet": self.set_signal,
            **{word: self.message(kind) for word, kind in words("val3").pairs("messages").items()},
            "put": self.message("write"),
            "logMsg": self.message("notify"),
            "cls": lambda items: (ir.Message("clear", ir.TextLiteral(""), origin=self.origin),),
            **{word: self.task(op) for word, op in words("val3").pairs("tasks").items()},
        }

    # ---- functions

    def plain(self, neutral: str) -> Callable[[list[SyntaxTree]], Value]:
        count = len(ir.FUNCTIONS[neutral].parameters.replace("i?", ""))

        def made(items: list[SyntaxTree]) -> Value:
            if len(items) != count:
                raise StatementError("the function has other arguments", 0)
            return Value(ir.Builtin(neutral, tuple(map(self.number, items)), origin=self.origin), "num")

        return made

    def built(self, function: str, *arguments: ir.Expression) -> ir.Builtin:
        return ir.Builtin(function, arguments, origin=self.origin)

    def appro(self, items: list[SyntaxTree]) -> Value:
        """appro(point, trsf): moved in its own axes."""
        point, shift = self.value(items[0], "point"), self.value(items[1], "trsf").node
        match shift:
            case ir.Aggregate(entries=entries) if [number_of(part) for _, part in entries[3:]] == [0.0] * 3:
                node = self.built("tool_offset", point.node, *(part for _, part in entries[:3]))
            case ir.Builtin("tool_offset", (first, *parts)) if first == WORLD:
                node = self.built("tool_offset", point.node, *parts)
            case _:
                node = self.built("displaced_in_tool", point.node, shift)
        return Value(node, "point", point.place)

    def compose(self, items: list[SyntaxTree]) -> Value:
        """compose(point, frame, trsf): moved in the axes of the frame, about its origin."""
        point, frame = self.value(items[0], "point"), self.value(items[1], "frame")
        shift = self.value(items[2], "trsf").node
        if frame.place != point.place:
            between = composed(inverted(point.place), frame.place)
            shift = composed(composed(between, shift), inverted(between))
        straight = isinstance(shift, ir.Aggregate) and [number_of(p) for _, p in shift.entries[3:]] == [0.0] * 3
        if straight and isinstance(shift, ir.Aggregate):
            node = self.built("offset", point.node, *(part for _, part in shift.entries[:3]))
        else:
            node = self.built("displaced", point.node, shift)
        return Value(node, "point", point.place)

    def here(self, items: list[SyntaxTree]) -> Value:
        """here(tool, frame): where the tool is when the statement is executed, not when the last movement ends."""
        tool, frame = self.value(items[0], "tool").place, self.value(items[1], "frame").place
        return Value(self.built("current_target", tool, frame), "point", frame)

    def here_joints(self, items: list[SyntaxTree]) -> Value:
        return Value(self.built("current_joints"), "joint")

    def in_world(self, point: Value) -> ir.Expression:
        pose = point.node if point.kind == "trsf" else self.built("pose_of", point.node)
        return composed(point.place, pose) if point.kind == "point" else pose

    def distance(self, items: list[SyntaxTree]) -> Value:
        one, other = (self.value(item) for item in items)
        same = one.place == other.place
        parts = [ir.Field(point.node if same else self.in_world(point), "trans") for point in (one, other)]
        return Value(self.built("distance", *parts), "num")

    def position(self, items: list[SyntaxTree]) -> Value:
        """position(point, frame): its trsf as seen from the frame."""
        point, frame = self.value(items[0], "point"), self.value(items[1], "frame")
        if frame.place == point.place:
            return Value(self.built("pose_of", point.node), "trsf")
        return Value(composed(inverted(frame.place), self.in_world(point)), "trsf")

    def joint_to_point(self, items: list[SyntaxTree]) -> Value:
        tool, frame = self.value(items[0], "tool").place, self.value(items[1], "frame").place
        joints = self.value(items[2], "joint").node
        return Value(self.built("joints_to_target", joints, tool, frame), "point", frame)

    def point_to_joint(self, items: list[SyntaxTree]) -> Value:
        """pointToJoint(tool, near, point, result): is there a solution; the result is only set when there is."""
        tool, near = self.value(items[0], "tool").place, self.value(items[1], "joint").node
        point, result = self.value(items[2], "point"), self.value(items[3], "joint").node
        given = (point.node, near, tool, point.place)
        solved = ir.Assign(result, self.built("target_to_joints_near", *given), origin=self.origin)
        found = self.helper(self.built("is_reachable", *given))
        self.before.append(ir.If(((found, (solved,)),), origin=self.origin))
        return Value(found, "bool")

    def helper(self, value: ir.Expression | None) -> ir.Name:
        """A variable of the routine that holds a truth for the statement at hand."""
        name = f"val3_answer{len(self.helpers) + 1}"
        self.helpers.append(ir.Variable(name, ir.BoolType(), ir.BoolLiteral(False), scope="routine"))
        if value is not None:
            self.before.append(ir.Assign(ir.Name(name), value, origin=self.origin))
        return ir.Name(name)

    def watch(self, items: list[SyntaxTree]) -> Value:
        """watch(condition, seconds): waits; true when the condition came in time."""
        late = self.helper(ir.BoolLiteral(False))
        condition, limit = self.value(items[0]).node, self.number(items[1])
        self.before.append(ir.WaitUntil(condition, timeout=limit, timed_out=late, origin=self.origin))
        return Value(ir.Unary("not", late), "bool")

    def set_frame(self, items: list[SyntaxTree]) -> Value:
        """setFrame(origin, on x, in xy, frame): sets the frame from three points; 0 when they make one."""
        frame = self.value(items[3], "frame")
        father = composed(frame.place, inverted(frame.node)) if frame.place != frame.node else WORLD
        match frame.place:
            case ir.Binary(op=":", left=left, right=right) if right == frame.node:
                father = left
        points = [ir.Field(moved_to(self.value(item, "point"), father), "trans") for item in items[:3]]
        self.before.append(ir.Assign(frame.node, self.built("frame_from_points", *points), origin=self.origin))
        return Value(ir.IntLiteral(0), "num")

    def interpolated(self, items: list[SyntaxTree]) -> Value:
        one, other = self.value(items[0], "trsf").node, self.value(items[1], "trsf").node
        return Value(self.built("interpolate_pose", one, other, self.number(items[2])), "trsf")

    def limit(self, items: list[SyntaxTree]) -> Value:
        value, least, most = map(self.number, items)
        return Value(self.built("min", self.built("max", value, least), most), "num")

    def chosen(self, items: list[SyntaxTree]) -> Value:
        """sel(condition, one, other): both are worked out."""
        condition, one, other = self.value(items[0]).node, self.number(items[1]), self.number(items[2])
        bit = ir.Convert("bit", condition)
        return Value(ir.Binary("+", other, ir.Binary("*", bit, ir.Binary("-", one, other))), "num")

    def size(self, items: list[SyntaxTree]) -> Value:
        tree = items[0]
        if tree.data != "name":
            raise StatementError("size needs a name", 0)
        value, is_array = self.named(str(tree.children[0]))
        datum = self.facts.data.get(str(tree.children[0]))
        if datum is not None:
            which = number_of(self.number(items[1])) if len(items) > 1 else 1
            return Value(ir.IntLiteral(datum.sizes[int(which or 1) - 1]), "num")
        return Value(self.built("length", value.node) if is_array else ir.IntLiteral(1), "num")

    def clock(self, items: list[SyntaxTree]) -> Value:
        return Value(ir.System("time", origin=self.origin), "num")

    def override(self, items: list[SyntaxTree]) -> Value:
        return Value(ir.System("override", origin=self.origin), "num")

    def at_rest(self, items: list[SyntaxTree]) -> Value:
        return Value(ir.Unary("not", ir.System("moving", origin=self.origin)), "bool")

    def key(self, items: list[SyntaxTree]) -> Value:
        """The key that the operator has pressed last, -1 for none: only the cell can say."""
        return Value(ir.VendorValue("val3", "getKey()", ir.RealType(), origin=self.origin), "num")

    def powered(self, items: list[SyntaxTree]) -> Value:
        """A program that runs has power on its arm."""
        return Value(ir.BoolLiteral(True), "bool")

    def task_status(self, items: list[SyntaxTree]) -> Value:
        runs = ir.Convert("bit", self.built("task_runs", ir.TextLiteral(self.task_of(items[0]))))
        scaled = ir.Binary("*", runs, ir.IntLiteral(_RUNS - _GONE))
        return Value(ir.Binary("+", scaled, ir.IntLiteral(_GONE)), "num")

    def task_of(self, tree: SyntaxTree) -> str:
        """The program of a task: by its name, or by the text that has it."""
        value = self.value(tree).node
        name = value.value if isinstance(value, ir.TextLiteral) else getattr(value, "id", "")
        if name not in self.facts.tasks:
            raise StatementError(f"no task is created with the name {name or 'that is worked out here'}", 0)
        return self.facts.tasks[name]

    def signal_value(self, items: list[SyntaxTree]) -> Value:
        return Value(self.value(items[0]).node, "num")

    # ---- texts: positions count from 0

    def length(self, items: list[SyntaxTree]) -> Value:
        return Value(self.built("text_length", self.value(items[0]).node), "num")

    def middle(self, items: list[SyntaxTree]) -> Value:
        """mid(text, count, position)."""
        text, count, at = self.value(items[0]).node, self.number(items[1]), self.number(items[2])
        return Value(self.built("text_part", text, _next(at), count), "string")

    def left(self, items: list[SyntaxTree]) -> Value:
        text, count = self.value(items[0]).node, self.number(items[1])
        return Value(self.built("text_part", text, ir.IntLiteral(1), count), "string")

    def right(self, items: list[SyntaxTree]) -> Value:
        text, count = self.value(items[0]).node, self.number(items[1])
        begin = ir.Binary("-", _next(self.built("text_length", text)), count)
        return Value(self.built("text_part", text, begin, count), "string")

    def find(self, items: list[SyntaxTree]) -> Value:
        """find(text, part): the position, -1 where there is none."""
        text, part = self.value(items[0]).node, self.value(items[1]).node
        found = self.built("text_find", text, ir.IntLiteral(1), part)
        return Value(ir.Binary("-", found, ir.IntLiteral(1)), "num")

    def character(self, items: list[SyntaxTree]) -> Value:
        return Value(self.built("from_code", self.number(items[0])), "string")

    def code(self, items: list[SyntaxTree]) -> Value:
        """asc(text, position)."""
        text, at = self.value(items[0]).node, self.number(items[1])
        return Value(self.built("character_code", self.built("text_part", text, _next(at), ir.IntLiteral(1))), "num")

    def to_string(self, items: list[SyntaxTree]) -> Value:
        """toString("size.decimals", number)."""
        form, number = self.value(items[0]).node, self.number(items[1])
        if not isinstance(form, ir.TextLiteral):
            raise StatementError("the format of a number has to be a constant", 0)
        size, _, decimals = form.value.partition(".")
        places = ir.IntLiteral(int(decimals or 0))
        if size.strip("01") == "":
            return Value(self.built("number_text", number, places) if decimals else as_text(Value(number)), "string")
        return Value(self.built("format", ir.TextLiteral(f"%{size}.{places.value}f"), number), "string")

    # ---- instructions

    def hand(self, items: list[SyntaxTree], opens: bool) -> tuple[ir.Statement, ...]:
        """open(tool), close(tool): behind the motion; then the tool's time passes."""
        tree = items[0]
        name = str(tree.children[0]) if tree.data == "name" else ""
        datum = self.facts.data.get(name)
        given = datum.values.get(0, {}) if datum is not None else {}
        link = given.get("link", "").rpartition("\\")[2].rpartition(":")[2]
        if not link:
            raise StatementError(f"the tool {name or 'named here'} is wired to no output", 0)
        signal = ir.Signal("digital_out", name=link)
        done: list[ir.Statement] = [
            ir.WaitForMotion(origin=self.origin),
            ir.Assign(signal, ir.BoolLiteral(opens), origin=self.origin),
        ]
        seconds = float(given.get("open" if opens else "close", given.get("otime" if opens else "ctime", "0")))
        if seconds > 0.0:
            done.append(ir.Wait(ir.RealLiteral(seconds), origin=self.origin))
        return tuple(done)

    def delay(self, items: list[SyntaxTree]) -> tuple[ir.Statement, ...]:
        time = self.number(items[0])
        if number_of(time) == 0.0:
            time = ir.RealLiteral(CYCLE_S)
        return (ir.Wait(time, origin=self.origin),)

    def wait(self, items: list[SyntaxTree]) -> tuple[ir.Statement, ...]:
        return (ir.WaitUntil(self.value(items[0]).node, origin=self.origin),)

    def monitor_speed(self, items: list[SyntaxTree]) -> tuple[ir.Statement, ...]:
        return (ir.Assign(ir.System("override"), self.number(items[0]), origin=self.origin),)

    def set_signal(self, items: list[SyntaxTree]) -> tuple[ir.Statement, ...]:
        return (ir.Assign(self.value(items[0]).node, self.number(items[1]), origin=self.origin),)

    def message(self, kind: str) -> Callable[[list[SyntaxTree]], tuple[ir.Statement, ...]]:
        return lambda items: (ir.Message(kind, as_text(self.value(items[0])), origin=self.origin),)

    def task(self, op: str) -> Callable[[list[SyntaxTree]], tuple[ir.Statement, ...]]:
        return lambda items: (ir.TaskControl(op, self.task_of(items[0]), origin=self.origin),)

    def perform(self, name: str, items: list[SyntaxTree], text: str) -> tuple[ir.Statement, ...]:
        """An instruction that is no movement."""
        if name in ("watch", "setFrame", "pointToJoint"):
            self.functions[name](items)
            return ()
        if name in _TUNING:
            return (ir.Vendor("val3", text, "tuning", origin=self.origin),)
        if name in _SCREEN:
            return (ir.Vendor("val3", text, "none", origin=self.origin),)
        made = self.instructions.get(name)
        if made is None:
            return (ir.Vendor("val3", text, "unknown", origin=self.origin),)
        try:
            return made(items)
        except (IndexError, ValueError):
            raise StatementError(f"{name} has other arguments", 0) from None


def _next(position: ir.Expression) -> ir.Expression:
    """A position that counts from 1."""
    match position:
        case ir.IntLiteral(value=value):
            return ir.IntLiteral(value + 1)
    return ir.Binary("+", position, ir.IntLiteral(1))
