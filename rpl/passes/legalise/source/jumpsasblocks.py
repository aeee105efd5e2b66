"""Jumps that are loops and branches, written as such although the target has jumps.

In a language without endless loops (TP, INFORM, RAPID) a programmer jumps back because there is no other word for it.
In one that has the word, its programmer writes the loop. Where a language has both, a jump was wanted and stays.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.passes.conditions import opposite
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import statements_in
from rpl.passes.legalise.rewriting.editing import Editor, edit_routines
from rpl.passes.legalise.rewriting.structuring.structured import restructured
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import changed

# What may be made of jumps where the target has a word for it.
_LOOPING = frozenset(("Repeat", "ExitLoop", "NextPass"))


def _jumps_stay(context: Context) -> bool:
    can = context.capabilities
    if not context.foreign or can.carries_rules or not {"Goto", "Label", "While"} <= can.statements:
        return True
    return context.source not in registry.target_names() or "Loop" in _statements(context.source)


def _statements(language: str) -> frozenset[str]:
    return registry.target(language).capabilities().statements


@legalising(unless=_jumps_stay, sees=("Goto",))
def jumps_as_blocks(program: ir.Program, context: Context) -> ir.Program:
    """For targets with jumps and loops, from languages without endless loops. A routine that would need a flag for it
    keeps its jumps."""

    nested = "Repeat" in context.capabilities.statements

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        plain = routine.returns is None and routine.kind != "function"
        body = _nested(routine.body) if nested else routine.body
        return changed(routine, body=_in_blocks(editor, body, bool(routine.handlers), plain))

    return edit_routines(program, context, work)


def _nested(body: ir.Body) -> ir.Body:
    """Several checks that go back to one label, each further on than the one before, are loops in one another: `*A`,
    ..., `JUMP *A IF I<2`, ..., `JUMP *A IF J<2`."""
    jumps = Counter(one.label for one in statements_in(body) if isinstance(one, ir.Goto))
    for at, label in enumerate(body):
        if not isinstance(label, ir.Label):
            continue
        checks = [place for place in range(at + 1, len(body)) if _goes_back(body[place], label.name)]
        if len(checks) < 2 or len(checks) != jumps[label.name]:
            continue
        done: ir.Body = ()
        start = at + 1
        for place in checks:
            done = (_repeat((*done, *body[start:place]), body[place]),)
            start = place + 1
        if not _has_jumps(done):
            head = replace(done[0], origin=label.origin)
            return _nested((*body[:at], head, *body[start:]))
    return body


def _goes_back(statement: ir.Statement, label: str) -> bool:
    match statement:
        case ir.If(branches=((_, (ir.Goto(label=where),)),), otherwise=()):
            return where == label
    return False


def _repeat(body: ir.Body, check: ir.Statement) -> ir.Repeat:
    """The body until the check does not go back; what is remarked at the check stands at the end of the body."""
    assert isinstance(check, ir.If)
    condition, jump = check.branches[0]
    remarks = tuple(ir.Nothing(origin=one.origin) for one in (check, *jump) if one.origin.comments)
    return ir.Repeat(opposite(condition), (*body, *remarks), origin=replace(check.origin, comments=()))


def _has_jumps(body: ir.Body) -> bool:
    return any(isinstance(one, ir.Goto | ir.Label | ir.ExitLoop | ir.NextPass) for one in statements_in(body))


def _in_blocks(editor: Editor, body: ir.Body, raises: bool, returns: bool) -> ir.Body:
    """The body in blocks, if the target has all of them and nothing is needed besides; else the body itself."""
    before = list(statements_in(body))
    if not any(isinstance(one, ir.Goto) for one in before):
        return body
    apart = replace(editor.context, diagnostics=Diagnostics(), taken=set(editor.context.taken))
    trial = Editor(apart, editor.effects, editor.scope)
    done = restructured(trial, body, raises, returns)
    lacking = (_LOOPING - editor.capabilities.statements) | {"Goto"}
    after = list(statements_in(done))
    if trial.added or len(after) > len(before) or any(one.__class__.__name__ in lacking for one in after):
        return body
    return done


__all__ = ["jumps_as_blocks"]
