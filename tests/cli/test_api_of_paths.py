"""The Python API takes paths as the command line does, and its results show themselves in a line or a small table."""

from pathlib import Path

import pytest

import rpl
from rpl.errors import SourceError, UsageError

SAMPLE = Path(__file__).parents[2] / "samples/krl/palletiser"
MOVES = Path(__file__).parents[1] / "selfcheck/moves.src"
ROBOT = "kuka_kr6r900sixx"


@pytest.fixture
def demo(tmp_path: Path) -> Path:
    path = tmp_path / "demo.src"
    path.write_text("DEF demo()\n$OUT[1]=TRUE\nEND\n")
    return path


def test_every_word_takes_paths(demo: Path) -> None:
    assert rpl.run(str(demo)).status == "finished"
    assert rpl.run([demo]).outputs == rpl.run(rpl.read(demo)).outputs == ((0.0, "$OUT[1]", True),)
    assert [file.path for file in rpl.translate(str(demo), "abb").files] == ["demo.mod"]
    assert rpl.prove(MOVES, str(MOVES), ROBOT).equal


def test_a_cell_is_taken_by_its_path(demo: Path, tmp_path: Path) -> None:
    demo.write_text("DEF demo()\nWAIT FOR $IN[1]\n$OUT[1]=TRUE\nEND\n")
    cell = tmp_path / "cell.toml"
    cell.write_text('[[input]]\ntime = 1.0\nsignal = "di1"\nvalue = true\n')
    assert rpl.run(demo).status == "deadlock"
    assert rpl.run(demo, cell=cell).status == "finished"
    moving = demo.read_text().replace("$OUT[1]", "PTP {A1 10,A2 -80,A3 95,A4 0,A5 30,A6 0}\n$OUT[1]")
    demo.write_text(moving)
    assert rpl.prove(demo, demo, ROBOT, str(cell)).equal


def test_a_program_with_errors_is_refused_with_their_places(demo: Path) -> None:
    demo.write_text("DEF demo()\n" + "$OUT[1]==TRUE)(\n" * 9 + "END\n")
    for call in (
        lambda: rpl.run(demo),
        lambda: rpl.translate(demo, "rapid"),
        lambda: rpl.prove(demo, demo),
    ):
        with pytest.raises(SourceError, match=r"demo\.src:2:8: error unreadable-statement") as caught:
            call()
        assert str(caught.value).endswith("[9 times: lines 2 to 10]")
    assert rpl.run(rpl.read(demo)).status == "fault"  # who has read it has been told


def test_what_is_missing_is_said(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="no such file"):
        rpl.run(tmp_path / "nothing.src")
    with pytest.raises(UsageError, match="no robot program was found"):
        rpl.run(tmp_path)
    with pytest.raises(UsageError, match="no robot named"):  # before the program is looked at
        rpl.run(tmp_path / "nothing.src", "nobody")


def test_results_are_short(demo: Path) -> None:
    program = rpl.read(SAMPLE)
    assert repr(program) == "<ReadProgram: krl, 2 files, 90 statements>"
    written = rpl.translate(program, "rapid")
    assert repr(written) == "<Translation: 1 file (Palletiser.mod), 0 losses>"
    result = rpl.run(program, ROBOT)
    assert repr(result).startswith("<RunResult: finished after ") and "84 moves, 21 outputs" in repr(result)
    demo.write_text("DEF demo()\nINT i\ni=1/0\nEND\n")
    fault = repr(rpl.run(demo))
    assert "fault after 0.000 s" in fault and "demo.src:3" in fault


def test_events_and_reports_show_their_place_and_not_the_whole_file(demo: Path) -> None:
    result = rpl.run(demo, robot="kuka_kr6r900sixx")
    shown = [repr(event) for event in result.trace]
    assert shown and max(len(one) for one in shown) < 1500 and all("END" not in one for one in shown)


def test_notebooks_get_a_table_and_nothing_of_a_program_is_markup(demo: Path) -> None:
    program = rpl.read(SAMPLE)
    assert program._repr_html_().count("<tr>") == 3
    assert "<pre>MODULE Palletiser" in rpl.translate(program, "rapid")._repr_html_()
    assert "<td>$OUT[1]</td><td>True</td>" in rpl.run(demo)._repr_html_()
    demo.write_text('DEF demo()\n; <script>alert(1)</script>\nMsgNotify("<b>&")\nEND\n')
    read = rpl.read(demo)
    for shown in (read, rpl.run(read), rpl.translate(read, "rapid")):
        assert "<script>" not in shown._repr_html_() and "<b>&" not in shown._repr_html_()


def test_signs_that_steer_a_terminal_are_shown_as_escapes(tmp_path: Path) -> None:
    path = tmp_path / "demo\x1b[31m.src"
    path.write_text("DEF demo()\nINT i\ni=1/0\nEND\n")
    assert "\x1b" not in repr(rpl.run(path))
