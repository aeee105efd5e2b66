"""One interrupt of a program that watches its conditions itself, and what the target's programs need to know of it."""

from __future__ import annotations

from dataclasses import dataclass, field

from rpl import ir

__all__ = ["MOTION", "Watch"]

MOTION = (ir.Move, ir.MoveExternal, ir.Spline, ir.StopMotion, ir.StartMotion, ir.ClearMotion, ir.ResumeLevel)


@dataclass(slots=True)
class Watch:
    """One interrupt. `armed`, `was`, `enabled`, `mask`: data that says whether it is on, whether its condition held
    when looked at last, whether it waits (disabled), and how urgent it has to be. `of_source`: its condition and its
    action as the program declares them."""

    key: int
    priority: int
    declared: ir.DeclareInterrupt
    armed: str
    routine: ir.Routine
    served: bool
    was: str = ""
    enabled: str = ""
    mask: str = ""
    of_source: tuple[ir.Expression, ir.Assign | ir.CallRoutine] = field(init=False)

    def __post_init__(self) -> None:
        self.of_source = (self.declared.condition, self.declared.action)

    def may_come(self) -> ir.Expression | None:
        """Is it neither disabled nor masked? None: that never happens."""
        parts: list[ir.Expression] = []
        if self.enabled:
            parts.append(ir.Unary("not", ir.Name(self.enabled)))
        if self.mask:
            parts.append(ir.Binary("<", ir.IntLiteral(self.priority), ir.Name(self.mask)))
        if not parts:
            return None
        return parts[0] if len(parts) == 1 else ir.Binary("cand", parts[0], parts[1])
