"""Arcs on which the tool stays as it is to the arc, for targets that turn it to the one written at its end.

The tool turns by the arc's angle. That is twice the angle between the chords start-via and via-end, so the rotation
between two frames through the three points (one along each chord, the same plane), done twice, gives the orientation
at the end. A target whose tool takes the shortest way to that orientation gets half a circle or more in two arcs: the
shortest way back would be the other one (`arcsplit` has their points).
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.rewriting.library import composed, function, part
from rpl.passes.legalise.source.ways.arcsplit import is_short, split_points
from rpl.passes.scope import Scope
from rpl.passes.typing import type_of

IN_HALVES = code(
    "arc-in-halves",
    Severity.WARNING,
    "along this arc the tool stays as it is; the target would turn it the other way on half a circle or more, which is"
    " written as two arcs that meet in a corner of {corner:g} mm",
)
OTHER_WAY = code(
    "arc-turns-other-way",
    Severity.WARNING,
    "along this arc the tool stays as it is; if it is half a circle or more, the target turns it the other way, and"
    " because actions belong to it, it cannot be written as two arcs",
    "write the arc in parts of less than half a circle",
)
CORNER_MM = 1.0
_RULE = "circle_orientation"


def is_fixed(move: ir.Move) -> bool:
    """Does the move keep the tool as it is to its arc?"""
    return move.kind == "circular" and move.orientation == "constant" and move.circle_orientation == "path"


class FixedArcs:
    """Writes such arcs; the variables they need belong to the routine at hand."""

    def __init__(self, program: ir.Program, context: Context) -> None:
        self.context = context
        self.variables: list[ir.Variable] = []
        self.names: dict[str, str] = {}
        ours = rules_of(context.target).system_defaults.get(_RULE, "base")
        self.shortest = _RULE not in context.capabilities.system_variables and ours == "base"
        self.changes = any(isinstance(node, ir.Assign) and node.target == ir.System(_RULE) for node in walk(program))

    def taken(self) -> tuple[ir.Variable, ...]:
        """The variables of the routine that is done."""
        done, self.variables, self.names = tuple(self.variables), [], {}
        return done

    def written(self, move: ir.Move, scope: Scope) -> ir.Body | None:
        """The steps of one such arc; None where it is seen from frames of its own or its angle is given. Targets that
        do not tell where the motion will end stand at the start."""
        own = (move.relative, move.swept, move.tool, move.frame, move.search)
        if self.changes or move.via is None or move.settings or any(one is not None for one in own):
            return None
        start, via, end, first, second, turned = map(
            self.variable, ("start", "via", "end", "first", "second", "turned")
        )
        places = [ir.Field(ir.Name(name), "trans") for name in (start, via, end)]
        half = ir.Name(second)
        stood = "end_pose" not in self.context.capabilities.system_variables
        steps: list[ir.Statement] = [
            *((ir.WaitForMotion(),) if stood else ()),
            _given(start, ir.System("actual_pose" if stood else "end_pose")),
            _given(via, _pose(move.via, scope)),
            _given(end, _pose(move.target, scope)),
            _given(first, function("frame_from_points", *places)),
            _given(second, function("frame_from_points", places[1], places[2], places[0])),
            _given(second, composed(half, function("inverse", ir.Name(first)))),
            _given(turned, composed(half, half)),
            _given(turned, composed(ir.Name(turned), ir.Name(start))),
            *((_given(second, composed(half, ir.Name(start))),) if self.shortest else ()),
            *(ir.Assign(part(end, angle), part(turned, angle)) for angle in "abc"),
        ]
        steps[0] = replace(steps[0], origin=move.origin)
        arc = replace(
            move,
            target=ir.Name(end),
            via=ir.Name(via),
            orientation=None,
            origin=replace(move.origin, comments=()),
        )
        if self.shortest:
            return *steps, *self.halves(replace(arc, circle_orientation="base"), (start, via, end), second)
        if _RULE not in self.context.capabilities.system_variables:
            return *steps, arc
        usual = str(rules_of(self.context.source).system_defaults.get(_RULE, "base"))
        rule = ir.System(_RULE)
        around = (ir.Assign(rule, ir.EnumLiteral("path")), ir.Assign(rule, ir.EnumLiteral(usual)))
        return *steps, around[0], replace(arc, circle_orientation=None), around[1]

    def halves(self, arc: ir.Move, places: tuple[str, str, str], half: str) -> ir.Body:
        """The arc where it is short, else two arcs; `half` has the tool's orientation in the middle."""
        if arc.triggers:
            self.context.diagnostics.report(OTHER_WAY, arc.origin)
            return (arc,)
        self.context.diagnostics.report(IN_HALVES, arc.origin, corner=CORNER_MM)
        real = ir.RealType()
        sizes = [self.variable(what, real) for what in ("to_via", "from_via", "across", "share")]
        before, middle, behind = (self.variable(what) for what in ("before", "middle", "behind"))
        measured, points = split_points(places, (before, middle, behind), sizes)
        origin = replace(arc.origin, comments=())
        parts: list[ir.Statement] = [
            *(_given(name, ir.Name(half)) for name in (before, middle)),
            _given(behind, ir.Name(places[2])),
            *points,
            replace(
                arc,
                via=ir.Name(before),
                target=ir.Name(middle),
                blend=ir.BlendDistance(ir.RealLiteral(CORNER_MM)),
            ),
            replace(arc, via=ir.Name(behind)),
        ]
        return *measured, ir.If(((is_short(sizes), (arc,)),), tuple(parts), origin=origin)

    def variable(self, what: str, type: ir.Type | None = None) -> str:
        if what not in self.names:
            self.names[what] = self.context.fresh(f"arc_{what}")
            self.variables.append(ir.Variable(self.names[what], type or ir.PoseType(), scope="routine"))
        return self.names[what]


def _given(name: str, value: ir.Expression) -> ir.Assign:
    return ir.Assign(ir.Name(name), value)


def _pose(place: ir.Expression, scope: Scope) -> ir.Expression:
    return place if isinstance(type_of(place, scope), ir.PoseType) else function("pose_of", place)


__all__ = ["FixedArcs", "is_fixed"]
