"""Time limits of waits that a variable of the controller gives ($WAITTMOUT of TP): the seconds themselves, where every
way to the wait has set the variable to the same number. A variable that nothing else reads is gone then.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.fold import constant_number
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.values.heldvalues import Held, HeldValues, KnownData
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.unreaddata import without_unread
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies
from rpl.passes.scope import Scope

_CONTROLLERS = "$"  # how a variable of the controller itself begins; data of a program is set by hand, too


@legalising(unless=lambda context: not context.foreign, sees=("WaitUntil",))
def known_limits(program: ir.Program, context: Context) -> ir.Program:
    """Only into other languages: their waits say the limit."""
    waits = [
        one for one in walk_for({"WaitUntil"}, program) if isinstance(one, ir.WaitUntil) and one.timeout is not None
    ]
    names = {
        node.id.lower()
        for wait in waits
        for node in walk(wait.timeout)
        if isinstance(node, ir.Name) and node.id.startswith(_CONTROLLERS)
    }
    if not names:
        return program
    held = HeldValues.of(KnownData.of(program), names)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        def body(statements: ir.Body) -> ir.Body:
            return tuple(map(change, statements))

        def change(statement: ir.Statement) -> ir.Statement:
            done = rewrite_bodies(statement, body)
            if not isinstance(statement, ir.WaitUntil) or not isinstance(done, ir.WaitUntil):
                return done
            seconds = _seconds(statement.timeout, held.before(statement), editor.scope)
            return done if seconds is None else replace(done, timeout=seconds)

        return edit_bodies(routine, body)

    return without_unread(edit_routines(program, context, work), names)


def _seconds(limit: ir.Expression | None, held: Held, scope: Scope) -> ir.Expression | None:
    """The limit as a number of seconds; None where it is one, or the run decides it."""
    if limit is None or not any(isinstance(node, ir.Name) and node.id.lower() in held for node in walk(limit)):
        return None
    known = rewrite(limit, lambda node: held.get(node.id.lower(), node) if isinstance(node, ir.Name) else node)
    found = constant_number(known, scope)
    return None if found is None else ir.RealLiteral(found, origin=limit.origin)


__all__ = ["known_limits"]
