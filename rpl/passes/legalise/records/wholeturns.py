"""The three ZYX angles of a place set one behind the other, for targets that keep no angles: all three in one step.

Such targets read the other two angles back for each one that is set. At B = 90 degrees these come back as other ones of
the equal forms, so the last angle would turn the tool elsewhere.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from rpl import ir
from rpl.passes.capabilities import PlaceRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import children
from rpl.passes.legalise.rewriting.beside import tidy
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising
from rpl.passes.typewords import type_word

_ALL = ("x", "y", "z", *ir.ANGLES)


@legalising(unless=lambda context: PlaceRule.KEEP_ANGLES in context.capabilities.places.rules)
def whole_turns(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that say so."""

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        def body(statements: ir.Body) -> ir.Body:
            done: list[ir.Statement] = []
            at = 0
            while at < len(statements):
                taken = next(
                    (some for some in (_ALL, ir.ANGLES) if _sets(statements[at : at + len(some)], some, editor)), ()
                )
                if taken:
                    done.append(_whole(statements[at : at + len(taken)], taken, editor))
                else:
                    done.append(inside(statements[at], body))
                at += len(taken) or 1
            return statements if _same(done, statements) else tuple(done)

        return edit_bodies(routine, body)

    return edit_routines(program, context, work)


def _same(done: list[ir.Statement], statements: ir.Body) -> bool:
    return len(done) == len(statements) and all(new is old for new, old in zip(done, statements, strict=True))


def _sets(body: ir.Body, names: tuple[str, ...], editor: Editor) -> bool:
    """Do these statements set just these components of one place, with values that do not look at what was set?"""
    given: dict[str, ir.Expression] = {}
    place: ir.Expression | None = None
    for statement in body:
        match statement:
            case ir.Assign(target=ir.Field(base=base, name=name), value=value):
                place = place if place is not None else base
                if base != place or _looks(value, place, given.keys()):
                    return False
                given[name] = value
            case _:
                return False
    if place is None or set(given) != set(names):
        return False
    return isinstance(editor.type_of(place), ir.PoseType | ir.TargetType)


def _looks(value: ir.Expression, place: ir.Expression, done: Collection[str]) -> bool:
    """Does the value look at the place otherwise than at components that are still the old ones, or may it?"""
    if isinstance(value, ir.Field) and value.base == place:
        return value.name in done
    return value == place or isinstance(value, ir.Call) or any(_looks(one, place, done) for one in children(value))


def _whole(body: ir.Body, names: tuple[str, ...], editor: Editor) -> ir.Statement:
    """The place with these components new."""
    given: dict[str, ir.Expression] = {}
    for statement in body:
        assert isinstance(statement, ir.Assign) and isinstance(statement.target, ir.Field)  # _sets has looked
        place, given[statement.target.name] = statement.target.base, statement.value
    type = editor.type_of(place)
    assert type is not None  # _sets has looked
    entries = tuple((name, given.get(name, ir.Field(place, name))) for name in _ALL)
    comments = tuple(comment for one in body for comment in one.origin.comments)
    origin = replace(tidy(body[0].origin), comments=comments)
    return ir.Assign(place, ir.Aggregate(entries, type_word(type)), origin=origin)


__all__ = ["whole_turns"]
