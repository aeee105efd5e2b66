"""Ports that a program writes and reads by one name are one memory: what it reads is what it has written. Targets have
inputs and outputs of their own, so such a reading becomes one of the output.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.stages import legalising

_OUTPUTS = {"digital_in": "digital_out", "group_in": "group_out", "analog_in": "analog_out"}


@legalising(unless=lambda context: context.capabilities.carries_rules, sees=("Signal",))
def read_ports(program: ir.Program, context: Context) -> ir.Program:
    """Only for programs with such a port; names that a declaration gives are signals of one kind."""
    named = {
        (one.kind, one.name.lower())
        for one in walk_for({"Signal"}, *program.modules)
        if isinstance(one, ir.Signal) and one.name
    }
    both = {(kind, name) for kind, name in named if (_OUTPUTS.get(kind, ""), name) in named}
    if not both:
        return program

    def read(node: object) -> object:
        if isinstance(node, ir.Signal) and node.name and (node.kind, node.name.lower()) in both:
            return replace(node, kind=_OUTPUTS[node.kind])
        return node

    return replace(program, modules=tuple(rewrite(module, read) for module in program.modules))


__all__ = ["read_ports"]
