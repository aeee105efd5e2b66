"""Groups of signals bit by bit, where a target cannot say them as they are.

Where signals have names, a named group and the names of its bits are different signals: groups that overlap what else
is used become bits.
"""

from __future__ import annotations

from rpl import ir
from rpl.passes.capabilities import GroupRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.signalgroups import Group, GroupsInParts, group_of, is_computed
from rpl.passes.legalise.stages import legalising


@legalising()
def shared_groups_to_bits(program: ir.Program, context: Context) -> ir.Program:
    """Groups with computed numbers, for targets that have none; where signals have names, also groups of which another
    statement uses a part."""
    io = context.capabilities.io
    named = bool(io.signal_prefixes)
    apart = _overlapping(program) if named else frozenset()
    lacking = named or GroupRule.COMPUTED not in io.groups
    computed = lacking and any(
        isinstance(node, ir.Signal) and is_computed(node) for node in walk_for({"Signal"}, *program.modules)
    )
    if not apart and not computed:
        return program

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, GroupsInParts(editor, apart, computed).body)

    return edit_routines(program, context, work)


def _overlapping(program: ir.Program) -> frozenset[Group]:
    """Groups that have a signal in common with other signals of the program."""
    used: set[Group] = set()
    anywhere: set[str] = set()
    for node in walk_for({"Signal"}, *program.modules):
        if isinstance(node, ir.Signal):
            group = group_of(node)
            if group is not None:
                used.add(group)
            elif node.name is None:
                anywhere.add(node.kind.replace("group", "digital"))
    return frozenset(
        one
        for one in used
        if one[1] < one[2]
        and (
            one[0] in anywhere
            or any(other != one and other[0] == one[0] and other[1] <= one[2] and one[1] <= other[2] for other in used)
        )
    )
