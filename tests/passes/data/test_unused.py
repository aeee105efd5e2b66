"""Routines without types that nothing calls do not go along; what is called does."""

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.source.data.untyped import drop_untyped

from .helpers import RAPID

UNKNOWN = ir.VendorType("there", "handle")


def program(*body: ir.Statement) -> ir.Program:
    heavy = ir.Routine("heavy", parameters=(ir.Parameter("p", UNKNOWN),), body=())
    main = ir.Routine("main", body=body)
    return ir.Program((ir.Module("m", "there", routines=(main, heavy)),), entry="main")


@pytest.mark.parametrize(
    ("body", "kept"),
    [
        ((), False),
        ((ir.CallRoutine("heavy", (ir.Argument(ir.IntLiteral(1)),)),), True),
        ((ir.TaskControl("start", "Heavy"),), True),
        ((ir.OnError("heavy"),), True),
    ],
)
def test_a_routine_without_types_goes_along_only_when_used(body: ir.Body, kept: bool) -> None:
    diagnostics = Diagnostics()
    context = Context("there", "here", RAPID, diagnostics)
    found = drop_untyped(program(*body), context)
    names = [routine.name for routine in found.modules[0].routines]
    assert ("heavy" in names) is kept
    assert [item.code.name for item in diagnostics] == ([] if kept else ["routine-never-called"])
