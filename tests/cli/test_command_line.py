"""The command line as people and scripts meet it: shapes, exit statuses, and one-line messages for every mistake."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from rpl.cli.main import COMMANDS, run

KRL = "DEF demo()\n$OUT[1]=TRUE\nEND\n"
BROKEN = "DEF demo()\n$OUT[1]==TRUE)(\n$OUT[2]=TRUE\nEND\n"


@pytest.fixture
def program(tmp_path: Path) -> Path:
    path = tmp_path / "demo.src"
    path.write_text(KRL)
    return path


def words(capsys: pytest.CaptureFixture[str]) -> tuple[str, str]:
    captured = capsys.readouterr()
    return captured.out, captured.err


def test_help_lists_every_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["--help"]) == 0
    out, _ = words(capsys)
    assert all(name in out for name in COMMANDS)


@pytest.mark.parametrize("name", list(COMMANDS))
def test_every_command_has_help(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run([name, "--help"]) == 0
    assert "Usage: rpl " + name in words(capsys)[0]


def test_dialects_and_robots_have_their_shapes(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["dialects", "--json"]) == 0
    dialects = json.loads(words(capsys)[0])
    assert {"name", "title", "reads", "writes", "extensions", "aliases"} == set(dialects[0])
    assert run(["robots", "--json"]) == 0
    robots = json.loads(words(capsys)[0])
    assert {"name", "maker", "model", "axes"} <= set(robots[0])
    assert len(robots) >= 50
    assert run(["dialects"]) == run(["robots"]) == 0


def test_check_gives_one_json_line_per_file(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["check", str(program), "--json"]) == 0
    lines = words(capsys)[0].splitlines()
    assert [json.loads(line) for line in lines] == [
        {"file": str(program), "dialect": "krl", "statements": 3, "opaque": 0, "diagnostics": []}
    ]


def test_check_reports_a_damaged_statement_with_its_place(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program.write_text(BROKEN)
    assert run(["check", str(program), "--json"]) == 1
    out, err = words(capsys)
    report = json.loads(out)
    assert report["opaque"] == 1
    (found,) = report["diagnostics"]
    assert {"code", "severity", "line", "column", "message"} == set(found)
    assert (found["code"], found["severity"], found["line"]) == ("unreadable-statement", "error", 2)
    assert err.startswith(f"{program}:2:")
    assert " error unreadable-statement " in err


def test_check_writes_sarif(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program.write_text(BROKEN)
    assert run(["check", str(program), "--sarif"]) == 1
    log = json.loads(words(capsys)[0])
    assert log["version"] == "2.1.0"
    assert log["runs"][0]["results"][0]["ruleId"] == "unreadable-statement"


def test_a_folder_skips_what_is_no_program(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (program.parent / "photo.src").write_bytes(b"\x00\x01\x02" * 100)
    (program.parent / "notes.txt").write_text("buy milk\n")
    assert run(["check", str(program.parent)]) == 0
    out, err = words(capsys)
    assert "1 files, 0 errors" in out
    assert "skipped" in err


JOINTS = "0,-90,90,0,0,0"
ROBOT = "kuka_kr6r900sixx"


def test_fk_and_ik_agree(capsys: pytest.CaptureFixture[str]) -> None:
    joints = [10.0, -80.0, 95.0, 20.0, 30.0, -200.0]
    assert run(["fk", "--robot", ROBOT, "--joints", ",".join(map(str, joints)), "--dialect", "krl", "--json"]) == 0
    forward = json.loads(words(capsys)[0])
    assert [len(row) for row in forward["matrix"]] == [4, 4, 4, 4]
    assert "S " in forward["pose"] and "T " in forward["pose"]
    assert run(["ik", "--robot", ROBOT, "--dialect", "krl", "--pose", forward["pose"], "--json"]) == 0
    inverse = json.loads(words(capsys)[0])
    assert len(inverse["solutions"]) >= 2
    (selected,) = [entry for entry in inverse["solutions"] if entry["selected"]]
    assert selected["joints_deg"] == pytest.approx(joints, abs=1e-3)
    assert selected["configuration"] == forward["configuration"]


def test_fk_converts_between_notations_and_takes_a_tool(capsys: pytest.CaptureFixture[str]) -> None:
    common = ["fk", "--robot", ROBOT, "--joints", JOINTS, "--json"]
    assert run([*common, "--tool", "0,0,100"]) == 0
    document = json.loads(words(capsys)[0])
    assert {"krl", "rapid"} <= set(document["poses"])
    flange, tool = document["matrix"], document["tool_matrix"]
    assert tool[0][3] == pytest.approx(flange[0][3] + 100 * flange[0][2])
    assert tool[2][3] == pytest.approx(flange[2][3] + 100 * flange[2][2])
    assert run([*common, "--dialect", "rapid"]) == 0
    rapid = json.loads(words(capsys)[0])
    assert rapid["pose"].startswith("[[")
    assert run(["ik", "--robot", ROBOT, "--dialect", "rapid", "--pose", rapid["pose"], "--json"]) == 0


def test_a_pose_out_of_reach_is_answered_with_no(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["ik", "--robot", ROBOT, "--pose", "9000,0,0,0,90,0", "--json"]) == 1
    document = json.loads(words(capsys)[0])
    assert document["solutions"] == []
    assert "reach" in document["reason"]


@pytest.mark.parametrize(
    ("arguments", "hint"),
    [
        (["chek"], "did you mean check"),
        (["check"], "PATH"),
        (["check", "no/such/file.src"], "no such file"),
        (["check", "{program}", "--from", "krll"], "did you mean krl"),
        (["check", "{binary}"], "no robot program"),
        (["fk", "--joints", JOINTS], "--robot"),
        (["fk", "--robot", "kuka_kr6", "--joints", JOINTS], "did you mean"),
        (["fk", "--robot", ROBOT, "--joints", "1,2,3"], "6 numbers"),
        (["fk", "--robot", ROBOT, "--joints", "1,2,3,4,5,six"], "'six' is not a number"),
        (["fk", "--robot", ROBOT, "--joints", "1,2,3,4,5,nan"], "finite"),
        (["fk", "--robot", ROBOT, "--joints", JOINTS, "--dialect", "basic"], "basic"),
        (["fk", "--robot", ROBOT, "--joints", JOINTS, "--tool", "1,2"], "--tool"),
        (["ik", "--robot", ROBOT, "--pose", "{X 1"], "--pose"),
        (["ik", "--robot", ROBOT, "--pose", "here"], "--pose"),
        (["translate", "{program}"], "--to"),
        (["translate", "{program}", "--to", "esperanto"], "esperanto"),
        (["run", "no/such/file.src"], "no such file"),
        (["run", "{program}", "--max-time", "soon"], "max-time"),
        (["run", "{program}", "--robot", "nobody"], "nobody"),
        (["prove", "{program}"], "B"),
        (["prove", "{program}", "no/such"], "no such file"),
        (["robots", "--jsn"], "jsn"),
    ],
)
def test_mistakes_are_one_line_and_status_2(
    arguments: list[str], hint: str, program: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    binary = program.parent / "image.src"
    binary.write_bytes(bytes(range(256)) * 4)
    filled = [word.replace("{program}", str(program)).replace("{binary}", str(binary)) for word in arguments]
    assert run(filled) == 2
    err = words(capsys)[1]
    assert hint in err
    assert "Traceback" not in err
    assert len(err.splitlines()) <= 2


def test_without_a_command_the_help_is_shown(capsys: pytest.CaptureFixture[str]) -> None:
    assert run([]) == 2
    assert "Commands:" in words(capsys)[1]


def python(*code: str, **options: object) -> "subprocess.CompletedProcess[str]":
    return subprocess.run([sys.executable, *code], capture_output=True, text=True, timeout=600, **options)  # type: ignore


def test_check_starts_light(program: Path) -> None:
    code = f"""
import sys
from rpl.cli.main import run
assert run(["check", {str(program)!r}]) == 0
heavy = [name for name in ("numpy", "pinocchio", "coal", "jinja2", "rich", "scipy") if name in sys.modules]
print(",".join(heavy), end="")
"""
    done = python("-c", code)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1].endswith("warnings"), f"loaded: {done.stdout}"


def test_a_closed_pipe_is_no_traceback() -> None:
    command = f"{sys.executable} -m rpl.cli.main robots | head -n 1"
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, timeout=600)
    assert done.stderr == ""
    assert len(done.stdout.splitlines()) == 1


def test_the_module_runs_as_the_command_does() -> None:
    done = python("-m", "rpl.cli.main", "--version")
    assert (done.returncode, done.stdout.split()[0]) == (0, "rpl")


def test_a_cell_file_that_names_an_unknown_signal(
    program: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    program.write_text("DEF demo()\nSIGNAL grip_closed $IN[7]\nWAIT FOR grip_closed\n$OUT[1]=TRUE\nEND\n")
    rows = ["grip_closed", "$IN[9]", "DI[2]", "grip_close"]
    text = "".join(f'[[input]]\ntime = 1.0\nsignal = "{name}"\nvalue = true\n' for name in rows)
    cell = tmp_path / "cell.toml"
    cell.write_text(text)
    assert run(["run", str(program), "--cell", str(cell)]) == 0
    warnings = [line for line in words(capsys)[1].splitlines() if "cell-unknown-signal" in line]
    assert len(warnings) == 1
    assert "cell.toml:15:10: warning" in warnings[0] and "the nearest are grip_closed" in warnings[0]


def test_a_cell_file_that_gives_a_value_to_no_variable(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, cell = tmp_path / "a.src", tmp_path / "c.toml"
    path.write_text("DEF a()\nDECL INT i\ni=parts\nEND\n")
    path.with_suffix(".dat").write_text("DEFDAT a\nDECL INT parts=1\nENDDAT\n")
    cell.write_text('seed = 1\n[variables]\nparts = 2\n"part" = 3\n')
    for command in (["run", str(path)], ["prove", str(path), str(path)], ["translate", str(path), "--to", "krl"]):
        run([*command, "--cell", str(cell)])
        warned = [line for line in words(capsys)[1].splitlines() if "cell-unknown-variable" in line]
        assert len(warned) == 1
        assert "c.toml:4:1: warning" in warned[0] and "gives a value to part," in warned[0] and "parts" in warned[0]
