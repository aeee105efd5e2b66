"""The first line of a translation is never better than what stands below it."""

from pathlib import Path

import pytest

from rpl.cli.main import run
from rpl.diagnostics import Code, Diagnostics, Severity, code
from rpl.ir.walk import statements
from rpl.project import ReadProgram, read_program
from rpl.report.readiness import Readiness, readiness
from rpl.source import NOWHERE

STOP = code("test-ready-stop", Severity.LOSS, "stop")
REMARK = code("test-ready-remark", Severity.WARNING, "remark")
NOTE = code("test-ready-note", Severity.INFO, "note")
MISTAKE = code("test-ready-mistake", Severity.ERROR, "mistake")
MOVES = "".join(f"LIN {{X {500 + x},Y 0,Z 600,A 0,B 90,C 0}}\r\n" for x in range(30))
PROGRAM = f"DEF demo()\r\nPTP {{A1 0,A2 -90,A3 90,A4 0,A5 10,A6 0}}\r\n{MOVES}$OUT[1]=TRUE\r\nEND\r\n"


@pytest.fixture
def read(tmp_path: Path) -> ReadProgram:
    path = tmp_path / "demo.src"
    path.write_bytes(PROGRAM.encode())
    return read_program([path], None, Diagnostics())


def at_line(read: ReadProgram, kind: Code, *lines: int, nowhere: int = 0) -> Diagnostics:
    found = Diagnostics()
    places = {node.origin.line: node.origin for node in statements(read.program)}
    for line in lines:
        found.report(kind, places[line])
    for _ in range(nowhere):
        found.report(kind, NOWHERE)
    return found


@pytest.mark.parametrize(
    ("kind", "lines", "nowhere", "proved", "line"),
    [
        (NOTE, (2,), 0, "", "ready: 34 of 34 statements written; not proved"),
        (NOTE, (2,), 0, "equal", "ready: 34 of 34 statements written; the proof says equal"),
        (NOTE, (2,), 0, "alike", "workable: 34 of 34 statements written; the proof says alike"),
        (NOTE, (2,), 0, "undecided", "workable: 34 of 34 statements written; the proof says undecided"),
        (NOTE, (2,), 0, "different", "not ready: 34 of 34 statements written; the proof says different"),
        (REMARK, (2, 2, 3), 0, "", "workable: 34 of 34 statements written; 2 places to look at; not proved"),
        (
            STOP,
            (3, 7, 33),
            0,
            "equal",
            "workable: 2 of 31 moves need you; 31 of 34 statements written (91.1 %); 3 statements stop the program; "
            "the proof says equal",
        ),
        (
            STOP,
            (2,),
            1,
            "",
            "workable: 1 of 31 moves need you; 33 of 34 statements written (97 %); "
            "1 statement and 1 report without a place stop the program; not proved",
        ),
        (STOP, tuple(range(3, 33)), 0, "", "not ready: 30 of 31 moves need you; "),
    ],
)
def test_the_first_line(
    read: ReadProgram, kind: Code, lines: tuple[int, ...], nowhere: int, proved: str, line: str
) -> None:
    assert readiness(read, at_line(read, kind, *lines, nowhere=nowhere), proved).as_text().startswith(line)


def test_a_share_is_never_rounded_up_to_all() -> None:
    assert "(99.9 %)" in Readiness(0, 0, 100_000, 1, 0, 0).as_text()


def test_nothing_written_is_not_ready(read: ReadProgram) -> None:
    found = readiness(read, at_line(read, MISTAKE, 4), written=False)
    assert found.as_text() == (
        "not ready: nothing was written, the errors come first: 1 statement; 1 of 31 moves need you"
    )
    assert found.as_json()["verdict"] == "not ready"


def test_a_translation_begins_with_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "demo.src"
    path.write_bytes(PROGRAM.replace("$OUT[1]=TRUE", "ANIN ON x = 1.0 * y + 2.0").encode())
    status = run(["translate", str(path), "--to", "rapid", "-o", str(tmp_path / "out")])
    out, err = capsys.readouterr()
    assert status == 3 and out.startswith("workable: ") and "1 statement stop" in out.splitlines()[0]
    worst = [line.split(" ")[1] for line in err.splitlines() if "demo.src:" in line]
    assert worst[0] == "loss" and worst == sorted(worst, key=["loss", "warning", "info"].index)
