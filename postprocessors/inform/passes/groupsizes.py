"""Groups of signals as INFORM has them: eight or four in a row (IG#, IGH#), each behind a multiple of its size.

Those of another size become groups of these sizes and single signals: sixteen signals are two bytes.
"""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.signalgroups import Group, GroupsInParts, group_of
from rpl.passes.legalise.stages import legalising

from .. import tables


@legalising(sees=("Signal",))
def groups_in_sizes(program: ir.Program, context: Context) -> ir.Program:
    """Groups of another size, or that begin elsewhere, in parts."""
    odd = _odd(program)
    if not odd:
        return program

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, GroupsInParts(editor, odd, sizes=tables.GROUP_SIZES).body)

    return edit_routines(program, context, work)


def _odd(program: ir.Program) -> frozenset[Group]:
    """Groups of other sizes, or that do not begin behind a multiple of their size."""
    found = (
        group_of(node)
        for node in walk_for({"Signal"}, *program.modules)
        if isinstance(node, ir.Signal) and node.last is not None
    )
    return frozenset(one for one in found if one is not None and not _fits(one))


def _fits(group: Group) -> bool:
    _, first, last = group
    return any(last - first == size - 1 and (first - 1) % size == 0 for size in tables.GROUP_SIZES)


__all__ = ["groups_in_sizes"]
