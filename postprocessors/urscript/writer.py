"""A program as scripts: one `def` with its data, the functions it brings along, its routines, its threads, its body."""

from __future__ import annotations

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.scope import ProgramScope, Scope
from rpl.writing.ledger import EmissionLedger
from rpl.writing.statements import CannotSayError
from rpl.writing.target import OutputFile, WriteContext
from rpl.writing.templates import macros_of

from .declarations import first_value, header
from .facts.programs import called_names, names_of, not_reached, programs, started
from .facts.standing import Standing
from .facts.uses import Uses
from .helpers import HELPERS
from .namespace import one_namespace
from .statements import INDENT, Output, Printer

LOST_DECLARATION = code(
    "urscript-lost-declaration", Severity.LOSS, "URScript cannot declare {name}: {reason}", "it is left as a comment"
)
LOST_HANDLER = code(
    "urscript-lost-handler", Severity.LOSS, "URScript has no error handlers; the one of {name} is left out"
)
SEVERAL = code(
    "urscript-several-programs",
    Severity.INFO,
    "{count} routines can be started; each is written as a script of its own",
)


def write(program: ir.Program, context: WriteContext) -> list[OutputFile]:
    """One script for each routine that can be started (usually one). Raises InternalError when the ledger finds a node
    that nobody accounted for."""
    starts: list[ir.Routine | None] = list(programs(program)) or [None]
    if len(starts) > 1:
        context.diagnostics.report(SEVERAL, program.modules[0].origin, count=len(starts))
    files = []
    for start in starts:
        others = not_reached(program, [one for one in starts if one is not start and one is not None])
        files.append(_Script(program, start, others, context).file())
    return files


class _Script:
    """One script. `others`: routines that only other scripts need."""

    def __init__(
        self, program: ir.Program, start: ir.Routine | None, others: list[ir.Routine], context: WriteContext
    ) -> None:
        self.ledger = EmissionLedger()
        self.program, self.start = one_namespace(_without(program, others), start)
        self.scopes = ProgramScope(self.program)
        self.diagnostics = context.diagnostics
        taken = names_of(self.program) | set(HELPERS.texts)
        self.say, standing = macros_of(__package__, context.templates), Standing(self.program)
        uses = Uses.of(self.program)
        self.output = Output(self.ledger, context.diagnostics, context.robot, taken, standing, self.say, uses)
        called = called_names(self.program)
        self.is_body = self.start is not None and self.start.name.lower() not in called
        self.tasks = {task.entry.lower(): task for task in self.program.tasks if task.kind == "background"}
        self.started = started(self.program)

    def file(self) -> OutputFile:
        name = self.name()
        remarks = Printer(self.scopes.module(self.program.modules[0]), self.output, depth=0)
        for module in self.program.modules:
            self.ledger.written(module)
            remarks.comments_only(module.origin)
        data = self.data()
        routines = [
            self.routine(module, routine)
            for module in self.program.modules
            for routine in module.routines
            if not (self.is_body and routine is self.start)
        ]
        body = self.body()
        threads = [_indented(lines) for lines in self.output.threads]
        helpers = [_indented(HELPERS.texts[one]) for one in HELPERS.needed(self.output.notes.helpers)]
        parts = [part for part in (data, *helpers, *routines, *threads, body) if part]
        text = self.say("script", before=remarks.lines, name=name, parts=parts) + "\n"
        self.ledger.check(self.program)
        return OutputFile(f"{name}.script", text.encode("ascii", "replace"))

    def name(self) -> str:
        """The script's name: the routine's, or another where that routine is called too."""
        if self.start is None:
            return self.program.modules[0].name
        return self.start.name if self.is_body else self.output.fresh(f"{self.start.name}_program")

    # ---- data

    def data(self) -> list[str]:
        """Global data; what another one's first value mentions stands before it."""
        found = [(module, one) for module in self.program.modules for one in module.declarations]
        lines: list[str] = []
        for module, declaration in _ordered(found):
            printer = Printer(self.scopes.module(module), self.output, depth=1)
            self.declaration(declaration, printer, "global")
            lines.extend(printer.lines)
        return lines

    def declaration(self, declaration: ir.Declaration, printer: Printer, word: str) -> None:
        origin = declaration.origin
        try:
            match declaration:
                case ir.Variable(name=name, type=ir.ClockType()):
                    if word != "global":
                        raise CannotSayError("a stop watch of a routine")
                    seconds, runs = self.output.watch(name)
                    printer.line(f"global {seconds}", origin)
                    printer.more(f"global {runs}")
                case ir.Variable(type=ir.VendorType(dialect="urscript"), initial=None):
                    printer.comments_only(origin)  # a handle is what the call gives that makes it
                case ir.Variable(name=name) if name.lower() in self.output.uses.unasked:
                    printer.comments_only(origin)
                case ir.Variable():
                    value = first_value(declaration, printer.expressions)
                    printer.line(self.say("variable", where=word, name=declaration.name, value=value), origin)
                case ir.RecordDeclaration() | ir.ExternalDeclaration() | ir.Unread(text=""):
                    printer.comments_only(origin)  # a structure is what its values show
                case ir.SignalDeclaration(name=name, signal=signal):
                    printer.line(self.say("signal", name=name, signal=printer.expressions.text(signal)), origin)
                case ir.Initialise(assign=assign):
                    printer.line(self.say("assign", text=printer.actions.assignment(assign)), origin)
                case ir.Unread(text=text):
                    raise CannotSayError(f"it was not read ({text.strip()[:40]})")
                case _:
                    raise CannotSayError(f"there is no {declaration.__class__.__name__}")
        except CannotSayError as error:
            self.lost(declaration, printer, str(error))
        else:
            self.ledger.written(declaration)

    def lost(self, declaration: ir.Declaration, printer: Printer, reason: str) -> None:
        name = str(getattr(declaration, "name", "this"))
        printer.comments_only(declaration.origin)
        printer.remark(declaration.origin.text or name)
        self.diagnostics.report(LOST_DECLARATION, declaration.origin, name=name, reason=reason)
        self.ledger.reported(declaration)

    # ---- routines

    def routine(self, module: ir.Module, routine: ir.Routine) -> list[str]:
        """A routine as a def, or as the thread of a task."""
        scope = self.scopes.routine(module, routine)
        printer = Printer(scope, self.output, depth=1)
        printer.comments_only(routine.origin)
        task = self.tasks.get(routine.name.lower())
        thread = task is not None or routine.name.lower() in self.started
        try:
            head = header(routine)
            if thread and routine.parameters:
                raise CannotSayError("a thread takes no arguments")
        except CannotSayError as error:
            self.diagnostics.report(LOST_DECLARATION, routine.origin, name=routine.name, reason=str(error))
            self.ledger.reported(routine)
            names = ", ".join(parameter.name for parameter in routine.parameters)
            printer.line(self.say("heading", kind="def", name=routine.name, parameters=names))
            printer.depth += 1
            printer.more(*self.say.lines("remark", text=str(error)))
            printer.stop()
            printer.depth -= 1
            printer.word("end")
            return printer.lines
        self.ledger.written(routine)
        printer.line(self.say("heading", kind="thread" if thread else "def", **head))
        again = task is not None and task.cyclic
        printer.depth += 1
        self.own_data(routine, printer, "local", scope)
        if again:
            printer.line(self.say("while_head", condition="True"))
            printer.depth += 1
        printer.depth -= 1
        printer.body(routine.body)
        printer.depth = 2
        if again:
            printer.more(f"{INDENT}sync()", self.say("word", text="end"))
        printer.depth = 1
        printer.word("end")
        self.handlers(routine)
        return printer.lines

    def own_data(self, routine: ir.Routine, printer: Printer, word: str, scope: Scope) -> None:
        for declaration in routine.declarations:
            self.declaration(declaration, printer, word)

    def body(self) -> list[str]:
        """What the script does: start the tasks beside it, then the statements of the routine it starts with."""
        first = self.program.modules[0]
        start = self.start
        if start is None:
            return self.begun()
        if not self.is_body:
            return [*self.begun(), f"{INDENT}{start.name}()"]
        module = next((one for one in self.program.modules if any(r is start for r in one.routines)), first)
        printer = Printer(self.scopes.routine(module, start), self.output, inside=False, depth=1)
        self.ledger.written(start)
        printer.comments_only(start.origin)
        self.own_data(start, printer, "global", printer.scope)
        printer.lines.extend(self.begun())  # also the watches among its own data
        printer.depth = 0
        printer.body(start.body)
        self.handlers(start)
        return printer.lines

    def begun(self) -> list[str]:
        """The threads that run from the beginning."""
        busy = (*(task.entry for task in self.tasks.values()), *self.output.counting)
        return [f"{INDENT}run {name}()" for name in busy]

    def handlers(self, routine: ir.Routine) -> None:
        """What a routine has no place for. The passes before carry over what they can."""
        if self.ledger.handlers_reported(routine):
            self.diagnostics.report(LOST_HANDLER, routine.origin, name=routine.name)


def _without(program: ir.Program, routines: list[ir.Routine]) -> ir.Program:
    from dataclasses import replace

    if not routines:
        return program
    gone = {id(one) for one in routines}
    modules = tuple(
        replace(module, routines=tuple(one for one in module.routines if id(one) not in gone))
        for module in program.modules
    )
    return replace(program, modules=modules)


def _indented(lines: tuple[str, ...]) -> list[str]:
    return [f"{INDENT}{line}" for line in lines]


Datum = tuple[ir.Module, ir.Declaration]


def _ordered(data: list[Datum]) -> list[Datum]:
    """Each behind those that its first value mentions, otherwise as they stand."""
    by_name = {one.name: (module, one) for module, one in data if isinstance(one, ir.Variable)}
    done: list[Datum] = []
    seen: set[int] = set()

    def add(datum: Datum) -> None:
        declaration = datum[1]
        if id(declaration) in seen:
            return
        seen.add(id(declaration))
        if isinstance(declaration, ir.Variable) and declaration.initial is not None:
            for node in walk(declaration.initial):
                if isinstance(node, ir.Name) and node.id in by_name:
                    add(by_name[node.id])
        done.append(datum)

    for datum in data:
        add(datum)
    return done
