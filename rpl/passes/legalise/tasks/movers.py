"""A task that drives single moves, so that the program itself can look at something on their way.

The program chooses a move by its number, begins the task, and knows by a flag whether it still moves. To stop on the
way it ends the task and brakes. What a move needs that the task cannot see is copied into data first.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.passes.legalise.rewriting.editing import Editor
from rpl.passes.legalise.tasks.beside import Beside, local_names, tidy
from rpl.passes.scope import ProgramScope


@dataclass(slots=True)
class Movers:
    """The moves of the task. `number`: data that says which one is driven; `last`: the last one of its group."""

    beside: Beside
    scopes: ProgramScope
    home: ir.Routine | None = None  # the task stands beside this routine
    groups: list[list[ir.Move]] = field(default_factory=list)  # moves of one group go on through their corners
    name: str = ""
    number: str = ""
    last: str = ""

    def task(self) -> str:
        if not self.name:
            self.name = self.beside.context.fresh("rpl_mover")
            self.number = self.beside.context.fresh("rpl_move")
        return self.name

    def begin(self, editor: Editor, routine: ir.Routine, moves: Sequence[ir.Move]) -> list[ir.Statement]:
        """Statements that begin moves which follow each other through their corners (the last one stops). They go on
        while the flag `moving` is TRUE."""
        task = self.task()
        self.home = self.home or routine
        before: list[ir.Statement] = []
        first = 1 + sum(map(len, self.groups))
        group = [self.seen(editor, routine, replace(move, search=None, triggers=()), before) for move in moves]
        group[-1] = replace(group[-1], blend=ir.BlendStop())
        self.groups.append([replace(move, origin=tidy(move.origin)) for move in group])
        later = tidy(moves[0].origin)
        if len(moves) > 1 or self.last:
            self.last = self.last or self.beside.context.fresh("rpl_last_move")
            before.append(ir.Assign(ir.Name(self.last), ir.IntLiteral(first + len(moves) - 1), origin=later))
        return [
            *before,
            ir.Assign(ir.Name(self.number), ir.IntLiteral(first), origin=later),
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
        number, at = ir.Name(self.number), 0
        alone: list[ir.Case] = []
        done: list[ir.Statement] = []
        for group in self.groups:
            for place, move in enumerate(group, 1):
                at += 1
                if len(group) == 1:
                    alone.append(ir.Case((ir.IntLiteral(at),), (move,)))
                    continue
                onward: ir.Body = (ir.Assign(number, ir.IntLiteral(at + 1)),) if place < len(group) else ()
                done.append(ir.If(((ir.Binary("=", number, ir.IntLiteral(at)), (move, *onward)),)))
        if len(alone) == at == 1:
            done = [*alone[0].body]
        elif alone:
            done.append(ir.Switch(number, tuple(alone)))
        self.beside.routine(self.home, ir.Routine(self.name, body=(*done, ended), scope="global"))

    def data(self) -> tuple[ir.Variable, ...]:
        if self.home is None:
            return ()
        zero = ir.IntLiteral(0)
        last = (ir.Variable(self.last, ir.IntType(), zero, scope="global"),) if self.last else ()
        return (ir.Variable(self.number, ir.IntType(), zero, scope="global"), *last, self.beside.moving_flag())


__all__ = ["Movers"]
