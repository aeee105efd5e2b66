"""Files that stand beside programs are told apart from them, whatever language is named."""

import json
import shutil
from pathlib import Path

import pytest

from rpl.cli.main import run
from rpl.diagnostics import Diagnostics
from rpl.project import read_program

ROOT = Path(__file__).parents[2]
CONTROLLER = (ROOT / "dialects/krl/controller.toml").read_text("utf-8")
ROBOT = (ROOT / "rpl/robots/ur5e.toml").read_text("utf-8")
EXPECTED = (ROOT / "samples/krl/palletiser/expected.toml").read_text("utf-8")
CELL = '[[input]]\ntime = 1.0\nsignal = "di1"\nvalue = true\n'
MAP = 'target = "tp"\n[numbers.R]\n1 = "count"\n'
TRACE = '{"t": 0.0, "task": "main", "kind": "wait", "file": "a.src", "line": 2, "seconds": 1}\n'
PROGRAM = "DEF demo()\n$OUT[1]=TRUE\nEND\n"
OWN = {
    "cell.toml": (CELL, "cell file"),
    "map.toml": (MAP, "--map"),
    "expected.toml": (EXPECTED, "must show"),
    "arm.toml": (ROBOT, "robot file"),
    "law.toml": (CONTROLLER, "controller file"),
    "run.jsonl": (TRACE * 3, "trace of a run"),
}
OTHERS = {
    "pyproject.toml": ("[project]\nname = 'x'\n", "settings in TOML"),
    "run.json": (json.dumps({"status": "finished"}, indent=1), "data in JSON"),
    "run.html": ("<!doctype html>\n<html></html>\n", "page in HTML"),
    "arm.urdf": ("<?xml version='1.0'?>\n<robot name='x'/>\n", "robot description"),
}


@pytest.mark.parametrize("language", [None, "krl", "tp", "urscript"])
def test_those_of_a_project_are_no_strangers_in_its_folder(language: str | None, tmp_path: Path) -> None:
    (tmp_path / "demo.src").write_text(PROGRAM)
    for name, (text, _) in OWN.items():
        (tmp_path / name).write_text(text)
    diagnostics = Diagnostics()
    read = read_program([tmp_path], language, diagnostics)
    assert [Path(report.path).name for report in read.files] == ["demo.src"]
    assert not any(Path(item.origin.file).name in OWN for item in diagnostics)


@pytest.mark.parametrize("language", [None, "krl"])
def test_others_are_skipped_with_a_note(language: str | None, tmp_path: Path) -> None:
    (tmp_path / "demo.src").write_text(PROGRAM)
    for name, (text, _) in OTHERS.items():
        (tmp_path / name).write_text(text)
    diagnostics = Diagnostics()
    read = read_program([tmp_path], language, diagnostics)
    assert len(read.files) == 1
    told = {Path(item.origin.file).name: item for item in diagnostics}
    assert set(told) == set(OTHERS)
    for name, (_, kind) in OTHERS.items():
        assert told[name].code.name == "skipped-file" and kind in told[name].message


@pytest.mark.parametrize("name", [*OWN, *OTHERS])
@pytest.mark.parametrize("language", [[], ["--from", "rapid"]])
def test_one_that_is_given_as_a_program_is_refused_by_what_it_is(
    name: str, language: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text, kind = {**OWN, **OTHERS}[name]
    (tmp_path / name).write_text(text)
    assert run(["check", str(tmp_path / name), *language]) == 2
    err = capsys.readouterr().err
    assert " error side-file " in err and kind in err


def test_what_translate_writes_is_read_back_as_it_is(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sample = tmp_path / "in"
    shutil.copytree(ROOT / "samples/krl/palletiser", sample)
    assert run(["translate", str(sample), "--to", "tp", "-o", str(tmp_path / "out")]) == 0
    capsys.readouterr()
    for more in ([], ["--from", "tp"]):
        assert run(["check", str(tmp_path / "out"), *more]) == 0
        assert "map.toml" not in "".join(capsys.readouterr())
