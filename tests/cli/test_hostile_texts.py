"""Texts of programs never steer a terminal, and numbers that are none are refused by name."""

import math
import subprocess
import sys
from pathlib import Path

import pytest

import rpl
from rpl.cell import parse_cell
from rpl.cli.main import run
from rpl.errors import UsageError


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
