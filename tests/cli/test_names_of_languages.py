"""People ask for a language by its maker: aliases are data of each language's record, and capitals do not count."""

import json
from pathlib import Path

import pytest

import rpl
from rpl import registry
from rpl.cli.main import run

PROGRAM = "DEF demo()\n$OUT[1]=TRUE\nEND\n"


@pytest.fixture
def program(tmp_path: Path) -> Path:
    path = tmp_path / "demo.src"
    path.write_text(PROGRAM)
    return path


@pytest.mark.parametrize(
    ("word", "name"),
    [
        ("abb", "rapid"),
        ("ABB", "rapid"),
        ("Kuka", "krl"),
        ("KRL", "krl"),
        ("fanuc", "tp"),
        ("UR", "urscript"),
        ("Universal Robots", "urscript"),
        ("adept", "vplus"),
        ("V+", "vplus"),
        ("Yaskawa", "inform"),
        ("motoman", "inform"),
    ],
)
def test_makers_and_capitals(word: str, name: str) -> None:
    assert registry.dialect_called(word).name == registry.target_called(word).name == name


def test_no_two_languages_share_a_word() -> None:
    words = [word.lower() for name in registry.dialect_names() for word in {name, *registry.dialect(name).aliases}]
    assert len(words) == len(set(words))


def test_the_command_line_and_the_api_take_them(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["translate", str(program), "--from", "KUKA", "--to", "UR"]) == 0
    by_alias = capsys.readouterr().out
    assert run(["translate", str(program), "--from", "krl", "--to", "urscript"]) == 0
    assert by_alias == capsys.readouterr().out
    read = rpl.read(program, "kuka")
    assert read.dialects == ("krl",)
    assert rpl.translate(read, "ABB").files == rpl.translate(read, "rapid").files
    assert run(["run", str(program), "--controller", "KUKA"]) == 0


@pytest.mark.parametrize("wrong", ["rapit", "RAPIT", "abbb"])
def test_an_unknown_word_is_answered_with_the_nearest(
    wrong: str, program: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["translate", str(program), "--to", wrong]) == 2
    assert "did you mean rapid" in capsys.readouterr().err


def test_the_list_shows_them(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["dialects", "--json"]) == 0
    aliases = {row["name"]: row["aliases"] for row in json.loads(capsys.readouterr().out)}
    assert "abb" in aliases["rapid"] and "kuka" in aliases["krl"]
