"""Poses that moves go to as places with a posture, from languages where a place and a frame are one type (URScript,
V+), for targets whose places say one (a RAPID robtarget, a KRL E6POS, a TP position).

What is a place in the source becomes one in all that hands it on (variables, parameters, functions), so that it can be
taught. Poses that are something else as well stay poses. The frame that a place or such a pose is seen from
(`table:above`, `pose_trans(table, above)`) is the frame of the move, as people select the frame and move to the place
(KRL `$BASE=table`, `LIN above`; counted in public programs, one move in twenty-five goes to a product of frames).
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import partial

from rpl import ir
from rpl.passes.capabilities import Postures
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.worldframe import may_select_frames
from rpl.passes.legalise.kinds import kinds_in
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import changed, rewrite_parts
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typewords import type_word
from rpl.passes.typing import type_of

__all__ = ["places_as_targets"]

_PRODUCTS = frozenset(("operator :", "function compose"))
_SHIFTS = ("offset", "tool_offset")
_Key = int  # identity of a declaration, or of a function for what it returns


@legalising(unless=lambda context: context.capabilities.places.postures is not Postures.FLAGS, sees=("Move",))
def places_as_targets(program: ir.Program, context: Context) -> ir.Program:
    """Only where the program tells places and poses apart all through."""
    roles = _Roles(program, framed=may_select_frames(program, context.capabilities.settings.modal))
    roles.look()
    if not roles.places and not (roles.framed and kinds_in(program) & _PRODUCTS):
        return program
    return _Rewriting(roles, ir.TargetType(context.capabilities.places.notation)).program(program)


@dataclass(slots=True)
class _Roles:
    """What the poses of a program are: places are what moves go to, all that hands them on and all they are set to."""

    source: ir.Program
    framed: bool  # may moves have frames of their own?
    places: set[_Key] = field(default_factory=set)
    otherwise: set[_Key] = field(default_factory=set)  # used as something that a target is not
    links: list[tuple[_Key, _Key]] = field(default_factory=list)
    scopes: ProgramScope = field(init=False)
    assigned: set[str] = field(init=False)

    def __post_init__(self) -> None:
        self.scopes = ProgramScope(self.source)
        self.assigned = unchanged_in(self.source).assigned

    def look(self) -> None:
        """Find the places: what is linked to one and to nothing else."""
        for module in self.source.modules:
            self.declared(module.declarations, self.scopes.module(module))
        for module, routine in self.scopes.routines():
            scope = self.scopes.routine(module, routine)
            self.declared(routine.declarations, scope)
            edit_bodies(routine, partial(self.body, scope=scope, routine=routine))
        for found in (self.places, self.otherwise):
            size = -1
            while size != len(found):
                size = len(found)
                for one, other in self.links:
                    if one in found or other in found:
                        found |= {one, other}
        self.places -= self.otherwise

    def declared(self, declarations: tuple[ir.Declaration, ...], scope: Scope) -> None:
        for one in declarations:
            if isinstance(one, ir.Variable) and one.initial is not None:
                self.value(one.initial, id(one), scope)
            elif not isinstance(one, ir.Variable):
                self.others(one, scope)

    def body(self, body: ir.Body, scope: Scope, routine: ir.Routine) -> ir.Body:
        for statement in body:
            self.statement(statement, scope, routine)
        return body

    def statement(self, statement: ir.Statement, scope: Scope, routine: ir.Routine) -> None:
        match statement:
            case ir.Move(target=target, via=via) if statement.relative is None:
                for place in (target, via):
                    if place is not None:
                        self.place(place, scope)
                self.others(replace(statement, target=ir.IntLiteral(0), via=None), scope)
                return
            case ir.Assign(target=ir.Name() as target, value=value) if (key := self.key(target, scope)) is not None:
                self.value(value, key, scope)
                return
            case ir.Return(value=value) if value is not None and isinstance(routine.returns, ir.PoseType):
                self.value(value, id(routine), scope)
                return
            case ir.CallRoutine(dynamic=None, name=name, arguments=arguments):
                self.passed(name, arguments, scope)
                return
        rewrite_parts(
            statement,
            lambda one: self.seen(one, scope),
            lambda inner: self.body(inner, scope, routine),
        )

    def place(self, place: ir.Expression, scope: Scope) -> None:
        """Where a move goes."""
        frame, inner = self.split(place, scope)
        if frame is not None:
            self.seen(frame, scope)
        base = inner
        while isinstance(base, ir.Builtin) and base.function in _SHIFTS:
            base = base.arguments[0]
        key = self.key(base, scope)
        if key is not None:
            self.places.add(key)
        self.value(inner, key, scope)

    def split(self, place: ir.Expression, scope: Scope) -> tuple[ir.Name | None, ir.Expression]:
        """The named frame that a place is seen from, and the place in it."""
        match place:
            case (
                ir.Binary(op=":", left=left, right=right) | ir.Builtin(function="compose", arguments=(left, right))
            ) if self.framed and self.is_frame(left, scope) and self.can_be_place(right, scope):
                assert isinstance(left, ir.Name)  # as `is_frame` found it
                return left, right
            case ir.Binary(op=":", left=base, right=way):
                frame, inner = self.split(base, scope)
                return frame, place if frame is None else replace(place, left=inner, right=way)
            case ir.Builtin(function="tool_offset" | "compose", arguments=(base, *rest)):
                frame, inner = self.split(base, scope)
                return frame, place if frame is None else replace(place, arguments=(inner, *rest))
        return None, place

    def is_frame(self, one: ir.Expression, scope: Scope) -> bool:
        symbol = scope.value(one.id) if isinstance(one, ir.Name) else None
        if symbol is None or symbol.module is None or symbol.routine is not None or not isinstance(one, ir.Name):
            return False
        return isinstance(scope.resolve(symbol.type), ir.PoseType) and one.id.lower() not in self.assigned

    def can_be_place(self, one: ir.Expression, scope: Scope) -> bool:
        match one:
            case ir.Aggregate(type_name="pose"):
                return True
            case ir.Builtin(function=function, arguments=(base, *_)) if function in _SHIFTS:
                return self.can_be_place(base, scope)
            case ir.Binary(op=":", left=base) | ir.Builtin(function="compose", arguments=(base, *_)):
                return self.can_be_place(base, scope)  # and a way in it
            case ir.Index():
                return isinstance(type_of(one, scope), ir.PoseType | ir.TargetType)
        return self.key(one, scope) is not None or isinstance(type_of(one, scope), ir.TargetType)

    def key(self, one: ir.Expression, scope: Scope) -> _Key | None:
        """The variable, parameter or function that gives a pose."""
        match one:
            case ir.Name(id=name):
                symbol = scope.value(name)
                if symbol is not None and isinstance(scope.resolve(symbol.type), ir.PoseType):
                    own = symbol.module is not None or symbol.routine is not None
                    return id(symbol.declaration) if own else None
            case ir.Call(name=name):
                routine = scope.routine(name)
                if routine is not None and isinstance(routine.returns, ir.PoseType):
                    return id(routine)
        return None

    def value(self, value: ir.Expression, into: _Key | None, scope: Scope) -> None:
        """What a pose is set to."""
        match value:
            case ir.Builtin(function=function, arguments=(base, *rest)) if function in _SHIFTS:
                self.value(base, into, scope)
                for one in rest:
                    self.seen(one, scope)
                return
            case ir.Aggregate(type_name="pose", entries=entries):
                for _, one in entries:
                    self.seen(one, scope)
                return
            case ir.Call(name=name, arguments=arguments):
                self.passed(name, arguments, scope)
        key = self.key(value, scope)
        if key is not None and into is not None:
            self.links.append((key, into))
        elif key is None:
            self.otherwise |= {into} - {None} if into is not None else set()
            self.seen(value, scope)

    def passed(self, name: str, arguments: tuple[ir.Argument, ...], scope: Scope) -> None:
        routine = scope.routine(name)
        parameters = routine.parameters if routine is not None else ()
        for at, argument in enumerate(arguments):
            parameter = parameters[at] if at < len(parameters) and argument.name is None else None
            if argument.value is None:
                continue
            if parameter is not None and isinstance(parameter.type, ir.PoseType):
                self.value(argument.value, id(parameter), scope)
            else:
                self.seen(argument.value, scope)

    def others(self, node: ir.Statement | ir.Declaration, scope: Scope) -> None:
        rewrite_parts(node, lambda one: self.seen(one, scope), lambda body: body)

    def seen(self, one: ir.Expression, scope: Scope) -> ir.Expression:
        """An expression that asks for what it names as it is; a component of a place is one of a target as well."""
        match one:
            case ir.Field(base=ir.Name()) if one.name in ir.POSE:
                return one
            case ir.Call(name=name, arguments=arguments):
                self.passed(name, arguments, scope)
        key = self.key(one, scope)
        if key is not None:
            self.otherwise.add(key)
            return one
        return rewrite_parts(one, lambda inner: self.seen(inner, scope))


@dataclass(slots=True)
class _Rewriting:
    """`frame`: that of the move before, as it stands in the text."""

    roles: _Roles
    target: ir.TargetType
    frame: ir.Expression | None = None

    def program(self, program: ir.Program) -> ir.Program:
        modules = []
        for module in program.modules:
            routines = tuple(self.routine(module, one) for one in module.routines)
            modules.append(
                changed(module, declarations=tuple(map(self.declaration, module.declarations)), routines=routines)
            )
        return changed(program, modules=tuple(modules))

    def declaration(self, one: ir.Declaration) -> ir.Declaration:
        if id(one) not in self.roles.places or not isinstance(one, ir.Variable):
            return one
        initial = None if one.initial is None else self.placed(one.initial)
        return replace(one, type=self.target, initial=initial)

    def routine(self, module: ir.Module, routine: ir.Routine) -> ir.Routine:
        scope = self.roles.scopes.routine(module, routine)
        places = self.roles.places
        self.frame = None
        parameters = tuple(replace(one, type=self.target) if id(one) in places else one for one in routine.parameters)

        def expression(one: ir.Expression) -> ir.Expression:
            done = rewrite_parts(one, expression)
            if isinstance(one, ir.Call) and isinstance(done, ir.Call):
                return replace(done, arguments=self.arguments(one.name, done.arguments, scope))
            return done

        def body(statements: ir.Body) -> ir.Body:
            return tuple(
                self.statement(one, rewrite_parts(one, expression, body), routine, scope) for one in statements
            )

        done = edit_bodies(routine, body)
        return changed(
            done,
            parameters=parameters,
            returns=self.target if id(routine) in places else routine.returns,
            declarations=tuple(map(self.declaration, routine.declarations)),
        )

    def statement(self, old: ir.Statement, done: ir.Statement, routine: ir.Routine, scope: Scope) -> ir.Statement:
        match old, done:
            case ir.Move(relative=None), ir.Move():
                moved = self.move(old, done, scope)
                self.frame = moved.frame
                return moved
            case ir.Move(relative="tool", frame=None), ir.Move() if self.roles.framed:
                return replace(done, frame=self.frame)  # along the tool it is the same way in every frame
            case ir.Assign(target=target), ir.Assign() if self.roles.key(target, scope) in self.roles.places:
                return replace(done, value=self.placed(done.value))
            case ir.Return(), ir.Return(value=value) if value is not None and id(routine) in self.roles.places:
                return replace(done, value=self.placed(value))
            case ir.CallRoutine(dynamic=None, name=name), ir.CallRoutine():
                return replace(done, arguments=self.arguments(name, done.arguments, scope))
        return done

    def arguments(self, name: str, given: tuple[ir.Argument, ...], scope: Scope) -> tuple[ir.Argument, ...]:
        routine = scope.routine(name)
        wanted = [id(one) in self.roles.places for one in routine.parameters] if routine is not None else []
        return tuple(
            replace(one, value=self.placed(one.value)) if one.value is not None and is_place else one
            for one, is_place in zip(given, [*wanted, *[False] * len(given)], strict=False)
        )

    def move(self, old: ir.Move, done: ir.Move, scope: Scope) -> ir.Move:
        """The move with its places in the frame that they are seen from."""
        frame, target = self.roles.split(done.target, scope)
        via = done.via
        if via is not None:
            seen_from, inner = self.roles.split(via, scope)
            if seen_from == frame:
                via = inner
            else:
                frame, target = None, done.target
        if self.is_place(target, scope) and (via is None or self.is_place(via, scope)):
            target, via = self.placed(target), None if via is None else self.placed(via)
        return replace(done, target=target, via=via, frame=done.frame if frame is None else frame)

    def is_place(self, one: ir.Expression, scope: Scope) -> bool:
        match one:
            case ir.Aggregate(type_name="pose", entries=entries):
                return {name for name, _ in entries} >= set(ir.POSE)
            case ir.Builtin(function=function, arguments=(base, *_)) if function in _SHIFTS:
                return self.is_place(base, scope)
        key = self.roles.key(one, scope)
        return key in self.roles.places if key is not None else isinstance(type_of(one, scope), ir.TargetType)

    def placed(self, value: ir.Expression) -> ir.Expression:
        """A pose that is written out as a target."""
        match value:
            case ir.Aggregate(type_name="pose"):
                return replace(value, type_name=type_word(self.target))
            case ir.Builtin(function=function, arguments=(base, *rest)) if function in _SHIFTS:
                return replace(value, arguments=(self.placed(base), *rest))
        return value
