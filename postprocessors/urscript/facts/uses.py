"""What a program does with its variables, as far as the writer asks."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

from rpl import ir
from rpl.passes.legalise.facts.usage import usage_of
from rpl.passes.legalise.kinds import walk_for
from rpl.source import NOWHERE


@dataclass(frozen=True, slots=True)
class Uses:
    """Folded names. `unasked`: flags of waits that nothing asks. `assigned`: what something in the program assigns."""

    unasked: frozenset[str]
    assigned: frozenset[str]

    @staticmethod
    def of(program: ir.Program) -> Uses:
        return Uses(_unasked(program), frozenset(usage_of(program).assigned))


def _unasked(program: ir.Program) -> frozenset[str]:
    """Variables that passes have made for waits with a limit, and that nothing asks whether it was passed; folded."""
    named, told = Counter[str](), Counter[str]()
    for node in walk_for({"Name", "WaitUntil"}, *program.modules):
        match node:
            case ir.Name(id=name):
                named[name.lower()] += 1
            case ir.WaitUntil(timed_out=ir.Name(id=name)):
                told[name.lower()] += 1
    made = {
        one.name.lower()
        for module in program.modules
        for routine in module.routines
        for one in routine.declarations
        if isinstance(one, ir.Variable) and one.origin is NOWHERE
    }
    return frozenset(name for name, count in told.items() if name in made and named[name] == count)
