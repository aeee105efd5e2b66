"""The acceleration of one move, in percent, for targets where accelerations are modal.

It is set before the first of several moves that have it, and set back behind the last. A target with a percentage for
all moves (RAPID's AccSet, V+ ACCEL) gets that; one with accelerations of the axes and of the path (KRL) gets the
percentage of its own usual acceleration for the kind of move.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.settings.speeds import scaled
from rpl.passes.legalise.settings.strengths import has_both, own_deceleration, without_own
from rpl.passes.legalise.stages import legalising

Settings = tuple[tuple[str, ir.Expression], ...]
_USUAL_PATH = 5000.0  # mm/s2, where the target's rules say nothing
_FULL = 100.0
_MOST = 1e6
# Statements that neither drive nor lead elsewhere: the setting may stay in force around them.
_SIMPLE = (ir.Assign, ir.Nothing, ir.LookAhead, ir.Wait, ir.WaitUntil, ir.WaitForMotion, ir.Trigger, ir.Pulse)


@legalising(
    unless=lambda context: (
        (context.capabilities.settings.of_moves and "acceleration_percent" not in context.capabilities.system_variables)
        or not context.capabilities.system_variables & {"acceleration_percent", "joint_acceleration"}
    )
)
def accelerations_of_moves(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose moves do not say their acceleration."""

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, _Runs(context).body)

    return edit_routines(program, context, work)


class _Runs:
    """Runs of moves with the same acceleration."""

    def __init__(self, context: Context) -> None:
        self.can, self.both = context.capabilities.system_variables, has_both(context.source)
        self.usual = float(rules_of(context.target).system_defaults.get("path_acceleration", _USUAL_PATH))

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        force: Settings = ()
        for statement in body:
            if isinstance(statement, ir.Move):
                wanted = self.settings(statement)
                if wanted != force:
                    back = tuple(one for one in self.back(force) if one[0] not in dict(wanted))
                    done.extend(_assigned((*back, *wanted), statement))
                    statement = replace(statement, origin=replace(statement.origin, comments=()))
                force = wanted
                done.append(without_own(replace(statement, acceleration=None)) if wanted else statement)
                continue
            if force and not isinstance(statement, _SIMPLE):
                done.extend(_assigned(self.back(force), statement, first=False))
                force = ()
            done.append(inside(statement, self.body))
        if force:
            done.extend(_assigned(self.back(force), body[-1], first=False))
        same = len(done) == len(body) and all(new is old for new, old in zip(done, body, strict=True))
        return body if same else tuple(done)

    def settings(self, move: ir.Move) -> Settings:
        """What the target has to set for the move."""
        percent, down = move.acceleration, own_deceleration(move)
        full = ir.RealLiteral(_FULL)
        if percent is None and (down is None or "deceleration_percent" not in self.can):
            return ()
        if "acceleration_percent" in self.can:
            up = full if percent is None else percent
            down = down or (full if self.both else up)
            ramp = ("acceleration_ramp", full)
            return (("acceleration_percent", up), ramp if ramp[0] in self.can else ("deceleration_percent", down))
        assert percent is not None  # such targets have no deceleration
        if move.kind == "joint":
            return (("joint_acceleration", percent),)
        return (("path_acceleration", scaled(percent, self.usual / _FULL, _MOST)),)

    def back(self, settings: Settings) -> Settings:
        """The usual values of these settings."""
        usual = {"path_acceleration": self.usual}
        return tuple((name, scaled(ir.RealLiteral(usual.get(name, _FULL)), 1.0, _MOST)) for name, _ in settings)


def _assigned(settings: Settings, at: ir.Statement, first: bool = True) -> list[ir.Statement]:
    """Assignments at the place of a statement; the first takes its comments when it stands before it."""
    later = replace(at.origin, comments=())
    return [
        ir.Assign(ir.System(name), value, origin=at.origin if first and number == 0 else later)
        for number, (name, value) in enumerate(settings)
    ]


__all__ = ["accelerations_of_moves"]
