"""Structured values in the form that the target can say.

Components named or in order, complete or partial, constants only or any expression; arrays as a whole or element by
element. What an aggregate of the target cannot hold is assigned component by component, to the place itself or to a
variable of its own. Poses, vectors and rotations are left to the pass of geometry, which takes them apart as numbers.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.capabilities import Aggregate, PlaceRule
from rpl.passes.fold import constant, lasting, literal
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import base_name
from rpl.passes.legalise.rewriting.support import default_value
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.typewords import component_names, component_type, type_word
from rpl.passes.values import Value

# Taken apart by the pass of geometry, also inside of expressions.
_GEOMETRIC = (ir.VectorType, ir.RotationType, ir.PoseType)
# Partial in their own right: what is left out stays as it is or is filled by the pass of geometry.
_POINTS = (ir.TargetType, ir.JointsType, ir.PoseType)
_LITERALS = (ir.IntLiteral, ir.RealLiteral, ir.BoolLiteral, ir.TextLiteral, ir.EnumLiteral)


@legalising()
def aggregates(program: ir.Program, context: Context) -> ir.Program:
    """The program with aggregates that the target has."""
    return _Aggregates(program, context).program()


_Placed = tuple[ir.Expression, ir.Expression, ir.Type]  # a place, its value, its type


class _Aggregates(Rewriter):
    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        can = context.capabilities
        self.named, self.partial, self.constant = (
            Aggregate.NAMED in can.data.aggregates,
            Aggregate.PARTIAL in can.data.aggregates,
            Aggregate.CONSTANT in can.data.aggregates,
        )
        self.whole_arrays = Aggregate.NAMED not in can.data.aggregates
        self.start: list[ir.Statement] = []

    def routine(self, module: ir.Module, routine: ir.Routine) -> ir.Routine:
        self.start = []
        done = super().routine(module, routine)
        return replace(done, body=(*self.start, *done.body)) if self.start else done

    # ---- initial values

    def declaration(self, declaration: ir.Declaration) -> list[ir.Declaration]:
        match declaration:
            case ir.Variable(initial=ir.Aggregate() as initial, type=type):
                resolved = self.scope.resolve(type)
                if isinstance(resolved, ir.ArrayType) and not self.whole_arrays:
                    return self.listed(declaration, initial, resolved)
                if self.holds_list(initial, resolved):
                    return self.with_lists(declaration, initial, resolved)
                return [replace(declaration, initial=self.complete(initial, resolved))]
            case ir.Initialise(assign=assign):
                done = self.assignment(assign)
                return [replace(declaration, assign=one) for one in done if isinstance(one, ir.Assign)]
        return super().declaration(declaration)

    def listed(self, declaration: ir.Variable, initial: ir.Aggregate, type: ir.ArrayType) -> list[ir.Declaration]:
        """An array that gets its values element by element: in the data list, or at the start of the routine."""
        bare = replace(declaration, initial=None)
        pairs = self.elements(ir.Name(declaration.name), initial, type)
        return self.valued_later(bare, [one for pair in pairs for one in self.apart(*pair)])

    def with_lists(self, declaration: ir.Variable, initial: ir.Aggregate, type: ir.Type) -> list[ir.Declaration]:
        """A record that holds arrays: these get their values element by element, the rest stays with the record."""
        (_, rest, _), *lists = self.apart(ir.Name(declaration.name), initial, type)
        bare = replace(declaration, initial=self.complete(rest, type) if _entries(rest) else None)
        return self.valued_later(bare, lists)

    def valued_later(self, bare: ir.Variable, values: list[_Placed]) -> list[ir.Declaration]:
        later = replace(bare.origin, comments=())
        assigns = [ir.Assign(place, self.member(value, inner), origin=later) for place, value, inner in values]
        if self.scope.routine_here is None:
            return [bare, *(ir.Initialise(one, origin=later) for one in assigns)]
        self.start.extend(assigns)
        return [bare]

    def holds_list(self, value: ir.Expression, type: ir.Type | None) -> bool:
        """Is an array written out inside of a record, for a target that has no form for that?"""
        if self.whole_arrays or not isinstance(value, ir.Aggregate) or not isinstance(type, ir.NamedType):
            return False
        if "NamedType" not in self.context.capabilities.types:
            return False  # records come apart later
        members = [(component_type(type, name, self.scope), one) for name, one in self.given(value, type).items()]
        return any(isinstance(inner, ir.ArrayType) or self.holds_list(one, inner) for inner, one in members)

    def apart(self, place: ir.Expression, value: ir.Expression, type: ir.Type) -> list[_Placed]:
        """A value without the arrays inside of it, and behind it their elements, each in the same way."""
        if not self.holds_list(value, type) or not isinstance(value, ir.Aggregate):
            return [(place, value, type)]
        kept: list[tuple[str | None, ir.Expression]] = []
        found: list[_Placed] = []
        for name, one in self.given(value, type).items():
            inner = component_type(type, name, self.scope)
            written = _written(name, component_names(type, self.scope))
            here = ir.Field(place, written)
            if isinstance(inner, ir.ArrayType) and isinstance(one, ir.Aggregate):
                found.extend(part for element in self.elements(here, one, inner) for part in self.apart(*element))
            elif inner is not None and self.holds_list(one, inner):
                (_, rest, _), *lists = self.apart(here, one, inner)
                kept.extend([(written, rest)] if _entries(rest) else [])
                found.extend(lists)
            else:
                kept.append((written, one))
        return [(place, replace(value, entries=tuple(kept)), type), *found]

    def elements(
        self, place: ir.Expression, value: ir.Aggregate, type: ir.ArrayType
    ) -> list[tuple[ir.Expression, ir.Expression, ir.Type]]:
        """All elements of an array that is written out."""

        def deeper(
            entries: tuple[tuple[str | None, ir.Expression], ...], indices: tuple[ir.Expression, ...], depth: int
        ) -> list[tuple[ir.Expression, ir.Expression, ir.Type]]:
            found: list[tuple[ir.Expression, ir.Expression, ir.Type]] = []
            for at, (_, entry) in enumerate(entries):
                here = (*indices, ir.IntLiteral(type.base + at))
                if depth > 1 and isinstance(entry, ir.Aggregate):
                    found.extend(deeper(entry.entries, here, depth - 1))
                else:
                    found.append((ir.Index(place, here), entry, element))
            return found

        element = self.scope.resolve(type.element)
        return deeper(value.entries, (), len(type.dimensions))

    def complete(self, value: ir.Expression, type: ir.Type | None) -> ir.Expression:
        """A value with all components that the target asks for, members in order and, where it must be, constant."""
        if not isinstance(value, ir.Aggregate) or type is None:
            return self.plain(value)
        if isinstance(type, ir.ArrayType):
            rest = type.dimensions[1:]
            inner = ir.ArrayType(type.element, rest, type.base) if rest else self.scope.resolve(type.element)
            return replace(value, entries=tuple((None, self.complete(one, inner)) for _, one in value.entries))
        return self.arranged(value, type, fill=not self.partial)

    def arranged(self, value: ir.Aggregate, type: ir.Type, fill: bool) -> ir.Aggregate:
        order = component_names(type, self.scope)
        given = self.given(value, type)
        word = value.type_name or type_word(type)
        if isinstance(type, _POINTS) and not set(given) <= set(order):
            entries = tuple((name, self.plain(one)) for name, one in given.items())  # side by side, not nested
            return replace(value, entries=entries, type_name=word)
        names = order if fill and isinstance(type, ir.NamedType) else tuple(n for n in order if n.lower() in given)
        done: list[tuple[str | None, ir.Expression]] = []
        for name in names:
            inner = component_type(type, name, self.scope)
            member = given.get(name.lower())
            filled = self.complete(member, inner) if member is not None else self.default(inner)
            if filled is not None:
                done.append((name, filled))
        return replace(value, entries=tuple(done), type_name=word)

    def given(self, value: ir.Aggregate, type: ir.Type) -> dict[str, ir.Expression]:
        """The members by folded name."""
        order = component_names(type, self.scope)
        return {
            (written or (order[at] if at < len(order) else str(at))).lower(): one
            for at, (written, one) in enumerate(value.entries)
        }

    def default(self, type: ir.Type | None) -> ir.Expression | None:
        """The value that a component has when nothing gives it one."""
        match type:
            case ir.NamedType():
                names = component_names(type, self.scope)
                entries = tuple((name, self.default(component_type(type, name, self.scope))) for name in names)
                known = tuple((name, value) for name, value in entries if value is not None)
                return ir.Aggregate(known, type_name=type_word(type)) if known else None
            case ir.ArrayType(element=element, dimensions=(first, *rest)):
                count = constant(first, self.scope) if first is not None else None
                inner = ir.ArrayType(element, tuple(rest), type.base) if rest else self.scope.resolve(element)
                one = self.default(inner)
                if not isinstance(count, int) or one is None:
                    return None
                return ir.Aggregate(tuple((None, one) for _ in range(count)))
            case None:
                return None
        return default_value(type)

    def plain(self, value: ir.Expression) -> ir.Expression:
        """A member; a constant where the target takes nothing else."""
        if self.constant and not _is_literal(value) and not isinstance(value, ir.Aggregate):
            made = _literal_of(self.known(value))
            if made is not None:
                return made
        return self.expression(value)

    def member(self, value: ir.Expression, type: ir.Type) -> ir.Expression:
        return self.complete(value, type) if isinstance(value, ir.Aggregate) else self.plain(value)

    # ---- assignments

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        if isinstance(statement, ir.Assign):
            return self.assignment(statement)
        return super().statement(statement)

    def assignment(self, statement: ir.Assign) -> list[ir.Statement]:
        value, type = statement.value, self.type_of(statement.target)
        target = self.expression(statement.target)
        if isinstance(type, ir.ArrayType) and not self.whole_arrays:
            return self.array(statement, target, value, type)
        if not isinstance(value, ir.Aggregate) or type is None:
            return [replace(statement, target=target, value=self.expression(value))]
        if isinstance(type, ir.ArrayType):
            return [replace(statement, target=target, value=self.complete(value, type))]
        if isinstance(type, _GEOMETRIC) and self.is_complete(value, type):
            return [replace(statement, target=target, value=self.expression(value))]
        whole = (self.is_complete(value, type) or self.partial) and not self.holds_list(value, type)
        if whole and (not self.constant or self.is_constant(value)):
            return [replace(statement, target=target, value=self.arranged(value, type, fill=False))]
        return self.by_component(statement, target, value, type)

    def is_complete(self, value: ir.Aggregate, type: ir.Type) -> bool:
        """Are all components given, here and inside?"""
        given = self.given(value, type)
        order = {name.lower() for name in component_names(type, self.scope)}
        if isinstance(type, _POINTS) and not {"trans", "rot", "robax"} & set(given):
            flat = ir.POSE if not isinstance(type, ir.JointsType) else (
                "j1", "j2", "j3", "j4", "j5", "j6"
            )  # fmt: skip
            return set(flat) <= set(given)
        if isinstance(type, ir.TargetType | ir.JointsType):
            order -= {"conf", "ext"}
        if not order <= set(given):
            return False
        for name, one in given.items():
            inner = component_type(type, name, self.scope)
            if isinstance(one, ir.Aggregate) and isinstance(inner, ir.NamedType) and not self.is_complete(one, inner):
                return False
        return True

    def known(self, value: ir.Expression) -> Value | None:
        """Its value, in a routine unless it is taught anew; data begins with a value."""
        return (constant if self.scope.routine_here is None else lasting)(value, self.scope)

    def is_constant(self, value: ir.Expression) -> bool:
        if isinstance(value, ir.Aggregate):
            return all(self.is_constant(one) for _, one in value.entries)
        return _is_literal(value) or _literal_of(self.known(value)) is not None

    def by_component(
        self, statement: ir.Assign, target: ir.Expression, value: ir.Aggregate, type: ir.Type
    ) -> list[ir.Statement]:
        name = base_name(statement.target)
        given = self.given(value, type)
        kept = {part for part, one in given.items() if _same_place(one, statement.target, part)}
        changed = tuple((part, one) for part, one in given.items() if part not in kept)
        value = replace(value, entries=changed)
        if name is not None and _mentions(value, name):
            copy = self.temporary(type)
            made = self.spread(copy, value, type)
            if kept or not self.is_complete(value, type):
                made.insert(0, ir.Assign(copy, target))
            return [*made, ir.Assign(target, copy)]
        return self.spread(target, value, type) or [ir.Nothing()]

    def spread(self, target: ir.Expression, value: ir.Aggregate, type: ir.Type) -> list[ir.Statement]:
        """One assignment for each component, and for each of what is inside where that cannot be a constant."""
        done = self.begun_joints(target, value, type)
        for name, one in self.given(value, type).items():
            inner = component_type(type, name, self.scope)
            place = ir.Field(target, _written(name, component_names(type, self.scope)))
            if isinstance(one, ir.Aggregate) and inner is not None and not isinstance(inner, _GEOMETRIC):
                if isinstance(inner, ir.ArrayType) and not self.whole_arrays:
                    done.extend(self.array(ir.Assign(place, one), place, one, inner))
                elif not self.is_constant(one) or not self.is_complete(one, inner):
                    done.extend(self.spread(place, one, inner))
                else:
                    done.append(ir.Assign(place, self.complete(one, inner)))
            else:
                done.append(ir.Assign(place, self.expression(one)))
        return done

    def begun_joints(self, target: ir.Expression, value: ir.Aggregate, type: ir.Type) -> list[ir.Statement]:
        """Joints that say that the place holds joints, where it could hold a pose until now."""
        if PlaceRule.UNTYPED not in self.context.capabilities.places.rules or not isinstance(type, ir.JointsType):
            return []
        if not self.is_complete(value, type):
            return []
        given = self.given(value, type)
        zero: ir.Expression = ir.RealLiteral(0.0)
        entries = tuple((name, zero) for name in given if name.startswith("j"))
        if "robax" in given:
            axes = tuple((name, zero) for name in ir.COMPONENTS[ir.AxesType])
            zero = ir.Aggregate(axes, type_name=type_word(ir.AxesType()))
            entries = (("robax", zero),)
        return [ir.Assign(target, ir.Aggregate(entries, type_name=type_word(type)))] if entries else []

    def array(
        self, statement: ir.Assign, target: ir.Expression, value: ir.Expression, type: ir.ArrayType
    ) -> list[ir.Statement]:
        """A whole array, element by element."""
        element = self.scope.resolve(type.element)
        if isinstance(value, ir.Aggregate):
            done: list[ir.Statement] = []
            for place, one, inner in self.elements(target, value, type):
                if isinstance(one, ir.Aggregate) and not isinstance(inner, _GEOMETRIC) and not self.is_constant(one):
                    done.extend(self.spread(place, one, inner))
                else:
                    done.append(ir.Assign(place, self.member(one, inner)))
            return done or [ir.Nothing()]
        counts = [constant(bound, self.scope) if bound is not None else None for bound in type.dimensions]
        if not all(isinstance(count, int) for count in counts) or isinstance(element, ir.StringType):
            return [replace(statement, target=target, value=self.expression(value))]
        counters = [self.temporary(ir.IntType(), "element") for _ in counts]
        source = self.expression(value)
        inner_body: ir.Statement = ir.Assign(ir.Index(target, tuple(counters)), ir.Index(source, tuple(counters)))
        for counter, count in reversed(list(zip(counters, counts, strict=True))):
            last = ir.IntLiteral(type.base + int(count) - 1) if isinstance(count, int) else ir.IntLiteral(1)
            inner_body = ir.For(counter.id, ir.IntLiteral(type.base), last, None, (inner_body,))
        return [inner_body]

    # ---- elsewhere

    def expression(self, expression: ir.Expression) -> ir.Expression:
        if not isinstance(expression, ir.Aggregate):
            return super().expression(expression)
        type = self.type_of(expression)
        if type is None or isinstance(type, ir.ArrayType | ir.ConfigType | ir.ExternalType | ir.AxesType):
            return super().expression(expression)
        if isinstance(type, _GEOMETRIC) or not self.constant or self.is_constant(expression):
            return self.arranged(expression, type, fill=False)
        if self.scope.routine_here is None:
            return self.arranged(expression, type, fill=False)
        copy = self.temporary(type)
        self.before.extend(self.spread(copy, expression, type))
        return copy


def _entries(value: ir.Expression) -> bool:
    return isinstance(value, ir.Aggregate) and bool(value.entries)


def _same_place(value: ir.Expression, target: ir.Expression, part: str) -> bool:
    """Does the member leave the component of the target as it is?"""
    return isinstance(value, ir.Field) and value.name.lower() == part and value.base == target


def _written(name: str, order: tuple[str, ...]) -> str:
    """A component as it is declared."""
    return next((one for one in order if one.lower() == name), name)


def _is_literal(value: ir.Expression) -> bool:
    if isinstance(value, ir.Unary) and value.op == "-":
        return _is_literal(value.operand)
    return isinstance(value, _LITERALS)


def _literal_of(value: Value | None) -> ir.Expression | None:
    """A literal for a simple value; structures are no literals here."""
    return literal(value) if isinstance(value, bool | int | float | str) else None


def _mentions(value: ir.Expression, name: str) -> bool:
    found = False

    def look(one: ir.Expression) -> ir.Expression:
        nonlocal found
        found = found or isinstance(one, ir.Call) or (isinstance(one, ir.Name) and one.id.lower() == name)
        return rewrite_parts(one, look)

    look(value)
    return found
