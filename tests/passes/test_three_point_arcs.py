"""Arcs by an angle, and arcs on which controllers turn the tool by different rules, in targets with three points.

A KRL program runs on one arm; its translation runs on the same arm and must go the same way.
"""

import math

import pytest

from rpl.diagnostics import Diagnostics
from rpl.passes import rigid
from rpl.passes.legalise.places.threepoints import circle_through
from rpl.project import read_sources
from rpl.proof.prove import ProofResult, prove_programs
from rpl.proof.wiring import with_signal_names
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "kuka_kr6r900sixx"
FRAME = """DEF a()
$BASE = {{X 450.0,Y 0.0,Z 300.0,A 0.0,B 0.0,C 0.0}}
$TOOL = {{X 0.0,Y 0.0,Z 80.0,A 0.0,B 0.0,C 0.0}}
$VEL.CP = 0.2
PTP {{A1 0,A2 -90,A3 90,A4 0,A5 90,A6 -120}}
LIN {{X 0,Y -80,Z 0,A {a},B 0,C 180}}
{arc}
$OUT[1]=TRUE
END
"""
VIA = "CIRC {X 40,Y -40,Z 0,A 0,B 0,C 180}"


def translated(arc: str, target: str, a: float = 0.0) -> tuple[ProofResult, list[str]]:
    return translated_text(FRAME.format(arc=arc, a=a), target)


def translated_text(text: str, target: str) -> tuple[ProofResult, list[str]]:
    read = read_sources([source_from_text("a.src", text)], "krl", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, ARM, None, diagnostics)
    back = read_sources([source_from_bytes(file.path, file.data) for file in written.files], target, Diagnostics())
    named = with_signal_names(back.program, written.program)
    entry = written.renamed.get("a", "a")
    result = prove_programs(read.program, named, ARM, ARM, None, entry="a", to_entry=entry)
    return result, [item.code.name for item in diagnostics if item.severity.word in ("warning", "loss", "error")]


@pytest.mark.parametrize("target", ["rapid", "tp", "urscript", "inform"])
@pytest.mark.parametrize("angle", [90, 150, -60])
def test_an_arc_by_its_angle_ends_at_a_computed_point(target: str, angle: int) -> None:
    result, told = translated(f"{VIA},{{X 0,Y 0,Z 0,A 0,B 0,C 180}}, CA {angle}", target)
    assert result.agrees, result.as_text()
    assert "arc-in-parts" not in told
    assert "arc-orientation" not in told


@pytest.mark.parametrize("target", ["rapid", "tp"])
@pytest.mark.parametrize("angle", [360, -360, 540])
def test_more_than_one_turn_is_written_in_parts(target: str, angle: int) -> None:
    result, told = translated(f"{VIA},{{X 0,Y 0,Z 0,A 0,B 0,C 180}}, CA {angle}", target)
    assert result.agrees, result.as_text()
    assert "arc-in-parts" in told


@pytest.mark.parametrize("angle", [200, 206, 240, 270])
def test_parts_turn_the_tool_where_the_target_follows_another_rule(angle: int) -> None:
    """Seen from the tangent, the tool keeps its rotation by turning the shorter way: once around, and never by half a
    turn in one part."""
    result, told = translated(f"{VIA},{{X 0,Y 0,Z 0,A 0,B 0,C 180}}, CA {angle}", "urscript")
    assert "arc-in-parts" in told
    assert result.agrees, result.as_text()


def test_an_angle_that_changes_is_refused_by_name() -> None:
    arc = f"$VEL.CP = $VEL.CP\n{VIA},{{X 0,Y 0,Z 0,A 0,B 0,C 180}}, CA $OV_PRO"
    assert "arc-angle-lost" in translated(arc, "rapid")[1]


RUN = """DEF a()
DECL E6POS P,Q,S
INT I
$BASE = {X 0.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}
$TOOL = {X 0.0,Y 0.0,Z 100.0,A 0.0,B 0.0,C 0.0}
$VEL.CP = 0.3
PTP {A1 0,A2 -90,A3 90,A4 0,A5 90,A6 0}
S = $POS_ACT
S.Z = S.Z-100
LIN S
P = S
P.X = P.X+50
P.Y = P.Y+50
Q = S
Q.Y = Q.Y+100
CIRC P,Q,CA 90
WAIT SEC 0
IF (ABS($POS_ACT.X-P.X)<0.5) AND (ABS($POS_ACT.Y-P.Y)<0.5) THEN
  $OUT[1]=TRUE
ENDIF
FOR I=1 TO 2
  LIN S C_DIS
ENDFOR
P.Z = P.Z+10
CIRC P,Q,CA -45
$OUT[2]=TRUE
END
"""


@pytest.mark.parametrize("target", ["rapid", "tp", "urscript", "vplus", "inform"])
def test_ends_that_are_known_only_in_a_run_are_computed_there(target: str) -> None:
    result, told = translated_text(RUN, target)
    assert result.agrees, result.as_text()
    assert told.count("arc-end-computed") == 2
    assert not [one for one in told if "lost" in one or "guarded" in one]


@pytest.mark.parametrize("target", ["rapid", "tp", "urscript", "vplus", "inform"])
@pytest.mark.parametrize("angle", [-400, 360])
def test_a_full_turn_of_points_known_only_in_a_run_is_computed_in_parts(target: str, angle: int) -> None:
    text = RUN.replace("CA -45", f"CA {angle}").replace("$VEL.CP = 0.3", "$VEL.CP = 0.3\n$CIRC_TYPE = #BASE")
    result, told = translated_text(text, target)
    in_corners = result.level == "events" and result.max_path_mm < 0.02  # of 1 mm, which are said
    assert result.agrees or in_corners, result.as_text()
    assert told.count("arc-end-computed") == 2
    assert "arc-in-parts" in told
    assert not [one for one in told if "lost" in one or "guarded" in one]


def test_a_full_turn_along_which_the_tool_follows_the_path_is_refused_by_name() -> None:
    assert "arc-angle-lost" in translated_text(RUN.replace("CA -45", "CA 400"), "rapid")[1]


def test_what_is_not_the_same_is_told_with_its_size() -> None:
    arc = "$CIRC_TYPE=#BASE\n" + VIA + ",{X 0,Y 0,Z 0,A 0,B 10,C 180}"
    assert {"arc-in-parts", "arc-orientation"} & set(translated(arc, "tp")[1])


def test_the_circle_through_three_points() -> None:
    circle = circle_through(rigid.Vector(0.0, -80.0, 0.0), rigid.Vector(40.0, -40.0, 0.0), rigid.Vector(0.0, 0.0, 0.0))
    assert circle is not None
    assert math.dist((circle.centre.x, circle.centre.y, circle.centre.z), (0.0, -40.0, 0.0)) < 1e-9
    assert circle.at(90.0).x == pytest.approx(40.0)
    assert circle.angle(rigid.Vector(0.0, 0.0, 0.0)) == pytest.approx(180.0)
    line = [rigid.Vector(x, 0.0, 0.0) for x in (0.0, 1.0, 2.0)]
    assert circle_through(*line) is None


HALF = """MODULE Half
  CONST robtarget p:=[[450,90,310],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveJ Offs(p,0,0,50),v200,fine,tool0;
    MoveL p,v100,z5,tool0;
    MoveC Offs(p,30,{side},0),Offs(p,60,0,0),v100,fine,tool0;
    SetDO do1,1;
  ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize("target", ["krl", "tp", "urscript", "vplus", "inform"])
@pytest.mark.parametrize("side", [30, -30])
def test_half_a_circle_keeps_the_tool_as_it_is(target: str, side: int) -> None:
    """Not once round: a tool with the same rotation at both ends is not turned on the way."""
    read = read_sources([source_from_text("Half.mod", HALF.format(side=side))], "rapid", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, "abb_irb1200_5_90", None, diagnostics)
    assert "arc-in-parts" not in [item.code.name for item in diagnostics]
    back = read_sources([source_from_bytes(file.path, file.data) for file in written.files], target, Diagnostics())
    named = with_signal_names(back.program, written.program)
    entry = written.renamed.get("main", "main")
    arm = "abb_irb1200_5_90"
    result = prove_programs(read.program, named, arm, arm, None, entry="main", to_entry=entry)
    assert result.agrees, result.as_text()


def test_arcs_in_a_row_stay_arcs_in_a_row_when_their_speeds_are_computed() -> None:
    """What calculates a speed between two MOVC points does not part them, so no start is taught between them."""
    text = RUN.replace("CA -45", "CA 360").replace(
        "$VEL.CP = 0.3", "$VEL.CP = 0.3\n$CIRC_TYPE = #BASE\nFOR I=1 TO 2\n$VEL.CP = 0.1*I\nENDFOR"
    )
    result, _ = translated_text(text, "inform")
    assert result.agrees, result.as_text()
