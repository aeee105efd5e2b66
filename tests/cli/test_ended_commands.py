"""Commands that are ended from outside leave the terminal and the trace as they should be."""

import json
import os
import pty
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from rpl.cli.main import run
from rpl.runtime.trace import RunInterrupted, RunResult
from rpl.source import Origin, read_source

ENDLESS = """\
DEF a()
BOOL on
on=TRUE
LOOP
on=NOT on
$OUT[1]=on
WAIT SEC 0.1
ENDLOOP
END
"""
COMMAND = [sys.executable, "-m", "rpl.cli.main", "run"]
LIMITS = ["--max-time", "1e9", "--max-events", "1000000000"]
HIDE, SHOW = b"\x1b[?25l", b"\x1b[?25h"


@pytest.fixture(autouse=True)
def interruptible() -> Iterator[None]:
    """Tests that run in the background ignore SIGINT, and so would what they start."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def seen_until(terminal: int, wanted: bytes) -> bytes:
    """What a terminal shows up to that; an OSError where it never comes."""
    seen = b""
    while wanted not in seen:
        seen += os.read(terminal, 4096)
    return seen


def test_ctrl_c_says_where_the_run_was_and_keeps_its_events(tmp_path: Path) -> None:
    path, trace = tmp_path / "a.src", tmp_path / "a.jsonl"
    path.write_text(ENDLESS)
    ours, theirs = pty.openpty()
    made = subprocess.Popen([*COMMAND, str(path), *LIMITS, "--trace", str(trace)], stderr=theirs)
    os.close(theirs)
    told = seen_until(ours, b"running")
    made.send_signal(signal.SIGINT)
    assert made.wait(60) == 130
    told += seen_until(ours, b"until then")
    os.close(ours)
    assert b"s of simulated time" in told and b"Traceback" not in told
    assert any(f"{path}:{line}: task main was here".encode() in told for line in range(4, 9))
    events = [json.loads(line) for line in trace.read_text().splitlines()]
    assert len(events) > 10 and {event["kind"] for event in events} >= {"output"}


def test_who_is_told_to_end_shows_the_cursor_again(tmp_path: Path) -> None:
    """The progress bar hides it (DECTCEM, the private mode 25 of the VT220)."""
    path = tmp_path / "a.src"
    path.write_text(ENDLESS)
    ours, theirs = pty.openpty()
    made = subprocess.Popen([*COMMAND, str(path), *LIMITS], stderr=theirs, env={**os.environ, "TERM": "xterm"})
    os.close(theirs)
    shown = seen_until(ours, HIDE)
    made.terminate()
    assert made.wait(60) == 143
    shown += seen_until(ours, SHOW)
    os.close(ours)
    assert shown.rindex(SHOW) > shown.rindex(HIDE)


@pytest.mark.parametrize("more", [["prove", "a.src", "a.src"], ["prove", "a.src", "a.src", "--explore"]])
def test_ctrl_c_says_which_work_it_ended(tmp_path: Path, more: list[str]) -> None:
    (tmp_path / "a.src").write_text(ENDLESS)
    ours, theirs = pty.openpty()
    command = [sys.executable, "-m", "rpl.cli.main", *more, *LIMITS]
    made = subprocess.Popen(command, stderr=theirs, cwd=tmp_path)
    os.close(theirs)
    told = seen_until(ours, b"proving")
    made.send_signal(signal.SIGINT)
    assert made.wait(60) == 130
    told += seen_until(ours, b"rpl: interrupted while proving")
    os.close(ours)
    assert b"Traceback" not in told


def test_ctrl_c_says_where_a_run_was_that_another_command_made(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    path = tmp_path / "a.src"
    path.write_text(ENDLESS)
    source = read_source(path)
    result = RunResult("interrupted", 1.5, 0, 0, (), (), None, ())

    def stopped(*given: object, **more: object) -> None:
        raise RunInterrupted(result, (("main", Origin(source, source.text.index("WAIT"))),))

    monkeypatch.setattr("rpl.proof.prove.prove_programs", stopped)
    assert run(["prove", str(path), str(path)]) == 130
    told = capsys.readouterr().err
    assert "rpl: interrupted while proving" in told
    assert f"{path}:7: task main was here, 1.500 s after its start" in told
