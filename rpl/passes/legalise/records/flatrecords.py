"""Records as one variable for each component, for targets without records.

An array of records becomes arrays of components. A record as a parameter becomes several parameters; a function that
gives a record gives its first component and leaves the others in variables, which the caller copies at once. This comes
behind the pass of geometry, which makes records of the built-in types that a target lacks.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.capabilities import Composite
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import everything
from rpl.passes.legalise.rewriting.arraycopies import array_copy
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import Scope, ValueDeclaration

WHOLE_RECORD = code("record-as-a-whole", Severity.LOSS, "a record as a whole cannot be said here")
Path = tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Leaf:
    """One component that is no record: the way to it, its type (an array when records on the way are in arrays)."""

    path: Path
    type: ir.Type


@dataclass(frozen=True, slots=True)
class Place:
    """A part of a variable that contains records. `indices` with the base of their array, in order."""

    declaration: ValueDeclaration
    path: Path
    indices: tuple[tuple[ir.Expression, int], ...]
    type: ir.Type


@dataclass(slots=True)
class Made:
    """Names of the variables that stand for components, by declaration; results of functions by routine."""

    names: dict[tuple[int, Path], str] = field(default_factory=dict)
    kept: list[object] = field(default_factory=list)  # keeps the identities alive
    results: dict[str, tuple[str, ...]] = field(default_factory=dict)
    declared: list[ir.Variable] = field(default_factory=list)


@legalising(unless=lambda context: Composite.RECORDS in context.capabilities.data.composites)
def flat_records(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without records."""
    if not _has_records(program):
        return program
    worker = _Flat(program, context)
    done = worker.program()
    task = done.modules[0].task
    return with_support(done, context, worker.made.declared, (), task)


def _has_records(program: ir.Program) -> bool:
    return any(
        isinstance(one, ir.RecordDeclaration)
        for module in program.modules
        for one in (*module.declarations, *(d for routine in module.routines for d in routine.declarations))
    )


def fields_of(type: ir.Type, scope: Scope) -> tuple[tuple[str, ir.Type], ...] | None:
    """The components of a record type; None for other types."""
    resolved = scope.resolve(type)
    declared = scope.type(resolved.name) if isinstance(resolved, ir.NamedType) else None
    return declared.fields if isinstance(declared, ir.RecordDeclaration) else None


def leaves_of(type: ir.Type, scope: Scope) -> tuple[Leaf, ...] | None:
    """The components of a type that contains records; None when it contains none."""
    resolved = scope.resolve(type)
    if isinstance(resolved, ir.ArrayType):
        inner = leaves_of(resolved.element, scope)
        return None if inner is None else tuple(Leaf(one.path, _outer(resolved, one.type)) for one in inner)
    fields = fields_of(resolved, scope)
    if fields is None:
        return None
    found: list[Leaf] = []
    for name, inner_type in fields:
        deeper = leaves_of(inner_type, scope) or (Leaf((), scope.resolve(inner_type)),)
        found.extend(Leaf((name.lower(), *one.path), one.type) for one in deeper)
    return tuple(found)


def _outer(array: ir.ArrayType, element: ir.Type) -> ir.ArrayType:
    """An array of what may be an array itself; its indices follow."""
    if not isinstance(element, ir.ArrayType):
        return replace(array, element=element)
    shift = array.base - element.base
    further = tuple(None if one is None else _plus(one, shift) for one in element.dimensions)
    return replace(array, element=element.element, dimensions=(*array.dimensions, *further))


def _plus(value: ir.Expression, shift: int) -> ir.Expression:
    if shift == 0:
        return value
    if isinstance(value, ir.IntLiteral):
        return replace(value, value=value.value + shift)
    return ir.Binary("+" if shift > 0 else "-", value, ir.IntLiteral(abs(shift)))


class _Flat(Rewriter):
    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        self.made = Made()
        self.parts: dict[int, dict[Path, ir.Expression]] = {}
        self.bases: dict[str, int] = {}  # where the indices of arrays of components begin
        self.behind: list[ir.Statement] = []  # what gives rows back behind a call

    # ---- names

    def name(self, declaration: ValueDeclaration, path: Path) -> str:
        key = (id(declaration), path)
        if key not in self.made.names:
            self.made.names[key] = self.context.fresh("_".join((declaration.name, *path)))
            self.made.kept.append(declaration)
        return self.made.names[key]

    def results(self, routine: ir.Routine, leaves: tuple[Leaf, ...]) -> tuple[str, ...]:
        """Variables in which a function leaves all components but the first."""
        key = routine.name.lower()
        if key not in self.made.results:
            names = []
            for leaf in leaves[1:]:
                names.append(self.context.fresh("_".join((routine.name, *leaf.path))))
                self.made.declared.append(ir.Variable(names[-1], leaf.type, scope="global"))
            self.made.results[key] = tuple(names)
        return self.made.results[key]

    # ---- declarations

    def declaration(self, declaration: ir.Declaration) -> list[ir.Declaration]:
        match declaration:
            case ir.RecordDeclaration():
                return []
            case ir.AliasDeclaration(type=type) if leaves_of(type, self.scope) is not None:
                return []
            case ir.Variable(type=type):
                leaves = leaves_of(type, self.scope)
                return super().declaration(declaration) if leaves is None else self.spread(declaration, leaves)
            case ir.Initialise(assign=assign):
                done = self.statement(assign)
                return [replace(declaration, assign=one) for one in done if isinstance(one, ir.Assign)]
        return super().declaration(declaration)

    def spread(self, declaration: ir.Variable, leaves: tuple[Leaf, ...]) -> list[ir.Declaration]:
        done: list[ir.Declaration] = []
        resolved = self.scope.resolve(declaration.type)
        for at, leaf in enumerate(leaves):
            initial = self.part(declaration.initial, resolved, leaf.path)
            origin = declaration.origin if at == 0 else replace(declaration.origin, comments=())
            name = self.name(declaration, leaf.path)
            done.append(replace(declaration, name=name, type=self.type(leaf.type), initial=initial, origin=origin))
        return done

    def part(self, value: ir.Expression | None, type: ir.Type, path: Path) -> ir.Expression | None:
        """The part of a written value that belongs to a component; None when it does not say it."""
        if value is None or (not path and not isinstance(value, ir.Aggregate)):
            return None if value is None else self.expression(value)
        if not path:
            return self.expression(value)
        if not isinstance(value, ir.Aggregate):
            return self.split(value, type).get(path)
        resolved = self.scope.resolve(type)
        if isinstance(resolved, ir.ArrayType):
            rest = resolved.dimensions[1:]
            inner: ir.Type = replace(resolved, dimensions=rest) if rest else resolved.element
            parts = [self.part(one, inner, path) for _, one in value.entries]
            known = [one for one in parts if one is not None]
            return ir.Aggregate(tuple((None, one) for one in known)) if len(known) == len(parts) else None
        fields = fields_of(resolved, self.scope)
        for at, (name, inner) in enumerate(fields or ()):
            if name.lower() == path[0]:
                entry = _entry(value, name, at)
                return None if entry is None else self.part(entry, inner, path[1:])
        return None

    def split(self, value: ir.Expression, type: ir.Type) -> dict[Path, ir.Expression]:
        """The components of a value that is evaluated once, by their ways."""
        known = self.parts.get(id(value))
        if known is None:
            leaves, values = leaves_of(type, self.scope) or (), self.values(value, type) or ()
            known = {leaf.path: one for leaf, one in zip(leaves, values, strict=False)}
            self.parts[id(value)] = known
        return known

    def routine(self, module: ir.Module, routine: ir.Routine) -> ir.Routine:
        scope = self.scopes.routine(module, routine)
        leaves = leaves_of(routine.returns, scope) if routine.returns is not None else None
        done = super().routine(module, routine)
        parameters: list[ir.Parameter] = []
        for old, new in zip(routine.parameters, done.parameters, strict=True):
            inner = leaves_of(old.type, scope)
            if inner is None:
                parameters.append(new)
            else:
                parameters.extend(
                    replace(new, name=self.name(old, leaf.path), type=self.type(leaf.type)) for leaf in inner
                )
        returns = done.returns if leaves is None else self.type(leaves[0].type)
        return replace(done, parameters=tuple(parameters), returns=returns)

    # ---- places

    def place(self, expression: ir.Expression) -> Place | None:
        """The part of a variable with records that an expression names."""
        match expression:
            case ir.Name(id=name):
                symbol = self.scope.value(name)
                if symbol is None or isinstance(symbol.declaration, ir.SignalDeclaration):
                    return None
                if leaves_of(symbol.type, self.scope) is None:
                    return None
                return Place(symbol.declaration, (), (), self.scope.resolve(symbol.type))
            case ir.Index(base=base, indices=indices):
                outer = self.place(base)
                if outer is None or not isinstance(outer.type, ir.ArrayType):
                    return None
                given = tuple((index, outer.type.base) for index in indices)
                rest = outer.type.dimensions[len(indices) :]
                inner = replace(outer.type, dimensions=rest) if rest else self.scope.resolve(outer.type.element)
                return replace(outer, indices=(*outer.indices, *given), type=inner)
            case ir.Field(base=base, name=name):
                outer = self.place(base)
                for field_name, type in (fields_of(outer.type, self.scope) or ()) if outer is not None else ():
                    if outer is not None and field_name.lower() == name.lower():
                        return replace(outer, path=(*outer.path, name.lower()), type=self.scope.resolve(type))
        return None

    def leaf(self, place: Place, path: Path) -> ir.Expression:
        """A component below a place."""
        name = ir.Name(self.name(place.declaration, (*place.path, *path)))
        if not place.indices:
            return name
        first = self.bases[name.id] = place.indices[0][1]
        return ir.Index(name, tuple(_plus(self.expression(index), first - base) for index, base in place.indices))

    def values(self, expression: ir.Expression, type: ir.Type) -> list[ir.Expression] | None:
        """The components of a value of a type with records, in order; None when it does not say all of them."""
        leaves = leaves_of(type, self.scope)
        place = self.place(expression)
        if leaves is None:
            return None
        if place is not None:
            return [self.leaf(place, leaf.path) for leaf in leaves]
        if isinstance(expression, ir.Call):  # one that the project lacks gives nothing
            return None if self.scope.routine(expression.name) is None else self.called(expression, leaves)
        if not isinstance(expression, ir.Aggregate):
            return None
        found = [self.part(expression, type, leaf.path) for leaf in leaves]
        known = [one for one in found if one is not None]
        return known if len(known) == len(found) else None

    def called(self, call: ir.Call, leaves: tuple[Leaf, ...]) -> list[ir.Expression]:
        """What a function gives, copied before another call can change it."""
        routine = self.scope.routine(call.name)
        names = () if routine is None else self.results(routine, leaves)
        done = self.arguments_of(call)
        copies: list[ir.Expression] = []
        others: tuple[ir.Expression, ...] = tuple(ir.Name(name) for name in names)
        for leaf, value in zip(leaves, (done, *others), strict=False):
            copy = self.temporary(self.type(leaf.type), "part")
            self.before.extend(self.copy(copy, value, leaf.type))
            copies.append(copy)
        return copies

    def copy(self, target: ir.Expression, value: ir.Expression, type: ir.Type) -> tuple[ir.Assign, ...]:
        """A component; an array element by element."""
        base = type.base if isinstance(type, ir.ArrayType) else 0
        return array_copy(target, value, type, (self.first(target, base), self.first(value, base)))

    def first(self, place: ir.Expression, base: int) -> int:
        """Where the indices of an array begin; those of a row begin as the whole array's."""
        if not isinstance(place, ir.Index) or not isinstance(place.base, ir.Name):
            return base
        return self.bases.get(place.base.id, base)

    # ---- expressions and statements

    def expression(self, expression: ir.Expression) -> ir.Expression:
        place = self.place(expression) if isinstance(expression, ir.Name | ir.Index | ir.Field) else None
        if place is not None:
            if leaves_of(place.type, self.scope) is None:
                return replace(self.leaf(place, ()), origin=expression.origin)
            self.context.diagnostics.report(WHOLE_RECORD, expression.origin)
            return expression
        match expression:
            case ir.Field(base=ir.Call() as call, name=name):
                return self.component_of_call(expression, call, name)
            case ir.Binary(op="=" | "<>" as op, left=left, right=right):
                type = self.type_of(left)
                if type is not None and leaves_of(type, self.scope) is not None:
                    return self.compared(expression, op, left, right, type)
            case ir.Call():
                return self.arguments_of(expression)
        return super().expression(expression)

    def component_of_call(self, expression: ir.Field, call: ir.Call, name: str) -> ir.Expression:
        type = self.type_of(call)
        leaves = leaves_of(type, self.scope) if type is not None else None
        if leaves is None:
            return super().expression(expression)
        parts = self.called(call, leaves)
        chosen = [part for part, leaf in zip(parts, leaves, strict=True) if leaf.path[0] == name.lower()]
        return chosen[0] if len(chosen) == 1 else super().expression(expression)

    def compared(
        self, expression: ir.Binary, op: str, left: ir.Expression, right: ir.Expression, type: ir.Type
    ) -> ir.Expression:
        one, other = self.values(left, type), self.values(right, type)
        if not one or not other:
            return super().expression(expression)
        parts: list[ir.Expression] = [ir.Binary(op, a, b) for a, b in zip(one, other, strict=True)]
        done = parts[0]
        for part in parts[1:]:
            done = ir.Binary("and" if op == "=" else "or", done, part)
        return done

    def arguments_of(self, call: ir.Call) -> ir.Call:
        return replace(call, arguments=self.arguments(call.name, call.arguments))

    def arguments(self, name: str, given: tuple[ir.Argument, ...]) -> tuple[ir.Argument, ...]:
        """Arguments in their new form; of a record all its components."""
        routine = self.scope.routine(name)
        done: list[ir.Argument] = []
        for at, argument in enumerate(given):
            wanted = routine.parameters[at].type if routine is not None and at < len(routine.parameters) else None
            parts = None
            if wanted is not None and argument.value is not None and leaves_of(wanted, self.scope) is not None:
                parts = self.values(argument.value, wanted)
            if parts is not None and wanted is not None and routine is not None:
                leaves = leaves_of(wanted, self.scope) or ()
                by_reference = routine.parameters[at].mode == "reference"
                done.extend(self.row(part, leaf, by_reference) for part, leaf in zip(parts, leaves, strict=True))
            elif argument.value is None:
                done.append(argument)
            else:
                done.append(replace(argument, value=self.expression(argument.value)))
        return tuple(done)

    def row(self, part: ir.Expression, leaf: Leaf, by_reference: bool) -> ir.Argument:
        """A component as an argument; a row of an array goes by way of a copy."""
        if not isinstance(leaf.type, ir.ArrayType) or not isinstance(part, ir.Index):
            return ir.Argument(part)
        copy = self.temporary(self.type(leaf.type), "row")
        self.before.extend(self.copy(copy, part, leaf.type))
        if by_reference:
            self.behind.extend(self.copy(part, copy, leaf.type))
        return ir.Argument(copy)

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        self.parts = {}
        match statement:
            case ir.Assign(target=target, value=value):
                place = self.place(target)
                if place is not None and leaves_of(place.type, self.scope) is not None:
                    return self.assigned(statement, place, value)
            case ir.CallRoutine(name=name, arguments=arguments, dynamic=None):
                outer, self.behind = self.behind, []
                call = replace(statement, arguments=self.arguments(name, arguments))
                given_back, self.behind = self.behind, outer
                return [call, *given_back]
            case ir.Return(value=value) if value is not None and self.scope.routine_here is not None:
                return self.returned(statement, value, self.scope.routine_here)
        return super().statement(statement)

    def returned(self, statement: ir.Return, value: ir.Expression, routine: ir.Routine) -> list[ir.Statement]:
        leaves = leaves_of(routine.returns, self.scope) if routine.returns is not None else None
        if leaves is None or routine.returns is None:
            return super().statement(statement)
        parts = self.values(value, routine.returns)
        if parts is None:
            self.context.diagnostics.report(WHOLE_RECORD, statement.origin)
            return [statement]
        names = self.results(routine, leaves)
        others = zip(names, parts[1:], leaves[1:], strict=True)
        stored = [one for n, part, leaf in others for one in self.copy(ir.Name(n), part, leaf.type)]
        return [*stored, replace(statement, value=parts[0])]

    def assigned(self, statement: ir.Assign, place: Place, value: ir.Expression) -> list[ir.Statement]:
        """Component by component; by way of copies where the value reads what is written."""
        leaves = leaves_of(place.type, self.scope) or ()
        pairs = []
        if isinstance(value, ir.Aggregate):
            for leaf in leaves:
                part = self.part(value, place.type, leaf.path)
                if part is not None:
                    pairs.append((leaf, part))
        else:
            parts = self.values(value, place.type)
            if parts is None:
                self.context.diagnostics.report(WHOLE_RECORD, statement.origin)
                return [statement]
            pairs = list(zip(leaves, parts, strict=True))
        done: list[ir.Statement] = []
        own = {self.name(place.declaration, (*place.path, *leaf.path)).lower() for leaf, _ in pairs}
        if len(pairs) > 1 and isinstance(value, ir.Aggregate) and any(_reads(part, own) for _, part in pairs):
            for at, (leaf, part) in enumerate(pairs):
                copy = self.temporary(self.type(leaf.type), "part")
                done.extend(self.copy(copy, part, leaf.type))
                pairs[at] = (leaf, copy)
        for leaf, part in pairs:
            done.extend(self.copy(self.leaf(place, leaf.path), part, leaf.type))
        return done or [ir.Nothing(origin=statement.origin)]


def _entry(value: ir.Aggregate, name: str, at: int) -> ir.Expression | None:
    for number, (written, one) in enumerate(value.entries):
        if (written or "").lower() == name.lower() or (written is None and number == at):
            return one
    return None


def _reads(value: ir.Expression, names: set[str]) -> bool:
    return any(isinstance(one, ir.Name) and one.id.lower() in names for one in everything(value))
