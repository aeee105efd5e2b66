"""Statements to the IR: assignments, calls as statements, control flow, threads."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.source import Origin

from . import nodes
from .arguments import Bound, given
from .blends import check_blends
from .calls import Calls, as_text, one_more
from .expressions import BUILTINS, pose_literal, pose_part
from .functions import BindError, bind, constant
from .kinds import BOOL, INT, REAL, Kind
from .moves import MOVES, Made, Make, literal
from .nodes import Block, Expr, Node, shown
from .rules import STEP_TIME_S
from .scopes import Function

NO_LOOP = code("urscript-no-loop", Severity.ERROR, "{word} outside of a loop")
THREAD = code(
    "urscript-thread",
    Severity.WARNING,
    "{text} is kept as text: nothing tells which thread it means",
    "store the value of run in a variable of its own",
)
# Questions to the operator, and the kind of answer.
_ASKED = {
    "request_integer_from_primary_client": "number",
    "request_float_from_primary_client": "number",
    "request_string_from_primary_client": "text",
}
_STEP = ir.RealLiteral(STEP_TIME_S, str(STEP_TIME_S))


@dataclass(frozen=True, slots=True)
class Body:
    """A function's statements in the IR, and the helper variables they need."""

    statements: ir.Body
    helpers: tuple[ir.Variable, ...]


class Statements(Calls):
    """Lowers the statements of one function."""

    def body(self) -> Body:
        self.apply = self.call
        made = self.block(self.here.node.body)
        return Body(made, tuple(self.helpers))

    def block(self, block: Block, in_loop: bool = False) -> ir.Body:
        done: list[ir.Statement] = []
        for node in block:
            if isinstance(node, nodes.Define):
                continue
            done.extend(self.statement(node, in_loop))
        if any(isinstance(made, ir.Move) for made in done):
            check_blends(tuple(done), self.given_places(), self.diagnostics)
        return tuple(done)

    def given_places(self) -> dict[str, ir.Expression]:
        """The poses that the program gives to names once and for all."""
        symbols = [symbol for file in self.project.files for symbol in file.globals.values()]
        return {
            symbol.spelled: self.value(symbol.given.value)
            for symbol in symbols
            if symbol.given is not None and isinstance(symbol.given.value, nodes.PoseOf)
        }

    def statement(self, node: Node, in_loop: bool) -> ir.Body:
        """One statement; what it needs evaluated before stands in front of it."""
        if isinstance(node, ir.Nothing | ir.Opaque):
            return (node,)
        if isinstance(node, nodes.Store) and self.is_given(node):
            return ()  # the declaration says it, remarks included
        outer = self.before, self.kept
        self.before, self.kept = [], {}
        comments = node.origin.comments
        self.origin = replace(node.origin, comments=())
        made = self.made(node, in_loop)
        done = (*self.before, *made)
        self.before, self.kept = outer
        if not comments:
            return done
        if not done:
            return (ir.Nothing(origin=node.origin),)
        first = done[0]
        return (replace(first, origin=replace(first.origin, comments=comments)), *done[1:])

    def is_given(self, node: nodes.Store) -> bool:
        symbol = self.symbol(node.target)
        return symbol is not None and symbol.given is not None and symbol.given.origin.start == node.origin.start

    def made(self, node: Node, in_loop: bool) -> Made:
        match node:
            case nodes.Store():
                return self.store(node)
            case nodes.Declare():
                return ()
            case nodes.Perform(call=call):
                return self.perform(call)
            case nodes.Branches():
                return self.branches(node, in_loop)
            case nodes.Repeat():
                return self.loop(node)
            case nodes.Give(value=value):
                return (ir.Return(self.given(value), origin=self.origin),)
            case nodes.Thread(op=op, handle=handle):
                return self.thread(op, handle)
            case nodes.Template(text=text):
                return (ir.Vendor("urscript", text, "unknown", origin=self.origin),)
            case nodes.Word(word=word):
                return self.word(word, in_loop)
        return ()

    def word(self, word: str, in_loop: bool) -> Made:
        origin = self.origin
        if word in ("break", "continue") and not in_loop:
            self.diagnostics.report(NO_LOOP, origin, word=word)
            return (ir.Opaque(word, origin=origin),)
        match word:
            case "break":
                return (ir.ExitLoop(origin=origin),)
            case "continue":
                return (ir.NextPass(origin=origin),)
            case "halt":
                return (ir.Halt("exit", origin=origin),)
            case "enter_critical" | "exit_critical":
                return (ir.Critical(word == "enter_critical", origin=origin),)
        return (ir.Nothing(origin=origin),)

    # ---- assignments

    def store(self, node: nodes.Store) -> Made:
        target, value = node.target, node.value
        symbol = self.symbol(target)
        if isinstance(value, nodes.Run):
            return self.run(value, target)
        if symbol is not None and symbol.only_handle:  # what stands for no thread yet
            return (ir.Nothing(origin=self.origin),)
        if isinstance(target, nodes.Var):
            if isinstance(value, nodes.Apply) and value.base is None and value.name in _ASKED:
                return self.asked(target, value)
            kind = symbol.kind if symbol is not None else self.kind(value)
            stored = self.stored(value, kind, symbol is not None and symbol.is_joints)
            return (ir.Assign(self.name(target), stored, origin=self.origin),)
        if isinstance(target, nodes.Member):
            return (ir.Assign(self.member(target, None), self.value(value, self.kind(target)), origin=self.origin),)
        assert isinstance(target, nodes.At)  # the syntax allows no other place
        return self.store_part(target, value)

    def asked(self, target: nodes.Var, call: nodes.Apply) -> Made:
        """A question to the operator at the panel, whose answer is kept."""
        if len(call.arguments) != 1:
            return (ir.Assign(self.name(target), self.text_of(call, None), origin=self.origin),)
        question = self.value(call.arguments[0][1])
        return (ir.Dialog(self.name(target), question, kind=_ASKED[call.name], origin=self.origin),)

    def store_part(self, target: nodes.At, value: Expr) -> Made:
        base, kind = target.base, self.kind(target.base)
        index = target.indices[0]
        number = literal(index)
        if kind is None or kind.word not in ("pose", "list", "struct"):
            return self.vendor(f"{shown(target)} = {shown(value)}", "unknown")
        place = self.value(base)
        if kind.word == "struct" or (kind.word == "list" and not self.as_joints_kept(base)):
            stored = self.array(value) if self.as_joints_kept(value) else self.value(value, self.kind(target))
            part = self.at(target, None)
            if isinstance(part, ir.VendorValue):
                return self.vendor(f"{shown(target)} = {shown(value)}", "unknown")
            return (ir.Assign(part, stored, origin=self.origin),)
        given = self.value(value, REAL)
        if self.as_joints_kept(base):
            assert number is not None  # else it is an array
            changed = ir.Assign(ir.Field(place, f"j{int(number) + 1}"), ir.Quantity(given, "rad"), origin=self.origin)
            return (changed,)
        if number is not None:
            return (self.pose_part_set(place, int(number), given),)
        cases = [
            ir.Case((ir.IntLiteral(each),), (self.pose_part_set(place, each, given),), origin=self.origin)
            for each in range(6)
        ]
        return (ir.Switch(self.value(index, INT), tuple(cases), origin=self.origin),)

    def pose_part_set(self, place: ir.Expression, number: int, given: ir.Expression) -> ir.Assign:
        """Position: a component; rotation: a new pose with one number of the rotation vector changed."""
        if number < 3:
            return ir.Assign(ir.Field(place, "xyz"[number]), ir.Quantity(given, "m"), origin=self.origin)
        parts = [pose_part(place, each) for each in range(6)]
        parts[number] = given
        return ir.Assign(place, pose_literal(parts), origin=self.origin)

    def given(self, value: Expr | None) -> ir.Expression | None:
        """What a return gives; a function that gives a value elsewhere gives zero here."""
        kind = self.here.returns
        if self.here.kind == "thread":
            return None  # what a thread gives cannot be asked for
        if value is None:
            return zero(kind) if self.here.gives else None
        joints = self.here.returns is not None and self.here.returns.joints and kind is not None and kind.length == 6
        return self.stored(value, kind, joints)

    # ---- calls

    def vendor(self, text: str, effect: str) -> Made:
        return (ir.Vendor("urscript", text, effect, origin=self.origin),)

    def perform(self, call: Expr) -> Made:
        if isinstance(call, nodes.Run):
            return self.run(call, None)
        if not isinstance(call, nodes.Apply) or call.base is not None:
            return self.vendor(shown(call), "unknown")
        function = self.project.function(call.name, self.here)
        if function is not None:
            return (ir.CallRoutine(function.name, self.own_arguments(call, function), origin=self.origin),)
        builtin = BUILTINS.get(call.name)
        if builtin is None:
            given = tuple(ir.Argument(self.value(value), name) for name, value in call.arguments)
            return (ir.CallRoutine(call.name, given, origin=self.origin),)
        make = MOVES.get(call.name) or PROCEDURES.get(call.name)
        if make is None:
            return self.vendor(shown(call), builtin.effect or "none")
        try:
            bound = bind(builtin, call.arguments)
        except BindError as error:
            self.refused(call, str(error))
            return self.vendor(shown(call), "unknown")
        made = make(self, bound)
        if made is None:
            self.refused(call, "this form has no neutral meaning")
            return self.vendor(shown(call), "unknown")
        return made

    # ---- control flow

    def branches(self, node: nodes.Branches, in_loop: bool) -> Made:
        """Conditions that need something evaluated before make a nested if."""
        made: list[tuple[ir.Expression, ir.Body]] = []
        for place, (condition, body) in enumerate(node.branches):
            count = len(self.before)
            value = self.value(condition, BOOL)
            if len(self.before) > count and place > 0:
                before, self.before = tuple(self.before[count:]), self.before[:count]
                rest = nodes.Branches(node.branches[place:], node.otherwise, node.origin)
                outer, self.before = self.before, []
                inner = self.branches(rest, in_loop)
                self.before = outer
                return (ir.If(tuple(made), (*before, *inner), origin=self.origin),)
            origin = self.origin
            made.append((value, self.block(body, in_loop)))
            self.origin = origin
        origin = self.origin
        otherwise = self.block(node.otherwise, in_loop)
        return (ir.If(tuple(made), otherwise, origin=origin),)

    def loop(self, node: nodes.Repeat) -> Made:
        origin = self.origin
        condition = self.value(node.condition, BOOL)
        before, self.before = tuple(self.before), []
        body = self.block(node.body, in_loop=True)
        if before:  # evaluated again before each pass
            leave = ir.If(((ir.Unary("not", condition), (ir.ExitLoop(origin=origin),)),), origin=origin)
            return (ir.Loop((*before, leave, *body), origin=origin),)
        if condition == ir.BoolLiteral(True):
            return (ir.Loop(body, origin=origin),)
        if len(body) == 1 and body[0] == _SYNC and not _calls(condition):
            return (ir.WaitUntil(opposite(condition), origin=origin),)  # the language's way to wait
        return (ir.While(condition, body, origin=origin),)

    # ---- threads

    def threads_of(self, handle: Expr) -> list[str]:
        kind = self.kind(handle)
        return sorted(kind.threads) if kind is not None and kind.word == "thread" else []

    def run(self, run: nodes.Run, target: Expr | None) -> Made:
        """Starts the thread; its number becomes the handle."""
        if not isinstance(run.call, nodes.Apply):
            return self.vendor(shown(run), "unknown")
        function = self.project.function(run.call.name, self.here)
        name = function.name if function is not None else run.call.name
        later = self.output_later(function) if function is not None and target is None else None
        if later is not None:
            return (later,)
        start = ir.TaskControl("start", name, origin=self.origin)
        symbol = None if target is None else self.symbol(target)
        if target is None or (symbol is not None and symbol.only_handle):
            return (start,)
        number = ir.IntLiteral(self.thread_number(name))
        if not isinstance(target, nodes.Var):
            handle = nodes.Number(number.value, str(number.value))
            return (start, *self.store_part(target, handle)) if isinstance(target, nodes.At) else (start,)
        return (start, ir.Assign(self.name(target), number, origin=self.origin))

    def output_later(self, function: Function) -> ir.SetAfter | None:
        """A thread that only sleeps and then switches an output, nothing computed: an output that follows later."""
        statements = [node for node in function.node.body if not isinstance(node, ir.Nothing)]
        calls = [node.call for node in statements if isinstance(node, nodes.Perform)]
        if len(statements) != 2 or not all(
            isinstance(call, nodes.Apply) and all(constant(value) for _, value in call.arguments) for call in calls
        ):
            return None
        origin = self.origin
        made = self.block(function.node.body)
        self.origin = origin
        match [one for one in made if not isinstance(one, ir.Nothing)]:
            case [ir.Wait(time=time), ir.Assign(target=ir.Signal() as signal, value=value)]:
                return ir.SetAfter(signal, value, time, origin=origin)
        return None

    def thread_number(self, name: str) -> int:
        """Threads of the project are numbered from 1; 0 is no thread."""
        threads = [function.name for function in self.project.functions() if function.kind == "thread"]
        return 1 + threads.index(name) if name in threads else 1

    def thread(self, op: str, handle: Expr) -> Made:
        word = {"join": "join", "kill": "stop"}[op]
        if isinstance(handle, nodes.Run):
            return (*self.run(handle, None), *self.control(word, handle))
        return self.control(word, handle)

    def control(self, word: str, handle: Expr) -> Made:
        names = self.threads_of(handle)
        if not names:
            self.diagnostics.report(THREAD, self.origin, text=self.origin.text.strip()[:60])
            return self.vendor(self.origin.text.strip(), "unknown")
        if len(names) == 1:
            return (ir.TaskControl(word, names[0], origin=self.origin),)
        cases = tuple(
            ir.Case(
                (ir.IntLiteral(self.thread_number(name)),),
                (ir.TaskControl(word, name, origin=self.origin),),
                origin=self.origin,
            )
            for name in names
        )
        return (ir.Switch(self.value(handle), cases, origin=self.origin),)


def zero(kind: Kind | None) -> ir.Expression:
    """What stands where a function ends without a value though it gives one elsewhere."""
    if kind is None:
        return ir.RealLiteral(0.0, "0.0")
    match kind.word:
        case "bool":
            return ir.BoolLiteral(False)
        case "int" | "thread":
            return ir.IntLiteral(0)
        case "text":
            return ir.TextLiteral("")
        case "pose":
            return ir.Builtin("pose_from_rotation_vector", (ir.RealLiteral(0.0, "0.0"),) * 6)
        case "list":
            if kind.joints and kind.length == 6:
                none = ir.RealLiteral(0.0, "0.0")
                return ir.Aggregate(tuple((f"j{n}", none) for n in range(1, 7)), "joints")
            return ir.Aggregate(tuple((None, zero(kind.element)) for _ in range(kind.length or 0)))
    return ir.RealLiteral(0.0, "0.0")


def _calls(condition: ir.Expression) -> bool:
    return any(isinstance(node, ir.Call | ir.VendorValue) for node in walk((condition,)))


def opposite(condition: ir.Expression) -> ir.Expression:
    """The condition's opposite, without a double `not`."""
    match condition:
        case ir.Unary(op="not", operand=operand):
            return operand
        case ir.Binary(op="=" | "<>" as op, left=left, right=ir.BoolLiteral(value=truth)):
            return left if (op == "<>") == truth else ir.Unary("not", left)
    return ir.Unary("not", condition)


# ---- procedures

_SYNC = ir.Wait(ir.Quantity(_STEP, "s"))


def _set(group: str, name: str) -> Make:
    def make(calls: Calls, bound: Bound) -> Made:
        value = bound[name]
        assert value is not None  # it has to be given
        kind = REAL if group.endswith("analog") else BOOL
        return (ir.Assign(calls.signal(group, "out", bound["n"]), calls.value(value, kind), origin=calls.origin),)

    return make


def _write(name: str, kind: str, key: str = "address", content: str = "value") -> Make:
    def make(calls: Calls, bound: Bound) -> Made | None:
        value, address = bound[content], bound[key]
        assert value is not None  # it has to be given
        if key == "address":
            signal = calls.register(name, kind, address)
        else:
            signal = ir.Signal(kind, name=address.value) if isinstance(address, nodes.Text) else None
        found = calls.kind(value)
        if signal is None or (found is not None and found.word not in ("bool", "int", "real")):
            return None
        return (ir.Assign(signal, calls.value(value), origin=calls.origin),)

    return make


def _flag(calls: Calls, bound: Bound) -> Made:
    number, value = bound["n"], bound["b"]
    assert number is not None and value is not None  # they have to be given
    signal = ir.Signal("flag", one_more(calls.value(number, INT)))
    return (ir.Assign(signal, calls.value(value, BOOL), origin=calls.origin),)


def _sleep(calls: Calls, bound: Bound) -> Made:
    time = bound["t"]
    assert time is not None  # it has to be given
    return (ir.Wait(ir.Quantity(calls.value(time, REAL), "s"), origin=calls.origin),)


def _sync(calls: Calls, bound: Bound) -> Made:
    return (replace(_SYNC, origin=calls.origin),)


def _log(calls: Calls, bound: Bound) -> Made:
    """textmsg: two values, one behind the other, in the log."""
    one, other = bound["s1"], bound["s2"]
    assert one is not None and other is not None  # given, or the default
    text = as_text(calls, one)
    if other != nodes.Text(""):
        text = ir.Binary("&", text, as_text(calls, other))
    return (ir.Message("write", text, origin=calls.origin),)


def _popup(calls: Calls, bound: Bound) -> Made:
    """A window; the program waits for the operator only where it says so."""
    text, title = bound["s"], bound["title"]
    assert text is not None  # it has to be given
    blocking, error = bound["blocking"], bound["error"]
    kind = "quit" if blocking == nodes.Truth(True) else "error" if error == nodes.Truth(True) else "notify"
    sender = as_text(calls, title) if title is not None and title != nodes.Text("Popup") else None
    return (ir.Message(kind, as_text(calls, text), sender, origin=calls.origin),)


def _assert(calls: Calls, bound: Bound) -> Made:
    """M: an expectation that does not hold is an error, which ends the program."""
    condition = given(calls, bound, "condition", BOOL)
    stop = (
        ir.Message("error", ir.TextLiteral("assertion failed"), origin=calls.origin),
        ir.Halt("exit", origin=calls.origin),
    )
    return (ir.If(((opposite(condition), stop),), origin=calls.origin),)


PROCEDURES: dict[str, Callable[[Calls, Bound], Made | None]] = {
    "sleep": _sleep,
    "sync": _sync,
    "assert": _assert,
    "textmsg": _log,
    "popup": _popup,
    "set_digital_out": _set("digital", "b"),
    "set_standard_digital_out": _set("standard_digital", "b"),
    "set_configurable_digital_out": _set("configurable_digital", "b"),
    "set_tool_digital_out": _set("tool_digital", "b"),
    "set_analog_out": _set("analog", "f"),
    "set_standard_analog_out": _set("standard_analog", "f"),
    "set_flag": _flag,
    "write_output_boolean_register": _write("output_boolean_register", "digital_out"),
    "write_output_integer_register": _write("output_integer_register", "group_out"),
    "write_output_float_register": _write("output_float_register", "analog_out"),
    "write_port_bit": _write("port_bit", "digital_out"),
    "write_port_register": _write("port_register", "group_out"),
    "modbus_set_output_signal": _write("", "digital_out", "signal_name", "digital_value"),
    "modbus_set_output_register": _write("", "group_out", "signal_name", "register_value"),
}

__all__ = ["Body", "Function", "Origin", "Statements", "zero"]
