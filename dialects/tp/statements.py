"""TP statements to IR: registers and signals, jumps, branches, waits, calls, messages, timers, frames.

Motion stands in its own file. A statement whose place is only known at run time (`J P[R[1]] ...`) becomes a branch for
each place it can mean.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence

from lark import Token, Tree

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import is_statement
from rpl.reading.pieces import Close, Element, Middle, Open
from rpl.reading.shapes import StatementError, SyntaxTree
from rpl.source import Origin

from . import modal, tables
from .expressions import Choice, Expressions, Pieces, Typed
from .header import read_header
from .positions import parse_position, variable
from .split import without_notes
from .words import english

Lowered = Element | tuple[Element, ...]
Many = tuple[ir.Statement, ...]

INSTRUCTION = code(
    "tp-instruction",
    Severity.INFO,
    "{text} is an instruction of an application or a macro; only the controller knows what it does",
    "give the macro's program, or say in the cell file what it stands for ([[vendor]])",
)
MARKER = code(
    "tp-marker-once",
    Severity.WARNING,
    "the controller keeps {name} up to date with its expression; here it is worked out once, where it stands",
)
MISSING_LABEL = code(
    "tp-missing-label", Severity.WARNING, "this program has no LBL[{number}]; the controller stops at this jump"
)
_DEEPEST_CHOICE = 4
_SAME_S = 1e-6
TIMED_OUT, HIT = "wait_timed_out", "skip_hit"
CHOSEN_TRUTH, CHOSEN_NUMBER = "chosen_truth_", "chosen_number_"


class Statements(Expressions):
    """Lowers statement trees."""

    modal: dict[str, list[ir.Expression]]  # values of the conditions (see modal.py), in their order
    offsets: dict[str, str]  # kinds of the offsets among them
    interrupts = 0
    choices = 0

    def lower(self, tree: SyntaxTree, pieces: Pieces, origin: Origin) -> Lowered:
        """The element(s) of one statement."""
        self.pieces, self.origin, self.chosen = pieces, origin, {}
        return self.with_choices(lambda: self.statement(tree))

    def with_choices(self, make: Callable[[], Lowered]) -> Lowered:
        """The statement; a branch for each option where a place is chosen by a computed number."""
        try:
            return make()
        except Choice as choice:
            if len(self.chosen) >= _DEEPEST_CHOICE:
                raise StatementError("too many computed numbers choose places here", 0) from None
            cases = []
            for option in choice.options:
                self.chosen[choice.key] = option
                body = self.as_statements(self.with_choices(make))
                cases.append(ir.Case((ir.IntLiteral(option),), body, origin=self.origin))
            del self.chosen[choice.key]
            default = self.alarm(f"there is no such place: {self.origin_line()}")
            return ir.Switch(choice.selector, tuple(cases), default, origin=self.origin)

    def alarm(self, text: str) -> Many:
        """An alarm of the controller that pauses the program."""
        message = ir.Message("error", ir.TextLiteral(text, origin=self.origin), origin=self.origin)
        return message, ir.Halt("stop", origin=self.origin)

    def as_statements(self, lowered: Lowered) -> Many:
        items = lowered if isinstance(lowered, tuple) else (lowered,)
        statements = tuple(item for item in items if is_statement(item))
        if len(statements) < len(items):
            raise StatementError("a computed number cannot stand here", 0)
        return statements

    def origin_line(self) -> str:
        """The statement's own text, in English, without its number and its end."""
        text = " ".join(self.origin.text.split())
        head, colon, rest = text.partition(":")
        if colon and (not head.strip() or head.strip().isdigit()):
            text = rest
        text = text.strip().removesuffix(";").strip()
        return english(text) if self.place.german else text

    def written(self, pattern: str) -> str:
        """The part of the statement's own text that fits; numbers in the tree of a shape are not the statement's."""
        line = self.origin_line()
        found = re.search(pattern, line, re.IGNORECASE)
        return found[0].strip() if found else line

    def vendor(self, text: str, effect: str) -> ir.Vendor:
        return ir.Vendor("tp", text, effect, origin=self.origin)

    def statement(self, tree: SyntaxTree) -> Lowered:
        kind = str(tree.data)
        if kind == "statement":
            return self.statement(_tree(tree.children[0]))
        method: Callable[[SyntaxTree], Lowered] | None = getattr(self, f"on_{kind}", None)
        if method is None:
            raise StatementError(f"{kind} cannot stand here", 0)
        return method(tree)

    def action(self, tree: SyntaxTree) -> Many:
        """What stands behind a condition. A place chosen by a computed number is chosen behind the condition too."""
        return self.as_statements(self.with_choices(lambda: self.statement(tree)))

    # ---- the file

    def on_header(self, tree: SyntaxTree) -> Lowered:
        header = read_header(self.origin.text)
        return Open("program", header, self.origin)

    def on_positions(self, tree: SyntaxTree) -> Lowered:
        return Middle("program", "positions", self.origin)

    def on_point_data(self, tree: SyntaxTree) -> Lowered:
        position = self.place.taught.get(self.origin.start) or parse_position(self.origin.text)
        return variable(position, self.origin)

    def on_end_of_file(self, tree: SyntaxTree) -> Lowered:
        return Close("program", None, self.origin)

    def on_nested_end(self, tree: SyntaxTree) -> Lowered:
        return Close("point logic", None, self.origin)

    def on_macro(self, tree: SyntaxTree) -> Lowered:
        """An instruction whose name is no key word and no macro of the project: the controller's own business."""
        written = str(tree.children[0])[1:].strip()
        plain, _ = without_notes(written)
        effect = tables.instruction_effect(plain)
        if effect == "unknown":
            self.diagnostics.report(INSTRUCTION, self.origin, text=written)
        return self.vendor(written, effect)

    # ---- assignments

    def on_assign(self, tree: SyntaxTree) -> Lowered:
        target = self.typed(_tree(tree.children[0]))
        value = self.typed(_tree(tree.children[1]))
        match target.node:
            case ir.VendorValue():
                return self.vendor(self.origin_line(), "unknown")
            case ir.System(name="timer"):
                return ir.Assign(target.node, self.as_number(value), origin=self.origin)
            case ir.Index(base=ir.Name(id="UFRAME" | "UTOOL")):
                return self.frame(target.node, value)
            case ir.Name() | ir.Index() | ir.Field() | ir.Signal() | ir.System():
                if _is_marker(target.node) and not isinstance(value.node, ir.BoolLiteral):
                    self.diagnostics.report(MARKER, self.origin, name=self.origin_part("M"))
                return ir.Assign(target.node, self.converted(value, target.kind), origin=self.origin)
        raise StatementError("nothing can be assigned to this", 0)

    def on_assign_text_function(self, tree: SyntaxTree) -> Lowered:
        """`R[1]=STRLEN SR[2]`: text functions are written without brackets."""
        target = self.typed(_tree(tree.children[0]))
        values = [self.typed(_tree(child)) for child in tree.children[2:]]
        value = self.called(str(tree.children[1]).upper(), values)
        return ir.Assign(target.node, self.converted(value, target.kind), origin=self.origin)

    def converted(self, value: Typed, kind: str) -> ir.Expression:
        match kind:
            case "b":
                return self.as_truth(value)
            case "t":
                return self.text(value)
            case "p" | "j":
                return self.position(value, kind)
        return self.as_number(value)

    def frame(self, place: ir.Index, value: Typed) -> Lowered:
        """UFRAME[n]=PR[m]; where n is the active one the change takes effect at once."""
        assert isinstance(place.base, ir.Name)
        name = place.base.id
        pose = ir.Builtin("pose_of", (self.position(value, "p"),), origin=self.origin)
        given = value.node if isinstance(value.node, ir.Index) and value.node.base == ir.Name("UFRAME") else pose
        number = ir.Name(f"{name}_NUM", origin=self.origin)
        active = ir.Binary("=", number, place.indices[0], origin=self.origin)
        system = ir.System("base" if name == "UFRAME" else "tool", origin=self.origin)
        again = ir.If(((active, (ir.Assign(system, place, origin=self.origin),)),), origin=self.origin)
        return ir.Assign(place, given, origin=self.origin), again

    def on_frame_number(self, tree: SyntaxTree) -> Lowered:
        name = str(tree.children[0]).upper()
        bank = name.removesuffix("_NUM")
        parts = [child for child in tree.children[1:] if isinstance(child, Tree)]
        if parts[0].data == "group_suffix" and str(parts[0].children[0]).upper() != "GP1":
            return self.vendor(self.origin_line(), "none")
        value = self.number(parts[-1])
        number = ir.Name(name, origin=self.origin)
        index: ir.Expression = value if isinstance(value, ir.IntLiteral) else number
        frame = ir.Index(ir.Name(bank, origin=self.origin), (index,), origin=self.origin)
        system = ir.System("base" if bank == "UFRAME" else "tool", origin=self.origin)
        whole = value if isinstance(value, ir.IntLiteral) else ir.Convert("trunc", value, origin=self.origin)
        return ir.Assign(number, whole, origin=self.origin), ir.Assign(system, frame, origin=self.origin)

    def on_watch(self, tree: SyntaxTree) -> Lowered:
        """TIMER[n]=START | STOP | RESET."""
        place, word = self.typed(_tree(tree.children[0])).node, str(tree.children[1]).upper()
        if not isinstance(place, ir.System):
            raise StatementError(f"only a timer can be set to {word}", 0)
        if word == "RESET":
            return ir.Assign(place, ir.IntLiteral(0, origin=self.origin), origin=self.origin)
        stopped = ir.System("timer_stopped", place.indices, origin=self.origin)
        return ir.Assign(stopped, ir.BoolLiteral(word == "STOP", origin=self.origin), origin=self.origin)

    def on_pulse(self, tree: SyntaxTree) -> Lowered:
        signal = self.typed(_tree(tree.children[0])).node
        if not isinstance(signal, ir.Signal):
            raise StatementError("only an output can be pulsed", 0)
        parts = [child for child in tree.children[1:] if isinstance(child, Tree)]
        for unit in tree.children[3:]:
            self.unit(unit, "sec", "s")
        time: ir.Expression = self.number(parts[0]) if parts else ir.RealLiteral(tables.PULSE_DEFAULT_S)
        return ir.Pulse(signal, ir.BoolLiteral(True), self.pulse_length(time), origin=self.origin)

    def pulse_length(self, time: ir.Expression) -> ir.Expression:
        """As the controller keeps it: in tenths of a second; too short a one gets the default, too long is refused."""
        seconds = time.value if isinstance(time, ir.IntLiteral | ir.RealLiteral) else None
        if seconds is None:
            return time
        tenths = math.floor(seconds * 10.0 + 0.5)
        if tenths > tables.LONGEST_PULSE_TENTHS:
            raise StatementError(f"a pulse lasts at most {tables.LONGEST_PULSE_TENTHS / 10.0:g} s", 0)
        if abs(tenths / 10.0 - seconds) < _SAME_S and tenths:
            return time
        return ir.RealLiteral(tenths / 10.0 if tenths else tables.PULSE_DEFAULT_S, origin=self.origin)

    def unit(self, child: object, *wanted: str) -> None:
        if str(child).lower() not in wanted:
            raise StatementError(f"the unit here is {wanted[0]}, not {child}", 0)

    def on_override(self, tree: SyntaxTree) -> Lowered:
        for unit in tree.children[1:]:
            self.unit(unit, "%")
        override = ir.System("override", origin=self.origin)
        return ir.Assign(override, self.number(_tree(tree.children[0])), origin=self.origin)

    # ---- jumps, branches, loops

    def on_label(self, tree: SyntaxTree) -> Lowered:
        return ir.Label(f"LBL{self.whole(tree.children[0])}", origin=self.origin)

    def on_dead_label(self, tree: SyntaxTree) -> Lowered:
        """`LBL[*15]`: a label that the editor has switched off."""
        return self.vendor(self.origin_line(), "none")

    def on_jump(self, tree: SyntaxTree) -> Lowered:
        return self.jump(_tree(tree.children[0]))

    def jump(self, target: SyntaxTree) -> ir.Statement:
        (done,) = self.as_statements(self.with_choices(lambda: self.goto(target)))
        return done

    def goto(self, target: SyntaxTree) -> ir.Statement:
        if target.data == "dead_target":
            return self.vendor(self.origin_line(), "unknown")
        number = self.index(_tree(target.children[0]))
        if not isinstance(number, ir.IntLiteral):
            number = ir.IntLiteral(self.choice(number, self.place.labels))
        if number.value not in self.place.labels:
            self.diagnostics.report(MISSING_LABEL, self.origin, number=number.value)
        return ir.Goto(f"LBL{number.value}", origin=self.origin)

    def on_if_action(self, tree: SyntaxTree) -> Lowered:
        condition = self.truth(_tree(tree.children[0]))
        return ir.If(((condition, self.action(_tree(tree.children[1]))),), origin=self.origin)

    def on_if_then(self, tree: SyntaxTree) -> Lowered:
        before, condition = self.in_front(CHOSEN_TRUTH, lambda: self.truth(_tree(tree.children[0])))
        return (*before, Open("if", condition, self.origin))

    def in_front(self, name: str, value: Callable[[], ir.Expression]) -> tuple[Many, ir.Expression]:
        """A value that opens a block. Where a computed number chooses a place in it, it is worked out in front."""
        try:
            return (), value()
        except Choice:
            self.choices += 1
            kept = ir.Name(f"{name}{self.choices}", origin=self.origin)
            steps = self.with_choices(lambda: ir.Assign(kept, value(), origin=self.origin))
            return self.as_statements(steps), kept

    def on_else_part(self, tree: SyntaxTree) -> Lowered:
        return Middle("if", None, self.origin)

    def on_end_if(self, tree: SyntaxTree) -> Lowered:
        return Close("if", None, self.origin)

    def on_select(self, tree: SyntaxTree) -> Lowered:
        selector, *parts = [_tree(child) for child in tree.children if isinstance(child, Tree)]
        chosen = self.typed(selector)
        cases, default = [], None
        while parts:
            if len(parts) == 1:
                default = self.action(parts.pop(0))
                break
            value, branch = parts.pop(0), parts.pop(0)
            given = self.converted(self.typed(value), "t" if chosen.kind == "t" else "n")
            cases.append(ir.Case((given,), self.action(branch), origin=self.origin))
        node = chosen.node if chosen.kind == "t" else self.as_number(chosen)
        return ir.Switch(node, tuple(cases), default, origin=self.origin)

    def on_for_open(self, tree: SyntaxTree) -> Lowered:
        counter = self.typed(_tree(tree.children[0]))
        early, start = self.in_front(CHOSEN_NUMBER, lambda: self.number(_tree(tree.children[1])))
        late, stop = self.in_front(CHOSEN_NUMBER, lambda: self.number(_tree(tree.children[3])))
        down = str(tree.children[2]).upper() == "DOWNTO"
        if counter.kind != "n":
            raise StatementError("FOR counts in a numeric register", 0)
        return (*early, *late, Open("for", (counter.node, start, stop, down), self.origin))

    def on_end_for(self, tree: SyntaxTree) -> Lowered:
        return Close("for", None, self.origin)

    def on_end(self, tree: SyntaxTree) -> Lowered:
        return ir.Return(origin=self.origin)

    def on_pause(self, tree: SyntaxTree) -> Lowered:
        return ir.Halt("stop", origin=self.origin)

    def on_abort(self, tree: SyntaxTree) -> Lowered:
        return ir.Halt("exit", origin=self.origin)

    # ---- calls, tasks, monitors

    def on_call_named(self, tree: SyntaxTree) -> Lowered:
        name = str(tree.children[0]).split(None, 1)[1]
        arguments = self.arguments(tree.children[1:], name)
        return ir.CallRoutine(self.facts.routine_name(name), arguments, origin=self.origin)

    def on_call_dynamic(self, tree: SyntaxTree) -> Lowered:
        name = self.text(self.typed(_tree(tree.children[0])))
        return ir.CallRoutine("", self.arguments(tree.children[1:], ""), name, origin=self.origin)

    def arguments(self, children: Sequence[object], name: str) -> tuple[ir.Argument, ...]:
        trees = [_tree(child) for child in _tree(children[0]).children] if children else []
        done = []
        for number, argument in enumerate(trees, 1):
            if not argument.children:
                done.append(ir.Argument(None))
                continue
            value = self.typed(_tree(argument.children[0]))
            kind = self.facts.parameter_kind(name, number) if name else value.kind
            wanted = kind if value.kind in ("n", "b", "t") and kind in ("n", "t") else value.kind
            done.append(ir.Argument(value.node if wanted == "u" else self.converted(value, wanted)))
        return tuple(done)

    def on_run(self, tree: SyntaxTree) -> Lowered:
        name = str(tree.children[0]).split(None, 1)[1]
        return ir.TaskControl("start", self.facts.routine_name(name), origin=self.origin)

    def on_monitor(self, tree: SyntaxTree) -> Lowered:
        name = str(tree.children[0]).split(None, 1)[1]
        return ir.CallRoutine(self.facts.routine_name(name), origin=self.origin)

    def on_monitor_end(self, tree: SyntaxTree) -> Lowered:
        name = str(tree.children[0]).split()[-1]
        known = self.facts.monitors.get(name.upper())
        if known is None:
            return self.vendor(self.origin_line(), "unknown")
        first, count = known
        return tuple(
            ir.ControlInterrupt("off", ir.IntLiteral(first + place), origin=self.origin) for place in range(count)
        )

    def on_when(self, tree: SyntaxTree) -> Lowered:
        """WHEN of a condition program watches from MONITOR on and comes once. What holds already comes at once,
        an edge (`ON+`) does not (measured on a virtual controller, CrossArm)."""
        first, _ = self.facts.monitors.get(self.place.program.upper(), (1, 0))
        number = ir.IntLiteral(first + self.interrupts)
        self.interrupts += 1
        edge = self.edge_of(_tree(tree.children[0]))
        condition = edge[1] if edge is not None else self.truth(_tree(tree.children[0]))
        (action,) = self.action(_tree(tree.children[1]))
        if not isinstance(action, ir.CallRoutine | ir.Assign):
            raise StatementError("a monitored condition can only call a program or set something", 0)
        declared = ir.DeclareInterrupt(number, condition, action, True, once=True, origin=self.origin)
        armed = ir.ControlInterrupt("on", number, origin=self.origin)
        if edge is not None:
            return declared, armed
        disarmed = ir.ControlInterrupt("off", number, origin=self.origin)
        return declared, armed, ir.If(((condition, (disarmed, action)),), origin=self.origin)

    # ---- waiting, conditions

    def on_wait(self, tree: SyntaxTree) -> Lowered:
        expression = _tree(tree.children[0])
        target = next((_tree(c) for c in tree.children[1:] if isinstance(c, Tree)), None)
        edge = self.edge_of(expression)
        if edge is not None:
            before, after = edge
            return self.wait_until(before, None), *self.waited(after, target)
        value = self.typed(expression)
        if value.kind == "n" and target is None:
            return ir.Wait(value.node, origin=self.origin)
        return self.waited(self.as_truth(value), target)

    def edge_of(self, tree: SyntaxTree) -> tuple[ir.Expression, ir.Expression] | None:
        """`DI[1]=ON+` waits for the signal to become ON: first it has to be OFF."""
        if tree.data != "equality" or _tree(tree.children[-1]).data != "edge":
            return None
        signal = self.truth(_tree(tree.children[0]))
        rises = str(_tree(tree.children[-1]).children[0]).upper().startswith("ON")
        absent = ir.Unary("not", signal, origin=self.origin)
        return (absent, signal) if rises else (signal, absent)

    def waited(self, condition: ir.Expression, target: SyntaxTree | None) -> Many:
        if target is None:
            return (self.wait_until(condition, None),)
        late = ir.Name(TIMED_OUT, origin=self.origin)
        jump = ir.If(((late, (self.jump(target),)),), origin=self.origin)
        return self.wait_until(condition, late), jump

    def wait_until(self, condition: ir.Expression, late: ir.Expression | None) -> ir.WaitUntil:
        if late is None:
            return ir.WaitUntil(condition, origin=self.origin)
        limit = ir.Binary("/", ir.Name(tables.WAIT_TIMEOUT), ir.RealLiteral(100.0), origin=self.origin)
        return ir.WaitUntil(condition, limit, late, origin=self.origin)

    def on_skip_condition(self, tree: SyntaxTree) -> Lowered:
        """What later moves with Skip watch: part of those moves (see modal.py)."""
        expression = _tree(tree.children[0])
        edge = self.edge_of(expression)
        return self.set_modal(modal.SKIP, edge[1] if edge else self.truth(expression))

    def set_modal(self, word: str, value: ir.Expression) -> ir.Assign:
        given = self.modal.setdefault(word, [])
        given.append(value)
        return modal.mark(word, len(given), self.origin)

    def on_offset_condition(self, tree: SyntaxTree) -> Lowered:
        return self.modal_offset(modal.OFFSET, tree)

    def modal_offset(self, word: str, tree: SyntaxTree) -> Lowered:
        """What later moves with a bare Offset take. With a frame of its own the offset means something else."""
        given = self.typed(_tree(tree.children[0]))
        if self.offsets.setdefault(word, given.kind) != given.kind:
            raise StatementError("the offsets of one program are either positions or joints", 0)
        made = self.set_modal(word, given.node)
        if len(tree.children) > 1:
            return self.vendor(self.origin_line(), "unknown"), made
        return made

    def on_tool_offset_condition(self, tree: SyntaxTree) -> Lowered:
        return self.modal_offset(modal.TOOL_OFFSET, tree)

    # ---- the operator, settings

    def on_message(self, tree: SyntaxTree) -> Lowered:
        text = str(tree.children[0])
        inner = text[text.index("[") + 1 :].rstrip().removesuffix("]")
        return ir.Message("notify", ir.TextLiteral(inner, origin=self.origin), origin=self.origin)

    def on_user_alarm(self, tree: SyntaxTree) -> Lowered:
        """UALM[n]: the alarm's text is controller data; M: by its severity the program pauses."""
        number = self.index(_tree(tree.children[0]))
        shown: ir.Expression = ir.TextLiteral("UALM")
        if isinstance(number, ir.IntLiteral):
            shown = ir.TextLiteral(f"UALM[{number.value}]", origin=self.origin)
        return ir.Message("error", shown, origin=self.origin), ir.Halt("stop", origin=self.origin)

    def on_payload(self, tree: SyntaxTree) -> Lowered:
        """PAYLOAD[n]: the load that a dump has under this number; without one the controller alone knows it."""
        number = self.index(_tree(tree.children[-1]))
        known = self.facts.loads.get(number.value) if isinstance(number, ir.IntLiteral) else None
        said = self.vendor(self.origin_line(), "tuning")
        if known is None or known.get("M", 0.0) <= 0.0 or len(tree.children) > 1:
            return said
        parts: list[tuple[str | None, ir.Expression]] = [("mass", ir.RealLiteral(known["M"]))]
        centre = tuple((axis.lower(), ir.RealLiteral(known.get(axis, 0.0))) for axis in "XYZ")
        parts.append(("cog", ir.Aggregate(centre, "vector")))
        parts += [(name.lower(), ir.RealLiteral(known.get(name, 0.0))) for name in ("IX", "IY", "IZ")]
        load = ir.Aggregate(tuple(parts), "load", origin=self.origin)
        return said, ir.Assign(ir.System("load", origin=self.origin), load, origin=self.origin)

    def on_preread(self, tree: SyntaxTree) -> Lowered:
        """LOCK PREG lets position registers be read ahead: no difference to a program that is right."""
        return self.vendor(self.origin_line(), "tuning")

    def on_program_setting(self, tree: SyntaxTree) -> Lowered:
        return self.vendor(self.origin_line(), "none")


def _is_marker(place: ir.Expression) -> bool:
    return isinstance(place, ir.Signal) and (place.name or "")[:1] == "M"


def _tree(child: object) -> SyntaxTree:
    assert isinstance(child, Tree)  # the grammar says so
    return child


__all__ = [
    "CHOSEN_NUMBER",
    "CHOSEN_TRUTH",
    "HIT",
    "TIMED_OUT",
    "Lowered",
    "Many",
    "Statements",
    "Token",
]
