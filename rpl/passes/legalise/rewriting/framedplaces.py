"""Places of moves that are seen from a named frame (`table:above`, `pose_trans(table, above)`), as the frame and the
place in it, for targets whose people select the frame and move to the place.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from rpl import ir
from rpl.passes.fold import Unchanged
from rpl.passes.scope import Scope
from rpl.passes.typing import type_of


@dataclass(frozen=True, slots=True)
class FramedPlaces:
    """What a routine's moves are seen from. `stands`: may a move go to this place by itself?"""

    scope: Scope
    unchanged: Unchanged
    stands: Callable[[ir.Expression], bool]

    def of_move(self, move: ir.Move) -> tuple[ir.Expression | None, ir.Move]:
        """The frame that all places of a move are seen from, and the move in it; None: there is none."""
        frame, target = self.split(move.target)
        through = None if move.via is None else self.split(move.via)
        if frame is None or move.relative is not None or (through is not None and through[0] != frame):
            return None, move
        return frame, replace(move, target=target, via=None if through is None else through[1])

    def goes_to_joints(self, move: ir.Move) -> bool:
        return isinstance(type_of(move.target, self.scope), ir.JointsType)

    def split(self, place: ir.Expression) -> tuple[ir.Expression | None, ir.Expression]:
        """The named frame that a place is seen from, and the place in it."""
        match place:
            case (
                ir.Binary(op=":", left=ir.Name() as frame, right=inner)
                | ir.Builtin(function="compose", arguments=(ir.Name() as frame, inner))
            ) if self.is_frame(frame) and self.stands(inner):
                return frame, inner
            case ir.Binary(op=":", left=left, right=right):
                frame_of, inner = self.split(left)
                return frame_of, place if frame_of is None else replace(place, left=inner, right=right)
            case ir.Builtin(function="offset" | "tool_offset" as how, arguments=(base, *rest)):
                frame_of, inner = self.split(base)
                if frame_of is None or how == "offset":
                    return None, place
                return frame_of, replace(place, arguments=(inner, *rest))
        return None, place

    def is_frame(self, name: ir.Name) -> bool:
        symbol = self.scope.value(name.id)
        shared = symbol is not None and symbol.routine is None and name.id.lower() not in self.unchanged.assigned
        return shared and isinstance(type_of(name, self.scope), ir.PoseType)
