"""Right in front of the writer: actions on the way are steps, stops at corners are waits, outputs that follow later are
programs of tasks."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.source import Comment, Origin
from rpl.writing.target import WriteContext

CORNER = ir.BlendDistance(ir.RealLiteral(20.0))
OWN = ir.BlendSpeed(ir.IntLiteral(100))
EXACT = ir.Move("linear", ir.Name("a"), speed=ir.Speed(path=ir.RealLiteral(100.0)), blend=ir.BlendStop())
ROUND = replace(EXACT, blend=CORNER)
UNDER_WAY = replace(EXACT, blend=OWN)
STOP = ir.WaitForMotion()
ON = ir.Assign(ir.Signal("digital_out", ir.IntLiteral(1)), ir.BoolLiteral(True))
HERE, DEST = ir.System("actual_pose"), ir.System("end_pose")
READ = ir.Assign(ir.Name("n"), ir.Signal("digital_in", ir.IntLiteral(1)))


def number(value: float) -> ir.Expression:
    return ir.RealLiteral(value)


def near(millimetres: float) -> ir.Statement:
    return ir.WaitUntil(ir.Binary("<=", ir.Builtin("distance", (HERE, DEST)), number(millimetres)))


def before_writing(*body: ir.Statement, context: WriteContext | None = None) -> ir.Program:
    program = ir.Program((ir.Module("m", "rpl", routines=(ir.Routine("main", body=body),)),))
    for one in registry.target("vplus").last():
        program = one(program, context or WriteContext(Diagnostics()))
    return program


def steps(*body: ir.Statement, context: WriteContext | None = None) -> ir.Body:
    return before_writing(*body, context=context).modules[0].routines[0].body


def trigger(reference: str, action: ir.Assign | ir.CallRoutine = ON, **place: ir.Expression) -> ir.Trigger:
    return ir.Trigger(reference, action, **place)


def test_the_robot_stops_behind_the_steps_of_its_way() -> None:
    assert steps(trigger("start"), EXACT) == (UNDER_WAY, ON, STOP)
    assert steps(trigger("end", distance=number(-20.0)), EXACT) == (UNDER_WAY, near(20.0), ON, STOP)
    assert steps(trigger("end", delay=number(-0.5)), EXACT) == (UNDER_WAY, near(50.0), ON, STOP)


def test_what_comes_at_the_end_stands_behind_the_stop() -> None:
    assert steps(trigger("end"), EXACT) == (EXACT, ON)
    assert steps(trigger("end"), trigger("start"), EXACT) == (UNDER_WAY, ON, STOP, ON)


def test_a_way_from_the_start_is_measured_from_a_place_that_is_kept() -> None:
    program = before_writing(trigger("start", distance=number(30.0)), EXACT)
    (main,) = program.modules[0].routines
    kept, move, wait, *_ = main.body
    assert kept == ir.Assign(ir.Name("p1"), DEST) and move == UNDER_WAY
    left = ir.Binary("-", ir.Builtin("distance", (ir.Name("p1"), DEST)), number(30.0))
    assert wait == ir.WaitUntil(ir.Binary("<=", ir.Builtin("distance", (HERE, DEST)), left))
    assert [one.name for one in main.declarations if isinstance(one, ir.Variable)] == ["p1"]


def test_what_acts_in_a_corner_stands_behind_the_next_move() -> None:
    assert steps(ROUND, ON, EXACT) == (ROUND, UNDER_WAY, ON, STOP)
    assert steps(trigger("end"), ROUND, EXACT) == (ROUND, UNDER_WAY, ON, STOP)


def test_a_corner_becomes_a_stop_where_the_program_looks_outside() -> None:
    assert steps(ROUND, READ, EXACT) == (EXACT, READ, EXACT)
    asked = ir.If(((ir.BoolLiteral(True), (READ,)),))
    assert steps(ROUND, asked, EXACT) == (ROUND, ir.If(((ir.BoolLiteral(True), (STOP, READ)),)), EXACT)


def test_a_corner_of_a_size_that_the_run_decides_is_a_stop_where_it_has_none() -> None:
    computed = replace(EXACT, blend=ir.BlendDistance(ir.Name("size")))
    none = ir.Binary("<=", ir.Name("size"), ir.IntLiteral(0))
    assert steps(computed, EXACT) == (computed, ir.If(((none, (STOP,)),)), EXACT)


def test_what_cannot_be_said_stays_with_its_reason() -> None:
    context = WriteContext(Diagnostics())
    computed = trigger("start", ir.CallRoutine("sub"), delay=ir.Name("t"))
    assert steps(computed, EXACT, context=context) == (computed, EXACT)
    assert context.left_alone.why(computed) == "an action on the path with a computed delay"
    alone = trigger("start")
    assert steps(EXACT, alone, context=context) == (EXACT, alone)
    loop = ir.Loop((EXACT,))
    assert steps(alone, loop, EXACT, context=context) == (alone, loop, EXACT)


def test_remarks_of_an_action_stay_in_front_of_the_move() -> None:
    told = replace(trigger("start"), origin=Origin(comments=(Comment("the glue begins"),)))
    first, *others = steps(told, EXACT)
    assert isinstance(first, ir.Nothing) and [one.text for one in first.origin.comments] == ["the glue begins"]
    assert others == [UNDER_WAY, ON, STOP]


def test_an_output_that_follows_later_is_switched_by_a_program_of_its_own() -> None:
    pulse = ir.Pulse(ON.target, ir.BoolLiteral(True), number(0.5))
    program = before_writing(pulse, ir.SetAfter(ON.target, ir.BoolLiteral(False), number(0.5)))
    main, later = program.modules[0].routines
    begun = ir.TaskControl("start", "rpl.later.1")
    assert main.body == (ON, begun, begun)
    assert later.body == (ir.Wait(number(0.5)), replace(ON, value=ir.BoolLiteral(False)))


def test_both_levels_of_a_computed_one_stand_in_a_choice() -> None:
    (choice,) = steps(ir.SetAfter(ON.target, ir.Name("up"), number(0.5)))
    assert isinstance(choice, ir.If)
    assert choice.branches == ((ir.Name("up"), (ir.TaskControl("start", "rpl.later.1"),)),)
    assert choice.otherwise == (ir.TaskControl("start", "rpl.later.2"),)


def test_a_computed_output_is_left_to_the_library() -> None:
    pulse = ir.Pulse(ir.Signal("digital_out", ir.Name("n")), ir.BoolLiteral(True), number(0.5))
    assert steps(pulse) == (pulse,)


def test_outputs_get_tasks_as_long_as_there_are_some() -> None:
    signals = [ir.Signal("digital_out", ir.IntLiteral(at)) for at in range(1, 9)]
    pulses = [ir.SetAfter(signal, ir.BoolLiteral(True), number(0.5)) for signal in signals]
    *others, last = steps(*pulses)
    assert all(isinstance(one, ir.TaskControl) for one in others) and last == pulses[-1]


BESIDE = replace(EXACT, concurrent=True)
CHOICE = ir.If(((ir.Name("up"), (ON,)),))
LEAVES = ir.If(((ir.Name("up"), (ir.Return(),)),))


def test_a_move_beside_the_program_is_waited_for_where_the_next_one_begins() -> None:
    assert steps(BESIDE, ON, EXACT) == (UNDER_WAY, ON, STOP, EXACT)
    assert steps(BESIDE, CHOICE) == (UNDER_WAY, CHOICE, STOP)
    assert steps(BESIDE, LEAVES, ON) == (UNDER_WAY, STOP, LEAVES, ON)
    assert steps(BESIDE, STOP, EXACT) == (UNDER_WAY, STOP, EXACT)
    assert steps(trigger("end"), BESIDE) == (UNDER_WAY, STOP, ON)
