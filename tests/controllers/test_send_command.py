"""`rpl send`: nothing is sent that was not proved, when a proof is asked for."""

from __future__ import annotations

from pathlib import Path

import pytest

from rpl.cli.main import run

PROGRAM = "DEF a( )\nPTP {{A1 0,A2 -90,A3 90,A4 0,A5 {angle},A6 0}}\n$OUT[{output}]=TRUE\nEND\n"


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for name, output in (("origin", 1), ("same", 1), ("other", 2)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "a.src").write_text(PROGRAM.format(angle=30, output=output), "utf-8")
    (tmp_path / "there").mkdir()
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize(("folder", "status", "sent"), [("same", 0, ["a.src"]), ("other", 1, [])])
def test_only_what_is_proved_equal_is_sent(
    place: Path, capsys: pytest.CaptureFixture[str], folder: str, status: int, sent: list[str]
) -> None:
    words = ["send", folder, f"folder://{place}/there", "--write", "--at-rest", "--prove", "origin"]
    assert run([*words, "--robot", "kuka_kr6r900sixx"]) == status
    assert [path.name for path in (place / "there").iterdir()] == sent
    said = capsys.readouterr().err
    assert "equal" in said if sent else "nothing is sent" in said and "different" in said


def test_a_dry_run_writes_nothing(place: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["send", "same", f"folder://{place}/there", "--at-rest"]) == 0
    assert "this is what --write would do" in capsys.readouterr().out
    assert not list((place / "there").iterdir())
    assert not (place / ".rpl").exists()
