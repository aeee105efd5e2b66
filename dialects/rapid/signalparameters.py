"""Parameters of a routine that are signals: the body means the physical signal that was passed.

What writes, waits for or passes such a parameter has the signal itself already; where its value is read it is the
number that a signal reads as, like that of any other signal.
"""

from __future__ import annotations

from rpl import ir
from rpl.ir.walk import rewrite

from .expressions import compared, read_signal


def with_signal_parameters(routine: ir.Routine) -> ir.Routine:
    """The routine with readings of its signal parameters said as signals."""
    kinds = {one.name.lower(): one.type.kind for one in routine.parameters if isinstance(one.type, ir.SignalType)}
    if not kinds:
        return routine

    def read(node: object) -> object:
        match node:
            case ir.Name(id=name) if name.lower() in kinds:
                return read_signal(ir.Signal(kinds[name.lower()], name=name, origin=node.origin))
            case ir.Binary(op="=" | "<>" as op, left=left, right=right):
                done = compared(op, left, right)
                return node if isinstance(done, ir.Binary) else done
        return node

    return rewrite(routine, read)
