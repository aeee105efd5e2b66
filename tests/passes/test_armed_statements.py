"""What may run while an interrupt is on, also where a loop is left, begun anew or jumped out of while it is."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.passes.legalise.facts.reach import Armed, armed_statements

YES = ir.Name("yes")
ON, OFF = ir.ControlInterrupt("on", ir.IntLiteral(5)), ir.ControlInterrupt("off", ir.IntLiteral(5))
BEHIND = ir.Wait(ir.RealLiteral(1.0))


def chosen(*body: ir.Statement) -> ir.Statement:
    return ir.If(((YES, body),))


CASES: list[tuple[str, ir.Body, bool]] = [
    ("turned off", (ir.Loop((ON, OFF, chosen(ir.ExitLoop()))), BEHIND), False),
    ("left", (ir.Loop((ON, chosen(ir.ExitLoop()), OFF)), BEHIND), True),
    ("left in a branch", (ir.While(YES, (chosen(ON, ir.ExitLoop()), OFF)), BEHIND), True),
    ("begun anew", (ir.While(YES, (BEHIND, ON, chosen(ir.NextPass()), OFF)),), True),
    ("jumped out of", (ir.Loop((ON, chosen(ir.Goto("out")), OFF)), ir.Label("out"), BEHIND), True),
    ("jumped back", (ir.Label("again"), BEHIND, ON, chosen(ir.Goto("again")), OFF), True),
    ("jumped over", (chosen(ir.Goto("out")), ON, OFF, ir.Label("out"), BEHIND), False),
]


@pytest.mark.parametrize(("body", "armed"), [case[1:] for case in CASES], ids=[case[0] for case in CASES])
def test_what_may_run_while_it_is_on(body: ir.Body, armed: bool) -> None:
    program = ir.Program((ir.Module("m", "rpl", routines=(ir.Routine("main", body=body),)),))
    assert (id(BEHIND) in armed_statements(program, Armed(5))) is armed
