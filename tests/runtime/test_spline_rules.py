"""CONST_VEL and TIME_BLOCK in spline blocks, in seconds and millimetres per second.

KSS 8 operating and programming instructions: the time of a TIME_BLOCK is kept exactly and its components are shares of
it whatever their sum; a time that cannot be kept makes the block as fast as possible. A CONST_VEL part has one speed;
where it cannot be reached in time it is lowered (message 3216).
"""

import pytest
from helpers import KUKA, krl, moves, run
from test_spline_blocks import INIT, POINTS, place, speeds

from rpl.runtime.trace import Event, RunResult

SEGMENTS = [f"SPL {place(point)}\n" for point in POINTS]
FREE_S = [0.306478, 0.215067, 0.194591, 0.331823]


def driven(lines: str) -> list[Event]:
    result: RunResult = krl(INIT + lines, robot=KUKA)
    assert result.status == "finished", result.fault
    return moves(result)[2:]


def durations(events: list[Event]) -> list[float]:
    return [event.data["duration"] for event in events]


def blocked(*lines: str) -> str:
    return "SPLINE\n" + "".join(lines) + "ENDSPLINE\n"


def test_without_a_rule_the_block_takes_its_own_time() -> None:
    assert durations(driven(blocked(*SEGMENTS))) == pytest.approx(FREE_S, abs=1e-5)


@pytest.mark.parametrize(("time_s", "kept"), [(1.5, True), (4.0, True), (0.5, False)])
def test_the_time_of_a_block_is_kept_where_it_can_be(time_s: float, kept: bool) -> None:
    events = driven(blocked("TIME_BLOCK START\n", *SEGMENTS, f"TIME_BLOCK END={time_s}\n"))
    assert sum(durations(events)) == pytest.approx(time_s if kept else sum(FREE_S), abs=2e-5)


@pytest.mark.parametrize("shares", [(1, 2), (20.5, 41), (30, 20)])
def test_components_are_shares_of_the_time_whatever_their_sum(shares: tuple[float, float]) -> None:
    one, two, three, four = SEGMENTS
    parts = (f"TIME_BLOCK PART={share}\n" for share in shares)
    events = driven(
        blocked(one, "TIME_BLOCK START\n", two, next(parts), three, next(parts), "TIME_BLOCK END=0.9\n", four)
    )
    found = durations(events)
    assert found[1] + found[2] == pytest.approx(0.9, abs=1e-5)
    assert found[1] == pytest.approx(0.9 * shares[0] / sum(shares), abs=1e-4)


def test_a_time_reaches_over_a_stop_in_the_block() -> None:
    first, second = (550, 40, 400), (550, 80, 440)
    lines = blocked(
        "TIME_BLOCK START\n", f"SLIN {place(first)}\n", f"SLIN {place(second)}\n", "TIME_BLOCK END=3\n", SEGMENTS[3]
    )
    events = driven(lines)
    assert [event.stops for event in events] == [True, False, True]
    assert sum(durations(events)[:2]) == pytest.approx(3.0, abs=2e-5)


def test_a_block_of_joint_moves_can_have_a_time() -> None:
    lines = "PTP_SPLINE\nTIME_BLOCK START\nSPTP_REL {A1 20}\nSPTP_REL {A1 20,A2 10}\nTIME_BLOCK END=2.5\nENDSPLINE"
    assert sum(durations(driven(lines))) == pytest.approx(2.5, abs=1e-5)


def test_a_part_of_constant_speed_has_the_lowest_of_its_segments() -> None:
    one, two, three, four = SEGMENTS
    slow = three.replace("\n", " WITH $VEL.CP=0.1\n")
    events = driven(blocked("CONST_VEL START=10\n", one, two, slow, "CONST_VEL END=-10\n", four))
    # it ends 10 mm before the last point, so that the fourth segment belongs to it, too
    assert speeds(events[2]) == pytest.approx([100.0] * 9, abs=0.1)
    assert speeds(events[0]).max() == pytest.approx(200.0, abs=0.5) and speeds(events[1])[-1] == pytest.approx(100.0)
    assert speeds(events[3])[:5] == pytest.approx([100.0] * 5, abs=0.1)


def test_where_the_speed_cannot_be_reached_in_time_it_is_lowered() -> None:
    """Message 3216: `the acceleration distance for CONST_VEL START is too short`."""
    events = driven(blocked("CONST_VEL START=4 ONSTART\n", *SEGMENTS))
    found = speeds(events[1])
    assert found == pytest.approx([found[0]] * 9, rel=1e-3) and 20.0 < found[0] < 150.0


def test_at_a_stop_the_part_begins_where_the_speed_is_reached() -> None:
    """The limits of the block are not exceeded: an offset beyond them is made smaller."""
    events = driven(blocked("CONST_VEL START=-500\n", *SEGMENTS, "CONST_VEL END=500\n"))
    inside = speeds(events[1])
    assert inside == pytest.approx([inside[0]] * 9, rel=1e-3) and 150.0 < inside[0] < 190.0  # of the tightest place
    assert speeds(events[0])[0] == pytest.approx(0.0, abs=1e-6) and speeds(events[3])[-1] == pytest.approx(
        0.0, abs=1e-6
    )


def test_a_rule_outside_of_a_block_stops_the_run() -> None:
    result = run("rpl", "MODULE m\nPROCEDURE main()\nPATH RULE time_start\nEND PROCEDURE\nEND MODULE\n", robot=KUKA)
    assert result.fault is not None and result.fault.code == "motion"
