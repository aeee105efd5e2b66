"""Time limits, delayed outputs and stop watches on a controller that has timers only."""

from __future__ import annotations

from dataclasses import replace

import pytest

from rpl import ir
from rpl.passes.legalise.statements.errors import check_errors
from rpl.passes.legalise.statements.logic import decide_logic
from rpl.passes.legalise.statements.waits import fit_waits

from .common import PLAIN, RICH, count, legalised, read, same_run

_RAPID = """MODULE m
  VAR clock c1;
  VAR clock many{2};
  PROC show(num a) TPWrite NumToStr(a,2); ENDPROC
  PROC watch(VAR clock c) ClkStart c; WaitTime 0.5; ClkStop c; show ClkRead(c); ENDPROC
  PROC main()
    VAR bool late;
    VAR num n:=0;
    VAR clock c2;
%s
  ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize("at", [0.0, 1.0, 3.0])
@pytest.mark.parametrize(
    "body",
    [
        "WaitUntil diGo=1\\MaxTime:=2\\TimeFlag:=late; IF late show 1;",
        "WaitDI diGo,1\\MaxTime:=2\\TimeFlag:=late; IF late show 1; WaitDI diGo,1\\MaxTime:=5\\TimeFlag:=late; show 2;",
        "WaitUntil diGo=1 OR n>0\\MaxTime:=2; show 2;",
        "WaitUntil diGo=1\\MaxTime:=2; show 2; ERROR show 9; n:=n+1; IF n<3 RETRY; TRYNEXT;",
    ],
)
def test_waits_with_a_limit(body: str, at: float) -> None:
    program = read("rapid", _RAPID % body)
    after = same_run(program, PLAIN, check_errors, fit_waits, decide_logic, inputs={"diGo": lambda time: time >= at})
    assert not count(after, lambda node: isinstance(node, ir.WaitUntil) and node.timeout is not None)


@pytest.mark.parametrize(
    "body",
    [
        "ClkReset c1; ClkStart c1; WaitTime 1.5; show ClkRead(c1); ClkStop c1; WaitTime 1; show ClkRead(c1);",
        "ClkReset c1; ClkReset c2; ClkStart c1; WaitTime 1; ClkStart c2; WaitTime 1; show ClkRead(c1)-ClkRead(c2);",
        "ClkReset c2; ClkStart c2; WaitTime 1; ClkReset c2; WaitTime 1; show ClkRead(c2);",
        "ClkReset many{1}; ClkReset many{2}; n:=2; ClkStart many{n}; WaitTime 1; show ClkRead(many{n}); show n;",
        "ClkReset c1; watch c1; watch c1; show ClkRead(c1);",
    ],
)
def test_stop_watches(body: str) -> None:
    after = same_run(read("rapid", _RAPID % body), PLAIN, fit_waits)
    assert not count(after, ir.Clock)


def test_a_target_with_limits_and_clocks_keeps_them() -> None:
    program = read("rapid", _RAPID % "ClkReset c1; WaitDI diGo,1\\MaxTime:=2\\TimeFlag:=late;")
    assert legalised(program, RICH, fit_waits)[0] is program


def test_timers_of_the_program_are_left_alone() -> None:
    program = read("krl", "DEF main()\n$TIMER[16]=0\n$TIMER[15]=0\nEND\n")
    wait = ir.WaitUntil(ir.BoolLiteral(False), ir.IntLiteral(2), ir.Name("b"))
    routine = program.modules[0].routines[0]
    declared = ir.Variable("b", ir.BoolType(), scope="routine")
    grown = replace(routine, declarations=(declared,), body=(*routine.body, wait))
    program = replace(program, modules=(replace(program.modules[0], routines=(grown,)),))
    after, _ = legalised(program, PLAIN, fit_waits)
    timers = [s.target for s in after.modules[0].routines[0].body if isinstance(s, ir.Assign)]
    used = {index.value for one in timers if isinstance(one, ir.System) for index in one.indices}  # type: ignore[union-attr]
    assert used == {14, 15, 16}


def test_running_out_of_timers_is_told() -> None:
    program = read("rapid", _RAPID % "WaitDI diGo,1\\MaxTime:=2\\TimeFlag:=late; ClkReset c1; ClkReset c2;")
    after, context = legalised(program, replace(PLAIN, io=replace(PLAIN.io, timers=3)), fit_waits)
    assert [item.code.name for item in context.diagnostics] == ["no-timer-left"] * 2
    assert (
        count(after, ir.Clock) + count(after, lambda node: isinstance(node, ir.WaitUntil) and bool(node.timeout)) == 2
    )


@pytest.mark.parametrize("value, test", [("1", ir.Unary), ("0", ir.Signal), ("n", ir.Binary)])
def test_a_delayed_output_is_a_pulse_of_the_opposite(value: str, test: type) -> None:
    program = read("rapid", _RAPID % f"SetDO\\SDelay:=0.5, doGrip, {value};")
    after, _ = legalised(program, PLAIN, fit_waits)
    (statement,) = after.modules[0].routines[-1].body
    assert isinstance(statement, ir.If)
    ((condition, (pulse,)),) = statement.branches
    assert isinstance(condition, test)
    assert isinstance(pulse, ir.Pulse)
