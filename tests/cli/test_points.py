"""Files of points: between any two notations, with bad rows named by their line and the rest converted."""

from __future__ import annotations

import csv
import io
import itertools
import json
from pathlib import Path

import numpy as np
import pytest

from rpl import registry
from rpl.cli.main import run
from rpl.emulator.configuration import BatchNotation
from rpl.emulator.model import RobotModel, load_robot

NOTATIONS = [name for name in registry.dialect_names() if registry.dialect(name).notation is not None]
ROBOT = "kuka_kr6r900sixx"


def answer(capsys: pytest.CaptureFixture[str]) -> tuple[list[dict[str, str]], list[str]]:
    out, err = capsys.readouterr()
    return list(csv.DictReader(io.StringIO(out))), err.splitlines()


def drawn(model: RobotModel, count: int, seed: int = 3) -> np.ndarray:
    """Joints inside the limits, none where flags are not looked at or printed digits decide."""
    low, high = model.limits[:, 0], model.limits[:, 1]
    joints = np.random.default_rng(seed).uniform(low, high, (20 * count, model.axes)).round(2)
    clear = (np.abs(joints % 90.0) > 2.5).all(axis=1)
    return joints[clear][:count]


def joint_file(path: Path, joints: np.ndarray) -> Path:
    header = ",".join(f"J{axis}" for axis in range(1, joints.shape[1] + 1))
    lines = [f"p{i}," + ",".join(f"{value:.2f}" for value in row) for i, row in enumerate(joints)]
    path.write_text(f"name,{header}\n" + "\n".join(lines) + "\n", encoding="utf-8")
    return path


@pytest.mark.parametrize(("source", "target"), list(itertools.permutations(NOTATIONS, 2)))
def test_between_any_two_notations(
    source: str, target: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = load_robot(ROBOT)
    joints = drawn(model, 6)
    assert (
        run(["fk", "--robot", ROBOT, "--points", str(joint_file(tmp_path / "j.csv", joints)), "--dialect", source]) == 0
    )
    (tmp_path / "one.csv").write_text(capsys.readouterr().out, encoding="utf-8")
    near = ["--near", "previous"] if source == "urscript" else []
    call = ["ik", "--robot", ROBOT, "--points", str(tmp_path / "one.csv"), "--dialect", source, "--to-dialect", target]
    assert run([*call, *near]) == 0
    rows, errors = answer(capsys)
    assert not errors
    assert [row["name"] for row in rows] == [f"p{i}" for i in range(len(joints))]
    make = registry.dialect(target).notation
    assert make is not None
    for row, wanted in zip(rows, joints, strict=True):
        found = np.array([float(row[f"j{axis}"]) for axis in range(1, 7)])
        matrix, flags = make().parse_pose(row["target"])
        assert matrix == pytest.approx(model.forward(found), abs=1e-5)
        assert flags == make().encode(model, found)
        assert matrix == pytest.approx(model.forward(wanted), abs=1e-4)
        if source in ("krl", "rapid", "tp", "rpl", "inform"):  # the others leave the turns to the arm's own place
            assert found == pytest.approx(wanted, abs=1e-4)


@pytest.mark.parametrize("dialect", NOTATIONS)
@pytest.mark.parametrize("robot", ["abb_irb120_3_58", "fanuc_m20id25", "ur5e", "adept_cobra_s600", "motoman_gp7"])
def test_many_at_once_choose_as_one_by_one(robot: str, dialect: str) -> None:
    model = load_robot(robot)
    make = registry.dialect(dialect).notation
    assert make is not None
    notation = make()
    assert isinstance(notation, BatchNotation)
    joints = drawn(model, 40)
    flanges = model.forward(joints)
    flags = notation.encode_all(model, joints)
    assert [notation.encode(model, one) for one in joints] == [
        dict(zip(notation.fields, map(int, row), strict=True)) for row in flags
    ]
    together = notation.select_all(model, flanges, flags.astype(float), model.home)
    for flange, row, found in zip(flanges, flags, together.joints, strict=True):
        single = notation.select(model, flange, dict(zip(notation.fields, map(int, row), strict=True)), model.home)
        assert single.joints is not None
        assert found == pytest.approx(single.joints, abs=1e-9)
    assert notation.poses_of(notation.values_of(flanges)) == pytest.approx(flanges, abs=1e-9)


def test_bad_rows_are_named_and_the_rest_converted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "points.csv"
    path.write_text(
        "name,X,Y,Z,A,B,C,S,T\n"
        "good,525,0,890,0,90,0,2,2\n"
        "# a remark\n"
        "word,525,zero,890,0,90,0,2,2\n"
        "far,9999,0,890,0,90,0,2,2\n"
        "flags,445,0,810,180,0,180,1,0\n"
        "untaught,666666.688,0,0,0,0,0,0,0\n"
        "open,445,0,810,180,0,180,,\n"
        "last,445,0,810,180,0,180,2,2\n",
        encoding="utf-8",
    )
    assert run(["ik", "--robot", ROBOT, "--points", str(path), "--dialect", "krl", "--to-dialect", "tp"]) == 1
    rows, errors = answer(capsys)
    assert [(row["line"], row["name"]) for row in rows] == [("2", "good"), ("9", "last")]
    assert [float(rows[1][f"j{axis}"]) for axis in range(1, 7)] == pytest.approx([0, -90, 90, 0, 90, 0], abs=1e-6)
    assert rows[0]["target"].startswith("CONFIG : 'N U T, 0, 0, 0'")
    places = [error.split(": ", 1) for error in errors]
    assert [place for place, _ in places] == [f"{path}:{line}:1" for line in (4, 5, 6, 7, 8)]
    words = [text for _, text in places]
    assert words[0] == "error bad-point y is 'zero', a number is needed"
    assert words[1] == "error unreachable-point the pose is out of reach"
    assert words[2].startswith("error unreachable-point S 1, T 0 cannot be reached: the arm reaches this pose with")
    assert words[3] == "error unreachable-point the point is not taught"
    assert words[4] == "error unreachable-point the first motion needs both S and T"


def test_a_file_of_texts_from_standard_input(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    lines = "{X 525,Y 0,Z 890,A 0,B 90,C 0,S 2,T 2}\nDECL E6POS XP1={X 445,Y 0,Z 810,A 180,B 0,C 180,S 2,T 2,E1 0}\n"
    monkeypatch.setattr("sys.stdin", io.StringIO(lines + "{X 1}\n"))
    call = ["ik", "--robot", ROBOT, "--points", "-", "--dialect", "krl", "--to-dialect", "rapid", "--json"]
    assert run(call) == 1
    document = json.loads(capsys.readouterr().out)
    assert {key: document[key] for key in ("robot", "dialect", "to_dialect")} == {
        "robot": ROBOT, "dialect": "krl", "to_dialect": "rapid",
    }  # fmt: skip
    assert [point["line"] for point in document["points"]] == [1, 2]
    assert [document["points"][1][name] for name in ("cf1", "cf4", "cf6", "cfx")] == [0, 0, 0, 0]
    assert document["errors"][0]["line"] == 3
    assert document["errors"][0]["code"] == "bad-point"


@pytest.mark.parametrize(
    ("dialect", "text", "joints"),
    [
        ("tp", "x,y,z,w,p,r,config\n965,0,965,-180,0,0,'N U T, 0, 0, 0'\n", (0, 0, 0, 0, -90, 0)),
        ("tp", "X;Y;Z;W;P;R;CONFIG\n965;0;965;180;0;-170;N U T, 0, 0, 1\n", (0, 0, 0, 0, -90, 190)),
        ("tp", "965,0,965,-180,0,0,0,0,0,0,0,0\n", (0, 0, 0, 0, -90, 0)),
        ("tp", "x_mm;y [mm];z (mm);w_deg;p;r\n965,0;0;965,000;-180;0;0\n", (0, 0, 0, 0, -90, 0)),
        ("rapid", "x,y,z,q1,q2,q3,q4\n1,2,3,1,1,0,0\n", None),
        ("tp", "x,y,z,w,p,r\n965,0,0,0,965,0,-180,0,0,0\n", None),
        ("tp", "x,y,z,w,p,r,flip\n965,0,965,-180,0,0,0.5\n", None),
    ],
)
def test_columns(
    dialect: str, text: str, joints: tuple[float, ...] | None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "points.csv"
    text = text.replace("'N U T, 0, 0, 0'", '"N U T, 0, 0, 0"')
    path.write_text(text, encoding="utf-8")
    status = run(["ik", "--robot", "fanuc_m20id25", "--points", str(path), "--dialect", dialect])
    rows, errors = answer(capsys)
    if joints is None:
        assert (status, rows, len(errors)) == (1, [], 1)
        return
    assert (status, errors) == (0, [])
    assert [float(rows[0][f"j{axis}"]) for axis in range(1, 7)] == pytest.approx(joints, abs=1e-3)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["fk"], "either --joints or --points"),
        (["ik"], "either --pose or --points"),
        (["fk", "--points", "POINTS"], "has no column j1, j2, j3, j4, j5, j6, it has one, two"),
        (["ik", "--points", "POINTS", "--dialect", "krl"], "needs the columns x, y, z, a, b, c"),
        (["ik", "--points", "TWICE", "--dialect", "krl"], "has the column x twice"),
        (["ik", "--points", "BYTES"], "is no text in UTF-8"),
        (["ik", "--points", "EMPTY"], "has no points"),
        (["ik", "--points", "nowhere.csv"], "cannot be read"),
        (["ik", "--pose", "1,2,3", "--to-dialect", "cobol"], "no language is called"),
    ],
)
def test_wrong_calls(arguments: list[str], words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "points.csv").write_text("one,two\n1,2\n", encoding="utf-8")
    (tmp_path / "empty.csv").write_text("\n", encoding="utf-8")
    (tmp_path / "twice.csv").write_text("x,y,x_mm\n1,2,3\n", encoding="utf-8")
    (tmp_path / "bytes.csv").write_bytes(b"\xff\xfe\x00")
    names = {name.upper(): str(tmp_path / f"{name}.csv") for name in ("points", "empty", "twice", "bytes")}
    assert run([names.get(one, one) for one in arguments] + ["--robot", ROBOT]) == 2
    assert words in capsys.readouterr().err


def test_one_target_in_another_notation(capsys: pytest.CaptureFixture[str]) -> None:
    call = ["ik", "--robot", ROBOT, "--pose", "{X 525,Y 0,Z 890,A 0,B 90,C 0,S 2,T 2}", "--dialect", "krl"]
    assert run([*call, "--to-dialect", "rapid"]) == 0
    assert capsys.readouterr().out.startswith("[[525,0,890],[0.707106781,0,0.707106781,0],[0,0,0,0],")
    assert run([*call, "--to-dialect", "tp", "--json"]) == 0
    converted = json.loads(capsys.readouterr().out)["converted"]
    assert (converted["dialect"], converted["configuration"]["down"]) == ("tp", 0)
    wrong = [part.replace("S 2", "S 1") for part in call]
    assert run([*wrong, "--to-dialect", "rapid"]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert "S 1, T 2 cannot be reached" in err


def test_another_arm_comes_there_in_the_same_posture(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """(j1, j2, -(j2+j3), -j4, -j5, 180-j6): axis 6 at 0 is half a turn, turn 1, where the flange is turned."""
    path = tmp_path / "points.csv"
    down, unused = "[0,0,1,0],[0,0,0,0]", "[9E9,9E9,9E9,9E9,9E9,9E9]"
    path.write_text(f"[[1300,0,900],{down},{unused}]\n[[2500,0,900],{down},{unused}]\n", encoding="utf-8")
    call = ["ik", "--robot", "abb_irb6700_140_285", "--dialect", "rapid", "--to-robot", "fanuc_r2000ic190s"]
    assert run([*call, "--points", str(path)]) == 1
    rows, errors = answer(capsys)
    assert [row["line"] for row in rows] == ["1"]
    assert rows[0]["target"].startswith("CONFIG : 'N U T, 0, 0, 1', X = 1300 mm")
    assert float(rows[0]["j6"]) == pytest.approx(180.0)
    assert errors == [f"{path}:2:1: error unreachable-point fanuc_r2000ic190s does not reach this in the same posture"]
    assert run([*call, "--pose", f"[[1300,0,900],{down},{unused}]", "--json"]) == 0
    converted = json.loads(capsys.readouterr().out)["converted"]
    assert (converted["robot"], converted["dialect"]) == ("fanuc_r2000ic190s", "tp")
    assert converted["joints_deg"][5] == pytest.approx(180.0)
    assert run([*call, "--pose", f"[[2500,0,900],{down},{unused}]"]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert "same posture" in err


def test_joints_beyond_their_limits_are_marked(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "joints.csv"
    path.write_text("0,-90,90,0,0,0\n200,-90,90,0,130,0\n", encoding="utf-8")
    assert run(["fk", "--robot", ROBOT, "--points", str(path)]) == 0
    rows, _ = answer(capsys)
    assert [row["outside_limits"] for row in rows] == ["", "1 5"]


@pytest.mark.parametrize(
    ("robot", "pose", "named"),
    [
        (ROBOT, "{X 525,Y 0,Z 890,A 0,B 90,C 0,S 2,T 2,E1 120.5,E2 0.0}", "E1"),
        (ROBOT, "{X 525,Y 0,Z 890,A 0,B 90,C 0,S 2,T 2,E1 0.0}", ""),
        ("abb_irb120_3_58", "[[374,0,630],[0.707107,0,0.707107,0],[0,0,0,0],[0,9E9,9E+09,9E9,9E9,9E9]]", "eax_a"),
        ("abb_irb120_3_58", "[[374,0,630],[0.707107,0,0.707107,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]", ""),
        (
            "fanuc_m20id25",
            "CONFIG : 'N U T, 0, 0, 0', X = 965 mm, Y = 0 mm, Z = 965 mm, W = 180 deg, P = 0 deg, R = 0 deg, E1= 55 mm",
            "E1",
        ),
    ],
)
def test_external_axes_are_not_left_out_in_silence(
    robot: str, pose: str, named: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["ik", "--robot", robot, "--pose", pose]) == 0
    assert capsys.readouterr().err == (f"rpl: the external axes {named} are left out\n" if named else "")
    path = tmp_path / "points.txt"
    path.write_text(f"{pose}\n", encoding="utf-8")
    assert run(["ik", "--robot", robot, "--points", str(path)]) == 0
    assert ("external axes are left out" in capsys.readouterr().err) is bool(named)


SEVEN = "".join(
    [
        '<robot name="seven"><link name="l0"/>',
        *(
            f'<link name="l{number}"/><joint name="j{number}" type="revolute"><parent link="l{number - 1}"/>'
            f'<child link="l{number}"/><origin xyz="0 0 0.2"/><axis xyz="{axis}"/>'
            '<limit lower="-2.9" upper="2.9" velocity="1" effort="1"/></joint>'
            for number, axis in enumerate(["0 0 1", "0 1 0"] * 3 + ["0 0 1"], start=1)
        ),
        "</robot>",
    ]
)


def test_flags_of_an_arm_of_another_build_are_refused_by_name(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """An arm of seven axes has an arm angle in its target, a cobot's wrist has other rules: nothing is made up."""
    pytest.importorskip("pinocchio")
    path = tmp_path / "seven.urdf"
    path.write_text(SEVEN, encoding="utf-8")
    words = "what configuration flags mean on an arm of this build is not known"
    call = ["--robot", str(path), "--dialect", "rapid"]
    assert run(["fk", *call, "--joints", "10,20,30,40,50,60,70"]) == 0
    assert words in capsys.readouterr().err
    pose = "[[300,100,900],[1,0,0,0],[0,0,0,3]]"
    run(["ik", *call, "--pose", pose])
    assert words in capsys.readouterr().err
    assert run(["ik", *call, "--pose", pose, "--to-dialect", "rapid"]) == 2
    assert words in capsys.readouterr().err


def test_a_tilted_pose_of_an_arm_that_cannot_tilt(capsys: pytest.CaptureFixture[str]) -> None:
    call = ["ik", "--robot", "adept_cobra_s600", "--dialect", "vplus"]
    assert run([*call, "--pose", "TRANS(400, 100, 300, 0, 170, 0)"]) == 1
    assert "tool axis is always vertical, the pose tilts it by 10 degrees" in capsys.readouterr().err
