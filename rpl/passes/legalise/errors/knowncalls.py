"""Calls of the source's own routines (its prelude) where everything that decides what they do is known.

`BAS(#PTP_PARAMS,50)` is the six or ten settings that it makes with the data in force, and `STOOL2(FPick)` is
`TOOL_DATA[1]`: branches are decided, short loops written out, arguments and data put in. Tools, frames and places stay
names, for they are taught anew. A call that waits, moves or asks, or where something is not known, stays.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.fold import constant, literal
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.mentioned import is_linked
from rpl.passes.legalise.facts.usage import base_name
from rpl.passes.legalise.facts.values.heldvalues import Held, HeldValues, KnownData, component
from rpl.passes.legalise.rewriting.editing import edit_bodies, expansion, map_body
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.scope import Scope
from rpl.passes.values import Value

_LONGEST = 40  # statements that stand for a call
_MOST_PASSES = 64  # of a loop that is written out
_DEEPEST = 12  # calls in calls
# What an argument or a variable of the routine may be made of, to stand where the routine names it.
_HOLDABLE = (ir.IntLiteral, ir.RealLiteral, ir.BoolLiteral, ir.TextLiteral, ir.EnumLiteral, ir.Name, ir.Field,
             ir.Index, ir.Unary, ir.Binary, ir.Convert, ir.Aggregate)  # fmt: skip
_FIXED = (ir.System("null_frame"), ir.System("world"))
_SCALARS = (ir.IntLiteral, ir.RealLiteral, ir.BoolLiteral, ir.TextLiteral, ir.EnumLiteral)
Locals = dict[str, "ir.Expression | None"]  # folded name -> what it stands for; None: nothing yet


class _OpenError(Exception):
    """What the routine does is not known here."""


@dataclass(slots=True)
class _Frame:
    """One call that is followed: what its names stand for, and the value that it returns."""

    scope: Scope
    locals: Locals
    depth: int
    result: ir.Expression | None = None


@dataclass(slots=True)
class _Effects:
    """What the calls of one statement do, and what is held behind that."""

    held: dict[str, ir.Expression]
    done: list[ir.Statement] = field(default_factory=list)
    open_choices: int = 0


@legalising()
def known_calls(program: ir.Program, context: Context) -> ir.Program:
    """The program with these calls as what they do; calls inside of the prelude's routines stay."""
    linked = [module for module in program.modules if is_linked(module, context)]
    routines = {id(one): (one, module) for module in linked for one in module.routines}
    if not routines:
        return program
    known = KnownData.of(program)
    own = {one.name.lower() for module in linked for one in module.declarations if isinstance(one, ir.Variable)}
    values = HeldValues.of(known, own & known.assigned)
    calls = _Calls(known, values, routines)

    def edited(module: ir.Module, routine: ir.Routine) -> ir.Routine:
        calls.scope = known.scopes.routine(module, routine)
        return edit_bodies(routine, calls.body)

    def whole(module: ir.Module) -> ir.Module:
        if is_linked(module, context):
            return module
        return replace(module, routines=tuple(edited(module, routine) for routine in module.routines))

    return replace(program, modules=tuple(map(whole, program.modules)))


class _Calls:
    """Puts what calls do in their place, body by body."""

    scope: Scope

    def __init__(
        self, known: KnownData, values: HeldValues, routines: Mapping[int, tuple[ir.Routine, ir.Module]]
    ) -> None:
        self.known, self.values, self.routines = known, values, routines
        # Forms repeat: what a call does by the scope where it stands, the call, and what is held in front of it.
        self.found: dict[tuple[Scope, ir.CallRoutine, tuple[object, ...]], ir.Body | None] = {}

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def statement(self, statement: ir.Statement) -> ir.Body:
        held = self.values.before(statement)
        if isinstance(statement, ir.CallRoutine):
            key = self.scope, statement, tuple(held.items())
            if key not in self.found:
                self.found[key] = self.made(statement, held)
            done = self.found[key]
            if done is not None:
                done = tuple(replace(one, origin=statement.origin) for one in done)
                return expansion(statement.origin, done) or (ir.Nothing(origin=statement.origin),)
        return (rewrite_parts(statement, lambda one: self.expression(one, held), self.body),)

    def made(self, call: ir.CallRoutine, held: Held) -> ir.Body | None:
        """What a call of a procedure does, as statements of the place where it stands."""
        effects = _Effects(dict(held))
        try:
            outside = _Frame(self.scope, {}, 0)
            self.run(call, outside, effects)
        except _OpenError:
            return None
        done = effects.done
        if len(done) > _LONGEST or effects.open_choices > 1:
            return None
        return tuple(done)

    def expression(self, one: ir.Expression, held: Held) -> ir.Expression:
        """An expression of the program with the values of functions in it."""
        match one:
            case ir.Call() if self.routine(one, self.scope) is not None:
                effects = _Effects(dict(held))
                try:
                    value = self.run(one, _Frame(self.scope, {}, 0), effects)
                except _OpenError:
                    value = None
                if value is not None and not effects.done:
                    return replace(value, origin=one.origin)
        done = rewrite_parts(one, lambda part: self.expression(part, held))
        if isinstance(done, ir.Field) and done is not one and isinstance(done.base, ir.Aggregate):
            return component(done.base, done.name) or done
        return done

    def routine(self, call: ir.Call | ir.CallRoutine, scope: Scope) -> tuple[ir.Routine, ir.Module] | None:
        """The routine of the prelude that a call means."""
        if isinstance(call, ir.CallRoutine) and call.dynamic is not None:
            return None
        meant = scope.routine(call.name)
        return None if meant is None else self.routines.get(id(meant))

    def seen(self, name: str, frame: _Frame) -> None:
        """A name of the routine that is left in what the call does has to mean the same at the place of the call."""
        here, there = self.scope.value(name), frame.scope.value(name)
        if here is None or there is None or here.declaration is not there.declaration:
            raise _OpenError

    # ---- following one call

    def run(self, call: ir.Call | ir.CallRoutine, outer: _Frame, effects: _Effects) -> ir.Expression | None:
        """Follow a call; what a function returns."""
        found = self.routine(call, outer.scope)
        if found is None or outer.depth >= _DEEPEST:
            raise _OpenError
        routine, module = found
        if routine.handlers or routine.undo or routine.open_ended or len(call.arguments) > len(routine.parameters):
            raise _OpenError
        given: Locals = {
            one.name.lower(): None
            for one in (*routine.parameters, *routine.declarations)
            if isinstance(one, ir.Variable | ir.Parameter)
        }
        if any(isinstance(one, ir.Variable) and one.storage == "persistent" for one in routine.declarations):
            raise _OpenError
        for parameter, argument in zip(routine.parameters, call.arguments, strict=False):
            if argument.name or argument.if_present:
                raise _OpenError
            value = None if argument.value is None else self.value(argument.value, outer, effects)
            given[parameter.name.lower()] = self.holdable(value)
        frame = _Frame(self.known.scopes.routine(module, routine), given, outer.depth + 1)
        references = {one.name.lower() for one in routine.parameters if one.mode != "value"}
        changed = {base_name(one.target) for one in walk(*routine.body) if isinstance(one, ir.Assign)}
        if references & changed:
            raise _OpenError
        self.follow(routine.body, frame, effects)
        return frame.result

    def holdable(self, value: ir.Expression | None) -> ir.Expression | None:
        for one in () if value is None else walk(value):
            if not isinstance(one, _HOLDABLE) and one not in _FIXED:
                raise _OpenError
        return value

    def follow(self, body: ir.Body, frame: _Frame, effects: _Effects) -> bool:
        """Follow statements; True where they return."""
        for statement in body:
            match statement:
                case ir.Nothing():
                    pass
                case ir.Assign(target=target, value=value):
                    self.assign(statement, target, self.value(value, frame, effects), frame, effects)
                case ir.CallRoutine():
                    self.run(statement, frame, effects)
                case ir.Return(value=value):
                    frame.result = None if value is None else self.holdable(self.value(value, frame, effects))
                    return True
                case ir.If(branches=branches, otherwise=otherwise):
                    if self.choose(statement, branches, otherwise, frame, effects):
                        return True
                case ir.Switch():
                    if self.follow(self.case(statement, frame, effects), frame, effects):
                        return True
                case ir.For():
                    if self.loop(statement, frame, effects):
                        return True
                case ir.Pulse() | ir.StopMotion():
                    effects.done.append(rewrite_parts(statement, lambda part: self.value(part, frame, effects)))
                case _:
                    raise _OpenError
        return False

    def assign(
        self, old: ir.Assign, target: ir.Expression, value: ir.Expression, frame: _Frame, effects: _Effects
    ) -> None:
        name = base_name(target)
        if name is not None and name in frame.locals:
            self.assign_local(target, name, value, frame)
            return
        place = rewrite_parts(target, lambda part: self.part(part, target, frame, effects))
        if name is not None:
            self.seen(name, frame)
            if any(_mentions(held, name) for held in (*frame.locals.values(), frame.result)):
                raise _OpenError
            closed = self.known.closed(value, frame.scope) if isinstance(target, ir.Name) else None
            followed = name in effects.held
            effects.held.pop(name, None)
            if closed is not None and followed:
                effects.held[name] = closed
        effects.done.append(replace(old, target=place, value=value))

    def part(self, part: ir.Expression, whole: ir.Expression, frame: _Frame, effects: _Effects) -> ir.Expression:
        """A part of a place that is assigned: subscripts are values, the variable itself is not."""
        if isinstance(whole, ir.Index | ir.Field) and part is whole.base:
            return rewrite_parts(part, lambda inner: self.part(inner, part, frame, effects))
        return self.value(part, frame, effects)

    def assign_local(self, target: ir.Expression, name: str, value: ir.Expression, frame: _Frame) -> None:
        value = self.holdable(value) or value
        match target, frame.locals[name]:
            case ir.Name(), _:
                frame.locals[name] = value
            case ir.Field(base=ir.Name(), name=part), ir.Aggregate(entries=entries) as whole:
                if not any(key is not None and key.lower() == part.lower() for key, _ in entries):
                    raise _OpenError
                done = tuple(
                    (key, value if key is not None and key.lower() == part.lower() else old) for key, old in entries
                )
                frame.locals[name] = replace(whole, entries=done)
            case _:
                raise _OpenError

    def choose(
        self,
        statement: ir.If,
        branches: tuple[tuple[ir.Expression, ir.Body], ...],
        otherwise: ir.Body,
        frame: _Frame,
        effects: _Effects,
    ) -> bool:
        """Follow the branch that is taken; where only the run can tell, the choice between what the branches set."""
        for condition, body in branches:
            told = self.decided(condition, frame, effects)
            if told is True:
                return self.follow(body, frame, effects)
            if told is None:
                break
        else:
            return self.follow(otherwise, frame, effects)
        effects.open_choices += 1
        before = dict(frame.locals)
        held = dict(effects.held)
        pairs = tuple(
            (self.value(condition, frame, effects), self.branch(body, frame, effects, held))
            for condition, body in branches
        )
        other = self.branch(otherwise, frame, effects, held)
        if frame.locals != before:
            raise _OpenError
        set_there = {base_name(one.target) for one in walk(pairs, other) if isinstance(one, ir.Assign)}
        effects.held = {name: value for name, value in held.items() if name not in set_there}
        effects.done.append(replace(statement, branches=pairs, otherwise=other))
        return False

    def branch(self, body: ir.Body, frame: _Frame, effects: _Effects, held: Held) -> ir.Body:
        inside = _Effects(dict(held), open_choices=effects.open_choices)
        if self.follow(body, frame, inside):
            raise _OpenError
        effects.open_choices = inside.open_choices
        return tuple(inside.done)

    def decided(self, condition: ir.Expression, frame: _Frame, effects: _Effects) -> bool | None:
        told = self.number(self.value(condition, frame, effects), frame)
        return told if isinstance(told, bool) else None

    def case(self, switch: ir.Switch, frame: _Frame, effects: _Effects) -> ir.Body:
        selector = self.number(self.value(switch.selector, frame, effects), frame)
        if selector is None:
            raise _OpenError
        for case in switch.cases:
            values = [self.number(self.value(one, frame, effects), frame) for one in case.values]
            if None in values:
                raise _OpenError
            if selector in values:
                return case.body
        return switch.default or ()

    def loop(self, loop: ir.For, frame: _Frame, effects: _Effects) -> bool:
        first, last = (self.number(self.value(one, frame, effects), frame) for one in (loop.start, loop.stop))
        name = loop.counter.lower()
        inside = any(isinstance(one, ir.ExitLoop | ir.NextPass) for one in walk(*loop.body))
        if not isinstance(first, int) or not isinstance(last, int) or loop.step is not None or inside:
            raise _OpenError
        if last - first >= _MOST_PASSES or (not loop.scoped and name not in frame.locals):
            raise _OpenError
        for number in range(first, last + 1):
            frame.locals[name] = ir.IntLiteral(number)
            if self.follow(loop.body, frame, effects):
                return True
        frame.locals[name] = None  # what a counter is behind its loop differs between languages
        return False

    # ---- values

    def number(self, value: ir.Expression, frame: _Frame) -> Value | None:
        """The value of an expression that is worked out; also of data of the program that nothing assigns."""
        return constant(self.settled(value), frame.scope)

    def subscript(self, one: ir.Expression, frame: _Frame) -> ir.Expression:
        known = self.number(one, frame)
        return ir.IntLiteral(known) if isinstance(known, int) and not isinstance(known, bool) else one

    def settled(self, one: ir.Expression) -> ir.Expression:
        if isinstance(one, ir.Name):
            begun = self.known.begun(one.id, self.scope, 0)
            return begun if isinstance(begun, _SCALARS) else one
        return rewrite_parts(one, self.settled)

    def value(self, one: ir.Expression, frame: _Frame, effects: _Effects) -> ir.Expression:
        """An expression of the routine with all that is known in it."""
        match one:
            case ir.Name(id=name) if name.lower() in frame.locals:
                given = frame.locals[name.lower()]
                if given is None:
                    raise _OpenError
                return given
            case ir.Name(id=name) if name.lower() in effects.held and frame.scope.value(name) is not None:
                return effects.held[name.lower()]
            case ir.Name(id=name) if frame.depth:
                begun = self.known.begun(name, frame.scope, 0)
                if begun is None or isinstance(begun, ir.Name):
                    self.seen(name, frame)
                return one if begun is None else begun
            case ir.Call():
                result = self.run(one, frame, effects)
                if result is None:
                    raise _OpenError
                return result
        done = rewrite_parts(one, lambda part: self.value(part, frame, effects))
        match done:
            case ir.Field(base=ir.Aggregate() as whole, name=part):
                found = component(whole, part)
                if found is None:
                    raise _OpenError
                return found
            case ir.Field(base=ir.Name(id=name), name=part):  # as the caller names it
                begun = self.known.begun(name, self.scope, 0)
                found = None if begun is None else component(begun, part)
                return done if found is None else found
            case ir.Index(indices=indices):
                return replace(done, indices=tuple(self.subscript(one, frame) for one in indices))
            case ir.Binary() | ir.Unary() | ir.Convert() if not isinstance(done, _SCALARS):
                known = constant(done, frame.scope) if all(map(_is_plain, walk(done))) else None
                simple = None if known is None else literal(known)
                return done if simple is None else simple
        return done


def _is_plain(node: object) -> bool:
    return isinstance(node, (*_SCALARS, ir.Unary, ir.Binary, ir.Convert, ir.Quantity, ir.Magnitude))


def _mentions(value: ir.Expression | None, name: str) -> bool:
    return value is not None and any(isinstance(one, ir.Name) and one.id.lower() == name for one in walk(value))


__all__ = ["known_calls"]
