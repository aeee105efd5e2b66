"""Waits for the end of the motion, for targets that say them at the move (FINE, PL=0).

A routine that begins with such a wait (V+ `BREAK` in the one that opens the gripper) would have to wait for a move of
its caller: the wait stands in front of its calls, where each is behind a move. Where the robot rests anyway, from the
start of the program or behind a move without a corner, there is nothing to wait for. Else such a target has only a
move to where the robot is.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Mapping
from dataclasses import replace

from rpl import ir
from rpl.ir.walk import bodies
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.facts.forward import started
from rpl.passes.legalise.facts.mentioned import naming_of_routines
from rpl.passes.legalise.facts.motion.resting import Rests
from rpl.passes.legalise.facts.values.heldtexts import named_by_texts
from rpl.passes.legalise.kinds import kinds_in
from rpl.passes.legalise.rewriting.editing import edit_all, map_body
from rpl.passes.legalise.rewriting.exactends import ending_exactly, says_nothing
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import changed
from rpl.source import NOWHERE

__all__ = ["waits_at_moves"]

_WAITS = frozenset(("WaitForMotion",))
_BESIDE = frozenset(
    ("DeclareInterrupt", "ConnectInterrupt", "Trigger", "DefineTrigger", "OnError", "TaskControl", "MoveExternal")
)


@legalising(
    unless=lambda context: "statement WaitForMotion" not in context.capabilities.said_otherwise,
    sees=_WAITS,
)
def waits_at_moves(program: ir.Program, context: Context) -> ir.Program:
    """Only in programs where nothing runs beside that might move the robot."""
    if program.tasks or kinds_in(program) & _BESIDE:
        return program
    program = edit_all(program, ending_exactly, _WAITS)
    program = edit_all(_at_calls(program), ending_exactly, _WAITS)
    resting = _resting(program)

    def waited(body: ir.Body) -> ir.Body:
        return map_body(body, change, _WAITS)

    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.WaitForMotion) and resting.before.get(id(statement), False):
            return (ir.Nothing(origin=statement.origin),) if statement.origin.comments else ()
        return (inside(statement, waited),)

    return edit_all(program, waited, _WAITS)


def _resting(program: ir.Program) -> Rests:
    resting = Rests(program)
    resting.solve(sorted(started(program)), [])
    return resting


def _at_calls(program: ir.Program) -> ir.Program:
    """The program with the waits that routines begin with in front of their calls."""
    begin = {
        routine.name.lower()
        for module in program.modules
        for routine in module.routines
        if isinstance(_first(routine.body), ir.WaitForMotion)
    }
    if not begin:
        return program
    begin -= {program.entry.lower(), *started(program)} | named_by_texts(program)
    behind, resting = Counter[str](), _resting(program).before
    for module in program.modules:
        for routine in module.routines:
            for body in bodies(routine):
                _count(body, behind, resting)
    named = naming_of_routines(program)
    routines = Counter(one.name.lower() for module in program.modules for one in module.routines)
    moved = {name for name in begin if routines[name] == 1 and 0 < behind[name] == named[name]}
    if not moved:
        return program
    modules = []
    for module in program.modules:
        parts = (
            replace(one, body=_without_first(one.body)) if one.name.lower() in moved else one for one in module.routines
        )
        modules.append(changed(module, routines=tuple(parts)))
    done = changed(program, modules=tuple(modules))
    return edit_all(done, lambda body: _waiting(body, moved), frozenset(("CallRoutine",)))


def _first(body: ir.Body) -> ir.Statement | None:
    return next((one for one in body if not says_nothing(one)), None)


def _without_first(body: ir.Body) -> ir.Body:
    """The body without the wait that it begins with; what is said about it stays."""
    first = _first(body)
    done: list[ir.Statement] = []
    for one in body:
        if one is not first:
            done.append(one)
        elif one.origin.comments:
            done.append(ir.Nothing(origin=one.origin))
    return tuple(done)


def _count(body: ir.Body, behind: Counter[str], resting: Mapping[int, bool]) -> None:
    """Calls that stand directly behind a move or such a wait, or to which the robot comes at rest."""
    before: ir.Statement | None = None
    for statement in body:
        if isinstance(statement, ir.CallRoutine) and statement.dynamic is None:
            said = isinstance(before, ir.Move | ir.WaitForMotion) or resting.get(id(statement), False)
            behind[statement.name.lower()] += said
        if not says_nothing(statement):
            before = statement
        for inner in blocks(statement):
            _count(inner, behind, resting)


def _waiting(body: ir.Body, moved: Collection[str]) -> ir.Body:
    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.CallRoutine) and statement.name.lower() in moved:
            where = replace(statement.origin, comments=()) if statement.origin is not NOWHERE else NOWHERE
            return (ir.WaitForMotion(origin=where), statement)
        return (inside(statement, lambda inner: _waiting(inner, moved)),)

    return map_body(body, change, frozenset(("CallRoutine",)))
