"""`rpl stable`: its JSON, its table, and what it refuses."""

import json
import sys
from pathlib import Path

import pytest

from rpl.cli.main import run

TRIANGLES = "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"


def test_json_has_states_and_nothing_else(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["stable", "--box", "10,20,30", "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert list(document) == ["states"]
    assert all(list(state) == ["normal", "rotation", "probability", "height_mm"] for state in document["states"])
    assert sum(state["probability"] for state in document["states"]) == pytest.approx(1.0)
    assert document["states"][0]["height_mm"] == 5.0


def test_a_file_gives_a_table(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "corner.obj"
    path.write_text(TRIANGLES)
    assert run(["stable", str(path)]) == 0
    out = capsys.readouterr().out.splitlines()
    assert out[0].startswith("probability ")
    assert out[0].endswith(" rotation w, x, y, z")
    assert len(out) == 5


def test_drops_are_counted_with_an_interval(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["stable", "--cylinder", "20,10", "--method", "dynamic", "--drops", "10", "--seed", "4"]) == 0
    assert " to " in capsys.readouterr().out
    assert run(["stable", "--sphere", "20", "--method", "dynamic", "--drops", "2", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["states"][0]["probability"] == 1.0


def test_a_part_that_does_not_fall_stays_as_it_is_held(capsys: pytest.CaptureFixture[str]) -> None:
    held = ["--drop-height", "0", "--down", "0,-1,0", "--json"]
    assert run(["stable", "--box", "10,20,30", *held]) == 0
    first = json.loads(capsys.readouterr().out)["states"][0]
    assert (first["normal"], first["probability"]) == ([0.0, -1.0, 0.0], 1.0)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([], "one part is needed"),
        (["--box", "1,2,3", "--sphere", "4"], "one part is needed"),
        (["--box", "1,2"], "3 numbers are needed"),
        (["--box", "1,2,0"], "a side is not above 0"),
        (["--box", "1,2,3", "--scale", "2"], "for a FILE"),
        (["--box", "1,2,3", "--method", "guess"], "fast and dynamic"),
        (["--box", "1,2,3", "--drops", "5"], "for --method dynamic"),
        (["--box", "1,2,3", "--down", "0,0,1"], "needs --drop-height"),
        (["--box", "1,2,3", "--com", "0,0,9"], "outside the convex hull"),
        (["--box", "1,2,3", "--com", "0,0"], "3 numbers are needed"),
        (["none.stl"], "there is no such file"),
    ],
)
def test_what_cannot_be_answered(words: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["stable", *words]) == 2
    assert said in capsys.readouterr().err


@pytest.mark.parametrize(("package", "more"), [("scipy.spatial", []), ("mujoco", ["--method", "dynamic"])])
def test_a_missing_package_is_named(
    package: str, more: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    assert run(["stable", "--box", "1,2,3", *more]) == 2
    assert "pip install 'robot-rpl[cell]'" in capsys.readouterr().err
