"""Statements without bodies: assignments, outputs, waits, messages, tasks. Some are several lines."""

from __future__ import annotations

from dataclasses import replace
from typing import Protocol

from rpl import ir
from rpl.ir.walk import expressions as all_expressions
from rpl.passes.conditions import opposite
from rpl.passes.fold import constant
from rpl.passes.typewords import component_names, word_type
from rpl.source import Origin
from rpl.writing.statements import CannotSayError
from rpl.writing.templates import Macros

from . import tables
from .declarations import in_one_list
from .expressions import Expressions
from .facts.standing import Standing
from .facts.uses import Uses

_MESSAGES = {"notify": "", "state": "", "write": "", "error": "error=True", "quit": "blocking=True"}
_LONGEST_KEYS = 9


class Sharing(Protocol):
    """What all routines of one file share (see statements.Output)."""

    watches: dict[str, str]
    threads: list[tuple[str, ...]]
    handles: dict[str, str]
    standing: Standing
    uses: Uses

    def fresh(self, stem: str) -> str: ...


class Printing(Protocol):
    """What writes the lines of a routine (see statements.Printer)."""

    expressions: Expressions
    inside: bool
    say: Macros

    @property
    def output(self) -> Sharing: ...

    def line(self, text: str, origin: Origin | None = None) -> None: ...

    def more(self, *texts: str) -> None: ...

    def remark(self, text: str) -> None: ...

    def temporary(self, stem: str, value: str) -> str: ...

    def comments_only(self, origin: Origin) -> None: ...

    def onward(self, word: str) -> None: ...


class Actions:
    """Writes to the printer of one routine."""

    def __init__(self, printer: Printing) -> None:
        self.printer, self.expressions, self.say = printer, printer.expressions, printer.say

    def write(self, statement: ir.Statement) -> None:
        printer, origin = self.printer, statement.origin
        match statement:
            case ir.Assign():
                printer.line(self.say("assign", text=self.assignment(statement)), origin)
            case ir.CallRoutine():
                printer.line(self.say("call", **self.call(statement)), origin)
            case ir.NextPass():
                printer.comments_only(origin)
                printer.onward("continue")
            case ir.WaitForMotion():
                printer.comments_only(origin)  # moves without a blend radius end before the next line
                if printer.output.standing.must_wait(statement):  # the last move of a loop, branch or call above
                    printer.line(self.say("while_head", condition="not is_steady()"))
                    printer.more("  sync()", self.say("word", text="end"))
            case ir.WaitUntil():
                self.wait_until(statement)
            case ir.Pulse() | ir.SetAfter():
                self.later(statement)
            case ir.Message():
                self.message(statement)
            case ir.Clock(op=op, clock=clock):
                name, runs = self.watch(clock)
                printer.line(self.say("clock", runs=runs, on=op == "start"), origin)
                if op == "reset":
                    printer.more(f"{name} = 0.0")
            case _:
                printer.line(self.simple(statement), origin)

    def watch(self, clock: ir.Expression) -> tuple[str, str]:
        """The variables of a stop watch: the seconds, and whether it runs."""
        name = clock.id if isinstance(clock, ir.Name) else ""
        runs = self.printer.output.watches.get(name)
        if runs is None:
            raise CannotSayError("a stop watch that is not a variable of the program")
        return name, runs

    def simple(self, statement: ir.Statement) -> str:
        say = self.say
        match statement:
            case ir.ExitLoop():
                return say("word", text="break")
            case ir.Return(value=None):
                return say("word", text="return")
            case ir.Return(value=value) if value is not None:
                routine = self.expressions.scope.routine_here
                given = self.expressions.given(value, routine.returns if routine else None)
                return say("return_value", value=given)
            case ir.Halt(kind="stop" | "exit"):
                return say("stop")
            case ir.Wait(time=ir.Quantity(ir.RealLiteral(value=seconds), "s")) if seconds == tables.STEP_S:
                return say("word", text="sync()")
            case ir.Wait(time=time):
                return say("wait", time=self.expressions.measured(time, "s"))
            case ir.StopMotion(hard=hard):
                return say("stop_motion", deceleration="20.0" if hard else "2.0")
            case ir.Do(procedure=procedure, arguments=arguments):
                return say("do", text=self.procedure(procedure, arguments))
            case ir.Dialog():
                return self.dialog(statement)
            case ir.Critical(enter=enter):
                return say("word", text="enter_critical" if enter else "exit_critical")
            case ir.TaskControl(op="start", task=task, arguments=()):
                return say("start_task", handle=self.handle(task), task=task)
            case ir.TaskControl(op="stop" | "join" as op, task=task):
                return say("stop_task", word="kill" if op == "stop" else "join", handle=self.handle(task))
        raise CannotSayError(f"there is no {statement.__class__.__name__}")

    def handle(self, task: str) -> str:
        """The global that holds the number of the running thread: no name that the program has itself."""
        output = self.printer.output
        if task not in output.handles:
            output.handles[task] = output.fresh(f"{task}_run")
        return output.handles[task]

    # ---- assignments

    def assignment(self, statement: ir.Assign) -> str:
        target, value = statement.target, statement.value
        measured, places = self.expressions.measured, self.expressions.places
        match target:
            case ir.Index(base=text) if isinstance(self.expressions.type(text), ir.StringType):
                raise CannotSayError("one character of a text cannot be changed")
            case ir.System(name=name):
                return self.setting(name, target.indices, value)
            case ir.Signal():
                return places.output(target, value)
            case ir.Name(id=name) if places.declared(name) is not None:
                return places.output(ir.Signal("", name=name), value)
            case ir.Field(base=base, name=name):
                found = places.component(base, name)
                if found is not None and found[1] == "deg":
                    place, axis = self.expressions.text(base), str(tables.EULER[name])
                    turned = self.expressions.helper("rpl_turned", place, axis, self.expressions.text(value))
                    return f"{place} = {turned}"
                if found is not None:
                    return f"{found[0]} = {measured(value, found[1])}"
        type = self.expressions.type(target)
        if isinstance(type, ir.ArrayType) and isinstance(value, ir.Aggregate):
            value = in_one_list(value, type, self.expressions.scope)
        if isinstance(type, ir.RealType) and isinstance(value, ir.IntLiteral):
            value = ir.Convert("real", value)
        return f"{self.expressions.text(target)} = {self.expressions.given(value)}"

    def setting(self, name: str, indices: tuple[ir.Expression, ...], value: ir.Expression) -> str:
        match name:
            case "tool":
                return f"set_tcp({self.expressions.text(value)})"
            case "load":
                return self.payload(value)
            case "flag" if len(indices) == 1:
                return self.expressions.places.output(ir.Signal("flag", indices[0]), value)
        raise CannotSayError(f"there is no setting for {name.replace('_', ' ')}")

    def payload(self, value: ir.Expression) -> str:
        """`set_payload(mass, [x, y, z])` in kg and m."""
        parts = self.parts(value)
        mass = parts.get("mass")
        if mass is None:
            mass, centre = ir.Field(value, "mass"), None
        else:
            centre = parts.get("cog")
        if centre is None:
            return f"set_payload({self.expressions.measured(mass, 'kg')})"
        inner = self.parts(centre)
        place = [inner.get(axis) or ir.Field(centre, axis) for axis in ("x", "y", "z")]
        shown = ", ".join(self.expressions.measured(one, "m") for one in place)
        given = f"{self.expressions.measured(mass, 'kg')}, [{shown}]"
        inertias = [parts.get(name) for name in ("ix", "iy", "iz")]
        if None in inertias or all(one in (ir.RealLiteral(0.0), ir.IntLiteral(0)) for one in inertias):
            return f"set_payload({given})"
        about = ", ".join(self.expressions.text(one) for one in inertias if one is not None)
        return f"set_target_payload({given}, [{about}, 0, 0, 0])"

    def parts(self, value: ir.Expression) -> dict[str, ir.Expression]:
        """The components of a written value by their names."""
        if not isinstance(value, ir.Aggregate):
            return {}
        scope = self.expressions.scope
        type = word_type(value.type_name, scope) if value.type_name else None
        names = component_names(type, scope) if type is not None else ()
        return {
            written or (names[at] if at < len(names) else str(at)): one
            for at, (written, one) in enumerate(value.entries)
        }

    def call(self, statement: ir.CallRoutine) -> dict[str, str]:
        if statement.dynamic is not None:
            raise CannotSayError("there is no call by a computed name")
        given = self.expressions.arguments(statement.name, statement.arguments)
        return {"name": statement.name, "arguments": given}

    def procedure(self, name: str, arguments: tuple[ir.Expression | None, ...]) -> str:
        given = [argument for argument in arguments if argument is not None]
        if not given:
            raise CannotSayError(f"there is no procedure {name}")
        target = self.expressions.text(given[0])
        step = self.expressions.atom(given[1]) if len(given) > 1 else "1"
        match name:
            case "increment" | "decrement":
                return f"{target} = {target} {'+' if name == 'increment' else '-'} {step}"
            case "clear":
                zero = "0" if isinstance(self.expressions.type(given[0]), ir.IntType) else "0.0"
                return f"{target} = {zero}"
            case "text_append" if len(given) == 2:
                return f"{target} = str_cat({target}, {self.expressions.text(given[1])})"
            case "text_copy" if len(given) == 2:
                return f"{target} = {self.expressions.text(given[1])}"
            case "text_clear":
                return f'{target} = ""'
        raise CannotSayError(f"there is no procedure {name}")

    # ---- waiting

    def wait_until(self, wait: ir.WaitUntil) -> None:
        """A loop that looks again in each step of the controller."""
        printer = self.printer
        waiting = self.expressions.text(opposite(wait.condition))
        if wait.timeout is None:
            printer.line(self.say("while_head", condition=waiting), wait.origin)
            printer.more("  sync()", self.say("word", text="end"))
            return
        if wait.timed_out is None:
            raise CannotSayError("a wait whose time limit raises an error")
        asked = not isinstance(wait.timed_out, ir.Name) or wait.timed_out.id.lower() not in printer.output.uses.unasked
        flag = (self.assignment(ir.Assign(wait.timed_out, _negated(wait.condition))),) if asked else ()
        printer.comments_only(wait.origin)
        waited = printer.temporary("waited", "0.0")
        in_time = ir.Binary("<", ir.Name(waited), self.expressions.in_unit(wait.timeout, "s"))
        printer.more(
            f"while {self.expressions.text(ir.Binary('cand', _negated(wait.condition), in_time))}:",
            "  sync()",
            f"  {waited} = {waited} + get_steptime()",
            "end",
            *flag,
        )

    def later(self, statement: ir.Pulse | ir.SetAfter) -> None:
        """An output that changes while the program goes on: a thread of its own sleeps and sets it."""
        printer = self.printer
        scope = self.expressions.scope
        for node in all_expressions(statement):
            symbol = scope.value(node.id) if isinstance(node, ir.Name) else None
            if symbol is not None and symbol.routine is not None and printer.inside:
                raise CannotSayError("an output that changes later by a variable of the routine")
        if isinstance(statement, ir.Pulse):
            change = self.assignment(ir.Assign(statement.signal, statement.value))
            printer.line(self.say("assign", text=change), statement.origin)
            back, delay = _negated(statement.value), statement.duration
        else:
            printer.comments_only(statement.origin)
            back, delay = statement.value, statement.delay
        if isinstance(statement, ir.Pulse) and statement.value == ir.Unary("not", statement.signal):
            back = statement.value  # the other way round, and back again
        elif _reads(back, statement.signal):
            raise CannotSayError("an output that changes later to the opposite of what it is")
        if isinstance(statement, ir.Pulse) and any(isinstance(node, ir.Call) for node in all_expressions(statement)):
            raise CannotSayError("a pulse by a function, which would be called twice")
        name = printer.output.fresh("output_later")
        later, delay, begun = self.as_begun(ir.Assign(statement.signal, back), delay)
        try:
            lines = (f"  sleep({self.expressions.measured(delay, 's')})", f"  {self.assignment(later)}")
        finally:
            self.expressions.scope = scope
        printer.output.threads.append((f"thread {name}():", *begun, *lines, "end"))
        printer.more(f"run {name}()", *(["sync()"] if begun else []))

    def as_begun(self, change: ir.Assign, delay: ir.Expression) -> tuple[ir.Assign, ir.Expression, list[str]]:
        """The change and its delay by what the thread takes as it begins, before the program goes on (which gives it a
        step of the controller for that), and the lines that take it. The scope knows these values until it is put
        back."""
        lines: list[str] = []

        def begun(value: ir.Expression, stem: str) -> ir.Expression:
            if constant(value, self.expressions.scope) is not None:
                return value
            type = self.expressions.type(value)
            if type is None:
                raise CannotSayError("an output that changes later by a value whose type is not known")
            name = self.printer.output.fresh(stem)
            lines.append(f"  local {name} = {self.expressions.text(value)}")
            self.expressions.scope = self.expressions.scope.with_value(ir.Variable(name, type, scope="routine"))
            return ir.Name(name)

        signal, value = change.target, change.value
        match signal:
            case ir.Signal(index=index, last=last):
                first = begun(index, "number") if index is not None else None
                signal = replace(signal, index=first, last=begun(last, "last") if last is not None else None)
            case ir.System(indices=indices):
                signal = replace(signal, indices=tuple(begun(index, "number") for index in indices))
            case ir.Name():
                pass
            case _:
                raise CannotSayError("an output that changes later and is neither a signal nor a name")
        value = ir.Unary("not", signal) if value == ir.Unary("not", change.target) else begun(value, "level")
        seconds = begun(self.expressions.in_unit(delay, "s"), "seconds")
        return ir.Assign(signal, value), ir.Quantity(seconds, "s"), lines

    # ---- the operator

    def message(self, message: ir.Message) -> None:
        printer = self.printer
        if message.kind == "clear":
            printer.comments_only(message.origin)
            printer.remark("(the log is not cleared)")
            return
        if message.kind not in _MESSAGES:
            raise CannotSayError(f"there is no message of kind {message.kind}")
        text = message.text
        option = _MESSAGES[message.kind]
        if option or (message.kind == "notify" and message.sender is not None):  # a log has no place for the sender
            title = self.expressions.text(message.sender) if message.sender is not None else ""
            shown = self.say("popup", text=self.expressions.text(text), title=title, option=option)
            printer.line(shown, message.origin)
            return
        if message.sender is not None:
            text = ir.Binary("&", ir.Binary("&", message.sender, ir.TextLiteral(": ")), text)
        printer.line(self.say("log", text=self.told(text)), message.origin)

    def told(self, text: ir.Expression) -> str:
        """One or two pieces of a message; the controller shows numbers by itself."""
        match text:
            case ir.Binary(op="&", left=left, right=ir.Builtin(function="value_text", arguments=(value,))):
                self.expressions.value_text((value,))
                return f"{self.expressions.text(left)}, {self.expressions.text(value)}"
            case ir.Binary(op="&", left=left, right=right):
                return f"{self.expressions.text(left)}, {self.expressions.text(right)}"
        return self.expressions.text(text)

    def dialog(self, dialog: ir.Dialog) -> str:
        if dialog.timeout is not None or dialog.timed_out is not None:
            raise CannotSayError("a dialog that ends by time")
        question: ir.Expression = dialog.text
        if dialog.sender is not None:
            question = ir.Binary("&", ir.Binary("&", dialog.sender, ir.TextLiteral(": ")), question)
        functions = {"keys": "integer", "number": "float", "text": "string"}
        kind = functions[dialog.kind]
        if dialog.kind == "number" and isinstance(self.expressions.type(dialog.answer), ir.IntType):
            kind = "integer"
        for number, key in enumerate(dialog.keys[:_LONGEST_KEYS], 1):
            if key is not None:
                label: ir.Expression = ir.Binary("&", ir.TextLiteral(f" {number}: "), key)
                if isinstance(key, ir.TextLiteral):
                    label = ir.TextLiteral(f" {number}: {key.value}")
                question = _joined(question, label)
        shown = self.expressions.text(question)
        return self.say("ask", answer=self.expressions.text(dialog.answer), kind=kind, question=shown)


def _joined(one: ir.Expression, other: ir.Expression) -> ir.Expression:
    if isinstance(one, ir.TextLiteral) and isinstance(other, ir.TextLiteral):
        return ir.TextLiteral(one.value + other.value)
    return ir.Binary("&", one, other)


def _negated(condition: ir.Expression) -> ir.Expression:
    match condition:
        case ir.Unary(op="not", operand=operand):
            return operand
        case ir.BoolLiteral(value=value):
            return ir.BoolLiteral(not value)
    return ir.Unary("not", condition)


def _reads(value: ir.Expression, signal: ir.Expression) -> bool:
    return any(node == signal for node in all_expressions(value))
