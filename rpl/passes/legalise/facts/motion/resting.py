"""Where the robot rests: behind what waits for it, and behind a move without a corner, for controllers whose program
waits for such a move."""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.facts.forward import Forward

__all__ = ["Rests"]


class Rests(Forward[bool]):
    """`rests`: does the robot rest where a statement (by identity) evaluates its own expressions? `before`: does it
    where the program comes to the statement? It does when a program starts. Known behind `solve`, which is told what
    runs on its own and what runs beside. `holds`: does the controller hold the program at a move without a corner until
    it has ended?"""

    def __init__(self, program: ir.Program, holds: bool = True) -> None:
        super().__init__(program, True, False)
        self.holds = holds
        self.rests: dict[int, bool] = {}
        self.before: dict[int, bool] = {}

    def transfer(self, statement: ir.Statement, before: bool) -> bool:
        match statement:
            case ir.WaitForMotion():
                return True
            case ir.Move(blend=ir.BlendStop(), concurrent=False) if self.holds:
                return True
            case ir.Move() | ir.MoveExternal() | ir.Spline():
                return False
        return before

    def join(self, one: bool, other: bool) -> bool:
        return one and other

    def inner(self, statement: ir.Statement, state: bool | None) -> bool | None:
        after = super().inner(statement, state)
        return False if isinstance(statement, ir.Spline) and after else after

    def handled(self, state: bool) -> tuple[bool, bool | None, bool | None]:
        return super().handled(False)  # an error may come in the middle of a move

    def note(self, statement: ir.Statement, before: bool) -> None:
        self.before[id(statement)] = self.before.get(id(statement), True) and before
        known = self.rests.get(id(statement), True)
        self.rests[id(statement)] = known and before and not self.calls_in(statement)
