"""Samples of a run: where the robot is, how fast, and which move has it there."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rpl.emulator.model import load_robot
from rpl.report.motion import line_text, move_rows, tool_rates
from rpl.report.sampling import STANDING, RunSamples, driven_moves, moments, sample_run, thinned
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program
from tests.runtime.helpers import KUKA, read

PROGRAM = """DEF prog( )
$VEL.CP=0.2
$ACC.CP=2
PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}
LIN_REL {Z -120}
WAIT SEC 0.5
LIN_REL {Y 300}
PTP {A1 30,A2 -80,A3 100,A4 10,A5 45,A6 20}
END
"""
MODEL = load_robot(KUKA)


@pytest.fixture(scope="module")
def result() -> RunResult:
    done = run_program(read("krl", PROGRAM), MODEL)
    assert done.status == "finished", done.fault
    return done


@pytest.fixture(scope="module")
def samples(result: RunResult) -> RunSamples:
    return sample_run(result, MODEL)


def test_speeds_and_accelerations_are_those_of_the_joints(result: RunResult) -> None:
    """Integrating accelerations gives speeds, integrating speeds gives joints, leg by leg; what a jump of acceleration
    between two samples adds is half of it for a millisecond."""
    samples = sample_run(result, MODEL, 0.001)
    gaps = np.diff(samples.times)[:, None]
    same = (np.diff(samples.moves) == 0)[:, None] & (gaps > 1e-6)
    for rates, values, slack in ((samples.speeds, samples.joints, 0.002), (samples.accelerations, samples.speeds, 2.5)):
        expected = 0.5 * (rates[1:] + rates[:-1]) * gaps
        assert np.abs(np.where(same, np.diff(values, axis=0) - expected, 0.0)).max() < slack
    assert np.all(samples.speeds[samples.moves == STANDING] == 0.0)


def test_the_tool_is_where_the_moves_have_it(result: RunResult, samples: RunSamples) -> None:
    for number, move in enumerate(driven_moves(result)):
        (leg,) = move.legs
        rows = samples.moves == number
        planned = leg.plan.tcp_at(samples.times[rows] - leg.start_s)[:, :3, 3]
        assert samples.tool[rows] == pytest.approx(planned, abs=1e-6)
        assert samples.joints[rows] == pytest.approx(leg.plan.joints_at(samples.times[rows] - leg.start_s), abs=1e-6)


def test_a_line_is_driven_at_its_speed(result: RunResult, samples: RunSamples) -> None:
    speeds, turning = tool_rates(MODEL, samples)
    rows = move_rows(driven_moves(result), samples, speeds, MODEL)
    assert [line_text(row.origin) for row in rows][2] == "LIN_REL {Y 300}"
    line = rows[2]
    assert line.length_mm == pytest.approx(300.0, abs=1e-6)
    assert line.top_speed_mm_s == pytest.approx(200.0, abs=0.01)
    # 300 mm at 200 mm/s and 2000 mm/s2 at least.
    assert line.end_s - line.start_s >= 300.0 / 200.0 + 200.0 / 2000.0 - 1e-9
    on_it = samples.moves == 2
    middle = on_it & (np.abs(samples.times - 0.5 * (line.start_s + line.end_s)) < 0.3)
    assert speeds[middle] == pytest.approx(200.0, abs=0.01)
    assert turning[on_it].max() < 1e-3
    assert all(0.0 < row.margin.share < 1.0 and row.speed.share <= 1.001 for row in rows)


def test_the_wait_is_a_rest_between_two_moves(result: RunResult, samples: RunSamples) -> None:
    standing = np.flatnonzero(samples.moves == STANDING)
    assert np.diff(samples.times[standing[:2]]) == pytest.approx(0.5)
    assert samples.times[-1] == pytest.approx(result.time_s)
    assert np.all(np.diff(samples.times) >= 0.0)


def test_a_run_without_moves_stands() -> None:
    still = sample_run(run_program(read("krl", "DEF prog( )\nWAIT SEC 2\nEND\n"), MODEL), MODEL)
    assert still.times.tolist() == [0.0, 2.0]
    assert np.all(still.moves == STANDING)


@given(start=st.floats(0, 1e4), duration=st.floats(1e-6, 50.0), step=st.sampled_from([0.004, 0.012, 0.1]))
def test_moments_are_both_ends_and_the_steps_between(start: float, duration: float, step: float) -> None:
    times = moments(start, duration, step)
    assert times[0] == start
    assert times[-1] == start + duration
    assert np.all(np.diff(times) > 0.0)
    assert np.diff(times).max() <= step * (1.0 + 1e-6)
    assert times[1:-1] / step == pytest.approx(np.round(times[1:-1] / step), abs=1e-6)


@given(count=st.integers(1, 3000), most=st.integers(10, 500), seed=st.integers(0, 1000))
def test_thinning_keeps_the_ends_and_the_extremes(count: int, most: int, seed: int) -> None:
    values = np.random.default_rng(seed).normal(size=count)
    flat = np.zeros((count, 1))
    samples = RunSamples(np.arange(count) * 1.0, flat, flat, flat, np.zeros((count, 3)), np.zeros(count, dtype=int))
    rows = thinned(samples, most, values)
    assert len(rows) <= most
    assert rows[0] == 0
    assert rows[-1] == count - 1
    assert values[rows].max() == values.max()
    assert values[rows].min() == values.min()
    assert np.all(np.diff(rows) > 0)
