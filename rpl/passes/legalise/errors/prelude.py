"""Bring along what the source language predefines: a target knows its own system routines and data, not another's.

The parts of the source's prelude that the program uses, directly or through other parts, become modules of the program.
Calls of small system routines with a constant selector (`BAS(#INITMOV,0)`) are replaced by what they do.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.errors import InternalError
from rpl.passes.fold import constant, literal
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import usage_of
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typing import normalise

_LONGEST_INLINED = 40
_LONGEST_LOOP = 6
_DEEPEST = 4


@legalising()
def link_prelude(program: ir.Program, context: Context) -> ir.Program:
    """The program with the used part of each source dialect's prelude as a module of its own."""
    modules = list(program.modules)
    for dialect in sorted({module.dialect for module in program.modules}):
        prelude = _prelude(dialect)
        if prelude is None:
            continue
        modules = _inlined(modules, prelude, usage_of(program).assigned)
        modules = _with_own_values(modules, prelude)
        linked = _used_part(prelude, [module for module in modules if module.dialect == dialect], context)
        if linked is not None:
            modules.append(linked)
    return replace(program, modules=tuple(modules))


@cache
def _prelude(dialect: str) -> ir.Module | None:
    """A dialect's prelude in normal form, of which there is nothing to report."""
    prelude = registry.dialect(dialect).prelude()
    if prelude is None:
        return None
    diagnostics = Diagnostics()
    done = normalise(ir.Program((replace(prelude, dialect=dialect),)), diagnostics).modules[0]
    if diagnostics.items:
        raise InternalError(f"prelude of {dialect}: {[item.as_text() for item in diagnostics]}")
    return done


def _inlined(modules: list[ir.Module], prelude: ir.Module, assigned: set[str]) -> list[ir.Module]:
    """The modules of the prelude's dialect with calls of its small routines replaced."""
    own: set[str] = set()
    uses = _Uses()
    for module in modules:
        for declaration in module.declarations:
            own.update(_keys(declaration))
            uses.declaration(declaration)
        for routine in module.routines:
            own.add(routine.name.lower())
            uses.routine(routine)
    inliner = _Inliner(prelude, own, assigned, uses.names)
    return [
        replace(module, routines=tuple(edit_bodies(routine, inliner.body) for routine in module.routines))
        if module.dialect == prelude.dialect
        else module
        for module in modules
    ]


def _with_own_values(modules: list[ir.Module], prelude: ir.Module) -> list[ir.Module]:
    """Functions that only the source's controller has are values of its own, no routines to be brought along."""
    lone = {
        routine.name.lower(): routine.returns
        for routine in prelude.routines
        if routine.returns is not None and routine.open_ended and isinstance(routine.body[0], ir.Vendor)
    }
    for module in modules:
        for routine in module.routines:
            lone.pop(routine.name.lower(), None)

    def expression(one: ir.Expression) -> ir.Expression:
        done = rewrite_parts(one, expression)
        returns = lone.get(done.name.lower()) if isinstance(done, ir.Call) else None
        if isinstance(done, ir.Call) and returns is not None:
            text = one.origin.text or f"{done.name}(...)"
            return ir.VendorValue(prelude.dialect, text, returns, origin=done.origin)
        return done

    def body(statements: ir.Body) -> ir.Body:
        return tuple(rewrite_parts(statement, expression, body) for statement in statements)

    if not lone:
        return modules
    return [
        replace(module, routines=tuple(edit_bodies(routine, body) for routine in module.routines))
        if module.dialect == prelude.dialect
        else module
        for module in modules
    ]


# ---- what is used


class _Uses:
    """Names that a piece of IR mentions, folded."""

    def __init__(self) -> None:
        self.names: set[str] = set()

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Name(id=name):
                self.names.add(name.lower())
            case ir.Call(name=name):
                self.names.add(name.lower())
            case ir.EnumLiteral(member=member):
                self.names.add(f"#{member.lower()}")
            case ir.Aggregate(type_name=word) if word:
                self.names.add(word.lower())
        return rewrite_parts(expression, self.expression)

    def body(self, body: ir.Body) -> ir.Body:
        for statement in body:
            match statement:
                case ir.CallRoutine(name=name):
                    self.names.add(name.lower())
                case ir.ConnectInterrupt(routine=name):
                    self.names.add(name.lower())
                case ir.WaitUntil(error=str() as name):
                    self.names.add(name.lower())
            rewrite_parts(statement, self.expression, self.body)
        return body

    def type(self, type: ir.Type | None) -> None:
        match type:
            case ir.NamedType(name=name):
                self.names.add(name.lower())
            case ir.ArrayType(element=element):
                self.type(element)
                rewrite_parts(type, self.expression)

    def declaration(self, declaration: ir.Declaration) -> None:
        match declaration:
            case ir.Variable(type=type, initial=initial):
                self.type(type)
                if initial is not None:
                    self.expression(initial)
            case ir.RecordDeclaration(fields=fields):
                for _, type in fields:
                    self.type(type)
            case ir.AliasDeclaration(type=type):
                self.type(type)
            case ir.Initialise(assign=assign):
                self.body((assign,))

    def routine(self, routine: ir.Routine) -> None:
        for parameter in routine.parameters:
            self.type(parameter.type)
        self.type(routine.returns)
        for declaration in routine.declarations:
            self.declaration(declaration)
        self.body(routine.body)
        for handler in routine.handlers:
            for one in handler.codes:
                self.expression(one)
            self.body(handler.body)
        self.body(routine.undo)
        self.body(routine.backward)


def _keys(declaration: ir.Declaration) -> list[str]:
    match declaration:
        case ir.EnumDeclaration(name=name, members=members):
            return [name.lower(), *(f"#{member.lower()}" for member in members)]
        case ir.Initialise(assign=ir.Assign(target=target)):
            base = target
            while isinstance(base, ir.Index | ir.Field):
                base = base.base
            return [base.id.lower()] if isinstance(base, ir.Name) else []
        case ir.Unread() | ir.ExternalDeclaration():
            return []
    return [declaration.name.lower()]


def _spot(target: ir.Expression) -> tuple[object, ...]:
    """The part of a variable that an assignment of a data list sets, to be compared."""
    match target:
        case ir.Name(id=name):
            return (name.lower(),)
        case ir.Index(base=base, indices=indices):
            numbers = (one.value if isinstance(one, ir.IntLiteral) else one for one in indices)
            return (*_spot(base), *numbers)
        case ir.Field(base=base, name=name):
            return (*_spot(base), name.lower())
    return (target,)


def _used_part(prelude: ir.Module, modules: list[ir.Module], context: Context) -> ir.Module | None:
    uses = _Uses()
    own: set[str] = set()
    given: set[tuple[object, ...]] = set()  # parts of the prelude's data that the project's data lists set
    for module in modules:
        for declaration in module.declarations:
            uses.declaration(declaration)
            if isinstance(declaration, ir.Initialise):
                given.add(_spot(declaration.assign.target))
            else:
                own.update(_keys(declaration))
        for routine in module.routines:
            uses.routine(routine)
            own.add(routine.name.lower())
    kept: set[int] = set()
    size = -1
    while len(kept) != size:
        size = len(kept)
        for declaration in prelude.declarations:
            keys = _keys(declaration)
            if id(declaration) not in kept and any(key in uses.names and key not in own for key in keys):
                kept.add(id(declaration))
                uses.declaration(declaration)
        for routine in prelude.routines:
            name = routine.name.lower()
            if id(routine) not in kept and name in uses.names and name not in own:
                kept.add(id(routine))
                uses.routine(routine)
    if not kept:
        return None
    return replace(
        prelude,
        name=context.fresh(f"{prelude.dialect}_base"),
        declarations=tuple(
            _shared(d)
            for d in prelude.declarations
            if id(d) in kept and not (isinstance(d, ir.Initialise) and _spot(d.assign.target) in given)
        ),
        routines=tuple(replace(r, scope="global") for r in prelude.routines if id(r) in kept),
    )


def _shared(declaration: ir.Declaration) -> ir.Declaration:
    match declaration:
        case ir.Variable() | ir.RecordDeclaration() | ir.EnumDeclaration() | ir.AliasDeclaration():
            return replace(declaration, scope="global")
    return declaration


# ---- inlining of system routines with a constant selector


class _Inliner:
    """Replaces calls of small system routines by what they do: a Switch over a constant parameter is decided, a loop
    over the axes is written out, and defaults that nothing changes are written as their values."""

    def __init__(self, prelude: ir.Module, shadowed: set[str], assigned: set[str], mentioned: set[str]) -> None:
        self.routines = {r.name.lower(): r for r in prelude.routines if r.name.lower() not in shadowed}
        alone = ir.Program((prelude,))
        self.scope = ProgramScope(alone).module(prelude)
        assigned = assigned | usage_of(alone).assigned
        self.unseen = _noted(prelude) - _read(prelude) - mentioned  # what only notes something down for nobody
        self.defaults: dict[str, ir.Expression] = {}
        for declaration in prelude.declarations:
            if isinstance(declaration, ir.Variable) and declaration.initial is not None:
                name = declaration.name.lower()
                if name not in shadowed and name not in assigned and _is_number(declaration.initial):
                    self.defaults[name] = declaration.initial

    def body(self, statements: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        for statement in statements:
            inlined = self.call(statement, _DEEPEST) if isinstance(statement, ir.CallRoutine) else None
            if inlined is None:
                done.append(rewrite_parts(statement, lambda expression: expression, self.body))
            else:
                done.extend(inlined)
        return tuple(done)

    def call(self, call: ir.CallRoutine, depth: int) -> ir.Body | None:
        """What the call does, as statements without locals; None when it has to stay a call."""
        routine = self.routines.get(call.name.lower())
        if routine is None or depth == 0 or routine.handlers or len(call.arguments) > len(routine.parameters):
            return None
        given = dict(self.defaults)
        for parameter, argument in zip(routine.parameters, call.arguments, strict=False):
            if argument.value is None or argument.name or not _repeatable(argument.value):
                return None
            given[parameter.name.lower()] = argument.value
        missing = {parameter.name.lower() for parameter in routine.parameters[len(call.arguments) :]}
        done: list[ir.Statement] = []
        for statement in self.decided(routine.body, given):
            inner = self.call(statement, depth - 1) if isinstance(statement, ir.CallRoutine) else (statement,)
            if inner is None:
                return None
            done.extend(inner)
        uses = _Uses()
        uses.body(tuple(done))
        local = {d.name.lower() for d in routine.declarations if isinstance(d, ir.Variable)}
        if uses.names & (missing | local) or len(done) > _LONGEST_INLINED or _jumps(tuple(done)):
            return None
        if not done:
            return (ir.Nothing(origin=call.origin),)
        later = replace(call.origin, comments=())
        return tuple(replace(statement, origin=later if at else call.origin) for at, statement in enumerate(done))

    def decided(self, body: ir.Body, given: dict[str, ir.Expression]) -> ir.Body:
        """The body with parameters replaced, constant switches decided and short loops written out."""
        done: list[ir.Statement] = []
        for statement in body:
            match statement:
                case ir.Nothing():
                    continue
                case ir.Switch(selector=ir.Name(id=name)) if isinstance(
                    given.get(name.lower()), ir.EnumLiteral | ir.IntLiteral
                ):
                    done.extend(self.decided(_chosen(statement, given[name.lower()]), given))
                case ir.For(start=ir.IntLiteral(value=first), stop=ir.IntLiteral(value=last), step=None) if (
                    last - first < _LONGEST_LOOP and all(isinstance(s, ir.Assign) for s in statement.body)
                ):
                    for number in range(first, last + 1):
                        counted = {**given, statement.counter.lower(): ir.IntLiteral(number)}
                        done.extend(self.decided(statement.body, counted))
                case ir.Assign(target=ir.Name(id=name)) if name.lower() in self.unseen:
                    continue
                case ir.If():
                    done.extend(_taken(_Substitute(given, self.scope).body((statement,))))
                case _:
                    done.extend(_Substitute(given, self.scope).body((statement,)))
        return tuple(done)


def _noted(prelude: ir.Module) -> set[str]:
    """Plain variables of the prelude, folded."""
    return {d.name.lower() for d in prelude.declarations if isinstance(d, ir.Variable)}


def _read(prelude: ir.Module) -> set[str]:
    """Names that the prelude's routines mention elsewhere than as the place of a whole assignment."""
    uses = _Uses()

    def body(statements: ir.Body) -> ir.Body:
        for statement in statements:
            plain = isinstance(statement, ir.Assign) and isinstance(statement.target, ir.Name)
            if isinstance(statement, ir.Assign) and plain:
                uses.expression(statement.value)
            else:
                rewrite_parts(statement, uses.expression, body)
        return statements

    for routine in prelude.routines:
        body(routine.body)
        uses.routine(replace(routine, body=()))
    return uses.names


def _taken(body: ir.Body) -> ir.Body:
    """A branch whose condition is a constant, as its statements."""
    match body:
        case (ir.If(branches=((ir.BoolLiteral(value=True), chosen), *_)),):
            return chosen
        case (ir.If(branches=((ir.BoolLiteral(value=False), _), *rest), otherwise=otherwise) as whole,):
            return _taken((replace(whole, branches=tuple(rest)),)) if rest else otherwise
    return body


def _chosen(switch: ir.Switch, selector: ir.Expression) -> ir.Body:
    for case in switch.cases:
        if any(_same_constant(value, selector) for value in case.values):
            return case.body
    return switch.default or ()


def _is_number(value: ir.Expression) -> bool:
    return isinstance(value, ir.IntLiteral | ir.RealLiteral)


def _is_literal(value: ir.Expression) -> bool:
    return _is_number(value) or (isinstance(value, ir.Unary | ir.Convert) and _is_literal(value.operand))


def _repeatable(value: ir.Expression) -> bool:
    return isinstance(
        value, ir.EnumLiteral | ir.IntLiteral | ir.RealLiteral | ir.BoolLiteral | ir.Name | ir.TextLiteral
    ) or (isinstance(value, ir.Unary | ir.Convert) and _repeatable(value.operand))


def _same_constant(one: ir.Expression, other: ir.Expression) -> bool:
    match one, other:
        case ir.EnumLiteral(member=a), ir.EnumLiteral(member=b):
            return a.lower() == b.lower()
        case ir.IntLiteral(value=c), ir.IntLiteral(value=d):
            return c == d
    return False


def _jumps(body: ir.Body) -> bool:
    found = False

    def look(statements: ir.Body) -> ir.Body:
        nonlocal found
        for statement in statements:
            if isinstance(statement, ir.Return | ir.Goto | ir.Label | ir.For):
                found = True
            rewrite_parts(statement, lambda expression: expression, look)
        return statements

    look(body)
    return found


class _Substitute:
    """Replaces parameters by the arguments of one call; what then is arithmetic of literals becomes its value."""

    def __init__(self, given: dict[str, ir.Expression], scope: Scope) -> None:
        self.given, self.scope = given, scope

    def expression(self, expression: ir.Expression) -> ir.Expression:
        if isinstance(expression, ir.Name):
            return self.given.get(expression.id.lower(), expression)
        done = rewrite_parts(expression, self.expression)
        if isinstance(done, ir.Binary) and _is_literal(done.left) and _is_literal(done.right):
            value = constant(done, self.scope)
            known = None if value is None else literal(value)
            return done if known is None else replace(known, origin=done.origin)
        return done

    def body(self, body: ir.Body) -> ir.Body:
        return tuple(rewrite_parts(statement, self.expression, self.body) for statement in body)
