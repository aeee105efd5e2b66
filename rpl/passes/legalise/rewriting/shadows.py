"""Variables that keep what a setting of the controller was last set to, for targets that cannot be asked for it: each
statement that sets it sets the variable as well, and whoever reads the setting reads the variable.

Before the first setting the variable holds what the source's controller starts with.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.rewriting.editing import edit_all, expansion, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.rewrite import rewrite_parts

_AXES = 6
NO_SHIFT = ir.Aggregate(tuple((part, ir.RealLiteral(0.0)) for part in ir.POSE), "pose")


@dataclass(frozen=True, slots=True)
class Shadow:
    """The variable of one setting. first: what it holds before the setting is set for the first time. A setting of
    single axes has an array of them."""

    name: ir.Name
    first: ir.Expression
    of_axes: bool = False

    @property
    def variable(self) -> ir.Variable:
        type: ir.Type = ir.RealType()
        if isinstance(self.first, ir.Aggregate) or self.first == ir.System("null_frame"):
            type = ir.PoseType()
        if self.of_axes:
            type = ir.ArrayType(type, (ir.IntLiteral(_AXES),))
            return ir.Variable(self.name.id, type, ir.Aggregate(((None, self.first),) * _AXES), scope="global")
        return ir.Variable(self.name.id, type, self.first, scope="global")

    def place(self, setting: ir.System) -> ir.Expression:
        """The variable, or its element, that stands for a setting."""
        name = replace(self.name, origin=setting.origin)
        return ir.Index(name, setting.indices, origin=setting.origin) if self.of_axes else name

    def beside(self, statement: ir.Assign) -> ir.Body:
        """What sets the setting, with the variable set in front of it. The value is worked out once."""
        assert isinstance(statement.target, ir.System)
        place, given = self.place(statement.target), statement.value
        twice = not any(isinstance(node, ir.Call) or node == self.name for node in walk(given))
        setting = statement if twice else replace(statement, value=place)
        return expansion(statement.origin, (ir.Assign(place, _plain(given)), setting))


def with_shadows(program: ir.Program, context: Context, shadows: Mapping[str, Shadow], read: bool = True) -> ir.Program:
    """The program with these variables beside the settings of these names. read: whoever reads the setting reads the
    variable; without it, only what names the variable does."""
    if not shadows:
        return program

    def value(expression: ir.Expression) -> ir.Expression:
        done = rewrite_parts(expression, value)
        shadow = shadows.get(done.name) if isinstance(done, ir.System) else None
        return done if shadow is None or not isinstance(done, ir.System) else shadow.place(done)

    def change(statement: ir.Statement) -> ir.Body:
        target = statement.target if isinstance(statement, ir.Assign) else None
        if not isinstance(statement, ir.Assign) or not isinstance(target, ir.System):
            return (entered(statement),)
        if read:
            indices = tuple(value(index) for index in target.indices)
            statement = replace(statement, target=replace(target, indices=indices), value=value(statement.value))
        shadow = shadows.get(target.name)
        return (statement,) if shadow is None else shadow.beside(statement)

    def inner(body: ir.Body) -> ir.Body:
        return map_body(body, change)

    def entered(statement: ir.Statement) -> ir.Statement:
        return rewrite_parts(statement, value, inner) if read else inside(statement, inner)

    program = edit_all(program, inner)
    data = [shadow.variable for shadow in shadows.values()]
    return with_support(program, context, data, (), program.modules[0].task)


def _plain(value: ir.Expression) -> ir.Expression:
    """A quantity as the plain number that the variable keeps."""
    if not isinstance(value, ir.Quantity):
        return value
    return ir.Binary("*", value.value, ir.RealLiteral(ir.UNITS[value.unit]), origin=value.origin)


def only_served(program: ir.Program, variables: Collection[str]) -> ir.Program:
    """The program without what sets one of these variables in vain: where each reader stands close behind a statement
    that sets what it reads, all other statements that set the variable say nothing. The passes that make such a
    variable set it at every change, as they do not know yet which moves will read it."""
    for name in variables:
        program = _without(program, name)
    return program


def _without(program: ir.Program, name: str) -> ir.Program:
    nodes = [node for module in program.modules for node in walk(*module.routines)]
    stores = sum(_stores(node, name) for node in nodes)
    reads = sum(isinstance(node, ir.Name) and node.id == name for node in nodes) - stores
    needed: set[int] = set()
    served = 0
    for node in nodes:
        parts: Iterator[ir.Body] = iter(())
        if isinstance(node, ir.Routine):
            parts = iter(bodies(node))
        elif isinstance(node, ir.Statement):
            parts = iter(blocks(node))
        for body in parts:
            served += _served(body, name, needed)
    if served != reads or len(needed) == stores:
        return program

    def change(body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        for one in body:
            if not _stores(one, name) or id(one) in needed:
                done.append(inside(one, change))
            elif one.origin.comments:
                done.append(ir.Nothing(origin=one.origin))
        same = len(done) == len(body) and all(new is old for new, old in zip(done, body, strict=True))
        return body if same else tuple(done)

    return edit_all(program, change)


def _stores(node: object, name: str) -> bool:
    match node:
        case ir.Assign(target=ir.Name(id=place)):
            return place == name
    return False


def _served(body: ir.Body, name: str, needed: set[int]) -> int:
    """How often statements of this block read what an earlier one of it has set for sure; those are `needed`."""
    last: ir.Statement | None = None
    count = 0
    for statement in body:
        stores = _stores(statement, name)
        nodes = list(walk(statement))
        if isinstance(statement, ir.Label) or sum(isinstance(node, ir.Statement) for node in nodes) > 1:
            last = None  # a jump may come here; blocks, and actions that run later
            continue
        found = sum(isinstance(node, ir.Name) and node.id == name for node in nodes) - stores
        if found and last is not None:
            count += found
            needed.add(id(last))
        if stores:
            last = statement
        elif any(isinstance(node, ir.CallRoutine | ir.Call) for node in nodes):
            last = None
    return count


__all__ = ["NO_SHIFT", "Shadow", "only_served", "with_shadows"]
