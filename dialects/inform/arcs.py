"""Consecutive MOVC points to circular moves, consecutive MOVS points to a spline.

The controller's rule: the way to the first MOVC point is straight; from there each three points in a row define an arc.
Points two and three make one circular move, points four and five the next. A leg that is alone (an even number of
points, or an instruction between two points) is the arc through its two ends and the neighbouring point.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code

SHORT_ARC = code(
    "inform-short-arc",
    Severity.ERROR,
    "an arc needs three MOVC points in a row; the controller stops with an alarm here",
)
# What a run of points cannot go over.
_ENDS = (
    *(ir.Move, ir.MoveExternal, ir.Spline, ir.Label, ir.Goto, ir.If, ir.While, ir.For, ir.Switch),
    *(ir.CallRoutine, ir.Return, ir.Halt),
)


def grouped(body: ir.Body, diagnostics: Diagnostics) -> ir.Body:
    """The body with its arcs and splines put together."""
    if not any(_is(statement, "circular") or _is(statement, "spline") for statement in body):
        return body
    done: list[ir.Statement] = []
    at = 0
    while at < len(body):
        statement = body[at]
        if _is(statement, "circular"):
            end = _run(body, at, "circular")
            done.extend(_arcs(body[at:end], diagnostics))
        elif _is(statement, "spline"):
            end = _run(body, at, "spline")
            done.extend(_spline(body[at:end]))
        else:
            end = at + 1
            done.append(statement)
        at = end
    return tuple(done)


def _is(statement: ir.Statement, kind: str) -> bool:
    return isinstance(statement, ir.Move) and statement.kind == kind and statement.via is None


def _run(body: ir.Body, at: int, kind: str) -> int:
    """Where the run ends that begins here: behind its last point, with what stands between its points."""
    end = last = at
    while end < len(body):
        statement = body[end]
        if _is(statement, kind):
            last = end
        elif isinstance(statement, _ENDS):
            break
        end += 1
    return last + 1


def _arcs(run: ir.Body, diagnostics: Diagnostics) -> list[ir.Statement]:
    """The moves of a run; what stands between two points stays there."""
    legs: list[tuple[ir.Move, list[ir.Statement]]] = []  # each point with what follows it
    for statement in run:
        if isinstance(statement, ir.Move):
            legs.append((statement, []))
        else:
            legs[-1][1].append(statement)
    moves = [move for move, _ in legs]
    if len(moves) < 3:
        diagnostics.report(SHORT_ARC, moves[0].origin)
        return [replace(each, kind="linear") if isinstance(each, ir.Move) else each for each in run]
    done: list[ir.Statement] = [replace(moves[0], kind="linear"), *legs[0][1]]
    number = 1
    while number < len(moves):
        move, behind = legs[number]
        if number + 1 < len(moves) and all(isinstance(each, ir.Nothing) for each in behind):
            end, after = legs[number + 1]
            done += [*behind, replace(end, via=move.target), *after]
            number += 2
        else:
            done += [replace(move, via=_middle(moves, number)), *behind]
            number += 1
    return done


def _middle(moves: list[ir.Move], number: int) -> ir.Expression:
    """A place on the arc of one leg: of the circle through its ends and the point before or, at the start, behind."""
    start, end = moves[number - 1].target, moves[number].target
    other = moves[number - 2].target if number >= 2 else moves[number + 1].target
    if number >= 2:
        return ir.Builtin("arc_middle", (other, start, end), origin=moves[number].origin)
    return ir.Builtin("arc_middle", (other, end, start), origin=moves[number].origin)


def _spline(run: ir.Body) -> list[ir.Statement]:
    """A run of MOVS points; the way to the first is straight."""
    moves = [statement for statement in run if isinstance(statement, ir.Move)]
    first = replace(moves[0], kind="linear")
    if len(moves) == 1:
        return [first, *run[1:]]
    body = tuple(
        statement
        for statement in run[1:]
        if isinstance(statement, ir.Move | ir.Trigger | ir.Assign | ir.Vendor | ir.Nothing | ir.Opaque)
    )
    behind = [statement for statement in run[1:] if statement not in body]
    spline = ir.Spline("path", body, moves[-1].blend, origin=moves[1].origin)
    return [first, spline, *behind]
