"""Commands write whole files or none, and never over what they did not write themselves."""

import os
import subprocess
from pathlib import Path

import pytest

from rpl.cli import files
from rpl.cli.main import run
from rpl.diagnostics import Diagnostics
from rpl.errors import UsageError
from rpl.project import read_sources
from rpl.registry import target
from rpl.source import source_from_text
from rpl.translation import translate_program
from rpl.writing.target import OutputFile

PROGRAM = "DEF part()\nWAIT SEC 1\nEND\n"


@pytest.fixture
def source(tmp_path: Path) -> Path:
    path = tmp_path / "in" / "part.src"
    path.parent.mkdir()
    path.write_text(PROGRAM)
    return path


def translated(source: Path, output: Path, *more: str) -> int:
    return run(["translate", str(source), "--to", "rapid", "-o", str(output), *more])


def test_what_was_written_before_is_written_again(source: Path, tmp_path: Path) -> None:
    assert translated(source, tmp_path / "out") == 0
    assert translated(source, tmp_path / "out") == 0
    assert sorted(path.suffix for path in (tmp_path / "out").iterdir()) == [".json", ".mod", ".toml"]


def test_files_of_somebody_else_and_changed_ones_stay(
    source: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert translated(source, out) == 0
    (module,) = out.glob("*.mod")
    module.write_text("taught on the floor")
    assert translated(source, out) == 2
    assert module.name in capsys.readouterr().err
    assert module.read_text() == "taught on the floor"
    (out / files.MANIFEST).unlink()
    assert translated(source, out) == 2
    assert translated(source, out, "--force") == 0
    assert "MODULE" in module.read_text()


@pytest.mark.parametrize("option", ["--trace", "--plot"])
def test_reports_do_not_overwrite_programs(source: Path, option: str) -> None:
    assert run(["run", str(source), option, str(source)]) == 2
    assert source.read_text() == PROGRAM
    other = source.with_name("other.dat")
    other.write_text("DEFDAT other\nENDDAT\n")
    assert run(["run", str(source), option, str(other)]) == 2
    assert other.read_text().startswith("DEFDAT")


def test_a_trace_is_written_again(source: Path, tmp_path: Path) -> None:
    trace = tmp_path / "t.jsonl"
    for _ in range(2):
        assert run(["run", str(source), "--trace", str(trace)]) == 0
    assert trace.read_text().count("\n") > 1


def test_a_trace_in_the_folder_of_the_program_is_written_again(
    source: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """It is no part of the program, so it is neither an input nor left of a translation."""
    trace = source.with_name("t.jsonl")
    for _ in range(2):
        assert run(["run", str(source.parent), "--trace", str(trace)]) == 0
    assert translated(source.parent, source.parent) == 0
    assert "earlier translation" not in capsys.readouterr().err
    assert run(["check", str(trace), "--json"]) == 2
    assert run(["run", str(source), "--trace", str(source.with_name("T.JSONL")), "--plot", str(trace)]) == 0


def test_two_reports_are_two_files(source: Path, capsys: pytest.CaptureFixture[str]) -> None:
    trace = source.with_name("t.jsonl")
    assert run(["run", str(source), "--trace", str(trace), "--plot", str(trace)]) == 2
    assert "--trace and --plot" in capsys.readouterr().err and not trace.exists()


def test_files_that_differ_from_those_of_somebody_else_in_capitals_only_are_not_written(
    source: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """File systems of Windows (and of every controller with it) take both names for one file."""
    other = source.rename(source.with_name("PART.Src"))
    assert run(["translate", str(other), "--to", "krl", "-o", str(source.parent)]) == 2
    assert "in capitals only" in capsys.readouterr().err
    assert [path.name for path in source.parent.iterdir()] == ["PART.Src"]
    assert run(["translate", str(other), "--to", "krl", "-o", str(source.parent), "--force"]) == 0


def test_a_pipe_that_nobody_reads_is_not_waited_for(source: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pipe = source.with_name("pipe")
    os.mkfifo(pipe)
    assert run(["run", str(source), "--trace", str(pipe)]) == 2
    assert "cannot write" in capsys.readouterr().err
    taker = subprocess.Popen(["cat", str(pipe)], stdout=subprocess.PIPE)
    with pipe.open("wb"):  # somebody reads from here on
        assert run(["run", str(source), "--trace", str(pipe)]) == 0
    taken, _ = taker.communicate(timeout=600)
    assert taken.count(b"\n") > 1


def test_an_input_is_not_overwritten_though_it_was_written_by_us(source: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert run(["translate", str(source), "--to", "krl", "-o", str(out)]) == 0
    (own,) = out.glob("*.src")
    assert run(["translate", str(own), "--to", "krl", "-o", str(out)]) == 2


def test_a_failure_leaves_what_was_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first, second = tmp_path / "a.txt", tmp_path / "b.txt"
    files.write_files({first: b"old a", second: b"old b"})
    usual = Path.write_bytes

    def full(path: Path, data: bytes) -> int:
        if ".b.txt" in path.name:
            raise OSError(28, "No space left on device", str(path))
        return usual(path, data)

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(UsageError, match="No space left"):
        files.write_files({first: b"new a", second: b"new b"})
    assert (first.read_bytes(), second.read_bytes()) == (b"old a", b"old b")
    assert {path.name for path in tmp_path.iterdir()} == {"a.txt", "b.txt", files.MANIFEST}


def test_files_of_an_earlier_translation_are_named(
    source: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert run(["translate", str(source), "--to", "urscript", "-o", str(out)]) == 0
    assert translated(source, out) == 0
    err = capsys.readouterr().err
    assert "part.script" in err and "earlier translation" in err


@pytest.mark.parametrize("language", ["krl", "inform", "tp", "vplus", "rapid", "urscript", "rpl"])
def test_two_programs_of_one_name_never_meet_in_one_file(tmp_path: Path, language: str) -> None:
    for folder, name, seconds in (("a", "p", 1), ("b", "P", 2)):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / f"{name}.src").write_text(f"DEF {name}()\nWAIT SEC {seconds}\nEND\n")
    out = tmp_path / "out"
    status = run(["translate", str(tmp_path / "a"), str(tmp_path / "b"), "--to", language, "-o", str(out)])
    written = [path for path in out.rglob("*") if path.is_file()] if out.exists() else []
    assert len({str(path).lower() for path in written}) == len(written)
    text = "\n".join(path.read_bytes().decode("utf-8") for path in written)
    assert status == 1 or ("1" in text and "2" in text)


def test_results_that_differ_by_case_only_are_refused() -> None:
    from dataclasses import replace

    from rpl import translation as made

    twice = [OutputFile("cell/A.src", b"1"), OutputFile("cell/a.SRC", b"2"), OutputFile("b.src", b"3")]
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("a.src", PROGRAM)], "krl", diagnostics)
    assert len(made._each_once(twice, read.program, diagnostics)) == 2
    assert [item.code.name for item in diagnostics] == ["same-output-file"]
    assert replace(target("krl"), title="x").name == "krl"
    assert translate_program(read, "krl").files


def test_a_program_name_that_leads_out_of_the_folder_is_refused_by_name(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    program = tmp_path / "x.ls"
    program.write_text("/PROG  ../../NAME\n/ATTR\n/MN\n   1:  WAIT    .50(sec) ;\n/POS\n/END\n")
    status = run(["translate", str(program), "--from", "tp", "--to", "tp", "-o", str(tmp_path / "out")])
    told = capsys.readouterr().err
    assert status in (1, 2)
    assert "internal error" not in told
    assert "NAME" in told
    assert not (tmp_path.parent / "NAME.LS").exists()
