"""The posture of taught places that say none (URScript, V+), for targets whose places say one: the place gets the
posture in which the source's controller comes to it, as if it had been taught on the target.

A place and all that is worked out of it go to moves together, and one posture must serve them all. A move whose end the
run decides counts as if it went to the taught place itself. Where the postures are not the same, or are known nowhere,
the places stay as they are; where the target's places always say one, it is that of the first move, and a move that
comes there otherwise goes to joints.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Any

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies
from rpl.passes.capabilities import PlaceRule, Postures
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Context, array
from rpl.passes.legalise.facts.motion.whereabouts import NOWHERE_KNOWN, Whereabouts
from rpl.passes.legalise.facts.targetuses import Uses
from rpl.passes.legalise.facts.usage import each_statement
from rpl.passes.legalise.facts.values.taughtvalues import JointsOfPlaces
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.places.postures.choices import ASSUMED, FREE, SAME_DEG, Choices, joint_target, to_a_place
from rpl.passes.legalise.places.postures.writtenplaces import inserted
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import Scope
from rpl.passes.typewords import type_word
from rpl.passes.values import Target, moved
from rpl.source import Origin

AS_TAUGHT = code(
    "posture-as-taught",
    Severity.WARNING,
    "this place is worked out in the run of one that says nothing about the arm's posture: the arm comes here in the "
    "posture in which the source's controller comes to the taught place itself",
    "look on the target that the arm comes to all of these places in the posture that is meant",
)
_SHIFTS = ("offset", "tool_offset")


@legalising(unless=lambda context: context.capabilities.places.postures is not Postures.FLAGS, sees=("Move",))
def taught_postures(program: ir.Program, context: Context) -> ir.Program:
    """Only on the arm that the program was written for, where a controller would otherwise choose another posture."""
    choices = Choices.of(context)
    word = type_word(ir.TargetType(context.capabilities.places.notation))
    places = {
        id(one): one
        for one in walk_for({"Aggregate"}, *program.modules)
        if isinstance(one, ir.Aggregate) and one.type_name == word and {name for name, _ in one.entries} <= {*ir.POSE}
    }
    if choices is None or not places or not choices.apart:
        return program
    return _Taught(program, context, choices, places).program()


@dataclass(frozen=True, slots=True)
class _Going:
    """A joint move to one of such places: the joints that the source's controller takes there (n,) and how far that is
    known, the flange there (4, 4), and where the arm comes from (n,), if that is known."""

    place: int
    move: ir.Move
    joints: Any
    flange: Any
    before: Any
    computed: bool


@dataclass(slots=True)
class _Group:
    """Places that the same moves go to, and these moves; `open`: those of which no posture is known."""

    places: set[int] = field(default_factory=set)
    goings: list[_Going] = field(default_factory=list)
    open: list[ir.Move] = field(default_factory=list)


class _Taught(Rewriter):
    def __init__(
        self, program: ir.Program, context: Context, choices: Choices, places: dict[int, ir.Aggregate]
    ) -> None:
        super().__init__(program, context)
        self.choices, self.places = choices, places
        self.uses = Uses.of(program, self.scopes)
        self.stands = Whereabouts(program, context, assuming=True)
        self.groups = {key: _Group({key}) for key in places}
        for module, routine in self.scopes.routines():
            scope = self.scopes.routine(module, routine)
            for body in bodies(routine):
                each_statement(body, partial(self.look, scope=scope))
        self.flags: dict[int, dict[str, int]] = {}
        self.joints: dict[int, Any] = {}  # of moves that go to joints
        self.said = PlaceRule.POSTURE_SAID in context.capabilities.places.rules
        groups = list({id(one): one for one in self.groups.values() if one.goings or one.open}.values())
        if self.wanted([one for one in groups if not one.open]):
            self.settle(groups)

    # ---- what goes where

    def look(self, statement: ir.Statement, scope: Scope) -> None:
        if not isinstance(statement, ir.Move) or not to_a_place(statement):
            return
        reached = [key for key in self.places if key in self.reached(statement.target, scope)]
        if not reached:
            return
        group = self.joined(reached)
        for key in reached:
            going = self.going(statement, key, scope)
            if going is None:
                group.open.append(statement)
            else:
                group.goings.append(going)

    def reached(self, place: ir.Expression, scope: Scope) -> set[int]:
        """What the posture of a place may come from; of a function that hands on the posture of its argument, of the
        one that it is given here."""
        inner = place
        while isinstance(inner, ir.Builtin) and inner.function in _SHIFTS:
            inner = inner.arguments[0]
        routine = scope.routine(inner.name) if isinstance(inner, ir.Call) else None
        if routine is None or not isinstance(inner, ir.Call):
            return self.uses.reach(place, scope)
        given = {id(one) for one in routine.parameters}
        from_within = self.uses.sources.get(id(routine), set())
        if not from_within <= given:
            return self.uses.reach(place, scope)
        found: set[int] = set()
        for one, argument in zip(routine.parameters, inner.arguments, strict=False):
            if id(one) in from_within and argument.value is not None:
                found |= self.uses.reach(argument.value, scope)
        return found

    def joined(self, keys: list[int]) -> _Group:
        """One group for these places."""
        first, *others = [self.groups[key] for key in keys]
        for one in others:
            if one is not first:
                first.places |= one.places
                first.goings += one.goings
                first.open += one.open
                self.groups.update((key, first) for key in one.places)
        return first

    def going(self, move: ir.Move, key: int, scope: Scope) -> _Going | None:
        start, end = self.stands.starts.get(id(move), NOWHERE_KNOWN), self.stands.ends.get(id(move), NOWHERE_KNOWN)
        flange = end.flange or self.at_the_place(move, key, scope)
        if move.search is not None or flange is None:
            return None
        matrix = array(flange.matrix)
        before = None if start.joints is None else array(start.joints)
        joints = self.choices.source(matrix, before) if before is not None else self.everywhere(matrix)
        computed = end.flange is None
        if joints is None or (computed and PlaceRule.AXIS_SIGNS in self.context.capabilities.places.rules):
            return None
        return _Going(key, move, joints, matrix, before, computed)

    def everywhere(self, flange: Any) -> Any:
        return self.choices.from_everywhere(flange, self.stands)

    def at_the_place(self, move: ir.Move, key: int, scope: Scope) -> Any:
        """The flange as if the move went to the taught place itself, moved by what is constant."""
        frames, place = self.stands.flow.frames.get(id(move)), constant(self.places[key], scope)
        if frames is None or not isinstance(place, Target):
            return None
        match move.target:
            case ir.Builtin(function=function, arguments=(_, *rest)) if function in _SHIFTS:
                numbers = [constant(one, scope) for one in rest]
                given = [float(one) for one in numbers if isinstance(one, int | float)]
                shifted = moved(function, place, given) if len(given) == len(numbers) else None
                place = shifted if isinstance(shifted, Target) else place
        return frames.flange(place.pose)

    # ---- which posture

    def wanted(self, groups: list[_Group]) -> bool:
        """Are postures told? Where the target's places always tell one, where its controller would choose otherwise,
        and where all of them are known: else it chooses as the source's does in the run."""
        goings = [one for group in groups for one in group.goings]
        known = all(one.before is not None and not one.computed for one in goings)
        return self.said or known or any(map(self.needed, goings))

    def settle(self, groups: list[_Group]) -> None:
        """Give the places of each group their postures, where one serves all of its moves."""
        told: dict[int, Origin] = {}
        for group in groups:
            found = self.postures(group)
            self.flags |= found
            for going in group.goings if found else ():
                if going.computed:
                    self.context.diagnostics.report(AS_TAUGHT, going.move.origin)
                elif going.before is None:
                    told[id(going.move)] = going.move.origin
            for move in group.open if self.said else ():
                self.context.diagnostics.report(FREE, move.origin)
        for origin in told.values():
            self.context.diagnostics.report(ASSUMED, origin)

    def postures(self, group: _Group) -> dict[int, dict[str, int]]:
        """The flags of each place; none where they do not serve a move."""
        found: dict[int, dict[str, int]] = {}
        others = []
        for going in group.goings:
            flags = self.choices.theirs.encode(self.choices.arm, going.joints)
            if found.setdefault(going.place, flags) != flags or not self.serves(going, flags):
                others.append(going)
        if self.said:
            self.joints |= {id(one.move): one.joints for one in others if not one.computed}
            return found
        return {} if others or group.open else found

    def needed(self, going: _Going) -> bool:
        """Would the target's controller choose otherwise, or may it?"""
        return going.before is None or self.choices.differ(going.flange, going.before)

    def serves(self, going: _Going, flags: dict[str, int]) -> bool:
        """Does the target's controller come there as the source's does?"""
        before = going.joints if going.before is None else going.before
        joints = self.choices.target(going.flange, before, flags)
        return joints is not None and bool(abs(joints - going.joints).max() <= SAME_DEG)

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        joints = self.joints.get(id(statement))
        if joints is None or not isinstance(statement, ir.Move):
            return super().statement(statement)
        self.written.tell(statement, self.scope, statement.target)
        return [replace(statement, target=joint_target(joints))]

    @cached_property
    def written(self) -> JointsOfPlaces:
        return JointsOfPlaces(self.source, self.context)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        flags = self.flags.get(id(expression))
        if flags is None or not isinstance(expression, ir.Aggregate):
            return super().expression(expression)
        return replace(expression, entries=inserted(list(self.entries(expression)), [*_words(flags)]))

    def entries(self, place: ir.Aggregate) -> Iterator[tuple[str, ir.Expression]]:
        yield from ((name, value) for name, value in place.entries if name is not None)


def _words(flags: dict[str, int]) -> Iterator[tuple[str | None, ir.Expression]]:
    yield from ((name, ir.IntLiteral(value)) for name, value in flags.items())


__all__ = ["taught_postures"]
