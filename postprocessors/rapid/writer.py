"""Write a program as RAPID modules: one file per module, data before routines, checked by the emission ledger."""

from __future__ import annotations

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.passes.scope import ProgramScope
from rpl.source import Origin
from rpl.writing.ledger import EmissionLedger
from rpl.writing.statements import CannotSayError
from rpl.writing.target import OutputFile, WriteContext
from rpl.writing.templates import TemplateError, macros_of

from .expressions import LONGEST_TEXT, Expressions
from .statements import NOT_SAID, Layout, Statements
from .types import heading, record, type_name, variable

CUT_TEXT = code("text-cut", Severity.WARNING, "a text of {length} characters is cut to {limit}")
_HEADER = ("%VERSION", "%LANGUAGE")
_ATTRIBUTES = ("SYSMODULE", "NOSTEPIN", "VIEWONLY", "READONLY", "NOVIEW")


def write(program: ir.Program, context: WriteContext) -> list[OutputFile]:
    """All modules of the program as files. Raises InternalError when a node was neither written nor reported."""
    ledger = EmissionLedger()
    scopes = ProgramScope(program)
    header = context.options.get("header", "").lower() in ("yes", "true", "1")
    files = []
    layout = Layout(macros_of(__package__, context.templates))
    background = {task.name for task in program.tasks if task.kind == "background"}
    for module in program.modules:
        beside = module.task != "" and module.task in background
        writer = _ModuleWriter(module, scopes, context.diagnostics, ledger, layout, beside, context.foreign)
        text = writer.text(header)
        suffix = ".sys" if any(name == "SYSMODULE" for name, _ in module.attributes) else ".mod"
        folder = f"{module.task}/" if module.task else ""
        files.append(OutputFile(f"{folder}{module.name}{suffix}", _encoded(text)))
    ledger.check(program)
    return files


def _encoded(text: str) -> bytes:
    """ISO 8859-1 is what controllers read; text beyond it needs a newer one and UTF-8."""
    try:
        return text.encode("latin-1")
    except UnicodeEncodeError:
        return text.encode("utf-8")


class _ModuleWriter:
    def __init__(
        self,
        module: ir.Module,
        scopes: ProgramScope,
        diagnostics: Diagnostics,
        ledger: EmissionLedger,
        layout: Layout,
        beside: bool,
        foreign: bool,
    ) -> None:
        self.layout, self.say = layout, layout.macros
        self.module, self.scopes, self.beside, self.foreign = module, scopes, beside, foreign
        self.diagnostics, self.ledger = diagnostics, ledger

    def text(self, header: bool) -> str:
        module = self.module
        self.ledger.written(module)
        expressions = Expressions(self.scopes.module(module), beside=self.beside, foreign=self.foreign)
        declarations: list[str] = []
        for declaration in _ordered(module.declarations):
            declarations.extend(self.declaration(declaration, expressions))
        self.long_texts(expressions, module.origin)
        attributes = [name for name, _ in module.attributes if name in _ATTRIBUTES]
        text = self.say(
            "module",
            header=header or any(name in _HEADER for name, _ in module.attributes),
            remarks=self.layout.remarks(module.origin),
            behind=self.layout.behind(module.origin),
            name=module.name,
            attributes=attributes,
            declarations=[f"{self.layout.step}{line}" for line in declarations],
            routines=[self.layout.indented(self.routine(routine)) for routine in module.routines],
        )
        return f"{text}\n"

    def declaration(self, declaration: ir.Declaration, expressions: Expressions) -> list[str]:
        """The lines of a declaration with its comments; as comment lines when RAPID cannot say it."""
        try:
            lines = self.declared(declaration, expressions)
        except CannotSayError as reason:
            self.ledger.reported(declaration)
            self.diagnostics.report(NOT_SAID, declaration.origin, reason=str(reason))
            original = declaration.origin.text or getattr(declaration, "text", "") or repr(declaration)
            return self.lost(declaration.origin, reason, original)
        except TemplateError as error:
            raise error.at(declaration.origin) from None
        self.ledger.written(declaration)
        behind = self.layout.behind(declaration.origin)
        if lines:
            lines[0] += behind
        elif behind:
            lines = [behind.strip()]
        return [*self.layout.remarks(declaration.origin), *lines]

    def lost(self, origin: Origin, reason: CannotSayError, original: str) -> list[str]:
        shown = [line.strip() for line in original.splitlines()]
        return [*self.layout.remarks(origin), *self.say.lines("lost", reason=reason, original=shown)]

    def declared(self, declaration: ir.Declaration, expressions: Expressions) -> list[str]:
        match declaration:
            case ir.Variable():
                return self.say.lines("variable", **variable(declaration, expressions))
            case ir.RecordDeclaration():
                return self.say.lines("record", **record(declaration, expressions))
            case ir.AliasDeclaration(name=name, type=type, scope=scope):
                return self.say.lines("alias", local=scope == "module", type=type_name(type), name=name)
            case ir.Unread(text=""):
                return []
            case ir.Unread():
                raise CannotSayError("it could not be read")
            case ir.ExternalDeclaration(text=text):
                return self.say.lines("external", lines=[line.strip() for line in text.splitlines()])
        raise CannotSayError(f"there is no {declaration.__class__.__name__}")

    def routine(self, routine: ir.Routine) -> list[str]:
        expressions = Expressions(self.scopes.routine(self.module, routine), beside=self.beside, foreign=self.foreign)
        layout, origin = self.layout, routine.origin
        statements = Statements(expressions, self.diagnostics, self.ledger, layout)
        try:
            head = heading(routine, expressions)
        except CannotSayError as reason:
            self.ledger.reported(routine)
            self.diagnostics.report(NOT_SAID, origin, reason=str(reason))
            return self.lost(origin, reason, origin.text or routine.name)
        self.ledger.written(routine)
        lines: list[str] = []
        for declaration in _ordered(routine.declarations):
            lines.extend(self.declaration(declaration, expressions))
        lines.extend(statements.body(routine.body))
        handlers = []
        for handler in routine.handlers:
            codes = f" ({expressions.list(handler.codes)})" if handler.codes else ""
            remarks = [f"{layout.step}{line}" for line in layout.remarks(handler.origin)]
            lines_of = statements.inner(handler.body)
            handlers.append((f"ERROR{codes}", "\n".join((*remarks, lines_of)) if remarks else lines_of))
        for word, body in (("UNDO", routine.undo), ("BACKWARD", routine.backward)):
            if body:
                handlers.append((word, statements.inner(body)))
        self.long_texts(expressions, origin)
        return self.say.lines(
            "routine",
            remarks=layout.remarks(origin),
            heading=self.say("heading", **head),
            behind=layout.behind(origin),
            body=layout.indented(lines),
            handlers=handlers,
            ending=f"END{head['kind']}",
        )

    def long_texts(self, expressions: Expressions, origin: Origin) -> None:
        for text in expressions.long_texts:
            self.diagnostics.report(CUT_TEXT, origin, length=len(text), limit=LONGEST_TEXT)


def _ordered(declarations: tuple[ir.Declaration, ...]) -> list[ir.Declaration]:
    """Type definitions come before data on the controller; otherwise the order stays."""
    kinds = (ir.RecordDeclaration, ir.AliasDeclaration)
    seen_data = False
    for declaration in declarations:
        if isinstance(declaration, ir.Variable):
            seen_data = True
        elif isinstance(declaration, kinds) and seen_data:
            types = [one for one in declarations if isinstance(one, kinds)]
            return [*types, *(one for one in declarations if not isinstance(one, kinds))]
    return list(declarations)
