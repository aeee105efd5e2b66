"""Programs of other languages in KRL: what one move is driven with, and what only steers the source's controller."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity
from rpl.passes.typing import normalise
from rpl.project import ReadProgram, read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

FAST = ((ir.System("path_speed"), ir.Quantity(ir.RealLiteral(500.0), "mm/s")),)


def krl(*body: ir.Statement, source: str = "vplus") -> tuple[list[str], list[str], list[str]]:
    """The lines in KRL, the names of warnings, and what was lost."""
    declarations = (ir.Variable("p", ir.PoseType(), scope="global"),)
    module = ir.Module("m", source, declarations, (ir.Routine("main", body=tuple(body)),))
    diagnostics = Diagnostics()
    program = normalise(ir.Program((module,)), diagnostics)
    done = translate_program(ReadProgram(program, program, (), (), (source,)), "krl", None, None, diagnostics)
    lines = [line for file in done.files for line in file.data.decode("latin-1").splitlines()]
    named = [item.code.name for item in diagnostics.of(Severity.WARNING)]
    return lines, named, [item.as_text() for item in diagnostics.of(Severity.LOSS)]


def test_a_speed_of_one_move_is_set_back_behind_it() -> None:
    slow = ir.Assign(ir.System("path_speed"), ir.Quantity(ir.RealLiteral(100.0), "mm/s"))
    lines, _, lost = krl(slow, ir.Move("linear", ir.Name("p"), settings=FAST, blend=ir.BlendStop()))
    assert not lost
    at = lines.index("LIN p")
    assert (lines[at - 1], lines[at + 1]) == ("$VEL.CP=0.5", "$VEL.CP=0.1")


def test_a_speed_that_is_not_known_is_kept() -> None:
    move = ir.Move("linear", ir.Name("p"), settings=FAST, blend=ir.BlendStop())
    lines, _, lost = krl(ir.Assign(ir.System("path_speed"), ir.Builtin("random", ())), move)
    assert not lost
    at = lines.index("LIN p")
    assert lines[at - 1] == "$VEL.CP=0.5"
    assert "old_path_speed=" in lines[at - 2] and "old_path_speed" in lines[at + 1]


def test_a_way_of_turning_of_one_move() -> None:
    move = ir.Move("linear", ir.Name("p"), orientation="constant", blend=ir.BlendStop())
    lines, _, lost = krl(move)
    assert not lost
    at = lines.index("LIN p")
    assert (lines[at - 1], lines[at + 1]) == ("$ORI_TYPE=#CONSTANT", "$ORI_TYPE=#VAR")


def test_paths_slow_down_where_the_source_does() -> None:
    lines, _, _ = krl(ir.Move("linear", ir.Name("p"), blend=ir.BlendStop()))
    assert "$CP_VEL_TYPE=#VAR_ALL" in lines
    lines, _, _ = krl(ir.Assign(ir.Signal("digital_out", ir.IntLiteral(1)), ir.BoolLiteral(True)))
    assert "$CP_VEL_TYPE=#VAR_ALL" not in lines


def test_a_posture_that_is_asked_for_is_named() -> None:
    ask = ir.Assign(ir.System("posture_shoulder"), ir.EnumLiteral("front"))
    _, named, lost = krl(ask)
    assert named == ["dropped-setting"] and not lost


def test_a_process_move_is_a_path_move() -> None:
    move = ir.Move("linear", ir.Name("p"), motion_class="process", blend=ir.BlendStop())
    lines, named, lost = krl(move, source="urscript")
    assert "LIN p" in lines and "process-move" in named and not lost


CORNER = ir.Move(
    "linear",
    ir.Name("p"),
    speed=ir.Speed(path=ir.RealLiteral(50.0)),
    blend=ir.BlendDistance(ir.RealLiteral(10.0)),
)


def test_outputs_at_a_corner_are_triggers_of_the_move_before_them() -> None:
    first, second = (ir.Signal("digital_out", ir.IntLiteral(number)) for number in (1, 2))
    body = (CORNER, ir.Assign(first, ir.BoolLiteral(True)), ir.Assign(second, ir.BoolLiteral(False)), CORNER)
    lines, named, lost = krl(*body, source="tp")
    assert not lost
    at = lines.index("TRIGGER WHEN DISTANCE=1 DELAY=0 DO $OUT[1]=TRUE")
    assert lines[at + 1 : at + 3] == ["TRIGGER WHEN DISTANCE=1 DELAY=0 DO $OUT[2]=FALSE", "LIN p C_DIS"]
    assert named.count("corner-output") == 2 and "early-logic" not in named


def test_an_output_that_asks_at_a_corner_stops_the_robot_there() -> None:
    output = ir.Signal("digital_out", ir.IntLiteral(3))
    lines, named, lost = krl(CORNER, ir.Assign(output, ir.Unary("not", output)), CORNER, source="tp")
    assert not lost
    at = lines.index("LIN p")
    assert lines[at + 1] == "$OUT[3]=NOT $OUT[3]"
    assert "corner-stops-behind" in named and "early-logic" not in named


NAMED_OUTPUT = """MODULE m
  CONST robtarget a:=[[500,-200,500],[0,0,1,0],[-1,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget b:=[[500,200,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveJ a,v500,fine,tool0;
    SetDO doGun,1;
    MoveL b,v500,z50,tool0;
    SetDO doGlue,1;
    MoveL Offs(b,0,0,-200),v500,fine,tool0;
  ENDPROC
ENDMODULE
"""


def test_an_output_with_a_name_switches_in_its_corner_too() -> None:
    """And not when the move before it begins, which is 350 mm earlier."""
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("m.mod", NAMED_OUTPUT)], "rapid", diagnostics)
    translation = translate_program(read, "krl", "abb_irb1200_5_90", None, diagnostics)
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], "krl", diagnostics)
    spans = []
    for program in (read.program, back.program):
        first, second = (
            event.t
            for event in run_program(program, "abb_irb1200_5_90", controller="plain").trace
            if event.kind == "output"
        )
        spans.append(second - first)
    assert spans[1] == pytest.approx(spans[0], abs=0.3) and spans[0] > 0.5


def test_outputs_behind_a_stop_stay_where_they_are() -> None:
    output = ir.Assign(ir.Signal("digital_out", ir.IntLiteral(1)), ir.BoolLiteral(True))
    move = ir.Move("linear", ir.Name("p"), speed=ir.Speed(path=ir.RealLiteral(50.0)), blend=ir.BlendStop())
    lines, named, _ = krl(move, output, source="tp")
    assert "$OUT[1]=TRUE" in lines and "corner-output" not in named


TEXTS = """MODULE Data
  RECORD partdata
    string name;
    num size;
  ENDRECORD
  VAR partdata one;
  VAR string texts{3};
  PROC main()
    one.name:=texts{2};
  ENDPROC
ENDMODULE
"""


def test_texts_in_structures_and_arrays_have_a_length() -> None:
    diagnostics = Diagnostics()
    found = read_sources([source_from_text("Data.mod", TEXTS)], "rapid", diagnostics)
    done = translate_program(found, "krl", None, None, diagnostics)
    lines = [line for file in done.files for line in file.data.decode("latin-1").splitlines()]
    assert "GLOBAL STRUC partdata CHAR name[80],INT size" in lines
    assert "DECL GLOBAL CHAR texts[3,80]" in lines
