"""Computed places as position registers are filled: a point is copied, then its x, y and z are changed in the register
itself. No register stands between, and the copy is not read from the point once more.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies

_WAYS = ("x", "y", "z")


@legalising(sees=("function offset", "Field"))
def filled_places(program: ir.Program, context: Context) -> ir.Program:
    """Places that are moved by computed ways, and parts of a copy that are computed of the point that was copied."""

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, lambda body: _filled(body, editor))

    return edit_routines(program, context, work)


def _filled(body: ir.Body, editor: Editor) -> ir.Body:
    done: list[ir.Statement] = []
    copies: dict[str, tuple[str, frozenset[str]]] = {}  # a place -> what it is a copy of, and which parts have changed
    for statement in body:
        statement = rewrite_bodies(statement, lambda inner: _filled(inner, editor))
        statement = _of_copy(statement, copies)
        for one in _spelled(statement, editor):
            _note(one, copies)
            done.append(one)
    same = len(done) == len(body) and all(one is other for one, other in zip(done, body, strict=True))
    return body if same else tuple(done)


def _of_copy(statement: ir.Statement, copies: dict[str, tuple[str, frozenset[str]]]) -> ir.Statement:
    """A part of a copy, computed of the copy's own part in the place of the point's."""
    match statement:
        case ir.Assign(target=ir.Field(base=ir.Name(id=name) as place), value=value) if name.lower() in copies:
            source, touched = copies[name.lower()]

            def own(node: object) -> object:
                match node:
                    case ir.Field(base=ir.Name(id=read), name=part) if read.lower() == source:
                        return node if part.lower() in touched else replace(node, base=place)
                return node

            return replace(statement, value=rewrite(value, own))
    return statement


def _note(statement: ir.Statement, copies: dict[str, tuple[str, frozenset[str]]]) -> None:
    match statement:
        case ir.Assign(target=ir.Name(id=name), value=ir.Name(id=source)):
            _changed(name, copies)
            if name.lower() != source.lower():
                copies[name.lower()] = source.lower(), frozenset()
        case ir.Assign(target=ir.Field(base=ir.Name(id=name), name=part)):
            kept = copies.get(name.lower())
            _changed(name, copies)
            if kept is not None:
                copies[name.lower()] = kept[0], kept[1] | {part.lower()}
        case ir.Assign(target=ir.Name(id=name), value=value) if not any(
            isinstance(one, ir.Call) for one in walk(value)
        ):
            _changed(name, copies)
        case ir.Nothing():
            pass
        case _:
            copies.clear()


def _changed(name: str, copies: dict[str, tuple[str, frozenset[str]]]) -> None:
    """Neither the variable nor a copy of it is what it was."""
    key = name.lower()
    for copy in [one for one, (source, _) in copies.items() if key in (one, source)]:
        del copies[copy]


def _spelled(statement: ir.Statement, editor: Editor) -> ir.Body:
    """The place with each computed way added to its part."""
    match statement:
        case ir.Assign(
            target=ir.Name(id=name) as place,
            value=ir.Builtin(function="offset", arguments=(ir.Name() as base, *way)),
        ) if len(way) == len(_WAYS) and any(isinstance(one, ir.Binary) and constant(one, editor.scope) is None
                                            for one in way):  # fmt: skip
            read = {one.id.lower() for one in walk(*way) if isinstance(one, ir.Name)}
            if name.lower() in read or not all(map(editor.effects.safe, way)):
                return (statement,)
            first = () if base.id.lower() == name.lower() else (replace(statement, value=base),)
            return expansion(statement.origin, (*first, *_sums(place, way, editor))) or (statement,)
        case ir.Assign(
            target=ir.System(name="tool" | "base"), value=ir.Builtin(function="offset", arguments=(base, *way))
        ) if len(way) == len(_WAYS):
            type = editor.type_of(base)
            if type is not None:  # UTOOL and UFRAME take a whole register
                moved = editor.temporary("moved", type)
                steps = (ir.Assign(moved, base), *_sums(moved, way, editor), replace(statement, value=moved))
                return expansion(statement.origin, steps)
    return (statement,)


def _sums(place: ir.Name, way: Sequence[ir.Expression], editor: Editor) -> ir.Body:
    """Each way that is not zero, added to its part of the place."""
    parts = [ir.Field(place, part) for part in _WAYS]
    return tuple(
        ir.Assign(part, ir.Binary("+", part, one))
        for part, one in zip(parts, way, strict=True)
        if constant(one, editor.scope) != 0
    )


__all__ = ["filled_places"]
