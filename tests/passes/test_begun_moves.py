"""Programs that look where the robot is while it drives, in languages whose programs wait for the move."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity
from rpl.passes.typing import normalise
from rpl.project import ReadProgram
from rpl.translation import translate_program

_SPEED = ir.Speed(path=ir.RealLiteral(100.0))
_ON = ir.Assign(ir.Signal("digital_out", ir.IntLiteral(1)), ir.BoolLiteral(True))
_COMES = ir.WaitUntil(ir.Signal("digital_in", ir.IntLiteral(1)))
_CORNER = ir.BlendSpeed(ir.IntLiteral(100))


def _moved(name: str, concurrent: bool = False, blend: ir.Blend = _CORNER) -> ir.Move:
    return ir.Move("linear", ir.Name(name), speed=_SPEED, blend=blend, concurrent=concurrent)


def _written(target: str, source: str, *body: ir.Statement) -> tuple[list[str], list[str]]:
    """The lines, and the names of the losses."""
    declarations = tuple(ir.Variable(name, ir.PoseType(), scope="global") for name in ("p", "q", "now"))
    module = ir.Module("m", source, declarations, (ir.Routine("main", body=body),))
    diagnostics = Diagnostics()
    program = normalise(ir.Program((module,)), diagnostics)
    done = translate_program(ReadProgram(program, program, (), (), (source,)), target, None, None, diagnostics)
    lines = [line.strip() for file in done.files for line in file.data.decode("latin-1").splitlines()]
    return lines, [item.code.name for item in diagnostics.of(Severity.LOSS)]


_HERE = ir.Assign(ir.Name("now"), ir.Builtin("pose_of", (ir.System("actual_pose"),)))


@pytest.mark.parametrize("target", ["krl", "tp", "urscript", "val3"])
def test_a_controller_that_waits_for_moves_names_the_loss(target: str) -> None:
    """Nothing is made beside the move: no task and no action at its begin."""
    lines, lost = _written(target, "vplus", _moved("p"), _moved("q"), _ON, _COMES, _HERE, ir.WaitForMotion())
    assert lost.count("concurrent-move") == 1
    assert not any(word in line for line in lines for word in ("TRIGGER", "RUN ", "run ", "taskCreate"))


@pytest.mark.parametrize("target", ["krl", "tp", "urscript", "val3"])
def test_a_move_that_says_so_is_named_too(target: str) -> None:
    move = _moved("q", True, ir.BlendStop())
    lines, lost = _written(target, "inform", move, _ON, ir.Wait(ir.RealLiteral(0.5)), ir.WaitForMotion())
    assert lost == ["concurrent-move"]
    assert not any(word in line for line in lines for word in ("TRIGGER", "CONTINUE", "RUN ", "run ", "taskCreate"))


@pytest.mark.parametrize("concurrent", [False, True])
def test_a_stop_that_the_program_waits_for_stays_as_it_is(concurrent: bool) -> None:
    steps = (ir.WaitForMotion(), _HERE) if concurrent else (_HERE,)
    source = "vplus" if concurrent else "rapid"
    lines, lost = _written("krl", source, _moved("p", blend=ir.BlendStop()), *steps)
    assert not lost and "CONTINUE" not in lines


def test_a_language_that_lets_a_move_say_so_says_it() -> None:
    lines, lost = _written("rapid", "vplus", _moved("p"), _moved("q"), _ON, _COMES, _HERE, ir.WaitForMotion())
    assert not lost
    assert sum("\\Conc" in line for line in lines) == 1
    assert any(line.startswith("MoveL\\Conc") for line in lines)


def test_outputs_alone_need_no_such_move() -> None:
    lines, lost = _written("rapid", "vplus", _moved("p"), _ON, _moved("q"), ir.WaitForMotion(), _HERE)
    assert not lost and not any("\\Conc" in line for line in lines)
