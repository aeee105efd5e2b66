"""`rpl run --explore`: a backup is driven through its branches."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from rpl.cli.main import run

CELL = """DEF cell()
WAIT FOR $IN[1]
IF $IN[2] THEN
grip_part()
$OUT[1]=TRUE
ELSE
check()
ENDIF
END
DEF check()
INT n
n=0
IF $IN[3] THEN
n=5/n
ENDIF
$OUT[2]=TRUE
END
"""


def test_branches_faults_waits_and_stubs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "cell.src").write_text(CELL)
    assert run(["run", str(tmp_path), "--explore", "--json"]) == 1
    found = json.loads(capsys.readouterr().out)
    (entry,) = found["entries"]
    assert entry["entry"] == "cell" and entry["reached"] == entry["statements"] == 9
    (fault,) = entry["faults"]
    assert fault["line"] == 14 and fault["code"] == "division-by-zero" and "$IN[3] = True" in fault["cell"]
    assert [one["line"] for one in entry["stands"]] == [2]
    assert [(one["line"], one["signals"]) for one in found["waits_without_time_out"]] == [(2, ["$IN[1]"])]
    assert found["stubs"] == ["grip_part"] and found["reach"]["unreached"] == []


def test_the_same_for_people_and_the_same_again(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "cell.src").write_text(CELL)
    shown = []
    for _ in range(2):
        assert run(["run", str(tmp_path), "--explore"]) == 1
        shown.append(capsys.readouterr().out)
    assert shown[0] == shown[1]
    assert "cell: reached 9 of 9 statements in" in shown[0]
    assert "  fault: cell.src:14: division by zero (with $IN[" in shown[0]
    assert "not there, taken as doing nothing: grip_part" in shown[0]
    assert "waits without a time-out:\n  cell.src:2: $IN[1]\n" in shown[0]


@pytest.mark.parametrize(
    ("body", "status"),
    [
        ("IF $IN[2] THEN\n$OUT[1]=TRUE\nENDIF", 0),
        ("WAIT FOR $IN[1]", 3),  # nothing but the input ends the wait
        ("IF FALSE THEN\n$OUT[1]=TRUE\nENDIF", 3),  # nobody comes there
        ("away()", 3),  # a routine that is not there
        ("XP=$AXIS_ACT", 3),  # an arm that is not named
        ("XP={A1 1/0}", 1),
    ],
)
def test_exit_status(tmp_path: Path, body: str, status: int) -> None:
    (tmp_path / "main.src").write_text(f"DEF main()\nE6AXIS XP\n{body}\nEND\n")
    assert run(["run", str(tmp_path), "--explore"]) == status


def test_one_program_of_several_and_what_it_can_come_to(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "a.src").write_text("DEF a()\nshared()\nEND\nDEF shared()\n$OUT[1]=TRUE\nEND\n")
    (tmp_path / "b.src").write_text("DEF b()\n$OUT[2]=TRUE\n$OUT[3]=TRUE\nEND\n")
    assert run(["run", str(tmp_path), "--explore", "--entry", "A", "--json"]) == 3  # nobody came to b
    found = json.loads(capsys.readouterr().out)
    assert [(one["entry"], one["statements"], one["reached"]) for one in found["entries"]] == [("a", 2, 2)]
    assert found["reach"]["statements"] == 4
    assert run(["run", str(tmp_path), "--explore"]) == 0
    assert run(["run", str(tmp_path), "--explore", "--entry", "nobody"]) == 2
    assert run(["run", str(tmp_path), "--max-cells", "3"]) == 2


def test_fewer_cells_leave_more_to_look_at(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "cell.src").write_text(CELL)
    assert run(["run", str(tmp_path), "--explore", "--max-cells", "1", "--json"]) == 3
    (entry,) = json.loads(capsys.readouterr().out)["entries"]
    assert entry["ended"] == "cells" and entry["reached"] < entry["statements"] and not entry["faults"]
