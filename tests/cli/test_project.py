"""`rpl project`: the contents of a backup as a tree, a document and a page."""

from __future__ import annotations

import json
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

from rpl.cli.main import run

SAMPLE = str(Path(__file__).parents[2] / "samples" / "krl" / "palletiser")


def test_a_tree_for_people(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["project", SAMPLE]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "krl, 2 files, 90 statements, 3 routines, 12 moves"
    assert lines[1:5] == [
        "programs that can be started:",
        "  Palletiser (palletiser.src:4; 25 statements, 3 moves)",
        "    Pick (palletiser.src:42; 9 statements, 4 moves)",
        "    Place (palletiser.src:55; 19 statements, 5 moves)",
    ]
    assert "  digital out 1 doVacuum: written by Palletiser, Pick, Place; read by nobody" in lines
    assert "  tool Gripper (palletiser.dat:17): used by Palletiser" in lines


def test_a_document_for_machines(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["project", SAMPLE, "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["entries"] == ["Palletiser"] and document["arms"] == [] and document["diagnostics"] == []


class _Page(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.links: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.links += [str(value) for name, value in attrs if name in ("src", "href")]


def test_a_page_that_loads_nothing_and_escapes_names(tmp_path: Path) -> None:
    (tmp_path / "p.mod").write_text('MODULE p\nPROC main()\nlost;\n%"<b>"%;\nSet do_1;\nENDPROC\nENDMODULE\n')
    page = tmp_path / "page.html"
    assert run(["project", str(tmp_path / "p.mod"), "--html", str(page)]) == 0
    text = page.read_text("utf-8")
    reader = _Page()
    reader.feed(text)
    assert reader.links == [] and "default-src 'none'" in text
    assert re.search(r'<g class="missing" data-name="lost"', text)
    assert "<b>" not in text
    (tmp_path / "own.html").write_text("mine")
    assert run(["project", str(tmp_path / "p.mod"), "--html", str(tmp_path / "own.html")]) == 2
    assert (tmp_path / "own.html").read_text() == "mine"


def test_nothing_to_show_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "notes.txt").write_text("buy milk")
    assert run(["project", str(tmp_path)]) == 2
    assert "no robot program was found" in capsys.readouterr().err


MACHINE = 'DEFDAT $MACHINE PUBLIC\nCHAR $TRAFONAME[32]\n$TRAFONAME[]="#KR6R900SIXX C4SR FLR"\nENDDAT\n'


def test_a_run_takes_the_arm_that_the_backup_names(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "main.src").write_text("DEF main()\nPTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}\nPTP {A1 10}\nEND\n")
    assert run(["run", str(tmp_path), "--json"]) == 0
    without = json.loads(capsys.readouterr().out)
    (tmp_path / "$machine.dat").write_text(MACHINE)
    assert run(["run", str(tmp_path), "--json"]) == 0
    told = capsys.readouterr()
    assert "the arm is kuka_kr6r900sixx: $machine.dat calls it KR6R900SIXX C4SR FLR" in told.err
    assert json.loads(told.out)["time_s"] != without["time_s"]
    assert run(["run", str(tmp_path), "--robot", "kuka_kr16_2", "--json"]) == 0
    assert "the arm is" not in capsys.readouterr().err


def test_a_cell_file_with_what_the_programs_ask_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = "WAIT FOR $IN[7]\nLOST(1)\nn=far+1\n$OUT[1]=TRUE"
    (tmp_path / "main.src").write_text(f"DEF main()\nDECL INT n\n{lines}\nEND\n")
    cell = tmp_path / "cell.toml"
    assert run(["run", str(tmp_path), "--init-cell", str(cell)]) == 0
    text = cell.read_text("utf-8")
    assert '# read by main\n# [[input]]\n# time = 0.0\n# signal = "$IN[7]"\n# value = true\n' in text
    assert '# called at main.src:4, as in: LOST(1)\n[[routine]]\nname = "LOST"\nseconds = 0.0\n' in text
    assert "# Outputs, which a [[reaction]] may answer by an input:\n#   $OUT[1]: set by main\n" in text
    assert '[variables]\n"far" = 0  # assumed: asked for at main.src:5\n' in text
    capsys.readouterr()
    assert run(["run", str(tmp_path), "--cell", str(cell), "--json"]) == 1  # it waits for the input, as it is
    told = capsys.readouterr()
    assert json.loads(told.out)["status"] == "deadlock"
    assert "cell.toml" not in told.err  # nothing to say about the file itself
    edited = (
        text.replace("# [[input]]\n# time", "[[input]]\ntime")
        .replace("# signal", "signal")
        .replace("# value = t", "value = t")
    )
    cell.write_text(edited)
    assert run(["run", str(tmp_path), "--cell", str(cell), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["outputs"] == [[0.0, "$OUT[1]", True]]
    cell.write_text(edited.replace('"far" = 0', '# "far" = 0').replace("assume_data = true", ""))
    assert run(["run", str(tmp_path), "--cell", str(cell), "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["fault"] is not None  # data that nobody declares has no value
    assert run(["run", str(tmp_path), "--init-cell", str(cell)]) == 2  # edited: it stays


_LACKING = """DEF main()
DECL INT n
n=count+FUN(2)
gripper=held
IF mode==#FAST THEN
n=sheet[far].rows
ENDIF
PTP home
$OUT[1]=ready
END
"""


def test_a_cell_file_lets_the_program_go_on_unedited(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "main.src").write_text(_LACKING)
    (tmp_path / "main.dat").write_text("DEFDAT main\nDECL INT count\nDECL E6POS home\nENDDAT\n")
    cell = tmp_path / "cell.toml"
    assert run(["run", str(tmp_path), "--init-cell", str(cell)]) == 0
    text = cell.read_text("utf-8")
    assert "assume_data = true\n" in text and "value = 0                  # assumed: it is a function\n" in text
    values = dict(line.split("  # ")[0].split(" = ", 1) for line in text.splitlines() if line.startswith('"'))
    assert values == {'"count"': "0", '"far"': "1", '"held"': "0", '"mode"': '"#FAST"', '"ready"': "false"}
    assert '# "home" = { x = 0, y = 0, z = 0, a = 0, b = 0, c = 0 }  # a place, begins where the arm stands: ' in text
    capsys.readouterr()
    assert run(["run", str(tmp_path), "--cell", str(cell), "--robot", "kuka_kr6r900sixx", "--json"]) == 0
    told = capsys.readouterr()
    assert [one["name"] for one in json.loads(told.out)["assumed"]] == [
        "sheet[1].rows",
        "home",
    ]  # the file has the others
    assert "cell.toml" not in told.err


def test_assumed_data_is_told_before_the_result(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "main.src").write_text(_LACKING.replace("+FUN(2)", ""))
    assert run(["run", str(tmp_path), "--json"]) == 1
    assert "assumed" not in json.loads(capsys.readouterr().out)
    assert run(["run", str(tmp_path), "--assume-data"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "rests on 7 assumed values of data to which nothing in the project gives one:"
    assert lines[1] == "  main.src:3: count = 0" and lines[5] == "  main.src:6: sheet[1].rows = 0"
    assert run(["run", str(tmp_path), "--assume-data", "--json"]) == 0
    first = json.loads(capsys.readouterr().out)["assumed"][0]
    assert (first["name"], first["value"], first["line"], first["task"]) == ("count", "0", 3, "main")


def test_exploring_names_what_it_assumed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "main.src").write_text("DEF main()\nIF far>2 THEN\n$OUT[1]=$IN[1]\nENDIF\nEND\n")
    assert run(["run", str(tmp_path), "--explore", "--assume-data", "--json"]) == 3
    (driven,) = json.loads(capsys.readouterr().out)["entries"]
    assert [(one["name"], one["value"], one["line"]) for one in driven["assumed"]] == [("far", "0", 2)]
    assert run(["run", str(tmp_path), "--explore", "--assume-data"]) == 3
    told = capsys.readouterr().out.splitlines()
    assert told[0] == "rests on 1 assumed value of data to which nothing in the project gives one"
    assert "  assumed: main.src:2: far = 0" in told


def test_a_stub_that_is_never_asked_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "main.src").write_text("DEF main()\nLOST()\nOWN()\nEND\nDEF OWN()\n$OUT[1]=TRUE\nEND\n")
    cell = tmp_path / "cell.toml"
    cell.write_text("".join(f'[[routine]]\nname = "{name}"\n' for name in ("Lost", "Own", "Lots")))
    assert run(["run", str(tmp_path / "main.src"), "--cell", str(cell), "--entry", "main", "--verbose"]) == 0
    told = capsys.readouterr().err
    assert "own stands for, and the program has that routine" in told
    assert "lots stands for, and nothing calls it" in told and "lost stands for" not in told


def test_a_wait_for_what_nothing_in_the_project_changes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    job = "/JOB\n//NAME MAIN\n//POS\n///NPOS 0,0,0,0,0,0\n//INST\n///DATE 2026/01/01 00:00\n///ATTR SC,RW\nNOP\n"
    (tmp_path / "MAIN.JBI").write_text(f"{job}DOUT OT#(890) OFF\nWAIT OT#(890)=ON\nEND\n")
    assert run(["run", str(tmp_path)]) == 1
    assert "nothing in the project changes OT#(890): that comes from outside" in capsys.readouterr().err
    assert run(["run", str(tmp_path), "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["from_outside"] == ["OT#(890)"]
    (tmp_path / "MAIN.JBI").write_text(f"{job}WAIT OT#(890)=ON\nDOUT OT#(890) ON\nEND\n")
    assert run(["run", str(tmp_path), "--json"]) == 1
    assert "from_outside" not in json.loads(capsys.readouterr().out)
