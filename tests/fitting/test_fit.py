"""`rpl fit`: logs made with hidden parameters and noise give them back; logs that cannot be used say why."""

from __future__ import annotations

import csv
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from rpl.cli.main import run as rpl
from rpl.controllerfiles import controller_named, parse_controller
from rpl.diagnostics import Diagnostics
from rpl.emulator.model import RobotModel, load_robot
from rpl.errors import UsageError
from rpl.fitting.adjust import Fitted, Told, fit_alone, fit_with_program, run_at
from rpl.fitting.log import Log, read_log
from rpl.fitting.parameters import chosen, prepared
from rpl.motionmodel import MotionModel
from rpl.project import read_program
from rpl.simulation import RunResult, run_program

POSES = "".join(
    f"P[{number}]{{\n GP1:\n UF : 0, UT : 1, CONFIG : 'N U T, 0, 0, 0',\n"
    f" X = {x} mm, Y = {y} mm, Z = {z} mm,\n W = 180.0 deg, P = 0.0 deg, R = 135.0 deg\n}};\n"
    for number, (x, y, z) in enumerate([(1100, -400, 600), (1400, 300, 900), (1300, -300, 700), (1300, 200, 700)], 1)
)
TP = f"""/PROG  LOGGED
/MN
 1: UFRAME_NUM=0 ;
 2: UTOOL_NUM=1 ;
 3:J P[1] 20% FINE ;
 4: WAIT .20(sec) ;
 5:J P[2] 40% FINE ;
 6: WAIT .20(sec) ;
 7:L P[3] 300mm/sec FINE ;
 8: WAIT .20(sec) ;
 9:L P[4] 500mm/sec CNT60 ;
10:L P[1] 500mm/sec FINE ;
/POS
{POSES}/END
"""
REST = "[0,0.3826834,0.9238795,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"
RAPID = f"""MODULE Logged
 CONST robtarget p1:=[[1300,-300,800],{REST};
 CONST robtarget p2:=[[1300,300,800],{REST};
 CONST robtarget p3:=[[1600,300,800],{REST};
 PROC main()
  ConfL\\Off;
  ConfJ\\Off;
  MoveJ p1,v500,fine,tool0;
  WaitTime 0.2;
  MoveL p2,v1000,fine,tool0;
  WaitTime 0.2;
  MoveL p1,v500,fine,tool0;
  WaitTime 0.2;
  MoveL p2,v500,z50,tool0;
  MoveL p3,v500,fine,tool0;
 ENDPROC
ENDMODULE
"""
KRL = """DEF LOGGED()
 BAS(#INITMOV,0)
 PTP {A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}
 WAIT SEC 0.2
 PTP {A1 60,A2 -70,A3 90,A4 0,A5 30,A6 0}
 WAIT SEC 0.2
 PTP {A1 20,A2 -100,A3 110,A4 20,A5 40,A6 0}
 WAIT SEC 0.2
 $VEL.CP=0.4
 LIN_REL {X 150}
 WAIT SEC 0.2
 $VEL.CP=0.15
 LIN_REL {Z -150}
END
"""
CASES = {
    # name: language, robot, changed, how closely each comes back
    "ramps": (
        ("tp", TP, "fanuc_m20id25", {"joint_ramp_s": 0.24, "path_ramp_s": 0.19}),
        {"joint_ramp_s": 0.01, "path_ramp_s": 0.01},
    ),
    "overlap": (("tp", TP, "fanuc_m20id25", {"corner_ramp_s": 0.30}), {"corner_ramp_s": 0.05}),
    "path": (
        (
            "rapid",
            RAPID,
            "abb_irb6700_140_285",
            {"path_acceleration_mm_s2": 5000.0, "path_smoothing_s": 0.16, "corner_cut": 0.26},
        ),
        {"path_acceleration_mm_s2": 0.03, "path_smoothing_s": 0.03, "corner_cut": 0.04},
    ),
    "smoothing": (
        (
            "krl",
            KRL,
            "kuka_kr6r900sixx",
            {"joint_smoothing_s": 0.22, "path_smoothing_s": 0.07, "joint_acceleration_share": 1.6},
        ),
        {"joint_smoothing_s": 0.03, "path_smoothing_s": 0.05, "joint_acceleration_share": 0.04},
    ),
}
SUFFIX = {"tp": "logged.ls", "rapid": "Logged.mod", "krl": "logged.src"}


def program_of(folder: Path, language: str, text: str) -> Path:
    path = folder / SUFFIX[language]
    path.write_text(text, encoding="utf-8")
    return path


def driven(path: Path, robot: RobotModel, controller: MotionModel) -> RunResult:
    result = run_program(read_program([path], None, Diagnostics()).program, robot, controller=controller)
    assert result.fault is None, result.fault
    return result


def recorded(result: RunResult, joints: bool, noise: float = 0.004, step_s: float = 0.004) -> Log:
    """What a recorder would have written: begun 0.3 s early at another time, with noise and rounding."""
    times = np.arange(-0.3, result.time_s + 0.3, step_s)
    values = run_at(result, times, joints)
    values = np.round(values + np.random.default_rng(7).normal(0.0, noise, values.shape), 4)
    return Log("made.csv", times + 12.5, values, joints)


def fitted(folder: Path, case: str, joints: bool, alone: bool = False) -> tuple[Fitted, dict[str, float]]:
    language, text, name, hidden = CASES[case][0]
    robot = load_robot(name)
    base = prepared(controller_named(language), robot)
    secret = replace(base, **hidden)  # type: ignore[arg-type]  # names of number fields
    path = program_of(folder, language, text)
    log = recorded(driven(path, robot, secret), joints)
    names = tuple(hidden)
    if alone:
        names = (*names, "path_acceleration_mm_s2")  # what the program says of it is not in the log
        return fit_alone(log, robot, base, chosen(base, names)), hidden
    return fit_with_program(log, robot, base, chosen(base, names), partial(driven, path, robot)), hidden


@pytest.mark.parametrize("joints", [True, False], ids=["joints", "places"])
@pytest.mark.parametrize("case", CASES)
def test_hidden_parameters_come_back(case: str, joints: bool, tmp_path: Path) -> None:
    found, hidden = fitted(tmp_path, case, joints)
    by_name = {one.name: one for one in found.parameters}
    for name, tolerance in CASES[case][1].items():
        assert by_name[name].value == pytest.approx(hidden[name], rel=tolerance), name
        assert by_name[name].determined == "well"
    assert found.rms < 0.006
    assert max(abs(move.emulated_s - move.measured_s) for move in found.moves) < 0.012


@pytest.mark.parametrize(("case", "joints"), [("ramps", True), ("path", False), ("smoothing", True)])
def test_straight_moves_tell_their_time_law_without_the_program(case: str, joints: bool, tmp_path: Path) -> None:
    found, hidden = fitted(tmp_path, case, joints, alone=True)
    by_name = {one.name: one for one in found.parameters}
    told = [name for name in hidden if np.isfinite(by_name[name].deviation)]
    assert len(told) >= (1 if case == "path" else 2)
    for name in told:
        half = 0.5 if name == "joint_acceleration_share" else 1.0  # the program asks for half of the accelerations
        assert by_name[name].value == pytest.approx(half * hidden[name], rel=0.06), name


def test_a_parameter_without_a_say_is_kept_and_said_so(tmp_path: Path) -> None:
    language, text, name, _ = CASES["smoothing"][0]
    robot = load_robot(name)
    base = prepared(controller_named(language), robot)
    path = program_of(tmp_path, language, text)
    log = recorded(driven(path, robot, base), True)
    found = fit_with_program(log, robot, base, chosen(base, ("corner_cut",)), partial(driven, path, robot))
    assert found.parameters[0].determined == "not at all"
    assert found.parameters[0].value == base.corner_cut
    assert "corner_cut" not in found.controller.uncertainty


def test_another_program_than_the_recorded_one_is_noticed(tmp_path: Path) -> None:
    language, text, name, _ = CASES["smoothing"][0]
    robot = load_robot(name)
    base = prepared(controller_named(language), robot)
    path = program_of(tmp_path, language, text)
    log = recorded(driven(path, robot, base), True)
    short = program_of(tmp_path, language, text.replace(" LIN_REL {Z -150}\n", ""))
    with pytest.raises(UsageError, match=r"5 motions from rest to rest, the program makes 4"):
        fit_with_program(log, robot, base, chosen(base, ()), partial(driven, short, robot))


WRONG = {
    "radians": (True, lambda values: np.radians(values), r"the log's places are in rad; deg are needed"),
    "metres": (False, lambda values: values / 1000.0, r"the log's places are in m; mm are needed"),
    "inches": (False, lambda values: values / 25.4, r"the log's places are in inches; mm are needed"),
    "signs": (True, lambda values: -values, r"motion 1 of the log, .* from where the program's ends: other signs"),
    "order": (True, lambda values: values[:, ::-1], r"motion \d of the log, .* another order of joints"),
    "frame": (
        False,
        lambda values: values + np.array([0.0, 0.0, 400.0]),
        r"motion 1 of the log, .* another frame or tool",
    ),
}


@pytest.mark.parametrize("case", WRONG)
def test_places_of_another_unit_or_frame_are_refused(case: str, tmp_path: Path) -> None:
    joints, change, told = WRONG[case]
    language, text, name, _ = CASES["path"][0]
    robot = load_robot(name)
    base = prepared(controller_named(language), robot)
    path = program_of(tmp_path, language, text)
    log = recorded(driven(path, robot, base), joints)
    with pytest.raises(UsageError, match=told):
        fit_with_program(
            replace(log, values=change(log.values)), robot, base, chosen(base, ()), partial(driven, path, robot)
        )


RECORDERS = {
    # noise (deg, mm), step s, what is kept of the moments
    "slow": (True, 0.004, 0.05, lambda times: times > -9.0),
    "noisy": (True, 0.05, 0.004, lambda times: times > -9.0),
    "noisy places": (False, 0.2, 0.004, lambda times: times > -9.0),
    "uneven": (True, 0.004, 0.004, lambda times: np.random.default_rng(1).random(len(times)) > 0.5),
    "with a gap": (True, 0.004, 0.004, lambda times: (times < 13.6) | (times > 14.0)),
}


@pytest.mark.parametrize("recorder", RECORDERS)
def test_other_recorders_give_the_parameters_back_too(recorder: str, tmp_path: Path) -> None:
    """The remaining error is the recorder's own noise, whatever it is."""
    joints, noise, step_s, kept = RECORDERS[recorder]
    (language, text, name, hidden), close = CASES["path"]
    robot = load_robot(name)
    base = prepared(controller_named(language), robot)
    path = program_of(tmp_path, language, text)
    log = recorded(driven(path, robot, replace(base, **hidden)), joints, noise, step_s)  # type: ignore[arg-type]
    rows = kept(log.times)
    log = replace(log, times=log.times[rows], values=log.values[rows])
    found = fit_with_program(log, robot, base, chosen(base, tuple(hidden)), partial(driven, path, robot))
    for one in found.parameters:
        assert one.value == pytest.approx(hidden[one.name], rel=close[one.name]), one
        assert abs(one.value - hidden[one.name]) < 6.0 * one.deviation
    assert found.rms == pytest.approx(noise, rel=0.15)


def test_a_value_at_its_bound_is_said_to_be_there() -> None:
    assert Told("joint_smoothing_s", 0.0, 0.1, 1e-4).determined == "at its bound"
    assert Told("path_acceleration_mm_s2", 2e5, 5000.0, 10.0).determined == "at its bound"
    assert Told("joint_smoothing_s", 0.1, 0.1, 1e-4).determined == "well"


def write(path: Path, log: Log) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["time", *(f"j{number}" for number in range(1, log.values.shape[1] + 1))])
        writer.writerows([f"{t:.4f}", *row] for t, row in zip(log.times, log.values.tolist(), strict=True))


def test_the_command_writes_a_controller_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    language, text, name, hidden = CASES["ramps"][0]
    robot = load_robot(name)
    base = prepared(controller_named(language), robot)
    path = program_of(tmp_path, language, text)
    write(tmp_path / "log.csv", recorded(driven(path, robot, replace(base, **hidden)), True))  # type: ignore[arg-type]
    target = tmp_path / "mine.toml"
    arguments = ["fit", str(tmp_path / "log.csv"), str(path), "--robot", name, "-o", str(target)]
    assert rpl([*arguments, "--parameter", "joint_ramp_s", "--parameter", "path_ramp_s"]) == 0
    assert "joint_ramp_s" in capsys.readouterr().out
    made = parse_controller(target.read_text(encoding="utf-8"), "mine", str(target))
    assert made.joint_ramp_s == pytest.approx(0.24, rel=0.01)
    assert made.uncertainty["joint_ramp_s"] < 0.05
    assert rpl([*arguments, "--parameter", "joint_ramps"]) == 2
    assert "did you mean joint_ramp_s" in capsys.readouterr().err


HEAD = "time,j1,j2,j3,j4,j5,j6\n"
ROWS = "".join(f"{0.01 * k:.2f},{k},0,0,0,0,0\n" for k in range(30))
BAD = {
    "no time": ("stamp,j1\n1,2\n", r"log.csv:1: the header has no column 'time'"),
    "five joints": (HEAD.replace(",j6", "") + "0,1,2,3,4,5\n", r"log.csv:1: the robot has the joints j1.*, the log j1"),
    "half a place": ("time,x,y\n0,1,2\n", r"log.csv:1: .*missing z"),
    "time stands": (HEAD + ROWS + "0.29,0,0,0,0,0,0\n", r"log.csv:32: the time 0.29 does not rise"),
    "not a number": (HEAD + ROWS + "0.30,0,nan,0,0,0,0\n", r"log.csv:32: 'nan' in column 'j2' is not finite"),
    "text": (HEAD + ROWS + "0.30,0,0,0,x7,0,0\n", r"log.csv:32: 'x7' in column 'j4' is no number"),
    "short row": (HEAD + ROWS + "0.30,0,0\n", r"log.csv:32: there is no value in column 'j3'"),
    "empty": ("", r"log.csv:1: the log is empty"),
    "milliseconds": (
        HEAD + "".join(f"{10 * k},{k},0,0,0,0,0\n" for k in range(30)),
        r"log.csv:2: the moments are 10 s apart.* is the time in ms\?",
    ),
    "microseconds": (
        HEAD + "".join(f"{10000 * k},{k},0,0,0,0,0\n" for k in range(30)),
        r"log.csv:2: the moments are 10000 s apart.* microseconds\?",
    ),
    "few": (HEAD + "0,0,0,0,0,0,0\n", r"log.csv:2: 1 moments are too few"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_logs_are_refused_with_their_line(case: str, tmp_path: Path) -> None:
    text, message = BAD[case]
    path = tmp_path / "log.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(UsageError, match=message):
        read_log(str(path), 6)


def test_columns_are_found_by_name_and_semicolons_are_read(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("z;T;note;x;y\n" + "".join(f"{k};{0.1 * k};a;{2 * k};0\n" for k in range(25)), encoding="utf-8")
    log = read_log(str(path), 6)
    assert not log.joints
    assert log.values[3].tolist() == [6.0, 0.0, 3.0]


def test_decimal_commas_stand_between_semicolons(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text(
        "t;x;y;z\n" + "".join(f"{k / 10:.1f};{k},5;0;1.25\n".replace("0.", "0,") for k in range(25)), "utf-8"
    )
    log = read_log(str(path), 6)
    assert log.values[3].tolist() == [3.5, 0.0, 1.25]
    assert log.times[3] == pytest.approx(0.3)
