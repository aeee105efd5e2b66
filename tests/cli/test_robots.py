"""`rpl robots FILTER`: which arm is it, how far does it reach, what does it carry."""

import json
import re
from pathlib import Path

import pytest

from rpl.cli.main import run
from rpl.emulator.robotfile import robot_names

ROOT = Path(__file__).parents[2]


def listed(capsys: pytest.CaptureFixture[str], *words: str) -> dict[str, dict[str, object]]:
    assert run(["robots", *words, "--json"]) == 0
    return {row["name"]: row for row in json.loads(capsys.readouterr().out)}


@pytest.mark.parametrize("words", [("kuka", "R900"), ("KR6R900",), ("kr 6 r900",), ("KUKA", "kr-6", "r900 sixx")])
def test_words_in_any_spelling(words: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> None:
    found = listed(capsys, *words)
    assert "kuka_kr6r900sixx" in found and all(name.startswith("kuka_") for name in found)


# Reach as the makers' data sheets and model names say (mm): KR 6 R900, IRB 120-3/0.58, IRB 1200-5/0.9, M-10iA,
# GP7 (927), Cobra s600; they round, and names have two digits.
@pytest.mark.parametrize(
    ("name", "reach", "payload"),
    [
        ("kuka_kr6r900sixx", 901, 6),
        ("abb_irb120_3_58", 580, 3),
        ("abb_irb1200_5_90", 900, 5),
        ("fanuc_m10ia", 1420, 10),
        ("motoman_gp7", 927, 7),
        ("adept_cobra_s600", 600, None),
    ],
)
def test_reach_and_payload(name: str, reach: float, payload: float | None, capsys: pytest.CaptureFixture[str]) -> None:
    row = listed(capsys, name)[name]
    assert row["reach_mm"] == pytest.approx(reach, abs=5)
    assert row["payload_kg"] == payload
    limits = row["limits"]
    assert isinstance(limits, list) and len(limits) == row["axes"]


def test_people_get_limits_when_they_ask_for_an_arm(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["robots", "ur5e"]) == 0
    first, second = capsys.readouterr().out.splitlines()
    assert first.split() == ["ur5e", "Universal", "Robots", "UR5e", "6", "axes", "828", "mm", "5", "kg"]
    assert second.split() == ["-360..360"] * 6
    assert run(["robots"]) == 0
    assert len(capsys.readouterr().out.splitlines()) == len(robot_names())


def test_no_such_arm_is_answered_with_the_nearest(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["robots", "kuka_kr6r901"]) == 1
    assert "kuka_kr6r900" in capsys.readouterr().err
    assert run(["robots", "nobody", "--json"]) == 1
    assert capsys.readouterr().out == "[]\n"


def test_numbers_of_robots_in_the_texts_are_true() -> None:
    """A number in front of `arms` or `robot models` in the texts for newcomers is the number there is."""
    for name in ("README.md", "CHANGELOG.md", "docs/command-line.md"):
        text = (ROOT / name).read_text("utf-8")
        for number in re.findall(r"(\d+) (?:robot models|robots|arms;)", text):
            assert int(number) == len(robot_names()), name
    table = re.findall(
        r"^\| `(\w+)` \|", (ROOT / "docs/robots.md").read_text("utf-8").partition("## The arms")[2], re.M
    )
    assert sorted(table) == robot_names()
