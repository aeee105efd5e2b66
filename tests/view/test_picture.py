"""Pictures of a moment: what is in front is what a ray meets first, and the file is a PNG."""

from __future__ import annotations

import json
import struct
import zlib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpl.cell.shapes import Facets
from rpl.cli.main import run as rpl
from rpl.view.camera import VIEWS, Camera
from rpl.view.picture import SIZE, bounds_of, picture
from rpl.view.raster import NOTHING, Canvas, png
from rpl.view.scene import scene_of
from rpl.workcell.collisions import Collision
from tests.runtime.helpers import KUKA
from tests.view.cells import PROGRAM, cell_run

SIDE = 24


def pixels_of(file: bytes) -> np.ndarray:
    """A PNG file read back, chunk by chunk."""
    assert file[:8] == b"\x89PNG\r\n\x1a\n"
    at, chunks = 8, {}
    while at < len(file):
        (size,), name = struct.unpack(">I", file[at : at + 4]), file[at + 4 : at + 8]
        chunks[name] = file[at + 8 : at + 8 + size]
        assert struct.unpack(">I", file[at + 8 + size : at + 12 + size])[0] == zlib.crc32(name + chunks[name])
        at += 12 + size
    width, height, depth, kind, *_ = struct.unpack(">IIBBBBB", chunks[b"IHDR"])
    assert (depth, kind) == (8, 2)
    rows = np.frombuffer(zlib.decompress(chunks[b"IDAT"]), dtype=np.uint8).reshape(height, 1 + 3 * width)
    assert set(rows[:, 0]) <= {2}
    return np.add.accumulate(rows[:, 1:], axis=0, dtype=np.uint8).reshape(height, width, 3)


@given(st.integers(0, 2**32 - 1))
def test_pixels_come_back_from_the_file(seed: int) -> None:
    pixels = np.random.default_rng(seed).integers(0, 256, (7, 5, 3), dtype=np.uint8)
    assert (pixels_of(png(pixels)) == pixels).all()


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_the_nearest_triangle_is_seen_as_a_ray_through_the_pixel_says(seed: int) -> None:
    random = np.random.default_rng(seed)
    facets = Facets(random.uniform(-100.0, 100.0, (18, 3)), np.arange(18).reshape(6, 3))
    camera = Camera(np.zeros(3), 500.0, float(random.uniform(-180, 180)), float(random.uniform(-80, 80)))
    canvas = Canvas(SIDE, SIDE)
    canvas.triangles(camera.seen(facets.vertices[facets.faces], SIDE, SIDE))
    edge = 0.5 / np.tan(np.deg2rad(15.0)) * SIDE
    for place in range(SIDE * SIDE):
        x, y = place % SIDE + 0.5 - SIDE / 2.0, place // SIDE + 0.5 - SIDE / 2.0
        way = camera.axes.T @ np.array([x, -y, -edge])
        met = facets.pierced(camera.eye, way / np.linalg.norm(way))
        assert canvas.owner[place] == (NOTHING if met is None else met[1])


@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.parametrize("aspect", [0.5, 1.5])
def test_everything_is_in_the_picture_and_fills_it(view: str, aspect: float) -> None:
    bounds = np.array([[-300.0, 100.0, 0.0], [900.0, 400.0, 1300.0]])
    camera = Camera.around(bounds, view, aspect)
    corners = np.array([[bounds[i, 0], bounds[j, 1], bounds[k, 2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
    width, height = int(800 * aspect), 800
    x, y, depth = camera.seen(corners, width, height).T
    assert np.isfinite(depth).all()
    assert min(x.min(), y.min()) >= 0.0
    assert max(x.max() / width, y.max() / height) <= 1.0
    assert max((x.max() - x.min()) / width, (y.max() - y.min()) / height) > 0.7


def test_a_collision_is_red_at_its_time_and_a_picture_is_the_same_again() -> None:
    scene = scene_of(cell_run(), [Collision(1.5, 1.6, "table", "plug", (600.0, 0.0, 0.0), 1.0, 1.5)])
    files = {t: picture(scene, t, "top", (300, 200)) for t in (0.5, 1.5)}
    reds = {}
    for t, file in files.items():
        pixels = pixels_of(file).astype(int)
        assert pixels.shape == (200, 300, 3)
        reds[t] = int(((pixels[..., 0] > 140) & (pixels[..., 1] < 60) & (pixels[..., 2] < 60)).sum())
    assert reds[1.5] > 2_000 > reds[0.5]
    assert picture(scene, 1.5, "top", (300, 200)) == files[1.5]


def test_bounds_hold_every_body_and_the_path() -> None:
    scene = scene_of(cell_run())
    low, high = bounds_of(scene)
    assert (low <= scene.tracks[0].tool.min(axis=0)).all()
    assert (high >= scene.tracks[0].tool.max(axis=0)).all()
    assert low[2] == pytest.approx(-40.0)  # below the table
    assert high[0] == pytest.approx(900.0)


def test_the_command_takes_a_picture(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program, target = tmp_path / "prog.src", tmp_path / "at.png"
    program.write_text(PROGRAM)
    given = ["view", str(program), "--robot", KUKA, "--picture", str(target), "--at", "1.5", "--side", "front"]
    assert rpl([*given, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["files"] == [{"path": str(target)}]
    assert pixels_of(target.read_bytes()).shape == (SIZE[1], SIZE[0], 3)


def test_what_is_asked_for_in_vain_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program = tmp_path / "prog.src"
    program.write_text(PROGRAM)
    assert rpl(["view", str(program), "--at", "1.5", "--save", str(tmp_path / "a.html")]) == 2
    assert "--picture" in capsys.readouterr().err
