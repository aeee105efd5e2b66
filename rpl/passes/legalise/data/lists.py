"""Lists that are written out inside of an expression, for targets that write a list only where it is stored.

An argument `f([1, n, 3])` and an element of a list, `[5, 7, 9][i]`, become a variable of the routine that gets the list
in front of the statement: behind what is evaluated earlier, inside of the branch that needs it, again in each pass.
Whole lists are compared element by element.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import product

from rpl import ir
from rpl.passes.capabilities import Passing
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.bodies import Hoister, Lowered
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.stages import legalising

# What may take a list: a call, a function, an element, a comparison.
_ACTS_ON = frozenset(("CallRoutine", "Call", "Index", "Builtin", "operator =", "operator <>"))


@legalising(sees=_ACTS_ON)
def lists_in_variables(program: ir.Program, context: Context) -> ir.Program:
    """The program with lists only where they are stored, or where the target takes them as arguments."""

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, _Lists(editor).body)

    return edit_routines(program, context, work, _ACTS_ON)


class _Lists(Hoister):
    """`wanted`: types of lists in the expressions at hand that have to be stored, by the identity of their nodes."""

    acts_on = _ACTS_ON

    def __init__(self, editor: Editor) -> None:
        super().__init__(editor, lambda _: None)
        self.wanted: dict[int, ir.ArrayType] = {}

    def placed(self, statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.CallRoutine) and statement.dynamic is None:
            self.note(statement.name, statement.arguments)
        return super().placed(statement)

    def lower(self, expression: ir.Expression, lvalue: bool = False) -> Lowered:
        match expression:
            case ir.Call(name=name, arguments=arguments):
                self.note(name, arguments)
            case ir.Index(base=ir.Aggregate() as base):
                self.want(base, self.own_type(base))
            case ir.Builtin(arguments=arguments):
                for argument in arguments:
                    if isinstance(argument, ir.Aggregate):
                        self.want(argument, self.own_type(argument))
            case ir.Aggregate() if (type := self.wanted.pop(id(expression), None)) is not None:
                before, value = super().lower(expression)
                kept = self.editor.temporary("list", type)
                return (*before, ir.Assign(kept, value)), kept
            case ir.Binary(op="=" | "<>") if (type := self.compared(expression)) is not None:
                return self.comparison(expression, type)
        return super().lower(expression, lvalue)

    def compared(self, expression: ir.Binary) -> ir.ArrayType | None:
        """The type of the lists that are compared, when one of them has a type with known bounds."""
        found = [self.editor.type_of(side) for side in (expression.left, expression.right)]
        return next((one for one in found if isinstance(one, ir.ArrayType) and _bounds(one)), None)

    def comparison(self, expression: ir.Binary, type: ir.ArrayType) -> Lowered:
        """`a = b` as `a[0] = b[0] and a[1] = b[1] ...`; a list whose members do something is stored first."""
        for side in (expression.left, expression.right):
            if isinstance(side, ir.Aggregate) and not self.editor.effects.quiet(side):
                self.want(side, sized(type, side))
        before, (left, right) = self.several((expression.left, expression.right), (False, False))
        pairs = [*self.elements(left, type)], [*self.elements(right, type)]
        if len(pairs[0]) != len(pairs[1]) or not pairs[0]:
            same_size = len(pairs[0]) == len(pairs[1])
            return before, ir.BoolLiteral(same_size == (expression.op == "="), origin=expression.origin)
        same = [ir.Binary(expression.op, *pair) for pair in zip(*pairs, strict=True)]
        joined: ir.Expression = same[0]
        for one in same[1:]:
            joined = ir.Binary("and" if expression.op == "=" else "or", joined, one)
        return before, replace(joined, origin=expression.origin)

    def elements(self, value: ir.Expression, type: ir.ArrayType) -> Iterator[ir.Expression]:
        """Every element of a list, row by row. `type`: of a list with which it is compared."""
        own = self.editor.type_of(value)
        if not isinstance(value, ir.Aggregate):
            own = own if isinstance(own, ir.ArrayType) and _bounds(own) else type
            ranges = [range(own.base, last + 1) for last in _bounds(own) or ()]
            for place in product(*ranges):
                yield ir.Index(value, tuple(map(ir.IntLiteral, place)))
        elif type.dimensions[1:]:
            inner = replace(type, dimensions=type.dimensions[1:])
            for _, one in value.entries:
                yield from self.elements(one, inner)
        else:
            yield from (one for _, one in value.entries)

    def note(self, name: str, arguments: Sequence[ir.Argument]) -> None:
        """Lists among the arguments of a call of the program's own routine."""
        routine = self.editor.scope.routine(name)
        if routine is None or Passing.WRITTEN_LISTS in self.editor.capabilities.routines.passing:
            return
        fold = self.editor.scope.fold
        named = {fold(parameter.name): parameter for parameter in routine.parameters}
        in_order = iter([parameter for parameter in routine.parameters if not parameter.optional])
        for argument in arguments:
            parameter = named.get(fold(argument.name)) if argument.name is not None else next(in_order, None)
            if parameter is not None and isinstance(argument.value, ir.Aggregate):
                type = self.editor.scope.resolve(parameter.type)
                self.want(argument.value, sized(type, argument.value) if isinstance(type, ir.ArrayType) else None)

    def want(self, value: ir.Aggregate, type: ir.ArrayType | None) -> None:
        if type is not None:
            self.wanted[id(value)] = type

    def own_type(self, value: ir.Aggregate) -> ir.ArrayType | None:
        """The type of a list that nothing but its members tells; None when it is no list, or they differ."""
        if value.type_name or not value.entries or any(name is not None for name, _ in value.entries):
            return None
        element = _common(self.editor.type_of(one) for _, one in value.entries)
        base = self.editor.scope.rules.array_base
        return None if element is None else ir.ArrayType(element, (_last(value, base),), base)


def _bounds(type: ir.ArrayType) -> tuple[int, ...] | None:
    """The upper bounds, when all are written as numbers."""
    found = tuple(one.value for one in type.dimensions if isinstance(one, ir.IntLiteral))
    return found if len(found) == len(type.dimensions) else None


def _common(types: Iterable[ir.Type | None]) -> ir.Type | None:
    found = set(types)
    if found and found <= {ir.IntType(), ir.RealType()}:
        return ir.RealType() if ir.RealType() in found else ir.IntType()
    return found.pop() if len(found) == 1 else None


def sized(type: ir.ArrayType, value: ir.Expression) -> ir.ArrayType:
    """The type of a parameter with the bounds that this list has where the parameter leaves them open."""
    bounds: list[ir.Expression | None] = []
    for bound in type.dimensions:
        bounds.append(bound if bound is not None or not isinstance(value, ir.Aggregate) else _last(value, type.base))
        value = value.entries[0][1] if isinstance(value, ir.Aggregate) and value.entries else value
    return ir.ArrayType(type.element, tuple(bounds), type.base)


def _last(value: ir.Aggregate, base: int) -> ir.Expression:
    """The upper bound of a list whose elements are numbered from `base`."""
    return ir.IntLiteral(base + len(value.entries) - 1)
