"""A move whose end is waited for, as people write it in KRL: it goes exactly to its point, and what looks at a signal
or at the robot behind it stops the advance run by itself, so that `WAIT SEC 0` stands only in front of what does not.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from rpl import ir
from rpl.passes.legalise.context import Context, ProgramScope, rules_of
from rpl.passes.legalise.facts.motion.advance import touches
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies
from rpl.passes.scope import Scope

__all__ = ["plain_stops"]


@legalising(sees=("WaitForMotion",))
def plain_stops(program: ir.Program, context: Context) -> ir.Program:
    """Waits that stand right behind the move."""
    scopes = ProgramScope(program)
    stops = rules_of(context.target).advance.stop_statements
    modules = []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            work = partial(_body, scope=scopes.routine(module, routine), stops=stops)
            routines.append(edit_bodies(routine, work))
        modules.append(replace(module, routines=tuple(routines)))
    return replace(program, modules=tuple(modules))


def _body(body: ir.Body, scope: Scope, stops: frozenset[str]) -> ir.Body:
    done: list[ir.Statement] = []
    for at, statement in enumerate(body):
        before = done[-1] if done else None
        if isinstance(statement, ir.WaitForMotion) and isinstance(before, ir.Move) and not before.concurrent:
            done[-1] = replace(before, blend=ir.BlendStop())
            if not _stops(body[at + 1 :], scope, stops):
                done.append(statement)
            elif statement.origin.comments:
                done.append(ir.Nothing(origin=statement.origin))
            continue
        done.append(rewrite_bodies(statement, lambda inner: _body(inner, scope, stops)))
    return tuple(done)


def _stops(rest: ir.Body, scope: Scope, stops: frozenset[str]) -> bool:
    """Does what comes next stop the advance run before it does anything?"""
    following = next((one for one in rest if not isinstance(one, ir.Nothing)), None)
    if following is None or isinstance(following, ir.If | ir.Switch | ir.For | ir.While | ir.Repeat | ir.Loop):
        return False
    return following.__class__.__name__ in stops or touches(following, scope)
