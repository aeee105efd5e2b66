"""Enumerations as whole-number constants, for targets without enumerations (RAPID).

Each member becomes a constant of its name (made unique where the name is taken otherwise), numbered from 1 in the order
of its declaration. A member that several enumerations share is one constant, so that a literal needs no context.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.passes.capabilities import Composite
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts


@legalising(unless=lambda context: Composite.ENUMS in context.capabilities.data.composites)
def enums_to_constants(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without enumerations."""
    numbering = _Numbering()
    for at, module in enumerate(program.modules):
        numbering.add(module.declarations, at)
        for routine in module.routines:
            numbering.add(routine.declarations, at)
    if not numbering.enums:
        return program
    numbering.settle()
    taken = _other_names(program)
    names: dict[str, str] = {}
    for key, written in numbering.written.items():
        names[key] = written if key not in taken else context.fresh(written)
    return _Enums(program, context, numbering, names).program()


@dataclass(slots=True)
class _Numbering:
    """The numbers of all members, folded; `shared` belong to several enumerations. `homes`: the module, counted from
    0, that declares a member first."""

    enums: list[ir.EnumDeclaration] = field(default_factory=list)
    written: dict[str, str] = field(default_factory=dict)
    shared: set[str] = field(default_factory=set)
    numbers: dict[str, int] = field(default_factory=dict)
    homes: dict[str, int] = field(default_factory=dict)

    def add(self, declarations: tuple[ir.Declaration, ...], module: int) -> None:
        for one in declarations:
            if isinstance(one, ir.EnumDeclaration):
                self.enums.append(one)
                for member in one.members:
                    key = member.lower()
                    if key in self.written:
                        self.shared.add(key)
                    self.written.setdefault(key, member)
                    self.homes.setdefault(key, module)

    def settle(self) -> None:
        """By position in the enumeration; where shared members would collide, all are numbered through."""
        for enum in self.enums:
            own = {self.numbers[m.lower()] for m in enum.members if m.lower() in self.numbers}
            free = (number for number in range(1, len(self.written) + len(own) + 1) if number not in own)
            for member in enum.members:
                if member.lower() not in self.numbers:
                    self.numbers[member.lower()] = next(free)
        for enum in self.enums:
            found = [self.numbers[member.lower()] for member in enum.members]
            if len(set(found)) != len({member.lower() for member in enum.members}):
                self.numbers = {key: number for number, key in enumerate(self.written, 1)}
                return


class _Enums(Rewriter):
    def __init__(self, program: ir.Program, context: Context, numbering: _Numbering, names: dict[str, str]) -> None:
        super().__init__(program, context)
        self.numbering, self.names = numbering, names
        self.used: set[str] = set()

    def program(self) -> ir.Program:
        done = super().program()
        shared = sorted(key for key in self.numbering.shared if key in self.used)
        modules = list(done.modules)
        for key in reversed(shared):  # each in front of the others
            at = self.numbering.homes[key]
            constant = self.constant(key, "global", ir.Nothing())
            modules[at] = replace(modules[at], declarations=(constant, *modules[at].declarations))
        return replace(done, modules=tuple(modules))

    def type(self, type: ir.Type) -> ir.Type:
        if isinstance(type, ir.NamedType):
            found = self.scope.type(type.name)
            return ir.IntType() if isinstance(found, ir.EnumDeclaration) else type
        return super().type(type)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.EnumLiteral(member=member):
                name = self.names.get(member.lower())
                self.used.add(member.lower())
                return expression if name is None else ir.Name(name, origin=expression.origin)
            case ir.Binary(left=left, right=right) if isinstance(left, ir.System) or isinstance(right, ir.System):
                # A mode of the controller is compared in neutral words.
                return rewrite_parts(expression, lambda e: e if isinstance(e, ir.EnumLiteral) else self.expression(e))
            case ir.Aggregate(type_name=word) if word and isinstance(self.scope.type(word), ir.EnumDeclaration):
                return rewrite_parts(replace(expression, type_name=None), self.expression)
        return super().expression(expression)

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        match statement:
            case ir.Assign(target=ir.System(), value=ir.EnumLiteral()):
                return [statement]
            case ir.Move(settings=settings) if settings:
                done = super().statement(replace(statement, settings=()))
                kept = tuple(
                    (place, value if isinstance(value, ir.EnumLiteral) else self.expression(value))
                    for place, value in settings
                )
                return [replace(one, settings=kept) if isinstance(one, ir.Move) else one for one in done]
        return super().statement(statement)

    def declaration(self, declaration: ir.Declaration) -> list[ir.Declaration]:
        if isinstance(declaration, ir.EnumDeclaration):
            own = [member.lower() for member in declaration.members if member.lower() not in self.numbering.shared]
            if not own:
                return [ir.Unread("", origin=declaration.origin)] if declaration.origin.comments else []
            later = replace(declaration.origin, comments=())
            return [
                self.constant(key, declaration.scope, replace(declaration, origin=later) if at else declaration)
                for at, key in enumerate(own)
            ]
        return super().declaration(declaration)

    def constant(self, key: str, scope: str, place: ir.EnumDeclaration | ir.Nothing) -> ir.Variable:
        number = ir.IntLiteral(self.numbering.numbers[key])
        return ir.Variable(self.names[key], ir.IntType(), number, "constant", scope, origin=place.origin)


def _other_names(program: ir.Program) -> set[str]:
    """All declared names but the members of enumerations."""
    taken: set[str] = set()

    def add(declarations: tuple[ir.Declaration, ...]) -> None:
        for one in declarations:
            if not isinstance(one, ir.Initialise | ir.Unread | ir.EnumDeclaration):
                taken.add(one.name.lower())

    for module in program.modules:
        taken.add(module.name.lower())
        add(module.declarations)
        for routine in module.routines:
            taken.add(routine.name.lower())
            taken.update(parameter.name.lower() for parameter in routine.parameters)
            add(routine.declarations)
    return taken
