"""Places that are copied and then moved along the axes of their frame, one component after the other.

`Over=Pick`, `Over.Z=Pick.Z+Clear` is how people write it in languages whose places are changed by components (KRL, TP).
Where a place can be given moved (RAPID Offs, V+ SHIFT), it is one assignment.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies

__all__ = ["moved_copies"]

_AXES = ("x", "y", "z")
_STILL = ir.RealLiteral(0.0)


@legalising(
    unless=lambda context: "offset" not in context.capabilities.functions or context.capabilities.storage.banks,
    sees=("Field",),
)
def moved_copies(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that have such places as values, and names to keep them under."""

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, lambda body: _moved(body, editor))

    return edit_routines(program, context, work, frozenset(("Field",)))


def _moved(body: ir.Body, editor: Editor) -> ir.Body:
    done: list[ir.Statement] = []
    at = 0
    while at < len(body):
        statement = body[at]
        at += 1
        found = _copied(statement, editor)
        if found is None:
            done.append(rewrite_bodies(statement, lambda inner: _moved(inner, editor)))
            continue
        copy, original = found
        way: dict[str, ir.Expression] = {}
        while at < len(body) and (step := _step(body[at], copy, original, editor)) is not None and step[0] not in way:
            way[step[0]] = step[1]
            at += 1
        if way:
            given = ir.Builtin("offset", (original, *(way.get(axis, _STILL) for axis in _AXES)))
            statement = ir.Assign(copy, replace(given, origin=original.origin), origin=statement.origin)
        done.append(statement)
    same = len(done) == len(body) and all(one is other for one, other in zip(done, body, strict=True))
    return body if same else tuple(done)


def _copied(statement: ir.Statement, editor: Editor) -> tuple[ir.Name, ir.Name] | None:
    """The names of a variable and of another place that is stored in it."""
    match statement:
        case ir.Assign(target=ir.Name() as copy, value=ir.Name() as original) if copy.id.lower() != original.id.lower():
            types = [editor.type_of(copy), editor.type_of(original)]
            if isinstance(types[0], ir.TargetType) and types[0] == types[1]:
                return copy, original
    return None


def _step(
    statement: ir.Statement, copy: ir.Name, original: ir.Name, editor: Editor
) -> tuple[str, ir.Expression] | None:
    """The axis that an assignment moves the copy along, and how far; None: it does something else."""
    match statement:
        case ir.Assign(target=ir.Field() as target, value=value) if not statement.origin.comments:
            axis = _axis(target, copy)
        case _:
            return None
    if axis is None:
        return None
    rest: list[tuple[int, ir.Expression]] = []
    counted = 0
    for sign, term in _terms(value):
        if sign > 0 and isinstance(term, ir.Field) and axis in (_axis(term, copy), _axis(term, original)):
            counted += 1
        else:
            rest.append((sign, term))
    if counted != 1 or not rest or not all(_plain(term, copy, editor) for _, term in rest):
        return None
    return axis, _sum(rest)


def _axis(place: ir.Field, name: ir.Name) -> str | None:
    """The axis of the frame that a component of that place belongs to."""
    base = place.base
    if isinstance(base, ir.Field) and base.name.lower() == "trans":
        base = base.base
    named = isinstance(base, ir.Name) and base.id.lower() == name.id.lower()
    return place.name.lower() if named and place.name.lower() in _AXES else None


def _terms(value: ir.Expression, sign: int = 1) -> Iterator[tuple[int, ir.Expression]]:
    """What a sum adds and takes away."""
    match value:
        case ir.Binary(op="+" | "-" as op, left=left, right=right):
            yield from _terms(left, sign)
            yield from _terms(right, sign if op == "+" else -sign)
        case _:
            yield sign, value


def _sum(terms: list[tuple[int, ir.Expression]]) -> ir.Expression:
    terms.sort(key=lambda one: -one[0])  # what is added first
    (sign, total), *others = terms
    if sign < 0:
        total = ir.Unary("-", total)
    for sign, term in others:
        total = ir.Binary("+" if sign > 0 else "-", total, term)
    return total


def _plain(term: ir.Expression, copy: ir.Name, editor: Editor) -> bool:
    """Does the term say the same one statement earlier: has it nothing of the copy, and is it no call?"""
    named = any(isinstance(node, ir.Name) and node.id.lower() == copy.id.lower() for node in walk(term))
    return not named and editor.effects.safe(term)
