"""Right in front of INFORM's writer: choices whose condition is always the same are none."""

from __future__ import annotations

from dataclasses import replace

import pytest

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.source import Comment, Origin
from rpl.writing.target import WriteContext

TRUE, FALSE, ASKED = ir.BoolLiteral(True), ir.BoolLiteral(False), ir.Signal("digital_in", ir.IntLiteral(1))


def does(number: int) -> ir.Body:
    return (ir.Assign(ir.Name("B000"), ir.IntLiteral(number)),)


def before_writing(*body: ir.Statement) -> ir.Body:
    program = ir.Program((ir.Module("m", "rpl", routines=(ir.Routine("main", body=body),)),))
    for one in registry.target("inform").last():
        program = one(program, WriteContext(Diagnostics()))
    return program.modules[0].routines[0].body


@pytest.mark.parametrize(
    "choice, left",
    [
        (ir.If(((TRUE, does(1)),)), does(1)),
        (ir.If(((FALSE, does(1)),)), ()),
        (ir.If(((FALSE, does(1)),), does(2)), does(2)),
        (ir.If(((FALSE, does(1)), (TRUE, does(2)), (ASKED, does(3))), does(4)), does(2)),
        (ir.If(((ASKED, does(1)), (FALSE, does(2))), does(3)), (ir.If(((ASKED, does(1)),), does(3)),)),
        (ir.If(((ASKED, does(1)), (TRUE, does(2))), does(3)), (ir.If(((ASKED, does(1)),), does(2)),)),
        (ir.If(((ASKED, does(1)),), does(2)), (ir.If(((ASKED, does(1)),), does(2)),)),
        (ir.If(((TRUE, (ir.If(((FALSE, does(1)),), does(2)),)),)), does(2)),
    ],
)
def test_what_is_never_done_goes(choice: ir.If, left: ir.Body) -> None:
    assert before_writing(choice) == left
    assert before_writing(ir.Loop((choice,))) == (ir.Loop(left),)


def test_a_branch_that_a_jump_goes_into_stays() -> None:
    body = (ir.Goto("there"), ir.If(((FALSE, (ir.Label("there"), *does(1))),)))
    assert before_writing(*body) == body


def test_the_remark_of_a_choice_stays() -> None:
    choice = replace(ir.If(((TRUE, does(1)),)), origin=Origin(comments=(Comment("always"),)))
    remark, *rest = before_writing(choice)
    assert isinstance(remark, ir.Nothing) and remark.origin.comments == (Comment("always"),)
    assert tuple(rest) == does(1)
