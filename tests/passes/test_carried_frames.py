"""Frames on turn-tables in other languages: written where the target can, else named and guarded."""

import pytest

from rpl.cell import parse_cell
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.proof.prove import ProofResult, prove_programs
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

KUKA, ABB = "kuka_kr10r1420", "abb_irb4600_60_205"
CELL = parse_cell(
    """
[[mechanism]]
name = "EASYS"
kind = "rotary"
root = [700, 0, 400, 0, 0, 0]
axes = [{ number = 1, limits = [-180, 180], speed = 90 }]
"""
)
KRL = """DEF a( )
$TOOL={X 0.0,Y 0.0,Z 100.0,A 0.0,B 0.0,C 0.0}
$VEL.CP=0.2
PTP {A1 0,A2 -90,A3 90,A4 0,A5 90,A6 0,E1 0}
$BASE=EK(MACHINE_DEF[2].ROOT,#EASYS,{X 0.0,Y 0.0,Z 50.0,A 0.0,B 0.0,C 0.0})
LIN {X 60,Y 0,Z 100,A 180,B 0,C 180,E1 0}
LIN {X 60,Y 0,Z 100,A 180,B 0,C 180,E1 40}
CIRC {X 0,Y 60,Z 100},{X -60,Y 0,Z 100,E1 -30}
IF ABS($POS_ACT.X+60)<0.01 THEN
  $OUT[1]=TRUE
ENDIF
$BASE=$NULLFRAME
LIN {X 650,Y 0,Z 600,A 180,B 0,C 180,E1 0}
IF ABS($POS_ACT.X-650)<0.01 THEN
  $OUT[2]=TRUE
ENDIF
END
"""
RAPID = """MODULE a
TASK PERS tooldata pin:=[TRUE,[[0,0,100],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];
TASK PERS wobjdata plate:=[FALSE,FALSE,"EASYS",[[0,0,0],[1,0,0,0]],[[0,0,50],[1,0,0,0]]];
PROC main()
  ConfL\\Off;
  MoveAbsJ [[0,0,0,0,90,0],[0,9E9,9E9,9E9,9E9,9E9]],v100,fine,pin;
  MoveL [[60,0,400],[0,0,1,0],[0,0,0,0],[0,9E9,9E9,9E9,9E9,9E9]],v100,fine,pin\\WObj:=plate;
  MoveL [[60,0,400],[0,0,1,0],[0,0,0,0],[30,9E9,9E9,9E9,9E9,9E9]],v100,fine,pin\\WObj:=plate;
  SetDO do1,1;
ENDPROC
ENDMODULE
"""


def translated(text: str, language: str, target: str, arm: str) -> tuple[ProofResult, list[str], str]:
    read = read_sources([source_from_text("a.src" if language == "krl" else "a.mod", text)], language, Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, arm, None, diagnostics)
    back = read_sources([source_from_bytes(file.path, file.data) for file in written.files], target, Diagnostics())
    entry = "a" if language == "krl" else "main"
    to_entry = written.renamed.get(entry, entry)
    result = prove_programs(read.program, back.program, arm, arm, CELL, entry=entry, to_entry=to_entry)
    told = [item.code.name for item in diagnostics if item.severity.word in ("warning", "loss", "error")]
    return result, told, "\n".join(file.data.decode("utf-8", "replace") for file in written.files)


@pytest.mark.parametrize(("target", "line"), [
    ("krl", "$BASE=EK(EX_AX_DATA[1].ROOT,#EASYS,{X 0.0,Y 0.0,Z 50.0,A 0.0,B 0.0,C 0.0})"),
    ("rpl", '$base_unit = "EASYS"'),
    ("rapid", 'wobjCurrent.ufmec:="EASYS";'),
])  # fmt: skip
def test_external_kinematics_of_krl_move_the_base(target: str, line: str) -> None:
    result, told, text = translated(KRL, "krl", target, KUKA)
    assert line in text
    assert result.agrees and "fault" not in str(result.as_text()), result.as_text()
    assert "carried-frame-lost" not in told


def test_the_mechanism_keeps_its_name_in_rapid_and_that_is_said() -> None:
    assert "mechanism-name" in translated(KRL, "krl", "rapid", KUKA)[1]


@pytest.mark.parametrize("target", ["krl", "rpl"])
def test_a_work_object_on_a_table_stays_there(target: str) -> None:
    result, told, text = translated(RAPID, "rapid", target, ABB)
    assert result.agrees and "fault" not in str(result.as_text()), result.as_text()
    assert "EASYS" in text
    assert "carried-frame-lost" not in told


@pytest.mark.parametrize("target", ["tp", "inform", "urscript", "vplus"])
def test_a_target_without_such_frames_names_the_loss_and_stops(target: str) -> None:
    result, told, _ = translated(RAPID, "rapid", target, ABB)
    assert "carried-frame-lost" in told
    assert not result.agrees


def test_krl_knows_six_external_kinematics() -> None:
    result, told, text = translated(RAPID.replace("EASYS", "STN1"), "rapid", "krl", ABB)
    assert "krl-guarded-stop" in told
    assert "HALT" in text
    assert not result.agrees


@pytest.mark.parametrize("target", ["tp", "inform", "urscript", "vplus"])
def test_external_kinematics_of_krl_are_not_lost_silently(target: str) -> None:
    result, told, _ = translated(KRL, "krl", target, KUKA)
    assert any(one.endswith("guarded-stop") for one in told)
    assert not result.agrees


def test_a_place_seen_from_another_frame_is_not_composed_with_a_frame_that_moves() -> None:
    asks = "SetDO do1,1;\n  here:=CRobT(\\Tool:=pin\\WObj:=wobj0);"
    text = RAPID.replace("SetDO do1,1;", asks).replace("PROC main()", "VAR robtarget here;\nPROC main()")
    assert "carried-place-lost" in translated(text, "rapid", "krl", ABB)[1]
    assert "carried-place-lost" not in translated(text, "rapid", "rpl", ABB)[1]
