"""A variable for a setting is set where something reads it close behind; all that is read elsewhere keeps every one."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.passes.legalise.rewriting.shadows import only_served

SPEED = ir.Name("speed")


def given(value: int) -> ir.Assign:
    return ir.Assign(SPEED, ir.IntLiteral(value))


READ = ir.Assign(ir.Name("x"), SPEED)
OTHER = ir.Assign(ir.Name("y"), ir.IntLiteral(0))
CALL = ir.CallRoutine("other")
IF = ir.If(((ir.Name("b"), (READ,)),))
WATCH = ir.Trigger(ir.RealLiteral(0.0), action=READ)

CASES: list[tuple[str, ir.Body, ir.Body]] = [
    ("in vain", (given(1), OTHER, given(2), READ, given(3)), (OTHER, given(2), READ)),
    ("read twice", (given(1), READ, OTHER, READ, given(2)), (given(1), READ, OTHER, READ)),
    ("behind a call", (given(1), CALL, READ), (given(1), CALL, READ)),
    ("behind a label", (given(1), ir.Label("a"), READ), (given(1), ir.Label("a"), READ)),
    ("in a branch", (given(1), given(2), IF), (given(1), given(2), IF)),
    ("in an action that runs later", (given(1), WATCH, given(2)), (given(1), WATCH, given(2))),
    ("never read", (given(1), OTHER), (OTHER,)),
]


@pytest.mark.parametrize(("body", "wanted"), [case[1:] for case in CASES], ids=[case[0] for case in CASES])
def test_what_is_kept(body: ir.Body, wanted: ir.Body) -> None:
    program = ir.Program((ir.Module("m", "rpl", routines=(ir.Routine("main", body=body),)),))
    done = only_served(program, ["speed"])
    assert done.modules[0].routines[0].body == wanted
