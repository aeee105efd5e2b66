"""Spline blocks in a run: one path through the points, what happens on it, where it stops, what the trace shows."""

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from helpers import KUKA, krl, on, run

from rpl.runtime.trace import Event, RunResult

INIT = """BAS(#INITMOV,0)
$TOOL=$NULLFRAME
$BASE=$NULLFRAME
$APO.CDIS=10
$VEL.CP=0.2
$ACC.CP=2
PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}
LIN {X 550,Y 0,Z 400,A 0,B 135,C 0}
"""
POINTS = [(560, 40, 400), (550, 80, 410), (530, 110, 400), (550, 150, 400)]


def place(point: tuple[float, ...]) -> str:
    x, y, z = point
    return f"{{X {x},Y {y},Z {z},A 0,B 135,C 0}}"


def block(between: str = "", head: str = "", tail: str = "") -> str:
    """Four spline points; `between` stands in front of the third."""
    lines = [f"SPL {place(point)}" for point in POINTS]
    lines.insert(2, between)
    return "\n".join([f"SPLINE {head}", *lines, f"ENDSPLINE {tail}", ""])


def moves(result: RunResult) -> list[Event]:
    return [event for event in result.trace if event.kind == "move"]


def times(result: RunResult) -> dict[str, float]:
    return {name: t for t, name, value in result.outputs if value}


def speeds(event: Event) -> Any:
    """The tool's speed (mm/s) at some moments of a move."""
    found = []
    for leg in event.legs:
        at = leg.offset_s + np.linspace(0.0, leg.duration_s, 9)
        found.append(
            leg.plan.law.speed_at(at)
            * (leg.plan.span[1] - leg.plan.span[0])
            * leg.plan.geometry.distance(np.ones(1))[0]
        )
    return np.concatenate(found)


def test_a_block_goes_through_its_points_without_a_stop() -> None:
    result = krl(INIT + block(), robot=KUKA)
    assert result.status == "finished", result.fault
    points = moves(result)[2:]
    assert [event.data["motion"] for event in points] == ["spline"] * 4
    assert [event.stops for event in points] == [False, False, False, True]
    assert [event.data["xyz_mm"] for event in points] == [pytest.approx(point, abs=1e-4) for point in POINTS]
    assert speeds(points[1]).min() > 150.0 and speeds(points[0])[-1] > 150.0
    assert sum(event.data["duration"] for event in points) == pytest.approx(
        result.time_s - moves(result)[1].t, abs=1e-5
    )
    assert [event.origin.line for event in points] == [12, 13, 15, 16]


def test_the_legs_of_the_segments_join() -> None:
    """Each segment has its part of the one plan: they end where the next one begins, in time and in place."""
    legs = [leg for event in moves(krl(INIT + block(), robot=KUKA))[2:] for leg in event.legs]
    for one, other in pairwise(legs):
        assert one.start_s + one.duration_s == pytest.approx(other.start_s)
        ends = one.plan.tcp_at(one.offset_s + one.duration_s), other.plan.tcp_at(other.offset_s)
        assert ends[0] == pytest.approx(ends[1], abs=1e-6)


def test_each_segment_has_its_own_speed() -> None:
    slow = INIT + block().replace(f"SPL {place(POINTS[2])}", f"SPL {place(POINTS[2])} WITH $VEL.CP=0.05")
    found = [speeds(event) for event in moves(krl(slow, robot=KUKA))[2:]]
    assert [each.max() for each in found[:2]] == pytest.approx([200.0, 200.0], rel=0.02)
    assert np.median(found[2]) == pytest.approx(50.0, rel=0.02)


@pytest.mark.parametrize(
    ("trigger", "where"),
    [
        ("TRIGGER WHEN PATH=0 ONSTART DELAY=0 DO $OUT[1]=TRUE", (1, 0.0)),
        ("TRIGGER WHEN PATH=5 ONSTART DELAY=0 DO $OUT[1]=TRUE", (1, 5.0)),
        ("TRIGGER WHEN PATH=-5 ONSTART DELAY=0 DO $OUT[1]=TRUE", (1, -5.0)),
        ("TRIGGER WHEN PATH=0 DELAY=0 DO $OUT[1]=TRUE", (2, 0.0)),
        ("TRIGGER WHEN PATH=-8 DELAY=0 DO $OUT[1]=TRUE", (2, -8.0)),
        ("TRIGGER WHEN PATH=12 DELAY=0 DO $OUT[1]=TRUE", (2, 12.0)),
    ],
)
def test_triggers_on_the_path_of_the_block(trigger: str, where: tuple[int, float]) -> None:
    """KSS: the distance is counted from a point of the block along its path, also beyond the segment."""
    result = krl(INIT + block(trigger), robot=KUKA)
    points = moves(result)[2:]
    number, distance = where
    plan, begin = points[0].legs[0].plan, points[0].legs[0].start_s
    at_point, at_output = (
        plan.geometry.distance(np.array([plan.law.fraction_at(t - begin)]))[0]
        for t in (points[number].t, times(result)["$OUT[1]"])
    )
    assert at_output - at_point == pytest.approx(distance, abs=1e-3)


def test_a_delay_counts_from_the_point() -> None:
    result = krl(INIT + block("TRIGGER WHEN PATH=0 DELAY=30 DO $OUT[1]=TRUE"), robot=KUKA)
    assert times(result)["$OUT[1]"] == pytest.approx(moves(result)[4].t + 0.03)


def test_the_robot_stops_between_straight_segments_at_an_angle() -> None:
    """KSS: successive SLIN segments that are no straight line are driven with zero speed between them."""
    first, second = (550, 40, 400), (550, 80, 440)
    lines = f"SPLINE\nSLIN {place(first)}\nSLIN {place(second)}\nSPL {place((550, 120, 440))}\nENDSPLINE"
    points = moves(krl(INIT + lines, robot=KUKA))[2:]
    assert [event.stops for event in points] == [True, False, True]
    assert speeds(points[0])[-1] == pytest.approx(0.0, abs=1e-6)


def test_a_block_blends_into_the_next_move() -> None:
    """The corner takes at most half of the last segment (M)."""
    after = f"SLIN {place((600, 150, 400))}"
    result = krl(INIT + "$APO.CDIS=500\n" + block(tail="C_SPL") + after, robot=KUKA)
    assert result.status == "finished", result.fault
    points = moves(result)[2:]
    assert [event.stops for event in points] == [False] * 4 + [True]
    corner = next(leg.plan for leg in points[3].legs if leg.plan.kind == "corner")
    whole = points[0].legs[0].plan.geometry
    last = whole.distance(np.ones(1))[0] - 0.5 * np.linalg.norm(np.array(POINTS[3]) - POINTS[2]) * 1.1
    left = points[3].legs[0].plan
    assert whole.distance(np.array([left.span[1]]))[0] > last
    assert corner.length_mm > 5.0


def test_a_move_blends_into_a_block() -> None:
    result = krl(INIT + f"SLIN {place((550, -40, 400))}\nSLIN {place((550, 0, 400))} C_SPL\n" + block(), robot=KUKA)
    points = moves(result)[3:]
    assert [event.stops for event in points] == [False, False, False, False, True]
    assert [event.data["xyz_mm"] for event in points[1:]] == [pytest.approx(point, abs=1e-4) for point in POINTS]


CALLED = "DEF PART( )\n" + block() + "WAIT SEC 0\n$OUT[1]=TRUE\nEND\n"
WATCHED = INIT + "INTERRUPT DECL 10 WHEN $IN[1] DO HIT( )\nINTERRUPT ON 10\nPART( )\nINTERRUPT OFF 10\n$OUT[2]=TRUE"


def _come_at(time_s: float) -> str:
    return f"[[input]]\ntime={time_s}\nsignal='$IN[1]'\nvalue=true\n"


def test_an_interrupt_brakes_on_the_curve_and_goes_on() -> None:
    more = CALLED + "DEF HIT( )\nBRAKE\nWAIT SEC 2\nEND"
    free = krl(WATCHED, more=more, robot=KUKA)
    undisturbed = moves(free)[2:]
    for time_s in (undisturbed[0].t - 0.05, undisturbed[1].t - 0.01, undisturbed[2].t):  # brakes over a point, too
        result = krl(WATCHED, more=more, robot=KUKA, cell=_come_at(time_s))
        assert result.status == "finished", result.fault
        points = moves(result)[2:]
        assert [event.data["xyz_mm"] for event in points] == [event.data["xyz_mm"] for event in undisturbed]
        assert 2.0 < result.time_s - free.time_s < 2.3
        path = undisturbed[0].legs[0].plan.geometry.tcp(np.linspace(0, 1, 4000))[:, :3, 3]
        for leg in (leg for event in points for leg in event.legs):
            for at in np.linspace(leg.offset_s, leg.offset_s + leg.duration_s, 5):
                assert np.linalg.norm(path - leg.plan.tcp_at(at)[:3, 3], axis=1).min() < 0.05


def test_a_resume_leaves_the_block_on_its_way() -> None:
    more = CALLED + "DEF HIT( )\nBRAKE\nRESUME\nEND"
    time_s = moves(krl(WATCHED, more=more, robot=KUKA))[3].t + 0.05
    result = krl(WATCHED, more=more, robot=KUKA, cell=_come_at(time_s))
    assert result.status == "finished", result.fault
    assert on(result) == {"$OUT[2]": True}
    points = moves(result)[2:]
    assert len(points) == 3 and points[-1].data["interrupted"]
    assert points[-1].origin.line == moves(krl(WATCHED, more=more, robot=KUKA))[4].origin.line


def test_why_a_block_cannot_be_driven_names_its_point() -> None:
    far = block().replace(place(POINTS[2]), place((5500, 110, 400)))
    result = krl(INIT + far, robot=KUKA)
    assert result.status == "fault" and result.fault is not None
    assert (result.fault.code, result.fault.origin.line) == ("unreachable", 15)


def test_relative_points_and_constant_orientation() -> None:
    lines = "SPLINE WITH $ORI_TYPE=#CONSTANT\nSPL_REL {Y 40,A 20}\nSPL_REL {Y 40,Z 10}\nSLIN_REL {Y 30}\nENDSPLINE"
    points = moves(krl(INIT + lines, robot=KUKA))[2:]
    assert points[-1].data["xyz_mm"] == pytest.approx([550, 110, 410], abs=1e-3)
    assert points[-1].data["quat_wxyz"] == pytest.approx(moves(krl(INIT, robot=KUKA))[1].data["quat_wxyz"], abs=1e-6)


def test_a_joint_block_is_one_smooth_move() -> None:
    lines = (
        "PTP_SPLINE WITH $VEL_AXIS[1]=50\nSPTP_REL {A1 20}\nSPTP_REL {A1 20,A2 10}\nSPTP_REL {A1 -5,A5 10}\nENDSPLINE"
    )
    result = krl(INIT + lines, robot=KUKA)
    points = moves(result)[2:]
    assert [(event.data["motion"], event.stops) for event in points] == [
        ("joint", False),
        ("joint", False),
        ("joint", True),
    ]
    assert points[0].data["joints"][0] == pytest.approx(20.0, abs=1e-6)
    assert points[-1].data["joints"][0] == pytest.approx(35.0, abs=1e-6)


def external(event: Event, count: int = 9) -> Any:
    """External axis 1 at even moments of a move."""
    (leg,) = event.legs
    return leg.plan.external_at(leg.offset_s + np.linspace(0.0, leg.duration_s, count))[:, 0]


def test_moving_external_axes_go_smoothly_through_what_the_points_say() -> None:
    """The path is the same as without them; M: between the points their way is smooth."""
    lines = block()
    for value, point in zip((10, 30, 80, 100), POINTS, strict=True):
        lines = lines.replace(place(point), place(point).replace("}", f",E1 {value}}}"))
    points = moves(krl(INIT + "LIN_REL {E1 0}\n" + lines, robot=KUKA))[3:]
    assert [event.stops for event in points] == [False, False, False, True]
    assert [event.data["xyz_mm"] for event in points] == [pytest.approx(point, abs=1e-4) for point in POINTS]
    assert [external(event)[-1] for event in points] == pytest.approx([10, 30, 80, 100], abs=1e-3)
    together = np.concatenate([external(event) for event in points])
    assert (np.diff(together) > -1e-6).all()


def test_an_external_axis_that_is_slow_slows_the_block_down() -> None:
    far = block().replace(place(POINTS[3]), place(POINTS[3]).replace("}", ",E1 1000}"))
    points = moves(krl(INIT + "LIN_REL {E1 0}\n" + far, robot=KUKA))[3:]
    assert external(points[-1])[-1] == pytest.approx(1000.0)
    assert sum(event.data["duration"] for event in points) > 1000.0 / 500.0  # M: 500 mm/s where nothing is known


def test_what_has_no_curve_is_refused_with_its_line() -> None:
    other = block().replace(
        f"SPL {place(POINTS[2])}", f"SPL {place(POINTS[2])} WITH $TOOL={{X 0,Y 0,Z 50,A 0,B 0,C 0}}"
    )
    result = krl(INIT + other, robot=KUKA)
    assert result.fault is not None and (result.fault.code, result.fault.origin.line) == ("no-curve", 15)
    assert "another tool" in result.fault.message


def test_without_a_robot_every_point_is_made_at_once() -> None:
    result = krl(block("TRIGGER WHEN PATH=0 DELAY=0 DO $OUT[1]=TRUE"))
    assert [event.data["xyz_mm"] for event in moves(result)] == [list(map(float, point)) for point in POINTS]
    assert on(result) == {"$OUT[1]": True}


OUTPUTS = """MODULE prog
PROCEDURE main()
    MOVE TO joints {j1: 0, j2: -90, j3: 90, j4: 0, j5: 45, j6: 0}
    MOVE LINEAR TO pose {x: 550, y: 0, z: 400, a: 0, b: 135, c: 0}
    SPLINE
        MOVE SPLINE TO pose {x: 560, y: 40, z: 400, a: 0, b: 135, c: 0}
        SET do[1] TO ON
        MOVE SPLINE TO pose {x: 550, y: 80, z: 400, a: 0, b: 135, c: 0}
        %s
        MOVE SPLINE TO pose {x: 530, y: 120, z: 400, a: 0, b: 135, c: 0}
    END SPLINE
    SET do[2] TO ON
END PROCEDURE
END MODULE
"""


def test_an_output_between_two_points_is_switched_in_passing() -> None:
    result = run("rpl", OUTPUTS % "SET do[3] TO ON", robot=KUKA)
    assert result.status == "finished", result.fault
    points = moves(result)[2:]
    assert [event.stops for event in points] == [False, False, True]
    assert [t for t, _, _ in result.outputs] == pytest.approx([event.t for event in points])


def test_a_statement_that_has_to_wait_ends_the_path() -> None:
    result = run("rpl", OUTPUTS % "SET do[4] TO di[1]", robot=KUKA)
    assert [event.stops for event in moves(result)[2:]] == [False, True, True]
