"""Programs that look where the robot is while it drives, in languages whose programs wait for the move."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity
from rpl.passes.typing import normalise
from rpl.project import ReadProgram, read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
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


def test_a_look_beside_a_move_waits_for_its_begin_and_not_for_its_end() -> None:
    lines, lost = _written("krl", "vplus", _moved("p"), _moved("q"), _ON, _COMES, _HERE, ir.WaitForMotion())
    assert not lost
    begin = lines.index("TRIGGER WHEN DISTANCE=0 DELAY=0 DO rpl_begun=TRUE")
    move = next(at for at, line in enumerate(lines) if line.startswith("LIN q"))
    assert lines[begin - 1] == "rpl_begun=FALSE" and begin < move
    behind = [line for line in lines[move + 1 :] if not line.startswith("$VEL")]
    assert behind[:6] == [
        "CONTINUE",
        "WAIT FOR rpl_begun",
        "CONTINUE",
        "$OUT[1]=TRUE",
        "CONTINUE",
        "WAIT FOR $IN[1]",
    ]
    assert behind[6] == "CONTINUE" and "$POS_ACT" in behind[7] and behind[8] == "WAIT SEC 0"
    assert any("BOOL rpl_begun" in line for line in lines)


@pytest.mark.parametrize("concurrent", [False, True])
def test_a_stop_that_the_program_waits_for_stays_as_it_is(concurrent: bool) -> None:
    steps = (ir.WaitForMotion(), _HERE) if concurrent else (_HERE,)
    source = "vplus" if concurrent else "rapid"
    lines, lost = _written("krl", source, _moved("p", blend=ir.BlendStop()), *steps)
    assert not lost and "CONTINUE" not in lines and not any("rpl_begun" in line for line in lines)


def test_a_language_that_lets_a_move_say_so_says_it() -> None:
    lines, lost = _written("rapid", "vplus", _moved("p"), _moved("q"), _ON, _COMES, _HERE, ir.WaitForMotion())
    assert not lost
    assert sum("\\Conc" in line for line in lines) == 1
    assert any(line.startswith("MoveL\\Conc") for line in lines)


def test_outputs_alone_need_no_such_move() -> None:
    lines, lost = _written("rapid", "vplus", _moved("p"), _ON, _moved("q"), ir.WaitForMotion(), _HERE)
    assert not lost and not any("\\Conc" in line for line in lines)


def test_a_controller_that_always_waits_does_the_steps_in_a_task() -> None:
    now = ir.Assign(ir.Name("now"), ir.System("actual_pose"))
    lines, lost = _written("tp", "inform", _moved("q", True, ir.BlendStop()), _ON, now, ir.WaitForMotion(), _ON)
    assert not lost
    code = [line.partition(":")[2].strip(" ;") for line in lines]
    begin = next(at for at, line in enumerate(code) if line.startswith("RUN "))
    assert code[begin - 1].endswith("=(ON)") and code[begin + 1].startswith("L P[1:q]")
    flag = code[begin - 1].partition("=")[0]
    assert code[begin + 2 : begin + 4] == [f"WAIT (!{flag})", "DO[1]=ON"]
    task = code[code.index("DO[1]=ON", begin + 4) :]
    assert task[1] == f"{flag}=(OFF)"  # nobody asks for `now`
    groups = [line.partition("=")[2].strip(" ;") for line in lines if line.startswith("DEFAULT_GROUP")]
    assert groups == ["1,*,*,*,*", "*,*,*,*,*"]  # M: a program without the arm may look where it is


def test_a_move_without_steps_beside_it_needs_no_task() -> None:
    lines, lost = _written("tp", "inform", _moved("q", True, ir.BlendStop()), _moved("p"), ir.WaitForMotion())
    assert not lost and not any("RUN" in line for line in lines)


def _job(body: str) -> ReadProgram:
    text = f"""/JOB
//NAME BESIDE
//POS
///NPOS 2,0,0,0,0,0
///TOOL 0
///POSTYPE ROBOT
///RECTAN
///RCONF 1,0,0,0,0,0
C00000=400.000,-100.000,300.000,180.0000,0.0000,0.0000
C00001=400.000,100.000,300.000,180.0000,0.0000,0.0000
//INST
///DATE 2026/01/01 00:00
///ATTR SC,RW
///GROUP1 RB1
///LVARS 1,1,0,0,0,0,0,0
NOP
{body}
END
"""
    return read_sources([source_from_text("BESIDE.JBI", text)], "inform", Diagnostics())


# A move that the program does not wait for; LI000 is a variable of the routine that the steps change.
STEPS = {
    "a place on the way": "MOVL C00001 V=100.0 NWAIT\nTIMER T=0.50\nDOUT OT#(1) ON\nGETS PX001 $PX001\nCWAIT\n"
    "DOUT OT#(2) ON\nGETE D000 P001 (2)\nDOUT OT#(3) ON IF D000<-40000\nDOUT OT#(4) ON IF D000>-60000",
    "a variable of the routine": "SET LI000 4\nMOVL C00001 V=100.0 PL=0 NWAIT\nADD LI000 3\nTIMER T=0.20\nINC LI000\n"
    "MOVL C00000 V=200.0 PL=0\nDOUT OT#(1) ON IF LI000=8",
    "a choice": "MOVL C00001 V=100.0 PL=0 NWAIT\nTIMER T=0.20\nIFTHEN IN#(1)=ON\nDOUT OT#(1) ON\nELSE\nDOUT OT#(2) ON\n"
    "ENDIF\nCWAIT\nDOUT OT#(3) ON",
    "in a loop": "FOR I000=1 TO 2\nMOVL C00001 V=200.0 PL=0 NWAIT\nTIMER T=0.10\nPULSE OT#(1) T=0.20\n"
    "MOVL C00000 V=200.0 PL=0\nNEXT I000",
    "steps that take longer": "MOVL C00001 V=1000.0 PL=0 NWAIT\nTIMER T=2.00\nDOUT OT#(1) ON\n"
    "MOVL C00000 V=200.0 PL=0\nDOUT OT#(2) ON",
}


@pytest.mark.parametrize("name", STEPS)
def test_the_steps_come_when_they_did(name: str) -> None:
    read = _job("MOVJ C00000 VJ=50.00 PL=0\n" + STEPS[name])
    diagnostics = Diagnostics()
    done = translate_program(read, "tp", "motoman_gp7", None, diagnostics)
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in done.files], "tp", Diagnostics())
    theirs, ours = (run_program(one.program, "motoman_gp7", None, "BESIDE", controller="plain") for one in (read, back))
    wanted = [(round(t, 1), value) for t, _, value in theirs.outputs]
    assert wanted and [(round(t, 1), value) for t, _, value in ours.outputs] == wanted
    assert ours.status == "finished" and any(b"RUN " in file.data for file in done.files)


def test_a_jump_out_of_the_steps_waits_for_the_move_and_says_so() -> None:
    diagnostics = Diagnostics()
    body = "MOVL C00001 V=100.0 PL=0 NWAIT\nDOUT OT#(1) ON\nRET IF IN#(1)=OFF\nDOUT OT#(2) ON"
    translate_program(_job(body), "tp", "motoman_gp7", None, diagnostics)
    assert "concurrent-move-left" in [item.code.name for item in diagnostics.of(Severity.WARNING)]
