"""KRL statements to IR elements: control flow, waits, interrupts, assignments. Declarations and motion stand in their
own files; the block structure is declared here by what opens, divides and closes a block.
"""

from __future__ import annotations

from collections.abc import Callable

from lark import Token, Tree

from rpl import ir
from rpl.reading.pieces import Attribute, Close, Element, Middle, Open
from rpl.reading.shapes import Slot, StatementError, SyntaxTree
from rpl.source import Origin

from . import tables
from .calls import procedure_call
from .coupled import coupled_base
from .declarations import Declarations
from .expressions import Make, Pieces, as_number, mode_member

Lowered = Element | tuple[Element, ...]
Build = Callable[[Pieces, Origin], Lowered]
Pair = tuple[ir.Expression, ir.Expression]
Pairs = Callable[[Pieces, Origin], list[Pair]]


class Statements(Declarations):
    """Compiles statement trees; keeps what it has compiled by the identity of the shape's tree."""

    def lower(self, tree: SyntaxTree, pieces: Pieces, origin: Origin) -> Lowered:
        """The element(s) of one statement."""
        kept = self.compiled.get(id(tree))
        if kept is None:
            kept = (tree, self.statement(tree))
            self.compiled[id(tree)] = kept
        return kept[1](pieces, origin)

    def statement(self, tree: SyntaxTree) -> Build:
        """Compile one shape."""
        kind = str(tree.data)
        if kind == "statement":
            children = tree.children
            if len(children) == 2:
                return self.definition(_tree(children[0]), _tree(children[1]))
            return self.statement(_tree(children[0]))
        method: Callable[[SyntaxTree], Build] | None = getattr(self, f"on_{kind}", None)
        if method is None:
            return self.definition(None, tree)
        return method(tree)

    def definition(self, modifiers: SyntaxTree | None, tree: SyntaxTree) -> Build:
        if tree.data == "interrupt":
            return self.on_interrupt(tree, modifiers is not None)
        return super().definition(modifiers, tree)

    # ---- header, comments

    def on_attribute(self, tree: SyntaxTree) -> Build:
        text = str(tree.children[0])[1:].strip()
        name, _, value = text.partition(" ")
        return lambda pieces, origin: Attribute(name, value.strip(), origin)

    # ---- assignments and calls

    def on_assign(self, tree: SyntaxTree) -> Build:
        target, value = _tree(tree.children[0]), self.expression(_tree(tree.children[1]))
        first = target.children[0]
        name = str(first).lower() if isinstance(first, Token) else ""
        if name == "$out_c":
            return self.main_run_output(target, value)
        if name in tables.SCALARS and tables.SCALARS[name][0] in tables.MODES and len(target.children) == 1:
            variable = tables.SCALARS[name][0]
            return lambda pieces, origin: mode_assignment(variable, value(pieces, origin), origin)
        pairs = self.settings(target, _tree(tree.children[1]))
        if pairs is not None:

            def several(pieces: Pieces, origin: Origin) -> Lowered:
                done = tuple([ir.Assign(place, given, origin=origin) for place, given in pairs(pieces, origin)])
                return done[0] if len(done) == 1 else done

            return several
        place = self.reference(target)

        def one(pieces: Pieces, origin: Origin) -> Lowered:
            written, given = place(pieces, origin), value(pieces, origin)
            if isinstance(given, ir.Builtin) and self.is_number(written):
                given = as_number(given)
            return ir.Assign(written, given, origin=origin)

        return one

    def is_number(self, place: ir.Expression) -> bool:
        """Is it a variable that is declared as a number somewhere in the project?"""
        while isinstance(place, ir.Index):
            place = place.base
        return isinstance(place, ir.Name) and self.facts.types.get(place.id.lower()) in ("int", "real")

    def settings(self, target: SyntaxTree, value_tree: SyntaxTree) -> Pairs | None:
        """The neutral settings that assigning to a modal `$` variable stands for; None for any other target."""
        first = target.children[0]
        if not isinstance(first, Token) or not first.startswith("$"):
            return None
        name = first.lower()
        value = self.expression(value_tree)
        suffixes = [_tree(child) for child in target.children[1:]]
        if name in tables.STRUCTURES and not suffixes:
            return self.structure_settings(name, value)
        place = self.reference(target)

        def one(pieces: Pieces, origin: Origin) -> list[Pair]:
            written, given = place(pieces, origin), value(pieces, origin)
            if name == "$base" and not suffixes and isinstance(given, ir.Call):
                coupled = coupled_base(given, origin)
                if coupled is not None:
                    return coupled
            if isinstance(written, ir.Magnitude):  # $VEL.CP is m/s: what is assigned is a quantity
                return [(written.value, ir.Quantity(given, written.unit, origin=origin))]
            if isinstance(written, ir.System) and written.name in tables.MODES and isinstance(given, ir.EnumLiteral):
                return [(written, mode_member(written.name, given))]
            return [(written, given)]

        return one

    def structure_settings(self, name: str, value: Make) -> Pairs:
        parts = tables.STRUCTURES[name]

        def pairs(pieces: Pieces, origin: Origin) -> list[Pair]:
            given = value(pieces, origin)
            found: list[Pair] = []
            components: list[tuple[str, ir.Expression]]
            if isinstance(given, ir.Aggregate):
                components = [(key or "", part) for key, part in given.entries]
            else:
                components = [(key.upper(), ir.Field(given, key.upper(), origin=origin)) for key in parts]
            for key, part in components:
                neutral, unit = parts.get(key.lower(), ("", ""))
                if not neutral:
                    raise StatementError(f"{name.upper()} has no component {key}", 0)
                found.append(
                    (ir.System(neutral, origin=origin), ir.Quantity(part, unit, origin=origin) if unit else part)
                )
            return found

        return pairs

    def main_run_output(self, target: SyntaxTree, value: Make) -> Build:
        """`$OUT_C[n]=...` switches where the move before ends (in the middle of its corner), when the robot gets there,
        without stopping the advance run (expert programming, 5.3)."""
        indices = self.optionals(_tree(target.children[1])) if len(target.children) == 2 else []
        index = indices[0] if len(indices) == 1 else None
        if index is None:
            raise StatementError("$OUT_C needs one number", 0)

        def make(pieces: Pieces, origin: Origin) -> Lowered:
            output = ir.Signal("digital_out", index(pieces, origin), origin=origin)
            return ir.Trigger("start", ir.Assign(output, value(pieces, origin), origin=origin), origin=origin)

        return make

    def on_call_statement(self, tree: SyntaxTree) -> Build:
        name = str(tree.children[0])
        arguments = self.arguments(_tree(tree.children[1]))
        if name.lower() in self.facts.routines:
            return lambda pieces, origin: ir.CallRoutine(name, arguments(pieces, origin), origin=origin)
        return lambda pieces, origin: procedure_call(name, arguments(pieces, origin), code_text(origin), origin)

    def on_bare_call(self, tree: SyntaxTree) -> Build:
        name = str(tree.children[0])
        return lambda pieces, origin: procedure_call(name, (), code_text(origin), origin)

    def action(self, tree: SyntaxTree) -> Callable[[Pieces, Origin], ir.Assign | ir.CallRoutine]:
        """The statement behind DO of a trigger or interrupt.

        A routine of a technology package (H50, A20 ...) stays a call: it runs when the action does, and is named then.
        """
        build = self.statement(tree)
        called = tree.data == "call_statement"
        name = str(tree.children[0]) if called else ""
        arguments = self.arguments(_tree(tree.children[1])) if called else None

        def make(pieces: Pieces, origin: Origin) -> ir.Assign | ir.CallRoutine:
            done = build(pieces, origin)
            match done:
                case ir.Assign() | ir.CallRoutine():
                    return done
                case ir.Pulse(signal=ir.Signal(kind="digital_out", index=index)) if index is not None:
                    pulsed = (index, done.value, done.duration)
                    return ir.CallRoutine("PULSE_OUT", tuple(map(ir.Argument, pulsed)), origin=origin)
                case ir.StopMotion(hard=hard):
                    return ir.CallRoutine("BRAKE_HARD" if hard else "BRAKE_SOFT", origin=origin)
                case ir.Vendor() if arguments is not None:
                    return ir.CallRoutine(name, arguments(pieces, origin), origin=origin)
            raise StatementError("only an assignment or a call can stand behind DO", 0)

        return make

    # ---- control flow

    def on_if_open(self, tree: SyntaxTree) -> Build:
        return self.opening("if", tree)

    def on_if_else(self, tree: SyntaxTree) -> Build:
        return lambda pieces, origin: Middle("if", None, origin)

    def on_if_close(self, tree: SyntaxTree) -> Build:
        return _closing("if")

    def on_switch_open(self, tree: SyntaxTree) -> Build:
        return self.opening("switch", tree)

    def on_switch_case(self, tree: SyntaxTree) -> Build:
        values = [self.expression(_tree(child)) for child in tree.children]
        return lambda pieces, origin: Middle("switch", tuple(value(pieces, origin) for value in values), origin)

    def on_switch_default(self, tree: SyntaxTree) -> Build:
        return lambda pieces, origin: Middle("switch", None, origin)

    def on_switch_close(self, tree: SyntaxTree) -> Build:
        return _closing("switch")

    def on_for_open(self, tree: SyntaxTree) -> Build:
        counter = self.name(tree.children[0])
        start, stop, *rest = [self.expression(_tree(child)) for child in tree.children[1:]]
        step = rest[0] if rest else None

        def make(pieces: Pieces, origin: Origin) -> Lowered:
            by = step(pieces, origin) if step else None
            if isinstance(by, ir.IntLiteral) and by.value == 0:
                raise StatementError("STEP 0 never ends", 0)
            return Open("for", (counter(pieces), start(pieces, origin), stop(pieces, origin), by), origin)

        return make

    def on_for_close(self, tree: SyntaxTree) -> Build:
        return _closing("for")

    def on_while_open(self, tree: SyntaxTree) -> Build:
        return self.opening("while", tree)

    def on_while_close(self, tree: SyntaxTree) -> Build:
        return _closing("while")

    def on_repeat_open(self, tree: SyntaxTree) -> Build:
        return lambda pieces, origin: Open("repeat", None, origin)

    def on_repeat_close(self, tree: SyntaxTree) -> Build:
        until = self.expression(_tree(tree.children[0]))
        return lambda pieces, origin: Close("repeat", until(pieces, origin), origin)

    def on_loop_open(self, tree: SyntaxTree) -> Build:
        return lambda pieces, origin: Open("loop", None, origin)

    def on_loop_close(self, tree: SyntaxTree) -> Build:
        return _closing("loop")

    def opening(self, kind: str, tree: SyntaxTree) -> Build:
        value = self.expression(_tree(tree.children[0]))
        return lambda pieces, origin: Open(kind, value(pieces, origin), origin)

    def on_exit_loop(self, tree: SyntaxTree) -> Build:
        return lambda pieces, origin: ir.ExitLoop(origin=origin)

    def on_goto(self, tree: SyntaxTree) -> Build:
        label = self.name(tree.children[0])
        return lambda pieces, origin: ir.Goto(label(pieces), origin=origin)

    def on_label(self, tree: SyntaxTree) -> Build:
        label = self.name(tree.children[0])
        return lambda pieces, origin: ir.Label(label(pieces), origin=origin)

    def on_return_(self, tree: SyntaxTree) -> Build:
        if not tree.children:
            return lambda pieces, origin: ir.Return(origin=origin)
        value = self.expression(_tree(tree.children[0]))
        return lambda pieces, origin: ir.Return(value(pieces, origin), origin=origin)

    def on_halt(self, tree: SyntaxTree) -> Build:
        return lambda pieces, origin: ir.Halt(origin=origin)

    # ---- waiting, interrupts, background outputs

    def on_look_ahead(self, tree: SyntaxTree) -> Build:
        def make(pieces: Pieces, origin: Origin) -> Lowered:
            """The next line counts, even if it is empty (expert programming, 3.4): then CONTINUE does nothing."""
            behind = origin.source.text[origin.end :].split("\n", 2)[1:2] if origin.source is not None else []
            return ir.LookAhead(origin=origin) if not behind or behind[0].strip() else ir.Nothing(origin=origin)

        return make

    def on_wait_time(self, tree: SyntaxTree) -> Build:
        time = self.expression(_tree(tree.children[0]))
        return lambda pieces, origin: ir.Wait(time(pieces, origin), origin=origin)

    def on_wait_until(self, tree: SyntaxTree) -> Build:
        condition = self.expression(_tree(tree.children[0]))
        return lambda pieces, origin: ir.WaitUntil(condition(pieces, origin), origin=origin)

    def on_brake(self, tree: SyntaxTree) -> Build:
        word = self.name(tree.children[0])(()) if tree.children and not isinstance(tree.children[0], Slot) else ""
        if tree.children and word.upper() != "F":
            raise StatementError("BRAKE takes nothing but F", 0)
        return lambda pieces, origin: ir.StopMotion(bool(word), origin=origin)

    def on_resume(self, tree: SyntaxTree) -> Build:
        return lambda pieces, origin: ir.ResumeLevel(origin=origin)

    def on_interrupt_control(self, tree: SyntaxTree) -> Build:
        op = str(tree.children[0]).lower()
        if len(tree.children) == 1:
            return lambda pieces, origin: ir.ControlInterrupt(op, origin=origin)
        priority = self.expression(_tree(tree.children[1]))
        return lambda pieces, origin: ir.ControlInterrupt(op, priority(pieces, origin), origin=origin)

    def on_interrupt(self, tree: SyntaxTree, everywhere: bool = False) -> Build:
        priority, condition = (self.expression(_tree(child)) for child in tree.children[:2])
        action = self.action(_tree(tree.children[2]))
        return lambda pieces, origin: ir.DeclareInterrupt(
            priority(pieces, origin),
            _plain(condition(pieces, origin)),
            action(pieces, origin),
            everywhere,
            origin=origin,
        )

    def on_controller_only(self, tree: SyntaxTree) -> Build:
        """Conditions of spline motions, asynchronous axes."""
        text = str(tree.children[0]).rstrip()
        return lambda pieces, origin: ir.Vendor("krl", text, "unknown", origin=origin)

    def on_cyclic(self, tree: SyntaxTree) -> Build:
        """Cyclic analog signals: only the controller's own cycle can follow the value."""
        return lambda pieces, origin: ir.Vendor("krl", code_text(origin), "unknown", origin=origin)

    # ---- blocks of routines and data lists

    def on_end_routine(self, tree: SyntaxTree) -> Build:
        return _closing("routine")

    def on_data_list(self, tree: SyntaxTree) -> Build:
        name = self.name(tree.children[0])
        public = any(isinstance(child, Token) and child.type == "PUBLIC" for child in tree.children[1:])
        return lambda pieces, origin: Open("data", (name(pieces), public), origin)

    def on_end_data(self, tree: SyntaxTree) -> Build:
        return _closing("data")


def _plain(condition: ir.Expression) -> ir.Expression:
    """`$IN[1]==TRUE` as the signal itself: other controllers' interrupts watch a signal, not a comparison."""
    match condition:
        case ir.Binary(op="=", left=left, right=ir.BoolLiteral(value=True)):
            return left
        case ir.Binary(op="=", left=left, right=ir.BoolLiteral(value=False), origin=origin):
            return ir.Unary("not", left, origin=origin)
    return condition


def mode_assignment(variable: str, value: ir.Expression, origin: Origin) -> ir.Statement:
    """`$ORI_TYPE = ...`: a member by its neutral word; any other value is asked for, member by member."""
    target = ir.System(variable, origin=origin)
    if isinstance(value, ir.EnumLiteral):
        return ir.Assign(target, mode_member(variable, value), origin=origin)
    if isinstance(value, ir.System):
        return ir.Assign(target, value, origin=origin)
    cases = tuple(
        ir.Case(
            (ir.EnumLiteral(member.upper(), origin=origin),),
            (ir.Assign(target, ir.EnumLiteral(word, origin=origin), origin=origin),),
            origin=origin,
        )
        for member, word in tables.MODES[variable].items()
    )
    return ir.Switch(value, cases, origin=origin)


def _closing(kind: str) -> Build:
    return lambda pieces, origin: Close(kind, None, origin)


def code_text(origin: Origin) -> str:
    """The statement's text without the comment behind it."""
    from .split import code_of

    return code_of(origin.text)


def _tree(child: object) -> SyntaxTree:
    assert isinstance(child, Tree)  # the grammar says so
    return child
