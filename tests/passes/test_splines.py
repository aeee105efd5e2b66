"""Spline blocks in languages that have none: arcs along the curve, or straight moves through the points."""

import re

import pytest

from rpl.proof.prove import NOTHING_ACCEPTED, ProofResult
from rpl.proof.tolerance import Accepted
from tests.there_and_back import there_and_back

ARM = "kuka_kr6r900sixx"
SPLINES = """DEF way( )
  $BASE={X 0.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}
  $TOOL={X 0.0,Y 0.0,Z 100.0,A 0.0,B 0.0,C 0.0}
  $VEL.CP=0.3
  PTP {A1 0,A2 -90,A3 90,A4 0,A5 90,A6 0}
  PTP {X 500.0,Y 0.0,Z 400.0,A 180.0,B 0.0,C 180.0,S 2,T 2}
  ; through four points
  SPLINE WITH $VEL.CP=0.2
    SPL {X 500.0,Y 40.0,Z 420.0,A 180.0,B 0.0,C 180.0}
    TRIGGER WHEN PATH=0 ONSTART DELAY=0 DO $OUT[3]=TRUE
    SPL {X 500.0,Y 80.0,Z 400.0,A 180.0,B 0.0,C 180.0}
    SLIN {X 500.0,Y 120.0,Z 400.0,A 180.0,B 0.0,C 180.0} WITH $VEL.CP=0.1
    SCIRC {X 505.858,Y 134.142,Z 400.0,A 180.0,B 0.0,C 180.0},{X 520.0,Y 140.0,Z 400.0,A 180.0,B 0.0,C 180.0}
  ENDSPLINE
  WAIT SEC 0
  IF (ABS($POS_ACT.X-520)<0.5) AND (ABS($POS_ACT.Y-140)<0.5) THEN
    $OUT[1]=TRUE
  ENDIF
  SLIN {X 500.0,Y 120.0,Z 400.0,A 180.0,B 0.0,C 180.0} WITH $VEL.CP=0.1
  SPTP {A1 0,A2 -90,A3 90,A4 0,A5 90,A6 10}
  WAIT SEC 0
  IF ABS($AXIS_ACT.A6-10)<0.1 THEN
    $OUT[2]=TRUE
  ENDIF
END
"""
JOB = """/JOB
//NAME WAY
//POS
///NPOS 4,0,0,0,0,0
///TOOL 0
///POSTYPE ROBOT
///RECTAN
///RCONF 0,0,0,0,0,0,0,0
C00000=500.000,0.000,400.000,180.0000,0.0000,0.0000
C00001=500.000,40.000,400.000,180.0000,0.0000,0.0000
C00002=500.000,80.000,420.000,180.0000,0.0000,0.0000
C00003=500.000,120.000,400.000,180.0000,0.0000,0.0000
//INST
///DATE 2024/01/01 00:00
///ATTR SC,RW
///GROUP1 RB1
NOP
MOVJ C00000 VJ=20.00
MOVS C00001 V=100.0 PL=0
MOVS C00002 V=100.0
MOVS C00003 V=50.0 PL=0
DOUT OT#(1) ON
END
"""


def translated(
    path: str, text: str, language: str, target: str, arm: str, accepted: Accepted = NOTHING_ACCEPTED
) -> tuple[ProofResult, list[str], str]:
    journey = there_and_back({path: text}, language, target, arm)
    told = [item.code.name for item in journey.found if item.severity.word in ("warning", "loss", "error")]
    return journey.prove("way", accepted), told, journey.text


@pytest.mark.parametrize("target", ["rapid", "tp", "urscript"])
def test_a_block_is_written_as_arcs_along_its_curve(target: str) -> None:
    result, told, _ = translated("way.src", SPLINES, "krl", target, ARM)
    assert result.agrees, result.as_text()
    assert result.max_path_mm < 0.01
    assert told.count("spline-as-arcs") == 1 and "spline-as-lines" not in told
    assert not [one for one in told if "guarded" in one or "lost" in one]


@pytest.mark.parametrize("target", ["vplus", "inform"])
def test_the_way_is_the_curve_where_outputs_are_switched_beside_their_point(target: str) -> None:
    """These controllers switch it at the beginning or behind the end of a corner, or stop for it."""
    without = "\n".join(line for line in SPLINES.splitlines() if "TRIGGER" not in line)
    result, told, _ = translated("way.src", without, "krl", target, ARM)
    assert result.agrees, result.as_text()
    assert "spline-as-arcs" in told and result.max_path_mm < 0.01


def test_each_point_has_its_own_speed() -> None:
    text = translated("way.src", SPLINES, "krl", "urscript", ARM)[2]
    said = re.findall(r"(move[lc]).* v=([0-9.]+)", text)
    assert [speed for at, (_, speed) in enumerate(said) if at == 0 or said[at - 1][1] != speed] == [
        "0.2",
        "0.1",
        "0.2",
        "0.1",
    ]


UNKNOWN = [
    ("PTP {X 500.0", "PTP_REL {X 10.0", "where the block begins"),
    ("SPL {X 500.0,Y 40.0,Z 420.0", "SPL {X 500.0,Y HEIGHT,Z 420.0", "a point that the program computes"),
]


@pytest.mark.parametrize(("known", "unknown", "what"), UNKNOWN)
def test_a_block_whose_points_are_not_known_is_written_as_straight_moves(known: str, unknown: str, what: str) -> None:
    declared = SPLINES.replace("DEF way( )", "DEF way( )\nDECL REAL HEIGHT").replace(
        "  $VEL.CP", "  HEIGHT=$OV_PRO\n  $VEL.CP"
    )
    told = translated("way.src", declared.replace(known, unknown, 1), "krl", "rapid", ARM)[1]
    assert "spline-as-lines" in told and "spline-as-arcs" not in told, what


@pytest.mark.parametrize("target", ["rapid", "tp", "urscript", "vplus"])
def test_points_of_a_spline_in_a_job(target: str) -> None:
    """The way to the first point is straight, the others make a block; each says its own speed."""
    result, told, _ = translated("WAY.JBI", JOB, "inform", target, "motoman_gp7")
    assert result.agrees, result.as_text()
    assert "spline-as-arcs" in told


@pytest.mark.parametrize("end", [" PL=0", ""])
def test_points_of_a_spline_stay_a_spline_where_there_are_blocks(end: str) -> None:
    """The speed of each point is a setting of it; the tool is set in front of the block."""
    job = JOB.replace("MOVS C00001 V=100.0 PL=0", f"MOVS C00001 V=100.0{end}")
    result, told, text = translated("WAY.JBI", job, "inform", "krl", "motoman_gp7")
    assert result.agrees, result.as_text()
    assert "spline-as-arcs" not in told and "spline-as-lines" not in told
    lines = [line.strip() for line in text.splitlines()]
    at = lines.index("SPLINE")
    wanted = ["SPLINE", "SPL C00002 WITH $VEL.CP=0.1", "SPL C00003 WITH $VEL.CP=0.05", "ENDSPLINE"]
    assert lines[at : at + 4] == wanted


@pytest.mark.parametrize("target", ["rapid", "tp", "urscript"])
def test_a_corner_into_a_block_is_as_large_as_the_first_arc_allows(target: str) -> None:
    """It is told; behind the corner the way is the curve."""
    job = JOB.replace("MOVS C00001 V=100.0 PL=0", "MOVS C00001 V=100.0 PL=3")
    result, told, _ = translated("WAY.JBI", job, "inform", target, "motoman_gp7")
    assert result.agrees, result.as_text()
    assert "spline-corner-smaller" in told


RULED = SPLINES.replace("    TRIGGER", "    CONST_VEL START=+5 ONSTART\n    TIME_BLOCK START\n    TRIGGER").replace(
    "  ENDSPLINE", "    TIME_BLOCK PART=2\n    TIME_BLOCK END=1.5\n    CONST_VEL END=-5.5\n  ENDSPLINE"
)


@pytest.mark.parametrize("target", ["rapid", "tp", "urscript"])
def test_rules_about_speeds_are_told_and_the_path_stays(target: str) -> None:
    result, told, _ = translated("way.src", RULED, "krl", target, ARM)
    assert result.agrees and result.max_path_mm < 0.01, result.as_text()
    assert told.count("spline-speed-rule") == 2 and "spline-as-arcs" in told


@pytest.mark.parametrize("target", ["krl", "rpl"])
def test_rules_about_speeds_stay_where_there_are_such(target: str) -> None:
    result, told, text = translated("way.src", RULED, "krl", target, ARM)
    assert result.agrees and "spline-speed-rule" not in told, result.as_text()
    wanted = {
        "krl": ["CONST_VEL START=5 ONSTART", "TIME_BLOCK START", "TIME_BLOCK PART=2", "TIME_BLOCK END=1.5"],
        "rpl": ["PATH RULE constant_start AT 5 BEHIND START", "PATH RULE time_start", "PATH RULE time_part AT 2"],
    }[target]
    lines = [line.strip().replace("+", "") for line in text.splitlines()]
    assert [line for line in lines if line in wanted] == wanted


def block_of(*points: tuple[float, float], end: str = "") -> str:
    """A block from (0, 400) in y and z through further points, with a speed of its own at the second."""
    lines = [f"    SPL {{X 500.0,Y {y},Z {z},A 180.0,B 0.0,C 180.0}}" for y, z in points]
    lines[1] += " WITH $VEL.CP=0.1"
    head = SPLINES[: SPLINES.index("  ; through")]
    return "\n".join([head + "  SPLINE WITH $VEL.CP=0.2", *lines, f"  ENDSPLINE{end}", "  $OUT[1]=TRUE", "END", ""])


DENSE = [(10.0, 402.0), (20.0, 403.5), (30.0, 404.5), (40.0, 405.0), (50.0, 405.0)]
COARSE = [(40.0, 420.0), (80.0, 405.0), (120.0, 400.0)]
SOME = [("three points", [(40.0, 420.0), (80.0, 400.0)]), ("many points", DENSE)]


@pytest.mark.parametrize(("what", "points"), SOME)
def test_points_of_a_block_are_those_of_a_curve_in_a_job_where_both_are_the_same(
    what: str, points: list[tuple[float, float]]
) -> None:
    """Three points make one parabola in both; through more, the two curves differ by less than 0.05 mm."""
    result, told, text = translated("way.src", block_of(*points), "krl", "inform", ARM)
    assert result.agrees and result.max_path_mm < 0.06, result.as_text()
    assert "spline-as-points" in told and "spline-as-arcs" not in told, what
    said = [line.split()[2:] for line in text.splitlines() if line.startswith("MOVS ")]
    speeds = ["V=200.0", "V=200.0", "V=100.0", *["V=200.0"] * (len(points) - 2)]
    assert [one[0] for one in said] == speeds
    assert [one[1:] for one in said] == [["PL=0"], *[[]] * (len(points) - 1), ["PL=0"]]


def test_points_far_apart_stay_arcs_along_the_curve() -> None:
    result, told, text = translated("way.src", block_of(*COARSE), "krl", "inform", ARM)
    assert result.agrees and result.max_path_mm < 0.02, result.as_text()
    assert "spline-as-arcs" in told and "MOVS" not in text


def test_two_blocks_in_a_row_are_two_curves() -> None:
    text = block_of((40.0, 420.0), (80.0, 400.0))
    second = "  SPLINE\n" + "\n".join(
        f"    SPL {{X {500.0 + x},Y 80.0,Z {z},A 180.0,B 0.0,C 180.0}}" for x, z in ((20.0, 390.0), (40.0, 400.0))
    )
    result, told, _ = translated(
        "way.src", text.replace("  $OUT", second + "\n  ENDSPLINE\n  $OUT"), "krl", "inform", ARM
    )
    assert result.agrees and result.max_path_mm < 0.01, result.as_text()
    assert told.count("spline-as-points") == 2


def test_a_job_through_points_far_apart_is_written_as_arcs_along_its_own_curve() -> None:
    """A KRL block through the same points would bend in another way between them."""
    job = JOB.replace("NPOS 4", "NPOS 5").replace(
        "//INST", "C00004=500.000,160.000,410.000,180.0000,0.0000,0.0000\n//INST"
    )
    job = job.replace("DOUT", "MOVS C00004 V=100.0 PL=0\nDOUT").replace("C00003 V=50.0 PL=0", "C00003 V=50.0")
    # Arcs stand for the curve within about a hundredth of a millimetre; each controller has its own first corner.
    near = Accepted(path_mm=0.02)
    result, told, _ = translated("WAY.JBI", job, "inform", "krl", "motoman_gp7", near)
    assert result.agrees, result.as_text()
    assert "spline-as-arcs" in told
