"""ENWAIT: what stands behind a move is done before the robot gets to its end.

M: this is the one instruction behind the move; an output that it sets becomes an action on the path. M: a time is
counted back from the moment when the robot is there, a distance along its path.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.source import Origin

NOT_EARLY = code(
    "inform-not-early",
    Severity.WARNING,
    "ENWAIT is read with an instruction behind it that sets outputs; this one is done where the robot has arrived",
)
NOT_ANTICIPATED = code(
    "inform-not-anticipated",
    Severity.WARNING,
    "ANTOUT is read directly behind a move; this one is done at once",
)


@dataclass(frozen=True, slots=True)
class Early:
    """How far before the end of the move: mm (`distance`) or s (`delay`)."""

    distance: ir.Expression | None
    delay: ir.Expression | None


def before(value: ir.Expression, origin: Origin) -> ir.Expression:
    """So much before: the value with the other sign."""
    match value:
        case ir.RealLiteral(value=number):
            return ir.RealLiteral(-number, origin=origin)
        case ir.IntLiteral(value=number):
            return ir.RealLiteral(-float(number), origin=origin)
    return ir.Unary("-", value, origin=origin)


def with_actions(
    done: list[ir.Statement], early: Early, made: Sequence[ir.Statement], diagnostics: Diagnostics
) -> None:
    """Adds the statements behind a move that stands in `done`: what sets outputs becomes an action in front of it."""
    at = max(n for n, one in enumerate(done) if isinstance(one, ir.Move))
    actions = [one for one in made if isinstance(one, ir.Assign) and isinstance(one.target, ir.Signal)]
    if not made or len(actions) < len(made):
        origin = made[0].origin if made else done[at].origin
        diagnostics.report(NOT_EARLY, origin)
        done.extend(made)
        return
    comments = tuple(comment for one in actions for comment in one.origin.comments)
    plain = [replace(one, origin=replace(one.origin, comments=())) for one in actions]
    triggers = [ir.Trigger("end", one, early.distance, early.delay, origin=one.origin) for one in plain]
    done[at:at] = triggers
    if comments:
        done.append(ir.Nothing(origin=replace(plain[0].origin, comments=comments)))


def anticipated(
    done: list[ir.Statement], delay: ir.Expression, made: Sequence[ir.Statement], diagnostics: Diagnostics
) -> None:
    """ANTOUT behind a move: so many seconds after the robot has come to its point (before it, where negative). M: with
    no move in front of it, at once."""
    at = next((n for n in range(len(done) - 1, -1, -1) if not isinstance(done[n], ir.Nothing)), None)
    actions = [one for one in made if isinstance(one, ir.Assign)]
    if at is None or not isinstance(done[at], ir.Move) or len(actions) < len(made):
        diagnostics.report(NOT_ANTICIPATED, made[0].origin)
        done.extend(made)
        return
    done[at:at] = [ir.Trigger("end", one, None, delay, origin=one.origin) for one in actions]


__all__ = ["Early", "anticipated", "before", "with_actions"]
