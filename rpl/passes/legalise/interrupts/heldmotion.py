"""Interrupt routines that stop the robot on its path and let it go on (RAPID StopMove .. StartMove), for targets that
know no such start, but whose robot goes on when the routine ends that has braked it (KRL).

A start that is the last thing in the routine which takes time is left out, and so is the pair that puts the path aside
in between (StorePath .. RestoPath). Everything else is named: there the robot would go on at another time.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

from rpl import ir
from rpl.diagnostics import Code, Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes.capabilities import InterruptRule, Watched
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import statements_in
from rpl.passes.legalise.facts.usage import called_below
from rpl.passes.legalise.rewriting.beside import closure
from rpl.passes.legalise.rewriting.editing import edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising
from rpl.source import Comment

STAYS = code(
    "motion-stays-stopped",
    Severity.LOSS,
    "{routine} stops the robot, and it goes on only when something else says so: on the target it goes on when the"
    " interrupt routine ends",
    "start the motion again at the end of the routine that stops it",
)
EARLY = code(
    "motion-goes-on-early",
    Severity.LOSS,
    "{routine} lets the robot go on before it has ended: on the target the robot goes on when the routine ends",
    "put what takes time behind the start into the program, or in front of it",
)
_TIME = (
    *(ir.Move, ir.MoveExternal, ir.Spline, ir.Wait, ir.WaitUntil, ir.WaitForMotion, ir.Dialog, ir.StopMotion),
    *(ir.StartMotion, ir.ClearMotion, ir.StoreMotion, ir.Halt),
)
_LEAVING = (ir.Return, ir.Goto, ir.Raise, ir.Retry, ir.TryNext, ir.ResumeLevel, ir.ClearMotion, ir.StartMotion)


@legalising(
    unless=lambda context: "StartMotion" in context.capabilities.statements or drops_braked(context),
    sees=("StopMotion",),
)
def held_motion(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that cannot start the motion again by a word of their own, and whose brake does not drop it."""
    connected: set[str] = set()
    declared: set[str] = set()
    for node in walk(*program.modules):
        match node:
            case ir.ConnectInterrupt(routine=name):
                connected.add(name.lower())
            case ir.DeclareInterrupt(action=ir.CallRoutine(name=name)):
                declared.add(name.lower())
    if not (connected | declared) & closure(program, (ir.StopMotion,)):
        return program
    handlers = called_below(program, connected | declared)
    worker = _Held(context, closure(program, _TIME), called_below(program, connected))
    worker.ending = worker.ends(program, connected | declared)
    return edit_routines(
        program,
        context,
        lambda editor, routine: worker.routine(routine) if routine.name.lower() in handlers else routine,
    )


def drops_braked(context: Context) -> bool:
    """Is a move that was stopped gone on the target, so that it would have to begin again in its middle?"""
    can = context.capabilities
    watched = can.interrupts.watched in (Watched.ALL, Watched.INTERRUPTS)
    return InterruptRule.STOPPING in can.interrupts.rules or watched or "StopMotion" not in can.statements


@dataclass(slots=True)
class _Held:
    """Routines (folded): `timed` take time; the end of the `connected` ones does not start the motion again; an
    interrupt ends with the `ending` ones."""

    context: Context
    timed: frozenset[str]
    connected: frozenset[str]
    ending: frozenset[str] = frozenset()
    name: str = ""
    strict: bool = False

    def routine(self, routine: ir.Routine) -> ir.Routine:
        self.name, self.strict = routine.name, routine.name.lower() in self.connected
        return edit_bodies(routine, partial(self.body, last=routine.name.lower() in self.ending))

    def ends(self, program: ir.Program, roots: set[str]) -> frozenset[str]:
        """The interrupt routines, and those that are called only where nothing that takes time follows in one."""
        calls: dict[str, int] = {}
        last: dict[str, int] = {}
        for module in program.modules:
            for routine in module.routines:
                for node in walk(*bodies(routine)):
                    if isinstance(node, ir.CallRoutine):
                        calls[node.name.lower()] = calls.get(node.name.lower(), 0) + 1
                if routine.name.lower() in roots:
                    for at, statement in enumerate(routine.body):
                        if isinstance(statement, ir.CallRoutine) and not any(
                            map(self.takes_time, routine.body[at + 1 :])
                        ):
                            last[statement.name.lower()] = last.get(statement.name.lower(), 0) + 1
        return frozenset((*roots, *(name for name, count in last.items() if calls[name] == count)))

    def takes_time(self, statement: ir.Statement) -> bool:
        for node in walk(statement):
            match node:
                case ir.CallRoutine(name=name) | ir.Call(name=name) if name.lower() in self.timed:
                    return True
            if isinstance(node, _TIME):
                return True
        return False

    def body(self, body: ir.Body, last: bool) -> ir.Body:
        """`last`: nothing that takes time follows in the routine."""
        done: list[ir.Statement] = []
        at = 0
        while at < len(body):
            statement = body[at]
            if isinstance(statement, ir.StopMotion):
                end = self.start_behind(body, at)
                if end is not None:
                    done.extend(self.pair(body, at, end, last))
                    at = end + 1
                    continue
                if any(isinstance(one, ir.ClearMotion | ir.ResumeLevel) for one in body[at:]):
                    pass  # what it stopped does not go on
                elif self.strict:
                    done.extend(self.lost(STAYS, statement))
            if isinstance(statement, ir.If | ir.Switch):
                quiet = last and not any(map(self.takes_time, body[at + 1 :]))
                statement = inside(statement, partial(self.body, last=quiet))
            done.append(statement)
            at += 1
        same = len(done) == len(body) and all(new is old for new, old in zip(done, body, strict=True))
        return body if same else tuple(done)

    def start_behind(self, body: ir.Body, at: int) -> int | None:
        """The start that certainly follows the stop."""
        for place in range(at + 1, len(body)):
            if isinstance(body[place], ir.StartMotion):
                return place
            if any(isinstance(one, _LEAVING) for one in statements_in((body[place],))):
                return None
        return None

    def pair(self, body: ir.Body, at: int, end: int, last: bool) -> ir.Body:
        between = list(body[at + 1 : end])
        stored = [one for one in between if isinstance(one, ir.StoreMotion)]
        if [one.restore for one in stored] == [False, True]:
            between = [_remark(one) if isinstance(one, ir.StoreMotion) else one for one in between]
        kept = [one for one in (*between, _remark(body[end])) if not _empty(one)]
        if not last or any(map(self.takes_time, body[end + 1 :])):
            return (*self.lost(EARLY, body[at]), *body[at : end + 1])
        return (body[at], *kept)

    def lost(self, what: Code, statement: ir.Statement) -> ir.Body:
        """Named, and the program stops here: no robot may drive on by itself."""
        self.context.diagnostics.report(what, statement.origin, routine=self.name)
        remark = Comment(" the motion would go on at another time than in the source")
        return (ir.Halt(origin=replace(statement.origin, comments=(remark,))),)


def _remark(statement: ir.Statement) -> ir.Statement:
    return ir.Nothing(origin=statement.origin)


def _empty(statement: ir.Statement) -> bool:
    return isinstance(statement, ir.Nothing) and not statement.origin.comments


__all__ = ["drops_braked", "held_motion"]
