"""The page of `rpl run --plot`: opens from disk, loads nothing, and shows the run with its source lines."""

import json
import sys
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

from rpl.cli.main import run as rpl
from rpl.emulator.model import load_robot
from rpl.emulator.rotations import pose_matrix, rotation_vector_to_matrix
from rpl.report.document import Heading, RunDocument, run_document
from rpl.report.page import drawing_library, page, script_json
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program
from tests.runtime.helpers import KUKA, rapid, read

PROGRAM = """DEF prog( )
$VEL.CP=0.2
PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}
$OUT[3]=TRUE
LIN_REL {Z -120} C_DIS
LIN_REL {Y 300}
$OUT[3]=FALSE
WAIT SEC 0.5
END
"""
MODEL = load_robot(KUKA)
# Attributes that make a browser load something.
LOADING = {"src", "href", "srcset", "data", "action", "poster", "background", "formaction", "manifest"}


class Page(HTMLParser):
    """Elements, text and data of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str]]] = []
        self.words: list[str] = []
        self.scripts: list[str] = []
        self.json = ""
        self.inside = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, {name: value or "" for name, value in attrs}))
        kind = dict(attrs).get("type")
        self.inside = "json" if tag == "script" and kind == "application/json" else tag

    def handle_endtag(self, tag: str) -> None:
        self.inside = ""

    def handle_data(self, data: str) -> None:
        if self.inside == "json":
            self.json += data
        elif self.inside == "script":
            self.scripts.append(data)
        elif self.inside != "style" and data.strip():
            self.words.append(data.strip())


def document(result: RunResult, **more: int) -> RunDocument:
    return run_document(result, MODEL, Heading(("cell/prog.src",), "KUKA KRL", "KUKA", moves=result.moves), **more)


@pytest.fixture(scope="module")
def result() -> RunResult:
    return run_program(read("krl", PROGRAM), MODEL)


@pytest.fixture(scope="module")
def shown(result: RunResult) -> Page:
    return Page(page(document(result), "/* library */"))


def test_the_page_loads_nothing(shown: Page) -> None:
    for tag, attributes in shown.tags:
        assert tag not in ("link", "iframe", "img", "object", "embed", "base"), tag
        assert not LOADING & set(attributes), (tag, attributes)
    (policy,) = [a["content"] for tag, a in shown.tags if a.get("http-equiv") == "Content-Security-Policy"]
    assert policy.startswith("default-src 'none';")
    assert "http" not in policy
    own = (Path(__file__).parents[2] / "rpl/report/page.js").read_text()
    assert not any(word in own for word in ("http:", "https:", "fetch(", "XMLHttpRequest", "import("))


def test_heading_and_table_are_readable_without_scripts(shown: Page, result: RunResult) -> None:
    assert {"prog", "finished", f"{result.time_s:.3f} s", "KUKA KRL", "p0.src:5"} <= set(shown.words)
    rows = [attributes for tag, attributes in shown.tags if tag == "tr" and "data-move" in attributes]
    assert len(rows) == result.moves == 3
    assert "LIN_REL {Z -120} C_DIS" in shown.words
    assert "300.0" in shown.words  # mm that the last move is long


def test_traces_have_the_runs_numbers(shown: Page, result: RunResult) -> None:
    data = json.loads(shown.json)
    samples = data["samples"]
    count = len(samples["t"])
    assert samples["t"][0] == 0.0
    assert samples["t"][-1] == pytest.approx(result.time_s, abs=1e-4)
    for name in ("tool_speed", "turning", "conditioning"):
        assert len(samples[name]) == count
    joints = np.array(samples["joints"]).T
    assert joints.shape == (count, 6)
    assert joints[-1] == pytest.approx(result.joints, abs=1e-4)
    tool = np.array(samples["tool"]).T
    last = [event for event in result.trace if event.kind == "move"][-1]
    assert tool[-1] == pytest.approx(last.data["xyz_mm"], abs=1e-3)
    assert max(samples["tool_speed"]) >= 200.0
    axis = data["joints"][0]
    assert (axis["low"], axis["high"], axis["speed"], axis["unit"]) == (-170.0, 170.0, 360.0, "deg")
    assert set(samples["factors"]) == {"wrist", "elbow", "shoulder"}


def test_the_arm_is_drawn_from_its_screws(shown: Page, result: RunResult) -> None:
    """What arm.js does with a joint vector, done here with the numbers of the page."""
    arm = json.loads(shown.json)["arm"]
    pose = np.eye(4)
    angles = np.array(arm["matrix"]) @ np.array(result.joints) - np.array(arm["offsets"])
    for point, direction, sliding, angle in zip(arm["points"], arm["directions"], arm["sliding"], angles, strict=True):
        assert not sliding
        turn = rotation_vector_to_matrix(np.array(direction) * angle)
        pose = pose @ pose_matrix(np.array(point) - turn @ np.array(point), turn)
    flange = np.vstack([np.array(arm["flange"]).reshape(3, 4), [[0.0, 0.0, 0.0, 1.0]]])
    assert pose @ flange == pytest.approx(MODEL.forward(result.joints), abs=2e-3)


def test_every_sample_of_a_move_has_its_source_line(shown: Page) -> None:
    data = json.loads(shown.json)
    lines = [data["labels"][number] for _, move, number in data["stretches"] if move >= 0]
    assert lines == [
        ["p0.src:3", "PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}"],
        ["p0.src:5", "LIN_REL {Z -120} C_DIS"],
        ["p0.src:6", "LIN_REL {Y 300}"],
    ]
    rests = [data["labels"][number] for _, move, number in data["stretches"] if move < 0 and number >= 0]
    assert rests == [["p0.src:8", "WAIT SEC 0.5"]]


def test_signals_are_a_timeline_with_lines(shown: Page, result: RunResult) -> None:
    data = json.loads(shown.json)
    (row,) = data["signals"]
    assert (row["name"], row["kind"], row["level"]) == ("$OUT[3]", "output", True)
    times = [t for t, name, _ in result.outputs]
    assert [change[0] for change in row["changes"]] == pytest.approx(times, abs=1e-4)
    assert [(change[2], data["labels"][change[3]][0]) for change in row["changes"]] == [
        ("TRUE", "p0.src:4"),
        ("FALSE", "p0.src:7"),
    ]


def test_what_the_program_says_is_escaped() -> None:
    text = '</script><script>alert("1")</script>&amp;<!--'
    said = rapid('TPWrite "' + text.replace('"', '""') + '";', robot=KUKA)
    assert said.messages == (text,)
    file = "a<b>&c.src"
    whole = page(run_document(said, MODEL, Heading((file,), fault=text)), "")
    parsed = Page(whole)
    assert [tag for tag, _ in parsed.tags].count("script") == 3
    assert json.loads(parsed.json)["marks"][0]["text"] == text
    assert file in parsed.words
    assert text in parsed.words
    assert "<b>&c" not in whole


def test_json_in_a_script_cannot_end_it() -> None:
    value = {"a": "</script><!--", "b": [1.5, None, "&"]}
    written = script_json(value)
    assert not set("<>&") & set(written)
    assert json.loads(written) == value


def test_long_runs_are_thinned_and_say_so(result: RunResult) -> None:
    whole, few = document(result), document(result, most_samples=100)
    assert len(few.data["samples"]["t"]) <= 100  # type: ignore[call-overload, index]
    assert any("of all" in note for note in few.notes)
    assert not any("of all" in note for note in whole.notes)
    assert few.moves == whole.moves


def test_without_a_robot_there_are_signals_only() -> None:
    result = run_program(read("krl", PROGRAM.replace("LIN_REL", ";")), None)
    alone = run_document(result, None, Heading(("prog.src",)))
    assert "samples" not in alone.data
    assert any("--robot" in note for note in alone.notes)
    assert "$OUT[3]" in page(alone, "")


def test_two_runs_give_the_same_page(result: RunResult) -> None:
    again = run_program(read("krl", PROGRAM), MODEL)
    assert page(document(result), "") == page(document(again), "")


def test_the_command_writes_the_page(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("plotly")
    program, target = tmp_path / "prog.src", tmp_path / "out" / "run.html"
    program.write_text(PROGRAM)
    assert rpl(["run", str(program), "--robot", KUKA, "--plot", str(target), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["moves"] == 3
    text = target.read_text("utf-8")
    assert "Plotly" in text
    assert drawing_library() in text
    assert len(text) < 6_000_000
    assert not LOADING & {name for _, attributes in Page(text).tags for name in attributes}


def test_a_missing_library_is_said_before_the_run(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "plotly.offline", None)
    program, target = tmp_path / "prog.src", tmp_path / "run.html"
    program.write_text(PROGRAM)
    assert rpl(["run", str(program), "--plot", str(target)]) == 2
    assert "pip install 'robot-rpl[plot]'" in capsys.readouterr().err
    assert not target.exists()
