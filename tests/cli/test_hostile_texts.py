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
from rpl.controllerfiles import parse_controller
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


@pytest.mark.parametrize(
    "arguments",
    [
        ["fk", "--robot", "ur5e", "--joints", "0,0,0,0,0,1e300"],
        ["fk", "--robot", "ur5e", "--joints", "0,0,0,0,0,0", "--tool", "1e9,0,0"],
        ["ik", "--robot", "ur5e", "--pose", "1e300,0,0,0,0,0"],
        ["ik", "--robot", "ur5e", "--dialect", "urscript", "--pose", "p[1e300,0,0,0,0,0]"],
        ["ik", "--robot", "kuka_kr6r900sixx", "--pose", "{X 1e300,Y 0,Z 0,A 0,B 0,C 0}"],
    ],
)
def test_joints_and_places_beyond_every_machine_are_refused(
    arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(arguments) == 2
    assert "beyond 1,000,000" in capsys.readouterr().err


@pytest.mark.parametrize("value", ["nan", "inf", "-1.0", "2e9"])
def test_times_of_a_cell_are_numbers(value: str) -> None:
    with pytest.raises(UsageError, match=r"cell.toml:2: input\[1\].time"):
        parse_cell(f'[[input]]\ntime = {value}\nsignal = "di1"\nvalue = true\n', "cell.toml")


@pytest.mark.parametrize("words", [["robots"], ["dialects", "--json"], ["--help"], ["run", "-h"], ["--version"]])
def test_who_has_read_enough_of_a_list_may_go(words: list[str]) -> None:
    made = subprocess.Popen([sys.executable, "-m", "rpl.cli.main", *words], stdout=subprocess.PIPE)
    assert made.stdout is not None
    made.stdout.close()
    assert made.wait(60) == 0


@pytest.mark.parametrize(("closed", "status"), [(">&-", 0), ("2>&-", 0), ("<&-", 2), (">&- 2>&- <&-", 2)])
def test_a_stream_that_the_shell_has_closed_is_no_traceback(tmp_path: Path, closed: str, status: int) -> None:
    path = tmp_path / "a.src"
    path.write_text("DEF a()\nWAIT SEC 1\nEND\n")
    given = "-" if status else str(path)
    command = f"{sys.executable} -m rpl.cli.main run {given} {closed}"
    made = subprocess.run(["sh", "-c", command], capture_output=True, text=True, timeout=600, check=False)
    assert made.returncode == status and "Traceback" not in made.stderr


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


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("joints = [0, nan]", r"c.toml:1: joints\[2\]: must be a finite number, not nan"),
        ("joints = [0, 1e9]", "c.toml:1: joints: .* none beyond 1,000,000"),
        ("external = [inf]", r"c.toml:1: external\[1\]: must be a finite number"),
        ("seed = true", "c.toml:1: seed: must be a whole number"),
        (f"seed = {'9' * 5000}", "c.toml:1: 'seed': a number has more than 4300 digits"),
        (f"\nseed = 0x{'F' * 5000}", "c.toml:2: 'seed': a whole number has more than 64 bits"),
        ("[variables]\nx = nan", "c.toml:2: variables.x: must be a finite number"),
        ("[variables]\nx = { y = [1, [-inf]] }", r"c.toml:2: variables.x.y\[2\]\[1\]: must be a finite number"),
        ("[system]\n\npath_speed = -5", "c.toml:3: system.path_speed: must be from 0.000001 to"),
        ("[system]\npath_speed = 1e-300", "c.toml:2: system.path_speed: must be from 0.000001 to"),
        ("[system]\npath_acceleration = 0", "c.toml:2: system.path_acceleration: must be from 0.000001 to"),
        ('[analog.tp]\n"AO[1]" = { numbers = [0, nan], volts = [0, 1] }', r"c.toml:2: analog.tp.AO\[1\].numbers\[2\]"),
        ('[[input]]\ntime = 1\nsignal = "a"\nvalue = 1\n[[input]]\ntime = 1\nsignal = "b"\nvalue = nan', "c.toml:8: "),
        (
            '[[mechanism]]\nname = "a"\nkind = "rotary"\naxes = [{ number = 1, speed = 1e-300 }]',
            "c.toml:4: .*speed: must be",
        ),
        (
            '[[mechanism]]\nname = "a"\nkind = "rotary"\naxes = [{ number = 1, limits = [-1e9, 1e9] }]',
            "c.toml:4: .*farther",
        ),
        (f"joints = {'[' * 5000}", "nested too deeply"),
    ],
)
def test_numbers_of_a_cell_that_are_none_are_named_with_line_and_key(text: str, complaint: str) -> None:
    """TOML 1.0: nan and inf are floats, and what does not fit 64 bits is an error."""
    with pytest.raises(UsageError, match=complaint):
        parse_cell(text, "c.toml")


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("joint_ramp_s = nan", "c.toml:1: 'joint_ramp_s' must be a number of at least 0, found nan"),
        ("joint_ramp_s = -1", "c.toml:1: 'joint_ramp_s' must be a number of at least 0"),
        (
            "path_acceleration_mm_s2 = 1e-300",
            "c.toml:1: 'path_acceleration_mm_s2' must be more than 0, at least 0.000001",
        ),
        ("\njoint_ramps_s = [0.1, 1e300]", "c.toml:2: 'joint_ramps_s' must be a number of at most 1,000,000,000"),
        ("[uncertainty]\ncorner = inf", "c.toml:2: 'uncertainty.corner' must be"),
        ("joint_ramp = 1", "c.toml:1: unknown key 'joint_ramp'; meant joint_ramp_s"),
        (f"restart_s = {'9' * 5000}", "c.toml:1: 'restart_s': a number has more than 4300 digits"),
    ],
)
def test_numbers_of_a_controller_that_are_none_are_named_with_line_and_key(text: str, complaint: str) -> None:
    with pytest.raises(UsageError, match=complaint):
        parse_controller(text, "c", "c.toml")


PROGRAMS = {
    "a.src": "DEF a()\nINT x\nx={}\nEND\n",
    "a.mod": "MODULE a\nVAR num x;\nPROC main()\nx:={};\nENDPROC\nENDMODULE\n",
    "a.ls": "/PROG A\n/ATTR\n/MN\n   1:  R[1]={} ;\n/POS\n/END\n",
    "a.script": "def a():\n  x = 1\n  x = {}\n  set_digital_out(1, True)\nend\n",
    "a.v2": ".PROGRAM a()\n x = 1\n x = {}\n.END\n",
    "a.jbi": "/JOB\n//NAME A\n//INST\n///DATE 2020/01/01 00:00\n///ATTR SC,RW\nNOP\nSET I000 {}\nEND\n",
    "a.rpl": "PROCEDURE main()\nVARIABLE x : INT = 1\nx = {}\nEND PROCEDURE\n",
}
LANGUAGES = ("krl", "rapid", "tp", "urscript", "vplus", "inform", "rpl")


@pytest.mark.parametrize(("name", "language"), zip(PROGRAMS, LANGUAGES, strict=True))
@pytest.mark.parametrize("number", ["9" * 4301, "F" * 4000])
def test_a_number_that_is_too_long_is_an_error_at_its_place(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, language: str, number: str
) -> None:
    path, other = tmp_path / name, tmp_path / f"b_{name}"
    text = PROGRAMS[name]
    path.write_text(text.format(number))
    line = text[: text.index("{")].count("\n") + 1
    assert run(["check", str(path), "--from", language]) == 1
    assert f"{name}:{line}:" in (told := capsys.readouterr().err) and "error number-too-long" in told
    assert run(["run", str(path), "--from", language]) == 1
    other.write_text(text.format("1").replace("main", "other"))
    capsys.readouterr()
    assert run(["check", str(tmp_path), "--from", language]) == 1
    assert f"b_{name}: {language}, " in capsys.readouterr().out
