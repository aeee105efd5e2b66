"""Tools and user frames by their numbers: what the source keeps as data with a name is one of the controller's own.

Data that nothing assigns gets a number, whose value goes into the controller's files TOOL.CND and UFRAME.CND; moves and
what asks where the robot is say the number. A place that is seen from a named frame is a point in that user frame.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes import rigid
from rpl.passes.fold import Unchanged, constant
from rpl.passes.legalise.context import Context, ProgramScope
from rpl.passes.legalise.facts.values.framenumbers import Table, is_none, key_of, names_in, own_number, tables_of
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies, rewrite_parts
from rpl.passes.scope import Scope
from rpl.passes.typing import type_of
from rpl.passes.values import pose_of

from .. import tables

HOME = "frames"
_BANKS = {"tool": (tables.TL, tables.TOOLS), "base": (tables.UF, tables.USER_FRAMES)}
# Functions of places -> where their arguments name the tool and the frame.
_SEEN = {"current_target": 0, "joints_to_target": 1, "target_to_joints": 1}


@legalising(sees=("Move",))
def frame_numbers(program: ir.Program, context: Context) -> ir.Program:
    """Tools and user frames that nothing assigns are numbers of the controller."""
    scopes, unchanged = ProgramScope(program), unchanged_in(program)
    program = _in_frames(program, scopes, unchanged)
    scopes = ProgramScope(program)
    uses = [use for use in _uses(program, scopes) if not _is_nothing(use[1], use[2], unchanged)]
    made = tables_of(uses, _BANKS, unchanged, context)
    program = _Numbering(made, unchanged).program(program, scopes)
    if not any(table.numbers for table in made.values()):
        return program
    data: list[ir.Declaration] = []
    for table in made.values():
        data += [table.declaration(), *table.initials()]
    home = ir.Module(context.fresh(HOME), program.modules[0].dialect, tuple(data), public=True)
    return replace(program, modules=(*program.modules, home))


def _said(node: object) -> Iterator[tuple[str, ir.Expression]]:
    """The tool and the frame that a move or a function names."""
    given: tuple[ir.Expression | None, ...] = ()
    match node:
        case ir.Move(tool=tool, frame=frame):
            given = (tool, frame)
        case ir.Builtin(function=name, arguments=arguments) if name in _SEEN:
            given = arguments[_SEEN[name] : _SEEN[name] + 2]
    for kind, one in zip(_BANKS, given, strict=False):
        if one is not None and names_in(one):
            yield kind, one


def _is_nothing(value: ir.Expression, scope: Scope, unchanged: Unchanged) -> bool:
    """Is it the flange, or the base? A table's element with a number is none, though its value is not known yet."""
    if own_number(key_of(value, scope)):
        return False
    return pose_of(constant(value, scope, unchanged)) == rigid.IDENTITY


def _uses(program: ir.Program, scopes: ProgramScope) -> Iterator[tuple[str, ir.Expression, Scope]]:
    for module in program.modules:
        for routine in module.routines:
            scope = scopes.routine(module, routine)
            for node in walk(*bodies(routine)):
                for kind, one in _said(node):
                    yield kind, one, scope


@dataclass(slots=True)
class _Numbering:
    made: dict[str, Table]
    unchanged: Unchanged
    scope: Scope = field(init=False)

    def program(self, program: ir.Program, scopes: ProgramScope) -> ir.Program:
        modules = []
        for module in program.modules:
            routines = []
            for routine in module.routines:
                self.scope = scopes.routine(module, routine)
                routines.append(edit_bodies(routine, self.body))
            modules.append(replace(module, routines=tuple(routines)))
        return replace(program, modules=tuple(modules))

    def body(self, body: ir.Body) -> ir.Body:
        return tuple(map(self.statement, body))

    def statement(self, statement: ir.Statement) -> ir.Statement:
        done = rewrite_parts(statement, self.expression, self.body)
        if not isinstance(statement, ir.Move) or not isinstance(done, ir.Move):
            return done
        given = dict(_said(statement))
        tool, frame = (self.number(kind, given[kind]) if kind in given else None for kind in _BANKS)
        return replace(done, tool=tool or done.tool, frame=frame or done.frame)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        done = rewrite_parts(expression, self.expression)
        given = dict(_said(expression))
        if not given or not isinstance(done, ir.Builtin):
            return done
        arguments = list(done.arguments)
        for at, kind in enumerate(_BANKS, _SEEN[done.function]):
            if kind in given:
                arguments[at] = self.number(kind, given[kind]) or arguments[at]
        return replace(done, arguments=tuple(arguments))

    def number(self, kind: str, value: ir.Expression) -> ir.Expression | None:
        if names_in(value) & self.unchanged.assigned:
            return None  # the program sets it, if only to this value
        if _is_nothing(value, self.scope, self.unchanged):
            return ir.System("null_frame")
        number = self.made[kind].number(value, self.scope)
        return None if not number else self.made[kind].element(number)


# ---- places in front of which a named frame stands


def _in_frames(program: ir.Program, scopes: ProgramScope, unchanged: Unchanged) -> ir.Program:
    modules = []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            worker = _Seen(scopes.routine(module, routine), unchanged)
            routines.append(edit_bodies(routine, worker.body))
        modules.append(replace(module, routines=tuple(routines)))
    return replace(program, modules=tuple(modules))


@dataclass(slots=True)
class _Seen:
    """The moves of a routine with the frames that their places are seen from."""

    scope: Scope
    unchanged: Unchanged

    def body(self, body: ir.Body) -> ir.Body:
        return tuple(map(self.statement, body))

    def statement(self, statement: ir.Statement) -> ir.Statement:
        if not isinstance(statement, ir.Move):
            return rewrite_bodies(statement, self.body)
        if statement.relative is not None or (statement.frame is not None and not is_none(statement.frame)):
            return statement
        frame, target = self.split(statement.target)
        through = None if statement.via is None else self.split(statement.via)
        if frame is None or (through is not None and through[0] != frame):
            return statement
        return replace(statement, frame=frame, target=target, via=None if through is None else through[1])

    def split(self, place: ir.Expression) -> tuple[ir.Expression | None, ir.Expression]:
        """The named frame that a place is seen from, and the place in it."""
        match place:
            case (
                ir.Binary(op=":", left=ir.Name() as frame, right=inner)
                | ir.Builtin(function="compose", arguments=(ir.Name() as frame, inner))
            ) if self.is_frame(frame):
                return frame, inner
            case ir.Binary(op=":", left=left, right=right):
                found, inner = self.split(left)
                return found, place if found is None else replace(place, left=inner, right=right)
            case ir.Builtin(function="tool_offset" | "displaced_in_tool", arguments=(base, *rest)):
                found, inner = self.split(base)
                return found, place if found is None else replace(place, arguments=(inner, *rest))
        return None, place

    def is_frame(self, name: ir.Name) -> bool:
        symbol = self.scope.value(name.id)
        shared = symbol is not None and symbol.routine is None and name.id.lower() not in self.unchanged.assigned
        return shared and isinstance(type_of(name, self.scope), ir.PoseType)
