"""What is reported again and again is told once, with its number and places; JSON has every one."""

import json
from pathlib import Path

import pytest

from rpl.cli.main import run
from rpl.diagnostics import Diagnostic, Severity, code, folded
from rpl.source import Origin, Source, source_from_text

ERROR = code("test-folded-error", Severity.ERROR, "wrong: {word}")
LOSS = code("test-folded-loss", Severity.LOSS, "lost: {word}")


def report(kind: object, source: Source, line: int, word: str) -> Diagnostic:
    assert kind in (ERROR, LOSS)
    chosen = ERROR if kind is ERROR else LOSS
    offset = source.line_starts()[line - 1]
    return Diagnostic(chosen, Origin(source, offset, offset), (("word", word),), chosen.severity)


@pytest.fixture
def source() -> Source:
    return source_from_text("a.src", "x\n" * 100)


def test_the_same_words_are_one_line_with_their_places(source: Source) -> None:
    items = [report(ERROR, source, line, "x" if line != 3 else "y") for line in (2, 3, 5, 9)]
    assert list(folded(items)) == [
        "a.src:2:1: error test-folded-error wrong: x [2 more times: lines 5, 9]",
        "a.src:3:1: error test-folded-error wrong: y",
    ]
    many = list(folded(report(ERROR, source, line, "x") for line in range(1, 51)))
    assert many == [
        "a.src:1:1: error test-folded-error wrong: x [49 more times: lines 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, ...]"
    ]


def test_many_of_a_kind_end_in_a_count(source: Source) -> None:
    texts = list(folded(report(ERROR, source, line, str(line)) for line in range(1, 51)))
    assert len(texts) == 21
    assert texts[-1] == "a.src:21: error test-folded-error 30 more of this kind, to line 50"
    assert len(list(folded(report(ERROR, source, line, str(line)) for line in range(1, 22)))) == 21


def test_every_different_loss_is_told(source: Source) -> None:
    assert len(list(folded(report(LOSS, source, line, str(line)) for line in range(1, 51)))) == 50


def test_other_files_and_severities_stand_for_themselves(source: Source) -> None:
    other = source_from_text("b.src", "x\n")
    items = [report(ERROR, source, 1, "x"), report(ERROR, other, 1, "x"), report(LOSS, source, 1, "x")]
    assert len(list(folded(items))) == 3


def test_the_command_line_folds_and_json_does_not(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program = tmp_path / "demo.src"
    program.write_text("DEF demo()\n" + "$OUT[1]==TRUE)(\n" * 40 + "END\n")
    assert run(["check", str(program), "--json"]) == 1
    captured = capsys.readouterr()
    assert len(captured.err.splitlines()) == 1 and "[39 more times: lines 3, 4," in captured.err
    assert len(json.loads(captured.out)["diagnostics"]) == 40
    assert run(["check", str(program)]) == 1
    assert "1 files, 40 errors" in capsys.readouterr().out


def test_what_a_run_warns_of_in_every_pass_is_told_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A UR leaves out a move whose blend is longer than what the one before leaves of the way, in each pass."""
    program = tmp_path / "loop.script"
    moves = "".join(
        f"    movel(p[{x}, -0.2, 0.3, 0, 3.14159, 0], a=1.2, v=0.25, r={r})\n"
        for x, r in ((0.30, 0.0), (0.35, 0.04), (0.40, 0.04), (0.45, 0.0))
    )
    program.write_text(f"def loop():\n  i = 0\n  while i < 3:\n{moves}    i = i + 1\n  end\nend\n")
    run(["run", str(program), "--robot", "ur5e"])
    warned = [line for line in capsys.readouterr().err.splitlines() if " warning overlapping-blends " in line]
    assert warned and all(line.endswith("[3 times]") for line in warned), warned
