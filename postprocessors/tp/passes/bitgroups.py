"""Groups of signals bit by bit: TP has single signals, and groups that the controller declares."""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import kinds_in
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.signalgroups import GroupsAsBits
from rpl.passes.legalise.stages import legalising


@legalising(sees=("Signal",))
def groups_to_bits(program: ir.Program, context: Context) -> ir.Program:
    """Groups that are given by their first and last signal; the numbers of some have been given by now."""
    named = "SignalDeclaration" in kinds_in(program)  # then a name may stand for a group
    acts_on = frozenset(("Signal", "Name") if named else ("Signal",))

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, GroupsAsBits(editor, acts_on).body)

    return edit_routines(program, context, work, acts_on)
