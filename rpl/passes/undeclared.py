"""Data that a program uses and that nothing in the project declares, declared by how it is used.

A backup that is not whole lacks modules; what its programs do with the data of those says what it must be: a truth
where it decides a branch, a place where a move goes to it, an array where it has an index, a record where it has
components, else what it is compared with, assigned to or handed over as. What nothing tells is a number. The
declarations stand in a module of their own and give no value: nobody knows it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.ir.walk import bodies, walk
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typerules import BOOL, INT, LOGIC, REAL
from rpl.passes.typing import normalise, type_of
from rpl.source import NOWHERE, Origin

MODULE = "not declared"  # no language has such a name
# Elements of an array of which some index is worked out while the program runs, by how many dimensions it has.
_GUESSED = {1: 256, 2: 32}
_GUESSED_MORE = 8
_PLACE = frozenset((*ir.POSE, "s", "t", "e1", "e2", "e3", "e4", "e5", "e6"))
_JOINTS = frozenset(("a1", "a2", "a3", "a4", "a5", "a6", "e1", "e2", "e3", "e4", "e5", "e6"))
_POSE_PARTS = frozenset(ir.POSE)


def declared_by_use(program: ir.Program, only: Collection[str] | None = None) -> ir.Program:
    """The normalised program with declarations, without values, for what nothing declares. only: the names, folded,
    that are wanted (None: all)."""
    scopes = ProgramScope(program)
    uses: dict[str, _Uses] = {}
    for module, routine in scopes.routines():
        scope = scopes.routine(module, routine)
        found = uses.setdefault(module.dialect, _Uses(module.dialect))
        found.look(routine, scope)
    made = [new for one in uses.values() if (new := one.module(only)) is not None]
    if not made:
        return program
    return normalise(replace(program, modules=(*program.modules, *made)), Diagnostics())


@dataclass(slots=True)
class _Shape:
    """What the uses of a datum, of its elements or of a component say of it. `guessed`: dimensions of which some index
    is worked out."""

    origin: Origin = NOWHERE
    types: list[ir.Type] = field(default_factory=list)
    members: dict[str, None] = field(default_factory=dict)
    fields: dict[str, _Shape] = field(default_factory=dict)
    element: _Shape | None = None
    sizes: list[int] = field(default_factory=list)
    guessed: set[int] = field(default_factory=set)
    base: int = 1

    def indexed(self, indices: tuple[ir.Expression, ...]) -> _Shape:
        """The shape of its elements."""
        self.sizes += [1] * (len(indices) - len(self.sizes))
        for number, index in enumerate(indices):
            match index:
                case ir.IntLiteral(value=value):
                    self.sizes[number] = max(self.sizes[number], value)
                    self.base = min(self.base, value)
                case _:
                    self.guessed.add(number)
        if self.element is None:
            self.element = _Shape(self.origin)
        return self.element


class _Uses:
    """What the routines of one language use and nothing declares: data by name, and types that declared data is of."""

    def __init__(self, language: str) -> None:
        self.language = language
        self.data: dict[str, tuple[str, _Shape]] = {}
        self.types: dict[str, tuple[str, _Shape]] = {}

    def look(self, routine: ir.Routine, scope: Scope) -> None:
        for node in walk(*bodies(routine)):
            self.node(node, routine, scope)

    def node(self, node: object, routine: ir.Routine, scope: Scope) -> None:
        match node:
            case ir.Name() | ir.Field():
                self.shape(node, scope)
            case ir.Index(indices=indices):
                self.shape(node, scope)
                self.all(indices, INT, scope)
            case ir.If(branches=branches):
                self.all(tuple(condition for condition, _ in branches), BOOL, scope)
            case ir.While(condition=condition) | ir.Repeat(until=condition) | ir.WaitUntil(condition=condition):
                self.all((condition,), BOOL, scope)
            case ir.DeclareInterrupt(condition=condition) | ir.Unary(op="not", operand=condition):
                self.all((condition,), BOOL, scope)
            case ir.Binary(op=op, left=left, right=right) if op in LOGIC or op == ":":
                self.all((left, right), ir.PoseType() if op == ":" else BOOL, scope)
            case ir.Binary(left=left, right=right) | ir.Assign(target=left, value=right):
                self.meet(left, right, scope)
            case ir.Switch(selector=selector, cases=cases):
                for value in (value for case in cases for value in case.values):
                    self.meet(selector, value, scope)
            case ir.For(counter=counter, start=start, stop=stop, scoped=scoped):
                self.all((start, stop, *(() if scoped else (ir.Name(counter),))), INT, scope)
            case ir.Move(target=target, via=via, relative=None):
                self.all((target, *((via,) if via is not None else ())), ir.TargetType(self.language), scope)
            case ir.Signal(index=index, last=last):
                self.all(tuple(one for one in (index, last) if one is not None), INT, scope)
            case ir.Wait(time=time):
                self.all((time,), REAL, scope)
            case ir.CallRoutine(name=name, arguments=arguments) | ir.Call(name=name, arguments=arguments):
                self.handed(name, arguments, scope)
            case ir.Return(value=value) if value is not None and routine.returns is not None:
                self.all((value,), routine.returns, scope)

    def handed(self, name: str, arguments: tuple[ir.Argument, ...], scope: Scope) -> None:
        called = scope.routine(name)
        if called is not None:
            for parameter, argument in zip(called.parameters, arguments, strict=False):
                if argument.value is not None and argument.name is None:
                    self.all((argument.value,), parameter.type, scope)

    def all(self, expressions: tuple[ir.Expression, ...], type: ir.Type, scope: Scope) -> None:
        for one in expressions:
            self.expect(one, type, scope)

    def expect(self, expression: ir.Expression, type: ir.Type | None, scope: Scope) -> None:
        """The expression is used as one of that type."""
        while isinstance(expression, ir.Convert):
            expression = expression.operand
        shape = self.shape(expression, scope)
        if shape is not None and type is not None:
            shape.types.append(scope.resolve(type))

    def meet(self, left: ir.Expression, right: ir.Expression, scope: Scope) -> None:
        """Both are of one type: what is known of one tells the other."""
        for one, other in ((left, right), (right, left)):
            shape = self.shape(one, scope)
            if shape is None:
                continue
            match other:
                case ir.EnumLiteral(member=member) if scope.enum_of(member) is None:
                    shape.members[member] = None
                case ir.Aggregate(entries=entries) if all(name is not None for name, _ in entries):
                    for name, value in entries:
                        part = shape.fields.setdefault(scope.fold(name or ""), _Shape(shape.origin))
                        part.types += [known] if (known := type_of(value, scope)) is not None else []
                case _:
                    self.expect(one, type_of(other, scope), scope)

    def shape(self, expression: object, scope: Scope) -> _Shape | None:
        """Of a place whose root nothing declares, or whose type nothing does; None for any other."""
        if not isinstance(expression, ir.Name | ir.Index | ir.Field):
            return None
        match expression:
            case ir.Name(id=name, origin=origin):
                if scope.value(name) is None:
                    return self.data.setdefault(scope.fold(name), (name, _Shape(origin)))[1]
            case ir.Index(base=base, indices=indices):
                outer = self.shape(base, scope)
                if outer is not None and outer.element is None and outer.fields:
                    return outer  # a record is no array: the name of a type whose declaration is not there
                if outer is not None:
                    return outer.indexed(indices)
            case ir.Field(base=base, name=name):
                outer = self.shape(base, scope)
                if outer is not None:
                    return outer.fields.setdefault(scope.fold(name), _Shape(outer.origin))
        type = type_of(expression, scope)
        if isinstance(type, ir.NamedType) and scope.type(type.name) is None:
            return self.types.setdefault(scope.fold(type.name), (type.name, _Shape(expression.origin)))[1]
        return None

    # ---- what they come to

    def module(self, only: Collection[str] | None) -> ir.Module | None:
        """The declarations; None when there are none to make."""
        wanted = {key: one for key, one in self.data.items() if only is None or key.lower() in only}
        kinds: list[ir.Declaration] = []
        variables = [
            ir.Variable(name, self.type(name, shape, kinds), None, "persistent", "global", origin=shape.origin)
            for name, shape in wanted.values()
        ]
        if only is None or wanted:
            for name, shape in self.types.values():
                self.declared(name, shape, kinds)
        if not (variables or kinds):
            return None
        return ir.Module(MODULE, self.language, (*kinds, *variables), public=True)

    def declared(self, name: str, shape: _Shape, kinds: list[ir.Declaration]) -> None:
        """A type that data is of and nothing declares."""
        if shape.fields:
            fields = tuple((key, self.type(f"{name}.{key}", one, kinds)) for key, one in shape.fields.items())
            kinds.append(ir.RecordDeclaration(name, fields, "global", origin=shape.origin))
        elif shape.members:
            kinds.append(ir.EnumDeclaration(name, tuple(shape.members), "global", origin=shape.origin))
        else:
            kinds.append(ir.AliasDeclaration(name, self.plain(shape), "global", origin=shape.origin))

    def type(self, name: str, shape: _Shape, kinds: list[ir.Declaration]) -> ir.Type:
        """The type that the uses come to; records and enumerations on the way are declared."""
        if shape.element is not None:
            element = self.type(f"{name}[]", shape.element, kinds)
            count = len(shape.sizes)
            least = _GUESSED.get(count, _GUESSED_MORE)
            sizes = [max(size, least) if at in shape.guessed else size for at, size in enumerate(shape.sizes)]
            return ir.ArrayType(element, tuple(ir.IntLiteral(size) for size in sizes), shape.base)
        if shape.fields:
            names = {key.lower() for key in shape.fields}
            if names <= _JOINTS and not names <= _PLACE:
                return ir.JointsType()
            if names <= _PLACE:
                seen = self.plain(shape)
                place = ir.PoseType() if names <= _POSE_PARTS else ir.TargetType(self.language)
                return seen if isinstance(seen, ir.TargetType | ir.PoseType | ir.JointsType) else place
            self.declared(f"type of {name}", shape, kinds)
            return ir.NamedType(f"type of {name}")
        if shape.members:
            self.declared(f"type of {name}", shape, kinds)
            return ir.NamedType(f"type of {name}")
        return self.plain(shape)

    def plain(self, shape: _Shape) -> ir.Type:
        """Of a datum without parts: what is no number rather than a number, a real one rather than a whole one."""
        return min(shape.types, key=_rank, default=REAL)


def _rank(type: ir.Type) -> int:
    match type:
        case ir.RealType():
            return 1
        case ir.IntType():
            return 2
        case ir.ArrayType():
            return 3
    return 0


def made_modules(program: ir.Program) -> Iterator[ir.Module]:
    """The modules that `declared_by_use` has added."""
    return (module for module in program.modules if module.name == MODULE)


__all__ = ["MODULE", "declared_by_use", "made_modules"]
