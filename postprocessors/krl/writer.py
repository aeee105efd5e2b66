"""A program in KRL's terms to `.src`, `.sub` and `.dat` files. Templates give the frame, the printers the lines."""

from __future__ import annotations

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.scope import ProgramScope, Scope
from rpl.writing.ledger import EmissionLedger
from rpl.writing.statements import CannotSayError
from rpl.writing.target import OutputFile, WriteContext
from rpl.writing.templates import Macros, macros_of

from . import tables
from .declarations import (
    everywhere,
    first_values,
    heading_words,
    parameter_words,
    record_words,
    signal_words,
    variable_words,
)
from .settings import assigned
from .statements import Printer

LOST_DECLARATION = code(
    "krl-lost-declaration", Severity.LOSS, "KRL cannot declare {name}: {reason}", "it is left as a comment"
)
LOST_HANDLER = code("krl-lost-handler", Severity.LOSS, "KRL has no error handlers; the one of {name} is left out", "")

_TABLES = "For the tables of the controller's own $config.dat"
_HEADS = ("ACCESS RVP", "REL 1")
_KRL_FILES = (".src", ".dat", ".sub")


def write(program: ir.Program, context: WriteContext) -> list[OutputFile]:
    """All files of a program. Raises InternalError when the ledger finds a node that nobody accounted for."""
    ledger = EmissionLedger()
    scopes = ProgramScope(program)
    background = {name for task in program.tasks if task.kind == "background" for name in task.modules}
    files: list[OutputFile] = []
    macros = macros_of(__package__, context.templates)
    for module in program.modules:
        files.extend(_Module(module, scopes, ledger, context, macros, module.name in background).files())
    ledger.check(program)
    return files


class _Module:
    def __init__(
        self,
        module: ir.Module,
        scopes: ProgramScope,
        ledger: EmissionLedger,
        context: WriteContext,
        macros: Macros,
        background: bool,
    ) -> None:
        self.module, self.scopes, self.ledger, self.background = module, scopes, ledger, background
        self.diagnostics, self.say = context.diagnostics, macros
        self.frames = context.register_names if context.foreign else None
        self.is_config = module.name.lower() == tables.CONFIG
        self.scope = scopes.module(module)

    def files(self) -> list[OutputFile]:
        """The program file and, where there is anything to put into it, the data list."""
        module = self.module
        self.ledger.written(module)
        found = []
        program, data = self.attributes()
        if module.routines and self.has_forms():  # the pendant asks for the rights to open them
            program, data = program or list(_HEADS), data or list(_HEADS)
        lines = self.data_lines()
        if module.routines:
            fits = self.named_after_module()
            routines = [self.routine(routine, fits and index == 0) for index, routine in enumerate(self.ordered())]
            if not fits:
                heading = self.say("heading", everywhere=False, returns="", name=module.name, parameters="")
                routines.insert(0, self.say("routine", before=(), heading=heading, lines=(), foot="END"))
            suffix = "sub" if self.background else "src"
            text = self.say("program", attributes=program, routines=routines)
            found.append(_file(f"{module.name}.{suffix}", text))
        if lines or data or not module.routines:
            seen = not self.is_config  # its data are seen everywhere without the word
            public = module.public or any(
                seen and getattr(declaration, "scope", "") in ("task", "global") for declaration in module.declarations
            )
            text = self.say("data", attributes=data, name=module.name, public=public, lines=lines)
            found.append(_file(f"{module.name}.dat", text))
        return found

    def has_forms(self) -> bool:
        """Has the data list any data of inline forms, of a program from another language?"""
        types = (one.type for one in self.module.declarations if isinstance(one, ir.Variable))
        named = (one.name.upper() for one in types if isinstance(one, ir.NamedType))
        return self.frames is not None and not self.is_config and any(name in tables.FORM_TYPES for name in named)

    def attributes(self) -> tuple[list[str], list[str]]:
        """File attributes of the program and of the data list; other languages' attributes have no place here, though
        some are called the same (`///USER` of a job is a user frame)."""
        program: list[str] = []
        data: list[str] = []
        source = self.module.origin.source
        foreign = source is not None and not source.path.lower().endswith((*_KRL_FILES, ".rpl"))
        for name, value in self.module.attributes:
            of_data, bare = name.startswith("dat "), name.removeprefix("dat ")
            if bare.upper() in tables.ATTRIBUTES and (not foreign or bare.upper() == "COMMENT"):
                (data if of_data else program).append(f"{bare} {value}".rstrip())
        return program, data

    def ordered(self) -> list[ir.Routine]:
        """The routine that is named like the file, or one that others may call, stands first."""
        routines = list(self.module.routines)
        first = next((r for r in routines if r.name.lower() == self.module.name.lower()), None)
        if first is not None:
            routines.remove(first)
            routines.insert(0, first)
        return routines

    def named_after_module(self) -> bool:
        """A controller wants the first routine named like its file. A KRL file that breaks this stays as it was."""
        source = self.module.origin.source
        if source is not None and source.path.lower().endswith(_KRL_FILES):
            return True
        return any(routine.name.lower() == self.module.name.lower() for routine in self.module.routines)

    def printer(self, scope: Scope) -> Printer:
        return Printer(scope, self.ledger, self.diagnostics, self.say, self.frames)

    # ---- data list

    def data_lines(self) -> list[str]:
        printer = self.printer(self.scope)
        if self.is_config and self.module.origin.source is None:
            printer.lines.extend(self.say.lines("remark", text=_TABLES))
        for declaration in self.module.declarations:
            self.declaration(declaration, printer, self.scope, in_data=True)
        return printer.lines

    def declaration(self, declaration: ir.Declaration, printer: Printer, scope: Scope, in_data: bool) -> None:
        origin, say = declaration.origin, self.say
        try:
            match declaration:
                case ir.Variable(name=name) if self.is_config and name.lower() in tables.OWN:
                    pass  # the controller declares it
                case ir.Variable():
                    values = first_values(declaration, scope, in_data)
                    printer.line(say("variable", **variable_words(declaration, scope, in_data)), origin)
                    for value in values if in_data else ():
                        printer.line(say("assign", **assigned(value, printer.expressions)))
                case ir.RecordDeclaration():
                    printer.line(say("record", **record_words(declaration, scope)), origin)
                case ir.EnumDeclaration(name=name, members=members):
                    seen = everywhere(declaration.scope)
                    printer.line(say("enumeration", everywhere=seen, name=name, members=members), origin)
                case ir.SignalDeclaration():
                    printer.line(say("signal", **signal_words(declaration, scope)), origin)
                case ir.ExternalDeclaration(text=text):
                    printer.line(text, origin)
                case ir.Initialise(assign=assign):
                    printer.line(say("assign", **assigned(assign, printer.expressions)), origin)
                case ir.Unread(text=""):
                    printer.comments_only(origin)
                case ir.Unread(text=text):
                    raise CannotSayError(f"it was not read ({text.strip()[:40]})")
                case ir.AliasDeclaration():
                    raise CannotSayError("there are no second names for types")
        except CannotSayError as error:
            self.lost(declaration, printer, str(error))
        else:
            self.ledger.written(declaration)

    def lost(self, declaration: ir.Declaration, printer: Printer, reason: str) -> None:
        printer.comments_only(declaration.origin)
        name = getattr(declaration, "name", "this")
        printer.lines.extend(self.commented(declaration.origin.text or str(name)))
        self.diagnostics.report(LOST_DECLARATION, declaration.origin, name=name, reason=reason)
        self.ledger.reported(declaration)

    def commented(self, original: str) -> list[str]:
        return [line for part in original.splitlines() for line in self.say.lines("remark", text=part.strip())]

    # ---- routines

    def routine(self, routine: ir.Routine, first: bool) -> str:
        scope = self.scopes.routine(self.module, routine)
        printer, before = self.printer(scope), self.printer(scope)
        before.comments_only(routine.origin)
        foot = "END" if routine.returns is None else "ENDFCT"
        try:
            heading = self.say("heading", **heading_words(routine, scope, first))
            for parameter in routine.parameters:
                printer.line(self.say("parameter", **parameter_words(parameter, scope)))
        except CannotSayError as error:
            self.diagnostics.report(LOST_DECLARATION, routine.origin, name=routine.name, reason=str(error))
            self.ledger.reported(routine)
            lines = [*before.lines, *self.commented(routine.origin.text)]
            heading = self.say("heading", everywhere=False, returns="", name=routine.name, parameters="")
            stop = self.say.lines("stop")
            return self.say("routine", before=lines, heading=heading, lines=stop, foot="END")
        self.ledger.written(routine)
        for declaration in routine.declarations:
            self.declaration(declaration, printer, scope, in_data=False)
        self.initial_values(routine, printer)
        printer.depth = -1
        printer.body(routine.body)
        self.handlers(routine)
        return self.say("routine", before=before.lines, heading=heading, lines=printer.lines, foot=foot)

    def initial_values(self, routine: ir.Routine, printer: Printer) -> None:
        """A routine's variables are declared bare; their first values are assignments."""
        for declaration in routine.declarations:
            if not isinstance(declaration, ir.Variable):
                continue
            try:
                for value in first_values(declaration, self.scope, in_data=False):
                    printer.line(self.say("assign", **assigned(value, printer.expressions)))
            except CannotSayError as error:
                self.diagnostics.report(LOST_DECLARATION, declaration.origin, name=declaration.name, reason=str(error))
                printer.stop()

    def handlers(self, routine: ir.Routine) -> None:
        """What a KRL routine has no place for. The passes before carry over what they can."""
        if self.ledger.handlers_reported(routine):
            self.diagnostics.report(LOST_HANDLER, routine.origin, name=routine.name)


def _file(path: str, text: str) -> OutputFile:
    """Controllers read 8-bit text with CR LF; what that cannot hold is written as UTF-8."""
    text = "\r\n".join(line.rstrip() for line in text.splitlines()) + "\r\n"
    try:
        return OutputFile(path, text.encode("cp1252"))
    except UnicodeEncodeError:
        return OutputFile(path, text.encode("utf-8"))
