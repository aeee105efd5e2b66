"""External axes on the page of a run: positions and speeds of the plan itself, with the limits that are known."""

from pathlib import Path

import numpy as np
import pytest

from rpl.cell import read_cell
from rpl.cli.main import run as rpl
from rpl.emulator.model import load_robot
from rpl.report.external import external_curves
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program
from tests.runtime.helpers import KUKA, krl, read

SAMPLE = Path(__file__).parents[2] / "samples" / "rapid" / "turntable"
TRACK = """PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0,E1 0,E2 5}
PTP {A1 10,A2 -90,A3 90,A4 0,A5 45,A6 0,E1 400,E2 5}
WAIT SEC 1
PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0,E1 100,E2 5}
"""


def test_axes_that_move_are_drawn_with_their_speeds() -> None:
    result = krl(TRACK, robot=KUKA, cell="external = [0, 5]")
    (curve,) = external_curves(result, {}, 0.012, 40_000)
    assert (curve.name, curve.unit, curve.limits) == ("E1", "deg or mm", None)
    assert np.isclose(curve.positions.max(), 400.0) and np.isclose(curve.positions[-1], 100.0)
    even = np.diff(curve.times) > 1e-4
    slopes = np.diff(curve.positions)[even] / np.diff(curve.times)[even]
    middles = 0.5 * (curve.speeds[1:] + curve.speeds[:-1])[even]
    assert np.abs(slopes - middles).max() < 0.02 * np.abs(curve.speeds).max()


def test_what_a_file_describes_is_drawn_with_its_limits() -> None:
    cell = read_cell(str(SAMPLE / "cell.toml"))
    program = read("rapid", (SAMPLE / "turntable.mod").read_text())
    result = run_program(program, load_robot("abb_irb4600_60_205"), cell)
    axes = {axis.number: axis for mechanism in cell.mechanisms for axis in mechanism.axes}
    (curve,) = external_curves(result, axes, 0.012, 40_000)
    assert (curve.unit, curve.limits, curve.top_speed) == ("deg", (-180.0, 180.0), 90.0)
    assert np.abs(curve.speeds).max() <= 90.0 * 1.001


def test_long_runs_are_thinned() -> None:
    result = krl(TRACK, robot=KUKA, cell="external = [0, 5]")
    (curve,) = external_curves(result, {}, 0.012, 30)
    assert len(curve.times) <= 32 and curve.positions.max() > 399.0


def test_a_run_without_external_axes_has_no_such_rows() -> None:
    result: RunResult = krl("PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}", robot=KUKA)
    assert external_curves(result, {}, 0.012, 40_000) == ()


def test_the_result_is_printed_where_the_page_cannot_be_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "n.src").write_text("DEF n()\nWAIT SEC 1\nEND\n")
    (tmp_path / "file").write_text("")
    command = ["run", str(tmp_path / "n.src"), "--robot", KUKA, "--times", "--plot", str(tmp_path / "file" / "p.html")]
    assert rpl(command) == 2
    shown = capsys.readouterr()
    assert "finished after 1.000 s" in shown.out and "cannot write" in shown.err
    assert "()" not in shown.out, "without a move there is no controller to name"
