"""A program as one `.v2` file: its programs, then the values of its global variables in data sections."""

from __future__ import annotations

import re
from dataclasses import dataclass

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.facts.usage import usage_of
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typing import type_of
from rpl.writing.ledger import EmissionLedger
from rpl.writing.statements import CannotSayError
from rpl.writing.target import OutputFile, WriteContext
from rpl.writing.templates import macros_of

from . import spelling, tables
from .data import declared, stored, values
from .facts.interrupts import Interrupts
from .facts.names import names_of, starts
from .facts.routines import filled, labels_of
from .facts.tasks import later_signals, tasks_of
from .facts.usualspeed import usual_speed
from .helpers import HELPERS
from .motion import MotionFacts
from .output import Output
from .reactions import Reactions
from .statements import Printer

LOST_DECLARATION = code(
    "vplus-lost-declaration", Severity.LOSS, "V+ cannot declare {name}: {reason}", "it is left as a comment"
)
LOST_HANDLER = code("vplus-lost-handler", Severity.LOSS, "V+ has no error handlers; the one of {name} is left out")
_ZEROS: dict[type, ir.Expression] = {
    ir.RealType: ir.IntLiteral(0),
    ir.BoolType: ir.BoolLiteral(False),
    ir.StringType: ir.TextLiteral(""),
}
_ORDER = (".LOCATIONS", ".REALS", ".STRINGS")


@dataclass(frozen=True, slots=True)
class ProgramText:
    """What the template needs of one program."""

    head: str
    lines: tuple[str, ...]


def write(program: ir.Program, context: WriteContext) -> list[OutputFile]:
    """The file of a program. Raises InternalError when the ledger finds a node that nobody accounted for."""
    return [_File(program, context).file()]


class _File:
    def __init__(self, program: ir.Program, context: WriteContext) -> None:
        self.program = program
        self.scopes = ProgramScope(self.program)
        self.ledger, self.diagnostics = EmissionLedger(), context.diagnostics
        facts = MotionFacts(context.diagnostics, context.robot, context.foreign)
        self.starting = starts(self.program)
        if context.foreign:
            facts.usual = usual_speed(self.program)
        self.output = Output(
            self.ledger,
            context.diagnostics,
            facts,
            Reactions(Interrupts.of(self.program)),
            names_of(self.program),
            macros_of(__package__, context.templates),
            context.left_alone,
            tasks_of(self.program),
            pulses=list(dict.fromkeys(later_signals(self.program).values())),
        )
        self.output.reactions.task_of = self.output.helper_task
        self.background = {task.entry.lower(): task for task in self.program.tasks if task.kind == "background"}
        self.assigned = set(usage_of(self.program).assigned)
        self.sections: dict[str, list[str]] = {}

    def file(self) -> OutputFile:
        first = self.program.modules[0]
        remarks = Printer(self.scopes.module(first), self.output)
        for module in self.program.modules:
            self.ledger.written(module)
            remarks.comments_only(module.origin)
            for declaration in module.declarations:
                self.data(declaration, self.scopes.module(module), remarks)
        programs = [self.routine(module, routine) for module in self.program.modules for routine in module.routines]
        programs.sort(key=lambda one: not one[1])
        later = [one for one in programs if one[0].head.startswith(f".PROGRAM {tables.LATER}")]
        programs = [one for one in programs if one not in later]
        indent = self.output.say("first")
        programs += [
            (ProgramText(head, tuple(indent + step for step in steps)), False)
            for head, *steps, _ in (HELPERS.texts[name] for name in sorted(HELPERS.needed(self.output.helpers)))
        ]
        programs += later
        programs += [
            (ProgramText(f".PROGRAM {watch.name}()", tuple(indent + step for step in watch.steps())), False)
            for watch in self.output.reactions.watches.values()
        ]
        say = self.output.say
        text = say(
            "file",
            before=[line.strip() for line in remarks.lines],
            programs=[say("program", heading=one.head, lines=one.lines) for one, _ in programs],
            sections=[(word, self.sections[word]) for word in _ORDER if word in self.sections],
        )
        self.ledger.check(self.program)
        text = "\r\n".join(line.rstrip() for line in text.splitlines()) + "\r\n"
        name = re.sub(r"[^\w.]", "_", first.name.lower()).strip(".") or "program"
        return OutputFile(f"{name}.v2", text.encode("ascii", "replace"))

    # ---- data

    def data(self, declaration: ir.Declaration, scope: Scope, printer: Printer) -> None:
        """A global variable: its first value, if it has one."""
        origin = declaration.origin
        try:
            match declaration:
                case ir.Variable():
                    self.place_values(declaration, scope)
                    self.remarks_of(declaration, printer)
                case ir.Initialise(assign=ir.Assign(target=target, value=value)):
                    type = type_of(target, scope)  # the printer sees the first module only
                    if type is None:
                        raise CannotSayError("its type is not known")
                    self.add(*stored(target, type, value, scope))
                case ir.SignalDeclaration(name=name, signal=signal):
                    printer.comments_only(origin)
                    printer.remark(f" {name} is {printer.expressions.text(signal)}")
                case ir.ExternalDeclaration() | ir.Unread(text="") | ir.RecordDeclaration() | ir.AliasDeclaration():
                    printer.comments_only(origin)
                case ir.Unread(text=text):
                    raise CannotSayError(f"it was not read ({text.strip()[:40]})")
                case _:
                    raise CannotSayError(f"there is no {declaration.__class__.__name__}")
        except CannotSayError as error:
            self.lost(declaration, printer, str(error))
        else:
            self.ledger.written(declaration)

    def remarks_of(self, variable: ir.Variable, printer: Printer) -> None:
        """V+ declares no global data: a remark behind the declaration names what it is about."""
        for comment in variable.origin.comments:
            if comment.behind and self.output.facts.foreign:
                printer.remark(f" {spelling.spelled(variable.name, variable.type)}: {comment.text.strip()}")
            else:
                printer.comment(comment)

    def place_values(self, variable: ir.Variable, scope: Scope) -> None:
        given = values(variable)
        if not given and self.output.facts.foreign and variable.name.lower() not in self.assigned:
            zero = _ZEROS.get(variable.type.__class__)  # read only: the source begins with it
            given = [(ir.Name(variable.name), variable.type, zero)] if zero is not None else []
        lines = [stored(place, type, value, scope) for place, type, value in given]
        for section, line in lines:
            self.add(section, line)

    def add(self, section: str, line: str) -> None:
        self.sections.setdefault(section, []).append(line)

    def lost(self, declaration: ir.Declaration, printer: Printer, reason: str) -> None:
        name = str(getattr(declaration, "name", "this"))
        printer.comments_only(declaration.origin)
        printer.remark(f" {declaration.origin.text or name}")
        self.diagnostics.report(LOST_DECLARATION, declaration.origin, name=name, reason=reason)
        self.ledger.reported(declaration)

    # ---- programs

    def routine(self, module: ir.Module, routine: ir.Routine) -> tuple[ProgramText, bool]:
        """A program, and whether it is one to start with."""
        scope = self.scopes.routine(module, routine)
        printer = Printer(scope, self.output, labels_of(routine))
        remarks = Printer(scope, self.output)
        remarks.comments_only(routine.origin)
        self.ledger.written(routine)
        if routine.kind == "function" or routine.returns is not None:
            self.diagnostics.report(
                LOST_DECLARATION, routine.origin, name=routine.name, reason="there are no user functions"
            )
        self.output.reactions.inside = routine.name.lower()
        first = routine.name.lower() in self.starting
        initial = self.own_data(routine, printer)
        values_first, printer.lines = printer.lines, []
        if first:
            self.opening(routine, printer)
        task = self.background.get(routine.name.lower())
        again = task is not None and task.cyclic
        if again:
            printer.put("while_head", condition="TRUE")
        printer.body(routine.body, again)
        if again:
            printer.depth += 1
            printer.line("WAIT")
            printer.depth -= 1
            printer.line("END")
        self.handlers(routine)
        lines = [
            *remarks.lines,
            *_declarations(initial, printer.notes.autos, printer.first),
            *values_first,
            *printer.lines,
        ]
        return ProgramText(_head(routine), tuple(lines)), first

    def own_data(self, routine: ir.Routine, printer: Printer) -> list[tuple[str, str]]:
        """(AUTO or LOCAL, name) of each variable; their first values are printed."""
        found: list[tuple[str, str]] = []
        for declaration in routine.declarations:
            try:
                if isinstance(declaration, ir.Variable):
                    word = "LOCAL" if declaration.storage == "persistent" else "AUTO"
                    found.append((word, declared(declaration, printer.expressions)))
                    printer.comments_only(declaration.origin)
                    if word == "LOCAL" and declaration.initial is not None:
                        self.first_time(declaration, printer)
                    else:
                        given = values(declaration) or filled(declaration, routine)
                        if not given and word == "AUTO" and self.output.facts.foreign:
                            given = _never_set(declaration, self.assigned)
                        for place, _, value in given:
                            printer.line(printer.actions.stored(place, value))
                elif isinstance(declaration, ir.Unread) and declaration.text:
                    raise CannotSayError(f"it was not read ({declaration.text.strip()[:40]})")
                else:
                    printer.comments_only(declaration.origin)
            except CannotSayError as error:
                self.lost(declaration, printer, str(error))
            else:
                self.ledger.written(declaration)
        return found

    def first_time(self, variable: ir.Variable, printer: Printer) -> None:
        """The first value of a variable that keeps its value between calls."""
        places = values(variable)
        asked = printer.expressions.text(places[0][0])
        printer.put("if_head", condition=f"NOT DEFINED({asked})")
        printer.depth += 1
        for place, _, value in places:
            printer.line(printer.actions.stored(place, value))
        printer.depth -= 1
        printer.line("END")

    def opening(self, routine: ir.Routine, printer: Printer) -> None:
        """What a program that is started does first: its speed, the tasks beside it."""
        if routine.name.lower() in self.background:
            return
        usual = self.output.facts.usual
        if usual is not None:
            printer.line(f"SPEED {spelling.number(usual, 4)} ALWAYS")
        for name in self.background:
            number = self.output.tasks.get(name)
            if number is not None:
                printer.line(f"EXECUTE {number} {name}()")

    def handlers(self, routine: ir.Routine) -> None:
        """What a program has no place for. The passes before carry over what they can."""
        if self.ledger.handlers_reported(routine):
            self.diagnostics.report(LOST_HANDLER, routine.origin, name=routine.name)


def _never_set(variable: ir.Variable, assigned: set[str]) -> list[tuple[ir.Expression, ir.Type, ir.Expression]]:
    """A variable that nothing is stored into has the source's value of no value: zero."""
    zero = _ZEROS.get(variable.type.__class__) if variable.name.lower() not in assigned else None
    if zero is None and isinstance(variable.type, ir.PoseType | ir.TargetType):
        zero = ir.System("null_frame") if variable.name.lower() not in assigned else None
    return [] if zero is None else [(ir.Name(variable.name), variable.type, zero)]


def _head(routine: ir.Routine) -> str:
    names = []
    for parameter in routine.parameters:
        name = spelling.spelled(parameter.name, parameter.type)
        if isinstance(parameter.type, ir.ArrayType):
            name += f"[{',' * (len(parameter.type.dimensions) - 1)}]"
        names.append(name)
    return f".PROGRAM {routine.name.lower()}({', '.join(names)})"


def _declarations(found: list[tuple[str, str]], autos: list[str], indent: str) -> list[str]:
    """AUTO and LOCAL lines, as many names in each as fit."""
    lines = []
    for word, names in (
        ("AUTO", [*(name for kind, name in found if kind == "AUTO"), *autos]),
        ("LOCAL", [name for kind, name in found if kind == "LOCAL"]),
    ):
        line = ""
        for name in names:
            if line and len(line) + len(name) + 2 > tables.LONGEST_LINE:
                lines.append(line)
                line = ""
            line = f"{line}, {name}" if line else f"{indent}{word} {name}"
        if line:
            lines.append(line)
    return lines


__all__ = ["write"]
