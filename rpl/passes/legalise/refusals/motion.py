"""Interrupts and searches for targets that have none, and forms of motion that no target is given."""

from __future__ import annotations

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.capabilities import InterruptRule
from rpl.passes.legalise.interrupts.identities import ASKED, ORDERED, SEVERAL
from rpl.passes.legalise.places.nextmove.queuedwaits import PAUSED_TIMED
from rpl.passes.legalise.records.arcdistances import STRAIGHT as COMPUTED_ON_ARC
from rpl.passes.legalise.records.arcdistances import TIMED as TIMED_ON_ARC
from rpl.passes.legalise.records.pathevents import NOT_WATCHED as NO_PATH_TASK
from rpl.passes.legalise.records.watching import LOST as NOT_WATCHED
from rpl.passes.legalise.refusals.rows import PLAINLY, Asked, Found, Refusal
from rpl.passes.legalise.rewriting.refusedactions import BRAKED, ON_JOINT_MOVE, STAYS
from rpl.passes.legalise.source.rates import LOST as RATE
from rpl.passes.legalise.source.ways.constantorientations import FIXED
from rpl.passes.legalise.source.ways.constantorientations import LOST as KEPT

__all__ = ["MOTION", "WAITED_FOR"]

INTERRUPT = code(
    "interrupt-lost",
    Severity.LOSS,
    "the target has no interrupts; {action} does not run when the condition comes true",
    "watch the condition in a task of its own or with the controller's monitoring function",
    stops=True,
)
SEARCH = code(
    "search-lost",
    Severity.LOSS,
    "the target's moves do not watch a condition on their way",
    "use the controller's own search function, or drive in short steps and ask the condition between them",
    stops=True,
)
ALONE = code(
    "interrupt-held-alone",
    Severity.LOSS,
    "the target holds back all interrupts or none, not one alone",
    "switch the interrupt off here, or let its routine ask a variable that is set here",
    stops=True,
)
WAITED_FOR = code(
    "concurrent-move",
    Severity.LOSS,
    "the program goes on while this move is driven; the target's program waits for its end",
    "write what stands beside the move as an action on its path, or in a task of its own",
)
_INTERRUPTS = frozenset(("DeclareInterrupt", "ConnectInterrupt"))


def _declared(statement: ir.DeclareInterrupt, asked: Asked) -> Found:
    if _INTERRUPTS & asked.can.statements:
        return ()
    action = statement.action
    return ({"action": action.name if isinstance(action, ir.CallRoutine) else "an assignment"},)


def _connected(statement: ir.ConnectInterrupt, asked: Asked) -> Found:
    return () if _INTERRUPTS & asked.can.statements else ({"action": statement.routine},)


def _held_alone(statement: ir.ControlInterrupt, asked: Asked) -> Found:
    given = InterruptRule.SINGLE_DISABLES in asked.can.interrupts.rules or not _INTERRUPTS & asked.can.statements
    return PLAINLY if not given and statement.op in ("disable", "enable") and statement.handle is not None else ()


def _search(statement: ir.Move, asked: Asked) -> Found:
    can = asked.can.statements
    return PLAINLY if statement.search is not None and "Search" not in can and not _INTERRUPTS & can else ()


MOTION = (
    Refusal("an interrupt", INTERRUPT, (ir.DeclareInterrupt,), _declared),
    Refusal("an interrupt of a trap routine", INTERRUPT, (ir.ConnectInterrupt,), _connected),
    Refusal("one interrupt that is held back and goes on later", ALONE, (ir.ControlInterrupt,), _held_alone),
    Refusal("an interrupt variable of several routines", SEVERAL),
    Refusal("an interrupt variable that is ordered in several ways", ORDERED),
    Refusal("a routine that asks which interrupt has called it", ASKED),
    Refusal("an interrupt that no task and no search can stand for", NOT_WATCHED),
    Refusal("an interrupt that brakes a move which goes on behind it", BRAKED),
    Refusal("a motion that an interrupt stops and that goes on before its routine has ended, or later", STAYS),
    Refusal("a move that a condition ends", SEARCH, (ir.Move,), _search),
    Refusal("a move that the program does not wait for", WAITED_FOR),
    Refusal("an action at a place of an arc that the run decides", COMPUTED_ON_ARC),
    Refusal("an action on the way of a joint move, where moves are cut at places", ON_JOINT_MOVE),
    Refusal("an action on the path that no task beside the move can do", NO_PATH_TASK),
    Refusal("an action a time before or behind a place on an arc", TIMED_ON_ARC),
    Refusal("a time that the program takes while the robot pauses", PAUSED_TIMED),
    Refusal("a path that keeps the orientation of its start, where its end is written with another one", KEPT),
    Refusal("an arc along which the tool stays as it is to the arc", FIXED),
    Refusal("a motion at a given speed whose loop counts its passes or does other work", RATE),
)
