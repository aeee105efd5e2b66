"""Instructions of control flow, signals, waiting, messages, other jobs and tasks; and the bodies of blocks."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import get_args

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.reading.assemble import UNREADABLE
from rpl.reading.pieces import Item, ModulePart
from rpl.reading.shapes import StatementError
from rpl.source import Origin

from . import tables
from .arcs import grouped
from .data import Statements
from .early import anticipated, with_actions
from .kinds import labels_of
from .operands import tags_of
from .operator import asked
from .signals import is_digital
from .split import code_of
from .syntax import Bracket, Command, JobName, LabelBy, LabelName, Nest, Operand, Relation, Word
from .tasks import Tasks

UNKNOWN = code(
    "inform-unknown-instruction",
    Severity.WARNING,
    "{word} is no instruction known here; a run stops at it",
    "say in the cell file under [[vendor]] what it stands for",
)

_STATEMENTS = get_args(ir.Statement)
START = "*START"  # no label of a job can be called so


class Control(Tasks):
    """One job's lines to statements."""

    unread: int = 0
    anticipation: ir.Expression | None = None  # seconds, of the ANTOUT just read

    # ---- bodies

    def body(self, items: Iterable[Item]) -> ir.Body:
        done: list[ir.Statement] = []
        self.early = None
        for item in items:
            early, self.early = self.early, None
            self.anticipation = None
            made = self.item(item)
            if self.anticipation is not None:
                anticipated(done, self.anticipation, made, self.diagnostics)
            elif early is None or all(isinstance(one, ir.Nothing) for one in made):
                done.extend(asked(done, made))
                self.early = self.early or early
            else:
                with_actions(done, early, made, self.diagnostics)
        self.early = self.anticipation = None
        return grouped(tuple(done), self.diagnostics)

    def item(self, item: Item) -> Statements:
        if isinstance(item, ModulePart):
            self.origin = replace(item.origin, comments=())
            made = self.guarded(item)
            if item.origin.comments:
                if not made:
                    return (ir.Nothing(origin=item.origin),)
                return replace(made[0], origin=item.origin), *made[1:]
            return made
        assert isinstance(item, _STATEMENTS)  # labels, comments, what was not read
        self.shown = None
        return (item,)

    def guarded(self, item: ModulePart) -> Statements:
        """A line that cannot be given a meaning costs itself alone."""
        try:
            if isinstance(item.data, Nest):
                return (self.nest(item.data),)
            assert isinstance(item.data, Command)
            return self.command(item.data)
        except StatementError as error:
            self.unread += 1
            at = replace(self.origin, start=min(self.origin.start + error.offset, self.origin.end))
            self.diagnostics.report(UNREADABLE, at, reason=str(error))
            return (ir.Opaque(code_of(self.origin.text), origin=self.origin),)

    def command(self, command: Command) -> Statements:
        self.state = self.flow.before.get(id(command), {})
        head, condition = self.split_condition(command)
        word = command.word
        if word not in ("MSG", "INPUT"):
            self.shown = None
        if word in tables.MOVES:
            done = self.on_move(command)
        elif word in _METHODS:
            self.nothing_behind(head)
            done = _METHODS[word](self, head)
        else:
            done = self.vendor(head)
        if condition is None:
            return done
        return (ir.If(((condition, done),), origin=self.origin),)

    def nothing_behind(self, command: Command) -> None:
        """Raises StatementError where more operands stand than the instruction has: none of them means nothing."""
        most = _OPERANDS.get(command.word, len(command.items))
        logic = command.word == "SET" and command.items[1:2] == (Word("LOGICEXP"),)
        if len(command.items) > most and not logic and not self.is_position(command.items[0]):
            raise StatementError(f"{command.word} has {most} operands, here are {len(command.items)}", 0)

    def split_condition(self, command: Command) -> tuple[Command, ir.Expression | None]:
        """`... IF a=b` behind an instruction."""
        for at, item in enumerate(command.items):
            if isinstance(item, Word) and item.text in tables.CONDITION_WORDS:
                condition = self.condition(command.items[at + 1 :])
                return Command(command.word, command.items[:at], command.origin), condition
        return command, None

    def vendor(self, command: Command) -> Statements:
        effect = tables.vendor_effect(command.word)
        if effect is None:
            effect = "unknown"
            self.report_once(UNKNOWN, command.word, word=command.word)
        return (ir.Vendor("inform", code_of(self.origin.text), effect, origin=self.origin),)

    # ---- blocks

    def nest(self, nest: Nest) -> ir.Statement:
        origin, head = self.origin, nest.head
        self.state = self.flow.before.get(id(head), {})
        match nest.kind:
            case "if":
                return self.if_block(nest, origin)
            case "while":
                condition = self.condition(head.items)
                return ir.While(condition, self.body(nest.sections[0][1]), origin=origin)
            case "for":
                return self.for_block(nest, origin)
        return self.switch_block(nest, origin)

    def if_block(self, nest: Nest, origin: Origin) -> ir.Statement:
        branches: list[tuple[ir.Expression, ir.Body]] = []
        otherwise: ir.Body = ()
        for head, items in nest.sections:
            command = head or nest.head
            if command.word == "ELSE":
                otherwise = self.body(items)
                continue
            self.origin = command.origin
            self.state = self.flow.before.get(id(command), {})
            condition = self.condition(command.items)
            branches.append((condition, self.body(items)))
        return ir.If(tuple(branches), otherwise, origin=origin)

    def for_block(self, nest: Nest, origin: Origin) -> ir.Statement:
        """FOR I000=0 TO 9 [STEP n]. M: behind the loop the counter holds the first value past the end."""
        relation, *rest = nest.head.items or (None,)
        match rest:  # newer controllers: FOR I000 START=1 TO 9 STEP=2
            case [Relation(left=Word(text="START"), op="=", right=first), *others] if relation is not None:
                relation = Relation(relation, "=", first)
                rest = [one.right if isinstance(one, Relation) else one for one in others]
        numbers = [item for item in rest if not isinstance(item, Word)]
        if not isinstance(relation, Relation) or not numbers:
            raise StatementError("FOR needs a variable, its first and its last value", 0)
        start, stop = self.value(relation.right), self.value(numbers[0])
        step = self.value(numbers[1]) if len(numbers) > 1 else None
        counter = self.value(relation.left)
        if isinstance(counter, ir.Name):
            return ir.For(counter.id, start, stop, step, self.body(nest.sections[0][1]), origin=origin)
        return self.counted(counter, start, stop, step, nest, origin)

    def counted(
        self,
        counter: ir.Expression,
        start: ir.Expression,
        stop: ir.Expression,
        step: ir.Expression | None,
        nest: Nest,
        origin: Origin,
    ) -> ir.Statement:
        """A loop whose counter is an element of an array: counted by its own statements."""
        if not isinstance(counter, ir.Index):
            raise StatementError("the counter of FOR must be a variable", 0)
        down = isinstance(step, ir.IntLiteral) and step.value < 0
        raised = ir.Assign(counter, ir.Binary("+", counter, step or ir.IntLiteral(1), origin=origin), origin=origin)
        first: list[ir.Statement] = [ir.Assign(counter, start, origin=origin)]
        if not isinstance(stop, ir.IntLiteral):  # the last value is looked up once
            self.ends += 1
            last = ir.Name(f"FOR_END{self.ends}", origin=origin)
            self.used.scalar(last.id, ir.IntType(), origin)
            first.append(ir.Assign(last, stop, origin=origin))
            stop = last
        condition = ir.Binary(">=" if down else "<=", counter, stop, origin=origin)
        body = (*self.body(nest.sections[0][1]), raised)
        loop = ir.While(condition, body, origin=origin)
        return ir.If(((ir.BoolLiteral(True), (*first, loop)),), origin=origin)

    def switch_block(self, nest: Nest, origin: Origin) -> ir.Statement:
        selector = self.value(nest.head.items[0]) if nest.head.items else None
        if selector is None:
            raise StatementError("SWITCH needs a variable", 0)
        cases: list[ir.Case] = []
        default: ir.Body | None = None
        before = self.body(nest.sections[0][1])
        for head, items in nest.sections[1:]:
            assert head is not None  # only the first section has none
            self.origin = head.origin
            if head.word == "DEFAULT":
                default = before + self.body(items)
            else:
                values = tuple(self.value(item) for item in head.items)
                cases.append(ir.Case(values, before + self.body(items), origin=head.origin))
            before = ()
        return ir.Switch(selector, tuple(cases), default, origin=origin)

    # ---- jumps and jobs

    def on_nop(self, command: Command) -> Statements:
        return ()

    def on_jump(self, command: Command) -> Statements:
        match self.needs(command, 1)[0]:
            case LabelName(name=name):
                return (ir.Goto(name, origin=self.origin),)
            case LabelBy(value=value):
                return (self.jump_by(value),)
            case JobName(name=name) as job if not self.is_text_variable(job) and name.upper() == self.job.name.upper():
                self.restarts = True
                return (ir.Goto(START, origin=self.origin),)
            case JobName():
                return (*self.on_call(command), ir.Return(origin=self.origin))
            case ir.Index() | ir.Signal() as number if (value := self.value(number)) is not None:
                called = self.on_call(command)
                if self.is_text(value):
                    return (*called, ir.Return(origin=self.origin))
                none = ir.Binary("<>", value, ir.IntLiteral(0), origin=self.origin)
                back = ir.Return(origin=self.origin)
                return (ir.If(((none, (*called, back)),), origin=self.origin),)
        raise StatementError("JUMP needs a label or a job", len(command.word))

    restarts: bool = False
    ends: int = 0  # last values of loops that are kept

    def jump_by(self, value: ir.Expression) -> ir.Statement:
        """To the label whose name is the value; without such a label the controller stops with an alarm."""
        selector = self.final(value)
        cases: list[ir.Case] = []
        for label in labels_of(self.job.body):
            if self.is_text(selector):
                wanted: ir.Expression = ir.TextLiteral(label, origin=self.origin)
            elif label.isdigit():
                wanted = ir.IntLiteral(int(label), origin=self.origin)
            else:
                continue
            cases.append(ir.Case((wanted,), (ir.Goto(label, origin=self.origin),), origin=self.origin))
        alarm = ir.Message("error", ir.TextLiteral("undefined label"), origin=self.origin)
        return ir.Switch(selector, tuple(cases), (alarm, ir.Halt(origin=self.origin)), origin=self.origin)

    def on_ret(self, command: Command) -> Statements:
        """RET [value]: the caller gets the value by GETS ... $RV."""
        back = ir.Return(origin=self.origin)
        if command.word == "END" or not command.items:
            return (back,)
        value = self.value(command.items[0])
        return ir.Assign(self.returned(self.is_text(value)), value, origin=self.origin), back

    def on_pause(self, command: Command) -> Statements:
        return (ir.Halt(origin=self.origin),)

    def on_abort(self, command: Command) -> Statements:
        return (ir.Halt("exit", origin=self.origin),)

    # ---- signals and waiting

    def on_dout(self, command: Command) -> Statements:
        signal, value = self.needs(command, 2)[:2]
        place = self.value(signal)
        if value == Word("INVERT") and is_digital(place):
            return (ir.Assign(place, ir.Unary("not", place, origin=self.origin), origin=self.origin),)
        given = self.value(value)
        if not isinstance(place, ir.Signal):
            return (ir.Vendor("inform", code_of(self.origin.text), "unknown", origin=self.origin),)
        if is_digital(place) and not isinstance(given, ir.BoolLiteral):
            given = self.lowest_bit(given)
        return (ir.Assign(place, given, origin=self.origin),)

    def on_antout(self, command: Command) -> Statements:
        """ANTOUT AT#(n) ON ANT=-0.50: around the moment when the robot comes to the point of the move before."""
        self.anticipation = next(
            (self.tagged("T", relation.right) for tag, relation in tags_of(command.items) if tag == "ANT"),
            ir.RealLiteral(0.0),
        )
        return self.on_dout(command)

    def on_din(self, command: Command) -> Statements:
        target, signal = self.needs(command, 2)[:2]
        place = self.value(signal)
        value = ir.Convert("bit", place, origin=self.origin) if is_digital(place) else place
        return self.set(target, value)

    def on_aout(self, command: Command) -> Statements:
        """AOUT AO#(n) volts; a whole-number variable counts in 0.01 V (M: a real one in volts)."""
        signal, given = self.needs(command, 2)[:2]
        value = self.value(given)
        if isinstance(given, ir.Index) and self.whole(given):
            real = ir.Convert("real", value, origin=self.origin)
            value = ir.Binary("*", real, ir.RealLiteral(tables.VOLTS_PER_COUNT), origin=self.origin)
        return (ir.Assign(self.value(signal), value, origin=self.origin),)

    def on_pulse(self, command: Command) -> Statements:
        signal = self.value(self.needs(command, 1)[0])
        time: ir.Expression = ir.RealLiteral(tables.PULSE_S)
        for tag, relation in tags_of(command.items):
            if tag == "T":
                time = self.seconds(relation.right)
        if isinstance(signal, ir.Signal) and signal.last is not None:
            return self.pulses(signal, command.items[1:], time)
        return (ir.Pulse(signal, ir.BoolLiteral(True), time, origin=self.origin),)

    def pulses(self, group: ir.Signal, rest: tuple[Operand, ...], time: ir.Expression) -> Statements:
        """`PULSE OG#(3) B000`: of those outputs of the group whose bits are set."""
        if not rest or isinstance(rest[0], Relation):
            raise StatementError("PULSE of a group needs a number for its outputs", 0)
        if not isinstance(group.index, ir.IntLiteral) or not isinstance(group.last, ir.IntLiteral):
            raise StatementError("PULSE is read for a group with a constant number", 0)
        number = self.value(rest[0])
        done: list[ir.Statement] = []
        for place, index in enumerate(range(group.index.value, group.last.value + 1)):
            one = ir.Signal("digital_out", ir.IntLiteral(index), origin=self.origin)
            pulse = ir.Pulse(one, ir.BoolLiteral(True), time, origin=self.origin)
            if isinstance(number, ir.IntLiteral):
                done += [pulse] if number.value >> place & 1 else []
                continue
            cut = ir.Binary("div", number, ir.IntLiteral(2**place), origin=self.origin) if place else number
            wanted = self.lowest_bit(cut)
            done.append(ir.If(((wanted, (pulse,)),), origin=self.origin))
        return tuple(done)

    def on_timer(self, command: Command) -> Statements:
        for tag, relation in tags_of(command.items):
            if tag == "T":
                return (ir.Wait(self.seconds(relation.right), origin=self.origin),)
        raise StatementError("TIMER needs T=", len(command.word))

    def on_cwait(self, command: Command) -> Statements:
        """The program goes on where a move with NWAIT has arrived."""
        return (ir.WaitForMotion(origin=self.origin),)

    def on_wait(self, command: Command) -> Statements:
        """WAIT condition [T=limit] [result]: a limit that passes is no error, the program goes on."""
        limit: ir.Expression | None = None
        conditions: list[Operand] = []
        result: Operand | None = None
        for item in command.items:
            if isinstance(item, Relation) and item.left == Word("T"):
                limit = self.seconds(item.right)
            elif item == Word("FOREXPRESS"):
                continue
            elif isinstance(item, Relation | Word | Bracket):
                conditions.append(item)
            else:
                result = item
        if not conditions:
            if limit is None:
                raise StatementError("WAIT needs a condition or T=", len(command.word))
            return (ir.Wait(limit, origin=self.origin),)
        condition = self.condition(tuple(conditions))
        if limit is None:
            return (ir.WaitUntil(condition, origin=self.origin),)
        self.shared.used.scalar(tables.WAIT_LATE, ir.BoolType(), self.origin)
        late = ir.Name(tables.WAIT_LATE, origin=self.origin)
        wait = ir.WaitUntil(condition, limit, late, origin=self.origin)
        if result is None:
            return (wait,)
        met = ir.Convert("bit", ir.Unary("not", late, origin=self.origin), origin=self.origin)
        return wait, *self.set(result, met)


# How many operands stand behind instructions that have a fixed number of them.
_OPERANDS = {
    "SET": 2,
    **dict.fromkeys((*tables.ARITHMETIC, *tables.BITS, *tables.FUNCTIONS, "NOT"), 2),
    **dict.fromkeys(("INC", "DEC", "TIMER"), 1),
}

_METHODS: dict[str, Callable[[Control, Command], Statements]] = {
    "NOP": Control.on_nop,
    "CWAIT": Control.on_cwait,
    "SET": Control.on_set,
    **dict.fromkeys(tables.ARITHMETIC, Control.arithmetic),
    **dict.fromkeys(("INC", "DEC"), Control.on_inc),
    **dict.fromkeys(tables.BITS, Control.bits),
    "NOT": Control.on_not,
    **dict.fromkeys(tables.FUNCTIONS, Control.function),
    "CLEAR": Control.on_clear,
    **dict.fromkeys(("CAT$", "MID$", "LEN", "ASC", "CHR$", "VAL", "VAL2STR", "STRSTR"), Control.on_text),
    "GETS": Control.on_gets,
    **dict.fromkeys(("SETREG", "GETREG"), Control.on_register),
    "GETPRM": Control.on_getprm,
    "GETFILE": Control.on_getfile,
    "GETARG": Control.on_getarg,
    "GETE": Control.on_gete,
    "SETE": Control.on_sete,
    "CNVRT": Control.on_cnvrt,
    "MFRAME": Control.on_mframe,
    "SETTOOL": Control.on_settool,
    "MULMAT": Control.on_mulmat,
    "INVMAT": Control.on_invmat,
    "MSHIFT": Control.on_mshift,
    "GETPOS": Control.on_getpos,
    "SPEED": Control.on_speed,
    **dict.fromkeys(("SFTON", "SFTOF", "SFTON3D", "SFTOF3D"), Control.on_shift),
    "JUMP": Control.on_jump,
    "CALL": Control.on_call,
    **dict.fromkeys(("RET", "END"), Control.on_ret),
    "PAUSE": Control.on_pause,
    "ABORT": Control.on_abort,
    "DOUT": Control.on_dout,
    "DIN": Control.on_din,
    "ANTOUT": Control.on_antout,
    "SETTM": Control.on_settm,
    "AOUT": Control.on_aout,
    "PULSE": Control.on_pulse,
    "TIMER": Control.on_timer,
    "WAIT": Control.on_wait,
    "MSG": Control.on_msg,
    "INPUT": Control.on_input,
    "PRINT": Control.on_print,
    "DIALOG": Control.on_dialog,
    "CLS": Control.on_cls,
    "SETUALM": Control.on_setualm,
    "PSTART": Control.on_pstart,
    "PWAIT": Control.on_pwait,
    "TSYNC": Control.on_tsync,
}
