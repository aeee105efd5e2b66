"""Signals that several reactions share, one after the other: V+ keeps one reaction for each signal, so REACT replaces
the one before and IGNORE takes away whichever there is. The neutral interrupts get an identity for each reaction; what
another one is replaced by, or taken away by, is written down. Where every program takes its own away again, nothing is
left to replace.

A reaction is over when it has come (user's guide, example of program interrupts: the reaction program enables itself
again). One whose program does that before any time has passed is an interrupt that comes again and again.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.rewrite import rewrite_parts

from .expressions import significant

# Identities of the further reactions to a signal; its own number is that of the first one.
_STEP = 10_000


@dataclass(frozen=True, slots=True)
class _Shared:
    """The reactions to one signal, in the order of the texts; `left`: can one be there when a program begins?"""

    variants: tuple[ir.DeclareInterrupt, ...]
    left: bool

    def identity(self, number: int, at: int) -> ir.IntLiteral:
        return ir.IntLiteral(number + (_STEP * at if number > 0 else -_STEP * at))


def come_once(modules: tuple[ir.Module, ...]) -> tuple[ir.Module, ...]:
    """The modules with `once` at the reactions whose program does not enable them again at once."""
    bodies = {significant(routine.name): routine.body for module in modules for routine in module.routines}

    def change(node: object) -> object:
        match node:
            case ir.DeclareInterrupt(action=ir.CallRoutine(name=name)):
                return node if _enables(bodies.get(significant(name), ()), node) else replace(node, once=True)
        return node

    return tuple(
        replace(module, routines=tuple(rewrite(routine, change) for routine in module.routines))
        if any(isinstance(node, ir.DeclareInterrupt) for node in walk(module))
        else module
        for module in modules
    )


def _enables(body: ir.Body, reaction: ir.DeclareInterrupt) -> bool:
    """Does the program come to the same REACT before anything that takes time or may lead elsewhere?"""
    for statement in body:
        if statement == reaction:
            return True
        if not isinstance(statement, ir.Assign | ir.Nothing | ir.Message | ir.DeclareInterrupt | ir.ControlInterrupt):
            return False
    return False


def told_apart(modules: tuple[ir.Module, ...]) -> tuple[ir.Module, ...]:
    """The modules with an identity for each reaction."""
    found: dict[int, list[ir.DeclareInterrupt]] = {}
    for node in walk(*modules):
        match node:
            case ir.DeclareInterrupt(identity=ir.IntLiteral(value=number)):
                known = found.setdefault(number, [])
                if node not in known:
                    known.append(node)
    several = {number for number, known in found.items() if len(known) > 1}
    if not several:
        return modules
    bodies = [routine.body for module in modules for routine in module.routines]
    shared = {
        number: _Shared(tuple(found[number]), not all(_balanced(body, number) for body in bodies)) for number in several
    }
    return tuple(
        replace(
            module,
            routines=tuple(replace(one, body=_Body(shared).body(one.body)) for one in module.routines),
        )
        for module in modules
    )


def _number(node: object) -> int | None:
    """The signal that a statement declares a reaction to, or controls."""
    match node:
        case ir.DeclareInterrupt(identity=ir.IntLiteral(value=number)):
            return number
        case ir.ControlInterrupt(op="on" | "delete", handle=ir.IntLiteral(value=number)):
            return number
    return None


def _balanced(body: ir.Body, number: int) -> bool:
    """Does the program take away, step by step, what it declares?"""
    active = False
    for statement in body:
        if _number(statement) == number:
            taken = isinstance(statement, ir.ControlInterrupt) and statement.op == "delete"
            active = isinstance(statement, ir.DeclareInterrupt) or (active and not taken)
        elif any(_number(node) == number for node in walk(statement)):
            return False
    return not active


class _Body:
    """The steps of one program. `there`: the reactions that a signal can have at this place."""

    def __init__(self, shared: dict[int, _Shared]) -> None:
        self.shared = shared
        self.there = {
            number: set(range(len(one.variants))) if one.left else set[int]() for number, one in shared.items()
        }

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        declared: dict[int, int] = {}
        for statement in body:
            number = _number(statement)
            shared = self.shared.get(number) if number is not None else None
            if shared is None or number is None:
                done.append(self.inside(statement))
                continue
            match statement:
                case ir.DeclareInterrupt():
                    at = shared.variants.index(statement)
                    later = replace(statement.origin, comments=())
                    for other in sorted(self.there[number] - {at}):
                        done.append(ir.ControlInterrupt("delete", shared.identity(number, other), origin=later))
                    done.append(replace(statement, identity=shared.identity(number, at)))
                    self.there[number], declared[number] = {at}, at
                case ir.ControlInterrupt(op="on"):
                    done.append(replace(statement, handle=shared.identity(number, declared.get(number, 0))))
                case ir.ControlInterrupt():
                    origin = statement.origin
                    # What a reaction's own program takes away is any of them: none has been declared there.
                    for other in sorted(self.there[number]) or range(len(shared.variants)):
                        identity = shared.identity(number, other)
                        done.append(replace(statement, handle=identity, origin=origin))
                        origin = replace(origin, comments=())
                    self.there[number] = set()
        return tuple(done)

    def inside(self, statement: ir.Statement) -> ir.Statement:
        """A block, or a call: behind it any reaction can be there that was left."""
        changed = rewrite_parts(statement, lambda value: value, self.body)
        if changed is not statement or isinstance(statement, ir.CallRoutine):
            for number, one in self.shared.items():
                if one.left:
                    self.there[number] = set(range(len(one.variants)))
        return changed


__all__ = ["come_once", "told_apart"]
