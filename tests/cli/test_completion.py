"""The shell completes robots, languages, controllers and files wherever they are asked for."""

import os
import re
import subprocess
import sys
from pathlib import Path

import click
import pytest
from click.shell_completion import BashComplete

from rpl.cli.main import COMMANDS, rpl
from rpl.emulator.robotfile import robot_names

ROOT = Path(__file__).parents[2]


def offered(*words: str) -> list[tuple[str, str]]:
    """Kind and text of what is offered for the last word."""
    items = BashComplete(rpl, {}, "rpl", "_RPL_COMPLETE").get_completions(list(words[:-1]), words[-1])
    return [(item.type, item.value) for item in items]


def test_commands_and_options() -> None:
    assert offered("tr") == [("plain", "translate")]
    assert ("plain", "--to-robot") in offered("translate", "--to")


@pytest.mark.parametrize(
    "words",
    [
        ("run", "a.src", "--robot"),
        ("translate", "a.src", "--to-robot"),
        ("prove", "a", "b", "--to-robot"),
        ("fk", "--robot"),
        ("ik", "--to-robot"),
        ("repl", "--robot"),
        ("fit", "--robot"),
        ("robots",),
    ],
)
def test_robots(words: tuple[str, ...]) -> None:
    assert [name for _, name in offered(*words, "")] == robot_names()
    assert offered(*words, "KUKA_kr6r900s") == [("plain", "kuka_kr6r900sixx")]


@pytest.mark.parametrize(
    "words",
    [
        ("check", "--from"),
        ("translate", "a.src", "--to"),
        ("prove", "a", "b", "--to"),
        ("fk", "--dialect"),
        ("ik", "--to-dialect"),
    ],
)
def test_languages(words: tuple[str, ...]) -> None:
    assert {"krl", "kuka", "rapid", "abb", "tp", "urscript"} <= {name for _, name in offered(*words, "")}
    assert offered(*words, "ra") == [("plain", "rapid")]


def test_controllers_and_files() -> None:
    assert ("plain", "plain") in offered("run", "a.src", "--controller", "")
    for words in (("run", "x"), ("check", "x"), ("prove", "x"), ("prove", "a", "x"), ("run", "a", "--cell", "x")):
        assert offered(*words) == [("file", "x")]
    assert offered("run", "a.src", "--robot", "./my") == [("file", "./my")]


def test_every_text_that_help_shows_as_a_robot_language_or_file_completes() -> None:
    for name in COMMANDS:
        command = rpl.get_command(click.Context(rpl), name)
        assert command is not None
        for param in command.params:
            if param.metavar in ("R", "R2", "D", "F.toml", "NAME|F.toml") or isinstance(param, click.Argument):
                assert param.type is not click.STRING, f"{name} {param.name}"


def test_the_documented_lines_give_scripts() -> None:
    shells = re.findall(r"_RPL_COMPLETE=(\w+)_source rpl", (ROOT / "docs/command-line.md").read_text("utf-8"))
    assert shells == ["bash", "zsh", "fish"]
    for shell in shells:
        environment = {**os.environ, "_RPL_COMPLETE": f"{shell}_source"}
        code = "import sys; sys.argv = ['rpl']; from rpl.cli.main import main; main()"
        done = subprocess.run(
            [sys.executable, "-c", code], env=environment, capture_output=True, text=True, timeout=600
        )
        assert "_RPL_COMPLETE" in done.stdout, done.stderr
