"""Right in front of the writer: a move is cut where something acts on its way, and the actions are statements."""

from __future__ import annotations

from dataclasses import replace

import pytest
from rpl.postprocessors.inform.passes.cutmoves import cut_moves

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.writing.target import WriteContext

STOP = ir.BlendStop()
ON = ir.Assign(ir.Signal("digital_out", ir.IntLiteral(1)), ir.BoolLiteral(True))
OFF = replace(ON, value=ir.BoolLiteral(False))
WAIT = ir.WaitForMotion()
ASKED = ir.Name("B001")


def place(x: float, y: float = 0.0) -> ir.Aggregate:
    values = (x, y, 300.0, 0.0, 180.0, 0.0)
    return ir.Aggregate(tuple((name, ir.RealLiteral(one)) for name, one in zip(ir.POSE, values, strict=True)))


def line(x: float, *triggers: ir.Trigger, blend: ir.Blend = STOP) -> ir.Move:
    return ir.Move("linear", place(x), blend=blend, triggers=triggers)


def on_way(reference: str, distance: float = 0.0, action: ir.Assign = ON, delay: float = 0.0) -> ir.Trigger:
    return ir.Trigger(reference, action, distance=ir.RealLiteral(distance), delay=ir.RealLiteral(delay))


def cut(*body: ir.Statement, context: WriteContext | None = None) -> ir.Body:
    program = ir.Program((ir.Module("m", "rpl", routines=(ir.Routine("main", body=body),)),))
    return cut_moves(program, context or WriteContext(Diagnostics())).modules[0].routines[0].body


def xs(body: ir.Body) -> list[float | str]:
    """The moves by where they go, the other statements by their kinds."""
    found: list[float | str] = []
    for one in body:
        match one:
            case ir.Move(target=ir.Aggregate(entries=((_, ir.RealLiteral(value=x)), *_))):
                found.append(round(x, 3))
            case _:
                found.append(type(one).__name__)
    return found


def test_the_action_stands_behind_a_point_on_the_way() -> None:
    first, piece, action, last = cut(line(400.0), line(500.0, on_way("start", 40.0)))
    assert xs((first, piece, action, last)) == [400.0, 441.0, "Assign", 500.0]
    assert isinstance(piece, ir.Move) and isinstance(piece.blend, ir.BlendDistance)
    assert action == ON and last == line(500.0)


def test_places_on_the_way_stand_in_their_order() -> None:
    body = cut(line(400.0), line(500.0, on_way("end", -20.0, OFF), on_way("start", 40.0)))
    assert xs(body) == [400.0, 441.0, "Assign", 481.0, "Assign", 500.0]
    assert (body[2], body[4]) == (ON, OFF)


def test_what_comes_at_an_end_stands_there() -> None:
    assert cut(line(400.0), line(500.0, on_way("start"))) == (line(400.0), ON, line(500.0))
    assert cut(line(400.0), line(500.0, on_way("end"))) == (line(400.0), line(500.0), ON)


CORNER = ir.BlendDistance(ir.RealLiteral(20.0))
BEGUN = replace(line(500.0), concurrent=True)


@pytest.mark.parametrize(
    ("behind", "steps"),
    [
        ((), (WAIT,)),
        ((OFF,), (WAIT, OFF)),
        ((line(600.0),), (line(600.0),)),
        ((ir.If(((ASKED, (OFF,)),)),), (WAIT, ir.If(((ASKED, (OFF,)),)))),
        ((WAIT, line(600.0)), (ir.Nothing(), line(600.0))),
    ],
)
def test_behind_a_corner_it_is_done_on_the_way_and_the_robot_is_waited_for(behind: ir.Body, steps: ir.Body) -> None:
    round_it = line(400.0, blend=CORNER)
    assert cut(round_it, line(500.0, on_way("start")), *behind) == (round_it, BEGUN, ON, *steps)


def test_a_time_behind_the_start_is_waited_for_on_the_way() -> None:
    late = line(500.0, on_way("start", delay=0.5))
    assert cut(ir.Label("a"), late) == (ir.Label("a"), BEGUN, ir.Wait(ir.RealLiteral(0.5)), ON, WAIT)


def test_the_start_is_known_where_all_ways_lead_from_the_same_place() -> None:
    move = line(500.0, on_way("start", 40.0))
    same = ir.If(((ASKED, (line(400.0),)),), (line(400.0),))
    assert xs(cut(same, move)) == ["If", 441.0, "Assign", 500.0]
    context = WriteContext(Diagnostics())
    other = ir.If(((ASKED, (line(400.0),)),), (line(300.0),))
    assert cut(other, move, context=context) == (other, move)
    assert context.left_alone.why(move) == "the start of the move is not known, or its tool is another one"


def test_a_place_outside_of_the_move_is_refused() -> None:
    context = WriteContext(Diagnostics())
    move = line(500.0, on_way("end", 40.0))
    assert cut(line(400.0), move, context=context) == (line(400.0), move)
    assert context.left_alone.why(move) == "the place is outside of the move, 140.0 mm from its start"
