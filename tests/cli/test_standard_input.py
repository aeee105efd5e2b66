"""`-` is standard input, and what is wrong with a call is said before anything is read."""

import io
from pathlib import Path

import pytest

from rpl.cli.main import run

PROGRAM = "DEF demo()\n$OUT[1]=TRUE\nPTP {A1 10,A2 -80,A3 95,A4 0,A5 30,A6 0}\nEND\n"


class Unread:
    """Standard input that must not be read."""

    buffer = None

    def isatty(self) -> bool:
        return False


def given(monkeypatch: pytest.MonkeyPatch, text: str) -> None:
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(text.encode())))


@pytest.mark.parametrize(
    "arguments",
    [
        ["check", "-"],
        ["run", "-"],
        ["translate", "-", "--to", "rapid"],
        ["prove", "-", "{program}", "--robot", "kuka_kr6r900sixx"],
        ["prove", "{program}", "-", "--robot", "kuka_kr6r900sixx"],
    ],
)
def test_a_program_comes_from_standard_input(
    arguments: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    program = tmp_path / "demo.src"
    program.write_text(PROGRAM)
    given(monkeypatch, PROGRAM)
    assert run([word.replace("{program}", str(program)) for word in arguments]) == 0
    assert "Traceback" not in capsys.readouterr().err


def test_its_reports_have_their_places(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    given(monkeypatch, PROGRAM.replace("=TRUE", "==TRUE)("))
    assert run(["check", "-"]) == 1
    assert capsys.readouterr().err.startswith("stdin:2:8: error unreadable-statement")


def test_a_bare_list_of_words_is_no_program(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    given(monkeypatch, "buy milk\n")
    assert run(["translate", "-", "--to", "rapid"]) == 2
    err = capsys.readouterr().err
    assert "stdin:1:1: error not-a-program" in err and "no robot program was found" in err
    assert run(["check", "-", "-"]) == 2
    assert "once only" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "hint"),
    [
        (["run", "-", "--robot", "nobody"], "no robot named 'nobody'"),
        (["run", "-", "--robot", "ur5e", "--robot", "nobody"], "no robot named 'nobody'"),
        (["run", "-", "--cell", "no/such.toml"], "no/such.toml"),
        (["translate", "-", "--to", "rapid", "--robot", "nobody"], "no robot named 'nobody'"),
        (["translate", "-", "--to", "rapid", "--to-robot", "nobody"], "no robot named 'nobody'"),
        (["translate", "-", "--to", "rapid", "--cell", "no/such.toml"], "no/such.toml"),
        (["prove", "-", "b", "--robot", "nobody"], "no robot named 'nobody'"),
        (["prove", "-", "b", "--to-robot", "nobody"], "no robot named 'nobody'"),
        (["prove", "-", "b", "--cell", "no/such.toml"], "no/such.toml"),
    ],
)
def test_what_is_missing_is_said_before_reading(
    arguments: list[str], hint: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.stdin", Unread())
    assert run(arguments) == 2
    assert hint in capsys.readouterr().err


def test_a_missing_package_is_said_before_reading(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(__import__("sys").modules, "pinocchio", None)
    monkeypatch.setattr("sys.stdin", Unread())
    arm = tmp_path / "arm.urdf"
    arm.write_text(
        "<robot name='arm'><link name='a'/><link name='b'/><joint name='j' type='revolute'><parent link='a'/>"
        "<child link='b'/><axis xyz='0 0 1'/><limit lower='-1' upper='1' velocity='1' effort='1'/></joint></robot>"
    )
    for asked in (["--robot", str(arm)], ["--robot", "ur5e", "--dynamics"]):
        assert run(["run", "-", *asked]) == 2
        assert "pip install 'robot-rpl[kinematics]'" in capsys.readouterr().err


def test_reports_come_with_the_refusal(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    notes = tmp_path / "notes.txt"
    notes.write_text("buy milk\n")
    for arguments in (["run", str(notes)], ["translate", str(notes), "--to", "rapid", "--json"]):
        assert run(arguments) == 2
        assert "notes.txt:1:1: error not-a-program" in capsys.readouterr().err
