"""Starting values of data that the source language sets to zero by itself and the target leaves undefined.

Data of modules gets its value in the declaration; a routine's own only where something else than a plain assignment may
come first. Between languages whose data starts undefined only places that get their components one by one need a value,
and only where the target makes a new place of the old one. Runs before the passes that write aggregates in the target's
form.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TypeGuard

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.capabilities import Local, PlaceRule
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.usage import base_name
from rpl.passes.legalise.rewriting.support import default_value
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.scope import Scope
from rpl.passes.typewords import component_names, component_type, type_word

# An array of more elements is filled by a loop where it can be.
_LISTED = 32
_LONGEST = 4096
_ZERO = ir.RealLiteral(0.0)
_NUMBERS: dict[type, tuple[str, ...]] = {
    ir.VectorType: ("x", "y", "z"),
    ir.PoseType: ir.POSE,
    ir.TargetType: ir.POSE,
    ir.JointsType: ir.AXES,
    ir.RotationType: ir.ANGLES,
}


@legalising()
def starting_values(program: ir.Program, context: Context) -> ir.Program:
    """From languages whose data starts at zero to those whose data starts undefined, or as it was left; else of places
    that are filled component by component."""
    can = context.capabilities
    if rules_of(context.source).undefined:
        return _InParts(program, context).program() if PlaceRule.WHOLE in can.places.rules else program
    left_over = (
        rules_of(context.target).undefined or bool(can.storage.banks) or Local.VARIABLES not in can.routines.locals
    )
    if not left_over:
        return program
    return _Defaults(program, context).program()


class _Defaults(Rewriter):
    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        self.body_here: ir.Body = ()
        self.start: list[ir.Statement] = []

    def routine(self, module: ir.Module, routine: ir.Routine) -> ir.Routine:
        self.body_here, self.start = routine.body, []
        done = super().routine(module, routine)
        return replace(done, body=(*self.start, *done.body)) if self.start else done

    def body(self, body: ir.Body) -> ir.Body:
        return body

    def declaration(self, declaration: ir.Declaration) -> list[ir.Declaration]:
        if not isinstance(declaration, ir.Variable) or declaration.initial is not None:
            return [declaration]
        type = self.scope.resolve(declaration.type)
        local = self.scope.routine_here is not None
        if local and _set_first(self.body_here, declaration.name.lower()):
            return [declaration]
        counts = self.counts(type)
        if counts is None:
            return [declaration]
        total = 1
        for count in counts:
            total *= count
        if local and isinstance(type, ir.ArrayType) and total > _LISTED:
            self.filled(declaration, type, counts)
            return [declaration]
        value = self.value(type) if total <= _LONGEST else None
        return [declaration if value is None else replace(declaration, initial=value)]

    def counts(self, type: ir.Type) -> list[int] | None:
        """Elements in each dimension (none for what is no array); None when they are not known."""
        if not isinstance(type, ir.ArrayType):
            return []
        found = [constant(bound, self.scope) if bound is not None else None for bound in type.dimensions]
        whole = [count for count in found if isinstance(count, int)]
        return whole if len(whole) == len(found) else None

    def filled(self, declaration: ir.Variable, type: ir.ArrayType, counts: list[int]) -> None:
        """A loop that sets every element."""
        value = self.value(self.scope.resolve(type.element))
        if value is None:
            return
        counters = [self.temporary(ir.IntType(), "element") for _ in counts]
        inner: ir.Statement = ir.Assign(ir.Index(ir.Name(declaration.name), tuple(counters)), value)
        for counter, count in reversed(list(zip(counters, counts, strict=True))):
            inner = ir.For(counter.id, ir.IntLiteral(1), ir.IntLiteral(count), None, (inner,))
        self.start.append(inner)

    def value(self, type: ir.Type) -> ir.Expression | None:
        """Zero, FALSE, the empty text, the identity, or these in all components."""
        match type:
            case ir.ArrayType(element=element, dimensions=dimensions):
                counts = self.counts(type) or []
                rest = dimensions[1:]
                inner = ir.ArrayType(element, rest, type.base) if rest else self.scope.resolve(element)
                one = self.value(inner)
                return ir.Aggregate(tuple((None, one) for _ in range(counts[0]))) if one is not None else None
            case ir.NamedType():
                entries = []
                for name in component_names(type, self.scope):
                    found = component_type(type, name, self.scope)
                    part = self.value(found) if found is not None else None
                    if part is None:
                        return None
                    entries.append((name, part))
                return ir.Aggregate(tuple(entries), type_name=type_word(type)) if entries else None
        names = _NUMBERS.get(type.__class__)
        if names is not None:
            return ir.Aggregate(tuple((name, _ZERO) for name in names), type_name=type_word(type))
        return default_value(type)


class _InParts(_Defaults):
    """Only what is set in parts: by component, here or in a routine that it is handed to, and never asked about."""

    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        self.elements: dict[int, set[int] | None] = {}  # by declaration; numbers of an array's, None: any or no array
        self.asked: set[int] = set()
        for module, routine in self.scopes.routines():
            self.look(self.scopes.routine(module, routine), routine)

    def look(self, scope: Scope, routine: ir.Routine) -> None:
        for node in walk(routine):
            match node:
                case ir.Assign(target=ir.Field(base=base)):
                    self.part(base, scope)
                case ir.CallRoutine(name=name, arguments=arguments) | ir.Call(name=name, arguments=arguments):
                    called = scope.routine(name)
                    for filled, argument in zip(_filled_parameters(called), arguments, strict=False):
                        if filled and argument.value is not None:
                            self.part(argument.value, scope)
                case ir.Builtin(function="is_uninitialised", arguments=(asked, *_)):
                    symbol = scope.value(base_name(asked) or "")
                    if symbol is not None:
                        self.asked.add(id(symbol.declaration))

    def part(self, place: ir.Expression, scope: Scope) -> None:
        """A component of the place is set."""
        symbol = scope.value(base_name(place) or "")
        if symbol is None:
            return
        key = id(symbol.declaration)
        number = constant(place.indices[0], scope) if _numbered(place) else None
        known = self.elements.setdefault(key, set())
        self.elements[key] = known | {number} if isinstance(number, int) and known is not None else None

    def declaration(self, declaration: ir.Declaration) -> list[ir.Declaration]:
        if id(declaration) not in self.elements or id(declaration) in self.asked:
            return [declaration]
        numbers = self.elements[id(declaration)]
        if numbers is None or not isinstance(declaration, ir.Variable) or declaration.initial is not None:
            return super().declaration(declaration)
        type = self.scope.resolve(declaration.type)
        value = self.value(self.scope.resolve(type.element)) if isinstance(type, ir.ArrayType) else None
        if value is None or self.scope.routine_here is not None:
            return super().declaration(declaration)
        place = ir.Name(declaration.name)
        firsts = [ir.Assign(ir.Index(place, (ir.IntLiteral(number),)), value) for number in sorted(numbers)]
        return [declaration, *map(ir.Initialise, firsts)]


def _numbered(place: ir.Expression) -> TypeGuard[ir.Index]:
    """An element of a list of one dimension."""
    return isinstance(place, ir.Index) and isinstance(place.base, ir.Name) and len(place.indices) == 1


def _filled_parameters(routine: ir.Routine | None) -> list[bool]:
    """For each parameter whether a component of it is set for the caller."""
    if routine is None:
        return []
    set_here = {
        (base_name(node.target) or "").lower()
        for node in walk(routine)
        if isinstance(node, ir.Assign) and isinstance(node.target, ir.Field)
    }
    return [one.mode == "reference" and one.name.lower() in set_here for one in routine.parameters]


def _set_first(body: ir.Body, name: str) -> bool:
    """Is the variable not used at all, or first by an assignment that always runs?"""
    for statement in body:
        if not _mentions(statement, name):
            continue
        match statement:
            case ir.Assign(target=ir.Name(), value=value):
                return not _in_expression(value, name)
            case ir.For(counter=counter, start=start, stop=stop) if counter.lower() == name:
                return not _in_expression(start, name) and not _in_expression(stop, name)
        return False
    return True


def _mentions(statement: ir.Statement, name: str) -> bool:
    found = False

    def expression(one: ir.Expression) -> ir.Expression:
        nonlocal found
        found = found or _in_expression(one, name)
        return one

    def body(statements: ir.Body) -> ir.Body:
        nonlocal found
        for one in statements:
            found = found or (isinstance(one, ir.For) and one.counter.lower() == name)
            rewrite_parts(one, expression, body)
        return statements

    body((statement,))
    return found or isinstance(statement, ir.Label | ir.Vendor)


def _in_expression(value: ir.Expression, name: str) -> bool:
    found = False

    def look(one: ir.Expression) -> ir.Expression:
        nonlocal found
        found = found or (isinstance(one, ir.Name) and one.id.lower() == name)
        return rewrite_parts(one, look)

    look(value)
    return found
