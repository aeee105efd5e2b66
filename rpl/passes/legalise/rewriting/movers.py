"""A task that drives single moves, so that the program itself can look at something on their way.

The program chooses a move by its number, begins the task, and knows by a flag whether it still moves. To stop on the
way it ends the task and brakes. What a move needs that the task cannot see is copied into data first.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.passes.legalise.rewriting.beside import Beside, local_names, tidy
from rpl.passes.legalise.rewriting.editing import Editor
from rpl.passes.scope import ProgramScope


@dataclass(slots=True)
class Movers:
    """The moves of the task. `number`: data that says which one is driven."""

    beside: Beside
    scopes: ProgramScope
    home: ir.Routine | None = None  # the task stands beside this routine
    moves: list[ir.Move] = field(default_factory=list)
    name: str = ""
    number: str = ""

    def task(self) -> str:
        if not self.name:
            self.name = self.beside.context.fresh("rpl_mover")
            self.number = self.beside.context.fresh("rpl_move")
        return self.name

    def begin(self, editor: Editor, routine: ir.Routine, move: ir.Move) -> list[ir.Statement]:
        """Statements that begin a move, which stops at its end. It goes on while the flag `moving` is TRUE."""
        task = self.task()
        self.home = self.home or routine
        before: list[ir.Statement] = []
        driven = self.seen(editor, routine, replace(move, search=None, triggers=()), before)
        later = tidy(move.origin)
        self.moves.append(replace(driven, blend=ir.BlendStop(), origin=later))
        return [
            *before,
            ir.Assign(ir.Name(self.number), ir.IntLiteral(len(self.moves)), origin=later),
            ir.Assign(ir.Name(self.beside.moving_name()), ir.BoolLiteral(True), origin=later),
            ir.TaskControl("start", task, origin=later),
        ]

    def seen(self, editor: Editor, routine: ir.Routine, move: ir.Move, before: list[ir.Statement]) -> ir.Move:
        """The move with copies of what the task cannot see."""
        assert self.home is not None  # the caller has set it
        local = local_names(routine)
        module = self.beside.program.modules[self.beside.homes[id(self.home)]]
        there = self.scopes.module(module)
        copies: dict[str, ir.Name] = {}

        def change(node: object) -> object:
            if not isinstance(node, ir.Name):
                return node
            here, seen = editor.scope.value(node.id), there.value(node.id)
            hidden = node.id.lower() in local or (here is not None and (seen is None or seen.module != here.module))
            if not hidden:
                return node
            if node.id not in copies:
                type = editor.type_of(node)
                if type is None:
                    return node
                copies[node.id] = self.beside.kept(editor, self.home or routine, "rpl_given", type)
                before.append(ir.Assign(copies[node.id], ir.Name(node.id), origin=tidy(move.origin)))
            return copies[node.id]

        return rewrite(move, change)

    def finish(self) -> None:
        """Adds the task and its data."""
        if self.home is None:
            return
        ended = ir.Assign(ir.Name(self.beside.moving_name()), ir.BoolLiteral(False))
        cases = tuple(ir.Case((ir.IntLiteral(at),), (move,)) for at, move in enumerate(self.moves, 1))
        driven: ir.Statement = self.moves[0] if len(cases) == 1 else ir.Switch(ir.Name(self.number), cases)
        self.beside.routine(self.home, ir.Routine(self.name, body=(driven, ended), scope="global"))

    def data(self) -> tuple[ir.Variable, ...]:
        if self.home is None:
            return ()
        zero = ir.IntLiteral(0)
        return (ir.Variable(self.number, ir.IntType(), zero, scope="global"), self.beside.moving_flag())


__all__ = ["Movers"]
