"""Certificates of proofs: kept, done again, and what makes them fail."""

import json
import os
import shutil
from pathlib import Path

import pytest

from rpl.cli.main import run
from rpl.proof import kept

ROBOT = "kuka_kr6r900sixx"
A = "DEF part()\n$OUT[1]=TRUE\nPTP {A1 10,A2 -90,A3 90,A4 0,A5 45,A6 0}\nWAIT SEC 0.5\n$OUT[1]=FALSE\nEND\n"
B = A.replace("SEC 0.5", "SEC 0.25+0.25")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name, text in (("a", A), ("b", B)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "part.src").write_text(text)
    (tmp_path / "cell.toml").write_text('[[input]]\ntime = 1.0\nsignal = "$IN[1]"\nvalue = true\n')
    return tmp_path


def prove(folder: Path, *options: str) -> int:
    kept = str(folder / "proof.json")
    programs = [str(folder / "a"), str(folder / "b")]
    return run(
        ["prove", *programs, "--robot", ROBOT, "--cell", str(folder / "cell.toml"), "--certificate", kept, *options]
    )


def check(folder: Path, capsys: pytest.CaptureFixture[str]) -> tuple[int, str]:
    capsys.readouterr()
    status = run(["prove", "--check", str(folder / "proof.json")])
    return status, capsys.readouterr().out


def test_a_certificate_says_what_was_proved(folder: Path) -> None:
    assert prove(folder) == 0
    document = json.loads((folder / "proof.json").read_text("utf-8"))
    assert document["verdict"] == "equal"
    assert {"rpl", "python", "numpy"} <= set(document["versions"])
    assert [one["path"] for one in document["programs"]["b"]] == ["b/part.src"]
    assert set(document["files"]) == {"robot", "cell"}
    assert document["tolerance"]["path_mm"] == 0.01


def test_it_holds_as_long_as_nothing_changes_and_wherever_it_lies(
    folder: Path, tmp_path_factory: pytest.TempPathFactory, capsys: pytest.CaptureFixture[str]
) -> None:
    assert prove(folder) == 0
    status, out = check(folder, capsys)
    assert (status, out.partition(":")[0]) == (0, "the certificate holds")
    elsewhere = tmp_path_factory.mktemp("elsewhere") / "moved"
    shutil.move(folder, elsewhere)
    assert check(elsewhere, capsys)[0] == 0


def test_paths_of_what_was_not_reached_travel_too(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, text in (("a", A), ("b", B)):
        (folder / name / "part.src").write_text(text.replace("END", "IF $IN[5] THEN\n$OUT[2]=TRUE\nENDIF\nEND"))
    monkeypatch.chdir(folder)
    assert run(["prove", "a", "b", "--robot", ROBOT, "--certificate", "proof.json"]) == 0
    reach = json.loads((folder / "proof.json").read_text("utf-8"))["result"]["reach"]
    assert [one["file"] for side in "ab" for one in reach[side]["unreached"]] == ["a/part.src", "b/part.src"]
    monkeypatch.chdir("/")
    assert check(folder, capsys)[0] == 0


@pytest.mark.parametrize(
    ("name", "old", "new", "words"),
    [
        (
            "b/part.src",
            "0.25+0.25",
            "0.25+0.26",
            ["B: b/part.src has changed", "the verdict was equal and is different"],
        ),
        ("a/part.src", "DEF part()", "DEF part() ; a remark", ["A: a/part.src has changed"]),
        ("cell.toml", "1.0", "2.0", ["the cell has changed"]),
        ("proof.json", '"path_mm": null', '"path_mm": 5.0', ["the tolerance is another one"]),
        ("proof.json", '"verdict": "equal"', '"verdict": "alike"', ["the verdict was alike and is equal"]),
    ],
)
def test_what_has_changed_is_told(
    folder: Path, name: str, old: str, new: str, words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert prove(folder) == 0
    path = folder / name
    text = path.read_text("utf-8")
    assert old in text
    path.write_text(text.replace(old, new), "utf-8")
    status, out = check(folder, capsys)
    assert status == 1
    for word in words:
        assert word in out


def test_deviations_and_what_is_accepted_stand_in_it(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "b" / "part.src").write_text(A.replace("SEC 0.5", "SEC 0.501"))
    assert prove(folder) == 3
    assert check(folder, capsys)[0] == 0
    assert prove(folder, "--accept", "wait", "--accept", "time") == 0
    document = json.loads((folder / "proof.json").read_text("utf-8"))
    assert document["result"]["deviations"] == [{"accepted": True, "count": 1, "kind": "wait", "worst": 0.001}]
    assert check(folder, capsys)[0] == 0


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("{", "this is no certificate"),
        ("{}", "this is no certificate"),
        ("[1]", "this is no certificate"),
        ('{"format": "rpl proof certificate 1", "question": {}}', "the certificate has other keys than it should"),
        ('{"format": "rpl proof certificate 2"}', "no format 'rpl proof certificate 1', but 'rpl proof certificate 2'"),
        ('{"format": {}, "format": 1}', "the key 'format' is there more than once"),
        pytest.param("9" * 5000, "this is no certificate", id="a number of 5000 digits"),
        pytest.param("[" * 100_000, "it is nested too deeply", id="deep"),
    ],
)
def test_what_is_no_certificate_is_refused(
    tmp_path: Path, text: str, words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "proof.json"
    path.write_text(text)
    assert run(["prove", "--check", str(path)]) == 2
    said = capsys.readouterr().err
    assert words in said and str(path) in said


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"explore": false', '"explore": 0', "question.explore: must be true or false, not 0"),
        ('"accept": []', '"accept": ["all"]', "question.accept: --accept all: no measure of a proof"),
        ('"accept": []', '"accept": [[]]', "question.accept: must be a list of words, not a list"),
        ('"path_mm": null', '"path_mm": -1', "question.path_mm: must be a number from 0 on, not -1"),
        ('"path_mm": null', '"path_mm": NaN', "question.path_mm: must be a finite number, not nan"),
        ('"path_mm": null', '"path_mm": 1e999', "question.path_mm: must be a finite number, not inf"),
        ('"max_steps": null', '"max_steps": 1.5', "question.max_steps: must be a whole number above 0, not 1.5"),
        ('"max_time": null', f'"max_time": {10**400}', "question.max_time: must be a number of at most 64 bits"),
        ('"entry": null', '"entry": "\\u0000"', "question.entry: must be a text without null signs"),
        ('"entry": null', '"entry": "\\ud800"', "question.entry: must be a text without null signs"),
        ('"entry": null', '"entry": "other"', "the question cannot be asked again: "),
        (f'"robot": "{ROBOT}"', '"robot": "kuka"', "the question cannot be asked again: "),
        ('"a": "a"', '"a": "none"', "the question cannot be asked again: "),
        ('"entry": null', '"start": null', "the certificate's question has other keys than it should: entry, start"),
        ('"verdict": "equal"', '"verdict": true', "verdict: must be one of equal, alike, different, undecided"),
        ('"path": "b/part.src"', '"file": "b/part.src"', "programs.b[0] has other keys than it should: file, path"),
        ('"path": "b/part.src"', '"path": 5', "programs.b[0].path: must be a text, not 5"),
        ('"place_mm": 1.0', '"place_mm": true', "tolerance.place_mm: must be a number, not true"),
    ],
)
def test_what_is_wrong_in_a_certificate_is_said_with_file_and_key(
    folder: Path, old: str, new: str, words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert prove(folder) == 0
    path = folder / "proof.json"
    text = path.read_text("utf-8")
    assert old in text
    path.write_text(text.replace(old, new), "utf-8")
    capsys.readouterr()
    assert run(["prove", "--check", str(path)]) == 2
    said = capsys.readouterr()
    assert said.err.startswith(f"rpl: {path}: ") and words in said.err and not said.out


def test_folders_pipes_and_what_is_too_large_are_no_certificates(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    os.mkfifo(tmp_path / "pipe.json")
    (tmp_path / "large.json").write_text("{}")
    monkeypatch.setattr(kept, "_LARGEST", 1)
    for name, words in ((".", "is a directory"), ("pipe.json", "a pipe"), ("large.json", "larger than")):
        assert run(["prove", "--check", str(tmp_path / name)]) == 2
        assert words in capsys.readouterr().err


def test_a_certificate_names_only_what_can_be_asked_for_again(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    odd = folder / os.fsdecode(b"\xff")
    shutil.copytree(folder / "b", odd)
    for other, words in ((str(odd), "no UTF-8"), ("-", "standard input")):
        target = folder / "odd.json"
        command = ["prove", str(folder / "a"), other, "--robot", ROBOT, "--certificate", str(target)]
        assert run(command) == 2
        assert words in capsys.readouterr().err and not target.exists()


def test_programs_or_a_certificate_are_needed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["prove"]) == 2
    assert "name two programs" in capsys.readouterr().err
    assert run(["prove", "x", "y", "--check", str(tmp_path / "proof.json")]) == 2
    assert "takes no programs" in capsys.readouterr().err
    assert run(["prove", "--check", str(tmp_path / "none.json")]) == 2
    assert "cannot read" in capsys.readouterr().err


RAPID = """MODULE Part
  PROC main()
    SetDO doGrip,1;
    WaitDI diPart,1;
    WaitTime 0.5;
    SetDO doGrip,0;
  ENDPROC
ENDMODULE
"""
GIVEN = '[[input]]\ntime = 1.0\nsignal = "diPart"\nvalue = true\n'


def translated(folder: Path, *options: str) -> int:
    (folder / "part.mod").write_text(RAPID)
    (folder / "given.toml").write_text(GIVEN)
    command = ["translate", str(folder / "part.mod"), "--to", "tp", "-o", str(folder / "out"), "--robot", ROBOT]
    command += ["--cell", str(folder / "given.toml"), "--certificate", str(folder / "proof.json")]
    return run([*command, *options])


def test_a_translation_is_certified_as_it_lies_in_its_folder(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Signals of the source have numbers in the target: the certificate knows which."""
    assert translated(folder) == 0
    assert "\nequal: " in capsys.readouterr().out
    document = json.loads((folder / "proof.json").read_text("utf-8"))
    assert document["question"]["signals"] == [["diPart", "digital_in", 1, None], ["doGrip", "digital_out", 1, None]]
    assert [one["path"] for one in document["programs"]["b"]] == ["out/MAIN.LS"]
    status, out = check(folder, capsys)
    assert (status, out.partition(":")[0]) == (0, "the certificate holds")
    written = folder / "out" / "MAIN.LS"
    assert b"=OFF" in written.read_bytes()
    written.write_bytes(written.read_bytes().replace(b"=OFF", b"=ON"))
    status, out = check(folder, capsys)
    assert status == 1 and "B: out/MAIN.LS has changed" in out and "the verdict was equal and is different" in out


def test_what_a_translation_approximates_stands_in_its_certificate(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A translation that says that it approximates is never equal; asked again it is what it was."""
    from rpl.cli import translate

    monkeypatch.setattr(translate, "_approximations", lambda written: (("some-code", 2),))
    assert translated(folder) == 3
    document = json.loads((folder / "proof.json").read_text("utf-8"))
    assert (document["verdict"], document["question"]["approximations"]) == ("alike", [["some-code", 2]])
    status, out = check(folder, capsys)
    assert status == 0 and "written with approximations: some-code (2)" in out


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"digital_in"', '"analogue"', "question.signals[0]: must be a name, the kind of a signal"),
        ('"signals": [', '"signals": [ 1,', "question.signals[0]: must be a name, the kind of a signal"),
        ('"signals"', '"approximations": {}, "signals"', "question.approximations: must be a list, not a table"),
        ('"signals": [', '"approximations": [["a", 0]], "signals": [', "question.approximations[0]: must be a code"),
    ],
)
def test_what_is_wrong_in_the_certificate_of_a_translation_is_said(
    folder: Path, old: str, new: str, words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert translated(folder) == 0
    path = folder / "proof.json"
    path.write_text(path.read_text("utf-8").replace(old, new, 1), "utf-8")
    capsys.readouterr()
    assert run(["prove", "--check", str(path)]) == 2
    assert words in capsys.readouterr().err


def test_the_certificate_of_a_translation_needs_files_that_can_be_read_again(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert translated(folder, str(folder / "a")) == 2
    assert "takes one PATH" in capsys.readouterr().err
    source, kept = str(folder / "a"), str(folder / "proof.json")
    assert run(["translate", source, "--to", "tp", "--certificate", kept]) == 2
    assert "give a folder with -o" in capsys.readouterr().err
    (folder / "out").mkdir()
    (folder / "out" / "old.ls").write_text("/PROG OLD\n/MN\n 1: END ;\n/POS\n/END\n")
    assert translated(folder) == 2
    assert "old.ls would be read with the result" in capsys.readouterr().err
    assert sorted(one.name for one in (folder / "out").iterdir()) == ["old.ls"]
