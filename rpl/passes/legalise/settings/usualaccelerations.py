"""The acceleration on paths that a language gives every program (URScript's 1.2 m/s2), where the target's is another.

A target with a setting for it (KRL `$ACC.CP`) is set so at the beginning, and around moves that say another one. The
other targets' controllers take an acceleration of their own arm: this is told, because what a program measures in time
differs then by how long the robot speeds up and brakes.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import rewrite
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.entries import moving_entries
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.formulas import plain
from rpl.passes.legalise.stages import legalising

DIFFERS = code(
    "accelerations-differ",
    Severity.WARNING,
    "the source's controller accelerates with {own:g} mm/s2 on paths, the target's as its arm does: times of short "
    "moves, and what corners save, come out otherwise",
    "where a time matters, give the moves of the target percentages of its acceleration on the robot",
)
_SETTING = "path_acceleration"
_USUAL_MM_S2 = 5000.0  # of a controller that says nothing: the emulator's value


@legalising()
def usual_accelerations(program: ir.Program, context: Context) -> ir.Program:
    """Only where the source's language says an acceleration, and the target's moves do not carry it anyway."""
    given = rules_of(context.source).system_defaults.get(_SETTING)
    can = context.capabilities
    if given is None or _SETTING in can.settings.speeds:
        return program
    own, usual = float(given), float(rules_of(context.target).system_defaults.get(_SETTING, _USUAL_MM_S2))
    first = next((node for node in walk_for({"Move"}, *program.modules) if _on_path(node)), None)
    if not isinstance(first, ir.Move):
        return program
    if _SETTING not in can.system_variables or not can.settings.modal:
        if own != usual:
            context.diagnostics.report(DIFFERS, first.origin, own=own)
        return program
    if any(isinstance(node, ir.Move) and _said(node) is not None for node in walk_for({"Move"}, *program.modules)):
        program = rewrite(program, lambda node: _set_around(node, own) if isinstance(node, ir.Move) else node)
    return program if own == usual else _set_first(program, own)


def _on_path(node: object) -> bool:
    return isinstance(node, ir.Move) and node.kind in ("linear", "circular")


def _said(move: ir.Move) -> ir.Expression | None:
    return move.speed.path_acceleration if move.speed is not None and move.kind != "joint" else None


def _set_around(move: ir.Move, own: float) -> ir.Move:
    """An acceleration of its own as a setting of the move; the usual one need not be said."""
    rate = _said(move)
    if rate is None or move.speed is None:
        return move
    speed = replace(move.speed, path_acceleration=None)
    bare = replace(move, speed=None if speed == ir.Speed() else speed)
    number = plain(rate)
    if isinstance(number, ir.RealLiteral) and abs(number.value - own) < 1e-6:
        return bare
    return replace(bare, settings=((ir.System(_SETTING), rate), *bare.settings))


def _set_first(program: ir.Program, own: float) -> ir.Program:
    """The setting at the beginning of the routines that a program may start with."""
    entries = moving_entries(program)
    setting = ir.Assign(ir.System(_SETTING), ir.Quantity(ir.RealLiteral(own), "mm/s2"))
    modules = []
    for module in program.modules:
        routines = tuple(
            replace(one, body=(setting, *one.body)) if one.name.lower() in entries and one.body else one
            for one in module.routines
        )
        modules.append(replace(module, routines=routines))
    return replace(program, modules=tuple(modules))


__all__ = ["usual_accelerations"]
