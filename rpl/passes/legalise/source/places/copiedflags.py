"""Targets put together with the arm configuration of another one (`[trans, rot, p.robconf, p.extax]`).

Controllers keep the flags of a place with it and have no word for them alone, so the other target is copied as a whole
and gets the new position and rotation. External axes that the program does not use are left out of what is copied.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.motion.externalaxes import has_external_axes, is_unused
from rpl.passes.legalise.facts.usage import base_name
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.bodies import Hoister, Lowered
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising

_ORDER = ("trans", "rot", "conf", "ext")
_UNUSED = ir.Aggregate(tuple((name, ir.RealLiteral(9e9, "9E9")) for name in ir.COMPONENTS[ir.ExternalType]))


@legalising(sees=("Field",))
def copied_flags(program: ir.Program, context: Context) -> ir.Program:
    """Only for programs that copy the flags or external axes of a target."""
    if not any(
        isinstance(node, ir.Field) and node.name in ("conf", "ext") for node in walk_for({"Field"}, *program.modules)
    ):
        return program
    external = has_external_axes(program)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        copies = _Copies(editor, external)
        done = routine if external else edit_bodies(routine, copies.without_external)
        done = edit_bodies(done, copies.body)
        return edit_bodies(done, Hoister(editor, copies.rule).body)

    return edit_routines(program, context, work)


class _Copies:
    def __init__(self, editor: Editor, external: bool) -> None:
        self.editor, self.external = editor, external

    # ---- external axes

    def without_external(self, body: ir.Body) -> ir.Body:
        """Where no axis is used, nothing is copied or set."""

        def part(node: object) -> object:
            match node:
                case ir.Aggregate(entries=entries):
                    given = tuple((name, _UNUSED if self.is_external(value) else value) for name, value in entries)
                    return replace(node, entries=given) if given != entries else node
            return node

        def change(statement: ir.Statement) -> ir.Body:
            match statement:
                case ir.Assign(target=target, value=value) if self.is_external(target) or (
                    isinstance(target, ir.Field)
                    and self.is_external(target.base)
                    and is_unused(value, self.editor.scope)
                ):
                    return (ir.Nothing(origin=statement.origin),) if statement.origin.comments else ()
            done = inside(statement, lambda inner: map_body(inner, change))
            return (rewrite(done, part),) if done is statement else (done,)

        return map_body(body, change)

    def is_external(self, value: ir.Expression) -> bool:
        return isinstance(value, ir.Field) and isinstance(self.editor.type_of(value), ir.ExternalType)

    # ---- flags

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def statement(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.Assign(target=ir.Field(base=target, name="conf"), value=ir.Field(base=giver, name="conf")):
                if self.is_target(target) and self.is_target(giver):
                    return _first(self.flags_alone(target, giver), statement)
            case ir.Assign(target=target, value=ir.Aggregate() as value):
                parts = self.parts(value)
                if parts is not None and self.is_target(target) and not _mentions(value, base_name(target), parts):
                    return _first(self.built(target, parts), statement)
        return (inside(statement, self.body),)

    def rule(self, expression: ir.Expression) -> Lowered | None:
        """A target that is put together where its value is used."""
        parts = self.parts(expression) if isinstance(expression, ir.Aggregate) else None
        if parts is None:
            return None
        type = self.editor.type_of(parts["conf"].base) if isinstance(parts["conf"], ir.Field) else None
        if type is None:
            return None
        place = self.editor.temporary("place", type)
        return self.built(place, parts), place

    def parts(self, value: ir.Aggregate) -> dict[str, ir.Expression] | None:
        """The parts of a target by their names, where the flags are those of another target."""
        if len(value.entries) != len(_ORDER):
            return None
        given = {name or _ORDER[at]: one for at, (name, one) in enumerate(value.entries)}
        match given.get("conf"):
            case ir.Field(base=giver, name="conf") if set(given) == set(_ORDER) and self.is_target(giver):
                return given
        return None

    def is_target(self, value: ir.Expression) -> bool:
        lvalue = isinstance(value, ir.Name | ir.Index | ir.Field)
        return lvalue and isinstance(self.editor.type_of(value), ir.TargetType)

    def built(self, target: ir.Expression, parts: dict[str, ir.Expression]) -> ir.Body:
        """The giver of the flags as a whole, then what differs."""
        flags = parts["conf"]
        giver = flags.base if isinstance(flags, ir.Field) else flags
        done: list[ir.Statement] = [ir.Assign(target, giver)]
        for name in ("trans", "rot", "ext"):
            own = parts[name]
            if own == ir.Field(giver, name) or (name == "ext" and not self.external):
                continue
            done.append(ir.Assign(ir.Field(target, name), own))
        return tuple(done)

    def flags_alone(self, target: ir.Expression, giver: ir.Expression) -> ir.Body:
        if target == giver:
            return ()
        type = self.editor.type_of(target)
        assert type is not None  # asked for before
        kept = self.editor.temporary("place", type)
        names = ("trans", "rot", "ext") if self.external else ("trans", "rot")
        parts = {name: ir.Field(kept, name) for name in names}
        back = tuple(ir.Assign(ir.Field(target, name), part) for name, part in parts.items())
        return (ir.Assign(kept, target), ir.Assign(target, giver), *back)


def _mentions(value: ir.Aggregate, name: str | None, parts: dict[str, ir.Expression]) -> bool:
    """Is the variable read by what would be assigned behind the first assignment to it?"""
    if any(isinstance(node, ir.Call) for node in walk(value)):
        return True
    read = [parts["trans"], parts["rot"], parts["ext"]]
    return name is None or any(isinstance(node, ir.Name) and node.id.lower() == name for node in walk(*read))


def _first(body: ir.Body, statement: ir.Statement) -> ir.Body:
    """The statements in place of one, whose remarks stand with the first."""
    if not body:
        return (ir.Nothing(origin=statement.origin),)
    later = replace(statement.origin, comments=())
    return (
        replace(body[0], origin=statement.origin),
        *(replace(one, origin=later) for one in body[1:]),
    )
