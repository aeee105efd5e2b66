"""The base that a program starts with, for controllers that keep the base of whatever ran before.

A source whose places lie in the robot's own base says nothing about it (INFORM jobs of type BASE, URScript, V+). A KRL
program without `$BASE` drives such places in the base of the program before it, or is refused after power-on.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import takewhile

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.entries import moving_entries
from rpl.passes.legalise.facts.usage import doing
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_each
from rpl.passes.legalise.stages import legalising

_BASE = ir.System("base")


@legalising()
def start_bases(program: ir.Program, context: Context) -> ir.Program:
    """Only for programs that set no base: the controller has none of its own at the start."""
    if any(isinstance(node, ir.Assign) and node.target == _BASE for node in walk_for({"Assign"}, *program.modules)):
        return program
    entries = moving_entries(program) & doing(program, _to_a_place)

    def work(module: ir.Module, routine: ir.Routine) -> ir.Routine:
        if routine.name.lower() not in entries:
            return routine
        body = routine.body
        settings = takewhile(_is_setting, body)
        at = max((n for n, one in enumerate(settings, 1) if _is_setting(one, "tool", "advance")), default=0)
        return replace(routine, body=(*body[:at], ir.Assign(_BASE, ir.System("null_frame")), *body[at:]))

    return edit_each(program, work)


def _is_setting(statement: ir.Statement, *names: str) -> bool:
    """Does it give a system variable a value (one of these)?"""
    setting = statement.target if isinstance(statement, ir.Assign) else None
    return isinstance(setting, ir.System) and (not names or setting.name in names)


def _to_a_place(node: object) -> bool:
    """Is it a move that may go to a place in space?"""
    joints = isinstance(node, ir.Move) and isinstance(node.target, ir.Aggregate) and node.target.type_name == "joints"
    return isinstance(node, ir.Spline) or (isinstance(node, ir.Move) and node.relative != "joints" and not joints)


__all__ = ["start_bases"]
