"""The live view: a server that a browser reaches, whose buttons do what the screen does. No browser is needed here."""

from __future__ import annotations

import asyncio
import socket
import sys
import threading
import urllib.request
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rpl.cli.main import run as rpl
from rpl.emulator.rotations import matrix_to_quaternion
from rpl.view.scene import scene_of
from rpl.view.screen import Loaded, Screen
from rpl.workcell.collisions import Collision
from tests.runtime.helpers import KUKA
from tests.view.cells import PROGRAM, at, cell_run

viser = pytest.importorskip("viser")

SOMEBODY = SimpleNamespace()  # the client of an event


def free_port() -> int:
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return int(one.getsockname()[1])


@pytest.fixture
def live() -> Iterator[Any]:
    from rpl.view.live import Live

    hit = Collision(2.0, 2.1, "table", "jaws", (400.0, 0.0, 20.0), 3.25, 2.05)
    shown = Live(Screen(Loaded(scene_of(cell_run(), [hit]), ())), "127.0.0.1", free_port(), "prog")
    yield shown
    shown.stop()


def node_at(live: Any, name: str) -> np.ndarray:
    number = [one.name for one in live.screen.scene.bodies].index(name)
    return np.array(live.nodes[number].position) * 1000.0


def test_a_browser_gets_the_client_and_the_scene(live: Any) -> None:
    from websockets.asyncio.client import connect
    from websockets.typing import Subprotocol

    with urllib.request.urlopen(live.address, timeout=30) as answer:
        assert b"<html" in answer.read(2000)
    version = Subprotocol(f"viser-v{viser.__version__}")

    async def first_bytes() -> int:
        address = live.address.replace("http", "ws")
        async with connect(address, subprotocols=[version], max_size=None) as link:
            return len(await asyncio.wait_for(link.recv(), 30))

    assert asyncio.run(first_bytes()) > 1_000


def test_it_listens_on_this_machine_only(live: Any) -> None:
    assert live.address.startswith("http://127.0.0.1:")


def test_bodies_stand_where_the_screen_has_them_while_it_plays(live: Any) -> None:
    playing = threading.Thread(target=live.serve)
    with live.working():
        live.screen.speed = 50.0
        live.screen.play()
    playing.start()
    live.ended.wait(1.0)
    live.ended.set()
    playing.join(30.0)
    assert live.screen.time_s == live.screen.scene.run.time_s
    assert node_at(live, "plug") == pytest.approx([400.0, 0.0, 30.0])
    assert live.panels.time.value == pytest.approx(live.screen.time_s, abs=1e-3)


def test_the_gizmo_drags_the_arm_and_says_what_it_cannot_do(live: Any) -> None:
    def drag(pose: np.ndarray, phase: str) -> None:
        turned, place = matrix_to_quaternion(pose[:3, :3]), pose[:3, 3] / 1000.0
        target = SimpleNamespace(wxyz=tuple(turned), position=tuple(place))
        live._dragged(SimpleNamespace(client=SOMEBODY, phase=phase, target=target))

    with live.working():
        live.screen.go(1.5)
    wanted = live.screen.tool_pose() @ at(30.0, 20.0, -40.0)
    drag(wanted, "update")
    assert node_at(live, "plug") == pytest.approx(wanted[:3, 3], abs=1e-3)
    drag(at(9000.0, 0.0, 0.0), "end")
    assert "out of reach" in live.panels.arm.content
    assert np.array(live.gizmo.position) * 1000.0 == pytest.approx(wanted[:3, 3], abs=1e-3)  # back at the tool


def test_a_click_on_a_surface_makes_a_frame(live: Any) -> None:
    number = [one.name for one in live.screen.scene.bodies].index("table")
    event = SimpleNamespace(client=SOMEBODY, ray_origin=(0.6, 0.1, 1.0), ray_direction=(0.0, 0.0, -1.0))
    live._clicked(number)(event)
    assert live.screen.frames["frame1"][:3, 3] == pytest.approx([600.0, 100.0, 0.0], abs=1e-6)
    event.ray_origin = (5.0, 0.1, 1.0)
    live._clicked(number)(event)
    assert "passes by" in live.panels.said.content


def test_what_touches_is_marked_around_its_time(live: Any) -> None:
    for t, seen in ((1.0, False), (2.0, True), (2.3, True), (2.6, False)):
        with live.working():
            live.screen.go(t)
        assert [mark.visible for mark in live.touches] == [seen]
        assert ("table touches jaws" in live.panels.arm.content) == seen


def test_texts_of_programs_are_escaped(live: Any) -> None:
    from rpl.view.livepanels import programs_html, signals_html

    assert "PTP {A1 0,A2 -90" in programs_html(live.screen)
    with live.working():
        live.screen.say("<b>&")
        live.screen.go(live.screen.scene.run.time_s)
    assert "&lt;b&gt;&amp;" in live.panels.said.content
    assert "$OUT[3]" in signals_html(live.screen)


def test_a_missing_package_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    program = tmp_path / "prog.src"
    program.write_text(PROGRAM)
    monkeypatch.setitem(sys.modules, "viser", None)
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    assert rpl(["view", str(program), "--robot", KUKA]) == 2
    assert "robot-rpl[view]" in capsys.readouterr().err
