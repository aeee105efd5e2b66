"""Places that are seen from a named frame, as KUKA's people move to them: the frame is the base, and the move goes to
the place (`$BASE=table`, `LIN above`; counted in public programs, one move in twenty-five goes to a product of frames).
"""

from __future__ import annotations

from dataclasses import dataclass

from rpl import ir
from rpl.passes.legalise.context import Context, ProgramScope, rules_of
from rpl.passes.legalise.facts.settingsinforce import SettingsInForce
from rpl.passes.legalise.facts.worldframe import may_select_frames
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_all, edit_bodies, edit_each, map_body
from rpl.passes.legalise.rewriting.framedplaces import FramedPlaces
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.stages import legalising


@legalising(sees=("operator :", "function compose"))
def framed_moves(program: ir.Program, context: Context) -> ir.Program:
    """Where the base is the world all the time otherwise; it is set where another one is in force."""
    if not may_select_frames(program, modal=True):
        return program
    scopes, unchanged = ProgramScope(program), unchanged_in(program)

    def work(module: ir.Module, routine: ir.Routine) -> ir.Routine:
        scope = scopes.routine(module, routine)
        return edit_bodies(routine, _Framed(FramedPlaces(scope, unchanged, _is_place)).body)

    done = edit_each(program, work)
    if not any(_frame_of(node) not in (None, _WORLD) for node in walk_for({"Assign"}, *done.modules)):
        return program
    # The controller keeps the base of whatever ran before: the first move says its own.
    flow = SettingsInForce.of(done, dict(rules_of(context.source).system_defaults), {"base": ir.System("base")})

    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Assign) and _frame_of(statement) is not None and flow.again(statement):
            return ()
        return (inside(statement, lambda body: map_body(body, change)),)

    return edit_all(done, lambda body: map_body(body, change, {"Assign"}))


_WORLD = ir.System("null_frame")


def _frame_of(node: object) -> ir.Expression | None:
    match node:
        case ir.Assign(target=ir.System(name="base"), value=value):
            return value
    return None


def _is_place(place: ir.Expression) -> bool:
    """One with a name, or one that a function of the program gives."""
    return isinstance(place, ir.Name | ir.Index | ir.Call)


@dataclass(frozen=True, slots=True)
class _Framed:
    """The moves of one routine, each behind what selects its frame; one to joints needs none."""

    places: FramedPlaces

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def statement(self, statement: ir.Statement) -> ir.Body:
        if not isinstance(statement, ir.Move):
            return (inside(statement, self.body),)
        if statement.relative == "tool" or self.places.goes_to_joints(statement):
            return (statement,)
        frame, move = self.places.of_move(statement)
        return ir.Assign(ir.System("base"), frame or _WORLD), move
