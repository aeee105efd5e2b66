"""Data that moves name: where it is declared (at the head of the program's module, as people have it), and frames for
constant shifts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.passes.legalise.context import Context


def with_data(program: ir.Program, added: Sequence[ir.Declaration]) -> ir.Program:
    """Data of moves at the head of the program's module: of the first one with routines, among those of its first
    task."""
    task = program.modules[0].task
    home = next((one for one in program.modules if one.routines and one.task == task), program.modules[0])
    own = replace(home, declarations=(*added, *home.declarations))
    return replace(program, modules=tuple(own if one is home else one for one in program.modules))


@dataclass(slots=True)
class ShiftFrames:
    """Constant shifts in millimetres as frames with a name that says them: `shift_z100`, `shift_xm2p5_y3`."""

    context: Context
    names: dict[ir.Aggregate, ir.Name] = field(default_factory=dict)

    def frame(self, shift: Sequence[float]) -> ir.Name:
        """The frame of a shift by x, y, z."""
        values = dict(zip(ir.POSE, [*shift, 0.0, 0.0, 0.0], strict=True))
        pose = ir.Aggregate(tuple((name, ir.RealLiteral(one)) for name, one in values.items()), type_name="pose")
        if pose not in self.names:
            parts = [f"{name}{one:g}" for name, one in values.items() if one] or ["0"]
            word = "shift_" + "_".join(parts).replace("-", "m").replace(".", "p")
            self.names[pose] = ir.Name(self.context.fresh(word))
        return self.names[pose]

    def declared(self) -> list[ir.Variable]:
        return [ir.Variable(one.id, ir.PoseType(), value, "persistent", "global") for value, one in self.names.items()]
