"""Places that are seen from a named frame, as KUKA's people move to them: the frame is the base, and the move goes to
the place (`$BASE=table`, `LIN above`; counted in public programs, one move in twenty-five goes to a product of frames).
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.passes.legalise.context import Context, ProgramScope
from rpl.passes.legalise.rewriting.editing import edit_bodies, edit_each, map_body
from rpl.passes.legalise.rewriting.framedplaces import FramedPlaces, keeps_world
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.stages import legalising


@legalising(sees=("operator :", "function compose"))
def framed_moves(program: ir.Program, context: Context) -> ir.Program:
    """Where the base is the world all the time otherwise; moves beside them say that they are seen from it. A move to
    joints keeps the base of the move above it."""
    if not keeps_world(program):
        return program
    scopes, unchanged = ProgramScope(program), unchanged_in(program)

    def work(module: ir.Module, routine: ir.Routine) -> ir.Routine:
        scope = scopes.routine(module, routine)
        return edit_bodies(routine, _Framed(FramedPlaces(scope, unchanged, _is_place)).body)

    return edit_each(program, work)


def _is_place(place: ir.Expression) -> bool:
    """One with a name, or one that a function of the program gives."""
    return isinstance(place, ir.Name | ir.Index | ir.Call)


@dataclass(slots=True)
class _Framed:
    """The moves of one routine. last: what the move above is seen from."""

    places: FramedPlaces
    last: ir.Expression = field(default_factory=lambda: ir.System("null_frame"))

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def statement(self, statement: ir.Statement) -> ir.Body:
        if not isinstance(statement, ir.Move):
            return (inside(statement, self.body),)
        if statement.relative == "tool" or self.places.goes_to_joints(statement):
            return (replace(statement, frame=self.last),)
        frame, move = self.places.of_move(statement)
        self.last = frame or ir.System("null_frame")
        return (replace(move, frame=self.last),)
