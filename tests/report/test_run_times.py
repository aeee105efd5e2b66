"""Where the time of a run goes, and the interval that follows from what the controller file calls uncertain."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

from rpl.cli.main import run as rpl_command
from rpl.controllerfiles import controller_named
from rpl.diagnostics import Diagnostics
from rpl.emulator.model import load_robot
from rpl.motionmodel import MotionModel
from rpl.project import read_sources
from rpl.report.times import RunTimes, run_times
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program
from rpl.source import source_from_text

ARM = "kuka_kr6r900sixx"
PROGRAM = """DEF MAIN()
BAS(#INITMOV,0)
$TOOL=$NULLFRAME
$BASE=$NULLFRAME
$VEL.CP=0.2
$ACC.CP=1.0
$APO.CDIS=20
PTP {A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}
LIN {X 450,Y 0,Z 400,A 0,B 135,C 0}
WAIT SEC 0.5
LIN_REL {Y 200} C_DIS
LIN_REL {Z 100}
WAIT FOR $IN[1]
END
"""


def command(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, str, str]:
    status = rpl_command(list(words))
    shown = capsys.readouterr()
    return status, shown.out, shown.err


def run(controller: str | MotionModel = "krl") -> RunResult:
    from rpl.cell import Cell, Input

    read = read_sources([source_from_text("main.src", PROGRAM)], "krl", Diagnostics())
    result = run_program(read.program, ARM, Cell(inputs=(Input(6.0, "$IN[1]", True),)), controller=controller)
    assert result.status == "finished", result.fault
    return result


def times(controller: str | MotionModel = "krl") -> RunTimes:
    return run_times(run(controller), load_robot(ARM))


def test_every_second_of_the_run_is_accounted_for() -> None:
    found = times()
    parts = found.moving_s + found.blending_s + found.timed_s + found.signal_s + found.standing_s
    assert parts == pytest.approx(found.total_s, abs=1e-6)
    assert found.timed_s == pytest.approx(0.5) and found.standing_s == pytest.approx(0.0, abs=1e-6)
    last = found.moves[-1]
    assert found.signal_s == pytest.approx(found.total_s - last.start_s - last.seconds, abs=1e-3)
    assert [move.kind for move in found.moves] == ["joint", "linear", "linear", "linear"]
    assert [move.blended_s > 0.0 for move in found.moves] == [False, False, True, False]


@pytest.mark.parametrize("wrong", [0.8, 1.25])
@pytest.mark.parametrize("parameter", ["joint_smoothing_s", "path_smoothing_s"])
def test_a_controller_that_is_wrong_by_what_is_declared_ends_within_the_interval(parameter: str, wrong: float) -> None:
    model = replace(controller_named("plain"), joint_smoothing_s=0.1, path_smoothing_s=0.2, name="test")
    declared = replace(model, uncertainty={"joint_smoothing_s": 0.25, "path_smoothing_s": 0.25})
    nominal = times(declared)
    other = times(replace(declared, **{parameter: getattr(model, parameter) * wrong}))
    ends = [[move.start_s + move.seconds for move in each.moves][-1] for each in (nominal, other)]
    effect = {name: (early, late) for name, early, late in nominal.effects}[parameter]
    assert ends[0] - effect[0] - 1e-6 <= ends[1] <= ends[0] + effect[1] + 1e-6
    assert abs(ends[1] - ends[0]) > 0.5 * min(effect)  # and not by far


def test_a_controller_that_is_sure_gives_a_narrow_interval() -> None:
    arm = replace(load_robot(ARM), uncertain_axes=False)
    found = run_times(run(replace(controller_named("krl"), uncertainty={}, name="test")), arm)
    assert found.low_s == found.high_s == found.total_s and not found.effects


def test_the_command_prints_a_line_a_move_and_the_sums(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "main.src"
    file.write_text(PROGRAM.replace("WAIT FOR $IN[1]\n", ""), encoding="utf-8")
    words = ("run", str(file), "--robot", ARM)
    status, shown, _ = command(capsys, *words, "--times")
    assert status == 0 and "linear main.src:11" in shown and "KUKA KR C4" in shown
    document = json.loads(command(capsys, *words, "--times", "--json")[1])
    low, high = document["times"]["interval_s"]
    assert low < document["time_s"] == document["times"]["total_s"] < high
    assert len(document["times"]["moves"]) == 4
    plain = json.loads(command(capsys, *words, "--controller", "plain", "--json")[1])
    assert plain["time_s"] < document["time_s"]  # no smoothing


def test_what_cannot_be_asked_is_refused_by_name(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "main.src"
    file.write_text(PROGRAM, encoding="utf-8")
    for options, told in (
        (["--times"], "--robot"),
        (["--robot", ARM, "--controller", "kru"], "did you mean krl?"),
        (["--robot", ARM, "--controller", str(tmp_path / "none.toml")], "cannot be read"),
    ):
        status, _, said = command(capsys, "run", str(file), *options)
        assert status == 2 and told in said


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("joint_ramp = 0.1", "unknown key 'joint_ramp'; meant joint_ramp_s?"),
        ("joint_ramp_s = -1", "'joint_ramp_s' must be a number of at least 0"),
        ("joint_ramp_s = nan", "'joint_ramp_s' must be a number of at least 0"),
        ("path_acceleration_mm_s2 = 0", "must be more than 0"),
        ("overlap = [[10, 0.5], [5, 0.2]]", "rising percents"),
        ("overlap = [[10, 1.5]]", "shares of at most 1"),
        ("[uncertainty]\nspeed = 0.1", "uncertainty of 'speed', which is no parameter"),
        ("title = ", "Invalid value"),
    ],
)
def test_a_controller_file_that_is_wrong_is_refused_with_its_key(tmp_path: Path, text: str, told: str) -> None:
    from rpl.errors import UsageError

    file = tmp_path / "own.toml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(UsageError) as caught:
        controller_named(str(file))
    assert told in str(caught.value) and "own.toml" in str(caught.value)


BEHIND_A_CORNER = """/PROG  AHEAD
/ATTR
/MN
   1:  $WAITTMOUT=300 ;
   2:J P[1] 50% CNT50 ;
   3:  WAIT DI[1]=ON TIMEOUT,LBL[1] ;
   4:  LBL[1] ;
   5:J P[2] 50% FINE ;
/POS
P[1]{
   GP1:
    UF : 0, UT : 1,
    J1= 10.000 deg, J2= 0.000 deg, J3= 0.000 deg,
    J4= 0.000 deg, J5= -60.000 deg, J6= 0.000 deg
};
P[2]{
   GP1:
    UF : 0, UT : 1,
    J1= 30.000 deg, J2= 0.000 deg, J3= 0.000 deg,
    J4= 0.000 deg, J5= -60.000 deg, J6= 0.000 deg
};
/END
"""


def test_a_wait_that_begins_before_the_robot_stands_is_waiting_for_signals() -> None:
    read = read_sources([source_from_text("ahead.ls", BEHIND_A_CORNER)], "tp", Diagnostics())
    result = run_program(read.program, "fanuc_m710ic50", controller="tp")
    assert result.status == "finished", result.fault
    (wait,) = [event for event in result.trace if event.kind == "wait"]
    found = run_times(result, load_robot("fanuc_m710ic50"))
    first, second = found.moves
    assert wait.t < first.start_s + first.seconds < wait.t + 3.0
    assert found.signal_s == pytest.approx(wait.t + 3.0 - first.start_s - first.seconds, abs=1e-3)
    assert found.standing_s == pytest.approx(second.start_s - wait.t - 3.0, abs=1e-3)
