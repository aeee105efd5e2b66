"""Statements that are neither moves nor blocks: assignments, calls, signals, waits, messages, tasks, stops."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.source import Origin
from rpl.writing.statements import CannotSayError

from . import settings, tables
from .facts.routines import stores
from .output import BodyPrinter

KEYS = code(
    "vplus-keys",
    Severity.WARNING,
    "V+ has no keys to choose from: the operator types the number of the answer",
)
TIMER_RUNS = code(
    "vplus-timer-runs", Severity.WARNING, "timers of V+ cannot be stopped; what is read later is the time until then"
)
ONE_PULSE = code(
    "vplus-one-pulse",
    Severity.WARNING,
    "the output of this pulse is computed: task {task} ends it, and another one of this statement can only begin when"
    " that has ended (a program that runs is not executed again)",
    "give each output a statement of its own",
)
SENDER = code("vplus-sender", Severity.WARNING, "a message has no sender in V+; its name is left out")
WATCHED = code(
    "vplus-watched",
    Severity.WARNING,
    "reactions watch one signal: a program in a task of its own looks at this condition once in a cycle of 16 ms",
)
ACKNOWLEDGE = code(
    "vplus-acknowledge", Severity.WARNING, "a message that waits for the operator is written as TYPE and PAUSE"
)
_SET = (ir.PoseType, ir.TargetType, ir.JointsType, ir.VectorType, ir.RotationType, ir.AxesType)
_LARGEST_COPY = 24
_LONGEST_NAME = tables.LONGEST_NAME + 2
_KEPT = 3  # characters of a variable that keeps a subscript
_TOLD = frozenset(("notify", "state", "write", "error", "quit"))


class Actions:
    """Prints through the printer of a body."""

    def __init__(self, printer: BodyPrinter) -> None:
        self.printer = printer
        self.expressions = printer.expressions

    def write(self, statement: ir.Statement) -> None:
        printer, origin = self.printer, statement.origin
        match statement:
            case ir.Assign():
                self.assign(statement)
            case ir.SetForNextMove(setting=ir.System(name=name), value=value):
                self.all(settings.setting(name, value, False, self.expressions), statement)
            case ir.DeclareInterrupt() | ir.ControlInterrupt():
                watched = len(printer.output.reactions.watches)
                self.all(printer.output.reactions.lines(statement, self.expressions), statement)
                if len(printer.output.reactions.watches) > watched:
                    printer.diagnostics.report(WATCHED, origin)
            case ir.CallRoutine():
                text = self.call(statement)
                word, _, what = text.partition(" ")
                printer.line(text, origin, printer.output.say("call", word=word, what=what))
                printer.motion.forget()
            case ir.Message():
                self.message(statement)
            case ir.Wait(time=time, in_position=True) if not printer.output.facts.foreign:
                printer.line(f"DELAY {self.expressions.measured(time, 's')}", origin)
            case ir.Wait(in_position=in_position) | ir.WaitUntil(in_position=in_position):
                waiting = self.waiting(statement)
                printer.comments_only_before(origin)
                if in_position and not printer.stands():
                    printer.line("BREAK")
                printer.line(waiting, _without_comments(origin))
            case ir.WaitForMotion() if printer.stands() and printer.output.facts.foreign:
                printer.comments_only(origin)
            case ir.Trigger():
                why = printer.output.left_alone.why(statement)
                raise CannotSayError(why or "an action on the path that no move follows")
            case ir.Pulse() | ir.SetAfter():
                self.later(statement)
            case _:
                printer.line(self.simple(statement), origin)

    def all(self, lines: list[str], statement: ir.Statement) -> None:
        """Several steps of one statement; none leaves its comments."""
        if not lines:
            self.printer.comments_only(statement.origin)
        for at, line in enumerate(lines):
            self.printer.line(line, statement.origin if at == 0 else None)

    def simple(self, statement: ir.Statement) -> str:
        match statement:
            case ir.ExitLoop():
                return "EXIT"
            case ir.NextPass():
                return "NEXT"
            case ir.Return(value=None):
                return "RETURN"
            case ir.Halt(kind="exit"):
                return "HALT"
            case ir.Halt(kind="stop"):
                return "PAUSE"
            case ir.WaitForMotion():
                return "BREAK"
            case ir.Do(procedure=procedure, arguments=arguments):
                return self.procedure(procedure, arguments)
            case ir.Dialog():
                return self.dialog(statement)
            case ir.TaskControl():
                return self.task(statement)
            case ir.OnError(routine=routine):
                return f"REACTE {routine.lower()}" if routine else "REACTE"
            case ir.TryNext():
                return "RETURNE"
        raise CannotSayError(f"there is no {statement.__class__.__name__}")

    # ---- assignments

    def assign(self, statement: ir.Assign) -> None:
        target, value, origin = statement.target, statement.value, statement.origin
        places = self.expressions.places
        match target:
            case ir.Name(id=name) if (declared := places.declared(name)) is not None:
                self.output(declared, value, statement)
            case ir.Signal():
                self.output(target, value, statement)
            case ir.System(name="flag", indices=(number,)):
                self.output(ir.Signal("flag", number), value, statement)
            case ir.System(name="timer" | "timer_stopped"):
                self.timer(target, value, statement)
            case ir.System(name=name):
                self.all(settings.setting(name, value, True, self.expressions), statement)
            case _ if isinstance(self.expressions.type(target), ir.ArrayType):
                self.whole(statement)
            case _:
                self.printer.line(self.stored(target, value), origin)

    def stored(self, target: ir.Expression, value: ir.Expression) -> str:
        text = self.expressions.text
        if isinstance(value, ir.Builtin) and isinstance(target, ir.Name):
            called = self.expressions.brought(value, text(target))
            if called is not None:
                return called
        match target:
            case ir.Field(base=base, name=name):
                return f"SET {text(base)} = {self.expressions.places.locations.with_component(base, name, value)}"
            case ir.Index(base=base) if isinstance(self.expressions.type(base), ir.StringType):
                raise CannotSayError("one character of a text cannot be changed")
        if isinstance(value, ir.Builtin) and value.function == "joints_to_target" and len(value.arguments) == 1:
            value = value.arguments[0]  # SET makes a transformation of a precision point
        if isinstance(self.expressions.type(value), ir.ArrayType):
            raise CannotSayError("a list is not a location or a number")
        word = "SET " if isinstance(self.expressions.type(target), _SET) else ""
        place = text(target)
        room = tables.LONGEST_LINE - len(word) - len(place) - 3
        return f"{word}{place} = {self.expressions.shortened(value, room)}"

    def components(self, body: ir.Body) -> tuple[str, int] | None:
        """x, y, z (and a, b, c) of one location, given side by side: one SET."""
        first = body[0]
        assert isinstance(first, ir.Assign) and isinstance(first.target, ir.Field)  # the caller asked
        place, parts = first.target.base, dict[str, ir.Expression]()
        if not isinstance(self.expressions.type(place), ir.PoseType | ir.TargetType):
            return None
        for statement, name in zip(body, ir.POSE, strict=False):
            match statement:
                case ir.Assign(target=ir.Field(base=base, name=other), value=value) if base == place and other == name:
                    own = ir.Field(place, name)
                    if any(isinstance(one, ir.Field) and one.base == place and one != own for one in walk((value,))):
                        break
                    parts[name] = value
                case _:
                    break
        count = 6 if len(parts) == 6 else 3
        if len(parts) < count or (count == 6 and any(node == place for node in walk(tuple(parts.values())))):
            return None
        given = {name: parts[name] for name in ir.POSE[:count]}
        name, locations = self.expressions.text(place), self.expressions.places.locations
        shown = locations.composed(place, given)
        while len(shown) + len(name) + 7 > tables.LONGEST_LINE:
            longest = max(given, key=lambda axis: len(self.expressions.text(given[axis])))
            if len(self.expressions.text(given[longest])) <= _LONGEST_NAME:
                return None
            given[longest] = ir.Name(self.expressions.moved_in_front(given[longest]))
            shown = locations.composed(place, given)
        return f"SET {name} = {shown}", count

    def whole(self, statement: ir.Assign) -> None:
        """A whole array: element by element."""
        target, value = statement.target, statement.value
        lines = [self.stored(place, one) for place, one in self.elements(target, value)]
        self.all(lines, statement)

    def elements(self, target: ir.Expression, value: ir.Expression) -> list[tuple[ir.Expression, ir.Expression]]:
        type = self.expressions.type(target)
        assert isinstance(type, ir.ArrayType)  # the caller asked
        if isinstance(value, ir.Aggregate):
            return listed(target, value, type)
        bounds = [self.expressions.known(bound) if bound is not None else None for bound in type.dimensions]
        if None in bounds:
            raise CannotSayError("an array whose size is not known is copied")
        places = list(product(*(range(type.base, int(bound or 0) + 1) for bound in bounds)))
        if len(places) > _LARGEST_COPY:
            raise CannotSayError("a large array is copied at once")
        indices = [tuple(ir.IntLiteral(number) for number in place) for place in places]
        return [(ir.Index(target, one), ir.Index(value, one)) for one in indices]

    def output(self, signal: ir.Signal, value: ir.Expression, statement: ir.Assign) -> None:
        """SIGNAL n, SIGNAL -n; by a calculated value both ways in a choice."""
        printer, places, origin = self.printer, self.expressions.places, statement.origin
        signal = places.numbered(signal)
        if signal.kind == "analog_out" and signal.index is not None:
            printer.line(f"AIO.OUT {self.expressions.text(signal.index)} = {self.expressions.text(value)}", origin)
            return
        if signal.kind.endswith("_in"):
            raise CannotSayError("an input cannot be switched")
        if places.is_group(signal):
            printer.line(f"BITS {places.group(signal)} = {self.expressions.text(value)}", origin)
            return
        on, off = f"SIGNAL {places.number(signal)}", f"SIGNAL {places.number(signal, True)}"
        if isinstance(value, ir.BoolLiteral):
            printer.line(on if value.value else off, origin)
            return
        printer.line(f"IF {printer.condition(value)} THEN", origin)
        printer.depth += 1
        printer.line(on)
        printer.depth -= 1
        printer.line("ELSE")
        printer.depth += 1
        printer.line(off)
        printer.depth -= 1
        printer.line("END")

    def timer(self, target: ir.System, value: ir.Expression, statement: ir.Assign) -> None:
        """Timers always run; starting one says nothing, stopping one cannot be said."""
        if target.name == "timer":
            number = self.expressions.text(target.indices[0])
            self.printer.line(f"TIMER {number} = {self.expressions.measured(value, 's')}", statement.origin)
            return
        self.printer.comments_only(statement.origin)
        stops = value != ir.BoolLiteral(False) and statement.origin.text
        if stops and "reset" not in statement.origin.text.lower():
            self.printer.output.facts.once(TIMER_RUNS, statement.origin)

    # ---- calls

    def call(self, statement: ir.CallRoutine) -> str:
        if statement.dynamic is not None:
            name = self.expressions.text(statement.dynamic)
            given = self.arguments(statement.name, statement.arguments)
            if given == "()":
                return f"CALLS {name}"
            if not isinstance(statement.dynamic, ir.Name | ir.Index | ir.TextLiteral):
                kept = self.expressions.notes.temporary("$routine")
                self.expressions.notes.step(f"{kept} = {name}")
                self.expressions.notes.autos.append(kept)
                name = kept
            return f"CALLS {name}{given}"
        return f"CALL {statement.name.lower()}{self.arguments(statement.name, statement.arguments)}"

    def arguments(self, name: str, given: tuple[ir.Argument, ...]) -> str:
        routine = self.expressions.scope.routine(name)
        shown, values = [], {}
        for at, argument in enumerate(given):
            parameter = routine.parameters[at] if routine is not None and at < len(routine.parameters) else None
            shown.append("" if argument.value is None else self.argument(argument.value, parameter, routine))
            if argument.value is not None and self.is_a_value(argument.value, parameter):
                values[at] = argument.value
        while sum(len(one) + 2 for one in shown) > tables.LONGEST_LINE - len(name) - 10:
            longest = max(values, key=lambda place: len(shown[place]), default=None)
            if longest is None or len(shown[longest]) <= _LONGEST_NAME:
                break
            shown[longest] = self.expressions.moved_in_front(values.pop(longest))
            given = (*given[:longest], ir.Argument(ir.Name(shown[longest])), *given[longest + 1 :])
        shown = self.with_kept_subscripts(name, given, shown)
        while shown and not shown[-1]:
            shown.pop()
        whole = f"({', '.join(shown)})"
        return whole if len(name) + len(whole) + 5 <= tables.LONGEST_LINE else f"({','.join(shown)})"

    def with_kept_subscripts(self, name: str, given: tuple[ir.Argument, ...], shown: list[str]) -> list[str]:
        """Elements stay references: where the call is too long, computed subscripts are kept in variables in front."""
        elements = {at: one.value for at, one in enumerate(given) if isinstance(one.value, ir.Index)}
        while elements and len(name) + sum(len(one) + 2 for one in shown) + 5 > tables.LONGEST_LINE:
            found = [(self.expressions.text(one), one) for element in elements.values() for one in element.indices]
            longest = max(found, key=lambda one: len(one[0]) * sum(other == one for other in found), default=None)
            if longest is None or len(longest[0]) <= _KEPT:
                break
            kept = ir.Name(self.expressions.moved_in_front(longest[1]))
            for at, element in elements.items():
                places = tuple(kept if one == longest[1] else one for one in element.indices)
                if places != element.indices:
                    elements[at] = replace(element, indices=places)
                    shown[at] = shown[at].replace(self.expressions.text(element), self.expressions.text(elements[at]))
        return shown

    def is_a_value(self, value: ir.Expression, parameter: ir.Parameter | None) -> bool:
        """Does the callee get only the value, so that a variable beside it serves as well?"""
        if isinstance(self.expressions.type(value), ir.ArrayType):
            return False
        by_value = parameter is not None and parameter.mode == "value"
        return by_value or not isinstance(value, ir.Name | ir.Index)

    def argument(self, value: ir.Expression, parameter: ir.Parameter | None, routine: ir.Routine | None) -> str:
        """Variables are passed by reference; where the callee changes its copy, brackets pass the value."""
        if isinstance(self.expressions.type(value), ir.ArrayType):
            return self.expressions.places.whole_array(value)
        if isinstance(value, ir.Unary) and value.op == "+":  # how the reader marks brackets around a variable
            return f"({self.expressions.text(value.operand)})"
        text = self.expressions.text(value)
        variable = isinstance(value, ir.Name | ir.Index) and "(" not in text
        if not variable or parameter is None or parameter.mode != "value" or routine is None:
            return text
        if not self.is_own(value) or stores(routine, parameter.name):
            if isinstance(self.expressions.type(value), ir.JointsType):
                name = self.expressions.notes.temporary("#p")
                self.expressions.notes.step(f"SET {name} = {text}")
                self.expressions.notes.autos.append(name)
                return name
            return f"({text})"
        return text

    def is_own(self, value: ir.Expression) -> bool:
        """Is it a variable that only the caller can change, or one that nobody does?"""
        name = value.base if isinstance(value, ir.Index) else value
        symbol = self.expressions.scope.value(name.id) if isinstance(name, ir.Name) else None
        if symbol is None:
            return False
        constant = isinstance(symbol.declaration, ir.Variable) and symbol.declaration.storage == "constant"
        return constant or symbol.routine is not None

    def procedure(self, name: str, arguments: tuple[ir.Expression | None, ...]) -> str:
        given = [argument for argument in arguments if argument is not None]
        if not given:
            raise CannotSayError(f"there is no procedure {name}")
        target = given[0]
        step = given[1] if len(given) > 1 else ir.IntLiteral(1)
        match name:
            case "increment" | "decrement":
                return self.stored(target, ir.Binary("+" if name == "increment" else "-", target, step))
            case "clear":
                return self.stored(target, ir.IntLiteral(0))
            case "text_append" if len(given) == 2:
                return self.stored(target, ir.Binary("&", target, given[1]))
            case "text_copy" if len(given) == 2:
                return self.stored(target, given[1])
            case "text_clear":
                return self.stored(target, ir.TextLiteral(""))
        raise CannotSayError(f"there is no procedure {name}")

    def task(self, statement: ir.TaskControl) -> str:
        number = self.printer.output.tasks.get(statement.task.lower())
        if number is None:
            raise CannotSayError(f"there are at most {tables.TASKS} tasks beside the main one")
        match statement.op:
            case "start":
                name = statement.task.lower()
                return f"EXECUTE {number} {name}{self.arguments(statement.task, statement.arguments)}"
            case "stop":
                return f"ABORT {number}"
            case "resume":
                return f"PROCEED {number}"
        raise CannotSayError(f"a program cannot {statement.op} another task")

    # ---- waiting, path events

    def waiting(self, statement: ir.Wait | ir.WaitUntil) -> str:
        if isinstance(statement, ir.Wait):
            return f"WAIT.EVENT , {self.expressions.measured(statement.time, 's')}"
        if statement.timeout is not None or statement.error is not None:
            raise CannotSayError("a wait whose time limit raises an error")
        return f"WAIT {self.printer.condition(statement.condition, True)}"

    def later(self, statement: ir.Pulse | ir.SetAfter) -> None:
        """A computed output, or a computed time: `rpl.later` waits and switches it while the program goes on."""
        places, output, value = self.expressions.places, self.printer.output, statement.value
        signal = statement.signal
        if isinstance(signal, ir.Name):
            signal = places.declared(signal.id) or signal
        if not isinstance(signal, ir.Signal):
            raise CannotSayError("an output that follows later without a number")
        if places.is_group(signal) or signal.kind not in tables.SINGLE_OUTPUTS or not isinstance(value, ir.BoolLiteral):
            raise CannotSayError("anything but one digital output that follows later")
        pulse = isinstance(statement, ir.Pulse)
        delay = statement.duration if isinstance(statement, ir.Pulse) else statement.delay
        signal = places.numbered(signal)
        task, time = output.helper_task(signal), self.expressions.measured(delay, "s")
        now, then = (places.number(signal, value.value == back) for back in (False, pulse))
        if pulse:
            self.printer.line(f"SIGNAL {now}", statement.origin)
        else:
            self.printer.comments_only(statement.origin)
        if signal.index is None or self.expressions.known(signal.index) is None:
            self.printer.diagnostics.report(ONE_PULSE, statement.origin, task=task)
        self.printer.line(f"EXECUTE {task} rpl.later({_by_value(then)}, {_by_value(time)})")
        self.expressions.notes.helpers.add("rpl.later")

    # ---- the operator

    def message(self, message: ir.Message) -> None:
        printer = self.printer
        if message.kind == "clear":
            printer.comments_only(message.origin)
            return
        if message.kind not in _TOLD:
            raise CannotSayError(f"there is no message of kind {message.kind}")
        text = message.text
        if message.sender is not None and message.sender != ir.TextLiteral(""):
            printer.output.facts.once(SENDER, message.origin)
        printer.line(f"TYPE {self.expressions.texts.items(text)}", message.origin)
        if message.kind == "quit":
            printer.output.facts.once(ACKNOWLEDGE, message.origin)
            printer.line("PAUSE")

    def dialog(self, dialog: ir.Dialog) -> str:
        if dialog.timeout is not None or dialog.timed_out is not None:
            raise CannotSayError("a dialog that ends by time")
        question: ir.Expression = dialog.text
        if dialog.sender is not None and dialog.sender != ir.TextLiteral(""):
            question = ir.Binary("&", ir.Binary("&", dialog.sender, ir.TextLiteral(": ")), question)
        if dialog.kind == "keys":
            self.printer.output.facts.once(KEYS, dialog.origin)
            for number, key in enumerate(dialog.keys, 1):
                if key is not None:
                    label: ir.Expression = ir.Binary("&", ir.TextLiteral(f" {number}="), key)
                    if isinstance(key, ir.TextLiteral):
                        label = ir.TextLiteral(f" {number}={key.value}")
                    question = _joined(question, label)
        return f"PROMPT {self.expressions.text(question)}, {self.expressions.text(dialog.answer)}"


def listed(target: ir.Expression, value: ir.Aggregate, type: ir.ArrayType) -> list[tuple[ir.Expression, ir.Expression]]:
    """Each element that a list fills, with its value."""
    found: list[tuple[ir.Expression, ir.Expression]] = []

    def fill(indices: tuple[ir.Expression, ...], part: ir.Expression) -> None:
        if len(indices) == len(type.dimensions):
            found.append((ir.Index(target, indices), part))
            return
        if not isinstance(part, ir.Aggregate):
            raise CannotSayError("a part of an array is filled at once")
        for number, (_, inner) in enumerate(part.entries, type.base):
            fill((*indices, ir.IntLiteral(number)), inner)

    fill((), value)
    return found


def _by_value(number: str) -> str:
    """A number as an argument: a variable in brackets."""
    return f"({number})" if number[:1].isalpha() else number


def _joined(one: ir.Expression, other: ir.Expression) -> ir.Expression:
    if isinstance(one, ir.TextLiteral) and isinstance(other, ir.TextLiteral):
        return ir.TextLiteral(one.value + other.value)
    return ir.Binary("&", one, other)


def _without_comments(origin: Origin) -> Origin:
    return replace(origin, comments=tuple(comment for comment in origin.comments if comment.behind))
