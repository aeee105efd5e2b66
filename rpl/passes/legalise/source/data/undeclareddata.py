"""Data that no file of the project declares, for targets whose data has numbers: each gets one, by what its use shows.

Targets with names write the name, and their controllers ask for it. Where data has numbers the line would be lost, and
a program given without its project was nothing but stops. So it stops once, at its beginning, and says what is missing.
A part of an undeclared record is taken as a datum of its own. Nothing is taken where the uses do not agree, for arrays,
and for what goes to a routine as a whole.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.builtins import FUNCTIONS
from rpl.ir.walk import rewrite
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.entries import never_called
from rpl.passes.legalise.facts.usage import doing
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import visit_parts
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typing import type_of
from rpl.source import NOWHERE, Origin

TAKEN = code(
    "undeclared-data",
    Severity.LOSS,
    "not declared in what was read, and taken as data of the kind that its use shows: {names}",
    "give all files of the project, or declare it; what is a signal there has to be one here",
    stops=True,
)

Path = tuple[str, ...]  # folded: a name and the components behind it
_PARTS = frozenset((*ir.POSE, "s", "t", *(f"e{number}" for number in range(1, 7))))
_LOGIC = frozenset(("and", "or", "cand", "cor"))
_ORDER = frozenset(("=", "<>", "<", "<=", ">", ">="))
_SUMS = frozenset(("+", "-", "*", "/", "div", "mod", "quo", "**"))
_WHOLE, _NUMBER, _TRUTH = ir.IntType(), ir.RealType(), ir.BoolType()
_PLACE = ir.TargetType("")  # in the notation of its module
_LETTERS: dict[str, ir.Type] = {"n": _NUMBER, "i": _WHOLE, "b": _TRUTH, "p": _PLACE}  # of parameters of functions
_KINDS = (ir.IntType, ir.RealType, ir.BoolType, ir.TargetType)
_HOME = "undeclared"


@dataclass(slots=True)
class _Found:
    """What the uses of one path say of it. `type` None: nothing yet; `refused`: they do not agree."""

    spelling: str
    origin: Origin
    type: ir.Type | None = None
    refused: bool = False

    def add(self, type: ir.Type | None) -> None:
        if type is None:
            return
        if not isinstance(type, _KINDS):
            self.refused = True
        elif self.type is None or self.type == type:
            self.type = type
        elif {self.type, type} == {_WHOLE, _NUMBER}:
            self.type = _NUMBER
        else:
            self.refused = True


@legalising(unless=lambda context: not context.capabilities.storage.banks or not context.foreign)
def undeclared_data(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets with banks."""
    scopes, uses = ProgramScope(program), _Uses()
    for module, routine in scopes.routines():
        if routine.origin is NOWHERE:
            continue  # what the reader has brought along
        uses.scope = _scope(scopes, module, routine)
        names_here = {node.id for node in walk_for({"Name"}, routine) if isinstance(node, ir.Name)}
        if all(uses.scope.value(name) is not None for name in names_here):
            continue
        for body in (routine.body, *(one.body for one in routine.handlers), routine.undo, routine.backward):
            uses.body(body)
    paths = uses.agreed()
    if not paths:
        return program
    names = {path: ir.Name(context.fresh("_".join(one.spelling.split(".")))) for path, one in paths.items()}

    modules = []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            scope = _scope(scopes, module, routine)

            def change(node: object, scope: Scope = scope) -> object:
                if isinstance(node, ir.Name | ir.Field):
                    new = names.get(_path(node, scope))
                    return node if new is None else replace(new, origin=node.origin)
                return node

            routines.append(rewrite(routine, change) if routine.origin is not NOWHERE else routine)
        modules.append(replace(module, routines=tuple(routines)))
    place = replace(_PLACE, notation=program.modules[0].dialect)
    made = tuple(
        ir.Variable(
            names[path].id,
            place if one.type == _PLACE else one.type or _NUMBER,
            storage="persistent",
            scope="global",
            origin=_bare(one.origin),
        )
        for path, one in paths.items()
    )
    context.unknown |= {one.name.lower() for one in made}
    first = next(iter(paths.values())).origin
    listed = ", ".join(one.spelling for one in paths.values())
    context.diagnostics.report(TAKEN, first, names=listed)
    home = ir.Module(context.fresh(_HOME), program.modules[0].dialect, made, public=True)
    done = replace(program, modules=(*modules, home))
    return _stopped(done, {one.name.lower() for one in made}, listed, first)


def _scope(scopes: ProgramScope, module: ir.Module, routine: ir.Routine) -> Scope:
    """What names mean in the routine; a counter that its loop declares is known in all of it."""
    scope = scopes.routine(module, routine)
    counters = {node.counter for node in walk_for({"For"}, routine) if isinstance(node, ir.For) and node.scoped}
    for counter in sorted(counters):
        if scope.value(counter) is None:
            scope = scope.with_value(ir.Variable(counter, _WHOLE))
    return scope


def _path(node: ir.Expression, scope: Scope) -> Path:
    """The name and its components, folded, of what no file declares; empty for anything else."""
    match node:
        case ir.Name(id=name):
            return (name.lower(),) if scope.value(name) is None else ()
        case ir.Field(base=base, name=name):
            before = _path(base, scope)
            return (*before, name.lower()) if before else ()
    return ()


def _spelled(node: ir.Expression) -> str:
    match node:
        case ir.Field(base=base, name=name):
            return f"{_spelled(base)}.{name}"
        case ir.Name(id=name):
            return name
    return ""


@dataclass(slots=True)
class _Uses:
    """The uses of what is not declared, statement by statement."""

    found: dict[Path, _Found] = field(default_factory=dict)
    scope: Scope = field(init=False)

    def agreed(self) -> dict[Path, _Found]:
        """Those with one kind; none of a record that is also used as a whole."""
        found = self.found
        broken = {path[0] for path in found if any(one[: len(path)] == path and one != path for one in found)}
        return {
            path: one
            for path, one in found.items()
            if path[0] not in broken and one.type is not None and not one.refused
        }

    def body(self, body: ir.Body) -> None:
        for statement in body:
            self.statement(statement)

    def statement(self, statement: ir.Statement) -> None:
        match statement:
            case ir.Assign(target=target, value=value):
                self.beside(target, value)
            case ir.If(branches=branches):
                for condition, _ in branches:
                    self.use(condition, _TRUTH)
            case ir.While(condition=condition) | ir.WaitUntil(condition=condition) | ir.Repeat(until=condition):
                self.use(condition, _TRUTH)
            case ir.Wait(time=time):
                self.use(time, _NUMBER)
            case ir.Move(target=target, via=via):
                self.use(target, _PLACE)
                if via is not None:
                    self.use(via, _PLACE)
            case ir.CallRoutine(arguments=arguments):
                for argument in arguments:
                    if argument.value is not None:
                        self.refuse(argument.value)
        visit_parts(statement, self.look, self.body)

    def look(self, expression: ir.Expression) -> None:
        self.use(expression, None)

    def beside(self, one: ir.Expression, other: ir.Expression) -> None:
        """Two that have to be of one kind."""
        self.use(one, self.kind(other))
        self.use(other, self.kind(one))

    def kind(self, expression: ir.Expression) -> ir.Type | None:
        """What something declared is; None for what is not known either."""
        match expression:
            case ir.BoolLiteral():
                return _TRUTH
            case ir.IntLiteral() | ir.RealLiteral():
                return _NUMBER  # a whole number may be one, too
            case ir.Unary(op="-", operand=operand):
                return self.kind(operand)
            case ir.Aggregate(entries=entries) if entries and all(
                (name or "").lower() in _PARTS for name, _ in entries
            ):
                return _PLACE
            case ir.Quantity():
                return _NUMBER
        type = type_of(expression, self.scope)
        match type:
            case None:
                return None
            case ir.IntType() | ir.RealType():
                return _NUMBER
            case ir.PoseType() | ir.TargetType():
                return _PLACE
        return type

    def use(self, expression: ir.Expression, kind: ir.Type | None) -> None:
        path = _path(expression, self.scope)
        if path:
            if path[-1] in _PARTS and len(path) > 1:
                path, kind, expression = (
                    path[:-1],
                    _PLACE,
                    expression.base if isinstance(expression, ir.Field) else expression,
                )
            origin = getattr(expression, "origin", NOWHERE)
            self.found.setdefault(path, _Found(_spelled(expression), origin)).add(kind)
            return
        match expression:
            case ir.Unary(op="not", operand=operand):
                self.use(operand, _TRUTH)
            case ir.Binary(op=op, left=left, right=right) if op in _LOGIC:
                self.use(left, _TRUTH)
                self.use(right, _TRUTH)
            case ir.Binary(op=op, left=left, right=right) if op in _ORDER:
                self.beside(left, right)
            case ir.Binary(op=op, left=left, right=right) if op in _SUMS:
                self.use(left, _NUMBER)
                self.use(right, _NUMBER)
            case ir.Binary(op=":", left=left, right=right):
                self.use(left, _PLACE)
                self.use(right, _PLACE)
            case ir.Builtin(function=name, arguments=arguments) if name in FUNCTIONS:
                kinds = FUNCTIONS[name].parameters.replace("?", "")
                for letter, operand in zip(kinds, arguments, strict=False):
                    if operand is not None:
                        self.use(operand, _LETTERS.get(letter))
            case ir.Index(base=base, indices=indices):
                self.refuse(base)
                for index in indices:
                    self.use(index, _WHOLE)
            case ir.System(indices=indices):
                for index in indices:
                    self.use(index, _WHOLE)
            case ir.Call(arguments=arguments):
                for argument in arguments:
                    if argument.value is not None:
                        self.refuse(argument.value)
            case _:
                visit_parts(expression, self.look)

    def refuse(self, expression: ir.Expression) -> None:
        """What is indexed, or goes to a routine, whose own kind for it is not known."""
        path = _path(expression, self.scope)
        if path:
            self.found.setdefault(path, _Found(_spelled(expression), NOWHERE)).refused = True
        else:
            self.use(expression, None)


def _bare(origin: Origin) -> Origin:
    return replace(origin, comments=())


def _stopped(program: ir.Program, names: set[str], listed: str, first: Origin) -> ir.Program:
    """The program with a stop at its beginning. Its origin is that of the report, so that it is not reported again."""
    users = doing(program, lambda node: isinstance(node, ir.Name) and node.id.lower() in names)
    starts = never_called(program) & users or users
    where = Origin(first.source, first.start, first.start)

    def stopped(routine: ir.Routine, dialect: str) -> ir.Routine:
        if routine.name.lower() not in starts:
            return routine
        stop = ir.Vendor(dialect, f"not declared, to be set first: {listed}", "unknown", origin=where)
        return replace(routine, body=(stop, *routine.body))

    modules = tuple(
        replace(module, routines=tuple(stopped(one, module.dialect) for one in module.routines))
        for module in program.modules
    )
    return replace(program, modules=modules)


__all__ = ["undeclared_data"]
