"""Sums of positions component by component, positions moved by a pose, poses of targets: as functions brought along.

Controllers with numbered positions add them like lists of numbers; others have no word for it. Each function is made
once for the type it is used with, in terms of components, which the passes behind this one write as the target does.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.capabilities import PlaceRule, Postures
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typing import type_of

_OPERATORS = {"element_sum": "+", "element_difference": "-", "element_product": "*"}
_MOVED = ("displaced", "displaced_in_tool")
_NAMING = frozenset(("Name", "Field", "Assign", "Builtin"))
_DONE, _ONE, _OTHER, _PRODUCT = "done", "one", "other", "product"
_SEEN = frozenset(f"function {one}" for one in (*_OPERATORS, *_MOVED, "pose_of"))


@legalising(
    unless=lambda context: (
        not {*_OPERATORS, *_MOVED, "pose_of"}
        - (context.capabilities.functions - (context.capabilities.places.move_functions & set(_MOVED)))
    ),
    sees=_SEEN,
)
def elementwise(program: ir.Program, context: Context) -> ir.Program:
    """The program without the functions of this kind that the target lacks."""
    can = context.capabilities
    alone = can.functions - (
        can.places.move_functions & set(_MOVED)
    )  # what only a move's target may be is lacking elsewhere
    lacking = {*_OPERATORS, *_MOVED, "pose_of"} - alone
    return _Worker(program, context, frozenset(lacking)).program()


@dataclass(slots=True)
class _Worker:
    source: ir.Program
    context: Context
    lacking: frozenset[str]
    names: dict[tuple[str, ir.Type, ir.Type | None], str] = field(default_factory=dict)
    routines: list[ir.Routine] = field(default_factory=list)
    plain: frozenset[str] | None = None  # `components_only`, when it has been asked for

    def program(self) -> ir.Program:
        program = self.source
        scopes = ProgramScope(program)
        modules = []
        for module in program.modules:
            routines = tuple(self.routine(routine, scopes.routine(module, routine)) for routine in module.routines)
            modules.append(replace(module, routines=routines))
        if not self.routines:
            return replace(program, modules=tuple(modules))
        first = modules[0]
        made = ir.Module(
            self.context.fresh("rpl_positions"), first.dialect, routines=tuple(self.routines), task=first.task
        )
        return replace(program, modules=(*modules, made))

    def routine(self, routine: ir.Routine, scope: Scope) -> ir.Routine:
        def expression(node: ir.Expression) -> ir.Expression:
            node = rewrite_parts(node, expression)
            if isinstance(node, ir.Builtin) and node.function in self.lacking:
                return self.call(node, scope)
            return node

        def parts(statement: ir.Statement) -> ir.Statement:
            target = statement.target if isinstance(statement, ir.Move) else None
            if isinstance(statement, ir.Move) and isinstance(target, ir.Builtin) and self.moves(target):
                inner = rewrite_parts(target, expression)
                return rewrite_parts(statement, lambda node: inner if node is target else expression(node), body)
            return rewrite_parts(statement, expression, body)

        def body(statements: ir.Body) -> ir.Body:
            return tuple(
                one for statement in statements for one in self.nothing_left(statement, scope) or (parts(statement),)
            )

        return edit_bodies(routine, body)

    def nothing_left(self, statement: ir.Statement, scope: Scope) -> ir.Body:
        """A place less itself (INFORM `SUB P010 P010`, TP `PR[1]=LPOS-LPOS`) is that place with all its components set
        to 0."""
        match statement:
            case ir.Assign(
                target=ir.Name() as place, value=ir.Builtin(function="element_difference", arguments=(one, other))
            ) if one == other and "element_difference" in self.lacking:
                calls = any(isinstance(node, ir.Call) for node in walk(one))
                if not calls and isinstance(self.known(place, scope), ir.TargetType | ir.PoseType):
                    return self.zero(statement, place, one, scope)
        return ()

    def zero(self, statement: ir.Assign, place: ir.Name, one: ir.Expression, scope: Scope) -> ir.Body:
        """The place with nothing but zeros; its posture stays where anything may ask for it."""
        places = self.context.capabilities.places
        rules = places.rules
        if PlaceRule.WHOLE in rules or places.postures is Postures.JOINTS:  # a place is a pose and nothing else
            return (replace(statement, value=ir.System("null_frame")),)
        if place.id.lower() in self.components_only():
            word = "pose" if isinstance(self.known(place, scope), ir.PoseType) else "target"
            nowhere = ir.Aggregate(tuple((part, ir.RealLiteral(0.0)) for part in ir.POSE), word)
            return (replace(statement, value=nowhere),)
        nothing = ir.IntLiteral(0)
        values: dict[str, ir.Expression] = dict.fromkeys(ir.POSE, nothing)
        if PlaceRule.QUATERNIONS in rules:
            turn = (ir.IntLiteral(1), nothing, nothing, nothing)
            values = {
                "trans": ir.Aggregate(tuple((None, one) for one in (nothing, nothing, nothing)), "vector"),
                "rot": ir.Aggregate(tuple((None, one) for one in turn), "rotation"),
            }
        done = [] if one == place else [replace(statement, value=one)]
        done += [replace(statement, target=ir.Field(place, part), value=value) for part, value in values.items()]
        first, *others = done
        return (first, *(replace(one, origin=replace(one.origin, comments=())) for one in others))

    def components_only(self) -> frozenset[str]:
        """Names (folded) of places of which the program sets and reads x, y, z and angles alone: nothing drives there,
        so that nothing asks for their posture."""
        if self.plain is None:
            self.plain = _components_only(self.source)
        return self.plain

    def moves(self, target: ir.Builtin) -> bool:
        """Does a move of the target's say this itself?"""
        can = self.context.capabilities
        return target.function in _MOVED and target.function in can.places.move_functions & can.functions

    def call(self, node: ir.Builtin, scope: Scope) -> ir.Expression:
        """The call of the function for these types; the node where a type is not known."""
        one = self.known(node.arguments[0], scope)
        other: ir.Type | None = ir.RealType()
        if node.function not in ("element_product", "pose_of"):
            other = self.known(node.arguments[1], scope)
        if one is None or other is None or (node.function == "pose_of" and not isinstance(one, ir.TargetType)):
            return node
        key = (node.function, one, other)
        if key not in self.names:
            name = self.names[key] = self.context.fresh(f"rpl_{node.function}")
            made = _MAKERS[node.function](name, node.function, one, other)
            whole = PlaceRule.QUATERNIONS in self.context.capabilities.places.rules and node.function in _MOVED
            self.routines.append(_by_wholes(made) if whole else made)
        arguments = tuple(ir.Argument(argument) for argument in node.arguments)
        return ir.Call(self.names[key], arguments, origin=node.origin)

    def known(self, expression: ir.Expression, scope: Scope) -> ir.Type | None:
        if isinstance(expression, ir.Call):  # one of ours, of the type of its first argument
            found = next((routine.returns for routine in self.routines if routine.name == expression.name), None)
            if found is not None:
                return found
        type = type_of(expression, scope)
        return type if isinstance(type, ir.TargetType | ir.PoseType | ir.JointsType) else None


def _components_only(program: ir.Program) -> frozenset[str]:
    used: Counter[str] = Counter()
    plain: Counter[str] = Counter()
    for node in walk_for(_NAMING, *program.modules):
        match node:
            case ir.Name(id=name):
                used[name.lower()] += 1
            case ir.Field(base=ir.Name(id=name), name=part) if part in ir.POSE:
                plain[name.lower()] += 1
            case ir.Assign(target=ir.Name(id=name)) | ir.Builtin(function="pose_of", arguments=(ir.Name(id=name),)):
                plain[name.lower()] += 1
            case ir.Builtin(function=function, arguments=(one, ir.Name(id=name))) if function in _OPERATORS:
                nothing = function == "element_difference" and one == ir.Name(name)
                plain[name.lower()] += 2 if nothing else 1
    return frozenset(name for name, times in used.items() if plain[name] == times)


def _part(name: str, component: str) -> ir.Field:
    return ir.Field(ir.Name(name), component)


def _made(name: str, one: ir.Type, other: ir.Type, locals: tuple[ir.Variable, ...], body: ir.Body) -> ir.Routine:
    return ir.Routine(
        name,
        "function",
        (ir.Parameter(_ONE, one), ir.Parameter(_OTHER, other)),
        one,
        (ir.Variable(_DONE, one, scope="routine"), *locals),
        (ir.Assign(ir.Name(_DONE), ir.Name(_ONE)), *body, ir.Return(ir.Name(_DONE))),
        scope="global",
    )


def _element(name: str, function: str, one: ir.Type, other: ir.Type) -> ir.Routine:
    """done := one, each component combined with that of the other (or with the number)."""
    components = ir.AXES if isinstance(one, ir.JointsType) else ir.POSE
    number = isinstance(other, ir.RealType)
    body = tuple(
        ir.Assign(
            _part(_DONE, component),
            ir.Binary(
                _OPERATORS[function],
                _part(_ONE, component),
                ir.Name(_OTHER) if number else _part(_OTHER, component),
            ),
        )
        for component in components
    )
    return _made(name, one, other, (), body)


def _displaced(name: str, function: str, one: ir.Type, other: ir.Type) -> ir.Routine:
    """done := one at the place of other . one (in its frame) or one . other (in its own axes)."""
    inside = function == "displaced_in_tool"
    left, right = (_ONE, _OTHER) if inside else (_OTHER, _ONE)
    product = ir.Variable(_PRODUCT, other if inside else one, scope="routine")
    body = (
        ir.Assign(ir.Name(_PRODUCT), ir.Binary(":", ir.Name(left), ir.Name(right))),
        *(ir.Assign(_part(_DONE, component), _part(_PRODUCT, component)) for component in ir.POSE),
    )
    return _made(name, one, other, (product,), body)


def _by_wholes(made: ir.Routine) -> ir.Routine:
    """Position and rotation are copied as they are where a rotation is no three angles."""
    copies = tuple(ir.Assign(_part(_DONE, part), _part(_PRODUCT, part)) for part in ("trans", "rot"))
    kept = tuple(one for one in made.body if not (isinstance(one, ir.Assign) and isinstance(one.target, ir.Field)))
    return replace(made, body=(*kept[:-1], *copies, kept[-1]))


def _pose_of(name: str, function: str, one: ir.Type, other: ir.Type) -> ir.Routine:
    """A target's place and rotation."""
    pose = ir.PoseType()
    body = tuple(ir.Assign(_part(_DONE, component), _part(_ONE, component)) for component in ir.POSE)
    return ir.Routine(
        name,
        "function",
        (ir.Parameter(_ONE, one),),
        pose,
        (ir.Variable(_DONE, pose, scope="routine"),),
        (*body, ir.Return(ir.Name(_DONE))),
        scope="global",
    )


_MAKERS: dict[str, Callable[[str, str, ir.Type, ir.Type], ir.Routine]] = {
    **dict.fromkeys(_OPERATORS, _element),
    **dict.fromkeys(_MOVED, _displaced),
    "pose_of": _pose_of,
}
