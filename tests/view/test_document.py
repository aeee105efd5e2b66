"""The page of `rpl view --save`: its numbers are the run's, its texts are texts, it loads nothing, it stays small."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rpl.cli.main import run as rpl
from rpl.emulator.model import load_robot
from rpl.simulation import run_program
from rpl.source import source_from_text
from rpl.view.document import LINES_AROUND, view_document
from rpl.view.packing import packed, unpacked
from rpl.view.page import TEXTS, view_page
from rpl.view.scene import Scene, scene_of
from rpl.view.tracks import LineAt, Track
from rpl.workcell.collisions import Collision
from rpl.workcell.record import CellRun, RobotRun
from tests.report.test_page import LOADING, Page
from tests.runtime.helpers import KUKA, read
from tests.view.cells import LAYOUT, PROGRAM, cell_run


def hit() -> Collision:
    """The jaws in the table while line 7 is driven."""
    (origin,) = {event.origin for event in cell_run().robots[0].result.trace if event.origin.line == 7}
    return Collision(2.0, 2.1, "table", "jaws", (400.0, 0.0, 20.0), 3.25, 2.05, origin)


@pytest.fixture(scope="module")
def scene() -> Scene:
    return scene_of(cell_run(), [hit()])


@pytest.fixture(scope="module")
def page(scene: Scene) -> str:
    return view_page(view_document(scene, "prog"))


@given(
    st.lists(st.tuples(*[st.floats(-2e5, 2e5)] * 3), max_size=20),
    st.sampled_from([1e-4, 0.01, 1.0]),
)
def test_numbers_come_back_within_half_a_step(rows: list[tuple[float, ...]], step: float) -> None:
    values = np.array(rows).reshape(-1, 3)
    back = unpacked(json.loads(json.dumps(packed(values, step))))
    assert back.shape == values.shape
    assert np.abs(back - values).max(initial=0.0) <= step * 0.5001


@pytest.mark.parametrize("values", [[np.nan], [np.inf], [1e9]])
def test_what_cannot_be_packed_is_refused(values: list[float]) -> None:
    with pytest.raises(ValueError, match=r"number|32 bits"):
        packed(np.array(values), 1e-4)


def test_the_document_has_the_runs_numbers(page: str, scene: Scene) -> None:
    data = json.loads(Page(page).json)
    (robot,), track = data["robots"], scene.tracks[0]
    assert unpacked(robot["t"]) == pytest.approx(track.times, abs=1e-4)
    assert unpacked(robot["q"]) == pytest.approx(track.joints, abs=1e-4)
    assert unpacked(robot["tool"]) == pytest.approx(track.tool, abs=0.01)
    assert unpacked(robot["speed"]) == pytest.approx(track.speeds, abs=0.5)
    assert data["time_s"] == pytest.approx(scene.run.time_s, abs=1e-6)
    assert [row[1] for row in data["parts"][0]] == ["rests", "held", "falls", "rests"]
    assert [row["name"] for row in data["signals"]] == ["$OUT[3]"]
    assert data["grippers"][0]["widths"] == [[0.0, 120.0], [1.0, 30.0], [2.0, 80.0]]


def test_the_page_moves_the_arm_as_the_package_does(page: str, scene: Scene) -> None:
    """What motion.js does with the screws, done here with the numbers of the page."""
    robot = json.loads(Page(page).json)["robots"][0]
    model, screws = load_robot(KUKA), robot["screws"]
    joints = unpacked(robot["q"])[-1]
    theta = np.array(screws["matrix"]) @ joints - np.array(screws["offsets"])
    assert theta == pytest.approx(model.theta(joints), abs=1e-9)
    flange = np.array(screws["flange"]).reshape(3, 4)
    assert flange == pytest.approx(model.arm.forward(np.zeros(6))[:3], abs=1e-3)


def test_events_are_by_time_with_their_lines(page: str) -> None:
    events = json.loads(Page(page).json)["events"]
    assert [(row["kind"], row["t"]) for row in events] == [("grasp", 1.0), ("collision", 2.0), ("misgrip", 2.2)]
    assert events[1]["text"] == "table touches jaws, 3.2 mm deep"
    assert (events[1]["line"], events[1]["names"], events[1]["point"]) == (7, ["table", "jaws"], [400.0, 0.0, 20.0])


def test_equal_forms_go_in_once(scene: Scene) -> None:
    twice = scene_of(CellRun(LAYOUT, scene.run.robots * 2, time_s=1.0))
    document = view_document(twice, "two")
    assert len(document["shapes"]) < len(document["bodies"])  # type: ignore[arg-type]


def test_the_page_loads_nothing(page: str) -> None:
    for tag, attributes in Page(page).tags:
        assert tag not in ("link", "iframe", "img", "object", "embed", "base"), tag
        assert not LOADING & set(attributes), (tag, attributes)
    (policy,) = [a["content"] for _, a in Page(page).tags if a.get("http-equiv") == "Content-Security-Policy"]
    assert policy.startswith("default-src 'none';")
    assert "http" not in policy
    folder = Path(__file__).parents[2] / "rpl/view/player"
    for name in TEXTS:
        own = (folder / name).read_text("utf-8")
        assert not any(word in own for word in ("http:", "https:", "fetch(", "XMLHttpRequest", "import(", "innerHTML"))


def test_what_the_program_says_is_escaped() -> None:
    text = '</script><script>alert("1")</script>&amp;<!--'
    program = read(
        "rapid", 'MODULE prog\nPROC main()\nTPWrite "' + text.replace('"', '""') + '";\nENDPROC\nENDMODULE\n'
    )
    result = run_program(program, None)
    run = CellRun(LAYOUT, (RobotRun(LAYOUT.robots[0], None, program, result),), status="<b>", fault=text)
    whole = view_page(view_document(scene_of(run), "a<b>&c"))
    parsed = Page(whole)
    assert [tag for tag, _ in parsed.tags].count("script") == len([name for name in TEXTS if name.endswith(".js")]) + 2
    assert text in json.loads(parsed.json)["files"][0]["pieces"][0][1].replace('""', '"')
    assert text in parsed.words
    assert "<b>&c" not in whole
    assert "<script>alert" not in whole


def test_two_runs_give_the_same_page(page: str) -> None:
    cell_run.cache_clear()
    assert view_page(view_document(scene_of(cell_run(), [hit()]), "prog")) == page


def test_a_minute_stays_below_5_mb() -> None:
    """Sixty-five seconds of driving, most of it in moves."""
    body = "PTP {A1 -60,A2 -90,A3 90,A4 0,A5 45,A6 0}\nPTP {A1 60,A2 -70,A3 100,A4 50,A5 -45,A6 90}\n"
    program = read("krl", "DEF prog( )\n" + body * 45 + "END\n")
    model = load_robot(KUKA)
    result = run_program(program, model)
    assert result.time_s > 60.0
    run = CellRun(LAYOUT, (RobotRun(LAYOUT.robots[0], model, program, result),), time_s=result.time_s)
    assert len(view_page(view_document(scene_of(run), "minute"))) < 5_000_000


def test_a_long_text_is_cut_to_what_the_run_came_to() -> None:
    from rpl.view.document import _file

    source = source_from_text("long.src", "".join(f"; line {number} {'x' * 60}\n" for number in range(1, 20_001)))
    none = np.zeros(0)
    track = Track(
        none, none, none, none, (), (LineAt(0.0, "long.src", 5, "main"), LineAt(1.0, "long.src", 9_000, "main"))
    )
    pieces = _file("long.src", "long.src", source, [track])["pieces"]
    assert isinstance(pieces, list)
    assert [first for first, _ in pieces] == [1, 9_000 - LINES_AROUND]
    assert pieces[1][1].splitlines()[LINES_AROUND].startswith("; line 9000 ")
    assert len(pieces[1][1].splitlines()) == 2 * LINES_AROUND + 1


def test_the_command_writes_the_page(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program, target = tmp_path / "prog.src", tmp_path / "out" / "run.html"
    program.write_text(PROGRAM)
    assert rpl(["view", str(program), "--robot", KUKA, "--save", str(target), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["files"] == [{"path": str(target)}]
    text = target.read_text("utf-8")
    assert "LIN_REL {Y 300}" in json.loads(Page(text).json)["files"][0]["pieces"][0][1]


def test_without_a_robot_the_panels_remain(tmp_path: Path) -> None:
    program, target = tmp_path / "prog.src", tmp_path / "run.html"
    program.write_text(PROGRAM.replace("LIN_REL", ";"))
    assert rpl(["view", str(program), "--save", str(target)]) == 0
    data = json.loads(Page(target.read_text("utf-8")).json)
    assert "q" not in data["robots"][0]
    assert data["signals"]


def test_a_program_with_errors_is_not_drawn(tmp_path: Path) -> None:
    program, target = tmp_path / "prog.src", tmp_path / "run.html"
    program.write_text("DEF prog( )\nINT x\nx=\nEND\n")
    assert rpl(["view", str(program), "--save", str(target)]) == 1
    assert not target.exists()
