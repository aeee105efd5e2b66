"""Points on the way of an arc that say only where they are (KRL), for targets that want whole places.

How the tool is turned at such a point does not count; it gets the rotation of the arc's end.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.capabilities import PlaceRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising
from rpl.passes.values import real

_POSITION = ("x", "y", "z")


@legalising(unless=lambda context: PlaceRule.PARTIAL in context.capabilities.places.rules)
def whole_arc_points(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without places of some components."""

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        def change(statement: ir.Statement) -> ir.Body:
            match statement:
                case ir.Move(kind="circular", relative=None, via=ir.Aggregate() as via) if _position_only(via):
                    return _turned_as_end(statement, via, editor)
            return (inside(statement, lambda body: map_body(body, change)),)

        return edit_bodies(routine, lambda body: map_body(body, change))

    return edit_routines(program, context, work)


def _position_only(via: ir.Aggregate) -> bool:
    named = {name for name, _ in via.entries}
    return named >= set(_POSITION) and not named >= set(ir.ANGLES) and "trans" not in named and None not in named


def _turned_as_end(move: ir.Move, via: ir.Aggregate, editor: Editor) -> ir.Body:
    given = {name: value for name, value in via.entries if name is not None}
    end = move.target
    match end:
        case ir.Aggregate(entries=entries):
            angles = {name: value for name, value in entries if name in ir.ANGLES}
            filled = {**dict.fromkeys(ir.ANGLES, real(0.0)), **angles, **given}
            entries = tuple((name, filled[name]) for name in (*_POSITION, *ir.ANGLES))
            return (replace(move, via=replace(via, entries=entries)),)
        case ir.Name() | ir.Index() | ir.Field():
            type = editor.type_of(end)
            if not isinstance(type, ir.PoseType | ir.TargetType):
                return (move,)
            through = editor.temporary("through", type)
            later = replace(move.origin, comments=())
            steps = [ir.Assign(ir.Field(through, name), value, origin=later) for name, value in given.items()]
            first = ir.Assign(through, end, origin=move.origin)
            return (first, *steps, replace(move, via=through, origin=later))
    return (move,)


__all__ = ["whole_arc_points"]
