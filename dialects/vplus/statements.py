"""V+ steps to IR elements: programs, control flow, assignments, calls, tasks, messages. Motion, signals and settings
stand in their own files.

`EXIT n` and `NEXT n` reach over n loops; they leave as jumps to marks (`LEAVE_MARK`) that `blocks` resolves.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass

from lark import Token, Tree

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.reading.pieces import Close, Middle, ModulePart, Open
from rpl.reading.shapes import Slot, StatementError, SyntaxTree
from rpl.source import Origin

from . import decode, formats, tables
from .decode import LEAVE_MARK, Lowered
from .expressions import Facts, root_name, significant, subtree
from .functions import Functions
from .quick import round_of
from .split import Outline, code_of

ALWAYS_TRUE = code(
    "vplus-constant-wait",
    Severity.WARNING,
    "WAIT does not wait here: {text} is always true",
    "WAIT takes a condition; use WAIT.EVENT , seconds or DELAY to wait for a time",
)
BEHIND_END = code(
    "vplus-text-behind-end", Severity.WARNING, "{text} behind END is read over", "write it behind a semicolon"
)
DOUBLE = code(
    "vplus-double-as-single",
    Severity.WARNING,
    "DOUBLE variables have eight bytes on the controller; here they are calculated with four as all others",
    "compare what depends on the further digits with a tolerance",
)
UNKNOWN_TASK = code(
    "vplus-unknown-task",
    Severity.WARNING,
    "which program runs in task {task} is not known: {count} programs are executed there",
)

Operands = list[SyntaxTree | None]


@dataclass(frozen=True, slots=True)
class Header:
    """What stands in a .PROGRAM line."""

    name: str
    parameters: tuple[tuple[str, int], ...]  # name, number of dimensions (0: no array)


@dataclass(frozen=True, slots=True)
class Declared:
    """AUTO, LOCAL or GLOBAL: `kind` in lower case, `type` real, double, loc or empty, bounds per dimension."""

    kind: str
    type: str
    names: tuple[tuple[str, tuple[ir.Expression | None, ...]], ...]


@dataclass(frozen=True, slots=True)
class Datum:
    """A line of a data section."""

    name: str
    indices: tuple[int, ...]
    values: tuple[ir.Expression, ...]


@dataclass(frozen=True, slots=True)
class Instruction:
    """One instruction with its operands as trees, and what stands behind them."""

    word: str
    operands: Operands
    brackets: SyntaxTree | None
    unit: str
    always: bool
    origin: Origin


def _operand(part: SyntaxTree) -> SyntaxTree | None:
    """What stands in one place of a list of operands; None where nothing does."""
    return subtree(part.children[0]) if part.children else None


@dataclass(frozen=True, slots=True)
class Round:
    """EXECUTE of a program several times (a negative number: for ever), as the program `name` that does it."""

    name: str
    program: str
    cycles: int
    origin: Origin


class Statements(Functions):
    """Lowers statement trees; the base of the families of instructions."""

    def __init__(self, facts: Facts, diagnostics: Diagnostics) -> None:
        super().__init__(facts, diagnostics)
        self.outline = Outline()
        self.section = ""
        self.rounds: dict[str, Round] = {}
        self.program = ""  # the name of the one that is read
        self.events: set[str] = set()  # variables that are events of tasks

    def lower(self, tree: SyntaxTree, numbers: tuple[str, ...], origin: Origin) -> Lowered:
        """The element(s) of one statement."""
        self.numbers, self.origin = numbers, origin
        self.steps, self.met = [], []
        children = tree.children
        kind = str(tree.data)
        method: Callable[[SyntaxTree, Origin], Lowered] | None = getattr(self, f"on_{kind}", None)
        if method is None:
            if kind == "statement" and len(children) == 1:
                return self.lower(subtree(children[0]), numbers, origin)
            raise StatementError(f"did not expect {kind} here", 0)
        lowered = method(tree, origin)
        return decode.in_front(tree, lowered, tuple(self.steps), origin) if self.steps else lowered

    # ---- programs and sections

    def on_program(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        parameters: list[tuple[str, int]] = []
        for child in tree.children[1:]:
            for given in subtree(child).children:
                parts = subtree(given).children
                if parts:
                    count = len(subtree(parts[1]).children) if len(parts) > 1 else 0
                    parameters.append((self.name(str(parts[0])), count))
        self.section, self.program = "", significant(str(tree.children[0]))
        return Open("program", Header(str(tree.children[0]), tuple(parameters)), origin)

    def on_end_program(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        closed, self.section = ("data" if self.section else "program"), ""
        return Close(closed, None, origin)

    def on_section(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        self.section = str(tree.children[0]).upper()
        return Open("data", self.section, origin)

    def on_datum(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        """`name value ...` of a data section."""
        from .sections import datum

        found = datum(self.section, code_of(origin.text))
        return ModulePart("datum", (), (), Datum(self.name(found.name), found.indices, found.values), origin)

    def on_label(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        return ir.Label(str(self.number(tree.children[0])), origin=origin)

    def on_declare(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        kind = str(tree.children[0]).lower()
        type, names = "", []
        for child in tree.children[1:]:
            if isinstance(child, Token):
                type = child.lower()
                continue
            parts = subtree(child).children
            bounds: tuple[ir.Expression | None, ...] = ()
            if len(parts) > 1:
                bounds = tuple(self.optional(subtree(bound)) for bound in subtree(parts[1]).children)
            names.append((self.name(str(parts[0])), bounds))
        if type == "double":
            self.diagnostics.report(DOUBLE, origin)
        return ModulePart("declared", (), (), Declared(kind, type, tuple(names)), origin)

    # ---- assignments and calls

    def on_assign(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        target = self.place(subtree(tree.children[0]))
        value = subtree(tree.children[1])
        if value.data == "call" and str(value.children[0]).lower() == "$decode":
            values = self.values(subtree(value.children[1]))
            if values[:1] == [target]:  # the head alone is left
                head = self.temporary("$decoded")
                return *decode.decoded(head, values, origin), ir.Assign(target, head, origin=origin)
            return decode.decoded(target, values, origin)
        return ir.Assign(target, self.expression(value), origin=origin)

    def place(self, tree: SyntaxTree) -> ir.Expression:
        """What is written to: a variable, even one whose name is a constant's elsewhere."""
        if tree.data == "reference" and len(tree.children) == 1:
            return ir.Name(self.name(str(tree.children[0])), origin=self.origin)
        target = self.expression(tree)
        if root_name(target) is None:
            raise StatementError("a value cannot be stored here", 0)
        return target

    def on_set(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        target, value = subtree(tree.children[0]), self.expression(subtree(tree.children[1]))
        return self.stored(target, value, origin)

    def stored(self, target: SyntaxTree, value: ir.Expression, origin: Origin) -> Lowered:
        """A location stored in a variable; of a compound one the last part is solved for."""
        if target.data == "compose":
            last = self.place(subtree(target.children[-1]))
            before = self.expression(subtree(target.children[0]))
            inverse = ir.Builtin("inverse", (before,), origin=origin)
            return ir.Assign(last, ir.Binary(":", inverse, value, origin=origin), origin=origin)
        place = self.place(target)
        name = root_name(place) or ""
        if not name.startswith("#"):
            value = ir.Builtin("pose_of", (value,), origin=origin)  # a mark that both are locations
        return ir.Assign(place, value, origin=origin)

    def on_call_routine(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        name = self.name(str(tree.children[0]))
        arguments = self.arguments(subtree(tree.children[1])) if len(tree.children) > 1 else ()
        return ir.CallRoutine(name, arguments, origin=origin)

    def arguments(self, tree: SyntaxTree) -> tuple[ir.Argument, ...]:
        """Variables are passed by reference; a bracketed one and everything else by value."""
        given = [subtree(child) for child in tree.children]
        while given and not given[-1].children:
            given.pop()
        return tuple(self.argument(child) for child in given)

    def argument(self, tree: SyntaxTree) -> ir.Argument:
        if not tree.children:
            return ir.Argument(None)
        inner = subtree(tree.children[0])
        value = self.expression(inner)
        if inner.data == "group":
            value = by_value(value)
        return ir.Argument(value)

    def on_call_computed(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        inner = subtree(tree.children[0])
        arguments: tuple[ir.Argument, ...] = ()
        if inner.data == "call" and str(inner.children[0]).lower() not in tables.FUNCTIONS:
            arguments = self.arguments(subtree(inner.children[1]))
            name: ir.Expression = ir.Name(self.name(str(inner.children[0])), origin=origin)
        else:
            name = self.expression(inner)
        return ir.CallRoutine("", arguments, name, origin=origin)

    def on_call_element(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        element = SyntaxTree("reference", list(tree.children[:2]))
        return ir.CallRoutine("", self.arguments(subtree(tree.children[2])), self.expression(element), origin=origin)

    def on_call_text(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        name = ir.TextLiteral(str(tree.children[0])[1:-1], origin=origin)
        return ir.CallRoutine("", self.arguments(subtree(tree.children[1])), name, origin=origin)

    # ---- control flow

    def opened(self, origin: Origin, data: object) -> Open:
        return Open(self.outline.kinds.get(origin.start, "IF"), data, origin)

    def owner(self, origin: Origin, otherwise: str) -> str:
        return self.outline.owner.get(origin.start, otherwise)

    def first(self, tree: SyntaxTree) -> ir.Expression:
        return self.expression(subtree(tree.children[0]))

    def on_if_open(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        return self.opened(origin, self.first(tree))

    def on_if_goto(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        jump = ir.Goto(str(self.number(tree.children[1])), origin=origin)
        return ir.If(((self.first(tree), (jump,)),), origin=origin)

    def on_else_(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        return Middle(self.owner(origin, "IF"), None, origin)

    def on_end_block(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        if tree.children:
            self.diagnostics.report(BEHIND_END, origin, text=str(tree.children[0]))
        return Close(self.owner(origin, "block"), None, origin)

    def on_case_open(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        return self.opened(origin, self.first(tree))

    def on_value(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        values = tuple(self.expression(subtree(child)) for child in tree.children)
        return Middle(self.owner(origin, "CASE"), values, origin)

    def on_any_(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        return Middle(self.owner(origin, "CASE"), None, origin)

    def on_for_open(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        counter = self.place(subtree(tree.children[0]))
        start, stop, *step = (self.expression(subtree(child)) for child in tree.children[1:])
        by = step[0] if step else None
        if isinstance(by, ir.IntLiteral) and by.value == 0:
            raise StatementError("STEP 0 never ends", 0)
        return self.opened(origin, (counter, start, stop, by))

    def on_while_open(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        return self.opened(origin, self.first(tree))

    def on_do_open(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        return self.opened(origin, None)

    def on_until(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        return Close(self.owner(origin, "DO"), self.first(tree), origin)

    def on_leave(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        word = str(tree.children[0]).lower()
        count = self.number(tree.children[1]) if len(tree.children) > 1 else 1
        if count < 1:
            raise StatementError(f"{word.upper()} needs a number of loops from 1", 0)
        return ir.Goto(LEAVE_MARK.format(word=word, count=count), origin=origin)

    def on_goto(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        return ir.Goto(str(self.number(tree.children[0])), origin=origin)

    # ---- operator

    def on_type_(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        return ir.Message("write", formats.text_of(self.items(subtree(tree.children[1])), origin), origin=origin)

    def on_write(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        """WRITE (lun) items: to the terminal (4) or the pendant (1) like TYPE, else to a device."""
        units = self.values(subtree(tree.children[1]))
        if units in ([ir.IntLiteral(4)], [ir.IntLiteral(1)]):
            return ir.Message("write", formats.text_of(self.items(subtree(tree.children[2])), origin), origin=origin)
        return ir.Vendor("vplus", code_of(origin.text), "message", origin=origin)

    def on_raw(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        """An instruction that only the controller can carry out."""
        text = code_of(origin.text)
        word = text.split("(")[0].split()[0].lower()
        effect = tables.RAW_EFFECTS.get(word, "unknown")
        inner = text[len(word) :].strip().replace(" ", "")
        if word == "attach" and inner not in ("", "()", "(0)", "(0,0)", "(0,1)"):
            effect = "unknown"
        return ir.Vendor("vplus", text, effect, origin=origin)

    # ---- tasks

    def on_execute(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        name, further = "", []
        arguments: tuple[ir.Argument, ...] = ()
        for child in tree.children:
            if isinstance(child, Token) and child.type == "NAME":
                name = self.name(str(child))
            elif isinstance(child, Tree) and child.data == "arguments":
                arguments = self.arguments(child)
            elif isinstance(child, Tree) and child.data == "optional":
                further.append(self.optional(child))
        cycles = signed(further[0]) if further and further[0] is not None else 1
        if len(further) > 1 or not cycles:
            return ir.Vendor("vplus", code_of(origin.text), "unknown", origin=origin)
        if cycles != 1:
            several = round_of(name, cycles)
            self.rounds.setdefault(significant(several), Round(several, name, cycles, origin))
            name = self.name(several)
        return ir.TaskControl("start", name, arguments, origin=origin)

    def task_of(self, operands: Operands, op: str, origin: Origin) -> Lowered:
        """ABORT n and the like: the program that is executed in task n, where the project tells."""
        given = operands[0] if operands else None
        if given is None:
            return ir.Vendor("vplus", code_of(origin.text), "unknown", origin=origin)
        number = self.expression(given)
        key = str(number.value) if isinstance(number, ir.IntLiteral) else (root_name(number) or "").lower()
        programs = sorted(self.facts.executed.get(key, frozenset()))
        elsewhere = {name for task, names in self.facts.executed.items() if task != key for name in names}
        if op == "stop" and len(programs) > 1 and not elsewhere & set(programs):  # that of them which runs
            return tuple(ir.TaskControl(op, self.name(program), origin=origin) for program in programs)
        if len(programs) != 1:
            self.diagnostics.report(UNKNOWN_TASK, origin, task=key or "?", count=len(programs))
            return ir.Vendor("vplus", code_of(origin.text), "unknown", origin=origin)
        return ir.TaskControl(op, self.name(programs[0]), origin=origin)

    # ---- instructions

    def on_instruction(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        """One instruction; its family has a method of its own."""
        return self.instruction(self.taken(tree, origin))

    def on_bracketed(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        return self.instruction(self.taken(tree, origin))

    def taken(self, tree: SyntaxTree, origin: Origin) -> Instruction:
        word, unit, always = str(tree.children[0]).lower(), "", False
        brackets: SyntaxTree | None = None
        operands: Operands = []
        for child in tree.children[1:]:
            if isinstance(child, Token):
                unit, always = (unit, True) if child.type == "ALWAYS" else (child.lower(), always)
            elif isinstance(child, Slot):
                raise StatementError("a number stands where none can be", 0)
            elif child.data == "operands":
                operands = [_operand(subtree(part)) for part in child.children]
            else:
                brackets = child
        while operands and operands[-1] is None:
            operands.pop()
        return Instruction(word, operands, brackets, unit, always, origin)

    @abstractmethod
    def instruction(self, given: Instruction) -> Lowered:
        """A step that begins with a word of its own."""

    @abstractmethod
    def on_setting(self, tree: SyntaxTree, origin: Origin) -> Lowered:
        """A setting of the controller."""

    def operand(self, given: Instruction, position: int) -> ir.Expression | None:
        """An operand's value; None when it is left out."""
        tree = given.operands[position] if position < len(given.operands) else None
        return self.expression(tree) if tree is not None else None

    def needed(self, given: Instruction, position: int, what: str) -> ir.Expression:
        value = self.operand(given, position)
        if value is None:
            raise StatementError(f"{given.word.upper()} needs {what}", 0)
        return value

    def routine_named(self, tree: SyntaxTree) -> str:
        """A program's name among operands, with or without brackets behind it."""
        if tree.data in ("reference", "call") and isinstance(tree.children[0], Token):
            return self.name(str(tree.children[0]))
        raise StatementError("the name of a program is needed", 0)


def signed(value: ir.Expression) -> int:
    """A whole number that is written out, with its sign; else 0."""
    match value:
        case ir.IntLiteral(value=number):
            return number
        case ir.Unary(op="-", operand=ir.IntLiteral(value=number)):
            return -number
    return 0


def by_value(value: ir.Expression) -> ir.Expression:
    """A variable in brackets: its value is passed, not the variable."""
    name = root_name(value)
    if name is None:
        return value
    if name.startswith("$"):
        return ir.Binary("&", value, ir.TextLiteral(""), origin=value.origin)
    return ir.Unary("+", value, origin=value.origin)


__all__ = ["Datum", "Declared", "Header", "Instruction", "LEAVE_MARK", "Lowered", "Statements"]
