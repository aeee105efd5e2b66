"""Write a program as a VAL3 application: a project, its data, and a file for each program."""

from __future__ import annotations

from itertools import product

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, statements
from rpl.passes import rigid
from rpl.passes.fold import constant, constant_number
from rpl.passes.scope import ProgramScope, Scope
from rpl.writing.ledger import EmissionLedger
from rpl.writing.statements import CannotSayError
from rpl.writing.target import OutputFile, WriteContext
from rpl.writing.templates import macros_of
from rpl.writing.text import number_text

from . import tables
from .data import Datum, Store
from .expressions import NULL, Expressions, point_row, pose_row
from .facts.names import names_of
from .facts.roles import entry_of, fathers_of, roles_of
from .statements import Statements, indented

UNLINKED = code(
    "val3-signals-not-linked",
    Severity.WARNING,
    "{names}: declared without a terminal, which a program of another controller does not know; without a link the "
    "controller refuses to use one",
    "link each to its terminal in the controller's list of inputs and outputs before the program runs",
)
LOST = code("val3-lost-declaration", Severity.LOSS, "VAL3 cannot declare {name}: {reason}", "what uses it will not run")
_MOST_DIMENSIONS = 3
_ENTRY, _END = "start", "stop"
_ATTRIBUTE_SIGNS = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "\n": " "})


def write(program: ir.Program, context: WriteContext) -> list[OutputFile]:
    """All files of the application. Raises InternalError when a node was neither written nor reported."""
    return _Application(program, context).files()


class _Application:
    def __init__(self, program: ir.Program, context: WriteContext) -> None:
        self.program, self.diagnostics = program, context.diagnostics
        self.say = macros_of(__package__, context.templates)
        self.ledger = EmissionLedger()
        self.scopes = ProgramScope(program)
        self.roles = roles_of(program)
        self.fathers = fathers_of(program, self.roles)
        self.store = Store(names_of(program))
        self.entry = entry_of(program)
        self.first: list[tuple[ir.Initialise, Expressions]] = []  # values that the data are given at the start

    def files(self) -> list[OutputFile]:
        for module in self.program.modules:
            self.ledger.written(module)
            expressions = self.expressions(self.scopes.module(module))
            for declaration in module.declarations:
                self.declaration(declaration, expressions)
        for datum in self.store.data.values():
            if datum.father.partition("[")[0] not in ("", "world", "flange", *self.store.data):
                datum.father = "world"  # no movement to it is written
        programs: dict[str, str] = {}
        for module in self.program.modules:
            for routine in module.routines:
                self.told_parameters(module, routine)
        for module in self.program.modules:
            for routine in module.routines:
                programs[routine.name] = self.routine(module, routine)
        if _ENTRY not in programs:
            calls = [f"{self.say('step')}call {self.entry}()"] if self.entry else []
            programs[_ENTRY] = self.say("program", name=_ENTRY, parameters=[], locals=[], lines=calls)
        if self.store.unlinked:
            names = ", ".join(self.store.unlinked)
            self.diagnostics.report(UNLINKED, self.program.modules[0].origin, names=names)
        programs.setdefault(_END, self.say("program", name=_END, parameters=[], locals=[], lines=[]))
        self.ledger.check(self.program)
        name = self.program.modules[0].name if self.program.modules else "application"
        rows = [(one.name, one.type, one.count, one.rows) for _, one in sorted(self.store.data.items())]
        files = {f"{own}.pgx": text for own, text in programs.items()}
        files[f"{name}.dtx"] = self.say("data", data=rows)
        files[f"{name}.pjx"] = self.say("project", name=name, programs=sorted(programs))
        return [OutputFile(path, (text + "\n").encode("utf-8-sig")) for path, text in sorted(files.items())]

    def expressions(self, scope: Scope) -> Expressions:
        return Expressions(scope, self.store, self.roles, self.fathers)

    # ---- data

    def declaration(self, declaration: ir.Declaration, expressions: Expressions) -> None:
        try:
            match declaration:
                case ir.Variable():
                    self.store.add(self.datum(declaration, expressions))
                case ir.SignalDeclaration(name=name, signal=signal):
                    expressions.text(signal)
                case ir.Initialise():
                    self.first.append((declaration, expressions))
                    return
                case ir.Unread(text="") | ir.ExternalDeclaration():
                    pass
                case _:
                    raise CannotSayError(f"there is no {declaration.__class__.__name__}")
        except CannotSayError as error:
            name = str(getattr(declaration, "name", "this"))
            self.store.lost.add(name)
            self.ledger.reported(declaration)
            self.diagnostics.report(LOST, declaration.origin, name=name, reason=str(error))
        else:
            self.ledger.written(declaration)

    def datum(self, variable: ir.Variable, expressions: Expressions) -> Datum:
        scope = expressions.scope
        type, sizes = _element(scope.resolve(variable.type), scope)
        word = self.roles.get(variable.name) or tables.TYPES.get(type.__class__.__name__)
        if word is None:
            raise CannotSayError(f"there is no type {type.__class__.__name__}")
        father = ""
        if word in ("frame", "tool"):
            father = "world" if word == "frame" else "flange"
        elif word == "pointRx":
            father = self.fathers.get(variable.name, "world")
        is_list = isinstance(scope.resolve(variable.type), ir.ArrayType)
        values = _elements(variable.initial, sizes) if is_list else [variable.initial]
        rows = [self.row(type, value, scope) for value in values]
        return Datum(variable.name, word, rows if any(rows) else [], sizes, father)

    def row(self, type: ir.Type, value: ir.Expression | None, scope: Scope) -> str:
        """The attributes of one element."""
        match type:
            case ir.IntType() | ir.RealType():
                number = 0.0 if value is None else constant_number(value, scope)
                if number is None:
                    raise CannotSayError("a first value that is worked out")
                return f'value="{number_text(number, None, tables.NUMBERS)}"'
            case ir.BoolType():
                if value is not None and not isinstance(value, ir.BoolLiteral):
                    raise CannotSayError("a first value that is worked out")
                return f'value="{"true" if value == ir.BoolLiteral(True) else "false"}"'
            case ir.StringType():
                if value is not None and not isinstance(value, ir.TextLiteral):
                    raise CannotSayError("a first value that is worked out")
                return f'value="{(value.value if value is not None else "").translate(_ATTRIBUTE_SIGNS)}"'
            case ir.TargetType() if isinstance(value, ir.Aggregate):
                return point_row(value, scope)
            case ir.JointsType() if isinstance(value, ir.Aggregate):
                numbers = {name: constant_number(part, scope) for name, part in value.entries}
                if None in numbers.values():
                    raise CannotSayError("a first value that is worked out")
                given = [(name, numbers.get(name) or 0.0) for name in tables.JOINTS]
                return " ".join(f'{name}="{number_text(number, 10, tables.NUMBERS)}"' for name, number in given)
        if value is None or value == NULL:
            return ""
        known = constant(value, scope)
        if isinstance(known, rigid.Pose):
            return pose_row(known)
        raise CannotSayError("a first value that is worked out")

    # ---- programs

    def told_parameters(self, module: ir.Module, routine: ir.Routine) -> None:
        """A routine with a parameter that cannot be declared is not written: its calls stop."""
        scope = self.scopes.routine(module, routine)
        try:
            for one in routine.parameters:
                self.parameter(one, scope)
        except CannotSayError as error:
            self.store.unwritten.add(routine.name)
            self.diagnostics.report(LOST, routine.origin, name=routine.name, reason=str(error))

    def stopped_routine(self, routine: ir.Routine) -> str:
        """In place of a routine that cannot be declared: the stop alone, for who starts it by hand."""
        self.ledger.written(routine)
        for declaration in routine.declarations:
            self.ledger.reported(declaration)
        for statement in statements(*bodies(routine)):
            self.ledger.reported(statement)
        lines = self.say.lines("guarded", original=[f"{routine.name} is not written"])
        return self.say("program", name=routine.name, parameters=[], locals=[], lines=indented(lines, self.say("step")))

    def routine(self, module: ir.Module, routine: ir.Routine) -> str:
        if routine.name in self.store.unwritten:
            return self.stopped_routine(routine)
        scope = self.scopes.routine(module, routine)
        expressions = self.expressions(scope)
        statements = Statements(expressions, self.diagnostics, self.ledger, self.say)
        self.ledger.written(routine)
        lines = statements.remarks(routine.origin)
        locals_: list[tuple[str, str, str]] = []
        lost: set[str] = set()
        for declaration in routine.declarations:
            try:
                lines.extend(self.local(declaration, statements, locals_))
                self.ledger.written(declaration)
            except CannotSayError as error:
                name = str(getattr(declaration, "name", "this"))
                lost.add(name)
                self.ledger.reported(declaration)
                self.diagnostics.report(LOST, declaration.origin, name=name, reason=str(error))
        known_lost = self.store.lost
        self.store.lost = known_lost | lost
        if routine.name == self.entry:
            lines.extend(self.given())
            for task in self.program.tasks:
                if task.kind == "background":
                    lines.extend(self.say.lines("create", task=task.entry, priority=10, name=task.entry, arguments=""))
        parameters = [self.parameter(one, scope) for one in routine.parameters]
        lines.extend(statements.body(routine.body))
        self.store.lost = known_lost
        for handler in routine.handlers:
            for statement in handler.body:
                self.ledger.reported(statement)
            self.diagnostics.report(LOST, handler.origin, name=routine.name, reason="there are no error handlers")
        return self.say(
            "program",
            name=routine.name,
            parameters=parameters,
            locals=locals_,
            lines=indented(lines, statements.step),
        )

    def given(self) -> list[str]:
        """The first values that are no part of a declaration."""
        lines: list[str] = []
        for one, expressions in self.first:
            try:
                statements = Statements(expressions, self.diagnostics, self.ledger, self.say)
                lines.extend(statements.assigned(one.assign.target, one.assign.value))
                self.ledger.written(one)
            except CannotSayError as error:
                self.ledger.reported(one)
                self.diagnostics.report(LOST, one.origin, name="a first value", reason=str(error))
        return lines

    def parameter(self, parameter: ir.Parameter, scope: Scope) -> tuple[str, str, str, int, bool]:
        type, sizes = _element(scope.resolve(parameter.type), scope)
        if isinstance(type, ir.SignalType):
            return parameter.name, "dio" if type.kind.startswith("digital") else "aio", "element", 1, False
        word = self.roles.get(parameter.name) or tables.TYPES.get(type.__class__.__name__)
        if word is None:
            raise CannotSayError(f"there is no type {type.__class__.__name__}")
        form = "array" if isinstance(scope.resolve(parameter.type), ir.ArrayType) else "element"
        return parameter.name, word, form, len(sizes), parameter.mode == "reference"

    def local(
        self, declaration: ir.Declaration, statements: Statements, found: list[tuple[str, str, str]]
    ) -> list[str]:
        """A routine's own datum, and what gives it its first value."""
        expressions = statements.expressions
        match declaration:
            case ir.Unread(text=""):
                return []
            case ir.Variable(name=name, initial=initial):
                type, sizes = _element(expressions.scope.resolve(declaration.type), expressions.scope)
                word = self.roles.get(name) or tables.TYPES.get(type.__class__.__name__)
                if word is None:
                    raise CannotSayError(f"there is no type {type.__class__.__name__}")
                found.append((name, word, ",".join(map(str, sizes))))
                if initial is None or _is_zero(initial):
                    return []
                if sizes == (1,):
                    return statements.assigned(ir.Name(name), initial)
                lines = []
                for key, value in zip(product(*map(range, sizes)), _elements(initial, sizes), strict=True):
                    if value is not None:
                        element = ir.Index(ir.Name(name), tuple(map(ir.IntLiteral, key)))
                        lines.extend(statements.assigned(element, value))
                return lines
        raise CannotSayError(f"there is no {declaration.__class__.__name__}")


def _is_zero(value: ir.Expression) -> bool:
    return value in (ir.IntLiteral(0), ir.RealLiteral(0.0), ir.BoolLiteral(False), ir.TextLiteral(""), NULL)


def _element(type: ir.Type, scope: Scope) -> tuple[ir.Type, tuple[int, ...]]:
    """The type of a datum's elements and how many there are in each dimension."""
    if not isinstance(type, ir.ArrayType):
        return type, (1,)
    most = [0 if bound is None else constant_number(bound, scope) for bound in type.dimensions]
    if len(most) > _MOST_DIMENSIONS or None in most:
        raise CannotSayError(f"a list of more than {_MOST_DIMENSIONS} dimensions, or whose size is worked out")
    return scope.resolve(type.element), tuple(int(one or 0) + 1 for one in most)


def _elements(initial: ir.Expression | None, sizes: tuple[int, ...]) -> list[ir.Expression | None]:
    """The first values of all elements, the last dimension first; None: none is given."""
    given = [value for _, value in initial.entries] if isinstance(initial, ir.Aggregate) else []
    rows = [given[at] if at < len(given) else None for at in range(sizes[0])]
    return [one for row in rows for one in (_elements(row, sizes[1:]) if sizes[1:] else [row])]
