"""Trap routines that stop the robot on its path and let it go on (RAPID StopMove .. StartMove): KRL knows no such
start, but its robot goes on when the routine ends that has braked it.

The start is left out where it is the last step of the trap routine that takes time, and so is the pair that puts the
path aside in between (StorePath .. RestoPath). Every other stop is refused: the robot would go on at another time.
"""

from __future__ import annotations

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import statements_in
from rpl.passes.legalise.facts.usage import called_below
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.beside import closure, does_any
from rpl.passes.legalise.rewriting.editing import edit_bodies, edit_each, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.refusedactions import STAYS
from rpl.passes.legalise.rewriting.stopping import left_out, stopped
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import changed

_TIME = (
    *(ir.Move, ir.MoveExternal, ir.Spline, ir.Wait, ir.WaitUntil, ir.WaitForMotion, ir.Dialog, ir.StopMotion),
    *(ir.StartMotion, ir.ClearMotion, ir.StoreMotion, ir.Halt),
)
_LEAVING = (ir.Return, ir.Goto, ir.Raise, ir.Retry, ir.TryNext, ir.ResumeLevel, ir.ClearMotion, ir.StartMotion)


@legalising(sees=("StopMotion",))
def held_motion(program: ir.Program, context: Context) -> ir.Program:
    """Stops of trap routines and of what they call."""
    traps = {
        one.routine.lower()
        for one in walk_for({"ConnectInterrupt"}, *program.modules)
        if isinstance(one, ir.ConnectInterrupt)
    }
    below, timed = called_below(program, traps), closure(program, _TIME)

    def work(module: ir.Module, routine: ir.Routine) -> ir.Routine:
        name = routine.name.lower()
        if name not in below or not any(isinstance(one, ir.StopMotion) for one in walk(routine)):
            return routine
        held = _held(routine.body, timed) if name in traps else None
        if held is not None:
            return changed(routine, body=held)

        def refuse(statement: ir.Statement) -> ir.Body:
            if isinstance(statement, ir.StopMotion):
                return (stopped(statement, STAYS, context, routine=routine.name),)
            if isinstance(statement, ir.StartMotion):
                return (left_out(statement, "the stop of the motion is refused"),)
            return (inside(statement, lambda body: map_body(body, refuse)),)

        ends = any(isinstance(one, ir.ClearMotion | ir.ResumeLevel) for one in walk(routine))
        return routine if ends else edit_bodies(routine, lambda body: map_body(body, refuse))

    return edit_each(program, work)


def _held(body: ir.Body, timed: frozenset[str]) -> ir.Body | None:
    """The body of a trap routine without its start; None where the robot would go on at another time."""
    stop, start = (next((at for at, one in enumerate(body) if isinstance(one, kind)), -1) for kind in _PAIR)
    inner, behind = body[stop + 1 : start], body[start + 1 :]
    stops = sum(isinstance(one, _PAIR) for one in walk(body))
    if not 0 <= stop < start or stops != len(_PAIR) or any(isinstance(one, _LEAVING) for one in statements_in(inner)):
        return None
    if any(does_any(one, _TIME, timed) for one in behind):
        return None
    aside = [one.restore for one in inner if isinstance(one, ir.StoreMotion)] == [False, True]
    kept = (
        ir.Nothing(origin=one.origin) if isinstance(one, ir.StartMotion | ir.StoreMotion) else one
        for one in body[stop + 1 : start + 1]
    )
    left = [one for one in kept if not isinstance(one, ir.Nothing) or one.origin.comments]
    return (*body[: stop + 1], *left, *behind) if aside or not _stores(inner) else None


_PAIR = (ir.StopMotion, ir.StartMotion)


def _stores(body: ir.Body) -> bool:
    return any(isinstance(one, ir.StoreMotion) for one in walk(body))


__all__ = ["held_motion"]
