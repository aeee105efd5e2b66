"""Texts of programs never steer a terminal, and numbers that are none are refused by name."""

import math
import os
import pty
import subprocess
import sys
from pathlib import Path

import pytest

import rpl
from rpl.cell import parse_cell
from rpl.cli.main import run
from rpl.errors import RunError, UsageError


def test_control_characters_of_a_program_do_not_reach_the_terminal(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "a.rpl"
    path.write_text('MESSAGE "red \x1b[31m \x07 \x9b2J"\nx \x1b]0;title\x07 y\n', encoding="utf-8")
    run(["run", str(path), "--from", "rpl", "--despite-errors"])
    run(["check", str(path), "--from", "rpl"])
    told = capsys.readouterr()
    assert not any(sign in told.out + told.err for sign in "\x1b\x07\x9b")
    assert "\\x1b[31m" in told.out


def test_no_number_as_a_limit_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.src"
    path.write_text("DEF a()\nWAIT SEC 1\nEND\n")
    with pytest.raises(UsageError, match="max_time_s"):
        rpl.run(rpl.read(path), max_time_s=math.nan)


@pytest.mark.parametrize("value", ["nan", "inf", "-1.0", "2e9"])
def test_times_of_a_cell_are_numbers(value: str) -> None:
    with pytest.raises(UsageError, match=r"cell.toml: input\[1\].time"):
        parse_cell(f'[[input]]\ntime = {value}\nsignal = "di1"\nvalue = true\n', "cell.toml")


def test_who_has_read_enough_of_a_list_may_go() -> None:
    made = subprocess.Popen([sys.executable, "-m", "rpl.cli.main", "robots"], stdout=subprocess.PIPE)
    assert made.stdout is not None
    made.stdout.close()
    assert made.wait(60) == 0


STEERING = ("\x1b", "\x07", "\x9b")


def told(capsys: pytest.CaptureFixture[str]) -> str:
    seen = capsys.readouterr()
    assert not any(sign in seen.out + seen.err for sign in STEERING)
    return seen.out + seen.err


def test_no_command_shows_names_and_messages_raw(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """ECMA-48: ESC and the controls from 80 to 9F (hexadecimal) begin what terminals obey."""
    path, other = tmp_path / "a\x1b[2J.rpl", tmp_path / "b.rpl"
    path.write_text('MESSAGE "red \x1b[31m \x9b2J"\n', encoding="utf-8")
    other.write_text('MESSAGE "other \x07"\n', encoding="utf-8")
    run(["check", str(path), "--from", "rpl"])
    assert "a\\x1b[2J.rpl: rpl" in told(capsys)
    run(["prove", str(path), str(other), "--from", "rpl", "--to", "rpl"])
    assert "\\x1b[31m" in told(capsys)
    run(["run", str(path), "--from", "rpl", "--json"])
    assert "\\u001b[31m \\u009b2J" in told(capsys)
    run(["run", str(path), "--from", "rpl", "--robot", "ur5e", "--times", "--dynamics"])
    told(capsys)


def test_the_session_shows_no_message_raw(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    lines = iter(['MESSAGE "red \x1b[31m"', "history", "quit"])
    monkeypatch.setattr("builtins.input", lambda prompt: next(lines))
    run(["repl"])
    assert told(capsys).count("\\x1b[31m") == 2


def printed(arguments: list[str], on_terminal: bool) -> bytes:
    """What a command writes to stdout, seen from a terminal or a pipe."""
    command = [sys.executable, "-m", "rpl.cli.main", *arguments]
    if not on_terminal:
        return subprocess.run(command, stdout=subprocess.PIPE, check=False).stdout
    ours, theirs = pty.openpty()
    try:
        subprocess.run(command, stdout=theirs, check=False)
        os.close(theirs)
        return os.read(ours, 65536)
    finally:
        os.close(ours)


def test_a_printed_translation_is_escaped_on_a_terminal_only(tmp_path: Path) -> None:
    path = tmp_path / "a.src"
    path.write_text("DEF a()\n; red \x1b[31m\nWAIT SEC 1\nEND\n", encoding="utf-8")
    arguments = ["translate", str(path), "--from", "krl", "--to", "rapid"]
    assert b"red \x1b[31m" in printed(arguments, False)
    shown = printed(arguments, True)
    assert b"red \\x1b[31m" in shown and b"\x1b" not in shown


def test_a_first_value_that_cannot_be_made_is_named_with_its_place(tmp_path: Path) -> None:
    path = tmp_path / "a.mod"
    record = "RECORD point\nnum x;\nENDRECORD\n"
    text = f"MODULE a\n{record}VAR point p1:=[nowhere];\nPROC main()\nTPWrite ValToStr(p1);\nENDPROC\nENDMODULE\n"
    path.write_text(text)
    with pytest.raises(RunError, match=r"a\.mod:5: the initial value of p1: nowhere is not declared"):
        rpl.run(rpl.read(path))
    path.write_text(text.replace("VAR point p1:=[nowhere];\nPROC main()", "PROC main()\nVAR point p1:=[nowhere];"))
    with pytest.raises(RunError, match=r"a\.mod:5: main: nowhere is not declared"):
        rpl.run(rpl.read(path))
