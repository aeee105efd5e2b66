"""Right in front of the writer: actions belong to their move, and a move that is waited for ends exactly."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.source import Comment, Origin
from rpl.writing.target import WriteContext

CORNER = ir.BlendDistance(ir.RealLiteral(20.0))
MOVE = ir.Move("linear", ir.Name("C0001"), blend=CORNER)
EXACT = replace(MOVE, blend=ir.BlendStop())
WAIT = ir.WaitForMotion()
COUNT = ir.Assign(ir.Name("I001"), ir.IntLiteral(1))
SWITCH = ir.Assign(ir.Signal("digital_out", ir.IntLiteral(1)), ir.BoolLiteral(True))
ACTION = ir.Trigger("start", SWITCH, distance=ir.RealLiteral(50.0))
LATER = ir.Trigger("end", SWITCH, delay=ir.RealLiteral(-0.1))
ASKED = ir.Name("B001")


def before_writing(*body: ir.Statement) -> ir.Body:
    program = ir.Program((ir.Module("m", "rpl", routines=(ir.Routine("main", body=body),)),))
    for one in registry.target("inform").last():
        program = one(program, WriteContext(Diagnostics()))
    return program.modules[0].routines[0].body


def remark(text: str) -> Comment:
    return Comment(text)


def test_an_awaited_move_ends_exactly_and_the_wait_stays() -> None:
    assert before_writing(MOVE, WAIT) == (EXACT, WAIT)
    assert before_writing(ir.Loop((MOVE, WAIT))) == (ir.Loop((EXACT, WAIT)),)


def test_only_variables_may_be_calculated_in_between() -> None:
    assert before_writing(MOVE, COUNT, ir.If(((ASKED, (COUNT,)),)), WAIT) == (
        *(EXACT, COUNT, ir.If(((ASKED, (COUNT,)),)), WAIT),
    )
    for other in (SWITCH, ir.If(((ASKED, (SWITCH,)),)), ir.Wait(ir.RealLiteral(1.0)), ir.CallRoutine("other")):
        assert before_writing(MOVE, other, WAIT)[0] == MOVE
    assert before_writing(MOVE, COUNT) == (MOVE, COUNT)


def test_of_two_moves_the_last_one_is_awaited() -> None:
    assert before_writing(MOVE, MOVE, WAIT) == (MOVE, EXACT, WAIT)


def test_actions_go_to_the_next_move_behind_its_own() -> None:
    own = replace(MOVE, triggers=(LATER,))
    assert before_writing(ACTION, COUNT, own, MOVE) == (COUNT, replace(MOVE, triggers=(LATER, ACTION)), MOVE)


def test_equal_actions_all_stay() -> None:
    assert before_writing(ACTION, ACTION, MOVE) == (replace(MOVE, triggers=(ACTION, ACTION)),)


def test_an_action_without_a_move_stays_where_it_is() -> None:
    body = (MOVE, ACTION, ir.Return())
    assert before_writing(*body) == body


def test_remarks_of_an_action_stand_in_front_of_those_of_the_move() -> None:
    action = replace(ACTION, origin=Origin(comments=(remark("the glue begins"),)))
    move = replace(MOVE, origin=Origin(comments=(remark("along the edge"),)))
    (found,) = before_writing(action, move)
    assert [one.text for one in found.origin.comments] == ["the glue begins", "along the edge"]
