"""What is reported again and again is told once, with its number and places; JSON has every one."""

import json
from pathlib import Path

import pytest

from rpl.cli.main import run
from rpl.diagnostics import Code, Diagnostic, Severity, code
from rpl.grouping import told
from rpl.source import Origin, Source, source_from_text

ERROR = code("test-told-error", Severity.ERROR, "wrong: {word}")
LOSS = code("test-told-loss", Severity.LOSS, "lost: {word}")


NOTE = code("test-told-note", Severity.INFO, "{name} is kept")
SETTING = code("test-told-setting", Severity.WARNING, "no {name}", several="{count} settings are left out: [{name}]")
PAIR = code("test-told-pair", Severity.WARNING, "signal {name} gets number {number}")
TEXT = code("test-told-text", Severity.WARNING, "{text}")
ADVISED = code("test-told-advice", Severity.WARNING, "not known", "name the arm with --robot, and set tools")
ELSEWHERE = code("test-told-elsewhere", Severity.WARNING, "not looked at", "run it (rpl run --robot)")


def report(kind: Code, source: Source | None, line: int = 1, **arguments: object) -> Diagnostic:
    offset = source.line_starts()[line - 1] if source is not None else 0
    return Diagnostic(kind, Origin(source, offset, offset), tuple(arguments.items()), kind.severity)


def texts(*items: Diagnostic) -> list[str]:
    return list(told(items))


@pytest.fixture
def source() -> Source:
    return source_from_text("a.src", "x\n" * 2100)


def test_the_same_words_are_one_line_with_their_number_and_lines(source: Source) -> None:
    items = [report(ERROR, source, line, word="x" if line != 3 else "y") for line in (2, 3, 5, 9)]
    assert texts(*items) == [
        "a.src:2:1: error test-told-error wrong: x [3 times: lines 2, 5, 9]",
        "a.src:3:1: error test-told-error wrong: y",
    ]
    assert texts(*(report(ERROR, source, line, word="x") for line in range(1, 51))) == [
        "a.src:1:1: error test-told-error wrong: x [50 times: lines 1 to 50]"
    ]
    assert texts(*(report(ERROR, source, line, word="x") for line in range(1, 61, 2)))[0].endswith("17, 19, ...]")


def test_the_worst_comes_first(source: Source) -> None:
    items = [report(NOTE, source, 1, name="a"), report(LOSS, source, 2, word="x"), report(ERROR, source, 3, word="y")]
    assert [text.split()[1] for text in texts(*items)] == ["error", "loss", "info"]


def test_one_argument_that_differs_is_listed(source: Source) -> None:
    items = [report(NOTE, source, line, name=f"N{line}") for line in (7, 4, 5, 6)]
    assert texts(*items) == ["a.src:7:1: info test-told-note N7, N4, N5, N6 is kept [4 times: lines 4 to 7]"]
    many = texts(*(report(NOTE, source, line, name=f"N{line}") for line in range(1, 101)))
    assert len(many) == 1 and "N12 and 88 more is kept [100 times: lines 1 to 100]" in many[0]


def test_a_code_has_its_own_sentence_for_several(source: Source) -> None:
    items = [report(SETTING, source, 4, name=name) for name in ("speed", "load")]
    assert texts(*items) == ["a.src:4:1: warning test-told-setting 2 settings are left out: speed, load"]
    assert texts(*items[:1]) == ["a.src:4:1: warning test-told-setting no speed"]
    assert texts(*items, *items)[0].endswith("speed, load [4 times]")


def test_two_arguments_that_differ_are_an_example(source: Source) -> None:
    items = [report(PAIR, source, line, name=f"S{line}", number=line) for line in range(1, 6)]
    assert texts(*items) == [
        "a.src:1:1: warning test-told-pair signal S1 gets number 1 "
        "(and 4 others like it: --verbose shows them) [5 times: lines 1 to 5]"
    ]
    few = [report(PAIR, source, line, name=f"S{line}", number=line % 2) for line in range(1, 6)]
    assert texts(*few) == [
        "a.src:1:1: warning test-told-pair signal S1, S3, S5 gets number 1 [3 times: lines 1, 3, 5]",
        "a.src:2:1: warning test-told-pair signal S2, S4 gets number 0 [2 times: lines 2, 4]",
    ]
    whole = [report(TEXT, source, line, text=f"sentence {line}") for line in (1, 2)]
    assert texts(*whole)[0].startswith("a.src:1:1: warning test-told-text sentence 1 (and 1 other like it")


@pytest.mark.parametrize("kind", [ERROR, LOSS])
def test_errors_and_losses_stand_each_for_itself_while_they_are_few(source: Source, kind: Code) -> None:
    assert len(texts(*(report(kind, source, line, word=line) for line in range(1, 11)))) == 10
    assert len(texts(*(report(kind, source, line, word=line) for line in range(1, 2001)))) == 1
    items = [report(kind, source, line, word=line) for line in range(1, 2001)]
    single = list(told(items, verbose=True))
    assert len(single) == 2000 and single[1999].startswith("a.src:2000:1: ") and single[1999].endswith(": 2000")


def test_several_files_are_one_line(source: Source) -> None:
    other = source_from_text("b.src", "x\r\nx\r\n")
    items = [report(NOTE, source, 1, name="x"), report(NOTE, other, 2, name="x"), report(NOTE, None, name="x")]
    assert texts(*items) == [
        "a.src:1:1: info test-told-note x is kept [3 times: line 1; b.src: line 2; without a place]"
    ]


def test_advice_that_was_followed_is_left_out() -> None:
    item = report(ADVISED, None)
    assert list(told([item])) == [
        "warning test-told-advice not known (name the arm with --robot, and set tools)",
    ]
    assert list(told([item], followed=frozenset(("--robot",)))) == ["warning test-told-advice not known (set tools)"]
    other = list(told([report(ELSEWHERE, None)], followed=frozenset(("--robot",))))
    assert other == ["warning test-told-elsewhere not looked at (run it (rpl run --robot))"]


def test_the_command_line_folds_and_json_does_not(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program = tmp_path / "demo.src"
    program.write_text("DEF demo()\n" + "$OUT[1]==TRUE)(\n" * 40 + "END\n")
    assert run(["check", str(program), "--json"]) == 1
    captured = capsys.readouterr()
    assert len(captured.err.splitlines()) == 1 and "[40 times: lines 2 to 41]" in captured.err
    assert len(json.loads(captured.out)["diagnostics"]) == 40
    assert run(["check", str(program), "--verbose"]) == 1
    captured = capsys.readouterr()
    assert len([line for line in captured.err.splitlines() if "demo.src:" in line]) == 40
    assert "1 files, 40 errors" in captured.out


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
