"""Places of moves as people say them in TP: a shift by constants is `Offset,PR[n]` or `Tool_Offset,PR[n]` on the taught
point, not a place computed in front of the move.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.passes.fold import Unchanged, constant
from rpl.passes.legalise.context import Context, ProgramScope
from rpl.passes.legalise.rewriting.editing import edit_bodies, edit_each, map_body
from rpl.passes.legalise.rewriting.headdata import ShiftFrames
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import Scope

_SHIFTS = {"offset": "element_sum", "tool_offset": ":"}
_PLAIN = (ir.Name, ir.Index, ir.Field)


@legalising(sees=("function offset", "function tool_offset"))
def places_of_moves(program: ir.Program, context: Context) -> ir.Program:
    """Constant shifts are said at the move."""
    worker = _Places(ShiftFrames(context), unchanged_in(program))
    scopes = ProgramScope(program)

    def work(module: ir.Module, routine: ir.Routine) -> ir.Routine:
        worker.scope = scopes.routine(module, routine)
        return edit_bodies(routine, worker.body)

    done = edit_each(program, work)
    if not worker.shifts.names:
        return done
    home = replace(done.modules[0], declarations=(*done.modules[0].declarations, *worker.shifts.declared()))
    return replace(done, modules=(home, *done.modules[1:]))


@dataclass(slots=True)
class _Places:
    shifts: ShiftFrames
    unchanged: Unchanged
    scope: Scope = field(init=False)

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def statement(self, statement: ir.Statement) -> ir.Body:
        if not isinstance(statement, ir.Move):
            return (inside(statement, self.body),)
        return (replace(statement, target=self.shifted(statement)),)

    def shifted(self, move: ir.Move) -> ir.Expression:
        """The target with a constant shift of it in data of its own, as the register that the move names."""
        match move.target:
            case ir.Builtin(function=name, arguments=(base, *rest)) if name in _SHIFTS and len(rest) == 3:
                numbers = [constant(one, self.scope, self.unchanged) for one in rest]
                if move.relative is not None or not isinstance(base, _PLAIN) or not all(map(_is_number, numbers)):
                    return move.target
                shift = self.shifts.frame([float(one) for one in numbers if isinstance(one, int | float)])
                if name == "offset":
                    return ir.Builtin("element_sum", (base, shift), origin=move.target.origin)
                return ir.Binary(":", base, shift, origin=move.target.origin)
        return move.target


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
