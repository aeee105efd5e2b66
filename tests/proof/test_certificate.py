"""Certificates of proofs: kept, done again, and what makes them fail."""

import json
import shutil
from pathlib import Path

import pytest

from rpl.cli.main import run

ROBOT = "kuka_kr6r900sixx"
A = "DEF part()\n$OUT[1]=TRUE\nPTP {A1 10,A2 -90,A3 90,A4 0,A5 45,A6 0}\nWAIT SEC 0.5\n$OUT[1]=FALSE\nEND\n"
B = A.replace("SEC 0.5", "SEC 0.25+0.25")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name, text in (("a", A), ("b", B)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "part.src").write_text(text)
    (tmp_path / "cell.toml").write_text('[[input]]\ntime = 1.0\nsignal = "$IN[1]"\nvalue = true\n')
    return tmp_path


def prove(folder: Path, *options: str) -> int:
    kept = str(folder / "proof.json")
    programs = [str(folder / "a"), str(folder / "b")]
    return run(
        ["prove", *programs, "--robot", ROBOT, "--cell", str(folder / "cell.toml"), "--certificate", kept, *options]
    )


def check(folder: Path, capsys: pytest.CaptureFixture[str]) -> tuple[int, str]:
    capsys.readouterr()
    status = run(["prove", "--check", str(folder / "proof.json")])
    return status, capsys.readouterr().out


def test_a_certificate_says_what_was_proved(folder: Path) -> None:
    assert prove(folder) == 0
    document = json.loads((folder / "proof.json").read_text("utf-8"))
    assert document["verdict"] == "equal"
    assert {"rpl", "python", "numpy"} <= set(document["versions"])
    assert [one["path"] for one in document["programs"]["b"]] == ["b/part.src"]
    assert set(document["files"]) == {"robot", "cell"}
    assert document["tolerance"]["path_mm"] == 0.01


def test_it_holds_as_long_as_nothing_changes_and_wherever_it_lies(
    folder: Path, tmp_path_factory: pytest.TempPathFactory, capsys: pytest.CaptureFixture[str]
) -> None:
    assert prove(folder) == 0
    status, out = check(folder, capsys)
    assert (status, out.partition(":")[0]) == (0, "the certificate holds")
    elsewhere = tmp_path_factory.mktemp("elsewhere") / "moved"
    shutil.move(folder, elsewhere)
    assert check(elsewhere, capsys)[0] == 0


@pytest.mark.parametrize(
    ("name", "old", "new", "words"),
    [
        (
            "b/part.src",
            "0.25+0.25",
            "0.25+0.26",
            ["B: b/part.src has changed", "the verdict was equal and is different"],
        ),
        ("a/part.src", "DEF part()", "DEF part() ; a remark", ["A: a/part.src has changed"]),
        ("cell.toml", "1.0", "2.0", ["the cell has changed"]),
        ("proof.json", '"path_mm": null', '"path_mm": 5.0', ["the tolerance is another one"]),
        ("proof.json", '"verdict": "equal"', '"verdict": "alike"', ["the verdict was alike and is equal"]),
    ],
)
def test_what_has_changed_is_told(
    folder: Path, name: str, old: str, new: str, words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert prove(folder) == 0
    path = folder / name
    text = path.read_text("utf-8")
    assert old in text
    path.write_text(text.replace(old, new), "utf-8")
    status, out = check(folder, capsys)
    assert status == 1
    for word in words:
        assert word in out


def test_deviations_and_what_is_accepted_stand_in_it(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "b" / "part.src").write_text(A.replace("SEC 0.5", "SEC 0.501"))
    assert prove(folder) == 3
    assert check(folder, capsys)[0] == 0
    assert prove(folder, "--accept", "wait", "--accept", "time") == 0
    document = json.loads((folder / "proof.json").read_text("utf-8"))
    assert document["result"]["deviations"] == [{"accepted": True, "count": 1, "kind": "wait", "worst": 0.001}]
    assert check(folder, capsys)[0] == 0


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("{", "this is no certificate"),
        ("{}", "this is no certificate"),
        ("[1]", "this is no certificate"),
        ('{"format": "rpl proof certificate 1", "question": {}}', "other keys"),
    ],
)
def test_what_is_no_certificate_is_refused(
    tmp_path: Path, text: str, words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "proof.json"
    path.write_text(text)
    assert run(["prove", "--check", str(path)]) == 2
    assert words in capsys.readouterr().err


def test_programs_or_a_certificate_are_needed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["prove"]) == 2
    assert "name two programs" in capsys.readouterr().err
    assert run(["prove", "x", "y", "--check", str(tmp_path / "proof.json")]) == 2
    assert "takes no programs" in capsys.readouterr().err
    assert run(["prove", "--check", str(tmp_path / "none.json")]) == 2
    assert "cannot read" in capsys.readouterr().err
