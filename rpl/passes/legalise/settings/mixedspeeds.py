"""Moves that take the modal speed beside moves that say one of their own, for targets where every speed is modal.

There the speed of one move would stay for the next ones. So a move without a speed gets the modal one as its own, where
it is known (`modalflow`).
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.settingsinforce import SettingsInForce
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_all, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising

UNKNOWN = code(
    "modal-speed-unknown",
    Severity.WARNING,
    "the move takes the modal speed, which depends on the run; on the target it is that of the move before",
    "say the speed of this move",
)


@legalising(unless=lambda context: not context.capabilities.settings.modal)
def mixed_speeds(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets with modal motion, and programs with both kinds of moves."""
    moves = [node for node in walk_for({"Move"}, *program.modules) if isinstance(node, ir.Move)]
    mixed = {
        kind for kind in ("path", "joint") if {_has(move) for move in moves if _kind(move) == kind} == {True, False}
    }
    if not mixed:
        return program
    flow = SettingsInForce.begun_by(program, context.source)

    def change(statement: ir.Statement) -> ir.Body:
        if not isinstance(statement, ir.Move):
            return (inside(statement, lambda inner: map_body(inner, change)),)
        kind = _kind(statement)
        if kind not in mixed or _has(statement) or statement.speed is not None:
            return (statement,)
        found = flow.at(statement).get(f"{kind}_speed")
        if found is None:
            context.diagnostics.report(UNKNOWN, statement.origin)
            return (statement,)
        return (replace(statement, speed=ir.Speed(path=found) if kind == "path" else ir.Speed(joint=found)),)

    return edit_all(program, lambda body: map_body(body, change))


def _kind(move: ir.Move) -> str:
    return "joint" if move.kind == "joint" else "path"


def _has(move: ir.Move) -> bool:
    """Does the move say its speed itself?"""
    names = {place.name for place, _ in move.settings if isinstance(place, ir.System)}
    if f"{_kind(move)}_speed" in names:
        return True
    speed = move.speed
    if speed is None:
        return False
    return (speed.joint if move.kind == "joint" else speed.path) is not None or speed.profile is not None


__all__ = ["mixed_speeds"]
