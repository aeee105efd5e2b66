"""Write statements: each IR node prepares the words of one macro. The unsayable becomes a guarded stop."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import zip_longest

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.passes.fold import constant_number
from rpl.source import Origin
from rpl.writing.ledger import EmissionLedger
from rpl.writing.refusals import refusal
from rpl.writing.statements import CannotSayError, original
from rpl.writing.templates import Macros, TemplateError

from . import tables
from .expressions import NULL, Expressions, root_of
from .motion import Motion

NOT_SAID = code(
    "val3-not-written",
    Severity.LOSS,
    "VAL3 cannot say this: {reason}",
    "the original stands there as a comment, and the task stops for good",
)
PROCESS = code(
    "val3-process-move",
    Severity.WARNING,
    "a move that keeps the tool's speed constant is written as a path move, which may slow down at its corners",
)
_PRIORITY = 10


class Statements:
    """Writes the statements of one routine."""

    def __init__(self, expressions: Expressions, diagnostics: Diagnostics, ledger: EmissionLedger, say: Macros) -> None:
        self.expressions, self.diagnostics, self.ledger, self.say = expressions, diagnostics, ledger, say
        self.text = expressions.text
        self.step = say("step")
        self.in_switch = False  # `break` there ends the case

    def body(self, body: ir.Body) -> list[str]:
        """All lines of a body, not indented."""
        lines: list[str] = []
        for statement, following in zip_longest(body, body[1:]):
            if isinstance(statement, ir.StopMotion) and isinstance(following, ir.ClearMotion):
                self.ledger.written(statement)  # resetMotion stops the robot too
                lines.extend(self.framed(statement.origin, []))
            else:
                lines.extend(self.statement(statement))
        return lines

    def statement(self, statement: ir.Statement) -> list[str]:
        origin = statement.origin
        try:
            lines = self.lines(statement)
        except TemplateError as error:
            raise error.at(origin) from None
        except CannotSayError as reason:
            self.ledger.reported(statement)
            shown, why = refusal(statement, "val3") or (NOT_SAID, str(reason))
            self.diagnostics.report(shown, origin, reason=why)
            lines = self.say.lines("guarded", original=original(statement).splitlines())
            return [*self.remarks(origin), *lines]
        self.ledger.written(statement)
        return self.framed(origin, lines)

    def framed(self, origin: Origin, lines: list[str]) -> list[str]:
        """The lines with the remarks of the statement before and behind them."""
        words = " ".join(
            line.rstrip() for one in origin.comments if one.behind and not one.layout for line in one.text.splitlines()
        )
        behind = self.say("behind", text=words) if words else ""
        if lines:
            lines = [lines[0] + behind, *lines[1:]]
        elif behind:
            lines = [behind.strip()]
        return [*self.remarks(origin), *lines]

    def remarks(self, origin: Origin) -> list[str]:
        return [
            self.say("remark", text=line).rstrip()
            for comment in origin.comments
            if not comment.behind and not comment.layout
            for line in comment.text.splitlines() or [""]
        ]

    def looped(self, body: ir.Body) -> str:
        """The body of a loop: `break` in it leaves the loop."""
        outer, self.in_switch = self.in_switch, False
        text = self.inner(body)
        self.in_switch = outer
        return text

    def inner(self, body: ir.Body) -> str:
        return "\n".join(f"{self.step}{line}" if line else line for line in self.body(body))

    # ---- blocks

    def lines(self, statement: ir.Statement) -> list[str]:
        """The statement's own lines. Raises CannotSayError."""
        say = self.say.lines
        match statement:
            case ir.Nothing():
                return []
            case ir.If(branches=branches, otherwise=otherwise):
                conditions = [self.text(condition) for condition, _ in branches]
                done = [(text, self.inner(body)) for text, (_, body) in zip(conditions, branches, strict=True)]
                return say("if_block", branches=done, otherwise=self.inner(otherwise))
            case ir.Switch(selector=selector, cases=cases, default=default):
                values = [self.expressions.listed(case.values) for case in cases]
                chosen = self.text(selector)
                outer, self.in_switch = self.in_switch, True
                listed = [(value, self.inner(case.body)) for value, case in zip(values, cases, strict=True)]
                rest, has = self.inner(default or ()), default is not None
                self.in_switch = outer
                return say("switch_block", selector=chosen, cases=listed, default=rest, has_default=has)
            case ir.While(condition=condition, body=body):
                return say("while_block", condition=self.text(condition), body=self.looped(body))
            case ir.Repeat(until=until, body=body):
                return say("repeat_block", condition=self.text(until), body=self.looped(body))
            case ir.Loop(body=body):
                return say("while_block", condition="true", body=self.looped(body))
            case ir.For():
                return self.counting(statement)
            case ir.Move():
                made = Motion(self.expressions).move(statement)
                if statement.motion_class == "process":
                    self.diagnostics.report(PROCESS, origin=statement.origin)
                return say(
                    "move",
                    before=list(made.before),
                    word=made.word,
                    points=",".join(made.points),
                    tool=made.tool,
                    descriptor=made.descriptor,
                )
        return self.simple(statement)

    def counting(self, loop: ir.For) -> list[str]:
        if loop.at_least_once or loop.scoped or loop.automatic or loop.keeps_last:
            raise CannotSayError("a loop that counts by its own rule")
        step = "" if loop.step is None else self.text(loop.step)
        bounds = self.text(loop.start), self.text(loop.stop)
        body = self.looped(loop.body)
        return self.say.lines("for_block", counter=loop.counter, start=bounds[0], stop=bounds[1], step=step, body=body)

    # ---- one-line statements

    def simple(self, statement: ir.Statement) -> list[str]:
        say = self.say.lines
        match statement:
            case ir.Assign(target=target, value=value):
                return self.assigned(target, value)
            case ir.CallRoutine(name=name, arguments=arguments, dynamic=None):
                before, given = self.arguments(name, arguments)
                return [*before, *say("call", name=name, arguments=",".join(given))]
            case ir.TaskControl(op="start", task=task, arguments=arguments):
                before, given = self.arguments(task, arguments)
                return [*before, *say("create", task=task, priority=_PRIORITY, name=task, arguments=",".join(given))]
            case ir.TaskControl(op=op, task=task) if op in tables.TASKS:
                return say("task", word=tables.TASKS[op], task=task)
            case ir.Return(value=None):
                return say("leave")
            case ir.Wait(time=time, in_position=stand):
                rest = say("wait_for_motion") if stand else []
                return [*rest, *say("delay", time=self.text(time))]
            case ir.WaitUntil():
                return self.waits(statement)
            case ir.WaitForMotion():
                return say("wait_for_motion")
            case ir.StopMotion(hard=False):
                return say("motion", word="stopMove")
            case ir.StartMotion():
                return say("motion", word="restartMove")
            case ir.ClearMotion():
                return say("motion", word="resetMotion")
            case ir.ExitLoop():
                if self.in_switch:
                    raise CannotSayError("a loop that is left out of a switch")
                return say("leave_loop")
            case ir.Halt():
                return say("halt")
            case ir.Message(kind="clear"):
                return say("clear")
            case ir.Message(kind="quit", text=text):
                return say("acknowledged", text=self.shown(text))
            case ir.Message(kind=kind, text=text) if kind in tables.MESSAGES:
                return say("message", word=tables.MESSAGES[kind], text=self.shown(text))
            case ir.Vendor(dialect="val3", text=text):
                return [text]
            case ir.Opaque():
                raise CannotSayError("it could not be read")
        raise CannotSayError(f"there is no {statement.__class__.__name__} statement")

    def shown(self, text: ir.Expression) -> str:
        """What a message shows: a number may stand as it is."""
        match text:
            case ir.Builtin(function="value_text", arguments=(value,)):
                return self.text(value)
        return self.text(text)

    def waits(self, wait: ir.WaitUntil) -> list[str]:
        if wait.error is not None:
            raise CannotSayError("a wait that ends by an error")
        rest = self.say.lines("wait_for_motion") if wait.in_position else []
        condition = self.text(wait.condition)
        if wait.timeout is None:
            return [*rest, *self.say.lines("wait", condition=condition)]
        if wait.timed_out is None:
            raise CannotSayError("a wait that ends by time needs a flag")
        flag, time = self.text(wait.timed_out), self.text(wait.timeout)
        return [*rest, *self.say.lines("watch", flag=flag, condition=condition, time=time)]

    def arguments(self, name: str, arguments: tuple[ir.Argument, ...]) -> tuple[list[str], list[str]]:
        """Lines in front and the arguments. A point counts in the world for the program that gets it."""
        e = self.expressions
        if name in e.store.unwritten:
            raise CannotSayError(f"{name} could not be declared")
        routine = e.scope.routine(name)
        parameters = routine.parameters if routine is not None else ()
        before: list[str] = []
        given: list[str] = []
        for at, argument in enumerate(arguments):
            value = argument.value
            if value is None or argument.name is not None or argument.if_present is not None:
                raise CannotSayError("an argument cannot be left out here")
            by_reference = at < len(parameters) and parameters[at].mode == "reference"
            if isinstance(value, ir.Signal):
                given.append(e.store.signal(value.name or "", value.kind))
            elif by_reference:
                if e.is_point(value) and e.father(value) != "world":
                    raise CannotSayError("a point of a frame that the program gets as a reference")
                given.append(e.storage(value))
            elif e.is_point(value):
                given.append(self.point_argument(value, before, at))
            else:
                given.append(self.text(value))
        return before, given

    def point_argument(self, value: ir.Expression, before: list[str], at: int) -> str:
        e = self.expressions
        if e.father(value) == "world":
            return e.point(value)
        name = e.store.helper(f"pGiven{at + 1}", "pointRx", "world")
        taken, source = self.taken(value)
        before.extend((*taken, f"{name}.trsf={source}.trsf", f"{name}.config={source}.config"))
        return name

    def taken(self, value: ir.Expression) -> tuple[list[str], str]:
        """What puts a point that is worked out into a variable, and the variable's name."""
        e = self.expressions
        if isinstance(value, ir.Name | ir.Index):
            return [], e.storage(value)
        helper = e.store.helper("pTaken", "pointRx", e.father(value))
        return [f"{helper}={e.point(value)}"], helper

    # ---- assignments

    def assigned(self, target: ir.Expression, value: ir.Expression) -> list[str]:
        e, say = self.expressions, self.say.lines
        match target:
            case ir.System(name="override"):
                return say("override", value=self.text(value))
            case ir.System(name=name):
                raise CannotSayError(f"there is no setting for {name.replace('_', ' ')}")
            case ir.Signal(kind="digital_out"):
                return say("assign", target=self.text(target), value=self.text(value))
            case ir.Signal(kind="analog_out", name=name):
                return say("analog", signal=e.store.signal(name or "", "analog_out"), value=self.text(value))
            case ir.Signal():
                raise CannotSayError("only outputs with a name can be written")
            case ir.Field(base=base, name=name) if isinstance(e.type(base), ir.TargetType | ir.PoseType):
                return self.component(base, name, value)
            case ir.Name() | ir.Index() if _is_measured(value) and e.roles.get(root_of(target)) == "frame":
                return self.measured(target, value)
            case ir.Name() | ir.Index() if e.is_point(target):
                return self.to_point(target, value)
        if isinstance(e.type(target), ir.ArrayType):
            raise CannotSayError("a whole list")
        return say("assign", target=self.text(target), value=self.text(value))

    def measured(self, target: ir.Expression, value: ir.Expression) -> list[str]:
        """A frame of three points: its origin, one on its x axis, one in its xy plane."""
        e = self.expressions
        given = value.arguments if isinstance(value, ir.Builtin) else ()
        points = [e.point(one.base) for one in given if isinstance(one, ir.Field) and e.is_point(one.base)]
        if len(points) != len(given) or any(
            e.father(one.base) != "world" for one in given if isinstance(one, ir.Field)
        ):
            raise CannotSayError("a frame of places that are no points of the world")
        return self.say.lines("measured", points=",".join(points), frame=e.storage(target))

    def written_out(self, target: ir.Expression, value: ir.Aggregate) -> list[str]:
        """A point of its components: the pose, and each side of the configuration."""
        lines = [f"{self.text(target)}={self.text(value)}"]
        for name, part in value.entries:
            if name in tables.FLAGS:
                lines.extend(self.component(target, name, part))
        return lines

    def to_point(self, target: ir.Expression, value: ir.Expression) -> list[str]:
        e, name = self.expressions, self.expressions.storage(target)
        if isinstance(value, ir.Aggregate):
            return self.written_out(target, value)
        if e.is_point(value) and e.father(value) == e.father(target):
            return self.say.lines("assign", target=name, value=e.point(value))
        lines: list[str] = []
        place, configuration = self.text(value), None
        if e.is_point(value):
            lines, source = self.taken(value)
            place = f"{source}.trsf"
            configuration = f"{source}.config"
        lines.append(f"{name}.trsf={place}")
        if configuration is not None:
            lines.append(f"{name}.config={configuration}")
        return lines

    def component(self, base: ir.Expression, name: str, value: ir.Expression) -> list[str]:
        """x, y, z, the position, the rotation and the configuration of a place."""
        e = self.expressions
        own = self.text(base)
        if name in tables.FLAGS:
            if isinstance(value, ir.Field) and value.name == name:
                return [f"{e.storage(base)}.config.{name}={e.storage(value.base)}.config.{name}"]
            flag, words = constant_number(value, e.scope), tables.FLAGS[name]
            if flag is None or not 0 <= flag < len(words) - 1:
                raise CannotSayError("a configuration that is worked out")
            return [f"{e.storage(base)}.config.{name}={words[int(flag) + 1]}"]
        if name in "xyz":
            return self.say.lines("assign", target=f"{own}.{name}", value=self.text(value))
        if not isinstance(value, ir.Field) or value.name != name:
            raise CannotSayError(f"the component {name} of a place")
        match name, value.base:
            case "trans", ir.Name() | ir.Index() as source:
                return [f"{own}.{part}={self.text(source)}.{part}" for part in "xyz"]
            case "trans", ir.Aggregate(entries=entries):
                given = dict(entries)
                zero = ir.IntLiteral(0)
                return [f"{own}.{part}={self.text(given.get(part, zero))}" for part in "xyz"]
            case "rot", ir.Aggregate(entries=entries):
                turn = ir.Aggregate(tuple(entry for entry in entries if entry[0] in ir.ANGLES), "pose")
                return [f"{own}={{{own}.x,{own}.y,{own}.z,0,0,0}}*{self.text(turn)}"]
            case "rot", ir.Builtin(function="tool_offset", arguments=(first, *shift, _, _, _)) as turn if (
                first == NULL and [constant_number(one, e.scope) for one in shift] == [0.0] * 3
            ):
                return [f"{own}={{{own}.x,{own}.y,{own}.z,0,0,0}}*{self.text(turn)}"]
            case "rot", ir.Name() | ir.Index() as source:
                there = self.text(source)
                angles = ",".join(f"{there}.{angle}" for angle in ("rx", "ry", "rz"))
                return [f"{own}={{{own}.x,{own}.y,{own}.z,{angles}}}"]
        raise CannotSayError(f"the component {name} of a place")


def _is_measured(value: ir.Expression) -> bool:
    return isinstance(value, ir.Builtin) and value.function == "frame_from_points" and len(value.arguments) == 3


def indented(lines: Sequence[str], step: str) -> list[str]:
    return [f"{step}{line}" if line else line for line in lines]
